"""The sides of a lander by its own axes, as a study names them."""

from typing import TYPE_CHECKING

from lithobrake.geometry.alike import alike

if TYPE_CHECKING:
    import numpy as np

    from lithobrake.study.lander_section import LanderSection

SIDES = ("+x", "-x", "+y", "-y", "+z", "-z")


def sides_down(lander: "LanderSection", normal: "np.ndarray") -> "np.ndarray":
    """Which side of the lander faces the ground most, [count]; "" for a ball. normal: seen from the lander [count, 3].

    Of a box by the axis that stands most upright, "z", or by those whose edges are alike, "x or y"; of a mesh one of
    "+x" to "-z", by its own axes.
    """
    import numpy as np

    axis = np.abs(normal).argmax(axis=1)
    if lander.edges is not None:
        words = np.array([_alike(lander.edges, one) for one in range(3)])
        found: np.ndarray = words[axis]
        return found
    if lander.shape == "sphere":
        return np.full(len(normal), "")
    upward = np.take_along_axis(normal, axis[:, None], axis=1)[:, 0] > 0.0
    sides: np.ndarray = np.array(SIDES)[2 * axis + upward]
    return sides


def directions_of_sides(lander: "LanderSection") -> dict[str, list[list[float]]]:
    """The sides of the lander, named as by `sides_down`, each with the directions of it that may face the ground."""
    found: dict[str, list[list[float]]] = {}
    for side in SIDES if lander.shape != "sphere" else ():
        axis = "xyz".index(side[1])
        name = side if lander.edges is None else _alike(lander.edges, axis)
        down = [(1.0 if side[0] == "+" else -1.0) * (one == axis) for one in range(3)]
        found.setdefault(name, []).append(down)
    return found


def side_words(lander: "LanderSection", side: str) -> str:
    """A side in words: of a box with the lengths of its face [m]."""
    if lander.edges is None:
        return side
    first, second = (length for axis, length in enumerate(lander.edges) if axis != "xyz".index(side[0]))
    return f"{side}, {first:g} m x {second:g} m"


def _alike(edges: tuple[float, float, float], axis: int) -> str:
    """The axes of a box whose faces are like those of one."""
    names = [name for name, edge in zip("xyz", edges, strict=True) if alike(edge, edges[axis])]
    return " or ".join([", ".join(names[:-1]), names[-1]] if len(names) > 1 else names)
