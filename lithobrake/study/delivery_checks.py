"""What is wrong with a delivery: keys that stand twice, correlations that cannot be, states without a frame."""

from collections.abc import Iterator

from lithobrake.study.covariance_checks import covariance_problems
from lithobrake.study.journey_sections import ANY_HEADING, FLOWN, OWN_KEYS, PLACE_KEYS, SURFACE_KEYS, DeliverySection
from lithobrake.study.quantity import Uncertain
from lithobrake.study.release_section import ReleaseSection
from lithobrake.study.study import Study
from lithobrake.vocabulary.plain_text import closest, show

AIM = ("latitude_deg", "longitude_deg")
ICRF = ("pole_right_ascension_deg", "pole_declination_deg", "meridian_deg")


def delivery_problems(study: Study) -> Iterator[str]:
    """One sentence for each thing that is wrong."""
    delivery = study.delivery
    if delivery is None:
        return
    yield from _double_problems(study, delivery)
    given = [key for key in OWN_KEYS if getattr(delivery, key) is not None]
    if given and study.journey is None:
        yield f"delivery.{given[0]} goes with [journey], and there is none; add it, or leave the key out"
        return
    yield from _correlation_problems(study, delivery)
    if delivery.is_flown:
        found = list(_flown_problems(study, delivery))
        yield from found
        if not found:
            yield from _state_problems(study, delivery)
        return
    for key in ("frame", "epoch"):
        if getattr(delivery, key) is not None:
            yield (
                f"delivery.{key} goes with states or [delivery.release], and neither is given; give one, or leave it "
                "out"
            )


def _double_problems(study: Study, delivery: DeliverySection) -> Iterator[str]:
    """Keys of [delivery] that stand with another value in the tables that they stand for."""
    for key in SURFACE_KEYS:
        part = "site" if key in PLACE_KEYS else "impact"
        value, other = getattr(delivery, key), getattr(getattr(study, part), key)
        if value is not None and value != other:
            yield f"delivery.{key} is {show(value)} and {part}.{key} {show(other)}; keep one of the two"


def _correlation_problems(study: Study, delivery: DeliverySection) -> Iterator[str]:
    """Correlations of what is not uncertain, that stand twice, or that contradict each other."""
    seen: set[frozenset[str]] = set()
    for one, other, _ in delivery.correlations or ():
        if wrong := next((text for key in (one, other) if (text := _uncorrelated(study, key))), None):
            yield wrong
            return
        if one == other or {one, other} in seen:
            yield (
                f"delivery.correlations has the pair {one} and {other}"
                f"{' twice' if one != other else ''}; allowed: two different keys, each pair once; mend it"
            )
            return
        seen.add(frozenset((one, other)))
    if delivery.correlations:
        from lithobrake.study.correlated_keys import copula_of, correlated_keys

        try:
            copula_of(study, correlated_keys(study))
        except ValueError as error:
            yield f"delivery.correlations: {error}"


def _uncorrelated(study: Study, key: str) -> str | None:
    """Why a key cannot be correlated."""
    if key not in SURFACE_KEYS:
        allowed = ", ".join(SURFACE_KEYS)
        return f"delivery.correlations names {show(key)}{closest(key, SURFACE_KEYS)}; allowed: {allowed}"
    value = getattr(study.site if key in PLACE_KEYS else study.impact, key)
    if isinstance(value, Uncertain):
        return None
    return (
        f"delivery.correlations names {key}, which is {show(value)}; allowed: keys with a distribution; give it one, "
        "or leave the pair out"
    )


def _flown_problems(study: Study, delivery: DeliverySection) -> Iterator[str]:
    """Keys that do not go together with states."""
    name = "delivery.states" if delivery.states is not None else "[delivery.release]"
    if delivery.states is not None and delivery.release is not None:
        yield "delivery.states and [delivery.release] are both given; keep one"
    for key in FLOWN:
        part = "site" if key in PLACE_KEYS else "impact"
        if getattr(getattr(study, part), key) not in (None, 0.0, ANY_HEADING):
            yield f"{part}.{key} is given, and the flight from {name} tells it; leave it out"
    for key in AIM:
        value, is_given = getattr(study.site, key), key in study.site.model_fields_set
        if isinstance(value, Uncertain) or not is_given:
            yield (
                f"delivery.{key} is {show(value) if is_given else 'missing'}; allowed with {name}: one number, that of "
                "the aim point; write it"
            )
    yield from _frame_problems(study, delivery, name)


def _frame_problems(study: Study, delivery: DeliverySection, name: str) -> Iterator[str]:
    """Axes that are not named, or not known."""
    if delivery.frame is None:
        yield f'delivery.frame is missing; allowed with {name}: "body_fixed" or "icrf"; write the axes of the states'
    lacking = [key for key in ICRF if getattr(study.site, key) is None]
    if delivery.frame == "icrf" and lacking:
        yield (
            f'site.{lacking[0]} is missing; delivery.frame = "icrf" goes through the pole and the prime meridian of '
            "the body at delivery.epoch; write all three"
        )
    if delivery.frame == "icrf" and delivery.epoch is None:
        yield (
            'delivery.epoch is missing; delivery.frame = "icrf" goes through site.meridian_deg, which holds at that '
            "date and time; write it"
        )
    if delivery.epoch is None:
        return
    # Arrays come with it, and a study without states is read without them.
    from lithobrake.study.delivered_states import parsed_time

    try:
        epoch = parsed_time(delivery.epoch)
        if study.site.epoch is not None and parsed_time(study.site.epoch) != epoch:
            yield (
                f"delivery.epoch is {delivery.epoch} and site.epoch {study.site.epoch}; both say when the partner "
                "stands where it does: make them equal"
            )
    except ValueError as error:
        yield f"delivery.epoch {error}"


def _state_problems(study: Study, delivery: DeliverySection) -> Iterator[str]:
    """States that cannot be read, or are too few, and a spread that is none."""
    if delivery.release is not None:
        yield from _release_problems(delivery.release)
        return
    from lithobrake.study.delivered_states import states_of

    try:
        count = len(states_of(study).time)
    except ValueError as error:
        yield f"delivery.states: {error}"
        return
    if count < study.design.most_runs:
        key = "journey.count" if study.design.half_width is None else "design.largest_run_count"
        yield (
            f"{key} is {study.design.most_runs} and delivery.states has {count} rows; allowed: at most as many "
            "journeys as rows, each of which is one lander; lower it, or give more rows"
        )


def _release_problems(release: ReleaseSection) -> Iterator[str]:
    spreads = [key for key in ("position_std", "velocity_std") if getattr(release, key) is not None]
    if release.covariance is not None and spreads:
        yield f"delivery.release has covariance and {spreads[0]}; keep one of the two"
    elif len(spreads) == 1:
        yield "delivery.release takes position_std and velocity_std together; write both, 0 for no spread"
    elif release.covariance is not None:
        for text in covariance_problems(release.covariance):
            yield f"delivery.release.covariance {text}"
