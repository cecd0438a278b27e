"""Ground that is rough at the scale of a lander: which way the ground faces that it meets.

The gradient of the ground against the facets of a shape has two components that are normal and independent, so its size
has a Rayleigh distribution and its direction is any. Seen along a velocity, ground that faces the lander covers more of
the view than its share of the map: a gradient is met with a probability that goes with 1 + (gradient along the way)
tan(incidence), and ground that faces away is not met. What stands in the way farther off is left out.
Source: [Shepard-2001] (rms slope, and that it belongs to a scale).
"""

import math

import numpy as np

from lithobrake.smallbody.bounce import impact_frame
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.given_numbers import finite_number

# Standard deviations within which a gradient lies, and halvings of their width down to the last bit.
FARTHEST, HALVINGS = 9.0, 60


def met_normals(velocity: Array, up: Array, roughness: float, uniforms: Array) -> Array:
    """Unit normals of the ground at the impacts, [count, 3], in the axes of the velocities.

    velocity [m/s] and up, unit normals of the ground without roughness, both [count, 3]; roughness: the angle [rad]
    whose tangent is the root mean square of the gradient, from 0 to below a right angle; uniforms [count, 2]: numbers
    between 0 and 1 that draw the gradient.
    """
    finite_number("roughness", roughness, at_least=0.0, below=0.5 * math.pi)
    if roughness == 0.0 or not len(velocity):
        return up
    from scipy.special import ndtri

    axes = impact_frame(velocity, up)
    along, down = ((axes[:, which] * velocity).sum(axis=1) for which in (0, 2))
    # The two components share the mean square of the gradient.
    std = math.tan(roughness) / math.sqrt(2.0)
    # A lander that comes in along the ground, or from below it for rounding, meets what rises before it.
    steepness = np.maximum(std * along / np.maximum(-down, 1e-12 * np.linalg.norm(velocity, axis=1)), 0.0)
    # At 0 and 1 the gradient would be infinite.
    first, second = np.clip(uniforms, 2.0**-54, 1.0 - 2.0**-53).T
    rise, aside = std * _met(steepness, first), std * ndtri(second)
    normal = axes[:, 2] - rise[:, None] * axes[:, 0] - aside[:, None] * axes[:, 1]
    found: Array = normal / np.linalg.norm(normal, axis=1, keepdims=True)
    return found


def _met(steepness: Array, uniform: Array) -> Array:
    """Numbers x [count] of a density that goes with (1 + steepness x) exp(-x**2 / 2) where that is above 0."""
    from scipy.special import ndtr

    with np.errstate(divide="ignore"):
        low = np.maximum(-1.0 / steepness, -FARTHEST)
    high = np.full_like(low, FARTHEST)

    def below(x: Array) -> Array:
        density = np.exp(-0.5 * x**2) / math.sqrt(2.0 * math.pi)
        # The integral in closed form: x exp(-x^2 / 2) is minus the derivative of exp(-x^2 / 2).
        found: Array = ndtr(x) - steepness * density
        return found

    least, most = below(low), below(high)
    wanted = least + uniform * (most - least)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        is_less = below(middle) < wanted
        low, high = np.where(is_less, middle, low), np.where(is_less, high, middle)
    return 0.5 * (low + high)


def incidence_on(velocity: Array, up: Array) -> Array:
    """Angles of velocities from the inward normals [rad], [count], of velocities and unit normals [count, 3]."""
    down = -(velocity * up).sum(axis=1) / np.linalg.norm(velocity, axis=1)
    found: Array = np.arccos(np.clip(down, -1.0, 1.0))
    return found
