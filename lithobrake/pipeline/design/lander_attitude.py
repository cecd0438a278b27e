"""The attitude of a study's lander at its touchdowns and at rest: terms, and sides that are down."""

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from lithobrake.geometry.attitude import LEAST_VARIANCE, AttitudeTerms, orthonormal, seen_from_lander
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.study import Study
from lithobrake.study.lander_section import side_toward
from lithobrake.touchdown.lander_model import lander
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.quantities import IMPACT_AZIMUTH, ORIENTATION, SIDES

if TYPE_CHECKING:
    from lithobrake.chaos import Distribution

# Names of the terms among the inputs of a touchdown.
PREFIX = "attitude."


def attitude_terms(study: Study) -> AttitudeTerms | None:
    """The terms of the lander's attitude; None for a ball."""
    section = study.lander
    if section.is_ball:
        return None
    if section.is_plain_box:
        moments = None if section.inertia is None else np.array(section.inertia)
        return AttitudeTerms.of_box(np.array(section.edges), moments)
    return AttitudeTerms.of_body(lander(study, study.touchdown_medians()).body.inertia)


def attitude_inputs_of(terms: AttitudeTerms, inputs: Mapping[str, np.ndarray]) -> dict[str, Array]:
    """The terms of touchdowns by the names of inputs, [run_count] each; inputs: of the touchdowns, [run_count] each."""
    return named_terms(terms, *seen(inputs))


def named_terms(terms: AttitudeTerms, normal: Array, travel: Array) -> dict[str, Array]:
    """The same of normals and directions of travel [run_count, 3], seen from the lander."""
    names = [f"{PREFIX}{name}" for name in terms.ranges]
    # Rounding may put a term beyond its end.
    columns = np.clip(terms.at(normal, travel), *np.array(list(terms.ranges.values())).T)
    return dict(zip(names, columns.T, strict=True))


def tells_attitude(inputs: Mapping[str, np.ndarray]) -> bool:
    """Whether touchdowns say in which attitude they are; those of a program need not."""
    return {*ORIENTATION, IMPACT_AZIMUTH} <= inputs.keys()


def told_attitudes(study: Study, inputs: Mapping[str, np.ndarray]) -> dict[str, Array]:
    """The terms of touchdowns as inputs, [run_count] each; none of a ball, and where attitudes are not told."""
    terms = attitude_terms(study)
    return {} if terms is None or not tells_attitude(inputs) else attitude_inputs_of(terms, inputs)


def is_any_attitude(design: DrawnDesign) -> bool:
    """Whether the attitudes of the first touchdowns are uniform over all rotations.

    Attitudes that are pointed or propagated follow no law in closed form.
    """
    return design.study.impact.orientation == "random" and not design.is_flown


def attitude_laws(design: DrawnDesign, inputs: Mapping[str, np.ndarray]) -> "dict[str, Distribution]":
    """The terms that an emulator of the first touchdowns reads: those that vary, over all their values or the runs'.

    inputs: of the drawn runs, [run_count] each.
    """
    from lithobrake.chaos import Uniform

    found = told_attitudes(design.study, inputs)
    if is_any_attitude(design) and found:
        terms = attitude_terms(design.study)
        assert terms is not None
        return {f"{PREFIX}{name}": Uniform(*ends) for name, ends in terms.ranges.items()}
    varying = {name: values for name, values in found.items() if np.var(values) > LEAST_VARIANCE}
    return {name: Uniform(float(values.min()), float(values.max())) for name, values in varying.items()}


def drawn_attitudes(
    design: DrawnDesign, inputs: Mapping[str, np.ndarray], sampled: Mapping[str, ArrayLike], count: int, seed: int
) -> dict[str, Array]:
    """Terms of attitudes as the study has them at its first touchdowns, [count] each; none of a ball.

    Any attitude, or those of the drawn runs, of which inputs has the inputs. sampled: other inputs, which may say how
    the lander travels in the bed.
    """
    terms, random = attitude_terms(design.study), np.random.default_rng(seed)
    if terms is None or not tells_attitude(inputs):
        return {}
    if is_any_attitude(design):
        into_frame = Rotation.random(count, rng=random).as_matrix()
        return named_terms(terms, into_frame[:, 2], into_frame[:, 0])
    run = random.integers(len(inputs[IMPACT_AZIMUTH]), size=count)
    told = {name: inputs[name][run] for name in (*ORIENTATION, IMPACT_AZIMUTH)}
    if IMPACT_AZIMUTH in sampled:
        told[IMPACT_AZIMUTH] = np.broadcast_to(sampled[IMPACT_AZIMUTH], count)
    return attitude_inputs_of(terms, told)


def attitude_rows(
    design: DrawnDesign, inputs: Mapping[str, np.ndarray], names: Sequence[str]
) -> list[list[float]] | None:
    """Some terms of the attitudes of the drawn runs, [run_count][term_count]; None where any attitude is as likely."""
    if is_any_attitude(design) or not names:
        return None
    told = told_attitudes(design.study, inputs)
    return [list(row) for row in zip(*(told[name].tolist() for name in names), strict=True)]


def seen(inputs: Mapping[str, np.ndarray]) -> tuple[Array, Array]:
    """Normal of the ground and direction of travel, [run_count, 3], seen from the lander at its touchdowns."""
    orientation = np.column_stack([inputs[name] for name in ORIENTATION])
    return seen_from_lander(orientation, np.radians(inputs[IMPACT_AZIMUTH]))


def independent_terms(design: DrawnDesign, inputs: Mapping[str, np.ndarray]) -> Array | None:
    """Terms of the attitude of the drawn runs [run_count, term_count] of mean 0, variance 1 and no correlation.

    Over the law of their attitudes: that of any attitude, or else that of the runs themselves. None for a ball, for
    touchdowns that tell no attitude, and where all have the same.
    """
    terms = attitude_terms(design.study)
    if terms is None or not tells_attitude(inputs):
        return None
    found, law = terms.at(*seen(inputs)), terms.uniform_law
    if not is_any_attitude(design):
        own = found - found.mean(axis=0)
        law = found.mean(axis=0), own.T @ own / len(own)
    independent = orthonormal(found, law)
    return independent if independent.shape[1] else None


def with_side_down(down: Array, azimuth_deg: Array, turn: Array) -> Array:
    """Attitudes as quaternions w, x, y, z [count, 4] that turn a direction of the lander [count, 3] straight down.

    azimuth_deg: of the travel in the bed; turn: about the vertical, a uniform number of each, [count].
    """
    least = np.eye(3)[np.abs(down).argmin(axis=1)]
    east = np.cross(down, least)
    east /= np.linalg.norm(east, axis=1, keepdims=True)
    angle = 2.0 * np.pi * turn[:, None]
    travel = np.cos(angle) * east + np.sin(angle) * np.cross(down, east)
    into_frame = np.stack([travel, np.cross(-down, travel), -down], axis=1)
    turned = Rotation.from_euler("z", azimuth_deg[:, None], degrees=True) * Rotation.from_matrix(into_frame)
    quaternions: Array = np.roll(turned.as_quat(), 1, axis=1)
    return quaternions


def side_down(attitude: Rotation, acceleration: np.ndarray) -> tuple[str, float]:
    """The side of the lander that points down most, and the angle [rad] between it and the plumb line.

    attitude: of the lander, acceleration [m/s2]: of what rests there, both in one frame.
    """
    down = attitude.inv().apply(acceleration / np.linalg.norm(acceleration))
    side = int(side_toward(down[None])[0])
    return SIDES[side], math.acos(min(abs(float(down[side // 2])), 1.0))
