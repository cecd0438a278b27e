"""What is wrong with limit states: names that none can have, and journeys that the study does not follow so."""

import re
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise, product

from lithobrake.study.design_sections import AIM_RESULTS
from lithobrake.study.lander_checks import NAME
from lithobrake.study.study import Study
from lithobrake.vocabulary.journey_names import FACE, FACES, JOURNEY_NUMBERS, JOURNEY_WORDS, SKY_HOURS
from lithobrake.vocabulary.limit_state import COMPARED, Comparison, Condition, Junction, LimitState, Negation, Word
from lithobrake.vocabulary.outcomes import CAPTURED, RETURNS, JourneyEnd
from lithobrake.vocabulary.quantities import REST_NUMBERS

# Cases of a condition that are looked at; one with more thresholds is taken as it is.
MOST_CASES = 20_000
AIM = ("latitude_deg", "longitude_deg")
# What stands beside limit states in results, comparisons and conditions of options.
RESERVED = (*JourneyEnd, RETURNS, CAPTURED, "time_s", "distance_m", *AIM_RESULTS[1:])
Case = Mapping[str, float | bool]


def named_condition(study: Study, key: str, name: str) -> str:
    """The condition of a limit state by its name, as it was asked for under a key. Raises ValueError for none."""
    conditions = study.limit_states.conditions()
    if name not in conditions:
        known = ", ".join(conditions) or "none: the study has no [limit_states]"
        raise ValueError(f"{key} is {name!r}; allowed: a name of [limit_states] ({known}); add it there")
    return conditions[name]


def option_states(study: Study) -> dict[str, LimitState]:
    """The limit states of a study that are asked of the landers of its options: those that these can tell."""
    states = {name: LimitState.of(text) for name, text in study.limit_states.conditions().items()}
    return {
        name: one for name, one in states.items() if one.journey and set(one.journey) <= {*REST_NUMBERS, *JOURNEY_WORDS}
    }


def limit_state_problems(study: Study) -> Iterator[str]:
    """One sentence for each thing that is wrong with the table [limit_states]."""
    for name, text in study.limit_states.conditions().items():
        key = f"limit_states.{name}"
        if not re.fullmatch(NAME, name):
            yield f"limit_states.{name} is no name; allowed: letters, digits, _ and -; rename it"
        state = LimitState.of(text)
        if state.journey and name in RESERVED:
            yield f"{key} has a name that is one of the results; allowed: any but {', '.join(RESERVED)}; rename it"
        if state.journey:
            yield from _journey_problems(study, key, state)
            yield from _case_problems(key, state)
    asked = study.limit_states.conditions().get(study.design.half_width_of or "")
    hours = [] if asked is None else [name for name in LimitState.of(asked).journey if name in SKY_HOURS]
    if hours:
        yield (
            f'design.half_width_of is "{study.design.half_width_of}", which uses {hours[0]}, and the sky is looked at '
            "when all journeys have ended; name a limit state without it"
        )


def _journey_problems(study: Study, key: str, state: LimitState) -> Iterator[str]:
    """Numbers of journeys that the study cannot have."""
    if study.journey.touchdowns == 1:
        yield (
            f"{key} uses {state.journey[0]}, and journey.touchdowns = 1 follows landers for their first touchdown "
            "alone; leave one of the two out"
        )
    lacking = [name for name in AIM if name not in study.site.model_fields_set]
    if "distance" in state.journey and lacking:
        yield f"{key} uses distance, and the study has no aim point that it counts from; write delivery.{lacking[0]}"
    if study.lander.is_ball and (names := [name for name in state.journey if name in (FACE, "tilt_deg")]):
        yield f"{key} uses {names[0]}, and the lander is a ball, which has no sides; leave it out"
    for name in state.journey:
        if name in SKY_HOURS and SKY_HOURS[name] not in study.sky.bodies:
            asked = ", ".join(study.sky.bodies) or "none"
            yield f"{key} uses {name}, and [sky] does not ask for it (it asks for: {asked}); ask for it there"


def _case_problems(key: str, state: LimitState) -> Iterator[str]:
    """A condition that no journey can meet, or every one does."""
    cases = _cases(state)
    found = {_holds(state.condition, case) for case in cases}
    if len(found) == 1:
        used = [name for name in state.journey if name in JOURNEY_NUMBERS]
        ranges = ", ".join(f"{name} is {JOURNEY_NUMBERS[name].words}" for name in used)
        which = "which every journey meets" if found == {True} else "which no journey can meet"
        yield (
            f'{key} is "{state.text}", {which}{": " if ranges else ""}{ranges}; correct its numbers or words'
        )  # fmt: skip


def _cases(state: LimitState) -> list[Case]:
    """A journey of each kind that the condition can tell apart; none where there are too many."""
    ends: list[Case] = [{end: end == own for end in JOURNEY_WORDS} for own in JOURNEY_WORDS]
    thresholds: dict[str, set[float]] = {name: set() for name in state.journey if name in JOURNEY_NUMBERS}
    if not _add_thresholds(state.condition, thresholds):
        return []
    values = [_between(name, sorted(found)) for name, found in thresholds.items()]
    sides = list(FACES) if FACE in state.journey else [""]
    count = len(sides)
    for one in values:
        count *= len(one)
    if count > MOST_CASES:
        return []
    rests: dict[str, float | bool] = {end: end == JourneyEnd.AT_REST for end in JOURNEY_WORDS}
    return [
        *(case for case in ends if not case[JourneyEnd.AT_REST]),
        *(
            rests | {face: face == side for face in FACES} | dict(zip(thresholds, numbers, strict=True))
            for side in sides
            for numbers in product(*values)
        ),
    ]


def _add_thresholds(condition: Condition, found: Mapping[str, set[float]]) -> bool:
    """Add the numbers that each name is compared with; false where names are compared with each other."""
    match condition:
        case Junction(parts, _):
            return all(_add_thresholds(part, found) for part in parts)
        case Negation(other):
            return _add_thresholds(other, found)
        case Comparison(sides, _):
            names, numbers = ([one for one in sides if isinstance(one, kind)] for kind in (str, float))
            for name in names:
                found[str(name)].update(map(float, numbers))
            return len(names) == 1
    return True


def _between(name: str, thresholds: Sequence[float]) -> list[float]:
    """A value of a number below, between and above thresholds, within its range; a whole number also at each."""
    known = JOURNEY_NUMBERS[name]
    if known.is_whole:
        near = {round(one) + step for one in thresholds for step in (-1.0, 0.0, 1.0)}
        return sorted(one for one in near | {known.lower} if known.lower <= one <= known.upper)
    # A number has no exact value with any probability.
    inner = [one for one in thresholds if known.lower < one < known.upper]
    last = known.upper if known.upper < float("inf") else max([known.lower, *inner]) + 1.0
    edges = [known.lower, *inner, last]
    return [0.5 * (low + high) for low, high in pairwise(edges)]


def _holds(condition: Condition, case: Case) -> bool:
    """Whether a journey meets a condition; a number that it does not have meets no comparison."""
    match condition:
        case Junction(parts, needs_all):
            return (all if needs_all else any)(_holds(part, case) for part in parts)
        case Negation(other):
            return not _holds(other, case)
        case Word(name, is_so):
            return bool(case.get(name, False)) == is_so
        case Comparison(sides, signs):
            numbers = [case.get(side) if isinstance(side, str) else side for side in sides]
            pairs = zip(signs, numbers, numbers[1:], strict=False)
            return None not in numbers and all(bool(COMPARED[sign](left, right)) for sign, left, right in pairs)
