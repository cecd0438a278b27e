"""The answer of a sequence on its page, and what a reader has to beware of, in sentences."""

from collections.abc import Mapping, Sequence

from lithobrake.outcomes import TouchdownOutcome
from lithobrake.report.captions import hours, listing, percent, place_words
from lithobrake.report.rare_tables import rare_warnings
from lithobrake.report.results import Results, SequenceResults

# With fewer beds intervals are wide, and how much beds differ is hardly known.
FEW_BEDS = 12
# Bounds by missing runs that are wider than this part of the interval belong to the answer.
WIDE = 1 / 3
ANOTHER = "another bed, place or attitude gives another figure, and this study cannot say how different"


def answer(data: SequenceResults) -> str:
    """Where, and what the summary says, in its own sentences or in those made of its record."""
    results = data.results
    said = results.get("answer") or results.get("headline") or _sentences(data)
    return " ".join([*place_words(data), *said])


def action(data: Results) -> str:
    """What the share of the answer is of: landers that do this."""
    limit, site = hours(data.study["flight"]["duration"]), data.table("site")
    holds = site.get("effective_acceleration_outward", -1.0) < 0.0
    return f"stay or come down again within {limit}" if holds else f"come down again within {limit}"


def has_interval(data: Results) -> bool:
    """Whether the runs tell how sure the share is."""
    return data.table("returns").get("lower") is not None


def share_digits(data: SequenceResults) -> int:
    """Digits behind the point that a share in per cent deserves: none unless it is known to two points."""
    returns = data.table("returns")
    return 1 if has_interval(data) and returns["upper"] - returns["lower"] < 0.02 else 0


def bounds(ends: Sequence[float], digits: int) -> str:
    """Two shares in per cent: "68 to 73 %"."""
    low, high = ends
    return f"{100 * low:.{digits}f} to {percent(high, digits)}"


def interval(data: SequenceResults) -> str:
    """The interval of the share, with its level: "90 %: 68 to 73 %"."""
    returns = data.table("returns")
    return f"{percent(data.level, 0)}: {bounds((returns['lower'], returns['upper']), share_digits(data))}"


def _sentences(data: SequenceResults) -> list[str]:
    """The record of the share in words: what it holds over, the next bed, missing runs, and what the site does."""
    returns, digits = data.table("returns"), share_digits(data)
    if not returns:
        return ["The summary has no return fraction."]
    share, source = percent(returns["share"], digits), returns.get("from")
    warning = data.table("site").get("warning")
    said = [_with_interval(data) if has_interval(data) else f"{_where(data)}: {share} of landers {action(data)}"]
    said[0] += f"; from {source}." if source else "."
    if not has_interval(data):
        said.append(as_sentence(returns.get("why") or ANOTHER))
    elif returns.get("next_bed"):
        said.append(
            f"On one next bed the share lies between {bounds(returns['next_bed'], digits).replace(' to ', ' and ')}."
        )
    return [*said, *_missing(data), *([warning] if warning else [])]


def _with_interval(data: SequenceResults) -> str:
    share = percent(data.table("returns")["share"], share_digits(data))
    return (
        f"{share} of landers {action(data)} ({interval(data).replace(':', ' interval')}), over the soils of the study "
        "file, on beds, places and attitudes that were not in the study"
    )


def _where(data: SequenceResults) -> str:
    """What the runs of a share without an interval have in common."""
    common = ["on this bed"] if data.table("runs").get("beds") == 1 else []
    common += [] if "place" in drawn_things(data) else ["at this place"]
    return ", ".join(common or ["in these landings"]).capitalize()


def drawn_things(data: SequenceResults) -> list[str]:
    """What every run draws for itself beside its soil."""
    impact = data.study.get("impact", {})
    place = impact.get("place") or {}
    has_place = impact.get("region") is not None or any(isinstance(one, Mapping) for one in place.values())
    found = {
        "place": has_place,
        "azimuth": impact.get("azimuth_deg") == "random",
        "attitude": impact.get("orientation") == "random",
    }
    return [words for words, is_drawn in found.items() if is_drawn]


def as_sentence(words: str) -> str:
    """Words with a capital, which a dotted key at their beginning does not take, and a full stop."""
    first = words[:1] if "." in words.split(" ", 1)[0] else words[:1].upper()
    return f"{first}{words[1:].rstrip('.')}."


def left_out(data: SequenceResults) -> str:
    """What the emulator was tried on: beds that it had not seen, or, where there is but one, runs."""
    return "runs left out" if data.table("runs").get("beds") == 1 else "beds left out"


def unanswered(data: SequenceResults) -> dict[str, int]:
    """How many runs ended in a way after which nobody knows where the lander went, in words."""
    known = (TouchdownOutcome.CLEAR, TouchdownOutcome.CAPTURED)
    outcomes = data.table("runs", "outcomes")
    return {outcome_label(word): count for word, count in outcomes.items() if count and word not in known}


def outcome_label(word: str) -> str:
    """How a run ended, in a few words."""
    return TouchdownOutcome(word).label if word in list(TouchdownOutcome) else word


def _missing(data: SequenceResults) -> list[str]:
    """What the runs without an answer may hide, where that is much beside the interval."""
    returns = data.table("returns")
    low, high = returns.get("if_missing") or (0.0, 0.0)
    width = returns["upper"] - returns["lower"] if has_interval(data) else 0.0
    return [missing_sentence(data)] if high - low > WIDE * width else []


def missing_sentence(data: SequenceResults) -> str:
    """How many runs have no answer, and between which shares the truth then lies; empty where all have one."""
    lost, returns = unanswered(data), data.table("returns")
    if not lost or not returns.get("if_missing"):
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
    found = [_few_beds(data), emulator_outside(data), _gravity(data), *rare_warnings(data.rare)]
    return [words for words in found if words]


def _few_beds(data: SequenceResults) -> str:
    beds = data.table("runs").get("beds")
    if not has_interval(data) or beds is None or beds >= FEW_BEDS:
        return ""
    return (
        f"The study has {beds} beds: its intervals are wide, and how much beds differ is hardly known. Set "
        f"bed.bed_count to {FEW_BEDS} or more."
    )


def emulator_outside(data: SequenceResults) -> str:
    """That the emulator contradicts the runs it was made from, if it does."""
    if data.table("emulator").get("warning"):
        return as_sentence(data.table("emulator")["warning"])
    returns = data.table("returns")
    by_emulator = returns.get("emulator")
    if by_emulator is None or not has_interval(data) or returns["lower"] <= by_emulator <= returns["upper"]:
        return ""
    return (
        f"The emulator is off: by it {percent(by_emulator, share_digits(data))} {action(data)}, outside the interval "
        f"of the runs ({interval(data)}); samples, map, ellipses and rest are the emulator's."
    )


def _gravity(data: SequenceResults) -> str:
    warning = data.table("site").get("gravity_warning")
    return as_sentence(warning) if warning else ""
