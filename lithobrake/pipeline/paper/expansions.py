"""The expansions of a study, fitted to its runs and scored on them: all inputs first, then those that matter."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from lithobrake.pipeline.job import Job
from lithobrake.pipeline.paper.paper_designs import kept_inputs
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.vocabulary.quantities import OUTPUTS, PAPER_DESIGNS

if TYPE_CHECKING:
    from lithobrake.chaos import Surrogate


def fit_screening(job: Job) -> None:
    """Fit all inputs at medium order."""
    runs = DesignRuns.load(job.folder, "screening")
    _fit(job, "screening", runs, list(job.design.inputs)).save(job.folder / "screening.json")


def fit_refined(job: Job) -> None:
    """Fit the inputs that matter at higher order."""
    runs = DesignRuns.load(job.folder, "refined")
    _fit(job, "refined", runs, screened_inputs(job)).save(job.folder / "refined.json")


def screened_inputs(job: Job) -> tuple[str, ...]:
    """The inputs that the screening keeps."""
    from lithobrake.chaos import load

    return kept_inputs(job.study, load(job.folder / "screening.json"))


def _fit(job: Job, design: str, runs: DesignRuns, names: Sequence[str]) -> "Surrogate":
    """The expansion of the runs that have outputs. Raises ValueError, with the outcomes, when they are too few."""
    from lithobrake.chaos import fit, term_count

    study, found = job.study, int(runs.has_outputs.sum())
    degree = getattr(study.design, f"{design}_degree")
    least_squares = study.design.fit == "ols"
    terms = term_count(len(names), degree) if least_squares else 1
    if found < terms:
        counts = ", ".join(f"{count} {name}" for name, count in runs.outcome_counts().items())
        reason = next((f"; the first failure: {reason}" for reason in runs.reasons if reason), "")
        measure = "level" if study.design.points == "smolyak" else "count"
        raise ValueError(
            f"of {runs.run_count} {design} runs {found} have outputs ({counts}), fewer than the {terms} terms that are "
            f"fitted; raise design.{design}_{measure}, lower design.{design}_degree, or choose an impact that rebounds"
            f"{reason}"
        )
    inputs, what = job.design.inputs, f"{design} fit, outputs"
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
    """Score both expansions on what they have seen and on what they have not."""
    from lithobrake.chaos import load

    screening, refined = load(job.folder / "screening.json"), load(job.folder / "refined.json")
    runs = {design: DesignRuns.load(job.folder, design) for design in PAPER_DESIGNS}
    job.progress(0, 1, "scores with their intervals")
    scores = {design: _score(screening if design == "screening" else refined, runs[design]) for design in PAPER_DESIGNS}
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
