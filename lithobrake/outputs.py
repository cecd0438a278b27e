"""What every touchdown gives, by name; light, so that whoever only looks at a study need not load how it is checked."""

from typing import Literal, get_args

OutputName = Literal["speed_out", "elevation_out", "spin_out", "velocity_out_x", "velocity_out_y", "velocity_out_z"]
OUTPUTS: tuple[OutputName, ...] = get_args(OutputName)
