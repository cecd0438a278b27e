"""The results of a study, read from its folder as they are asked for."""

import math
import os
import shlex
from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lithobrake.files.reading import NUMBER, DamagedFileError, read_json, read_rows, reading
from lithobrake.results.intact import KEYS, STUDY_FILE, intact_file
from lithobrake.results.journey_tables import JOURNEYS, NEEDED, TOUCHDOWN_RUNS, TOUCHDOWNS, joined_touchdowns
from lithobrake.vocabulary.quantities import (
    ARC,
    BEDS,
    DRAWN_DESIGNS,
    FLIGHT,
    JOURNEY,
    JOURNEY_DESIGN,
    JOURNEY_TOUCHDOWN,
    PAPER_DESIGNS,
    RUN,
    SOIL,
    TOUCHDOWN,
    TOUCHDOWN_COST,
    Quantity,
    quantity,
)
from lithobrake.vocabulary.screen import in_lines

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from lithobrake.campaign import Record
    from lithobrake.report.study_plots import StudyPlots
    from lithobrake.results.explorer_tables import ExplorerTables
    from lithobrake.results.journey_again import StudyJourney
    from lithobrake.results.limit_state_results import RareLimitState
    from lithobrake.results.moving_bodies import MovingBodies
    from lithobrake.results.named_emulator import NamedEmulator
    from lithobrake.results.named_surrogate import NamedSurrogate
    from lithobrake.results.summary import DrawnResults, PaperResults
    from lithobrake.results.table import Table
    from lithobrake.touchdown import Outcome

SUMMARY_FORMAT = 4
# Columns that a table has even without rows.
_RUN = ("key", "outcome")
_PLACES = ("sample", "status", "latitude_deg", "longitude_deg")
# Columns that hold no numbers.
_WORDS = {"key", "design", "outcome", "reason", "status", "ground", "end", "face", "soil"}
_SCORE = {"ape": [NUMBER | None], "mape": NUMBER | None, "q2": NUMBER | None, "rmse": NUMBER, "std": NUMBER}

# What a notebook says can be asked for: the file that it takes, and what comes.
_ASKED = {
    "summary": ("summary.json", "every number of the report"),
    "runs": ("runs.sqlite", "every touchdown: inputs, outcome, outputs"),
    "samples": ("samples.h5", "samples of the Monte Carlo"),
    "flights": ("flights.csv", "flights of the samples to their next impact"),
    "journeys": (JOURNEYS, "each lander from delivery to rest: end, time, place, contacts, side down"),
    "touchdowns": (TOUCHDOWNS, "every landing of the journeys: state in, state out, bed, soil, cost"),
    "rest": ("rest.csv", "where samples end after all bounces"),
    "arcs": ("arcs.csv", "each flight between impacts"),
    "emulator": ("*emulator.json", "samples of landings, at any inputs by their names"),
    "surrogate": ("refined.json", "the refined expansion, by the names of its inputs"),
    "median_landing": ("landing.h5", "a landing with its frames"),
    "bed_bodies()": ("beds/bed_0.h5", "the grains of a bed, and how they settled"),
}


# Files of what samples of an emulator or an expansion came to, which a study of journeys has none of.
OF_SAMPLES = ("samples.h5", "flights.csv", "rest.csv", "emulator.json", "explorer.h5")


class StudyResults:
    """What came out of a study; every table says of its columns what they are.

    Nothing is written: it works on a folder that may only be read, on an archived copy, and beside a study that runs,
    as far as that has come. Whatever is asked for raises ValueError, with what to do, where its file is damaged, was
    edited after it was made, or is not there yet.
    """

    # What is light here stays light: a second terminal looks at a running study every few seconds.

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        """Look at a study's folder. Raises ValueError when it is none."""
        self.folder = Path(folder)
        if not any((self.folder / name).is_file() for name in ("summary.json", KEYS, "runs.sqlite")):
            raise ValueError(f"{self.folder} holds no results of a study; name the folder of one that ran")
        self.remedy = f"make it again with: lithobrake run STUDY.toml --out {shlex.quote(str(self.folder))}"

    @cached_property
    def summary(self) -> dict[str, Any]:
        """summary.json: the tables "study", "results" and "provenance" (docs/summary.md has every key)."""
        path, tables = self._file("summary.json"), dict.fromkeys(("study", "results", "provenance"), dict)
        content: dict[str, Any] = read_json(path, {"format_version": int, **tables}, self.remedy)
        if content["format_version"] != SUMMARY_FORMAT:
            raise DamagedFileError(
                f"{path} has format {content['format_version']}; this version reads {SUMMARY_FORMAT}; {self.remedy}"
            )
        return content

    @cached_property
    def results(self) -> "DrawnResults | PaperResults":
        """The table "results" of the summary by attribute, with types."""
        from lithobrake.results.json_values import from_json
        from lithobrake.results.summary import DrawnResults, PaperResults

        with reading(self.folder / "summary.json", self.remedy):
            if self.study["design"]["method"] == "paper":
                return from_json(PaperResults, self.summary["results"], "results")
            return from_json(DrawnResults, self.summary["results"], "results")

    @property
    def study(self) -> dict[str, Any]:
        """The study as it was understood, with all defaults, as the tables of its file."""
        tables: dict[str, Any] = self.summary["study"]
        return tables

    @cached_property
    def study_text(self) -> str:
        """The study file as it was written."""
        path = self._file(STUDY_FILE)
        with reading(path, self.remedy):
            return path.read_text(encoding="utf-8")

    @property
    def headline(self) -> list[str]:
        """The answer, and the most telling numbers behind it, each in a sentence."""
        with reading(self.folder / "summary.json", self.remedy):
            return [str(sentence) for sentence in self.summary["results"]["headline"]]

    @property
    def ledger(self) -> "list[Record]":
        """Every run that was ever made or asked for, those of earlier settings among them, as it stands now."""
        from lithobrake.campaign import read_records

        return read_records(self.folder / "runs.sqlite")

    @cached_property
    def runs(self) -> "Table":
        """Every touchdown of the study once: outcome, inputs in the file's units, outputs [SI]."""
        rows: dict[str, dict[str, Any]] = {}
        for design, name in self._designs().items():
            for row in self._rows(name, _RUN):
                rows.setdefault(row["key"], {"design": design, **row})
        return self._table("run", list(rows.values()), ("design", *_RUN), RUN | TOUCHDOWN)

    @cached_property
    def scores(self) -> dict[str, dict[str, dict[str, Any]]]:
        """Errors of the expansions by set of runs and output (docs/summary.md), with those of single runs in "ape".

        A drawn study has those of its emulator in `emulator.model.scores`.
        """
        self._refuse_drawn("scores", "errors of expansions")
        content: dict[str, Any] = read_json(self._file("scores.json"), {str: {str: _SCORE}}, self.remedy)
        return content

    @cached_property
    def rare(self) -> "dict[str, RareLimitState]":
        """What `lithobrake rare` found of each limit state it was asked for, by name (docs/reliability.md)."""
        from lithobrake.results.json_values import from_json
        from lithobrake.results.limit_state_results import RareLimitState

        remedy, found = "make it again with: lithobrake rare", {}
        for path in sorted(self.folder.glob("rare_*.json")):
            content = read_json(self._file(path.name), dict, remedy)
            with reading(path, remedy):
                found[path.stem.removeprefix("rare_")] = from_json(RareLimitState, content)
        return found

    @cached_property
    def samples(self) -> "Table":
        """The samples of the Monte Carlo: inputs in the file's units, outcome, and outputs [SI] of those that leave."""
        import h5py
        import numpy as np

        path = self._file("samples.h5")
        with reading(path, self.remedy), h5py.File(path, "r") as file:
            names = [str(name) for name in file.attrs["outcomes"]]
            outcome = np.array(names)[file["outcome"][:]]
            inputs, outputs = (
                dict(zip(map(str, file.attrs[f"{part}_names"]), file[f"{part}s"][:].T, strict=True))
                for part in ("input", "output")
            )
        return self._described("sample", {**inputs, "outcome": outcome, **outputs}, RUN | TOUCHDOWN)

    @cached_property
    def flights(self) -> "Table":
        """The flights of the samples that leave, to the next impact (docs/flights.md)."""
        columns = (*_PLACES, "facet")
        return self._table("flight", self._rows("flights.csv", columns), columns, FLIGHT)

    @cached_property
    def flight_paths(self) -> "tuple[NDArray[np.float64], tuple[str, ...]]":
        """Places on the first flights' ways [m], shape [path_count, place_count, 3], body-fixed; how each ended."""
        import h5py

        path = self._file("flight_paths.h5")
        with reading(path, self.remedy), h5py.File(path, "r") as file:
            return file["position"][:], tuple(map(str, file.attrs["status"]))

    @cached_property
    def flight_path_times(self) -> "tuple[NDArray[np.float64], NDArray[np.int64]]":
        """Times since the start of each flight at the places of flight_paths [s], shape [path_count, place_count], and
        the number of the sample or journey that each is of, shape [path_count]."""
        import h5py

        path = self._file("flight_paths.h5")
        with reading(path, self.remedy), h5py.File(path, "r") as file:
            return file["time"][:], file["sample"][:]

    @cached_property
    def rest(self) -> "Table":
        """Where samples end after all bounces, on each ground (docs/flights.md)."""
        columns = ("ground", *_PLACES)
        return self._table("journey", self._rows("rest.csv", columns), columns, FLIGHT)

    @cached_property
    def journeys(self) -> "Table":
        """Each lander from its delivery to rest: how, when and where its journey ended (docs/journeys.md)."""
        return self._table("journey", self._journey_rows(JOURNEYS, NEEDED), tuple(JOURNEY), JOURNEY)

    @cached_property
    def touchdowns(self) -> "Table":
        """Every landing of the journeys: number, state in, state out, bed, soil and cost (docs/journeys.md)."""
        columns = tuple(JOURNEY_TOUCHDOWN)
        rows = self._journey_rows(TOUCHDOWNS, columns)
        columns += tuple(SOIL) if "soil" in self.study else ()
        joined = joined_touchdowns(rows, self._rows(TOUCHDOWN_RUNS, _RUN), self.ledger)
        known = RUN | TOUCHDOWN | JOURNEY_TOUCHDOWN | SOIL | TOUCHDOWN_COST
        return self._table("touchdown", joined, columns, known)

    def journey(self, number: int) -> "StudyJourney":
        """One journey: its touchdowns, each of which it makes again, and its end.

        number: of the table `journeys`, from 0. Raises ValueError for one that there is not.
        """
        from lithobrake.results.journey_again import StudyJourney, track_of

        count = self.journeys.row_count
        if not 0 <= number < count:
            raise ValueError(f"journey is {number}; allowed: 0 to {count - 1}, the journeys of {self.folder}")
        # Journeys are numbered as their rows.
        row = {name: self.journeys[name][number] for name in self.journeys}
        touchdowns = self.touchdowns.where(self.touchdowns["journey"] == number)
        track = track_of(row, touchdowns, self.results.site, self.body_shape[0])
        return StudyJourney(track, touchdowns, self.landing, self.landing_bodies)

    def _journey_rows(self, name: str, columns: Sequence[str]) -> list[dict[str, Any]]:
        """The rows of a table of journeys. Raises ValueError for a study that has none."""
        made = self._noted_files()
        if made and JOURNEYS not in made:
            raise ValueError(f"{self.folder} has no journeys of landings: its study file lacks the table [journey]")
        return self._rows(name, columns)

    @cached_property
    def arcs(self) -> "Table":
        """Each flight between impacts: of every journey of landings, or of the first samples that were followed."""
        return self._table("arc", self._rows("arcs.csv", tuple(ARC)), tuple(ARC), ARC)

    @cached_property
    def beds(self) -> "Table":
        """Numbers of each bed; a study whose touchdowns are made by its own program has none."""
        with reading(self.folder / "summary.json", self.remedy):
            beds: list[dict[str, Any]] = self.summary["results"]["beds"]
            columns = {name: [bed[name] for bed in beds] for name in (beds[0] if beds else ())}
        return self._described("bed", columns, BEDS)

    def bed_bodies(self, number: int = 0) -> "MovingBodies":
        """The grains of a bed, and how they were poured and settled."""
        return self._bodies(f"beds/bed_{number}.h5")

    @cached_property
    def median_landing(self) -> "MovingBodies":
        """The landing at the medians, or in a drawn study that with the median speed of the runs that leave.

        Until all runs of a drawn study have ended, its first. Grains and, as the last body, the lander.
        """
        told = (self.folder / "telling_landing.h5").is_file()
        return self._bodies("telling_landing.h5" if told else "landing.h5")

    def landing(
        self,
        run: str | int,
        *,
        frame_count: int = 120,
        progress: Callable[[float, str], None] = lambda fraction, what: None,
    ) -> "Outcome":
        """A touchdown of the study made once more, with its frames; nothing is written.

        run: its row in `runs`, or its key there, or how that begins. progress: called with the fraction that is done
        of what is being done.
        Raises ValueError for a run that is none of the study or has no outcome, a program of the user's own, other
        code than made the run, and where what comes out is not, bit for bit, what the ledger has.
        """
        from lithobrake.results.landing_again import land_again

        return land_again(self.folder, self._record(run), frame_count, progress)

    def landing_bodies(
        self,
        run: str | int,
        *,
        frame_count: int = 120,
        progress: Callable[[float, str], None] = lambda fraction, what: None,
    ) -> "MovingBodies":
        """The hulls of a touchdown made once more, and how they moved, the lander last; see landing()."""
        from lithobrake.results.landing_again import bodies_again

        return bodies_again(self.folder, self._record(run), frame_count, progress)

    def _record(self, run: str | int) -> "Record":
        """The row of the ledger of a run. Raises ValueError where there is none."""
        key = self._key(run)
        record = next((one for one in self.ledger if one.key == key), None)
        if record is None:
            raise ValueError(f"{self.folder / 'runs.sqlite'} lacks run {key}; {self.remedy}")
        return record

    @cached_property
    def body_shape(self) -> "tuple[NDArray[np.float64], NDArray[np.int64]]":
        """Vertices of the body [m], shape [vertex_count, 3], body-fixed, and its faces, from 0, [face_count, 3]."""
        import numpy as np

        path = self._file("body.obj")
        with reading(path, self.remedy):
            lines = [words for line in path.read_text(encoding="utf-8").splitlines() if (words := line.split())]
            vertices = np.array([[float(word) for word in words[1:4]] for words in lines if words[0] == "v"])
            faces = np.array([[int(word) - 1 for word in words[1:4]] for words in lines if words[0] == "f"])
            if vertices.ndim != 2 or faces.ndim != 2 or not 0 <= faces.min() <= faces.max() < len(vertices):
                raise ValueError("it has no vertices, or faces without them")
        return vertices, faces

    @cached_property
    def surrogate(self) -> "NamedSurrogate":
        """The refined expansion, called by the names of its inputs; a drawn study has an `emulator` in its place."""
        from lithobrake.results.named_surrogate import NamedSurrogate

        self._refuse_drawn("surrogate", "an expansion")
        path = self._file("refined.json")
        with reading(path, self.remedy):
            return NamedSurrogate.read(path)

    @cached_property
    def emulator(self) -> "NamedEmulator":
        """The emulator of a drawn study, sampled by the names of its inputs, also at values that were not simulated.

        Of a study of journeys that of all their touchdowns. Raises ValueError where these have none.
        """
        from lithobrake.emulator import load
        from lithobrake.results.named_emulator import NamedEmulator

        is_of_journeys = (self.folder / JOURNEYS).is_file()
        path = self._file("touchdown_emulator.json" if is_of_journeys else "emulator.json")
        explorer = self.touchdown_explorer if is_of_journeys else None
        if is_of_journeys and explorer is None:
            raise ValueError(f"{self.folder} has no emulator: {self.summary['results']['emulated']['why']}")
        with reading(path, self.remedy):
            if explorer is not None:
                return NamedEmulator(load(path), self._units, lambda: explorer.bound, explorer.attitude)
            return NamedEmulator(load(path), self._units, lambda: self.explorer.bound)

    @cached_property
    def explorer(self) -> "ExplorerTables":
        """The refits of the emulator or expansion as plain tables, for programs in other languages."""
        from lithobrake.results.explorer_tables import ExplorerTables

        return ExplorerTables.read(self._file("explorer.h5"), self.remedy)

    @cached_property
    def touchdown_explorer(self) -> "ExplorerTables | None":
        """The same of the emulator of all touchdowns of journeys; None where they have none (results.emulated.why)."""
        from lithobrake.results.explorer_tables import ExplorerTables
        from lithobrake.results.summary import DrawnResults

        emulated = self.results.emulated if isinstance(self.results, DrawnResults) else None
        if emulated is not None and emulated.why is not None:
            return None
        return ExplorerTables.read(self._file("touchdown_explorer.h5"), self.remedy)

    @cached_property
    def run_flights(self) -> "Table":
        """How the flights of each run of a drawn study ended, from many sites, and which share of them returns."""
        return self._table("run", self._rows("run_flights.csv", ("run", *_RUN)), ("run", *_RUN), RUN | FLIGHT)

    @cached_property
    def plot(self) -> "StudyPlots":
        """Figures one by one, on axes of matplotlib: `plot.map()`, `plot.ends(ax=axes)`, `plot.variance()` and others.

        Needs a study that has run to its end.
        """
        from lithobrake.report.study_plots import StudyPlots

        return StudyPlots(self)

    def _refuse_drawn(self, name: str, what: str) -> None:
        """Say that a study whose runs were drawn has no such thing, where this is one."""
        if (self.folder / "emulator.json").is_file() and not (self.folder / "refined.json").is_file():
            raise ValueError(f"{self.folder} is of a drawn study, without {what}: ask for emulator, not {name}")

    @cached_property
    def _units(self) -> dict[str, str]:
        from lithobrake.study.units import input_units

        return input_units()

    def _designs(self) -> dict[str, str]:
        """The files of the study's designs, by their names; a folder may also have those of an earlier method."""
        found = {design: f"designs/{design}.csv" for design in (*PAPER_DESIGNS, *DRAWN_DESIGNS, JOURNEY_DESIGN)}
        # An early format notes no stages, and knows of one method only.
        asked = self._noted_files()
        found = {design: name for design, name in found.items() if name in asked or not asked}
        return {design: name for design, name in found.items() if (self.folder / name).is_file()}

    def _noted_files(self) -> set[str]:
        """The files that the stages of the study make; none where the folder does not note them."""
        if not (self.folder / KEYS).is_file():
            return set()
        noted = read_json(self.folder / KEYS, dict, self.remedy)
        with reading(self.folder / KEYS, self.remedy):
            return {file for stage in noted.get("stages", {}).values() for file in stage["files"]}

    def _key(self, run: str | int) -> str:
        """The key of a run of the study. Raises ValueError where it has none, or several that begin like that."""
        keys = [str(key) for key in self.runs["key"]]
        found = [key for row, key in enumerate(keys) if (key.startswith(run) if isinstance(run, str) else row == run)]
        if len(found) != 1:
            raise ValueError(
                f"run is {run!r}, which {len(found) or 'none'} of the {len(keys)} runs of {self.folder} have; "
                "give a row of its table `runs`, from 0, or how the key of one run begins"
            )
        return found[0]

    def _file(self, name: str) -> Path:
        """The path of a file of the folder, there or not.

        Raises ValueError for one that changed after it was made, and for one of samples where landings were followed.
        """
        if name in OF_SAMPLES and not (self.folder / name).is_file() and (self.folder / JOURNEYS).is_file():
            raise ValueError(
                f"{self.folder} has journeys of landings, and no samples of an emulator: ask for journeys or touchdowns"
            )
        return intact_file(self.folder, name, self.remedy)

    def _bodies(self, name: str) -> "MovingBodies":
        from lithobrake.results.moving_bodies import MovingBodies

        path, made = self._file(name), self._noted_files()
        if made and name not in made and not path.exists():
            beds = sum(file.startswith("beds/") for file in made)
            reason = (
                f"its beds have the numbers 0 to {beds - 1}"
                if beds
                else "a program or function of its own makes its touchdowns; ask that program for its frames"
            )
            raise ValueError(f"{path} is not there, and no stage of this study makes it: {reason}")
        return MovingBodies.read(path, self.remedy)

    def _rows(self, name: str, columns: Sequence[str]) -> list[dict[str, Any]]:
        """The rows of a CSV file, numbers as numbers; columns: that it has to have."""
        path = self._file(name)
        with reading(path, self.remedy):
            return [
                {title: cell if title in _WORDS else float(cell or "nan") for title, cell in row.items()}
                for row in read_rows(path, columns, self.remedy)
            ]

    def _table(
        self, row: str, rows: Sequence[Mapping[str, Any]], first: Sequence[str], known: Mapping[str, Quantity]
    ) -> "Table":
        """A table of rows by title; a row that lacks a number has none there. first: columns that it has at least."""
        absent = {title: "" if title in _WORDS else math.nan for title in (*first, *(t for one in rows for t in one))}
        names = {title: title.removeprefix("input:").removeprefix("output:") for title in absent}
        columns = {names[title]: [one.get(title, none) for one in rows] for title, none in absent.items()}
        return self._described(row, columns, known)

    def _described(self, row: str, columns: Mapping[str, Any], known: Mapping[str, Quantity]) -> "Table":
        from lithobrake.results.table import Table

        return Table.of(row, {name: (quantity(name, known, self._units), values) for name, values in columns.items()})

    def __repr__(self) -> str:
        """Say where they are, and the answer."""
        answer = "not at its end"
        if (self.folder / "summary.json").is_file():
            # A notebook shows this unasked, whatever has become of the summary.
            given = self.summary.get("results")
            sentences = given.get("answer") if isinstance(given, dict) else None
            answer = sentences[0] if isinstance(sentences, list) and sentences else "no answer in the summary"
        return in_lines(f"StudyResults of {self.folder}: {answer}", "  ")

    def _repr_html_(self) -> str:
        """The most telling numbers, and what can be asked for, for a notebook."""
        return _html(self)


def _html(results: StudyResults) -> str:
    """What came out, and what can be asked for."""
    from html import escape

    from lithobrake.vocabulary.html_table import html_table

    rows = [(name, what) for name, (file, what) in _ASKED.items() if any(results.folder.glob(file))]
    table = html_table(f"Results of {results.folder}", ("ask for", "and get"), rows)
    if not (results.folder / "summary.json").is_file():
        return f"{table}<p>Not at its end: lithobrake status {escape(shlex.quote(str(results.folder)))}</p>"
    sentences = "".join(f"<li>{escape(sentence)}</li>" for sentence in results.headline)
    return f"<ul>{sentences}</ul>{table}"


def open_study(folder: str | os.PathLike[str]) -> StudyResults:
    """The results of a study's folder, for reading only. Raises ValueError when it is none."""
    return StudyResults(folder)
