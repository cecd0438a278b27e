"""What is wrong with a delivery and its journeys: keys that stand twice, correlations, states without a frame."""

import math
from collections.abc import Iterator, Mapping
from contextlib import suppress
from typing import TYPE_CHECKING

from lithobrake.study import delivery_sections
from lithobrake.study.quantity import Uncertain
from lithobrake.study.question_checks import sky_problems
from lithobrake.study.study import Study
from lithobrake.vocabulary.clock import Epoch
from lithobrake.vocabulary.plain_text import closest, show

if TYPE_CHECKING:
    import numpy as np

    from lithobrake.chaos import GaussianCopula

# Of numbers that were written with ten digits.
ROUNDING = 1e-9
AIM = ("latitude_deg", "longitude_deg")
ICRF = ("pole_right_ascension_deg", "pole_declination_deg", "meridian_deg")


def covariance_problems(matrix: delivery_sections.Matrix) -> Iterator[str]:
    """What is wrong with a matrix of six rows, after its name; the first thing alone."""
    pairs = [(row, column) for row in range(delivery_sections.SIDE) for column in range(row)]
    wrong = [text for row in range(delivery_sections.SIDE) if (text := _variance(matrix, row))]
    wrong = wrong or [text for row, column in pairs if (text := _pair(matrix, row, column))]
    if wrong:
        yield wrong[0]
    # Entries that are off by ROUNDING move an eigenvalue by at most SIDE times that.
    elif (smallest := _smallest(matrix)) < -delivery_sections.SIDE * ROUNDING:
        yield (
            f"has correlations whose matrix has the eigenvalue {smallest:.3g}; allowed: none below 0 (positive "
            "semi-definite); weaken correlations that contradict each other, or write more digits"
        )


def _variance(matrix: delivery_sections.Matrix, row: int) -> str | None:
    variance, unit = matrix[row][row], "m" if row < delivery_sections.SIDE / 2 else "m/s"
    largest = delivery_sections.LARGEST[unit] ** 2
    if 0.0 <= variance <= largest:
        return None
    return (
        f"has {variance:g} as the variance in row {row + 1}; allowed: 0 to {largest:g}, the square of "
        f"{delivery_sections.LARGEST[unit]:g} {unit}; mend it"
    )


def _pair(matrix: delivery_sections.Matrix, row: int, column: int) -> str | None:
    one, other = matrix[row][column], matrix[column][row]
    size = math.sqrt(matrix[row][row] * matrix[column][column])
    where = f"row {row + 1}, column {column + 1}"
    if abs(one - other) > ROUNDING * max(abs(one), abs(other)):
        return (
            f"has {one:g} in {where} and {other:g} in row {column + 1}, column {row + 1}; allowed: a symmetric matrix; "
            "make the two equal"
        )
    if abs(one) > size * (1.0 + ROUNDING):
        return f"has {one:g} in {where}; allowed: -{size:g} to {size:g}, by the two variances; lower it, or raise these"
    return None


def _smallest(matrix: delivery_sections.Matrix) -> float:
    """The smallest eigenvalue of its correlations; what has no variance is left out by being correlated with nothing"""
    import numpy as np

    # Of the correlations and not of the covariance: m2 and m2/s2 may differ by ten powers of ten, and no one tolerance
    # would suit both.
    variances = np.array([matrix[row][row] for row in range(delivery_sections.SIDE)])
    scale = np.sqrt(np.where(variances > 0.0, variances, 1.0))
    return float(np.linalg.eigvalsh(np.array(matrix) / np.outer(scale, scale))[0])


def delivery_problems(study: Study) -> Iterator[str]:
    delivery = study.delivery
    if delivery is None:
        return
    yield from _double_problems(study, delivery)
    yield from _correlation_problems(study, delivery)
    if delivery.is_flown:
        found = list(_flown_problems(study, delivery))
        yield from found
        if not found:
            yield from _state_problems(study, delivery)
        return
    for key in ("frame", "epoch", *delivery_sections.OFFSETS, *delivery_sections.VELOCITY_OFFSETS):
        if getattr(delivery, key) is not None:
            yield (
                f"delivery.{key} goes with states or [delivery.release], and neither is given; give one, or leave it "
                "out"
            )


def _double_problems(study: Study, delivery: delivery_sections.DeliverySection) -> Iterator[str]:
    """Keys of [delivery] that stand with another value in the tables that they stand for."""
    for key in delivery_sections.SURFACE_KEYS:
        part = "site" if key in delivery_sections.PLACE_KEYS else "impact"
        value, other = getattr(delivery, key), getattr(getattr(study, part), key)
        if value is not None and value != other:
            yield f"delivery.{key} is {show(value)} and {part}.{key} {show(other)}; keep one of the two"


def _correlation_problems(study: Study, delivery: delivery_sections.DeliverySection) -> Iterator[str]:
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
        if study.expansion is not None and not {one, other} & {*delivery_sections.PLACE_KEYS}:
            yield (
                f"delivery.correlations has {one} and {other}, and [expansion] takes all inputs as independent; leave "
                "one of the two out"
            )
            return
    if delivery.correlations:
        try:
            copula_of(study, correlated_keys(study))
        except ValueError as error:
            yield f"delivery.correlations: {error}"


def _uncorrelated(study: Study, key: str) -> str | None:
    if key not in delivery_sections.SURFACE_KEYS:
        allowed = ", ".join(delivery_sections.SURFACE_KEYS)
        return (
            f"delivery.correlations names {show(key)}{closest(key, delivery_sections.SURFACE_KEYS)}; allowed: {allowed}"
        )
    value = getattr(study.site if key in delivery_sections.PLACE_KEYS else study.impact, key)
    if isinstance(value, Uncertain):
        return None
    return (
        f"delivery.correlations names {key}, which is {show(value)}; allowed: keys with a distribution; give it one, "
        "or leave the pair out"
    )


def _flown_problems(study: Study, delivery: delivery_sections.DeliverySection) -> Iterator[str]:
    name = "delivery.states" if delivery.states is not None else "[delivery.release]"
    if delivery.states is not None and delivery.release is not None:
        yield "delivery.states and [delivery.release] are both given; keep one"
    for key in delivery_sections.FLOWN:
        part = "site" if key in delivery_sections.PLACE_KEYS else "impact"
        # A flown study has these where its file gives nothing.
        if getattr(getattr(study, part), key) not in (None, 0.0, delivery_sections.ANY_HEADING):
            yield f"{part}.{key} is given, and the flight from {name} tells it; leave it out"
    for key in AIM:
        value, is_given = getattr(study.site, key), key in study.site.model_fields_set
        if isinstance(value, Uncertain) or not is_given:
            yield (
                f"delivery.{key} is {show(value) if is_given else 'missing'}; allowed with {name}: one number, that of "
                "the aim point; write it"
            )
    yield from _frame_problems(study, delivery, name)


def _frame_problems(study: Study, delivery: delivery_sections.DeliverySection, name: str) -> Iterator[str]:
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
    try:
        epoch = Epoch.of(delivery.epoch)
    except ValueError as error:
        yield f"delivery.epoch {error}"
        return
    # One that is no date is refused where kernels are checked.
    with suppress(ValueError):
        if study.site.epoch is not None and Epoch.of(study.site.epoch) != epoch:
            yield (
                f"delivery.epoch is {delivery.epoch} and site.epoch {study.site.epoch}; both say when the partner "
                "stands where it does: make them equal"
            )


def _state_problems(study: Study, delivery: delivery_sections.DeliverySection) -> Iterator[str]:
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


def _release_problems(release: delivery_sections.ReleaseSection) -> Iterator[str]:
    spreads = [key for key in ("position_std", "velocity_std") if getattr(release, key) is not None]
    if release.covariance is not None and spreads:
        yield f"delivery.release has covariance and {spreads[0]}; keep one of the two"
    elif len(spreads) == 1:
        yield "delivery.release takes position_std and velocity_std together; write both, 0 for no spread"
    elif release.covariance is not None:
        for text in covariance_problems(release.covariance):
            yield f"delivery.release.covariance {text}"


def correlated_keys(study: "Study") -> tuple[str, ...]:
    """The keys of [delivery] that are correlated with another, those of the place before all others."""
    pairs = () if study.delivery is None else study.delivery.correlations or ()
    named = {key for one, other, _ in pairs for key in (one, other)}
    return tuple(key for key in delivery_sections.SURFACE_KEYS if key in named)


def copula_of(study: "Study", keys: tuple[str, ...]) -> "GaussianCopula":
    """The distribution of these keys together. Raises ValueError for correlations that contradict each other."""
    import numpy as np

    from lithobrake.chaos import GaussianCopula

    laws, matrix = {}, np.eye(len(keys))
    for key in keys:
        value = getattr(study.site if key in delivery_sections.PLACE_KEYS else study.impact, key)
        assert isinstance(value, Uncertain)
        laws[key] = value.to_chaos()
    assert study.delivery is not None
    for one, other, correlation in study.delivery.correlations or ():
        if one in keys and other in keys:
            row, column = keys.index(one), keys.index(other)
            matrix[row, column] = matrix[column, row] = correlation
    return GaussianCopula(laws, matrix)


def drawn_together(study: "Study", columns: "Mapping[str, np.ndarray]") -> "dict[str, np.ndarray]":
    """Columns by key, each [count], of which those that are correlated go together; all else stays as it is.

    columns: independent draws. A key follows from those before it alone, so that the place of a lander is the same
    whether the rest of its arrival is asked for or not.
    """
    keys = tuple(key for key in correlated_keys(study) if key in columns)
    # One alone goes with nothing here.
    if len(keys) < 2:
        return dict(columns)
    import numpy as np

    table = np.column_stack([columns[key] for key in keys])
    return {**columns, **dict(zip(keys, copula_of(study, keys).dependent(table).T, strict=True))}


def drawn_apart(study: "Study", columns: "Mapping[str, np.ndarray]") -> "dict[str, np.ndarray]":
    """The independent draws that columns by key, each [count], came from by `drawn_together`."""
    keys = tuple(key for key in correlated_keys(study) if key in columns)
    if len(keys) < 2:
        return dict(columns)
    import numpy as np

    table = np.column_stack([columns[key] for key in keys])
    return {**columns, **dict(zip(keys, copula_of(study, keys).independent(table).T, strict=True))}


def journey_problems(study: Study) -> Iterator[str]:
    yield from delivery_problems(study)
    yield from sky_problems(study)
    design, journey = study.design, study.journey
    if journey.count is not None and journey.count != design.run_count:
        yield (
            f"journey.count is {journey.count} and design.run_count {design.run_count}; both are the number of "
            "landers: keep one"
        )
    yield from _gravity_problems(study)
    if journey.touchdowns == 1:
        return
    if not study.has_local_ground:
        yield (
            f"surface.gravity is {show(study.surface.gravity)}; later touchdowns take the acceleration of where they "
            "are: leave it out, or set journey.touchdowns = 1"
        )
    if study.has_soil and study.bed.sides != "periodic":
        yield (
            'bed.sides is "walls", and landers that are followed beyond the first touchdown need ground without an '
            'edge; set bed.sides = "periodic", or journey.touchdowns = 1'
        )


def _gravity_problems(study: Study) -> Iterator[str]:
    """What is given of the ground of a touchdown beside the body's own."""
    if not study.has_local_ground and study.delivery is not None and study.delivery.is_flown:
        yield (
            f"surface.gravity is {show(study.surface.gravity)}, and landers that fly to the ground from a state take "
            "the acceleration of where they touch down; leave it out"
        )
    if not study.has_local_ground and study.site.roughness_deg:
        yield (
            f"site.roughness_deg is {study.site.roughness_deg:g}, and surface.gravity = {show(study.surface.gravity)} "
            "gives all touchdowns one ground; leave one of the two out, or tilt the ground by surface.slope_deg"
        )
    if study.has_local_ground and study.surface.model_fields_set & {"slope_deg", "slope_azimuth_deg"}:
        yield (
            'surface.slope_deg is given; with surface.gravity = "site" every touchdown has the slope of where it is; '
            "leave it out, or give surface.gravity a number"
        )
    if study.has_local_ground and study.surface.model_fields_set & {"rotation_x", "rotation_y", "rotation_z"}:
        yield (
            'surface.rotation_x, rotation_y or rotation_z is given; with surface.gravity = "site" the ground turns as '
            "the body; leave it out, or give surface.gravity a number"
        )
