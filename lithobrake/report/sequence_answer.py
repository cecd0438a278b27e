"""What the answer of a sequence is of, and what a reader has to beware of, in words."""

from collections.abc import Mapping, Sequence

from lithobrake.outcomes import TouchdownOutcome
from lithobrake.report.captions import hours, listing, percent
from lithobrake.report.rare_tables import rare_warnings
from lithobrake.report.results import Results, SequenceResults

# With fewer beds intervals are wide, and how much beds differ is hardly known.
FEW_BEDS = 12


def action(data: Results) -> str:
    """What the share of the answer is of: landers that do this."""
    limit = hours(data.study["flight"]["duration"])
    holds = data.results["site"]["effective_acceleration_outward"] < 0.0
    return f"stay or come down again within {limit}" if holds else f"come down again within {limit}"


def has_interval(data: Results) -> bool:
    """Whether the runs tell how sure the share is."""
    return data.results["returns"]["lower"] is not None


def share_digits(data: SequenceResults) -> int:
    """Digits behind the point that a share in per cent deserves: none unless it is known to two points."""
    returns = data.results["returns"]
    return 1 if has_interval(data) and returns["upper"] - returns["lower"] < 0.02 else 0


def bounds(ends: Sequence[float], digits: int) -> str:
    """Two shares in per cent: "68 to 73 %"."""
    low, high = ends
    return f"{100 * low:.{digits}f} to {percent(high, digits)}"


def interval(data: SequenceResults) -> str:
    """The interval of the share, with its level: "90 %: 68 to 73 %"."""
    returns = data.results["returns"]
    return f"{percent(data.level, 0)}: {bounds((returns['lower'], returns['upper']), share_digits(data))}"


def drawn_things(data: SequenceResults) -> list[str]:
    """What every run draws for itself beside its soil."""
    impact = data.study["impact"]
    place = impact["place"] or {}
    has_place = impact["region"] is not None or any(isinstance(one, Mapping) for one in place.values())
    found = {
        "place": has_place,
        "azimuth": impact["azimuth_deg"] == "random",
        "attitude": impact["orientation"] == "random",
    }
    return [words for words, is_drawn in found.items() if is_drawn]


def as_sentence(words: str) -> str:
    """Words with a capital, which a dotted key at their beginning does not take, and a full stop."""
    first = words[:1] if "." in words.split(" ", 1)[0] else words[:1].upper()
    return f"{first}{words[1:].rstrip('.')}."


def left_out(data: SequenceResults) -> str:
    """What the emulator was tried on: beds that it had not seen, or, where there is but one, runs."""
    return "runs left out" if data.results["runs"]["beds"] == 1 else "beds left out"


def unanswered(data: SequenceResults) -> dict[str, int]:
    """How many runs ended in a way after which nobody knows where the lander went, in words."""
    known = (TouchdownOutcome.CLEAR, TouchdownOutcome.CAPTURED)
    outcomes = data.results["runs"]["outcomes"]
    return {outcome_label(word): count for word, count in outcomes.items() if count and word not in known}


def outcome_label(word: str) -> str:
    """How a run ended, in a few words."""
    return TouchdownOutcome(word).label if word in list(TouchdownOutcome) else word


def missing_sentence(data: SequenceResults) -> str:
    """How many runs have no answer, and between which shares the truth then lies; empty where all have one."""
    lost, returns = unanswered(data), data.results["returns"]
    if not lost:
        return ""
    total, count = sum(data.results["runs"]["outcomes"].values()), sum(lost.values())
    kinds = listing([words if len(lost) == 1 else f"{number} {words}" for words, number in lost.items()])
    ends = bounds(returns["if_missing"], 1).replace(" to ", " and ")
    return (
        f"{count} of {total} landings ({percent(count / total, 0)}), {kinds}, have no answer: between {ends} of all "
        f"{action(data)}, if none or all of these do."
    )


def warnings(data: SequenceResults) -> list[str]:
    """What makes the numbers of the page weaker than they look."""
    found = [
        _few_beds(data),
        emulator_outside(data),
        _said(data.results["site"]["gravity_warning"]),
        *rare_warnings(data.rare),
    ]
    return [words for words in found if words]


def _few_beds(data: SequenceResults) -> str:
    beds = data.results["runs"]["beds"]
    if not has_interval(data) or beds >= FEW_BEDS:
        return ""
    return (
        f"The study has {beds} beds: its intervals are wide, and how much beds differ is hardly known. Set "
        f"bed.bed_count to {FEW_BEDS} or more."
    )


def emulator_outside(data: SequenceResults) -> str:
    """That the emulator contradicts the runs it was made from, if it does."""
    return _said(data.results["emulator"]["warning"])


def _said(warning: str | None) -> str:
    return as_sentence(warning) if warning else ""
