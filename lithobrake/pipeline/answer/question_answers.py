"""What the study file asks for: the probability of each limit state, and the best of its delivery options."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from lithobrake import analysis
from lithobrake.analysis.subset_simulation import limit_state_met
from lithobrake.files.reading import read_rows
from lithobrake.pipeline.answer.dispersion_statistics import NORMAL_QUANTILE_90
from lithobrake.pipeline.answer.emulated_ends import Refits, quantile_of_some, sample_fates
from lithobrake.pipeline.answer.run_answers import failing_runs, left_in_flight, why_no_interval
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.first_touchdown.flights import read_table
from lithobrake.pipeline.first_touchdown.run_flights import RunFlights
from lithobrake.pipeline.first_touchdown.samples import Samples
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.study_folder import AGAIN, StudyFolder
from lithobrake.results.questions import AimOnGround, AimResult, AimResults, BestAim, LimitStateInput, LimitStateResult
from lithobrake.results.run_results import CountedShare
from lithobrake.statements import limits
from lithobrake.statements.limits import FAR, options
from lithobrake.study import Study
from lithobrake.study.design_sections import AT_REST, SIDE, AimLimit
from lithobrake.study.lander_section import side_words
from lithobrake.study.units import input_units
from lithobrake.vocabulary import outcomes
from lithobrake.vocabulary.constants import REFIT_COUNT
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.file_names import AIM_FILE, SAMPLE_FLIGHTS_FILE
from lithobrake.vocabulary.limit_state import LimitState
from lithobrake.vocabulary.quantities import AIM_COLUMNS, PURE, UNKNOWN_END


def limit_state_results(job: Job, shares: Mapping[str, CountedShare]) -> dict[str, LimitStateResult]:
    """The results of every limit state of a study, by its name.

    shares: the table of how landings end (`run_shares`), from which a limit state of one of its words has its numbers.

    Raises ValueError for an output that no run has.
    """
    study, folder = job.study, job.folder
    conditions = study.limit_states.conditions()
    if not conditions:
        return {}
    runs, fates = DesignRuns.load(folder, "drawn"), RunFlights.load(folder, "drawn").fates
    of_samples = _values_of_samples(job)
    states = {name: LimitState.of(text) for name, text in conditions.items()}
    found = {}
    for name, state in states.items():
        one, of_word = _one(study, name, state, runs, fates, of_samples), _of_one_word(state, shares)
        if of_word is not None:
            one = replace(one, probability=of_word, runs=replace(one.runs, share=of_word))
        found[name] = replace(one, statement=limits.limit_state(name, one))
    return found


def _one(
    study: Study, name: str, state: LimitState, runs: DesignRuns, fates: np.ndarray, of_samples: dict[str, np.ndarray]
) -> LimitStateResult:
    """The results of one limit state, without its statement."""
    for output in state.outputs:
        if not np.isfinite(runs.output(output)).any():
            raise ValueError(
                f"limit_states.{name} uses {output}, which no run has; have the program that simulates the touchdowns "
                "return it, or leave the limit state out"
            )
    failing, inputs = failing_runs(state, runs, fates), DrawnDesign(study).lawful_inputs
    if not np.isfinite(failing).any():
        raise ValueError(
            f"limit_states.{name} is {state.text!r}, which cannot be decided for any run (runs.sqlite lists how each "
            "ended); choose another condition, or correct the outcomes"
        )
    x = runs.columns(list(inputs))
    found = analysis.failure_probability(
        failing,
        runs.inputs["bed"],
        terms=analysis.regression_terms(inputs, x),
        drawn=_drawn(state, of_samples),
        like_missing=left_in_flight(runs),
        why=why_no_interval(study),
    )
    several = len(np.unique(runs.inputs["bed"][np.isfinite(failing)])) > 1
    of_inputs = analysis.failure_inputs(inputs, x, failing, runs.inputs["bed"], study.seed) if several else {}
    return LimitStateResult(
        condition=state.text,
        probability=found.probability,
        source=found.source,
        runs=found.by_runs,
        emulator=found.by_emulator,
        tail_limit=found.tail_limit,
        why=found.by_runs.share.why_missing,
        failing_runs=float(np.nansum(failing)),
        inputs={key: LimitStateInput(**vars(one), found=one.found) for key, one in of_inputs.items()},
        statement="",
    )


def _of_one_word(state: LimitState, shares: Mapping[str, CountedShare]) -> Estimate | None:
    """Probability and bounds of a limit state that is a fate, or its opposite; None of another."""
    if state.outputs or len(state.fates) != 1:
        return None
    (word,) = state.fates
    one = shares[word].share
    so, otherwise = (
        limit_state_met(state, {outcomes.CAPTURED: np.full(1, end), word: np.full(1, end)})[0] for end in (1.0, 0.0)
    )
    if so == otherwise:
        return None
    if otherwise:
        lower, upper = (None if end is None else 1.0 - end for end in (one.upper, one.lower))
        return Estimate(1.0 - one.value, lower, upper)
    return one


def _values_of_samples(job: Job) -> dict[str, np.ndarray]:
    """What limit states may name, of the samples of the emulator up to the last that was looked at; empty without any.

    NaN where it is not known what became of a sample.
    """
    if not job.study.sample_count or job.study.expansion is not None:
        return {}
    samples, holds = Samples.load(job.folder), job.site.holds
    met = sample_fates(samples, read_table(job.folder, SAMPLE_FLIGHTS_FILE), holds=holds)
    total = len(met["returns"])
    known = ~met["missing"]
    words = {status.value: met[status] for status in outcomes.FlightStatus}
    captured = met[outcomes.SampleOutcome.CAPTURED]
    words |= {
        outcomes.RETURNS: met["returns"],
        outcomes.CAPTURED: captured,
        outcomes.SETTLED: captured & holds,
        outcomes.LOFTED: captured & (not holds),
    }
    values = {name: samples.output(name)[:total] for name in samples.output_names}
    return values | {word: np.where(known, one.astype(float), np.nan) for word, one in words.items()}


def _drawn(state: LimitState, values: dict[str, np.ndarray]) -> tuple[np.ndarray, np.ndarray] | None:
    """How many samples of each refit meet a limit state, and how many are known; None where the runs alone are asked.

    Of a fate alone the flights of the runs are an estimate already, that of results.shares. And the emulator samples no
    outputs of landers that are captured: where one decides, only the runs can tell.
    """
    if not state.outputs or any(name not in values for name in state.outputs):
        return None
    met, refit = limit_state_met(state, values), np.arange(len(values[outcomes.CAPTURED])) % REFIT_COUNT
    if np.isnan(met[values[outcomes.CAPTURED] == 1.0]).any():
        return None
    drawn = analysis.drawn_counts(met, refit, REFIT_COUNT)
    # Of so few samples no scatter between refits can be told.
    return drawn if drawn[1].min() >= 2 else None


# More options than these make no sentence.


@dataclass(frozen=True)
class OptionLanders:
    """Landers on one ground, [aim_count, lander_count]: how each ended, time [s] and way [m] to rest, its refit."""

    status: np.ndarray
    time: np.ndarray
    distance: np.ndarray
    refit: np.ndarray

    @property
    def settled(self) -> np.ndarray:
        """Which have come to rest where the ground holds them."""
        rests: np.ndarray = self.status == AT_REST
        return rests


def aim_results(study: Study, folder: StudyFolder, fitted: Refits) -> AimResults | None:
    """The results of every aim of a study on both grounds, and the best; None where it has no aims."""
    if not study.aim.names:
        return None
    aims, units = study.aim.aims(), {SIDE: "", **input_units()}
    limits = [limit for limit in map(AimLimit.of, study.aim.within) if limit]
    soil = _landers(folder, "soil", len(aims))
    on_soil, best_on_soil = _on_ground(soil, aims, limits, fitted, "soil")
    on_hard: Sequence[AimOnGround | None] = [None] * len(aims)
    best_on_hard: BestAim | None = None
    if study.hard_ground.count:
        on_hard, best_on_hard = _on_ground(_landers(folder, "hard", len(aims)), aims, limits, fitted, "hard")
    results = AimResults(
        names=study.aim.names,
        units=tuple(units[name].removeprefix(PURE) for name in study.aim.names),
        within=tuple(study.aim.within),
        lander_count=soil.status.shape[1],
        refit_count=REFIT_COUNT,
        level=analysis.LEVEL,
        why=fitted.why,
        aims=tuple(
            AimResult(tuple(aim.values()), *both)
            for aim, both in zip(aims, zip(on_soil, on_hard, strict=True), strict=True)
        ),
        best_on_soil=best_on_soil,
        best_on_hard=best_on_hard,
        statement="",
        sides=tuple(side_words(study.lander, side) for side in study.aim.sides),
    )
    return replace(results, statement=options(results))


def _landers(folder: StudyFolder, ground: str, aim_count: int) -> OptionLanders:
    """The landers on one ground."""
    rows = [row for row in read_rows(folder / AIM_FILE, AIM_COLUMNS, AGAIN) if row["ground"] == ground]
    shape = (aim_count, len(rows) // aim_count)
    numbers = ([float(row[name] or "nan") for row in rows] for name in ("time_s", "distance"))
    time, distance = (np.reshape(one, shape) for one in numbers)
    status = np.reshape(np.array([row["status"] for row in rows], dtype=object), shape)
    return OptionLanders(status, time, distance, np.reshape([int(row["refit"]) for row in rows], shape))


def _on_ground(
    landers: OptionLanders, aims: Sequence[dict[str, float]], limits: list[AimLimit], fitted: Refits, ground: str
) -> tuple[list[AimOnGround], BestAim | None]:
    """Every aim on one ground, and the best of those that keep all limits."""
    parts = [_of_aim(landers, row, ground, fitted) for row in range(len(aims))]
    parts = [replace(part, allowed=_keeps(limits, aim, part)) for aim, part in zip(aims, parts, strict=True)]
    return _best(landers, parts, fitted if ground == "soil" and fitted.why is None else None)


def _of_aim(landers: OptionLanders, row: int, ground: str, fitted: Refits) -> AimOnGround:
    """Shares and 95 % quantiles of one aim, with their intervals where there are any; not yet whether it is allowed."""
    settled, refit = landers.settled[row], landers.refit[row]

    def far(values: np.ndarray) -> Estimate | None:
        """Where most of those that settle lie, or when."""
        return quantile_of_some(values, settled, FAR, lambda met: _share(met, settled, refit, ground, fitted))

    return AimOnGround(
        settled=_share(settled, np.ones(len(settled), dtype=bool), refit, ground, fitted),
        missing=float((landers.status[row] == UNKNOWN_END).mean()),
        distance_p95=far(landers.distance[row]),
        time_p95=far(landers.time[row]),
        allowed=False,
    )


def _share(met: np.ndarray, of: np.ndarray, refit: np.ndarray, ground: str, fitted: Refits) -> Estimate:
    """Share of some landers that have met an event, with its bounds: over refits on soil, by their number on hard."""
    if ground == "hard":
        share = float(met.sum() / of.sum())
        return Estimate(share, *analysis.wilson_interval(int(met.sum()), int(of.sum()), NORMAL_QUANTILE_90))
    return fitted.share(met, of, refit)


def _keeps(limits: list[AimLimit], aim: dict[str, float], part: AimOnGround) -> bool:
    """Whether an aim and what comes of it keep all limits."""
    known: dict[str, float | None] = {name.partition(".")[2]: value for name, value in aim.items()}
    known |= {AT_REST: part.settled.value, "missing": part.missing}
    far = {"distance_p95": part.distance_p95, "time_p95": part.time_p95}
    known |= {name: None if one is None else one.value for name, one in far.items()}
    return all(limit.keeps(known[limit.name]) for limit in limits)


def _best(
    landers: OptionLanders, parts: list[AimOnGround], fitted: Refits | None
) -> tuple[list[AimOnGround], BestAim | None]:
    """The aims with their shares of refits, and that at which most landers settle, of those allowed.

    None where none is allowed, or nobody settles. fitted: None where refits tell nothing, as on hard ground; then
    there is no share of refits and no interval.
    """
    allowed = [part.allowed for part in parts]
    shares = np.where(allowed, [part.settled.value for part in parts], -1.0)
    if shares.max() <= 0.0:
        return parts, None
    if fitted is None:
        return parts, BestAim(int(shares.argmax()), None, None, None, None, None)
    order = np.argsort(landers.refit[0], kind="stable")
    settled = landers.settled[:, order].reshape(len(parts), REFIT_COUNT, -1)
    found = analysis.best_choice(settled, fitted.bed_count, allowed, run_count=fitted.run_count)
    parts = [replace(part, share_of_refits=one) for part, one in zip(parts, found.shares.tolist(), strict=True)]
    others = tuple(aim for aim in found.not_worse if aim != found.best)
    share = float(found.shares[found.best])
    return parts, BestAim(found.best, share, found.own, others, found.runner_up, found.difference)
