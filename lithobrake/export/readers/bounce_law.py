"""Draws rebounds of a lander from a bounce law, a file of `lithobrake export --to bounce-law`. Needs NumPy alone.

    law = BounceLaw("bounce_law.txt")
    rebound = law.draw(law.soil(seed=1, journey=0) | {"impact.speed": 0.05, ...}, seed=1, draw=0)

The head of the law says what it was made from, and has its frame, units and ranges. bounce_law.c draws the same.

Copyright (c) 2026, lithobrake contributors. SPDX-License-Identifier: BSD-3-Clause
"""

import math
import os
import zlib
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

MAGIC, VERSION = "lithobrake bounce law", 1
# Places of the random numbers of a draw: outcome, row, four of its smoothing, row at rest, three of the attitude; soil.
OUTCOME, ROW, NOISE, REST, ATTITUDE, SOIL = 0, 1, 2, 6, 7, 10
_MASK, _STEP = (1 << 64) - 1, 0x9E3779B97F4A7C15


class OutsideRangeError(ValueError):
    """A touchdown unlike those that the law was made from."""


class Rebound(NamedTuple):
    """How a touchdown ends, in its frame; NaN where the outcome leaves it unknown.

    outcome   clear: it leaves; captured: it is at rest in the ground; another word: not known
    velocity  [m/s] and spin [rad/s], [3] each, against the ground; 0 where it is captured
    attitude  quaternion w, x, y, z that turns the lander's axes into the frame, at the end
    duration  from first contact to the end [s]; way of the centre of mass meanwhile [m], [3]
    row       of the landing whose scatter and direction it has
    """

    outcome: str
    velocity: np.ndarray
    spin: np.ndarray
    attitude: np.ndarray
    duration: float
    way: np.ndarray
    row: int


def _mixed(x: int) -> int:
    x = ((x ^ (x >> 30)) * 0xBF58476D1CE4E5B9) & _MASK
    x = ((x ^ (x >> 27)) * 0x94D049BB133111EB) & _MASK
    return x ^ (x >> 31)


def uniform(seed: int, draw: int, place: int) -> float:
    """The number between 0 and 1, neither included, at a place of a draw: SplitMix64 [Steele-2014], counted, not
    stepped.

    Output number `draw` of a generator that starts at the mixed seed starts another; that gives output number `place`.
    """
    start = _mixed((_mixed((seed + _STEP) & _MASK) + _STEP * (draw + 1)) & _MASK)
    return ((_mixed((start + _STEP * (place + 1)) & _MASK) >> 12) + 0.5) * 2.0**-52


class BounceLaw:
    """The law of a file. conditions: names of what it reads of a touchdown, units and ranges (lower, upper) of each."""

    def __init__(self, path: str | os.PathLike[str]) -> None:
        """Read a law. Raises ValueError for another file, another version, and one that was changed."""
        self.path = Path(path)
        self.names: dict[str, list[str]] = {}
        self.numbers: dict[str, np.ndarray] = {}
        words = _words(self.path)
        try:
            self._read(iter(words))
        except (StopIteration, ValueError) as error:
            raise ValueError(f"{path} is damaged ({error!r}): export the law again") from None
        self.conditions, self.outcomes = self.names["conditions"], self.names["outcomes"]
        self.units = dict(zip(self.conditions, self.names["units"], strict=True))
        ends = zip(self.numbers["lower"].tolist(), self.numbers["upper"].tolist(), strict=True)
        self.ranges = dict(zip(self.conditions, ends, strict=True))
        # Fit 0 is that to all landings, the others are to beds drawn with replacement.
        self.fit_count = len(self.numbers["location"])

    def _read(self, words: Iterator[str]) -> None:
        for kind in words:
            name, rank = next(words), 1 if kind == "names" else int(next(words))
            shape = [int(next(words)) for _ in range(rank)]
            values = [next(words) for _ in range(math.prod(shape))]
            if kind == "names":
                self.names[name] = values
            else:
                self.numbers[name] = np.array(values, dtype=float).reshape(shape)

    def soil(self, seed: int, journey: int) -> dict[str, float]:
        """What stays the same on all of a journey, soil and lander, as a lander of the study had it: draw it once."""
        soils = self.numbers["soils"]
        row = soils[int(uniform(seed, journey, SOIL) * len(soils))]
        places = self.numbers["soil_places"].astype(int).tolist()
        return {self.conditions[place]: float(value) for place, value in zip(places, row, strict=True)}

    def draw(
        self, conditions: Mapping[str, float], seed: int, draw: int, *,
        attitude: Sequence[float] | None = None, spin: Sequence[float] | None = None, fit: int = 0,
    ) -> Rebound:  # fmt: skip
        """Draw one rebound; the same seed and draw give the same numbers whatever was drawn before.

        conditions: all by name, in their units. attitude: quaternion w, x, y, z that turns the lander's axes into the
        frame of the touchdown; None: any. spin: of the arrival in that frame [rad/s], [3], which bounds the energy;
        None: that of the median arrival. fit: keep one over a journey.
        Raises OutsideRangeError for a condition beyond its range, ValueError for one that is missing or no number.
        """
        x = self._checked(conditions, fit, spin)
        random = [uniform(seed, draw, place) for place in range(SOIL)]
        terms = self._terms(np.concatenate([x[: self._plain_count], self._attitude_terms(attitude, random[ATTITUDE:])]))
        leaves, rests = self.numbers["outcome_places"].astype(int).tolist()
        outcome = _place(np.cumsum(self._chances(terms, fit)), random[OUTCOME])
        name = self.outcomes[outcome]
        if outcome == rests:
            rest = self.numbers["rest_rows"]
            row = rest[int(random[REST] * len(rest))]
            return Rebound(name, np.zeros(3), np.zeros(3), row[4:], float(row[0]), row[1:4], -1)
        if outcome != leaves:
            unknown = np.full(3, math.nan)
            return Rebound(name, unknown, unknown, np.full(4, math.nan), math.nan, unknown, -1)
        number = self._row(terms, fit, random[ROW])
        row = self.numbers["leaving_rows"][number]
        speed, elevation, rate = self._outputs(terms, number, fit, random[NOISE:], x, spin)
        level, azimuth = speed * math.cos(elevation), float(row[0])
        velocity = np.array([level * math.cos(azimuth), level * math.sin(azimuth), speed * math.sin(elevation)])
        return Rebound(name, velocity, rate * row[1:4], row[8:], float(row[4]), row[5:8], number)

    @property
    def _plain_count(self) -> int:
        return len(self.numbers["is_log"]) - len(self.numbers["attitude_ranges"])

    def _checked(self, conditions: Mapping[str, float], fit: int, spin: Sequence[float] | None) -> np.ndarray:
        if set(conditions) != set(self.conditions):
            raise ValueError(f"conditions are {', '.join(conditions)}; give exactly {', '.join(self.conditions)}")
        if not 0 <= fit < self.fit_count:
            raise ValueError(f"fit is {fit}; allowed: 0 to {self.fit_count - 1}")
        if spin is not None and not (len(spin) == 3 and all(map(math.isfinite, spin))):
            raise ValueError(f"spin is {list(spin)}; allowed: three finite numbers")
        for name, (lower, upper) in self.ranges.items():
            value, unit = float(conditions[name]), self.units[name]
            if not (lower <= value <= upper and math.isfinite(value)):
                told = f"{value:g}" if unit == "-" else f"{value:g} {unit}"
                raise OutsideRangeError(f"{name} is {told}, but the law holds from {lower:g} to {upper:g}")
        return np.array([float(conditions[name]) for name in self.conditions])

    def _attitude_terms(self, attitude: Sequence[float] | None, random: Sequence[float]) -> np.ndarray:
        """Terms of the attitude: how the ground's normal and the direction of travel lie as seen from the lander."""
        axes, ranges = self.numbers["attitude_axes"], self.numbers["attitude_ranges"]
        if not len(ranges):
            return np.empty(0)
        turned = _matrix(_any_attitude(*random[:3]) if attitude is None else attitude)
        n, t, b = (axes @ one for one in (turned[2], turned[0], np.cross(turned[2], turned[0])))
        has_sides, is_cube = self.numbers["attitude_kind"]
        if is_cube:
            found = np.array([(n**4).sum(), (n**3 * t).sum(), (n**2 * (t**2 - b**2)).sum()])
        else:
            second = np.column_stack([n**2, 2.0 * n * t, t**2 - b**2])
            found = np.concatenate([second[:2].ravel(), n, t]) if has_sides else second.ravel()
        return np.clip(found, ranges[:, 0], ranges[:, 1])

    def _terms(self, inputs: np.ndarray) -> np.ndarray:
        """Products of orthonormal polynomials of the inputs [term_count]; the first are the standardised inputs."""
        n = self.numbers
        germ = (np.where(n["is_log"] > 0.0, np.log(np.where(n["is_log"] > 0.0, inputs, 1.0)), inputs)
                - n["germ_zero"]) * n["germ_slope"]  # fmt: skip
        table = np.ones((n["center"].shape[1] + 1, len(germ)))
        for k in range(len(table) - 1):
            below = n["spread"][:, k - 1] * table[k - 1] if k else 0.0
            table[k + 1] = ((germ - n["center"][:, k]) * table[k] - below) / n["spread"][:, k]
        return np.asarray(table[n["multi_indices"].astype(int), np.arange(len(germ))].prod(axis=1))

    def _chances(self, terms: np.ndarray, fit: int) -> np.ndarray:
        never = self.numbers["class_never"][fit]
        logits = self.numbers["class_intercepts"][fit] + self.numbers["class_slopes"][fit] @ terms
        logits[never > 0.0] = -math.inf
        shares = np.exp(logits - logits.max())
        return np.asarray(never + (1.0 - never.sum()) * shares / shares.sum())

    def _row(self, terms: np.ndarray, fit: int, random: float) -> int:
        """The landing that gives scatter and direction: one whose inputs are near, where the law looks at that."""
        widths, inputs = self.numbers["kernel_widths"], self.numbers["row_inputs"]
        near = np.isfinite(widths)
        square = (((terms[: len(widths)] - inputs)[:, near] / widths[near]) ** 2).sum(axis=1)
        return _place(np.cumsum(self.numbers["row_weights"][fit] * np.exp(-0.5 * (square - square.min()))), random)

    def _outputs(
        self, terms: np.ndarray, row: int, fit: int, random: Sequence[float], x: np.ndarray,
        spin: Sequence[float] | None,
    ) -> list[float]:  # fmt: skip
        """Speed [m/s], elevation [rad], rate of spin [rad/s]: location and scale at the inputs, residuals of a row."""
        n = self.numbers
        size = n["smoothing_size"][fit]
        scatter = (n["rows"][fit, row] + size * (n["smoothing_root"][fit] @ _normals(random))) / math.sqrt(
            1.0 + size**2
        )
        location, scale = (n[name][fit, 0] + terms @ n[name][fit, 1:] for name in ("location", "log_scale"))
        coordinate = location + np.exp(np.clip(scale, *n["scale_limits"][fit])) * scatter
        upper, gyration = n["output_upper"].copy(), 0.0
        if math.isfinite(upper[0]):
            upper[0], gyration = self._most(x, spin)
            upper[2] = upper[0] / gyration
        ends = zip(coordinate.tolist(), n["output_lower"].tolist(), upper.tolist(), n["distant"].tolist(), strict=True)
        y = [_from_coordinate(*one) for one in ends]
        if gyration:
            # What the speed has taken of the energy is not there for the spin.
            y[2] = min(y[2], math.sqrt(max(upper[0] ** 2 - y[0] ** 2, 0.0)) / gyration)
        return y

    def _most(self, x: np.ndarray, spin: Sequence[float] | None) -> tuple[float, float]:
        """Speed [m/s] that energy allows, and smallest radius of gyration [m]."""
        height, across, limit, smallest, largest, mass_power, diameter_power, rate = self.numbers["bound"].tolist()
        medians = self.numbers["bound_medians"].tolist()
        places = self.numbers["bound_places"].astype(int).tolist()
        known = [medians[k] if place < 0 else float(x[place]) for k, place in enumerate(places)]
        speed, slope, gravity, mass, diameter = known
        power = _ratio(mass, medians[3]) ** mass_power * _ratio(diameter, medians[4]) ** diameter_power
        rate = rate if spin is None else math.sqrt(sum(one * one for one in spin))
        gravity, slope = abs(gravity), math.sin(math.radians(slope))
        fallen = across + speed * limit + 0.5 * gravity * slope * limit**2
        square = speed**2 + largest * power * rate**2 + 2.0 * gravity * (height + fallen * slope)
        return math.sqrt(square), math.sqrt(smallest * power)


def _words(path: Path) -> list[str]:
    """The words of a law but its comments and ends, after its version and its sum have been checked."""
    content = path.read_bytes()
    first = content.partition(b"\n")[0].decode("utf-8", "replace").strip()
    name, _, version = first.rpartition(" ")
    if name != MAGIC:
        raise ValueError(f"{path} is no bounce law of lithobrake: its first line is {first[:40]!r}")
    if version != str(VERSION):
        raise ValueError(f"{path} has version {version[:20]}, but this reader reads {VERSION}: take that of its export")
    body, _, end = content.removesuffix(b"\n").rpartition(b"\n")
    total = zlib.crc32(body + b"\n")
    if end != f"end {total:08x}".encode():
        raise ValueError(f"{path} was cut short or changed after it was written: export it again")
    lines = body.decode("utf-8").split("\n")[1:]
    return [word for line in lines if not line.startswith("#") for word in line.split()]


def _place(ends: np.ndarray, random: float) -> int:
    """Place of a random number among accumulated chances."""
    return min(int(np.searchsorted(ends / ends[-1], random, side="right")), len(ends) - 1)


def _normals(random: Sequence[float]) -> np.ndarray:
    """Three normal numbers of four uniform ones, by the method of Box and Muller [Box-1958]."""
    one, other = (math.sqrt(-2.0 * math.log(random[k])) for k in (0, 2))
    turn, last = 2.0 * math.pi * random[1], 2.0 * math.pi * random[3]
    return np.array([one * math.cos(turn), one * math.sin(turn), other * math.cos(last)])


def _any_attitude(first: float, second: float, third: float) -> tuple[float, float, float, float]:
    """Quaternion w, x, y, z, even over all rotations, of three uniform numbers, by the method of Shoemake.

    Source: [Shoemake-1992].
    """
    near, far, one, other = math.sqrt(1.0 - first), math.sqrt(first), 2.0 * math.pi * second, 2.0 * math.pi * third
    return far * math.cos(other), near * math.sin(one), near * math.cos(one), far * math.sin(other)


def _matrix(attitude: Sequence[float]) -> np.ndarray:
    """Rotation matrix of a quaternion w, x, y, z of any length but 0."""
    length = math.sqrt(sum(one * one for one in attitude))
    if len(attitude) != 4 or not 0.0 < length < math.inf:
        raise ValueError(f"attitude is {list(attitude)}; allowed: a quaternion w, x, y, z that is not 0")
    w, x, y, z = (one / length for one in attitude)
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])  # fmt: skip


def _ratio(value: float, median: float) -> float:
    return value / median if median else 1.0


def _from_coordinate(coordinate: float, lower: float, upper: float, distant: float) -> float:
    """An output of its coordinate: a logit between two bounds, a logarithm beyond one, itself if they are distant."""
    has_lower, has_upper = math.isfinite(lower), math.isfinite(upper)
    limited, y = min(max(coordinate, -700.0), 700.0), coordinate
    if not distant and has_lower and has_upper:
        y = lower + (upper - lower) / (1.0 + math.exp(-limited))
    elif not distant and (has_lower or has_upper):
        y = lower + math.exp(limited) if has_lower else upper - math.exp(-limited)
    return min(max(y, math.nextafter(lower, math.inf)), math.nextafter(upper, -math.inf))
