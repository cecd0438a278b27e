"""The files of a study's folder, as the page lists them: a link to each, what it holds, and its size."""

from collections.abc import Sequence
from pathlib import Path
from urllib.parse import quote

from lithobrake.report.content import PageTable

CONTENTS = {
    "study.toml": "the study file",
    "summary.json": "every number of this page, with its unit",
    "runs.sqlite": "every touchdown: inputs, outcome, outputs, seed, times",
    "beds/bed_*.h5": "a settled bed: shapes, poses and motion",
    "designs/drawn.csv": "the drawn landings: inputs and outputs",
    "designs/soil_pairs.csv": "drawn landings repeated on a second soil",
    "designs/twins.csv": "drawn landings repeated at a slightly shifted impact point",
    "run_flights.csv": "how the flights of each run ended, from many sites",
    "run_impacts.csv": "time, speed and incidence of the impacts that end these flights",
    "estimates.json": "estimates from the runs, with intervals",
    "landing.h5": "the preview landing: shapes, poses and motion",
    "telling_landing.h5": "the landing of this page: the run with the median rebound speed",
    "emulator.json": "the emulator (lithobrake.emulator.load reads it)",
    "explorer.h5": "refits of the emulator or the expansion, for the explorer of this page",
    "screening.json": "the expansion in all inputs",
    "refined.json": "the expansion in the kept inputs",
    "scores.json": "the errors of the expansions, run by run",
    "samples.h5": "the Monte Carlo: inputs and outputs of every sample",
    "flights.csv": "the flight of each sample that leaves the surface",
    "flights_without_scatter.csv": "the same flights without run-to-run scatter",
    "flights.json": "accuracy of the flights",
    "flight_paths.h5": "paths of the first flights, as the page shows them about the body",
    "journeys.csv": "every journey: end, time, place, distance, contacts, side down",
    "touchdowns.csv": "every landing of the journeys: its number, key, outcome, time and place",
    "designs/touchdowns.csv": "the same landings: inputs and outputs",
    "touchdown_emulator.json": "the emulator of all touchdowns of the journeys (lithobrake.emulator.load reads it)",
    "touchdown_explorer.h5": "refits of that emulator, for the explorer of this page",
    "emulated.csv": "journeys by the emulator of the touchdowns, and how they ended",
    "rest.csv": "the journey of each lander that was followed from bounce to bounce",
    "arcs.csv": "each flight between impacts: state at the beginning, time of the end",
    "restitution.csv": "restitution, friction and scatter that the soil implies, by speed and incidence",
    "rest.json": "which ground was followed, and the range of the runs",
    "rare_*.json": "a rare limit state: its probability and the levels of its subset simulation",
    "aim.csv": "the landers at every delivery option, and how they ended",
    "body.obj": "the shape of the body that the flights used",
}


def data_files(folder: Path) -> PageTable:
    """The data files that the folder has; the links hold as long as the page stays in it."""
    found = [(path, words) for name, words in CONTENTS.items() for path in sorted(folder.glob(name))]
    return _table("Data files", folder, found)


def picture_files(folder: Path, pictures: Sequence[tuple[str, str]]) -> PageTable:
    """The figures that stand beside the page: name of the file and title of each."""
    return _table("Figures as files", folder, [(folder / "report" / name, title) for name, title in pictures])


def _table(title: str, folder: Path, found: Sequence[tuple[Path, str]]) -> PageTable:
    names = [path.relative_to(folder).as_posix() for path, _ in found]
    rows = [[name, words, size(path.stat().st_size)] for name, (path, words) in zip(names, found, strict=True)]
    # The page stands in the folder `report`.
    links = {name: f"../{quote(name)}" for name in names}
    return PageTable(title, ["file", "what it holds", "size"], rows, numbers=frozenset({"size"}), links=links)


def size(byte_count: int) -> str:
    """A file's size in words, by powers of a thousand."""
    value, units = float(byte_count), ["B", "kB", "MB"]
    while value >= 999.5 and units[1:]:
        value, units = value / 1000.0, units[1:]
    return f"{value:.0f} {units[0]}" if value >= 99.5 or units[0] == "B" else f"{value:.2g} {units[0]}"
