"""From bounces in a file to the soil of a study: its emulator turned round, and what a bounce could say at all."""

import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from lithobrake.analysis import (
    LEVEL,
    Observation,
    Posterior,
    beds_statement,
    identifiability,
    infer,
    predictive_p_value,
)
from lithobrake.files.atomic import atomic_path
from lithobrake.files.reading import read_json
from lithobrake.pipeline.design.dependencies import bed_files
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.emulate.fitted_emulator import FILE as EMULATOR
from lithobrake.pipeline.emulate.fitted_emulator import SPEED, SPIN
from lithobrake.pipeline.folder.notes import REMEDY
from lithobrake.pipeline.folder.study_folder import StudyFolder
from lithobrake.pipeline.inference.bounce_table import read_bounces
from lithobrake.pipeline.inference.expected_inference import ExpectedInference, ExpectedInput
from lithobrake.pipeline.runs.energy_bound import energy_bound, height_of_beds
from lithobrake.pipeline.site import with_site_gravity
from lithobrake.results.intact import STUDY_FILE, intact_file
from lithobrake.study import Study, StudySource
from lithobrake.study.units import input_units

if TYPE_CHECKING:
    from lithobrake.emulator import Emulator

POSTERIOR, PICTURE = "posterior.json", "posterior.png"
# Points of the posterior that the file keeps and the picture draws.
DRAWN = 2000
# What a bounce has of its own, whether known of it or not; all else is the soil and the lander of all bounces.
OWN = "impact."


@dataclass(frozen=True)
class InferredStudy:
    """A study that ran, and its emulator."""

    study: Study
    folder: StudyFolder
    model: "Emulator"

    @classmethod
    def open(cls, path: Path) -> "InferredStudy":
        """Read a study's folder. Raises ValueError where it has no emulator, and for a file that was edited since."""
        from lithobrake.emulator import load

        folder = StudyFolder.only_read(path)
        if not (folder / EMULATOR).is_file():
            raise ValueError(f"{path} has no {EMULATOR}; run a drawn study there first (design.method = drawn)")
        source = StudySource.read(intact_file(path, STUDY_FILE, REMEDY))
        study = with_site_gravity(source.study, source.name)
        # The file does not say that a Python function made the touchdowns; then there are no beds.
        if not all(intact_file(path, name, REMEDY).is_file() for name in bed_files(study)):
            study = study.with_function("of the folder's runs")
        model = load(intact_file(path, EMULATOR, REMEDY))
        _refuse_unbounded(folder / EMULATOR, model)
        return cls(study, folder, model)

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
            design = DrawnDesign(self.study)
            height = height_of_beds(self.study, self.folder)
            bound = energy_bound(design, height, dict(zip(design.inputs, x.T, strict=True)), len(x))
            upper[:, speed], upper[:, spin] = bound.speed, bound.spin()
        return lower, upper

    def plan(self) -> ExpectedInference:
        """What bounces of which all outputs are seen would say."""
        found = identifiability(self.model, self.outputs, own=self.of_each_bounce, bounds=self.bounds, seed=1)
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
        anew = [name for name in self.of_each_bounce if any(name not in one.known for one in seen)]
        found = infer(self.model, seen, own=anew, bounds=self.bounds, seed=1)
        return self._content(found, seen)

    def _content(self, found: Posterior, seen: list[Observation]) -> dict[str, Any]:
        units, points = input_units(), found.sample(DRAWN, seed=1)
        surprise = [
            predictive_p_value(self.model, found, one, bounds=self.bounds, seed=1) if one.outputs else None
            for one in seen
        ]
        return {
            "bounces": [
                {"outputs": dict(one.outputs), "known": dict(one.known), "outcome": one.outcome, "bed": one.bed}
                for one in seen
            ],
            "statement": found.statement(),
            "beds": beds_statement(self.model, seen),
            "level": LEVEL,
            "effective_count": found.effective_count,
            "is_reliable": found.is_reliable,
            "log_evidence": found.log_evidence,
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
    with atomic_path(folder / POSTERIOR) as draft:
        draft.write_text(json.dumps(content, indent=2, allow_nan=False) + "\n", encoding="utf-8")
    write_corner(folder / POSTERIOR, folder / PICTURE)
    return content
