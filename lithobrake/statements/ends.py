"""How landings and journeys end, in sentences: fractions with their intervals, what they hold over, what is missing."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from lithobrake.statements.labels import FAILED, GROUND_WORDS, RUN_WORDS, end_words
from lithobrake.vocabulary.constants import LARGEST_CORRELATION
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.number_words import (
    LEVEL,
    as_sentence,
    counted,
    interval_digits,
    out_of,
    percent,
    span,
    time_limit,
    with_interval,
)
from lithobrake.vocabulary.outcomes import FlightStatus, JourneyEnd, SampleOutcome, TouchdownOutcome

if TYPE_CHECKING:
    from lithobrake.results.dispersion import FollowedLanders
    from lithobrake.results.run_results import CountedShare, ReturnFraction, RunResults
    from lithobrake.results.summary import Results

# What a study on one bed, at one impact point or in one attitude leaves open.
OTHERS = "Another bed, impact point or attitude would change the result; this study cannot show by how much"
# With fewer beds intervals are wide, and how much beds differ is hardly known.
FEW_BEDS = 12
# Samples after whose outcome nothing is known.
MISSING_SAMPLES = (SampleOutcome.LEFT_SIDEWAYS, SampleOutcome.TIME_LIMIT, SampleOutcome.OUTSIDE)
REMEDIES = {
    TouchdownOutcome.LEFT_SIDEWAYS: "a wider bed (bed.width, with bed.grain_count) or a steeper impact "
    "(impact.incidence_deg)",
    TouchdownOutcome.TIME_LIMIT: "a longer landing.time_limit",
    FAILED: "the remedy that the reasons of the failed runs name (runs.sqlite)",
}
# Smaller shares have a digit after the point.
FEW = 0.1
# Ends that stand in sentences of their own.
SAID_APART = (JourneyEnd.AT_REST, JourneyEnd.FAILED)
# A program of the user's own has neither bed nor time limit in the study file.
OF_A_PROGRAM = "a program that returns clear or captured for every touchdown"


@dataclass(frozen=True)
class Scope:
    """Over what the numbers of a study hold, and the times [s] after which its flights and journeys end.

    has_soil: whether its touchdowns are simulated; one_place: whether all runs have one impact point; has_scatter:
    whether the samples of an expansion have the scatter of the runs; to_rest: whether landers are drawn and followed to
    rest, and not for their first touchdown alone; touchdowns: for how many at most, None without a limit;
    is_flown: whether landers fly to the ground from states.
    """

    has_soil: bool
    bed_count: int
    one_place: bool
    random_attitude: bool
    has_scatter: bool
    flight_time: float
    journey_time: float
    to_rest: bool
    touchdowns: int | None = None
    is_flown: bool = False

    @property
    def where(self) -> str:
        """Words that an answer begins with: what its runs have in common."""
        if not self.has_soil:
            return "With the touchdowns of this study's own program"
        fixed = ["on this bed"] if self.bed_count == 1 else []
        fixed += ["at this impact point"] if self.one_place else []
        if fixed or not self.random_attitude:
            return ", ".join(fixed or ["in this attitude"]).capitalize()
        return f"On these {self.bed_count} beds, at random impact points and attitudes"

    @property
    def why(self) -> str:
        """Why a share of the samples of an expansion has no interval."""
        if not self.has_soil:
            return "Another contact model would change the result; this study cannot show by how much."
        if self.bed_count == 1 or self.one_place or not self.random_attitude:
            return f"{OTHERS}."
        return (
            "The result has no interval: the effect of other beds, impact points and attitudes and the error of the "
            "expansion are not quantified."
        )

    @property
    def landings(self) -> str:
        """What the landings were made on, "on 12 beds"."""
        return f"on {counted(self.bed_count, 'bed')}" if self.has_soil else "of the study's own program"

    @property
    def why_no_interval(self) -> str | None:
        """Why the runs say nothing of other beds and places; None where they do."""
        where, remedies = [], []
        if self.bed_count == 1:
            where, remedies = ["on one bed"], ["bed.bed_count to 12 or more"]
        if self.one_place:
            where += ["at one impact point"]
            remedies += ["impact.region to the area where it may land"]
        if not where:
            return None
        return f"All runs landed {' and '.join(where)}. {OTHERS}. To get an interval, set {' and '.join(remedies)}."


def returning(limit: float, *, holds: bool) -> str:
    """What the return fraction is of: landings that do this. limit [s] of the flights; holds: whether the site does."""
    again = f"impact the surface again within {time_limit(limit)}"
    return f"{again} or are captured where the ground holds them" if holds else again


def at_rest(
    one: Estimate, limit: float, where: str = "", of: str = "landers", level: float | None = None, digits: int = 0,
    touchdowns: int | None = None,
) -> str:  # fmt: skip
    """Which fraction comes to rest within a time [s], and within a number of touchdowns where that is limited.

    level: of the interval, where it is to be named.
    """
    within = f"{counted(touchdowns, 'touchdown')} and {time_limit(limit)}" if touchdowns else time_limit(limit)
    return f"{with_interval(one, digits, level=level)} of the {of} come to rest{where} within {within}"


def assumed_at_rest(least: float, of: str) -> str:
    """What is assumed of the fraction at rest before a study has runs."""
    return f"Assumed: {span(least, 1.0)} of {of} come to rest, most likely nearly all"


def unknown_outcome(share: float, digits: int = 0) -> str:
    """Which fraction has an unknown outcome."""
    return f"{percent(share, digits)} have an unknown outcome"


def covered(share: float) -> str:
    """Which fraction has an unknown outcome, where the interval covers all that they may have done."""
    return f"{unknown_outcome(share, 0 if share >= FEW else 1)}, and the interval holds whatever became of them"


def lost(outcomes: Mapping[str, int]) -> str:
    """The kinds of landings without an outcome with their counts."""
    return ", ".join(f"{count} {RUN_WORDS[name]}" for name, count in outcomes.items())


def if_missing(
    who: str, kinds: str, ends: tuple[float, float], digits: int, more: str = "", what: str = "return"
) -> str:  # fmt: skip
    """Between which shares a fraction lies, whatever became of those without an outcome; what: these do or do not."""
    low, high = (percent(end, digits) for end in ends)
    fraction = "return fraction" if what == "return" else "fraction at rest"
    return (
        f"{who} have no outcome ({kinds}): the {fraction} is {low} if none of these {what} and {high} if all do{more}."
    )


def missing_landings(runs: "RunResults", returns: "ReturnFraction") -> list[str]:
    """What landings without an outcome could change; nothing where all have one."""
    missing, ends = runs.missing, returns.if_missing
    if not missing.count:
        return []
    who, covers = out_of(missing.count, runs.count, "landings"), returns.share.lower is not None
    more = "; the interval covers both" if covers else ""
    return [if_missing(who, lost(missing.outcomes), ends, interval_digits(*ends), more)]


def missing_warning(count: int, total: int, outcomes: Mapping[str, int], *, has_soil: bool) -> str:
    """What missing landings do to the numbers of a study, and how to avoid them."""
    remedies = [REMEDIES[name] for name in outcomes] if has_soil else [OF_A_PROGRAM]
    return (
        f"{out_of(count, total, 'landings')} ({percent(count / total)}) have no outcome ({lost(outcomes)}): intervals "
        f"hold whatever became of them, but medians, parts of the variance and the emulator describe only the other "
        f"{total - count}; to avoid this: {', '.join(remedies)}"
    )


def described(outcomes: Sequence[str], total: int) -> str:
    """Which of the landings a number describes; outcomes: of those that have it."""
    met = set(outcomes)
    kinds = {TouchdownOutcome.CLEAR: TouchdownOutcome.CLEAR.label, TouchdownOutcome.CAPTURED: "were captured"}
    words = " or ".join(words for outcome, words in kinds.items() if outcome in met)
    return f"the {out_of(len(outcomes), total, 'landings')} that {words or 'have this number'}"


def landing_ends(scope: Scope, results: "Results") -> list[str]:
    """What becomes of landers after their first touchdown, and over what that holds."""
    returns, holds = results.returns, results.site.holds
    none = "" if holds else "None of the landings remains at the site; "
    share = with_interval(returns.share, level=returns.share.level)
    said = f"{none}{share}{'' if none else ' of the landings'} {returning(scope.flight_time, holds=holds)}"
    missing = missing_landings(results.runs, returns)
    others = f"Of all landings {', '.join(_other_ways(results.shares.outcomes, scope.flight_time, holds=holds))}."
    if returns.why is not None:
        return [f"{scope.where}: {said}; from {returns.from_}.", returns.why, *missing, others]
    return [f"{said}, {held_over(random_attitude=scope.random_attitude)}; from {returns.from_}.", *missing, others]


def held_over(*, random_attitude: bool) -> str:
    """Over which landings estimates with intervals hold."""
    more = "beds, impact points and attitudes" if random_attitude else "beds and impact points"
    return f"over the input distributions of the study file and for {more} outside the study"


def sample_ends(scope: Scope, results: "Results") -> list[str]:
    """What becomes of the samples of a model, where no lander is drawn; nothing without samples."""
    if results.samples is None:
        return []
    outcomes, holds, limit = results.samples.shares.outcomes, results.site.holds, scope.flight_time
    again = f"{with_interval(outcomes['returns'].share, 1)} of the landings {returning(limit, holds=holds)}"
    said = [f"{scope.where}: {again}; {', '.join(_other_ways(outcomes, limit, alone=1, holds=holds))}.", scope.why]
    if outcomes["missing"].count:
        kinds = ", ".join(f"{percent(outcomes[one].share.value, 1)} {one.label}" for one in MISSING_SAMPLES)
        who = f"{percent(outcomes['missing'].share.value, 1)} of the samples"
        said.append(if_missing(who, kinds, results.returns.if_missing, 1))
    return said


def hard_ground_ends(grounds: "Mapping[str, FollowedLanders]", limit: float, digits: int = 0) -> list[str]:
    """How many landers come to rest on other ground than that of the study within a time [s]."""
    said = []
    for ground, found in grounds.items():
        where, lost = f"on {GROUND_WORDS[ground]}", unknown_outcome(found.unknown, digits)
        if found.unknown == 1.0:
            said.append(f"{where.capitalize()} {lost}.")
            continue
        of, more = ("landers with a known outcome", f"; {lost}") if found.unknown > 0.0 else ("landers", "")
        said.append(f"{at_rest(found.ends[JourneyEnd.AT_REST].share, limit, f' {where}', of, digits=digits)}{more}.")
    return said


def _other_ways(
    outcomes: Mapping[str, "CountedShare"], limit: float, *, holds: bool, alone: int = 0
) -> Iterable[str]:  # fmt: skip
    """The fractions that do not return; alone: digits of those without an interval."""
    ways: dict[str, str] = {
        FlightStatus.ESCAPED: "escape",
        FlightStatus.FLYING: f"are still flying after {time_limit(limit)}",
    }
    if outcomes[FlightStatus.PARTNER].count:
        ways[FlightStatus.PARTNER] = "impact the partner"
    captured = TouchdownOutcome.CAPTURED.value
    if outcomes[captured].count and not holds:
        ways[captured] = "are captured and lifted off again"
    return [f"{with_interval(outcomes[name].share, alone)} {words}" for name, words in ways.items()]


def journey_ends(scope: Scope, results: "Results") -> list[str]:
    """How many landers come to rest, from how many journeys, and how the others end."""
    rests = results.ends[JourneyEnd.AT_REST].share
    main = rest_over(results, scope.journey_time, scope.touchdowns)
    said = f"{main} ({journey_counts(results)}).{_others(results)}{_all_alike(rests)}"
    why = [] if rests.why_missing is None else [rests.why_missing]
    return [said, *missing_journeys(results), *why]


def missing_journeys(results: "Results") -> list[str]:
    """What journeys of unknown end could change; nothing where every end is known."""
    failed, rests = results.ends[JourneyEnd.FAILED].count, results.ends[JourneyEnd.AT_REST]
    if not failed:
        return []
    ends = rests.count / results.journeys, (rests.count + failed) / results.journeys
    more = "; the intervals hold whatever became of them" if rests.share.lower is not None else ""
    who, kinds = out_of(failed, results.journeys, "journeys"), "a landing or flight failed"
    return [if_missing(who, kinds, ends, interval_digits(*ends), more, "come to rest")]


def _all_alike(rests: Estimate) -> str:
    """For which correlation an interval holds that no lander, or every lander, at rest leaves."""
    if rests.lower is None or rests.value not in (0.0, 1.0):
        return ""
    return f" The interval holds for a correlation of landers on one bed of up to {LARGEST_CORRELATION:g}."


def rest_over(results: "Results", limit: float, touchdowns: int | None) -> str:
    """The fraction at rest within a time [s]; where the ground is unknown its interval is that of one ground."""
    over, where = results.over_grounds, ""
    share = results.ends[JourneyEnd.AT_REST].share
    if over is not None:
        share, where = over.at_rest, " over the grounds that the study allows"
    return at_rest(share, limit, where, level=LEVEL, touchdowns=touchdowns)


def journey_counts(results: "Results") -> str:
    """How many journeys there are, of how many landings on how many beds."""
    beds = results.runs.beds
    return f"{results.journeys} journeys, {results.touchdowns} simulated landings, {counted(beds, 'bed')}"


def journeys_at_rest(count: int, total: int) -> str:
    """Which journeys numbers of landers at rest describe."""
    return f"{out_of(count, total, 'journeys')} that ended at rest"


def _others(results: "Results") -> str:
    """The shares of the other ends that occurred, with the body on which landers rest."""
    words = end_words(results.site)
    others = {name: one for name, one in results.ends.items() if name not in SAID_APART and one.count}
    listed = [f"{with_interval(one.share)} {words[name]}" for name, one in others.items()]
    return f" Other ends: {', '.join(listed)}." if listed else ""


def landing_warnings(results: "Results", *more: str | None) -> list[str]:
    """What makes the numbers of the landings weaker than they look; more: what else does."""
    runs, site = results.runs, results.site
    found = [runs.warning, _few_beds(results), *more, site.gravity_warning]
    return [as_sentence(words) for words in found if words]


def _few_beds(results: "Results") -> str | None:
    beds = results.runs.beds
    if results.returns.share.lower is None or beds >= FEW_BEDS:
        return None
    return (
        f"The study has only {beds} beds: intervals are wide, and the variance between beds is poorly known. Set "
        f"bed.bed_count to {FEW_BEDS} or more."
    )
