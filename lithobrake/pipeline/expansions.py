"""Designs, their runs, and the expansions fitted to them: all inputs first, then those that matter."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING, Any

import numpy as np

from lithobrake.campaign import Runs, missing
from lithobrake.outputs import OUTPUTS
from lithobrake.pipeline.folder import json_hash
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.site import gravity_warning
from lithobrake.pipeline.surface import touchdown_reads
from lithobrake.pipeline.touchdowns import drawn_reads, drawn_rows, touchdown_keys, touchdowns
from lithobrake.study import Study
from lithobrake.study.quantity import uncertain

if TYPE_CHECKING:
    from lithobrake.chaos import Distribution, Surrogate

DESIGNS = ("screening", "refined", "test_kept", "test_all")


@dataclass(frozen=True)
class DesignRuns:
    """The runs of one design: x in the file's units, shape [run_count, input_count], all uncertain inputs in order."""

    input_names: tuple[str, ...]
    x: np.ndarray
    runs: Runs

    @property
    def y(self) -> np.ndarray:
        """Fitted outputs, shape [run_count, output_count]; a row of NaN where the lander did not leave."""
        y, clear = self.runs.outputs(OUTPUTS), np.array(self.runs.outcomes) == "clear"
        return np.where((clear & ~np.isnan(y).any(axis=1))[:, None], y, np.nan)

    @property
    def has_outputs(self) -> np.ndarray:
        """Which runs have outputs, shape [run_count]."""
        return np.isfinite(self.y).all(axis=1)

    def columns(self, names: Sequence[str]) -> np.ndarray:
        """The columns of x of these inputs, shape [run_count, len(names)]."""
        return self.x[:, [self.input_names.index(name) for name in names]]

    def outcome_counts(self) -> dict[str, int]:
        """How often each outcome came, by name in the order of the alphabet."""
        return {name: self.runs.outcomes.count(name) for name in sorted(set(self.runs.outcomes))}


def design_inputs(study: Study) -> "dict[str, Distribution]":
    """The uncertain inputs of the touchdown with their distributions, in the order of the file's sections."""
    return {name: value.to_chaos() for name, value in uncertain(study.touchdown_values()).items()}


def design_reads(study: Study) -> dict[str, Any]:
    """What the runs of any design depend on."""
    values = study.touchdown_values()
    fixed = {name: value for name, value in values.items() if name not in uncertain(values)}
    inputs = {name: distribution.to_json() for name, distribution in design_inputs(study).items()}
    return {"touchdown": touchdown_reads(study), "drawn": drawn_reads(study), "fixed": fixed, "inputs": inputs}


def kept_inputs(study: Study, screening: "Surrogate") -> tuple[str, ...]:
    """The smallest set of inputs that together explain the asked share of every deciding output.

    Among sets of one size the one whose weakest output is explained best is taken; the first in order breaks a tie.
    """
    columns = [screening.output_names.index(name) for name in study.design.kept_outputs]
    for size in range(1, len(screening.input_names) + 1):
        groups = list(combinations(screening.input_names, size))
        shares = [min(np.asarray(screening.sobol_group(group))[columns]) for group in groups]
        best = int(np.argmax(shares))
        # All inputs together explain everything, but for rounding.
        if shares[best] >= study.design.kept_share or size == len(screening.input_names):
            return groups[best]
    raise AssertionError("a design has at least one input")


def points(study: Study, design: str, kept: Sequence[str]) -> np.ndarray:
    """The points of a design, shape [point_count, input_count]; inputs that do not vary are at their median."""
    from lithobrake.analysis import sample_inputs

    inputs = design_inputs(study)
    varied = inputs if design in ("screening", "test_all") else {name: inputs[name] for name in kept}
    seed = int(json_hash([study.seed, design])[:12], 16)
    if design.startswith("test"):
        x = sample_inputs(varied, study.design.test_count, seed=seed)
    else:
        x = _training_points(study, design, varied, seed)
    full = np.tile([distribution.median for distribution in inputs.values()], (len(x), 1))
    full[:, [list(inputs).index(name) for name in varied]] = x
    return full


def _training_points(study: Study, design: str, varied: "dict[str, Distribution]", seed: int) -> np.ndarray:
    """The points of a design to which an expansion is fitted, [point_count, len(varied)]."""
    from lithobrake.chaos import fekete, latin_hypercube, smolyak, sobol_sequence

    section = study.design
    if section.method == "smolyak":
        return smolyak(varied, level=getattr(section, f"{design}_level"))
    count = getattr(section, f"{design}_count")
    if section.method == "fekete":
        return fekete(varied, count, seed, degree=getattr(section, f"{design}_degree"))
    return (sobol_sequence if section.method == "sobol_sequence" else latin_hypercube)(varied, count, seed)


def replicate_count(study: Study, design: str) -> int:
    """Runs at every point of a design; the test sets have one."""
    return 1 if design.startswith("test") else study.design.replicate_count


def design_runs(job: Job, design: str, kept: Sequence[str] = ()) -> DesignRuns:
    """Make the runs of a design, all points once, then again if asked; those that the ledger has are read from it.

    Which runs they are is noted before they are made, so that whoever looks can tell them from all others.
    """
    inputs, x = tuple(design_inputs(job.study)), points(job.study, design, kept)
    count, title = replicate_count(job.study, design), f"{design.replace('_', ' ')} runs"
    titles = [f"{title}, {number} of {count} times" if count > 1 else title for number in range(1, count + 1)]
    rows = [drawn_rows(job.study, inputs, x, replicate) for replicate in range(count)]
    keys = [key for replicate, one in enumerate(rows) for key in touchdown_keys(job.study, one, replicate)]
    job.folder.note_runs(design, keys)
    runs = [touchdowns(job, rows[replicate], words, replicate) for replicate, words in enumerate(titles)]
    records = [record for one in runs for record in one.records]
    return DesignRuns(inputs, np.tile(x, (count, 1)), Runs(records, sum(one.reused_count for one in runs)))


def account(job: Job, design: str, runs: DesignRuns) -> None:
    """Say what of a design was known before, and what is missing. Raises ValueError when too much is."""
    name, distinct = design.replace("_", " "), len({record.key for record in runs.runs.records})
    if runs.runs.reused_count:
        job.say(f"{name}: {runs.runs.reused_count} of {distinct} runs were known and are reused")
    lost = missing(runs.x, runs.runs.reasons, runs.input_names, job.study.campaign.failed_share)
    if lost:
        job.say(f"{name}: {lost}")


def fit_screening(job: Job) -> None:
    """Run the screening design and fit all inputs at medium order."""
    # Said before the landings are made, as it may be a reason not to make them.
    warning = gravity_warning(job.study)
    if warning:
        job.say(warning)
    design = design_runs(job, "screening")
    account(job, "screening", design)
    _fit(job, "screening", design, list(design_inputs(job.study))).save(job.folder / "screening.json")


def fit_refined(job: Job) -> None:
    """Choose the inputs that matter, run the refined design and fit them at higher order."""
    from lithobrake.chaos import load

    job.progress(0, 1, "inputs that matter")
    kept = kept_inputs(job.study, load(job.folder / "screening.json"))
    design = design_runs(job, "refined", kept)
    account(job, "refined", design)
    _fit(job, "refined", design, kept).save(job.folder / "refined.json")


def _fit(job: Job, design: str, runs: DesignRuns, names: Sequence[str]) -> "Surrogate":
    """The expansion of the runs that have outputs. Raises ValueError, with the outcomes, when they are too few."""
    from lithobrake.chaos import fit, term_count

    study, found = job.study, int(runs.has_outputs.sum())
    degree = getattr(study.design, f"{design}_degree")
    least_squares = study.design.fit == "ols"
    terms = term_count(len(names), degree) if least_squares else 1
    if found < terms:
        counts = ", ".join(f"{count} {name}" for name, count in runs.outcome_counts().items())
        reason = next((f"; the first failure: {record.reason}" for record in runs.runs.records if record.reason), "")
        measure = "level" if study.design.method == "smolyak" else "count"
        raise ValueError(
            f"of {len(runs.x)} {design} runs {found} have outputs ({counts}), fewer than the {terms} terms that are "
            f"fitted; raise design.{design}_{measure}, lower design.{design}_degree, or choose an impact that rebounds"
            f"{reason}"
        )
    inputs, what = design_inputs(study), f"{design} fit, outputs"
    job.progress(0, len(OUTPUTS), what)
    chosen = {name: inputs[name] for name in names}
    method = None if study.design.fit == "best" else study.design.fit
    return fit(
        chosen,
        runs.columns(names),
        runs.y,
        degree if least_squares else None,
        method,
        output_names=OUTPUTS,
        progress=lambda done, total: job.progress(done, total, what),
    )


def score_all(job: Job) -> None:
    """Make the test runs and score both expansions on what they have seen and on what they have not."""
    from lithobrake.chaos import load

    screening, refined = load(job.folder / "screening.json"), load(job.folder / "refined.json")
    kept = refined.input_names
    runs = {design: design_runs(job, design, kept) for design in DESIGNS}
    for design in ("test_kept", "test_all"):
        account(job, design, runs[design])
    job.progress(0, 1, "scores with their intervals")
    scores = {design: _score(screening if design == "screening" else refined, runs[design]) for design in DESIGNS}
    scores["test_screening"] = _score(screening, runs["test_all"])
    job.folder.write_json("scores.json", scores)


def _score(surrogate: "Surrogate", design: DesignRuns) -> dict[str, Any]:
    """Scores by output on the runs that have outputs, with 95 % intervals; null where not finite.

    Raises ValueError for no runs.
    """
    from lithobrake.chaos import score_intervals

    known = design.has_outputs
    if not known.any():
        raise ValueError("no test run has outputs (see runs.sqlite); choose an impact that rebounds")
    x, y = design.columns(surrogate.input_names)[known], design.y[known]
    scores = surrogate.score(x, y)
    for output, intervals in score_intervals(surrogate, x, y).items():
        scores[output] |= {f"{key}_interval": list(interval) for key, interval in intervals.items()}
    return {output: {key: _finite(value) for key, value in score.items()} for output, score in scores.items()}


def _finite(value: Any) -> Any:
    if isinstance(value, list):
        return [_finite(entry) for entry in value]
    return float(value) if np.isfinite(value) else None
