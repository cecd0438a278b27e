"""What a study refuses of landers on their way to the ground: states below it, impacts and spins beyond the model."""

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.pipeline.site import Site
from lithobrake.study import Study, StudyError
from lithobrake.study.ground_checks import deep_contact, fast_spin
from lithobrake.study.lander_checks import lander_radius
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.constants import GRAVITATIONAL_CONSTANT

if TYPE_CHECKING:
    from lithobrake.smallbody import Shape

# A start so far below the ground is on it, of a millionth of the radius and at most [m].
SLACK_PART, MOST_SLACK = 1e-6, 1e-3


def refuse_below(
    site: Site, fixed: Array, uniform: Array, clock: Array, columns: Mapping[str, Array], source: Sequence[str]
) -> None:
    """Raise StudyError for a state below the ground of the body or of its partner.

    Places [m], [count, 3], fixed to the body, and in the axes that turn uniformly, in which the partner moves; clock:
    time of its motion at each [s], [count].
    """
    body, partner = site.body, site.body.partner
    _refuse_within(site, body.shape, fixed, source, "the ground")
    if partner is not None:
        orbit = body.orbit_with(GRAVITATIONAL_CONSTANT * columns["mass"], 2.0 * np.pi / columns["spin_period"])
        there, _ = orbit.seen_from_partner(uniform, np.zeros_like(uniform), clock)
        _refuse_within(site, partner.body.shape, there, source, f"the surface of {partner.body.name}")


def _refuse_within(site: Site, shape: "Shape", position: np.ndarray, source: Sequence[str], what: str) -> None:
    # The height of a place takes a look at every facet.
    near = np.flatnonzero(np.linalg.norm(position, axis=1) < shape.radius)
    height = np.full(len(position), np.inf)
    height[near] = shape.height(position[near])
    below = np.flatnonzero(height < -min(SLACK_PART * shape.radius, MOST_SLACK))
    if len(below):
        row = int(below[0])
        said = (
            f"{_origin(site.study)}: {source[row]} lies {-height[row]:.3g} m below {what}; allowed: on it or above; is "
            "it counted from the centre of the body, in metres and in the axes of delivery.frame? correct it, or lower "
            "the spread"
        )
        raise StudyError([site.study.said(said)])


def _origin(study: Study) -> str:
    """The key that says where landers come from."""
    return "delivery.states" if study.delivery and study.delivery.states else "delivery.release"


def refuse_fast(study: Study, speed: np.ndarray, source: Sequence[str]) -> float:
    """Return the largest of impact speeds [m/s], 0 of none; source: where each of the landers stands.

    Raises StudyError where it is too fast for any contact.
    """
    if not len(speed):
        return 0.0
    fastest = int(np.argmax(speed))
    # The overlap depends on the stiffness, and a region may have softer grains than [grain].
    for one in (study, *map(study.on_soil, study.soil)) if study.has_soil else ():
        if wrong := deep_contact(one, float(speed[fastest])):
            said = f"{_origin(study)}: {source[fastest]} comes down at {speed[fastest]:.4g} m/s {wrong}"
            raise StudyError([study.said(f"{said}; lower its velocity, or raise Young's modulus")])
    return float(speed[fastest])


def refuse_spinning(study: Study, rates: np.ndarray, speed: float, source: Sequence[str]) -> None:
    """Raise StudyError where one of the angular velocities [count, 3] [rad/s] is too fast at a speed [m/s]."""
    # In Python's own numbers: squares of absurd ones would overflow with a warning.
    spins = [math.hypot(*one) for one in rates.tolist()]
    fastest = int(np.argmax(spins))
    arriving = study.model_copy(update={"impact": study.impact.model_copy(update={"speed": speed})})
    if wrong := fast_spin(arriving, spins[fastest], lander_radius(study.lander)):
        raise StudyError([study.said(f"{_origin(study)}: {source[fastest]}: its rates are {wrong}")])
