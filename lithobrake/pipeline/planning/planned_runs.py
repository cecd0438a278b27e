"""How many touchdowns a study asks for, and how many of them its folder has already."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from lithobrake.pipeline.design.dependencies import touchdown_keys
from lithobrake.pipeline.design.drawn_design import SIDE_DESIGNS, DrawnDesign
from lithobrake.pipeline.folder.study_folder import StudyFolder
from lithobrake.pipeline.paper.paper_designs import kept_inputs, points, replicate_count
from lithobrake.pipeline.runs.touchdown_runs import drawn_rows
from lithobrake.study.touchdown_model import draw
from lithobrake.vocabulary.quantities import PAPER_DESIGNS

# Designs with more runs are not gone through run by run: that would take longer than a second or two.
MOST_NAMED = 10_000


@dataclass(frozen=True)
class PlannedRuns:
    """Distinct touchdowns of a study in which so many inputs are kept after the screening.

    A touchdown that several designs share counts for the first of them. known: keys of those that have ended already.
    drawn, side: of a drawn study, which has none of the others.
    """

    kept_count: int
    screening: int
    refined: int
    test: int
    known: frozenset[str]
    drawn: int = 0
    side: int = 0

    @property
    def total(self) -> int:
        """All of them."""
        return self.screening + self.refined + self.test + self.drawn + self.side

    @property
    def new(self) -> int:
        """Those that are to be made."""
        return self.total - len(self.known)


def possible_runs(drawn: DrawnDesign, folder: StudyFolder, screened: bool, known: Iterable[str]) -> list[PlannedRuns]:
    """The touchdowns with the inputs that the screening keeps; before it, those with one input and with all of them.

    Of a drawn study those of its count; with a half width that is not met yet, also the most that there may be.

    screened: the folder has the screening of this study. known: keys of runs that have ended.
    """
    study, inputs = drawn.study, tuple(drawn.inputs)
    if study.design.method == "drawn":
        return _possible_drawn(drawn, set(known))
    if screened:
        from lithobrake.chaos import load

        choices = [kept_inputs(study, load(folder / "screening.json"))]
    else:
        choices = [inputs[:1], inputs] if len(inputs) > 1 else [inputs]
    ended = set(known)
    return [_planned(drawn, kept, ended) for kept in choices]


def planned_rows(drawn: DrawnDesign, kept_count: int, most: int) -> list[dict[str, float]]:
    """All inputs of up to `most` of the touchdowns, drawn by chance."""
    study = drawn.study
    if study.design.method == "drawn":
        return drawn.rows[:most]
    points_of_runs = _planned_points(drawn, kept_count, most).tolist()
    return [
        draw(study, drawn.medians | dict(zip(drawn.inputs, row, strict=True)), study.seed) for row in points_of_runs
    ]


def _planned_points(drawn: DrawnDesign, kept_count: int, most: int) -> np.ndarray:
    """Up to `most` of the points at which touchdowns are made, drawn by chance, shape [point_count, input_count]."""
    from lithobrake.analysis import sample_inputs

    kept = tuple(drawn.inputs)[:kept_count]
    parts = [points(drawn, one, kept) for one in PAPER_DESIGNS if _point_count(drawn, one, kept_count) <= MOST_NAMED]
    if not parts:
        return sample_inputs(drawn.inputs, most, seed=0)
    return np.random.default_rng(0).permutation(np.concatenate(parts))[:most]


def _possible_drawn(drawn: DrawnDesign, ended: set[str]) -> list[PlannedRuns]:
    """The runs that are drawn, and the most that the half width may ask for where that is not known yet."""
    fewest, most = _planned_drawn(drawn, ended), drawn.study.design.most_runs
    if not fewest.new or most == drawn.study.design.run_count:
        return [fewest]
    return [fewest, _planned_drawn(drawn.with_run_count(most), ended)]


def _planned_drawn(drawn: DrawnDesign, ended: set[str]) -> PlannedRuns:
    side = SIDE_DESIGNS if drawn.study.design.side_runs else ()
    keys = set(drawn.keys)
    side_keys = {key for design in side for key in touchdown_keys(drawn.study, drawn.rows_of(design), 0)} - keys
    known = frozenset((keys | side_keys) & ended)
    return PlannedRuns(len(drawn.inputs), 0, 0, 0, known, drawn=len(keys), side=len(side_keys))


def _planned(drawn: DrawnDesign, kept: Sequence[str], ended: set[str]) -> PlannedRuns:
    study, seen = drawn.study, set[str]()
    counts = dict.fromkeys(PAPER_DESIGNS, 0)
    for design in PAPER_DESIGNS:
        replicates = range(replicate_count(study, design))
        counts[design] = len(replicates) * _point_count(drawn, design, len(kept))
        if counts[design] > MOST_NAMED:
            continue
        x = points(drawn, design, kept)
        keys = {
            key for replicate in replicates for key in touchdown_keys(study, drawn_rows(drawn, x, replicate), replicate)
        } - seen
        counts[design] = len(keys)
        seen |= keys
    test = counts["test_kept"] + counts["test_all"]
    return PlannedRuns(len(kept), counts["screening"], counts["refined"], test, frozenset(seen & ended))


def _point_count(drawn: DrawnDesign, design: str, kept_count: int) -> int:
    """Points of a design, counted without making them."""
    from lithobrake.chaos import smolyak_count

    section = drawn.study.design
    if design.startswith("test"):
        return section.test_count
    if section.points != "smolyak":
        return int(getattr(section, f"{design}_count"))
    input_count = kept_count if design == "refined" else len(drawn.inputs)
    return smolyak_count(input_count, getattr(section, f"{design}_level"))
