"""What becomes of the landers by the side that faces the ground when they touch down."""

from dataclasses import replace

import numpy as np

from lithobrake.analysis import share_estimate
from lithobrake.pipeline.answer.journey_ends import MEDIAN, JourneyTable, end_share, rest_quantile
from lithobrake.pipeline.answer.scope import why_no_interval
from lithobrake.pipeline.design.lander_attitude import seen, tells_attitude
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.results.journey_results import EndShare
from lithobrake.results.side_results import SideResults
from lithobrake.study import Study
from lithobrake.study.lander_sides import side_words, sides_down
from lithobrake.vocabulary.outcomes import TouchdownOutcome

Sides = dict[str, SideResults]


def first_sides(study: Study, runs: DesignRuns, returns: np.ndarray) -> Sides:
    """By side what the first touchdowns gave; empty where there is one side alone, or attitudes are not told.

    returns: share of the flights of each run that return, [run_count], NaN where that is not known.
    """
    side, bed, why = _sides(study, runs), runs.inputs["bed"], why_no_interval(study)
    ratio = runs.output("speed_out") / runs.inputs["impact.speed"]
    found = {}
    for name in _named(side):
        own = side == name
        share = share_estimate(returns[own], bed[own], why=why)
        found[name] = SideResults(
            words=side_words(study.lander, name),
            landings=int(own.sum()),
            speed_ratio=rest_quantile(ratio[own], bed[own], MEDIAN, why),
            returns=EndShare(int((returns[own] == 1.0).sum()), share.share, share.lower, share.upper, share.why),
        )
    return found


def with_journeys(study: Study, sides: Sides, runs: DesignRuns, touchdowns: DesignRuns, table: JourneyTable) -> Sides:
    """The same with what the journeys of these first touchdowns came to, and what all their touchdowns did."""
    side, every, why = _sides(study, runs), _sides(study, touchdowns), why_no_interval(study)
    captured = np.array(touchdowns.outcomes) == TouchdownOutcome.CAPTURED
    found = {}
    for name, one in sides.items():
        own, those = side == name, every == name
        time = np.where(table.rests, table.numbers["time_s"], np.nan)[own]
        found[name] = replace(
            one,
            at_rest=end_share(table.rests[own], table.bed[own], why),
            time_s=rest_quantile(time, table.bed[own], MEDIAN, why),
            touchdowns=int(those.sum()),
            rests=end_share(captured[those], touchdowns.inputs["bed"][those], why),
        )
    return found


def _sides(study: Study, runs: DesignRuns) -> np.ndarray:
    """The side that faces the ground at each touchdown [run_count]; "" where attitudes are not told."""
    if not tells_attitude(runs.inputs):
        return np.full(runs.run_count, "")
    return sides_down(study.lander, seen(runs.inputs)[0])


def _named(side: np.ndarray) -> list[str]:
    """The sides that occur, where they are several."""
    names = np.unique(side).tolist()
    return names if len(names) > 1 else []
