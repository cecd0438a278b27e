"""Where on which body a study lands: the body, the place, the local frame, and what a thing at rest there feels."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.files.reading import file_stamp, hashed_seed
from lithobrake.geometry.attitude import angles, directions
from lithobrake.geometry.mesh_units import labelled_mesh, mesh_unit
from lithobrake.study import BUILT_IN_BODIES, Study, StudyError
from lithobrake.study.body_checks import partner_warning
from lithobrake.study.delivered_states import delivery_warning
from lithobrake.study.delivery_checks import drawn_together
from lithobrake.study.impact_sections import RotationSection
from lithobrake.study.quantity import Scalar, Uncertain, median, scaled, uncertain, usual_reach
from lithobrake.vocabulary.constants import DAY, HOUR
from lithobrake.vocabulary.number_words import duration

if TYPE_CHECKING:
    from lithobrake.chaos import Distribution
    from lithobrake.smallbody import AttitudeHistory, Body, Shape

# The numbers of a place, in the order of their columns in flights.csv.
SITE_KEYS = (
    "latitude_deg", "longitude_deg", "heading_deg", "north_error", "east_error", "mass", "spin_period",
    "partner_longitude_deg", "rotation_time",
)  # fmt: skip
# Below this share of gravity the acceleration at a place counts as nearly none.
NEARLY_NONE = 0.05
# Accelerations that differ by this factor, or in direction, are told to the user.
UNLIKE = 3.0


# Compared by identity: a study has dicts, which cannot be hashed, and cached properties belong to one object.
@dataclass(frozen=True, eq=False)
class Site:
    """The landing site of a study, made once for it; each property is worked out when it is first asked for."""

    study: Study

    @cached_property
    def values(self) -> dict[str, Scalar]:
        """All numbers of SITE_KEYS, fixed or uncertain; what the study leaves open is the built-in body's.

        Where the partner stands when the lander leaves is not known unless the study says so: drawn evenly. So is when
        it arrives in the history of the body's rotation.
        """
        given = {name.removeprefix("site."): value for name, value in self.study.site_values().items()}
        body = _body(self.study)
        if "density" in given:
            given["mass"] = scaled(given["density"], body.shape.volume)
        values: dict[str, Scalar] = {"mass": body.mass, "spin_period": body.spin_period, "partner_longitude_deg": 0.0}
        if body.partner is not None and body.orbit.rate != 0.0:
            values["partner_longitude_deg"] = Uncertain("uniform", {"lower": -180.0, "upper": 180.0})
        values["rotation_time"] = 0.0
        if self.study.site.rotation is not None:
            last = DAY * self.study.site.rotation.days
            values["rotation_time"] = Uncertain("uniform", {"lower": 0.0, "upper": last})
        values |= given
        return {key: values[key] for key in SITE_KEYS}

    @cached_property
    def medians(self) -> dict[str, float]:
        return {key: median(value) for key, value in self.values.items()}

    @property
    def aim(self) -> tuple[float, float]:
        """Latitude and longitude of the aim point [deg]."""
        return self.medians["latitude_deg"], self.medians["longitude_deg"]

    @property
    def ground_names(self) -> tuple[str, ...]:
        """Names of the bodies on whose ground landers are followed, that of the site first."""
        own, partner = self.study.site.name or Path(self.study.site.body).stem, self.body.partner
        return (own,) if partner is None or partner.is_planet else (own, partner.body.name)

    @cached_property
    def aim_radius(self) -> float:
        """Radius of the body at the aim point [m]."""
        return float((self.body.shape.surface_point(*self.aim) ** 2).sum() ** 0.5)

    def ways_from_aim(self, places: np.ndarray) -> np.ndarray:
        """Ways over the ground from the aim point [m], as if the body were a ball of the radius there; [...].

        places: on the ground or above it, fixed to the body [m], [..., 3].
        """
        there = directions(*self.body.shape.latitude_longitude(places))
        ways: np.ndarray = self.aim_radius * angles(directions(*self.aim), there)
        return ways

    @cached_property
    def distributions(self) -> "dict[str, Distribution]":
        return {key: value.to_chaos() for key, value in uncertain(self.values).items()}

    @cached_property
    def has_heading(self) -> bool:
        """Whether the heading has a median: one that is uncertain over the circle has none.

        It has none where a draw points hardly anywhere in the mean (resultant length below a tenth; an even spread over
        325 degrees has that). Source: [Mardia-2000], section 2.3.
        """
        if "heading_deg" not in self.distributions:
            return True
        draws = np.radians(self.distributions["heading_deg"].ppf((np.arange(1000) + 0.5) / 1000))
        return bool(np.hypot(np.cos(draws).mean(), np.sin(draws).mean()) > 0.1)

    @cached_property
    def body(self) -> "Body":
        """The body of the study with its shape, partner and rotation, at the medians of its mass and spin period."""
        body = replace(_body(self.study), mass=self.medians["mass"], spin_period=self.medians["spin_period"])
        if self.study.site.rotation is None:
            return body
        return replace(body, rotation=_rotation(body, self.study.site.rotation, _longest_stay(self.study)))

    @property
    def rotation_words(self) -> str | None:
        """What the start of the body's rotation leads to, in words; None for a body that turns uniformly."""
        start, rotation = self.study.site.rotation, self.body.rotation
        if start is None or rotation is None:
            return None
        x, _, z = (math.degrees(angle) for angle in rotation.largest_angles)
        return (
            f"The body rotates from the state in [site.rotation]: its long axis deviates by up to {x:.0f} deg and its "
            f"pole by up to {z:.0f} deg from synchronous rotation; landers arrive over {duration(DAY * start.days)}."
        )

    @cached_property
    def cautions(self) -> tuple[str, ...]:
        """What the study leaves out, and what it takes for many deliveries where it is one, in sentences."""
        found = partner_warning(self.study.site), delivery_warning(self.study)
        return tuple(words for words in found if words is not None)

    @property
    def remarks(self) -> list[str]:
        """What to know of the study before its landers fly, in sentences."""
        return [*self.cautions, *filter(None, (self.warning, self.rotation_words))]

    def clock(self, columns: Mapping[str, np.ndarray]) -> np.ndarray:
        """Times at which landers arrive [s], [count], of the partner's motion and of the body's rotation.

        columns: of SITE_KEYS. They say where the partner stands, or how far the rotation has gone; 0 where neither
        matters.
        """
        place = self.body.partner_time(columns["partner_longitude_deg"], columns["spin_period"])
        clock: np.ndarray = place + columns["rotation_time"]
        return clock

    def frames(self, columns: Mapping[str, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
        """Origins on the surface [m], shape [count, 3], and axes in rows, [count, 3, 3], for columns of SITE_KEYS.

        The delivery error moves the place north and east; the frame is that of where it ends.
        """
        if not len(columns["mass"]):
            return np.empty((0, 3)), np.empty((0, 3, 3))
        names = ("latitude_deg", "longitude_deg", "heading_deg", "north_error", "east_error")
        return self.body.delivered_frame(*(columns[name] for name in names))

    def sampled(self, count: int) -> dict[str, np.ndarray]:
        """The numbers of each sample or journey by key, [count] each; a larger count changes no earlier one."""
        return drawn_together(self.study, self.sampled_apart(count))

    def sampled_apart(self, count: int) -> dict[str, np.ndarray]:
        from lithobrake.chaos.design import sample_inputs

        # The random numbers of an input follow from its name.
        laws = {f"site.{key}": law for key, law in self.distributions.items()}
        table = sample_inputs(laws, count, hashed_seed(self.study.seed, "site"))
        return self.columns(count) | dict(zip(self.distributions, table.T, strict=True))

    def columns(self, shape: int | tuple[int, ...]) -> dict[str, np.ndarray]:
        """The medians as columns of SITE_KEYS, each of this shape."""
        return {key: np.full(shape, value) for key, value in self.medians.items()}

    @cached_property
    def frame(self) -> tuple[np.ndarray, np.ndarray]:
        """Origin [m] and axes in their rows, [3, 3], at the medians."""
        origin, axes = self.frames(self.columns(1))
        return origin[0], axes[0]

    @cached_property
    def acceleration(self) -> np.ndarray:
        """Acceleration [m/s2] of a point at rest on the ground there, at medians: along heading, left of it, out."""
        origin, axes = self.frame
        felt: np.ndarray = axes @ self._felt(origin)
        return felt

    def _felt(self, place: np.ndarray) -> np.ndarray:
        """Acceleration [m/s2], body-fixed, of a point at rest at a place [m], [3], at medians.

        With the tide of a partner that the study gives, where it stands over one place. That of a built-in pair, which
        is smaller, is left to the touchdowns, so that beds of studies from before it was known stay what they were.
        """
        body, given = self.body, self.study.site.partner_body
        if given is None or body.orbit.rate != 0.0:
            return body.effective_acceleration(place)
        columns = self.columns(1)
        felt: np.ndarray = body.felt(place[None], self.clock(columns), columns["mass"], columns["spin_period"])[0]
        return felt

    @property
    def holds(self) -> bool:
        return bool(self.acceleration[2] < 0.0)

    @cached_property
    def slope_deg(self) -> float:
        """Slope of the ground there against the plumb line of gravity and rotation together, at medians [deg]."""
        if self.study.site.partner_body is None:
            return math.degrees(float(self.body.slope(self.medians["latitude_deg"], self.medians["longitude_deg"])))
        return math.degrees(math.acos(-float(self.acceleration[2]) / float(np.linalg.norm(self.acceleration))))

    @cached_property
    def escape_speed(self) -> float:
        """Speed [m/s], in axes that do not turn, with which a point there escapes the body alone, at medians."""
        return math.sqrt(2.0 * float(self.body.potential(self.frame[0])))

    @cached_property
    def warning(self) -> str | None:
        """What it means that the ground there does not hold what lies on it, or hardly; None where it does."""
        outward, pull = float(self.acceleration[2]), float(np.linalg.norm(self.body.acceleration(self.frame[0])))
        if outward < -NEARLY_NONE * pull:
            return None
        where = f"At the site gravity ({pull:.2g} m/s2) and rotation together"
        end = "a lander that falls back there within the flight time will not remain."
        if outward > NEARLY_NONE * pull:
            return f"{where} push outward by {outward:.2g} m/s2 and eject what lies there: {end}"
        words = "outward" if outward > 0.0 else "inward"
        # Metres that a fall or a drift covers in an hour say more than micrometres per second squared.
        hour = 0.5 * abs(outward) * HOUR**2
        return (
            f"{where} nearly cancel: only {abs(outward):.2g} m/s2 {words} remain, {hour:.2g} m in the first hour from "
            f"rest. A small error of mass, spin or shape can reverse this, and then {end}"
        )

    @cached_property
    def gravity_warning(self) -> str | None:
        """What it means that touchdowns and flights feel another acceleration; None where the two are alike."""
        at_site = -float(self.acceleration[2])
        given = self.study.surface.gravity
        lower, upper = (at_site, at_site) if isinstance(given, str) else usual_reach(given)
        # That end of surface.gravity which is nearest to the acceleration at the site.
        nearest = min(max(at_site, lower), upper)
        if nearest == at_site or (nearest * at_site > 0.0 and 1.0 / UNLIKE < nearest / at_site < UNLIKE):
            return None
        reached = f"{lower:.3g}" if lower == upper else f"{lower:.3g} to {upper:.3g}"
        settle = "" if at_site > 0.0 else " and bed.settle_gravity an inward value"
        return (
            f"surface.gravity is {reached} m/s2 inward, but gravity and rotation at the site add up to "
            f"{abs(at_site):.3g} m/s2 {'inward' if at_site > 0.0 else 'outward'}, so touchdown and flight use "
            'inconsistent accelerations; set surface.gravity = "site"'
            f"{settle}, or choose the site that the touchdown is meant for"
        )


def _body(study: Study) -> "Body":
    """The body with its built-in mass and spin or, where it comes from a mesh, with the medians of the study."""
    from lithobrake.smallbody import Body
    from lithobrake.smallbody.built_in_bodies import ball_partner, built_in_body

    site = study.site
    if site.body in BUILT_IN_BODIES:
        return built_in_body(site.body, partner=site.partner, extents=site.extents)
    mesh, given = labelled_mesh(Path(site.body)), study.site_values()
    # A mesh, or its label, that has changed since is read again.
    shape = _read_shape(mesh, mesh_unit(mesh, site.unit), site.gravity_facets, file_stamp(mesh))
    mass = median(given["site.mass"]) if "site.mass" in given else shape.volume * median(given["site.density"])
    body = Body(shape, mass=mass, spin_period=median(given["site.spin_period"]))
    if site.partner_body is None:
        return body
    return replace(body, partner=ball_partner(body, **site.partner_body.model_dump()))


# Moments of the body are those of its shape, and the orbit hardly depends on its mass: that of the median is taken.
@lru_cache(maxsize=4)
def _rotation(body: "Body", start: RotationSection, longest: float) -> "AttitudeHistory":
    from lithobrake.smallbody import rotation_history

    angles = {name: getattr(start, name) for name in ("yaw_deg", "pitch_deg", "roll_deg")}
    return rotation_history(body, DAY * start.days + longest, **angles, spin=start.spin)


def _longest_stay(study: Study) -> float:
    """Longest time that a lander of a study flies and rests about its body from its arrival on [s]."""
    # A lander that is flown to the ground may take as long for that.
    is_flown = study.delivery is not None and study.delivery.is_flown
    return max(study.journey.duration * (2.0 if is_flown else 1.0), study.flight.duration)


@lru_cache(maxsize=1)
def _read_shape(path: Path, unit: str, gravity_facets: int | None, _stamp: tuple[int, ...] | None) -> "Shape":
    from lithobrake.smallbody import Shape

    return Shape.read(path, unit, gravity_facets=gravity_facets)


def with_site_gravity(study: Study) -> Study:
    """The study with surface.gravity = "site" replaced by the acceleration there; negative points outward.

    Raises StudyError where no bed would settle under it.
    """
    if study.surface.gravity != "site":
        return study
    site = Site(study)
    gravity = -float(site.acceleration[2])
    if not math.isfinite(gravity):
        raise StudyError([study.said("the acceleration at the site is not finite; correct site.mass or its mesh")])
    if study.bed.settle_gravity is None and gravity <= 0.0:
        raise StudyError([study.said(_outward(site, gravity))])
    return study.under_site_gravity(gravity)


def _outward(site: Site, gravity: float) -> str:
    """What is wrong where the rotation throws off what lies at the site; gravity: inward [m/s2]."""
    period = site.medians["spin_period"]
    slower = replace(site.body, spin_period=HOUR * period)
    remedy = "move the site, or give bed.settle_gravity an inward value, say 2e-5 m/s2"
    if float((site.frame[1] @ slower.effective_acceleration(site.frame[0]))[2]) < 0.0 and period < HOUR:
        remedy = f"is it in hours? write seconds, {HOUR * period:.6g}"
    return (
        f"the spin period (site.spin_period) is {period:.6g} s, and gravity and rotation at the site push outward by "
        f"{-gravity:.3g} m/s2, and no bed settles under that; {remedy}"
    )
