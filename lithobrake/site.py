"""Where on which body a study lands: the body, the place, the local frame, and what a thing at rest there feels."""

import math
from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.quantity import Scalar, Uncertain, median
from lithobrake.study import BUILT_IN_BODIES, Study

if TYPE_CHECKING:
    from lithobrake.smallbody import Body, Shape

# The numbers of a place, in the order of their columns in flights.csv.
SITE_KEYS = (
    "latitude_deg", "longitude_deg", "heading_deg", "north_error", "east_error", "mass", "spin_period",
    "partner_longitude_deg",
)  # fmt: skip
# Below this share of gravity the acceleration at a place counts as nearly none.
NEARLY_NONE = 0.05


def site_values(study: Study) -> dict[str, Scalar]:
    """All numbers of SITE_KEYS, fixed or uncertain; what the study leaves open is the built-in body's.

    Where the partner stands when the lander leaves is not known unless the study says so: drawn evenly.
    """
    given = {name.removeprefix("site."): value for name, value in study.site_values().items()}
    body = _body(study)
    values: dict[str, Scalar] = {"mass": body.mass, "spin_period": body.spin_period, "partner_longitude_deg": 0.0}
    if body.partner is not None and body.orbit.rate != 0.0:
        values["partner_longitude_deg"] = Uncertain("uniform", {"lower": -180.0, "upper": 180.0})
    values |= given
    return {key: values[key] for key in SITE_KEYS}


def site_medians(study: Study) -> dict[str, float]:
    """The same with uncertain numbers at their median."""
    return {key: median(value) for key, value in site_values(study).items()}


def site_body(study: Study) -> "Body":
    """The body of the study with its shape and partner, at the medians of its mass and spin period."""
    values = site_medians(study)
    return replace(_body(study), mass=values["mass"], spin_period=values["spin_period"])


def _body(study: Study) -> "Body":
    """The body with its built-in mass and spin, or with 1 where it comes from a mesh, which has none."""
    from lithobrake.smallbody import Body

    if study.site.body in BUILT_IN_BODIES:
        return _built_in(study.site.body, study.site.partner)
    return Body(_read_shape(Path(study.site.body)), mass=1.0, spin_period=1.0)


@lru_cache(maxsize=4)
def _built_in(name: str, partner: bool) -> "Body":
    from lithobrake import smallbody

    body: Body = getattr(smallbody, name)(partner=partner)
    return body


@lru_cache(maxsize=1)
def _read_shape(path: Path) -> "Shape":
    from lithobrake.smallbody import Shape

    return Shape.read(path)


def frames(body: "Body", site: Mapping[str, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Origins on the surface [m], shape [count, 3], and axes in their rows, [count, 3, 3], for columns of SITE_KEYS.

    The delivery error moves the place along the ground, north and east; the frame is that of where it ends.
    """
    names = ("latitude_deg", "longitude_deg", "heading_deg", "north_error", "east_error")
    columns = np.column_stack([site[name] for name in names])
    # Most studies have one site, or few: each is looked for once.
    unique, index = np.unique(columns, axis=0, return_inverse=True)
    latitude, longitude, heading, north, east = unique.T
    origin, axes = body.local_frame(latitude, longitude, 0.0)
    moved = (north != 0.0) | (east != 0.0)
    if moved.any():
        # North is the first axis, and east is opposite to the second.
        place = origin[moved] + north[moved, None] * axes[moved, 0] - east[moved, None] * axes[moved, 1]
        latitude[moved], longitude[moved] = body.shape.latitude_longitude(place)
    origin, axes = body.local_frame(latitude, longitude, heading)
    return origin[index.reshape(-1)], axes[index.reshape(-1)]


def push_at_site(study: Study) -> np.ndarray:
    """Acceleration [m/s2] of a point at rest on the ground at the site, at medians: along heading, left of it, out."""
    body, values = site_body(study), site_medians(study)
    origin, axes = frames(body, {key: np.array([value]) for key, value in values.items()})
    push: np.ndarray = axes[0] @ body.effective_acceleration(origin[0])
    return push


def site_warning(study: Study) -> str | None:
    """What it means that the ground at the site does not hold what lies on it, or hardly; None where it does."""
    body, values = site_body(study), site_medians(study)
    origin, _ = frames(body, {key: np.array([value]) for key, value in values.items()})
    outward, pull = float(push_at_site(study)[2]), float(np.linalg.norm(body.acceleration(origin[0])))
    if outward < -NEARLY_NONE * pull:
        return None
    where = f"At the site gravity ({pull:.2g} m/s2) and rotation together"
    end = "a lander that comes down again within the time of flight is not one that stays."
    if outward > NEARLY_NONE * pull:
        return f"{where} push outwards by {outward:.2g} m/s2: what lies there is thrown off, so {end}"
    words = "push outwards" if outward > 0.0 else "hold"
    # Metres that a fall or a drift covers in an hour say more than micrometres per second squared.
    hour = 0.5 * abs(outward) * 3600.0**2
    return (
        f"{where} nearly cancel: they {words} by only {abs(outward):.2g} m/s2, {hour:.2g} m in the first hour from "
        f"rest. The least uncertainty of mass, spin or shape turns that round, so {end}"
    )


def gravity_warning(study: Study) -> str | None:
    """What it means that the touchdown and the site differ in their acceleration; None where they hardly do."""
    felt, given = -float(push_at_site(study)[2]), median(study.touchdown_values()["surface.gravity"])
    if felt <= 0.0 or 0.5 * felt <= given <= 2.0 * felt:
        return None
    return f'surface.gravity is {given:.2g} m/s2 and at the site it is {felt:.2g} m/s2: write "site" to take that.'


def with_site_gravity(study: Study) -> Study:
    """The study with surface.gravity = "site" replaced by the acceleration there; negative points outward."""
    if study.surface.gravity != "site":
        return study
    gravity = -float(push_at_site(study)[2])
    if not math.isfinite(gravity):
        raise ValueError("the acceleration at the site is not finite")
    return study.model_copy(update={"surface": study.surface.model_copy(update={"gravity": gravity})})
