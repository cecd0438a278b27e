"""The results of a study, read from its folder as they are asked for."""

import os
import shlex
from functools import cached_property
from typing import TYPE_CHECKING, Any

from lithobrake.files.reading import NUMBER, read_json, reading
from lithobrake.results.study_files import JOURNEYS, TOUCHDOWNS
from lithobrake.results.study_tables import StudyTables
from lithobrake.vocabulary import file_names
from lithobrake.vocabulary.callbacks import Progress, silent
from lithobrake.vocabulary.plain_text import in_lines

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from lithobrake.campaign import Record
    from lithobrake.results.journey_track import StudyJourney
    from lithobrake.results.motions import MovingBodies
    from lithobrake.results.named_emulator import NamedEmulator, NamedSurrogate
    from lithobrake.results.questions import RareLimitState
    from lithobrake.results.summary import Results, Summary
    from lithobrake.results.table import ExplorerTables
    from lithobrake.touchdown import Outcome

_SCORE = {"ape": [NUMBER | None], "mape": NUMBER | None, "q2": NUMBER | None, "rmse": NUMBER, "std": NUMBER}

# What a notebook says can be asked for: the file that it takes, and what comes.
_ASKED = {
    "summary": (file_names.SUMMARY_FILE, "every number of the report"),
    "runs": (file_names.RUNS_FILE, "every touchdown: inputs, outcome, outputs"),
    "samples": (file_names.SAMPLES_FILE, "samples of the Monte Carlo"),
    "flights": (file_names.SAMPLE_FLIGHTS_FILE, "flights of the samples to their next impact"),
    "journeys": (JOURNEYS, "each lander from delivery to rest: end, time, place, contacts, side down"),
    "touchdowns": (TOUCHDOWNS, "every landing of the journeys: state in, state out, bed, soil, cost"),
    "rest": (file_names.REST_FILE, "where landers on other ground end"),
    "arcs": (file_names.ARCS_FILE, "each flight between impacts"),
    "emulator": ("*emulator.json", "samples of landings, at any inputs by their names"),
    "surrogate": (file_names.REFINED_FILE, "the refined expansion, by the names of its inputs"),
    "median_landing": (file_names.LANDING_FILE, "a landing with its frames"),
    "bed_bodies()": ("beds/bed_0.h5", "the grains of a bed, and how they settled"),
}


class StudyResults(StudyTables):
    """Results of a study: tables whose columns have units and meanings, the summary, emulator and figures.

    Nothing is written: it works on a folder that may only be read, on an archived copy, and beside a study that runs,
    as far as that has come. Whatever is asked for raises ValueError, with what to do, where its file is damaged, was
    edited after it was made, or is not there yet.
    """

    # What is light here stays light: a second terminal looks at a running study every few seconds.

    @cached_property
    def summary(self) -> "Summary":
        """summary.json by attribute: `study`, `results` and `provenance` (docs/summary.md has every key)."""
        from lithobrake.results.summary import Summary

        with reading(self.folder / file_names.SUMMARY_FILE, self.remedy):
            return Summary.of_json(self._content)

    @property
    def results(self) -> "Results":
        return self.summary.results

    @property
    def headline(self) -> list[str]:
        """The answer, and the most telling numbers behind it, each in a sentence."""
        with reading(self.folder / file_names.SUMMARY_FILE, self.remedy):
            return [str(sentence) for sentence in self._content["results"]["headline"]]

    @cached_property
    def scores(self) -> dict[str, dict[str, dict[str, Any]]]:
        """Errors of the expansions by set of runs and output (docs/summary.md), with those of single runs in "ape".

        Those of the emulator are in `emulator.model.scores`.
        """
        self._refuse_without_expansion("scores")
        content: dict[str, Any] = read_json(self._file(file_names.SCORES_FILE), {str: {str: _SCORE}}, self.remedy)
        return content

    @cached_property
    def rare(self) -> "dict[str, RareLimitState]":
        """What `lithobrake rare` found of each limit state it was asked for, by name (docs/reliability.md)."""
        from lithobrake.results.questions import RareLimitState
        from lithobrake.results.study_files import results_in

        remedy, found = "make it again with: lithobrake rare", {}
        for path in sorted(self.folder.glob("rare_*.json")):
            content = read_json(self._file(path.name), dict, remedy)
            with reading(path, remedy):
                found[path.stem.removeprefix("rare_")] = results_in(RareLimitState, content)
        return found

    def journey(self, number: int) -> "StudyJourney":
        """One journey: its touchdowns, each of which it makes again, and its end.

        number: of the table `journeys`, from 0. Raises ValueError for one that there is not.
        """
        from lithobrake.results.journey_track import StudyJourney, track_of

        count = self.journeys.row_count
        if not 0 <= number < count:
            raise ValueError(f"journey is {number}; allowed: 0 to {count - 1}, the journeys of {self.folder}")
        # Journeys are numbered as their rows.
        row = {name: self.journeys[name][number] for name in self.journeys}
        touchdowns = self.touchdowns.where(self.touchdowns["journey"] == number)
        arcs = self.arcs.where(self.arcs["sample"] == number)
        track = track_of(row, touchdowns, arcs, self.results.site, self.body_shape[0])
        return StudyJourney(track, touchdowns, self.landing, self.landing_bodies)

    def bed_bodies(self, number: int = 0) -> "MovingBodies":
        """The grains of a bed, and how they were poured and settled."""
        return self._bodies(f"beds/bed_{number}.h5")

    @cached_property
    def median_landing(self) -> "MovingBodies":
        """The first touchdown with the median speed of those that leave; before all have ended, the first one.

        At the medians where no lander is drawn. Grains and, as the last body, the lander.
        """
        told = (self.folder / file_names.TELLING_LANDING_FILE).is_file()
        return self._bodies(file_names.TELLING_LANDING_FILE if told else file_names.LANDING_FILE)

    def landing(
        self,
        run: str | int,
        *,
        frame_count: int = 120,
        progress: Progress = silent,
    ) -> "Outcome":
        """A touchdown of the study made once more, with its frames; nothing is written.

        run: its row in `runs`, or its key there, or how that begins. progress: called with the fraction that is done
        of what is being done.
        Raises ValueError for a run that is none of the study or has no outcome, a program of the user's own, other
        code than made the run, and where what comes out is not, bit for bit, what the ledger has.
        """
        from lithobrake.results.motions import land_again

        return land_again(self.folder, self._record(run), frame_count, progress)

    def landing_bodies(
        self,
        run: str | int,
        *,
        frame_count: int = 120,
        progress: Progress = silent,
    ) -> "MovingBodies":
        """The hulls of a touchdown made once more, and how they moved, the lander last; see landing()."""
        from lithobrake.results.motions import bodies_again

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

        path = self._file(file_names.BODY_FILE)
        with reading(path, self.remedy):
            lines = [words for line in path.read_text(encoding="utf-8").splitlines() if (words := line.split())]
            vertices = np.array([[float(word) for word in words[1:4]] for words in lines if words[0] == "v"])
            faces = np.array([[int(word) - 1 for word in words[1:4]] for words in lines if words[0] == "f"])
            if vertices.ndim != 2 or faces.ndim != 2 or not 0 <= faces.min() <= faces.max() < len(vertices):
                raise ValueError("it has no vertices, or faces without them")
        return vertices, faces

    @cached_property
    def surrogate(self) -> "NamedSurrogate":
        """The refined expansion, called by the names of its inputs."""
        from lithobrake.results.named_emulator import NamedSurrogate

        self._refuse_without_expansion("surrogate")
        path = self._file(file_names.REFINED_FILE)
        with reading(path, self.remedy):
            return NamedSurrogate.read(path)

    @cached_property
    def emulator(self) -> "NamedEmulator":
        """The emulator of all touchdowns, sampled by the names of its inputs, also at values that were not simulated.

        Of the first touchdown where the study has no emulator of all of them.
        Raises ValueError where it has neither.
        """
        from lithobrake.emulator import load
        from lithobrake.results.named_emulator import NamedEmulator

        explorer = self.touchdown_explorer
        path = self._file(file_names.EMULATOR_FILE if explorer is None else file_names.TOUCHDOWN_EMULATOR_FILE)
        why = read_json(path, dict, self.remedy).get("why")
        if why is not None:
            raise ValueError(f"{self.folder} has no emulator: {why}")
        with reading(path, self.remedy):
            if explorer is not None:
                return NamedEmulator(load(path), self._units, lambda: explorer.bound, explorer.attitude)
            # A study without samples has no tables, and an expansion's know no attitude.
            known = (self.folder / file_names.EXPLORER_FILE).is_file()
            attitude = self.explorer.attitude if known else None
            return NamedEmulator(load(path), self._units, lambda: self.explorer.bound, attitude)

    @cached_property
    def explorer(self) -> "ExplorerTables":
        """The refits of the emulator or expansion as plain tables, for programs in other languages."""
        from lithobrake.results.table import ExplorerTables

        return ExplorerTables.read(self._file(file_names.EXPLORER_FILE), self.remedy)

    @cached_property
    def touchdown_explorer(self) -> "ExplorerTables | None":
        """The same of the emulator of all touchdowns; None where there is none (results.emulated.why)."""
        from lithobrake.results.table import ExplorerTables

        name = file_names.TOUCHDOWN_EMULATOR_FILE
        # Not from the summary: a study that runs has an emulator before it has that.
        if not (self.folder / name).is_file() or "why" in read_json(self._file(name), dict, self.remedy):
            return None
        return ExplorerTables.read(self._file(file_names.TOUCHDOWN_EXPLORER_FILE), self.remedy)

    def _refuse_without_expansion(self, name: str) -> None:
        """Say that a study without expansions has no such thing, where this is one."""
        if (self.folder / file_names.EMULATOR_FILE).is_file() and not (self.folder / file_names.REFINED_FILE).is_file():
            raise ValueError(f"{self.folder} is of a study without [expansion]: ask for emulator, not {name}")

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

    def refuse_unknown_motion(self) -> None:
        """Raise ValueError where a program or function of the study's own makes the touchdowns."""
        made = self._noted_files()
        if made and not any(file.startswith("beds/") for file in made):
            raise ValueError(
                f"{self.folder} shows no motion: a program or function of the study's own makes its touchdowns; "
                "ask that program for its frames"
            )

    def _bodies(self, name: str) -> "MovingBodies":
        from lithobrake.results.motions import MovingBodies

        path, made = self._file(name), self._noted_files()
        if made and name not in made and not path.exists():
            self.refuse_unknown_motion()
            beds = sum(file.startswith("beds/") for file in made)
            raise ValueError(
                f"{path} is not there, and no stage of this study makes it: its beds have the numbers 0 to {beds - 1}"
            )
        return MovingBodies.read(path, self.remedy)

    def __repr__(self) -> str:
        """Say where they are, and the answer."""
        answer = "not at its end"
        if (self.folder / file_names.SUMMARY_FILE).is_file():
            # A notebook shows this unasked, whatever has become of the summary.
            given = self._content.get("results")
            sentences = given.get("answer") if isinstance(given, dict) else None
            answer = sentences[0] if isinstance(sentences, list) and sentences else "no answer in the summary"
        return in_lines(f"StudyResults of {self.folder}: {answer}", "  ")

    def _repr_html_(self) -> str:
        """The most telling numbers, and what can be asked for, for a notebook."""
        return _html(self)


def _html(results: StudyResults) -> str:
    """What came out, and what can be asked for."""
    from html import escape

    from lithobrake.vocabulary.plain_text import html_table

    rows = [(name, what) for name, (file, what) in _ASKED.items() if any(results.folder.glob(file))]
    table = html_table(f"Results of {results.folder}", ("ask for", "and get"), rows)
    if not (results.folder / file_names.SUMMARY_FILE).is_file():
        return f"{table}<p>Not at its end: lithobrake status {escape(shlex.quote(str(results.folder)))}</p>"
    sentences = "".join(f"<li>{escape(sentence)}</li>" for sentence in results.headline)
    return f"<ul>{sentences}</ul>{table}"


def open_study(folder: str | os.PathLike[str]) -> StudyResults:
    """The results of a study's folder, for reading only. Raises ValueError when it is none."""
    return StudyResults(folder)
