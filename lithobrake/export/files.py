"""What can be passed on, by the word for it, and the files that each becomes."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from lithobrake.export.ephemerides import write_ephemerides
from lithobrake.export.facet_table import write_facet_csv, write_facet_fits
from lithobrake.export.geojson import write_geojson
from lithobrake.export.geotiff import RESOLUTION_DEG, write_geotiff
from lithobrake.export.motions import named_landing, write_motions, write_sheet
from lithobrake.export.plate_text import write_plates
from lithobrake.results import StudyResults


@dataclass(frozen=True)
class ExportOptions:
    """What a user may choose of the files; the defaults are those of the functions that write them.

    run: whose landing is made again, by its row in `runs`, its key, or how that begins; None: the one that the study
    keeps. progress: told the fraction that is done of such a landing, and what is being done.
    """

    samples: Sequence[int] = ()
    frame: str = "inertial"
    epoch: str | None = None
    step: float | None = None
    resolution_deg: float = RESOLUTION_DEG
    run: str | int | None = None
    progress: Callable[[float, str], None] = lambda fraction, what: None


def _oem(results: StudyResults, folder: Path, chosen: ExportOptions) -> list[Path]:
    return write_ephemerides(results, folder, chosen.samples, frame=chosen.frame, epoch=chosen.epoch, step=chosen.step)


def _plates(results: StudyResults, folder: Path, chosen: ExportOptions) -> list[Path]:
    write_plates(results, folder / "body.plates.txt")
    return [folder / "body.plates.txt"]


def _facets(results: StudyResults, folder: Path, chosen: ExportOptions) -> list[Path]:
    write_facet_csv(results, folder / "facets.csv")
    write_facet_fits(results, folder / "facets.fits")
    return [folder / "facets.csv", folder / "facets.fits"]


def _geotiff(results: StudyResults, folder: Path, chosen: ExportOptions) -> list[Path]:
    write_geotiff(results, folder / "impacts.tif", resolution_deg=chosen.resolution_deg)
    return [folder / "impacts.tif"]


def _geojson(results: StudyResults, folder: Path, chosen: ExportOptions) -> list[Path]:
    write_geojson(results, folder / "impacts.geojson")
    return [folder / "impacts.geojson"]


def _vtkhdf(results: StudyResults, folder: Path, chosen: ExportOptions) -> list[Path]:
    landing, name = named_landing(results, chosen.run, chosen.progress)
    return write_motions(results, folder, landing, name)


def _sheet(results: StudyResults, folder: Path, chosen: ExportOptions) -> list[Path]:
    return [write_sheet(folder, *named_landing(results, chosen.run, chosen.progress))]


KINDS: dict[str, Callable[[StudyResults, Path, ExportOptions], list[Path]]] = {
    "oem": _oem,
    "plates": _plates,
    "facets": _facets,
    "geotiff": _geotiff,
    "geojson": _geojson,
    "vtkhdf": _vtkhdf,
    "sheet": _sheet,
}


def export_study(
    results: StudyResults, folder: Path, kinds: Sequence[str], choices: ExportOptions | None = None
) -> list[Path]:
    """Write files of these kinds into a folder, which is made where there is none, and give their paths.

    Raises ValueError for a kind that there is not, and for what the writer of a file refuses.
    """
    unknown = [kind for kind in kinds if kind not in KINDS]
    if unknown or not kinds:
        raise ValueError(f"to is {', '.join(unknown) or 'not given'}; allowed: {', '.join(KINDS)}; give one or more")
    folder.mkdir(parents=True, exist_ok=True)
    chosen = choices or ExportOptions()
    return [path for kind in dict.fromkeys(kinds) for path in KINDS[kind](results, folder, chosen)]
