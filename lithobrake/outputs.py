"""What every touchdown gives, and which designs ask for touchdowns, by name; light, for whoever only looks."""

from typing import Literal, get_args

OutputName = Literal["speed_out", "elevation_out", "spin_out", "velocity_out_x", "velocity_out_y", "velocity_out_z"]
OUTPUTS: tuple[OutputName, ...] = get_args(OutputName)
# The designs of a study, in the order in which their runs are made.
DESIGNS = ("screening", "refined", "test_kept", "test_all")
