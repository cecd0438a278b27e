"""What can be passed on, by the word for it, and the files that each becomes."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from lithobrake.export.attitudes import attitude_name, write_attitudes
from lithobrake.export.czml import write_czml
from lithobrake.export.ephemerides import CONSTANTS, FLIGHTS, flight_names, write_ephemerides, write_spk
from lithobrake.export.maps import RESOLUTION_DEG, map_name, write_geojson, write_geotiff, write_rest_geojson
from lithobrake.export.shape_tables import write_facet_csv, write_facet_fits, write_plates
from lithobrake.files.atomic import refuse_existing
from lithobrake.results import MovingBodies, StudyResults
from lithobrake.view import contact_sheet, write_vtkhdf
from lithobrake.vocabulary.callbacks import Progress, silent
from lithobrake.vocabulary.file_names import JOURNEYS_FILE, REST_FILE

IMPACTS, REST, CZML = "impacts.geojson", "rest.geojson", "landers.czml"


@dataclass(frozen=True)
class ExportOptions:
    """What a user may choose of the files; the defaults are those of the functions that write them.

    run: whose landing is made again, by its row in `runs`, its key, or how that begins; None: the one that the study
    keeps. replaces: write over files that exist. progress: told the fraction that is done of such a landing, or of the
    flights, and what is being done. body_number: of the body in SPICE.
    """

    samples: Sequence[int] = ()
    frame: str = "inertial"
    epoch: str | None = None
    step: float | None = None
    resolution_deg: float = RESOLUTION_DEG
    run: str | int | None = None
    replaces: bool = False
    progress: Progress = silent
    body_number: int | None = None


@dataclass(frozen=True)
class Kind:
    """A kind of export: the names of its files, in order, and what writes them at paths of these names."""

    names: Callable[[StudyResults, ExportOptions], list[str]]
    write: Callable[[StudyResults, Path, ExportOptions], None]


def _oem(results: StudyResults, folder: Path, chosen: ExportOptions) -> None:
    write_ephemerides(
        *(results, folder, chosen.samples),
        frame=chosen.frame,
        epoch=chosen.epoch,
        step=chosen.step,
        progress=chosen.progress,
    )


def _spk(results: StudyResults, folder: Path, chosen: ExportOptions) -> None:
    # SPICE takes its own axes alone, whatever the other files are in.
    write_spk(
        *(results, folder, chosen.samples),
        epoch=chosen.epoch,
        step=chosen.step,
        body_number=chosen.body_number,
        progress=chosen.progress,
    )


def _aem(results: StudyResults, folder: Path, chosen: ExportOptions) -> None:
    write_attitudes(results, folder, chosen.samples, frame=chosen.frame, epoch=chosen.epoch, step=chosen.step)


def _czml(results: StudyResults, folder: Path, chosen: ExportOptions) -> None:
    write_czml(
        *(results, folder / CZML, chosen.samples), epoch=chosen.epoch, step=chosen.step, progress=chosen.progress
    )


def _facets(results: StudyResults, folder: Path, chosen: ExportOptions) -> None:
    write_facet_csv(results, folder / "facets.csv")
    write_facet_fits(results, folder / "facets.fits")


def _geojson(results: StudyResults, folder: Path, chosen: ExportOptions) -> None:
    write_geojson(results, folder / IMPACTS)
    if _has_rest(results):
        write_rest_geojson(results, folder / REST)


def _has_rest(results: StudyResults) -> bool:
    return any((results.folder / name).is_file() for name in (REST_FILE, JOURNEYS_FILE))


# Two kinds of files show one landing, which may take minutes to make again.
@lru_cache(maxsize=1)
def _landing(results: StudyResults, run: str | int | None, progress: Progress) -> MovingBodies:
    """The landing of a run, made again, or for None the one that the study keeps."""
    return results.median_landing if run is None else results.landing_bodies(run, progress=progress)


def _landing_name(chosen: ExportOptions) -> str:
    return "landing" if chosen.run is None else f"landing_{chosen.run}"


def _vtkhdf(results: StudyResults, folder: Path, chosen: ExportOptions) -> None:
    # Of the other beds a study keeps no pictures.
    write_vtkhdf(_landing(results, chosen.run, chosen.progress), folder / f"{_landing_name(chosen)}.vtkhdf")
    write_vtkhdf(results.bed_bodies(0), folder / "bed_0.vtkhdf")


def _sheet(results: StudyResults, folder: Path, chosen: ExportOptions) -> None:
    contact_sheet(_landing(results, chosen.run, chosen.progress), folder / f"{_landing_name(chosen)}.png")


KINDS = {
    "oem": Kind(lambda results, chosen: [f"{name}.oem" for name in flight_names(chosen.samples)], _oem),
    "aem": Kind(
        lambda results, chosen: [f"{attitude_name(sample)}.aem" for sample in dict.fromkeys(chosen.samples)], _aem
    ),
    "spk": Kind(lambda results, chosen: [FLIGHTS, CONSTANTS], _spk),
    "czml": Kind(lambda results, chosen: [CZML], _czml),
    "plates": Kind(
        lambda results, chosen: ["body.plates.txt"],
        lambda results, folder, chosen: write_plates(results, folder / "body.plates.txt"),
    ),
    "facets": Kind(lambda results, chosen: ["facets.csv", "facets.fits"], _facets),
    "geotiff": Kind(
        lambda results, chosen: [map_name(results)],
        lambda results, folder, chosen: write_geotiff(
            results, folder / map_name(results), resolution_deg=chosen.resolution_deg
        ),
    ),
    "geojson": Kind(lambda results, chosen: [IMPACTS, *([REST] if _has_rest(results) else [])], _geojson),
    "vtkhdf": Kind(lambda results, chosen: [f"{_landing_name(chosen)}.vtkhdf", "bed_0.vtkhdf"], _vtkhdf),
    "sheet": Kind(lambda results, chosen: [f"{_landing_name(chosen)}.png"], _sheet),
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
    chosen, asked = choices or ExportOptions(), [KINDS[kind] for kind in dict.fromkeys(kinds)]
    paths = [folder / name for kind in asked for name in kind.names(results, chosen)]
    if not chosen.replaces:
        refuse_existing(paths, "choose another folder with --out, or replace what exists with --force")
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ValueError(f"{folder} is no folder and cannot become one ({error.strerror}); choose another") from error
    for kind in asked:
        kind.write(results, folder, chosen)
    return paths
