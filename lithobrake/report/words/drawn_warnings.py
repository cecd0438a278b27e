"""What the answer of a drawn study is of, and what a reader has to beware of, in words."""

from collections.abc import Mapping

from lithobrake.report.page_data import DrawnPage, PageData, RunsPage
from lithobrake.report.words.captions import listing
from lithobrake.results.limit_state_results import RareLimitState
from lithobrake.vocabulary.outcomes import TouchdownOutcome
from lithobrake.vocabulary.percentages import BoundedShare, interval_digits, percent, span

# With fewer beds intervals are wide, and how much beds differ is hardly known.
FEW_BEDS = 12


def has_interval(data: PageData) -> bool:
    """Whether the runs tell how sure the share is."""
    return data.results.returns.lower is not None


def interval(entry: BoundedShare, level: float) -> str:
    """The interval of an entry with its level, "90 % interval 68-73 %"; empty where it has none."""
    if entry.lower is None or entry.upper is None:
        return ""
    return f"{percent(level)} interval {span(entry.lower, entry.upper)}"


def drawn_things(data: RunsPage) -> list[str]:
    """What every run draws for itself beside its soil."""
    impact = data.study["impact"]
    place = impact["place"] or {}
    has_place = impact["region"] is not None or any(isinstance(one, Mapping) for one in place.values())
    found = {
        "impact point": has_place,
        "azimuth": impact["azimuth_deg"] == "random",
        "attitude": impact["orientation"] == "random",
    }
    return [words for words, is_drawn in found.items() if is_drawn]


def as_sentence(words: str) -> str:
    """Words with a capital, which a dotted key at their beginning does not take, and a full stop."""
    first = words[:1] if "." in words.split(" ", 1)[0] else words[:1].upper()
    return f"{first}{words[1:].rstrip('.')}."


def left_out(data: RunsPage) -> str:
    """What the emulator was validated on: beds that it had not seen, or, where there is but one, runs."""
    return "held-out runs" if data.results.runs.beds == 1 else "held-out beds"


def outcome_label(word: str) -> str:
    """How a run ended, in a few words."""
    return TouchdownOutcome(word).label if word in list(TouchdownOutcome) else word


def missing_sentence(data: RunsPage) -> str:
    """How many runs have no outcome, and between which shares the truth then lies; empty where all have one."""
    missing, returns = data.results.runs.missing, data.results.returns
    if not missing.count:
        return ""
    kinds = listing([f"{number} {outcome_label(word)}" for word, number in missing.outcomes.items()])
    ends = returns.if_missing
    low, high = (percent(end, interval_digits(*ends)) for end in ends)
    return (
        f"{missing.count} of {data.results.runs.count} landings have no outcome ({kinds}): the return "
        f"fraction is {low} if none of these return, {high} if all do."
    )


def warnings(data: DrawnPage) -> list[str]:
    """What makes the numbers of the page weaker than they look."""
    return [*landing_warnings(data, emulator_outside(data)), *rare_warnings(data.rare)]


def landing_warnings(data: RunsPage, outside: str = "") -> list[str]:
    """What makes the numbers of the landings weaker than they look; outside: that an emulator contradicts them."""
    runs, site = data.results.runs, data.results.site
    return [words for words in (_said(runs.warning), _few_beds(data), outside, _said(site.gravity_warning)) if words]


def _few_beds(data: RunsPage) -> str:
    beds = data.results.runs.beds
    if not has_interval(data) or beds >= FEW_BEDS:
        return ""
    return (
        f"The study has only {beds} beds: intervals are wide, and the variance between beds is poorly known. Set "
        f"bed.bed_count to {FEW_BEDS} or more."
    )


def emulator_outside(data: DrawnPage) -> str:
    """That the emulator contradicts the runs it was made from, if it does."""
    return _said(data.emulator.warning)


def _said(warning: str | None) -> str:
    return as_sentence(warning) if warning else ""


def rare_warnings(rare: Mapping[str, RareLimitState]) -> list[str]:
    """Where the same with another seed may give quite another probability."""
    return [f"{name}: {found.warning}" for name, found in rare.items() if found.warning]
