"""What an observed first contact says of the ground and of the place of rest, in sentences."""

from collections.abc import Mapping, Sequence
from typing import Any

from lithobrake.results.site_results import MOST_UNKNOWN
from lithobrake.vocabulary.number_words import at_level, duration, listing, number, percent, span

# More of the standard deviation of the prior than this is not worth a sentence.
NOTHING_LEARNT = 0.9
# An observation that so few draws are as unlikely as is unusual.
UNUSUAL = 0.05


def statement(found: Mapping[str, Any]) -> list[str]:
    """found: of nowcast.json."""
    if not found["is_reliable"]:
        return [_refusal(found)]
    said = [_worth(found)]
    if found["beyond"] > 0.0:
        said.append(
            f"Left out are {percent(found['beyond'], 1)} of the drawn landers, whose arrival lies beyond the range of "
            f"the study's touchdowns (most by {found['beyond_input']})."
        )
    if found["not_used"]:
        said.append(f"Not used, as the emulator has no law of it for captured landers: {listing(found['not_used'])}.")
    if found["predictive_p_value"] is not None and found["predictive_p_value"] < UNUSUAL:
        said.append(f"The contact is unusual: {percent(found['predictive_p_value'], 1)} of all draws are as unlikely.")
    if found["ground"]:
        said.append(_kinds(found))
    said += _inputs(found)
    return said + _rest(found)


def _worth(found: Mapping[str, Any]) -> str:
    worth = found["effective_count"]
    return (
        f"The first contacts of {worth:.0f} of {found['landers']} drawn landers are like this one; they stand on "
        f"{found['journeys']} simulated journeys on {found['beds']} beds."
    )


def _refusal(found: Mapping[str, Any]) -> str:
    outside = found["predictive_p_value"] is not None and found["predictive_p_value"] < UNUSUAL
    if outside:
        return (
            "The contact lies outside what the study simulated, so nothing is said of ground and rest; look at units "
            "and errors, or widen the inputs of the study."
        )
    return (
        f"The first contacts of {found['effective_count']:.0f} of {found['landers']} drawn landers are like this one, "
        f"fewer than {found['fewest']:.0f}, so nothing is said of ground and rest; give larger errors or leave an "
        "output out."
    )


def _kinds(found: Mapping[str, Any]) -> str:
    told = [
        f"{name} {_share(one['after'], found['level'])}, before {percent(one['before'])}"
        for name, one in found["ground"].items()
    ]
    return f"Ground: {'; '.join(told)}."


def _share(one: Sequence[float | None], level: float) -> str:
    lower, value, upper = one
    assert value is not None
    return (
        percent(value)
        if lower is None or upper is None
        else (f"{percent(value)} ({at_level(level)} {span(lower, upper)})")
    )


def _inputs(found: Mapping[str, Any]) -> list[str]:
    said, nothing = [], []
    for name, one in found["inputs"].items():
        if one["sd_ratio"] > NOTHING_LEARNT:
            nothing.append(name)
            continue
        unit = one["unit"].removeprefix("-")
        said.append(f"{name}: {_number(one, unit, found['level'])}.")
    return said + ([f"The contact says next to nothing about {listing(nothing)}."] if nothing else [])


def _number(one: Mapping[str, Any], unit: str, level: float) -> str:
    lower, middle, upper = one["after"]
    blank = f" {unit}" if unit else ""
    lowest, _, highest = one["before"]
    before = "before not known" if lowest is None else f"before {number(lowest)} to {number(highest)}{blank}"
    own = "" if lower is None else f"{at_level(level)} {number(lower)} to {number(upper)}{blank}, "
    return f"{number(middle)}{blank} ({own}{before})"


def _rest(found: Mapping[str, Any]) -> list[str]:
    rest, level = found["rest"], found["level"]
    said = [f"At rest: {_share(rest['at_rest']['after'], level)}, before {percent(rest['at_rest']['before'])}."]
    if rest["unknown"] > 0.0:
        said.append(f"Ends that the emulator does not know: {percent(rest['unknown'], 1)}.")
    if rest["unknown"] > MOST_UNKNOWN:
        said.append(f"These are more than {percent(MOST_UNKNOWN)}, so no time and place of rest are given.")
    if rest["time_s"]["after"][1] is None:
        return said
    lower, middle, upper = rest["time_s"]["after"]
    own = "" if lower is None else f" ({at_level(level)} {duration(lower)} to {duration(upper)})"
    said.append(f"Time to rest, where the lander rests: {duration(middle)}{own}.")
    ways = {"from_contact_m": "from the first contact", "distance_m": "from the aim point"}
    told = [f"{_number(rest[name], 'm', level)} {words}" for name, words in ways.items()]
    said.append(f"Place of rest: {listing(told)}.")
    if not rest["sides"]:
        said.append("Side down: too few simulated journeys had a similar contact.")
    else:
        sides = [f"{side} {_share(one, level)}" for side, one in rest["sides"].items()]
        said.append(f"Side down, by simulated journeys with a like contact: {'; '.join(sides)}.")
    return said
