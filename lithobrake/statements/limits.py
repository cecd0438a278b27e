"""What a study asks beside its answer, in sentences: limit states, rare ones among them, and delivery options."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from lithobrake.statements.ends import covered, unknown_outcome
from lithobrake.statements.labels import bracket, two_digits
from lithobrake.vocabulary.number_words import (
    at_level,
    counted,
    duration,
    intervals,
    number,
    percent,
    rare_percent,
    thousands,
    with_interval,
)

if TYPE_CHECKING:
    from lithobrake.results.questions import AimOnGround, AimResults, LimitStateResult, RareLimitState
    from lithobrake.vocabulary.estimate import Estimate

# Of those at rest, the share within the distance and time that are named.
FAR = 0.95
# Options up to so many are named.
NAMED = 3
# Landings that meet it descend from so few groups of one size: on a second go they may descend from quite others.
FEW_ORIGINS = 3.0


def met_words(name: str, found: "LimitStateResult") -> str:
    """What landers do that meet a limit state of journeys."""
    if found.radius_m is not None:
        return f"come to rest within {number(found.radius_m)} m of the aim point"
    return f"meet {name} ({found.condition})"


def shown_probability(found: "LimitStateResult") -> "Estimate":
    """The probability with the interval that the answer has; where the ground is unknown it is that of one ground."""
    over = found.over_grounds
    return found.probability if over is None else over


def journey_state(name: str, found: "LimitStateResult") -> str:
    """The probability of a limit state of journeys: by landings and emulator, by ground, and its inputs."""
    one, runs = shown_probability(found), found.runs
    words = met_words(name, found) + ("" if found.radius_m is None else f" ({name})")
    where = "" if found.over_grounds is None else " over the grounds that the study allows"
    said = [f"{with_interval(one, level=one.level)} of the landers {words}{where}"]
    said[0] += f", from {runs.from_}"
    verdict = "" if found.agrees is not False else ", which does not agree"
    said[0] += f"; the emulator gives {with_interval(found.emulator)}{verdict}" if found.emulator else ""
    if one.bounds is None and found.why:
        said[0] += f"; no interval: {found.why.rstrip('.')}"
    if found.if_aimed is not None:
        said[0] += f"; with the mean on the aim point it would be {with_interval(found.if_aimed)}"
    if runs.missing > 0.0:
        said.append(covered(runs.missing))
    if found.grounds:
        kinds = ", ".join(f"{kind} {with_interval(share)}" for kind, share in found.grounds.items())
        said.append(f"By kind of ground: {kinds}")
    made = _correlated(found)
    return ". ".join([*said, *([f"It is correlated with {', '.join(made)}"] if made else [])]) + "."


def _correlated(found: "LimitStateResult") -> list[str]:
    """The significant inputs, that which differs most first."""
    made = [key for key, one in found.inputs.items() if one.found]
    return sorted(made, key=lambda key: -found.inputs[key].distance.value)


def limit_state(name: str, found: "LimitStateResult") -> str:
    """The probability of a limit state: its interval, where it comes from, and correlated inputs."""
    if found.of_journey:
        return journey_state(name, found)
    begin = f"{name} ({found.condition}): {rare_percent(found.probability.value)} of the landings"
    one = found.probability
    if one.bounds is None:
        return f"{begin}, from {found.runs.from_}; no interval: {found.why}"
    said = f"{begin}{bracket(one.lower, one.upper, rare_percent, level=one.level)}"
    if found.source == "emulator":
        said += f", from the emulator, since {found.failing_runs:.3g} landings that meet it are too few for an estimate"
        if one.value < found.tail_limit:
            said += f"; {found.runs.from_} cannot resolve probabilities below {rare_percent(found.tail_limit)}"
    else:
        said += f", from {found.runs.from_}"
    if found.runs.missing > 0.0:
        said += f"; {covered(found.runs.missing)}"
    made = _correlated(found)
    none = "No input is significant" if found.inputs else "Its correlated inputs are unknown"
    return f"{said}. {'It is correlated with ' + ', '.join(made) if made else none}."


COUNTED = "It is too common for subset simulation to gain anything: for a narrower interval raise journey.count."


def rare_limit_state(name: str, found: Mapping[str, Any]) -> str:
    """The probability of a rare limit state; found: the content of its file."""
    said = f"no landing met it down to the last level, a probability of {number(found['rarest'], 1)}"
    if found["reached"]:
        interval = bracket(found["lower"], found["upper"], two_digits, level=found["level"])
        said = f"probability {two_digits(found['probability'])}{interval}"
    unknown = found["without_known_end"]
    lost = f"; {unknown} with unknown outcome count as not meeting it" if unknown else ""
    landings = f"{found['landings']} landings in {counted(found['levels'], 'level')} on {found['beds']} beds"
    why = f" {found['why']}" if found["why"] else ""
    warning = f" {found['warning']}" if found["warning"] and found["lower"] is not None else ""
    common = f" {COUNTED}" if found["reached"] and found["levels"] == 1 else ""
    return f"{name} ({found['condition']}): {said}; by {landings}{lost}.{common}{why}{warning}"


def few_origins(origins: float, bed_count: int) -> str | None:
    """That equal runs of the command would scatter much; None where they would not."""
    if origins >= FEW_ORIGINS:
        return None
    what, more = ("beds", "bed.bed_count") if bed_count > 1 else ("first landings", "--landings")
    return (
        f"The landings that meet it descend from few {what} (effective number {origins:.1f}), so another seed may give "
        f"a very different probability: raise {more}."
    )


def rare_warnings(rare: "Mapping[str, RareLimitState]") -> list[str]:
    """Where the same with another seed may give quite another probability."""
    return [f"{name}: {found.warning}" for name, found in rare.items() if found.warning]


def rare_caption(rare: "Mapping[str, RareLimitState]") -> str:
    """The figure of the levels."""
    named = ", ".join(f"{name} ({found.condition})" for name, found in rare.items())
    level = next(iter(rare.values())).probability.level
    return (
        f"Subset simulation with landings of {named}: each point is a level, and the next level starts "
        f"from the landings beyond its threshold; at 0 the limit state is reached. Bars are {intervals(level)}."
    )


def options(table: "AimResults") -> str:
    """The delivery options that cannot be distinguished from the best, the best's own share, and the best on hard
    ground."""
    aims, within = table.aims, f" within {', '.join(table.within)}" if table.within else ""
    count = sum(aim.soil.allowed for aim in aims)
    best, hard = table.best_on_soil, table.best_on_hard
    if best is None:
        return (
            f"Of {len(aims)} delivery options {count} are allowed{within}; no lander {_verb(table, 'comes', 'meets')} "
            "with any of these."
        )
    said = [] if best.not_worse is None else [_alike(table, (best.aim, *best.not_worse), count, within)]
    most = f"Of {count} delivery options{within} most landers" if not said else "Most landers"
    said.append(f"{most} {_verb(table, 'come', 'meet')} with {option(table, best.aim)}: {_of_best(table)}")
    on_hard = None if hard is None else aims[hard.aim].hard
    if hard is not None and on_hard is not None:
        where = "the same option" if best.aim == hard.aim else option(table, hard.aim)
        said.append(f"On hard ground the best is {where}: {with_interval(_compared(table, on_hard))}")
    return ". ".join(said) + "."


def _verb(table: "AimResults", rests: str, meets: str) -> str:
    """What is compared between the options: that landers come to rest, or meet a limit state."""
    return f"{rests} to rest" if table.best is None else f"{meets} {table.best}"


def _compared(table: "AimResults", part: "AimOnGround") -> "Estimate":
    """The fraction of an option that is compared."""
    return part.settled if table.best is None else part.limit_states[table.best]


def _of_best(table: "AimResults") -> str:
    """What becomes of the landers with the best option."""
    best = table.best_on_soil
    assert best is not None
    part = table.aims[best.aim].soil
    # The largest of many shares is too high by its selection, so the sentence has the share without it.
    said = with_interval(best.own or _compared(table, part), level=table.level)
    if table.best is not None:
        said += f"; {with_interval(part.settled)} come to rest"
    if part.distance_p95 is not None and part.time_p95 is not None:
        far, late = part.distance_p95.value, part.time_p95.value
        said += f", {percent(FAR)} of these within {number(far)} m and {duration(late)}"
    if part.missing >= 0.005:
        said += f"; {unknown_outcome(part.missing) if best.own is None else covered(part.missing)}"
    return said


def _alike(table: "AimResults", places: Sequence[int], count: int, within: str) -> str:
    """Which of the allowed options cannot be distinguished from the best, it among them."""
    surely = f"with {percent(table.level)} confidence"
    if count == 1:
        return f"Of {len(table.aims)} delivery options one is allowed{within}"
    if len(places) == 1:
        return f"One of {count} delivery options{within} is better than every other, {surely}"
    named = f": {'; '.join(option(table, place) for place in sorted(places))}" if len(places) <= NAMED else ""
    return f"{len(places)} of {count} delivery options{within} cannot be distinguished from the best, {surely}{named}"


def option(table: "AimResults", place: int) -> str:
    values = zip(table.names, table.aims[place].values, strict=True)
    return ", ".join(f"{name} = {table.value_words(name, value)}" for name, value in values)


def options_caption(table: "AimResults") -> str:
    """The figure of the delivery options."""
    crossed = " Options that the limits exclude are crossed out." if table.within else ""
    return (
        f"{table.statement} {thousands(table.lander_count)} landers at each delivery option, followed until they rest; "
        f"below each number its {at_level(table.level)}. Dotted frames: options that cannot be distinguished "
        f"from the best, which has a full frame.{crossed}"
    )
