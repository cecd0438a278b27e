"""From bounces in a file to the soil of a study: its emulator turned round, and what a bounce could say at all."""

import math
import os
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from lithobrake import analysis
from lithobrake.files.atomic import write_json
from lithobrake.files.reading import DamagedFileError, read_json, read_table
from lithobrake.pipeline.design.dependencies import bed_files
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.first_touchdown.emulator import EMULATOR_FILE, SPEED, SPIN, over_attitudes, why_no_emulator
from lithobrake.pipeline.runs.energy_bound import across_of, energy_bound, height_of_beds
from lithobrake.pipeline.site import with_site_gravity
from lithobrake.pipeline.study_folder import REMEDY, FinishedFolder, StudyFolder
from lithobrake.study import Study
from lithobrake.study.units import conversion, input_units, run_units
from lithobrake.vocabulary.file_names import STUDY_FILE
from lithobrake.vocabulary.number_words import percent
from lithobrake.vocabulary.outcomes import TouchdownOutcome
from lithobrake.vocabulary.quantities import PURE

if TYPE_CHECKING:
    from lithobrake.emulator import Emulator

# Columns of standard deviations begin so; those of words.
ERROR, OUTCOME, BED = "error:", "outcome", "bed"
# Size of the change of velocity in the touchdown, which follows from impact and rebound and of which a record tells.
SPEED_CHANGE = "speed_change"
POSTERIOR, PICTURE = "posterior.json", "posterior.png"
# Points of the posterior that the file keeps and the picture draws.
DRAWN = 2000
# Outcomes of runs of which it is not known what became of them.
LOST = (TouchdownOutcome.LEFT_SIDEWAYS.value, TouchdownOutcome.TIME_LIMIT.value)
# What a bounce has of its own, whether known of it or not; all else is the soil and the lander of all bounces.
OWN = "impact."


def read_bounces(path: str | os.PathLike[str]) -> list[analysis.Observation]:
    """Read bounces, one a row, from a CSV file; an empty cell was not observed.

    Columns: outputs of the touchdown, `error:` and the name of one for its standard deviation, uncertain numbers of
    [impact] by dotted key where they are known, outcome, and bed, a word that bounces on one bed share. A unit in
    brackets behind a name is turned into that of the study; without one numbers are in that unit. Raises ValueError for
    what is no number, a unit of another quantity, two columns of one name, and no bounce.
    """
    table = read_table(path, (), "write a line of names, and a line for each bounce")
    factors = {name: _factor(path, name, unit) for name, unit in table.units.items()}
    found = [_bounce(path, number, row, factors) for number, row in enumerate(table.rows, start=1)]
    if not found:
        raise ValueError(f"{path} has no bounce; write one a line below the line of names")
    return found


def _factor(path: str | os.PathLike[str], name: str, unit: str) -> float:
    """What the numbers of a column are multiplied by, to be in the unit of the study."""
    own = (run_units() | {OUTCOME: PURE, BED: PURE, SPEED_CHANGE: "m/s"}).get(name.removeprefix(ERROR))
    if own is None:
        # The emulator refuses the name.
        return 1.0
    try:
        return conversion(unit, own)
    except ValueError as error:
        raise ValueError(f"{path} has {name} in the {error}; convert the column") from error


def _bounce(
    path: str | os.PathLike[str], number: int, row: Mapping[str, str], factors: Mapping[str, float]
) -> analysis.Observation:
    given: dict[str, float] = {}
    for name, text in row.items():
        if name not in (OUTCOME, BED) and text.strip():
            try:
                given[name] = float(text) * factors.get(name, 1.0)
            except ValueError as error:
                raise DamagedFileError(
                    f'{path} has "{text}" for {name} in row {number}; write a number, or nothing'
                ) from error
    outcome = (row.get(OUTCOME) or "").strip() or None
    if outcome not in (None, *TouchdownOutcome):
        raise ValueError(f'{path} has the outcome "{outcome}" in row {number}; allowed: {", ".join(TouchdownOutcome)}')
    errors = {name.removeprefix(ERROR): value for name, value in given.items() if name.startswith(ERROR)}
    # Inputs of a study have dotted names, outputs of a touchdown plain ones.
    known = {name: value for name, value in given.items() if "." in name and not name.startswith(ERROR)}
    outputs = {name: value for name, value in given.items() if name not in known and not name.startswith(ERROR)}
    return analysis.Observation(outputs, errors, known, outcome, (row.get(BED) or "").strip() or None)


@dataclass(frozen=True)
class ExpectedInput:
    """What is left of an input's standard deviation by number of bounces, and how many halve it; None: none does."""

    left_of_sd: Mapping[str, float]
    halved_by: float | None

    def words(self) -> str:
        after, count = self.left_of_sd.get("1"), self.halved_by
        first = "" if after is None else f"one bounce leaves {percent(after)} of its standard deviation; "
        return first + ("no number that was tried halves it" if count is None else f"{count:.0f} halve it")


@dataclass(frozen=True)
class ExpectedInference:
    """outputs: seen of each bounce; inputs: by dotted key. Without either, `why` says what is to be done first."""

    outputs: tuple[str, ...]
    inputs: Mapping[str, ExpectedInput]
    why: str | None = None

    def lines(self) -> list[str]:
        """All of it in words, which a person should read before any bounce is looked at."""
        if self.why is not None:
            return [f"Bounces: {self.why}."]
        first = f"Bounces with observed {', '.join(self.outputs)}, for an exact emulator:"
        return [first, *(f"  {name}: {one.words()}" for name, one in self.inputs.items())]


def _without_emulator(path: Path, study: Study) -> str:
    """What is wrong with a folder that has no emulator of first bounces."""
    lacks = f"{path} has no {EMULATOR_FILE}"
    if not study.design.run_count:
        return f"{lacks}, as its study draws no lander (design.run_count is 0); infer from one that draws some"
    return f"{lacks}; finish the study there with: lithobrake run STUDY.toml --out {path}"


@dataclass(frozen=True)
class InferredStudy:
    """A finished study and its emulator of the first touchdown."""

    study: Study
    folder: StudyFolder
    model: "Emulator"

    @classmethod
    def open(cls, path: Path) -> "InferredStudy":
        """Read a study's folder. Raises ValueError where it has no emulator, and for a file that was edited since."""
        from lithobrake.emulator import load

        folder = FinishedFolder(path)
        if not (path / STUDY_FILE).is_file():
            raise ValueError(f"{path} has no {EMULATOR_FILE}; run a study there first that draws landers")
        source = folder.source()
        if not (folder / EMULATOR_FILE).is_file():
            raise ValueError(_without_emulator(path, source.study))
        study = with_site_gravity(source.study)
        if study.ground is not None:
            raise ValueError(
                f"{path} has [ground], and bounces tell the soil of one ground; infer from a study of one ground, or "
                "give a first contact, one row, to a study of journeys to rest"
            )
        # The file does not say that a Python function made the touchdowns; then there are no beds.
        if not all((folder / name).is_file() for name in bed_files(study)):
            study = study.with_function("of the folder's runs")
        if why := why_no_emulator(folder.read_json(EMULATOR_FILE)):
            said = study.as_written("Raise design.run_count.")
            raise ValueError(f"{path} has no emulator of the first touchdown: {why} {said}")
        model = load(folder / EMULATOR_FILE)
        _refuse_unbounded(folder / EMULATOR_FILE, model)
        # No bounce that is seen tells its attitude, so each is averaged over those of the runs.
        return cls(study, folder, over_attitudes(model))

    @property
    def outputs(self) -> list[str]:
        """Outputs that may be observed: those that have a law of their own."""
        return [self.model.output_names[column] for column in self.model.runs.modelled]

    @property
    def of_each_bounce(self) -> list[str]:
        """Inputs that each bounce has of its own."""
        return [name for name in self.model.runs.inputs if name.startswith(OWN)]

    def bounds(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Bounds of the outputs at points [point_count, input_count]: what energy allows, where the runs keep to it."""
        runs = self.model.runs
        lower, upper = np.tile(runs.lower[0], (len(x), 1)), np.tile(runs.upper[0], (len(x), 1))
        speed, spin = (self.model.output_names.index(name) for name in (SPEED, SPIN))
        if np.isfinite(upper[0, speed]):
            design, height, across = self._ground
            bound = energy_bound(design, height, dict(zip(runs.inputs, x.T, strict=True)), len(x), across)
            upper[:, speed], upper[:, spin] = bound.speed, bound.spin()
        return lower, upper

    @cached_property
    def _ground(self) -> tuple[DrawnDesign, float, float | None]:
        """The design, the height of the highest bed and the longest way of a touchdown [m], None where none is told."""
        return DrawnDesign(self.study), height_of_beds(self.study, self.folder), across_of(self.study, self.folder)

    def plan(self) -> ExpectedInference:
        """What bounces of which all outputs are seen would say."""
        found = analysis.identifiability(self.model, self.outputs, own=self.of_each_bounce, bounds=self.bounds, seed=1)
        inputs = {
            name: ExpectedInput({str(count): left for count, left in one.sd_ratio.items()}, one.bounces)
            for name, one in found.items()
        }
        return ExpectedInference(tuple(self.outputs), inputs)

    def infer(self, bounces: Path) -> dict[str, Any]:
        """Infer the soil from the bounces of a CSV file; what posterior.json holds."""
        seen = read_bounces(bounces)
        known = {name for one in seen for name in one.known}
        if known - set(self.of_each_bounce):
            raise ValueError(
                f"{bounces} gives {sorted(known - set(self.of_each_bounce))[0]} of a bounce; allowed: "
                f"{', '.join(self.of_each_bounce) or 'none, as [impact] has no uncertain number'}"
            )
        # An input that one bounce leaves out is unknown of that bounce, so it is inferred for all.
        anew = [name for name in self.of_each_bounce if any(name not in one.known for one in seen)]
        # A lander that is observed has left no bed, and nothing cut it off.
        found = analysis.infer(self.model, seen, own=anew, bounds=self.bounds, seed=1, missing=LOST)
        return self._content(found, seen)

    def _content(self, found: analysis.Posterior, seen: list[analysis.Observation]) -> dict[str, Any]:
        units, points = input_units(), found.sample(DRAWN, seed=1)
        surprise = [
            analysis.predictive_p_value(self.model, found, one, bounds=self.bounds, seed=1) if one.outputs else None
            for one in seen
        ]
        return {
            "bounces": [
                {"outputs": dict(one.outputs), "known": dict(one.known), "outcome": one.outcome, "bed": one.bed}
                for one in seen
            ],
            "statement": found.statement(),
            "beds": analysis.beds_statement(self.model, seen),
            "level": analysis.LEVEL,
            "effective_count": found.effective_count,
            "is_reliable": found.is_reliable,
            "log_evidence": found.log_evidence,
            "missing": found.missing,
            "predictive_p_value": surprise,
            "inputs": {
                name: {
                    "unit": units.get(name, ""),
                    "before": [one.before.lower, one.before.value, one.before.upper],
                    "after": [one.after.lower, one.after.value, one.after.upper],
                    "sd_ratio": one.sd_ratio,
                    "information": one.information,
                    "prior": law.ppf((np.arange(DRAWN) + 0.5) / DRAWN).tolist(),
                    "points": values.tolist(),
                }
                for (name, law), one, values in zip(
                    found.inputs.items(), found.learnt().values(), points.T, strict=True
                )
            },
        }


def _refuse_unbounded(path: Path, model: "Emulator") -> None:
    """Raise ValueError for an emulator of before energy bounded speed and spin together: no bounds fit its runs."""
    upper = dict(zip(model.output_names, model.runs.upper[0].tolist(), strict=True))
    if math.isinf(upper[SPEED]) != math.isinf(upper[SPIN]):
        heading = read_json(path, {"format_version": int, "written_by": str}, REMEDY)
        raise ValueError(
            f"{path} has an emulator of an earlier version (format {heading['format_version']}, {heading['written_by']}"
            f"), which bounds only one of {SPEED} and {SPIN}, so that no bounce can be inferred from; {REMEDY}"
        )


def infer_study(folder: Path, bounces: Path) -> dict[str, Any]:
    """Infer the soil of a study from bounces and write posterior.json and a picture into its folder."""
    from lithobrake.report import write_corner

    content = InferredStudy.open(folder).infer(bounces)
    write_json(folder / POSTERIOR, content)
    write_corner(folder / POSTERIOR, folder / PICTURE)
    return content
