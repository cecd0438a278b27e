"""How wide the interval of a study's answer will be: the half width to expect, and what that stands on."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from lithobrake.campaign import Record
from lithobrake.pipeline.answer.answer_of_run import answer_words, answers_of_design
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.folder.study_folder import StudyFolder
from lithobrake.pipeline.sequential_sampling import flown_shares

# Of a run that is all or nothing, as captured or not, at worst: half of them are.
YES_OR_NO = 0.5
# Fractions of landers at rest that a plan of journeys tells the width of.
LIKELY_AT_REST = (0.95, 0.8)
# Fewer answers say nothing of how they scatter.
FEWEST_ANSWERS = 20


@dataclass(frozen=True)
class ExpectedHalfWidth:
    """Half the interval of a share over so many runs on so many beds, as a share of 1.

    at_worst           of a share for which each run is all or nothing
    typical            of the return fraction, for which each run has a share of its own, as that of the headings that
                       return: least and largest, by the scatter of studies with randomised impact points; of journeys
                       the fraction at rest, of 95 and of 80 %
    spread             standard deviation of a run in these cases
    correlation        of two runs on one bed, in both
    own                of `answer`, by the scatter of the study's own runs; None before enough have ended
    own_run_count      how many these are
    level              probability that the interval stands for
    """

    run_count: int
    bed_count: int
    at_worst: float
    typical: tuple[float, float]
    spread: tuple[float, float]
    correlation: float
    own: float | None
    own_run_count: int
    answer: str
    level: float
    of: str = "return fraction"
    measured: str = "as measured with randomised impact points"

    def lines(self) -> list[str]:
        """The half width in words."""
        counts = f"{self.run_count} runs on {self.bed_count} beds"
        lines = [
            f"Expected half-width of the {100 * self.level:.0f} % interval ({counts}): {_points(*self.typical)} for "
            f"the {self.of}, at most {_points(self.at_worst)} for any share.",
            f"  Assumed: the standard deviation of a run is {self.spread[0]:.2g} to {self.spread[1]:.2g} "
            f"({self.measured}), at most {YES_OR_NO:g}; the correlation of runs on one bed is "
            f"{self.correlation:g}; every landing has an outcome.",
        ]
        if self.own is not None:
            lines.append(
                f"  By the {self.own_run_count} runs that have ended and flown: {_points(self.own)} for {self.answer}."
            )
        return lines


def expected_width(design: DrawnDesign, known: Mapping[str, Record], folder: StudyFolder) -> ExpectedHalfWidth | None:
    """What to expect of a drawn study; None for another method, and for one bed, which gives no interval.

    known: runs that have ended, by key; folder: where they may have flown.
    """
    study = design.study
    if study.design.method != "drawn" or study.bed_count == 1:
        return None
    from lithobrake.analysis import LEVEL, expected_half_width, expected_half_widths
    from lithobrake.analysis.half_width import CORRELATION, SPREAD_RANGE

    counts = study.design.run_count, study.bed_count
    of_journeys: dict[str, Any] = {}
    if study.journey is not None:
        spreads = [math.sqrt(share * (1.0 - share)) for share in LIKELY_AT_REST]
        widths = [expected_half_width(*counts, spread=spread) or math.inf for spread in spreads]
        words = "that of fractions of 95 and of 80 %"
        of_journeys = {"typical": tuple(widths), "spread": tuple(spreads), "of": "fraction at rest", "measured": words}
    values, bed = answers_of_design(design, known, flown_shares(study, folder))
    of_landings = {"typical": expected_half_widths(*counts) or (np.inf, np.inf), "spread": SPREAD_RANGE}
    return ExpectedHalfWidth(
        *counts,
        **(of_landings | of_journeys),
        at_worst=expected_half_width(*counts, spread=YES_OR_NO) or np.inf,
        correlation=CORRELATION,
        own=_own(values, bed, counts),
        own_run_count=int(np.isfinite(values).sum()),
        answer=answer_words(study),
        level=LEVEL,
    )


def _own(values: np.ndarray, bed: np.ndarray, counts: tuple[int, int]) -> float | None:
    from lithobrake.analysis import expected_half_width, scatter_of

    if np.isfinite(values).sum() < FEWEST_ANSWERS or (scatter := scatter_of(values, bed)) is None:
        return None
    return expected_half_width(*counts, spread=scatter[0], correlation=scatter[1])


def _points(*shares: float) -> str:
    return f"+- {' to '.join(f'{100 * share:.2g}' for share in shares)} points"
