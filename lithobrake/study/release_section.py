"""The table of the study file that says from which state landers are released, and how far off that may be."""

from typing import Annotated, Any

from pydantic import Field
from pydantic_core import core_schema

from lithobrake.study.quantity import Number, Numbers, Section, is_number, refuse

Matrix = tuple[tuple[float, ...], ...]
SIDE = 6


class SquareMatrix:
    """A list of six lists of six numbers."""

    def __get_pydantic_core_schema__(self, _source: object, _handler: object) -> core_schema.CoreSchema:
        """Let the annotation itself check the value."""
        return core_schema.no_info_plain_validator_function(self.read)

    def read(self, value: Any) -> Matrix:
        """Give back the matrix in its rows."""
        rows = value if isinstance(value, list | tuple) else ()
        if len(rows) != SIDE or not all(isinstance(row, list | tuple) and len(row) == SIDE for row in rows):
            raise refuse(value, f"{SIDE} rows of {SIDE} numbers", "write six lists of six numbers in square brackets")
        if not all(is_number(entry) for row in rows for entry in row):
            raise refuse(value, f"{SIDE} rows of {SIDE} finite numbers", "write finite numbers without quotes")
        return tuple(tuple(float(entry) for entry in row) for row in rows)


class CorrelatedPair:
    """Two names and a number, in a list."""

    def __get_pydantic_core_schema__(self, _source: object, _handler: object) -> core_schema.CoreSchema:
        """Let the annotation itself check the value."""
        return core_schema.no_info_plain_validator_function(self.read)

    def read(self, value: Any) -> tuple[str, str, float]:
        """Give back the names and the correlation."""
        allowed = "two keys and a number between -1 and 1"
        if not isinstance(value, list | tuple) or len(value) != 3 or not all(isinstance(one, str) for one in value[:2]):
            raise refuse(value, allowed, 'write it as ["north_error", "east_error", 0.5]')
        if not is_number(value[2]) or not -1.0 < value[2] < 1.0:
            raise refuse(value, allowed, "write such a number without quotes")
        return value[0], value[1], float(value[2])


Correlation = Annotated[tuple[str, str, float], CorrelatedPair()]


class Deviations(Numbers):
    """One standard deviation, or three."""

    def check(self, value: Any) -> tuple[float, ...]:
        """Give back three numbers."""
        return super().check([value] * 3 if is_number(value) else value)


class ReleaseSection(Section):
    """The mean state in which a carrier releases the lander, in the axes of delivery.frame. The state of each journey
    is sampled from a normal distribution about it, and the lander flies to the ground. The spread is `covariance`, or
    `position_std` and `velocity_std`; without them all journeys begin in the same state."""

    time: Annotated[float, Number("s")] = 0.0
    """Time of the release, counted from delivery.epoch."""
    position: Annotated[tuple[float, ...], Numbers("m")] = Field(examples=["[0.0, -300.0, 0.0]"])
    """x, y, z from the centre of the body."""
    velocity: Annotated[tuple[float, ...], Numbers("m/s")] = Field(examples=["[0.0, 0.03, 0.0]"])
    """Along the same axes."""
    position_std: Annotated[tuple[float, ...], Deviations("m", at_least=0)] | None = Field(
        default=None, examples=["30.0"]
    )
    """Standard deviation in every direction, or three: up, from the centre of the body; north; east."""
    velocity_std: Annotated[tuple[float, ...], Deviations("m/s", at_least=0)] | None = Field(
        default=None, examples=["0.0067"]
    )
    """The same for the velocity."""
    covariance: Annotated[Matrix, SquareMatrix()] | None = None
    """Instead of these: six rows of six numbers, for x, y, z, vx, vy, vz along the axes of delivery.frame [m2, m2/s,
    m2/s2]."""
