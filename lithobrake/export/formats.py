"""What can be passed on, by the word for it, and the files that each becomes."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from lithobrake.export.attitudes import attitude_names, write_attitudes
from lithobrake.export.bounce_law import LAW, READERS, write_bounce_law
from lithobrake.export.czml import write_czml
from lithobrake.export.ephemerides import ephemeris_names, write_ephemerides, write_spk
from lithobrake.export.flown import ExportOptions
from lithobrake.export.maps import map_names, point_names, write_geojson, write_geotiff
from lithobrake.export.shape_tables import facet_names, write_facets, write_plates
from lithobrake.files.atomic import make_folder, refuse_existing
from lithobrake.results import MovingBodies, StudyResults
from lithobrake.view import contact_sheet, write_vtkhdf
from lithobrake.vocabulary.callbacks import Progress

Names = Callable[[StudyResults, ExportOptions], list[str]]


@dataclass(frozen=True)
class Kind:
    """A kind of export: the names of its files, in order, and what writes them at paths of these names."""

    names: Names
    write: Callable[[StudyResults, Sequence[Path], ExportOptions], None]


# Two kinds of files show one landing, which may take minutes to make again.
@lru_cache(maxsize=1)
def _landing(results: StudyResults, run: str | int | None, progress: Progress) -> MovingBodies:
    """The landing of a run, made again, or for None the one that the study keeps."""
    return results.median_landing if run is None else results.landing_bodies(run, progress=progress)


def _landing_name(chosen: ExportOptions) -> str:
    return "landing" if chosen.run is None else f"landing_{chosen.run}"


def _write_motions(results: StudyResults, paths: Sequence[Path], chosen: ExportOptions) -> None:
    # Of the other beds a study keeps no pictures.
    write_vtkhdf(_landing(results, chosen.run, chosen.progress), paths[0])
    write_vtkhdf(results.bed_bodies(0), paths[1])


def _write_sheet(results: StudyResults, paths: Sequence[Path], chosen: ExportOptions) -> None:
    contact_sheet(_landing(results, chosen.run, chosen.progress), paths[0])


def _always(*names: str) -> Names:
    return lambda results, chosen: list(names)


KINDS = {
    "oem": Kind(ephemeris_names, write_ephemerides),
    "aem": Kind(attitude_names, write_attitudes),
    "spk": Kind(_always("flights.bsp", "body.tpc"), write_spk),
    "czml": Kind(_always("landers.czml"), write_czml),
    "plates": Kind(_always("body.plates.txt"), write_plates),
    "facets": Kind(facet_names, write_facets),
    "geotiff": Kind(map_names, write_geotiff),
    "geojson": Kind(point_names, write_geojson),
    "bounce-law": Kind(_always(LAW, *READERS), write_bounce_law),
    "vtkhdf": Kind(lambda results, chosen: [f"{_landing_name(chosen)}.vtkhdf", "bed_0.vtkhdf"], _write_motions),
    "sheet": Kind(lambda results, chosen: [f"{_landing_name(chosen)}.png"], _write_sheet),
}


def export_study(
    results: StudyResults, folder: Path, kinds: Sequence[str], choices: ExportOptions | None = None
) -> list[Path]:
    """Write files of these kinds into a folder, which is made where there is none, and give their paths.

    Raises ValueError for a kind that there is not, for a file that exists, unless the choices say that it is replaced,
    and for what the writer of a file refuses.
    """
    unknown = [kind for kind in kinds if kind not in KINDS]
    if unknown or not kinds:
        raise ValueError(f"to is {', '.join(unknown) or 'not given'}; allowed: {', '.join(KINDS)}; give one or more")
    chosen = choices or ExportOptions()
    paths = {kind: [folder / name for name in KINDS[kind].names(results, chosen)] for kind in kinds}
    written = [path for of_kind in paths.values() for path in of_kind]
    if not chosen.replaces:
        refuse_existing(written, "choose another folder with --out, or replace what exists with --force")
    make_folder(folder)
    for kind, of_kind in paths.items():
        KINDS[kind].write(results, of_kind, chosen)
    return written
