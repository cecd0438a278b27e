"""The study file that `lithobrake new` writes, with its bodies and landers by name."""

import json
import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from lithobrake.study.ground_presets import GROUND_PRESETS
from lithobrake.study.refusals import by_name
from lithobrake.study.template import DISTRIBUTION_WORDS, commented, sections
from lithobrake.vocabulary.constants import GRAVITATIONAL_CONSTANT
from lithobrake.vocabulary.known_bodies import KNOWN_BODIES, KnownBody, body_named_in

_CDS = "largest mass and envelope in [CDS-2022], without deployable parts"
PRESET_WORDS = "These are those of {} (docs/howto/ground.md)."
ANY_WORDS = "Nothing is said of this body here: replace them by what is known (docs/howto/ground.md)."
ANY_GROUND = "ryugu"
# Of the escape speed of a ball of the body's mass and size: what a lander comes in with. Nothing lands faster than
# FASTEST [m/s].
SPEEDS, FASTEST = (0.5, 0.9), 0.5
SLOW_WORDS = f"{SPEEDS[0]:g} to {SPEEDS[1]:g} of the escape speed"
FAST_WORDS = "far below the escape speed; free fall is faster, and needs stiffer grains"
# Over density and square of the speed: what a contact must have to be stiff, and the least of any use [Pa].
STIFFNESS, SOFTEST = 16_000.0, 2e5
DENSITY = 2500.0  # kg/m3
BULK_DENSITY = 2000.0  # kg/m3, by which a body of a mesh has a size for the speeds of its study
_STUDY = """\
# Where does a lander come to rest? Each one is followed from delivery to rest, with a landing simulated at each impact.
# Replace lander, body, delivery and ground by those of your mission. An unknown number is a table with a distribution,
# from which it is sampled for each lander. The ranges of soil and delivery are examples.
title = "{lander.name} on {body.name}"
seed = 1

# Boxes of settled grains that repeat in both directions: one for every four journeys, at
# least twelve.
[bed]
pour_gravity = 0.5    # m/s2; grains then settle under the local gravity

# Unknown ground: the kind of each bed is sampled by its weight, then a grain size, from
# which width and number of grains follow. {ground_words}
[ground]
unknown = "everywhere"    # or "patchy", or "both"

{kinds}
[grain]
density = {density}    # kg/m3
young_modulus = {{ distribution = "log_uniform", lower = {softest}, upper = {stiffest} }}    # Pa
poisson_ratio = 0.25
restitution = {{ distribution = "uniform", lower = 0.3, upper = 0.9 }}
friction = {{ distribution = "uniform", lower = 0.4, upper = 0.9 }}

# {lander.name}: {lander.source}.
[lander]
shape = "box"    # or "sphere" with diameter, or "hull" with file
edges = {edges}    # m
mass = {lander.mass}    # kg

# Delivery, in any attitude.
[delivery]
latitude_deg = {latitude}
longitude_deg = {longitude}
north_error = {{ distribution = "normal", mean = 0.0, std = 15.0 }}    # m
east_error = {{ distribution = "normal", mean = 0.0, std = 15.0 }}    # m
heading_deg = {{ distribution = "uniform", lower = 0.0, upper = 360.0 }}    # from north toward east
speed = {{ distribution = "uniform", lower = {slow}, upper = {fast} }}    # m/s; {speed_words}
incidence_deg = {{ distribution = "uniform", lower = 0.0, upper = 40.0 }}    # 0 is straight down
spin_x = {{ distribution = "normal", mean = 0.0, std = 0.02 }}    # rad/s

[journey]
count = 48
duration = 172_800.0    # s, two days

"""
_ALL_KEYS = """\
# All keys of a study file by their tables, with meaning, unit, range and default. Copy those that you need to the
# tables above. A key marked "number or table" takes a number, or one of these distributions:
"""


def known_body(name: str) -> KnownBody:
    """The body of a name in any case. Raises ValueError for another name."""
    return by_name("body", KNOWN_BODIES, name, "for another body give --mass and --spin with its --shape")


def body_of_mesh(shape: str, mass: float, spin_period: float) -> KnownBody:
    """The body of a mesh by its mass [kg] and spin period [s]; its name is that of the file.

    Raises ValueError for numbers that no body has.
    """
    for option, value, unit in (("--mass", mass, "kg"), ("--spin", spin_period, "s")):
        if not 0.0 < value < math.inf:
            raise ValueError(f"{option} is {value:g}; allowed: a finite number above 0 [{unit}]; write such a number")
    name = re.sub(r"[^\w -]", "_", Path(shape).stem, flags=re.ASCII).strip("_ -")[:40] or "body"
    radius = (0.75 * mass / (math.pi * BULK_DENSITY)) ** (1.0 / 3.0)
    return KnownBody(name, mass, spin_period, radius, "mass and spin period of the command line")


def refuse_other_body(body: KnownBody, shape: str) -> None:
    """Raise ValueError where the file of a mesh has the name of another body than the one that it is to be."""
    found = body_named_in(Path(shape).stem)
    if found is not None and found is not body:
        raise ValueError(
            f"--shape is {shape!r}, which names {found.name}, and --body is {body.name}, whose mass and spin the study "
            f"would have; write --body {found.key}, or rename the file"
        )


@dataclass(frozen=True)
class KnownLander:
    """A box without wings and booms: name as it is printed, edges [m], mass [kg], and where they come from."""

    name: str
    edges: tuple[float, float, float]
    mass: float
    source: str


_LANDERS = (
    KnownLander("1U", (0.1, 0.1, 0.1135), 2.0, _CDS),
    KnownLander("2U", (0.1, 0.1, 0.227), 4.0, _CDS),
    KnownLander("3U", (0.1, 0.1, 0.3405), 6.0, _CDS),
    KnownLander("6U", (0.2263, 0.1, 0.366), 12.0, _CDS),
    KnownLander("12U", (0.2263, 0.2263, 0.366), 24.0, _CDS),
    KnownLander("Juventas", (0.37, 0.23, 0.10), 12.0, "[ESA-2024]; its four booms of 1.5 m are left out"),
    KnownLander("Milani", (0.13, 0.246, 0.366), 12.0, "[Hera-2024]; its wings are left out"),
    KnownLander("MASCOT", (0.275, 0.29, 0.195), 10.0, "[Scholten-2019]"),
)
LANDERS = {lander.name.lower(): lander for lander in _LANDERS}


def known_lander(name: str) -> KnownLander:
    """The lander of a name in any case. Raises ValueError for another name."""
    return by_name("lander", LANDERS, name, "for another one write its edges and mass")


def short_study(body: KnownBody, lander: KnownLander, place: tuple[float, float], shape: str | None = None) -> str:
    """The text of a study that runs and follows landers to rest.

    place: latitude and longitude of the aim point [deg]. shape: path of a mesh from the study file, instead of a shape
    that the package has. Raises ValueError where there is neither.
    """
    speeds = [min(part * escape_speed(body), FASTEST * part / SPEEDS[1]) for part in SPEEDS]
    has_preset = body.key in GROUND_PRESETS
    softest = max(SOFTEST, STIFFNESS * DENSITY * speeds[1] ** 2)
    text = _STUDY.format(
        body=body, lander=lander, kinds=_kinds(GROUND_PRESETS[body.key if has_preset else ANY_GROUND]),
        ground_words=PRESET_WORDS.format(body.name) if has_preset else ANY_WORDS,
        density=DENSITY, softest=rounded_up(softest), stiffest=rounded_up(10.0 * softest),
        edges=list(lander.edges), latitude=place[0], longitude=place[1], slow=float(f"{speeds[0]:.2g}"),
        fast=float(f"{speeds[1]:.2g}"),
        speed_words=SLOW_WORDS if speeds[1] < FASTEST else FAST_WORDS,
    )  # fmt: skip
    return text + _site(body, shape)


def _kinds(ground: Mapping[str, Any]) -> str:
    """The tables of kinds of ground."""
    text = ""
    for name, kind in ground["kind"].items():
        text += f"[ground.kind.{name}]\nweight = {kind['weight']:g}\n"
        if size := kind.get("grain_size"):
            ends = f"lower = {size['lower']:g}, upper = {size['upper']:g}"
            text += f'grain_size = {{ distribution = "{size["distribution"]}", {ends} }}    # m\n'
        text += "rock = true    # blocks far larger than the lander\n\n" if kind.get("rock") else "\n"
    return text.rstrip("\n") + "\n"


def aim_point(text: str) -> tuple[float, float]:
    """Latitude and longitude [deg] of "10,120". Raises ValueError for another text or range."""
    try:
        latitude, longitude = (float(part) for part in text.split(","))
    except ValueError:
        latitude = longitude = math.nan
    if not (-90.0 <= latitude <= 90.0 and -360.0 <= longitude <= 360.0):
        raise ValueError(
            f"at is {text!r}; it takes a latitude of -90 to 90 and a longitude of -360 to 360, in degrees; "
            "write, say, 10,120"
        )
    return latitude, longitude


def all_keys() -> str:
    return "\n".join(["\n" + _ALL_KEYS + DISTRIBUTION_WORDS, *map(commented, sections())])


def rounded_up(value: float) -> str:
    """A number to one digit that is not smaller."""
    power = 10.0 ** math.floor(math.log10(value))
    # The division may come out above a whole number by its rounding, which would cost a digit.
    return f"{math.ceil(value / power * (1.0 - 1e-12)) * power:.0e}"


def escape_speed(body: KnownBody) -> float:
    """Escape speed from the ground of a ball of the body's mass and size [m/s]."""
    return math.sqrt(2.0 * GRAVITATIONAL_CONSTANT * body.mass / body.mean_radius)


def _site(body: KnownBody, shape: str | None) -> str:
    if shape is None and not body.is_built_in:
        raise ValueError(
            f"the package has no shape of {body.name}; give a closed mesh (OBJ, STL, PDS plates, ICQ) with --shape FILE"
        )
    if shape is not None and not shape.strip():
        raise ValueError("shape is empty; give the path of a closed mesh, or leave --shape out")
    if shape is None:
        return f'[site]\nbody = "{body.key}"    # or a mesh with mass and spin_period\n'
    # A JSON string is a basic string of TOML, so backslashes and quotes of a path are escaped as TOML reads them.
    quoted = json.dumps(shape, ensure_ascii=False)
    pole = ""
    if body.pole is not None:
        pole = f"# Its pole: right ascension {body.pole[0]} deg, declination {body.pole[1]} deg (ICRF).\n"
    other = body.companion
    partner = ""
    if other is not None:
        orbit = "" if body.is_synchronous else f"period = {other.period:.8g}    # s, of the orbit\n"
        partner = (
            f"\n# It orbits with {other.name}, a ball here, which attracts and may be hit.\n[site.partner_body]\n"
            f'name = "{other.name}"\nmass = {other.mass:g}    # kg\ndiameter = {other.diameter:g}    # m\n{orbit}'
        )
    return (
        f'# {body.name}: {body.source}.\n{pole}[site]\nbody = {quoted}    # unit = "km" if it is not in m\n'
        f'name = "{body.name}"\nmass = {body.mass:g}    # kg\nspin_period = {body.spin_period:.8g}    # s\n{partner}'
    )
