"""What the ground makes of the answer, in sentences: over all grounds of a study, by kind, and where there is one."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from lithobrake.statements.journeys import time_words
from lithobrake.statements.labels import quantile
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.number_words import LEVEL, intervals, number, percent, span, with_interval

if TYPE_CHECKING:
    from lithobrake.results.ground_results import FinerGround, GroundKindResults, OverGrounds
    from lithobrake.results.site_results import BedNumbers


def over_grounds(found: "OverGrounds | None") -> list[str]:
    """Where the answers on one ground lie; nothing where the study has no such ground."""
    if found is None or not found.time_s.is_known:
        return []
    said = [f"{_bounds(found.at_rest)} at rest"] if found.at_rest.lower is not None else []
    if found.time_s.lower is not None:
        said.append(f"median time to rest {time_words(found.time_s)}")
    if found.distance_m.lower is not None:
        said.append(f"median distance {quantile(found.distance_m)} m")
    sides = [f"{face} {_bounds(one)}" for face, one in found.faces.items() if one.lower is not None]
    said += [f"side down {', '.join(sides)}"] if sides else []
    if not said:
        return ["How far the grounds differ is not known: each has one landing; set bed.bed_count to fewer."]
    return [f"One ground of these gives, with {percent(LEVEL)} probability: {'; '.join(said)}."]


def _bounds(one: Estimate) -> str:
    assert one.lower is not None
    assert one.upper is not None
    return span(one.lower, one.upper)


def by_kind(found: "Mapping[str, GroundKindResults]") -> list[str]:
    """What each kind of ground gives alone."""
    listed = [
        f"{name} ({percent(one.weight)}, grains of {sizes(one.grain_size_m)} m) {with_interval(one.at_rest.share)} at "
        f"rest" + (f", median time {time_words(one.time_s)}" if one.time_s.is_known else "")
        for name, one in found.items()
    ]
    return [f"By kind of ground: {'; '.join(listed)}."] if listed else []


def finer(found: "FinerGround | None") -> list[str]:
    """For how much of the ground coarser beds stand."""
    if found is None:
        return []
    size = number(found.finest_m, 2)
    return [
        f"Beds of grains of {size} m stand for all finer ground, {percent(found.share)} of what the study allows; "
        "finer grains could change the answer."
    ]


def strip_note(*, has_finest: bool, has_one: bool) -> str:
    """Bars, marks and rows of the answers on each ground.

    has_finest: whether a row is of the ground finer than any bed; has_one: whether the last row is of one ground
    throughout.
    """
    last = "; in the last row of one ground throughout" if has_one else ""
    finest = "; the finest is part of the kinds above, its journeys on the coarser beds that stand for it"
    return f"Marks: values; bars: {intervals()} of the mean over beds of that ground{last}{finest * has_finest}."


def kind_words(weight: float, ends: tuple[float, float]) -> str:
    """How probable a kind of ground is, and how large its grains."""
    return f"{percent(weight)}, {sizes(ends)} m"


def finest_words(found: "FinerGround") -> str:
    """How probable the finest ground is, and which grains stand for it."""
    return f"{percent(found.share)}, up to {number(found.finest_m, 2)} m"


def curve_caption() -> str:
    """The figure of the ends against the size of the grains."""
    return (
        "Lines: smooth curves of the journeys on beds of such grains, with bounds that hold "
        f"{percent(LEVEL)} of the curves of resampled beds. Marks: beds, with an area by the number of their journeys. "
        "Below: the sizes of the beds of each kind of ground."
    )


def sizes(ends: tuple[float, float]) -> str:
    """A range of grain sizes, in metres."""
    low, high = (number(end, 2) for end in ends)
    return low if low == high else f"{low}-{high}"


def one_ground(beds: "Sequence[BedNumbers]") -> list[str]:
    """What an answer leaves out that holds for grains of one size; nothing where there are no beds."""
    if not beds:
        return []
    size = number(beds[0].mean_diameter_m, 2)
    return [f"This holds for grains of {size} m alone: its intervals leave out that the ground is unknown ([ground])."]
