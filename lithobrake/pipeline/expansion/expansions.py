"""The expansions of a study: their designs, the runs of these, their fit, and their scores."""

from collections.abc import Sequence
from itertools import combinations
from typing import TYPE_CHECKING, Any

import numpy as np

from lithobrake.files.reading import hashed_seed
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.landings import drawn_rows, make_rows, say_gravity
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.study import Study
from lithobrake.study.design_sections import ExpansionSection
from lithobrake.vocabulary.file_names import REFINED_FILE, SCORES_FILE, SCREENING_FILE
from lithobrake.vocabulary.quantities import OUTPUTS, PAPER_DESIGNS

if TYPE_CHECKING:
    from lithobrake.chaos import Distribution, Surrogate


def section_of(study: Study) -> ExpansionSection:
    """[expansion] of a study that has one."""
    assert study.expansion is not None
    return study.expansion


def kept_inputs(study: Study, screening: "Surrogate") -> tuple[str, ...]:
    """The smallest set of inputs that together explain the asked share of every deciding output.

    Among sets of one size the one whose weakest output is explained best is taken; the first in order breaks a tie.
    """
    section = section_of(study)
    columns = [screening.output_names.index(name) for name in section.kept_outputs]
    for size in range(1, len(screening.input_names) + 1):
        groups = list(combinations(screening.input_names, size))
        shares = [min(np.asarray(screening.sobol_group(group))[columns]) for group in groups]
        best = int(np.argmax(shares))
        # All inputs together explain everything, but for rounding.
        if shares[best] >= section.kept_share or size == len(screening.input_names):
            return groups[best]
    raise AssertionError("a design has at least one input")


def points(drawn: DrawnDesign, design: str, kept: Sequence[str]) -> np.ndarray:
    """The points of a design, shape [point_count, input_count]; inputs that do not vary are at their median."""
    from lithobrake.analysis import sample_inputs

    study, inputs = drawn.study, drawn.inputs
    varied = inputs if design in ("screening", "test_all") else {name: inputs[name] for name in kept}
    # Of its own for each design, so that test points are independent of training points.
    seed = hashed_seed(study.seed, design)
    if design.startswith("test"):
        x = sample_inputs(varied, section_of(study).test_count, seed=seed)
    else:
        x = _training_points(study, design, varied, seed)
    # All inputs stand in every row, so that a run that two designs share has one key and is made once.
    full = np.tile([distribution.median for distribution in inputs.values()], (len(x), 1))
    full[:, [list(inputs).index(name) for name in varied]] = x
    return full


def _training_points(study: Study, design: str, varied: "dict[str, Distribution]", seed: int) -> np.ndarray:
    """The points of a design to which an expansion is fitted, [point_count, len(varied)]."""
    from lithobrake.chaos import fekete, latin_hypercube, smolyak, sobol_sequence

    section = section_of(study)
    if section.points == "smolyak":
        return smolyak(varied, level=getattr(section, f"{design}_level"))
    count = getattr(section, f"{design}_count")
    if section.points == "fekete":
        return fekete(varied, count, seed, degree=getattr(section, f"{design}_degree"))
    return (sobol_sequence if section.points == "sobol_sequence" else latin_hypercube)(varied, count, seed)


def replicate_count(study: Study, design: str) -> int:
    return 1 if design.startswith("test") else section_of(study).replicate_count


def runs_of_designs(job: Job) -> dict[str, DesignRuns]:
    """The runs of all designs, by their names."""
    return {design: DesignRuns.load(job.folder, design) for design in PAPER_DESIGNS}


def fit_screening(job: Job) -> None:
    runs = DesignRuns.load(job.folder, "screening")
    _fit(job, "screening", runs, list(job.design.inputs)).save(job.folder / SCREENING_FILE)


def fit_refined(job: Job) -> None:
    runs = DesignRuns.load(job.folder, "refined")
    _fit(job, "refined", runs, screened_inputs(job)).save(job.folder / REFINED_FILE)


def screened_inputs(job: Job) -> tuple[str, ...]:
    from lithobrake.chaos import load

    return kept_inputs(job.study, load(job.folder / SCREENING_FILE))


def _fit(job: Job, design: str, runs: DesignRuns, names: Sequence[str]) -> "Surrogate":
    """The expansion of the runs that have outputs. Raises ValueError, with the outcomes, when they are too few."""
    from lithobrake.chaos import fit, term_count

    section, found = section_of(job.study), int(runs.has_outputs.sum())
    degree = getattr(section, f"{design}_degree")
    least_squares = section.fit == "ols"
    # The sparse fits choose as many terms as their runs support.
    terms = term_count(len(names), degree) if least_squares else 1
    if found < terms:
        counts = ", ".join(f"{count} {name}" for name, count in runs.outcome_counts().items())
        reason = next((f"; the first failure: {reason}" for reason in runs.reasons if reason), "")
        measure = "level" if section.points == "smolyak" else "count"
        raise ValueError(
            f"of {runs.run_count} {design} runs {found} have outputs ({counts}), fewer than the {terms} terms that are "
            f"fitted; raise expansion.{design}_{measure}, lower expansion.{design}_degree, or choose an impact that "
            f"rebounds{reason}"
        )
    inputs, what = job.design.inputs, f"{design} fit, outputs"
    job.progress(0, len(OUTPUTS), what)
    chosen = {name: inputs[name] for name in names}
    method = None if section.fit == "best" else section.fit
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
    from lithobrake.chaos import load

    screening, refined = load(job.folder / SCREENING_FILE), load(job.folder / REFINED_FILE)
    runs = runs_of_designs(job)
    job.progress(0, 1, "scores with their intervals")
    scores = {design: _score(screening if design == "screening" else refined, one) for design, one in runs.items()}
    scores["test_screening"] = _score(screening, runs["test_all"])
    job.folder.write_json(SCORES_FILE, scores)


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
    # JSON has neither NaN nor infinity, as Q2 may be of an output that does not vary.
    return float(value) if np.isfinite(value) else None


def make_screening_runs(job: Job) -> None:
    say_gravity(job)
    make_runs(job, "screening")


def make_refined_runs(job: Job) -> None:
    make_runs(job, "refined", screened_inputs(job))


def make_test_runs(job: Job) -> None:
    kept = screened_inputs(job)
    for design in ("test_kept", "test_all"):
        make_runs(job, design, kept)


def make_runs(job: Job, design: str, kept: Sequence[str] = ()) -> None:
    """Make the runs of a design, all points once, then again if asked; those that the ledger has are read from it.

    Which runs they are is noted before they are made, so that whoever looks can tell them from all others.
    Raises ValueError when too many have failed, or those that failed lie together.
    """
    x = points(job.design, design, kept)
    replicates = range(replicate_count(job.study, design))
    make_rows(job, design, [drawn_rows(job.design, x, replicate) for replicate in replicates])
