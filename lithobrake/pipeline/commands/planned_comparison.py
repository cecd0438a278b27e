"""The plan of a comparison: whether two studies can be compared, and how well their difference will be known."""

from dataclasses import replace
from pathlib import Path

from lithobrake.pipeline.answer.run_answers import answer_words
from lithobrake.pipeline.commands.comparison import compare_studies
from lithobrake.pipeline.planning.expected_difference import ExpectedDifference, pair_gains
from lithobrake.pipeline.planning.plan import Plan
from lithobrake.pipeline.planning.planner import PlannedStudy
from lithobrake.pipeline.shared_numbers import FIRST, SECOND, SharedNumbers, pair_count
from lithobrake.study import Study

# Half-widths of a fraction that may be asked for end here: an interval from 0 to 1.
WIDEST = 0.5
EXPECTED = "Correlations: expected from simulated pairs; a larger change lowers them (docs/howto/compare.md)."


def plan_comparison(
    path: Path, out: Path, other: Path, other_out: Path, worker_count: int | None = None, *,
    half_width: float | None = None,
) -> Plan:  # fmt: skip
    """Plan a study as plan_study does, and its difference to another one; writes nothing.

    half_width: that the difference of the fraction shall have, 0 to 0.5; None: no runs are asked for.
    Raises ValueError for studies that plan_study refuses or that cannot be compared, and for that half-width.
    """
    if half_width is not None and not 0.0 < half_width <= WIDEST:
        raise ValueError(
            f"--half-width is {half_width:g}; allowed: above 0 to {WIDEST:g}, a fraction of the landers (0.05 for 5 "
            "points)"
        )
    one, two = PlannedStudy.of(path, out, worker_count), PlannedStudy.of(other, other_out, worker_count)
    # Studies that cannot be compared are refused before their plans, which take seconds.
    difference = _difference(one, two, half_width)
    return replace(one.plan, difference=difference)


def _difference(one: PlannedStudy, two: PlannedStudy, half_width: float | None) -> ExpectedDifference:
    if one.tables == two.tables:
        raise ValueError(f"{one.name} and {two.name} are the same study; compare studies that differ")
    for each in (one, two):
        if not each.design.study.design.run_count:
            raise ValueError(f"{each.name} draws no lander (design.run_count is 0); compare studies that draw some")
    pairs = pair_count(*(SharedNumbers.of_design(each.design, each.name) for each in (one, two)))
    answers = [_asked(each.design.study) for each in (one, two)]
    if answers[0] != answers[1]:
        raise ValueError(
            f"{one.name} ({FIRST}) asks for {answers[0]} and {two.name} ({SECOND}) for {answers[1]}; give both the "
            "same design.half_width_of and condition"
        )
    widths = one.plan.half_width, two.plan.half_width
    if widths[0] is None or widths[1] is None:
        raise ValueError(
            f"{one.name} and {two.name} have one bed, which gives no interval; raise bed.bed_count of both"
        )
    beds = len(set(one.design.beds[:pairs]))
    measured, basis = _measured(one, two)
    gains = pair_gains(one.design.study, measured)
    return ExpectedDifference.of(
        two.name, pairs, beds, one.design.study, (widths[0], widths[1]), gains, basis, half_width
    )  # fmt: skip


def _asked(study: Study) -> str:
    """What the half-width of a study is of, with the condition of a limit state."""
    name = study.design.half_width_of
    return answer_words(study) if name is None else f"{answer_words(study)} ({study.limit_states.conditions()[name]})"


def _measured(one: PlannedStudy, two: PlannedStudy) -> tuple[dict[str, float], str]:
    """Correlations of the pairs of two finished studies by result; none before; and where they come from."""
    if one.plan.stages or two.plan.stages:
        return {}, EXPECTED
    found = compare_studies(one.folder, two.folder)
    names = pair_gains(one.design.study, {})
    known = {name: found.answers[name].correlation for name in names if name in found.answers}
    measured = {name: value for name, value in known.items() if value is not None}
    if not measured:
        return {}, EXPECTED
    others = "" if len(measured) == len(names) else "; expected ones of results that do not vary in these"
    return measured, f"Correlations: of the {found.of} that were made{others}."
