"""The attitude of a study's lander at its touchdowns: terms that its symmetry leaves, and the side that is down."""

import math
from collections.abc import Mapping

import numpy as np

from lithobrake.geometry.attitude_terms import ALIKE, AttitudeTerms, orthonormal, seen_from_lander
from lithobrake.pipeline.design.drawn_design import AZIMUTH, DrawnDesign
from lithobrake.study import Study
from lithobrake.study.touchdown_model import ORIENTATION, lander, medians
from lithobrake.vocabulary.arrays import Array

# Sides of a lander, by its own axes.
SIDES = ("+x", "-x", "+y", "-y", "+z", "-z")
# Names of the terms among the inputs of a touchdown.
PREFIX = "attitude."


def attitude_terms(study: Study) -> AttitudeTerms | None:
    """The terms of the lander's attitude; None for a ball."""
    section = study.lander
    if section.shape == "sphere":
        return None
    if section.edges is not None:
        moments = None if section.inertia is None else np.array(section.inertia)
        return AttitudeTerms.of_box(np.array(section.edges), moments)
    body = lander(study, medians(study))
    return AttitudeTerms.of_body(body.shape.inertia_per_density if body.inertia is None else body.inertia)


def attitude_inputs_of(terms: AttitudeTerms, inputs: Mapping[str, np.ndarray]) -> dict[str, Array]:
    """The terms of touchdowns by the names of inputs, [run_count] each; inputs: of the touchdowns, [run_count] each."""
    return named_terms(terms, *seen(inputs))


def named_terms(terms: AttitudeTerms, normal: Array, travel: Array) -> dict[str, Array]:
    """The same of normals and directions of travel [run_count, 3], seen from the lander."""
    names = [f"{PREFIX}{name}" for name in terms.ranges]
    # Rounding may put a term beyond its end.
    columns = np.clip(terms.at(normal, travel), *np.array(list(terms.ranges.values())).T)
    return dict(zip(names, columns.T, strict=True))


def seen(inputs: Mapping[str, np.ndarray]) -> tuple[Array, Array]:
    """Normal of the ground and direction of travel, [run_count, 3], seen from the lander at its touchdowns."""
    orientation = np.column_stack([inputs[name] for name in ORIENTATION])
    return seen_from_lander(orientation, np.radians(inputs[AZIMUTH]))


def independent_terms(design: DrawnDesign, inputs: Mapping[str, np.ndarray]) -> Array | None:
    """Terms of the attitude of the drawn runs [run_count, term_count] of mean 0, variance 1 and no correlation.

    Over the law of their attitudes: that of any attitude, or else that of the runs themselves. None for a ball, for
    touchdowns that tell no attitude, and where all have the same.
    """
    terms = attitude_terms(design.study)
    if terms is None or not {*ORIENTATION, AZIMUTH} <= inputs.keys():
        return None
    found, law = terms.at(*seen(inputs)), terms.uniform_law
    if design.study.impact.orientation != "random" or design.is_flown:
        own = found - found.mean(axis=0)
        law = found.mean(axis=0), own.T @ own / len(own)
    independent = orthonormal(found, law)
    return independent if independent.shape[1] else None


def sides_down(study: Study, normal: Array) -> np.ndarray:
    """Which side of the lander faces the ground most, [count]; "" for a ball. normal: seen from the lander [count, 3].

    Of a box by the axis that stands most upright, "z", or by those whose edges are alike, "x or y"; of a mesh one of
    "+x" to "-z", by its own axes.
    """
    section, axis = study.lander, np.abs(normal).argmax(axis=1)
    if section.edges is not None:
        words = np.array([_alike(section.edges, one) for one in range(3)])
        found: np.ndarray = words[axis]
        return found
    if section.shape == "sphere":
        return np.full(len(normal), "")
    upward = np.take_along_axis(normal, axis[:, None], axis=1)[:, 0] > 0.0
    sides: np.ndarray = np.array(SIDES)[2 * axis + upward]
    return sides


def directions_of_sides(study: Study) -> dict[str, list[list[float]]]:
    """The sides of the lander, named as by `sides_down`, each with the directions of it that may face the ground."""
    downs = [sign * axis for axis in np.eye(3) for sign in (1.0, -1.0)]
    names = sides_down(study, -np.array(downs)).tolist()
    found: dict[str, list[list[float]]] = {name: [] for name in dict.fromkeys(names) if name}
    for name, down in zip(names, downs, strict=True):
        if name:
            found[name].append(down.tolist())
    return found


def side_words(study: Study, side: str) -> str:
    """A side in words: of a box with the lengths of its face [m]."""
    edges = study.lander.edges
    if edges is None:
        return side
    first, second = (length for axis, length in enumerate(edges) if axis != "xyz".index(side[0]))
    return f"{side}, {first:g} m x {second:g} m"


def _alike(edges: tuple[float, float, float], axis: int) -> str:
    """The axes of a box whose faces are like those of one."""
    names = [name for name, edge in zip("xyz", edges, strict=True) if math.isclose(edge, edges[axis], rel_tol=ALIKE)]
    return " or ".join([", ".join(names[:-1]), names[-1]] if len(names) > 1 else names)
