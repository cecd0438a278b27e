"""Landings that are drawn from the emulator of a study."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.pipeline.emulate.fitted_emulator import AZIMUTH, ELEVATION, SPEED, SPIN
from lithobrake.pipeline.emulate.outgoing import VELOCITY, outgoing_velocity, rolling_spin
from lithobrake.pipeline.runs.energy_bound import EnergyBound
from lithobrake.vocabulary.quantities import OUTPUTS, SPIN_OUT

if TYPE_CHECKING:
    from lithobrake.emulator import Emulator


@dataclass(frozen=True)
class DrawnLandings:
    """Landings drawn from an emulator.

    outcome [count], places among the touchdown outcomes; outputs by name [count], SI, NaN where the lander did not
    leave; velocity and spin [count, 3].
    """

    outcome: np.ndarray
    outputs: Mapping[str, np.ndarray]

    @classmethod
    def of(cls, model: "Emulator", x: np.ndarray, bound: EnergyBound, seed: int) -> "DrawnLandings":
        """Draw one at each x [count, input_count]; bound: what energy allows each."""
        upper = np.tile(model.runs.upper[0], (len(x), 1))
        speed, spin = (model.output_names.index(name) for name in (SPEED, SPIN))
        bounded = bool(np.isfinite(model.runs.upper[0, speed]))
        if bounded:
            upper[:, speed], upper[:, spin] = bound.speed, bound.spin()
        drawn = model.draw(x, 1, seed, lower=model.runs.lower[0], upper=upper)
        y = drawn.y[:, 0]
        if bounded:
            # Each is within its own bound; what the speed has taken is not there for the spin.
            y[:, spin] = np.minimum(y[:, spin], bound.spin(y[:, speed]))
        return cls(drawn.outcome[:, 0], dict(zip(model.output_names, y.T, strict=True)))

    @cached_property
    def velocity(self) -> np.ndarray:
        """Velocity [m/s] in the frame of the touchdown, of the drawn speed, elevation and azimuth, [count, 3]."""
        return outgoing_velocity(*(self.outputs[name] for name in (SPEED, ELEVATION, AZIMUTH)))

    @cached_property
    def spin(self) -> np.ndarray:
        """Angular velocity [rad/s], of the drawn size about the axis of the run that was drawn, [count, 3].

        Where runs do not tell the axis it is that of rolling along the velocity.
        """
        if SPIN_OUT[0] not in self.outputs:
            return rolling_spin(self.velocity, self.outputs[SPIN])
        axis = np.column_stack([self.outputs[name] for name in SPIN_OUT])
        length = np.linalg.norm(axis, axis=1, keepdims=True)
        spin: np.ndarray = axis / np.where(length > 0.0, length, 1.0) * self.outputs[SPIN][:, None]
        return spin

    def table(self) -> dict[str, np.ndarray]:
        """All outputs by name [count], those that are fitted to in a study of the other method first."""
        of_vectors = dict(zip((*VELOCITY, *SPIN_OUT), np.hstack([self.velocity, self.spin]).T, strict=True))
        found = {**self.outputs, **of_vectors}
        return {name: found[name] for name in dict.fromkeys((*OUTPUTS, *found))}
