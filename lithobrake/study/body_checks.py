"""What is wrong with the body of a study and its rotation, found before anything runs."""

import math
import os
import re
import warnings
from collections.abc import Iterator
from pathlib import Path

from lithobrake.geometry.mesh_units import UNITS, labelled_mesh, mesh_unit
from lithobrake.study.impact_sections import RotationSection, SiteSection
from lithobrake.study.quantity import Scalar, median, usual_reach
from lithobrake.study.site_kernels import kernel_problems
from lithobrake.study.study import Study
from lithobrake.vocabulary.constants import DAY, GRAVITATIONAL_CONSTANT
from lithobrake.vocabulary.known_bodies import BUILT_IN_BODIES, body_named_in
from lithobrake.vocabulary.plain_text import closest, show

# Bulk density [kg/m3]: nuclei of comets are near 500 (67P: 533, Paetzold et al. 2016, Nature 530), iron-nickel is 7900.
LIGHTEST, HEAVIEST = 300.0, 8000.0
# Diameter of the ball of equal volume [m]: from the smallest asteroids seen to Ceres.
SMALLEST, LARGEST = 1.0, 1e6
# Spin period [s]: the shortest known is that of 2020 HS7, 3.0 s (Beniyama et al. 2022, PASJ 74, 877).
FASTEST = 1.0
# Angle [rad] that a body with [site.rotation] turns by beside one turn an orbit: 1e4 are integrated in half a minute.
LONGEST_TURN = 2e4
# Of a body, as other programs take it too.
NAME, NAME_WORDS = r"[A-Za-z0-9][\w -]{0,39}", "1 to 40 letters, digits, blanks, _ and -"
SYNCHRONOUS = [key for key, body in BUILT_IN_BODIES.items() if body.is_synchronous]
# A body whose spin period is within this part of that of its orbit keeps one face to its partner: distances are not
# known well enough to tell the two apart.
NEARLY_SYNCHRONOUS = 0.02


def body_problems(study: Study) -> Iterator[str]:
    """One sentence for each thing wrong; a mesh is read for that, and no kernel is compiled or loaded."""
    site = study.site
    # Numbers of the site are read from the kernels below, and would raise there.
    if unread := list(kernel_problems(site)):
        yield from unread
        return
    yield from _spin_problems(study)
    yield from _name_problems(study)
    yield from _extents_problems(study)
    yield from _partner_problems(study)
    if site.mass is not None and site.density is not None:
        yield f"site.mass is {show(site.mass)} and site.density {show(site.density)}; keep one of the two"
        return
    if site.body in BUILT_IN_BODIES:
        yield from _unit_problems(study)
        # Loading a built-in shape takes a second: only where the study changes what is known to be right.
        if (
            site.mass is None
            and site.density is None
            and not any(_largest(value) for value in _delivery(study).values())
        ):
            return
    elif lacking := list(_lacking(study)):
        yield from lacking
        return
    try:
        volume = _volume(study)
    except (ValueError, OSError) as error:
        yield f"site.body: {error}"
        return
    # In a wrong unit every delivery would be too wide, too.
    yield from list(_bulk_problems(study, volume)) or _delivery_problems(study, _ball_radius(volume))


def _unit_problems(study: Study) -> Iterator[str]:
    if study.site.unit not in (None, "m"):
        yield f'site.unit is "{study.site.unit}", and site.body is built in; a unit goes with a mesh: leave it out'
    if study.site.gravity_facets is not None:
        yield (
            f"site.gravity_facets is {study.site.gravity_facets}, and site.body is built in, with few facets; a mesh "
            "may be thinned: leave it out"
        )


def _extents_problems(study: Study) -> Iterator[str]:
    site = study.site
    if site.extents is None:
        return
    if site.body not in BUILT_IN_BODIES:
        yield "site.extents goes with a built-in body, and site.body is a mesh, which has its own: leave it out"
    elif site.mass is None and site.density is None:
        yield "site.extents changes the volume of the body; write site.mass, or site.density, that goes with it"


def _name_problems(study: Study) -> Iterator[str]:
    name = study.site.name
    if name is None:
        return
    if study.site.body in BUILT_IN_BODIES:
        yield f"site.name is {show(name)}, and site.body is built in and has one; leave it out"
    elif not re.fullmatch(NAME, name, flags=re.ASCII):
        yield f"site.name is {show(name)}; allowed: {NAME_WORDS}; write such a name"


def _spin_problems(study: Study) -> Iterator[str]:
    shortest = usual_reach(study.site_values().get("site.spin_period", math.inf))[0]
    if shortest < FASTEST:
        yield (
            f"site.spin_period reaches down to {shortest:.4g} s; allowed: at least {FASTEST:g} s, as no known body "
            "turns faster; is it in hours or days? write seconds"
        )


def _lacking(study: Study) -> Iterator[str]:
    if not os.path.isfile(study.site.body):
        names = ", ".join(f'"{name}"' for name in BUILT_IN_BODIES)
        meant = closest(Path(study.site.body).name, BUILT_IN_BODIES)
        yield f"site.body is {show(study.site.body)}; allowed: {names} or the path of a mesh; no such file{meant}"
        return
    given = study.site_values()
    if "site.mass" not in given and "site.density" not in given:
        yield "site.mass is missing; a body read from a mesh needs its mass, or site.density"
    if "site.spin_period" not in given:
        yield "site.spin_period is missing; a body read from a mesh needs its spin period"


def _partner_problems(study: Study) -> Iterator[str]:
    """A partner of a body that has its own or none, or whose orbit is given twice, or nearly as the spin."""
    site, partner = study.site, study.site.partner_body
    if partner is None:
        return
    if site.body in BUILT_IN_BODIES or not site.partner:
        why = f"site.body is {show(site.body)}, which has its own" if site.partner else "site.partner is false"
        yield f"site.partner_body is given, and {why}; keep one of the two"
    if not re.fullmatch(NAME, partner.name, flags=re.ASCII):
        yield f"site.partner_body.name is {show(partner.name)}; allowed: {NAME_WORDS}; write such a name"
    if partner.name == (site.name or Path(site.body).stem):
        yield (
            f"site.partner_body.name is {show(partner.name)}, the name of the body itself; allowed: another, by which "
            "tables tell the two apart; rename one"
        )
    if partner.polar_diameter is not None and partner.polar_diameter > partner.diameter:
        yield (
            f"site.partner_body.polar_diameter is {partner.polar_diameter:g} m; allowed: up to its diameter, "
            f"{partner.diameter:g} m, as a body that spins is flattened; exchange the two"
        )
    if partner.period is not None and partner.distance is not None:
        yield (
            f"site.partner_body.period is {partner.period:g} s and distance {partner.distance:g} m; either follows "
            "from the other and both masses: keep one"
        )
    spin = study.site_values().get("site.spin_period")
    if partner.distance is None or partner.period is not None or spin is None or site.mass is None:
        return
    total = GRAVITATIONAL_CONSTANT * (partner.mass + median(site.mass))
    period, own = 2.0 * math.pi * math.sqrt(partner.distance**3 / total), median(spin)
    if abs(period / own - 1.0) < NEARLY_SYNCHRONOUS:
        yield (
            f"site.partner_body.distance is {partner.distance:g} m, for an orbit of {period:.6g} s, and spin_period is "
            f"{own:.6g} s; allowed: an orbit that differs by more than {NEARLY_SYNCHRONOUS:g} of that; leave distance "
            "out for a body that keeps one face to its partner, or write period"
        )


def partner_warning(site: SiteSection) -> str | None:
    """What it means that a body which is known to have a partner has none in a study; None where it is not so."""
    if site.body in BUILT_IN_BODIES or site.partner_body is not None or not site.partner:
        return None
    known = body_named_in(site.name or "", site.kernel_body or "", Path(site.body).stem)
    other = None if known is None else known.companion
    if known is None or other is None:
        return None
    return (
        f"{known.name} orbits with {other.name}, which this study leaves out: weights and flights lack its attraction; "
        f'write [site.partner_body] with name = "{other.name}", mass = {other.mass:g} and diameter = '
        f"{other.diameter:g}, or site.partner = false if it is meant so."
    )


def _volume(study: Study) -> float:
    """Volume of the body [m3]. Raises ValueError for a mesh that is no body, OSError for one that may not be read."""
    site = study.site
    if site.body in BUILT_IN_BODIES:
        from lithobrake import smallbody

        return float(smallbody.built_in_body(site.body, partner=False, extents=site.extents).shape.volume)
    # Only a mesh needs arrays: whatever else is refused is refused before they are imported.
    from lithobrake.geometry.mesh import closed_faces, holds_origin, volume_of
    from lithobrake.geometry.mesh_files import read_mesh

    vertices, faces = read_mesh(labelled_mesh(Path(site.body)), site.unit)
    with warnings.catch_warnings():
        # Whoever uses the mesh is warned of what is mended in it.
        warnings.simplefilter("ignore")
        faces = closed_faces(vertices, faces, site.body)
    if not holds_origin(vertices, faces):
        raise ValueError(
            f"{site.body}: the origin, about which the body turns, lies outside of it, so latitude and longitude name "
            "no place; move the vertices"
        )
    return volume_of(vertices, faces)


def _bulk_problems(study: Study, volume: float) -> Iterator[str]:
    """A body that is too light, too heavy, too small or too large, with the unit that was likely meant."""
    mass, density = study.site.mass, study.site.density
    if mass is not None:
        low, high = (one / volume for one in usual_reach(mass))
    elif density is not None:
        low, high = usual_reach(density)
    else:
        return
    built_in = study.site.body in BUILT_IN_BODIES
    given = "m" if built_in else mesh_unit(labelled_mesh(Path(study.site.body)), study.site.unit)
    diameter, here = 2.0 * _ball_radius(volume), UNITS[given]
    # A wrong unit is the common slip, and a bulk density shows it: from metres to kilometres it changes by 1e9.
    # A density that is given stays what it is in any unit.
    heavier = 1.0 if mass is None else 3.0
    fitting = [unit for unit, length in UNITS.items() if _is_a_body(low, high, diameter, length / here, heavier)]
    if given in fitting:
        return
    likely = fitting[0] if fitting and not built_in else None
    key = "site.density" if mass is None else "site.mass"
    remedy = f'is the mesh in {likely}? then set site.unit = "{likely}"' if likely else f"mend {key} or the mesh"
    bulk = f"{low:.4g} kg/m3" if low == high else f"{low:.4g} to {high:.4g} kg/m3"
    yield (
        f"site.body has {volume:.4g} m3 and is {diameter:.4g} m across, and {key} makes that a bulk density of "
        f"{bulk}; allowed: {LIGHTEST:g} to {HEAVIEST:g} kg/m3, as bodies from comets to iron have, and "
        f"{SMALLEST:g} to {LARGEST:g} m; {remedy}"
    )


def _is_a_body(low: float, high: float, diameter: float, longer: float, power: float) -> bool:
    """Tell whether densities [kg/m3] and a diameter [m] are a small body's, with all lengths so many times longer.

    power: of a length by which the densities fall, 3 of a mass that is given.
    """
    dense = low / longer**power >= LIGHTEST and high / longer**power <= HEAVIEST
    return dense and SMALLEST <= diameter * longer <= LARGEST


def _delivery_problems(study: Study, radius: float) -> Iterator[str]:
    """Errors of delivery that are no error but another place; radius [m]: of the ball of equal volume."""
    limit = 0.5 * math.pi * radius
    for name, value in _delivery(study).items():
        if _largest(value) > limit:
            yield (
                f"site.{name} reaches {_largest(value):.4g} m; allowed: at most {limit:.4g} m, a quarter of the way "
                f"round a body of {radius:.4g} m radius; lower it, or move the site"
            )


def _delivery(study: Study) -> dict[str, Scalar]:
    return {name: getattr(study.site, name) for name in ("north_error", "east_error")}


def _largest(value: Scalar) -> float:
    return max(abs(end) for end in usual_reach(value))


def _ball_radius(volume: float) -> float:
    """Radius [m] of the ball of a volume [m3]."""
    return (0.75 * volume / math.pi) ** (1.0 / 3.0)


def rotation_problems(study: Study) -> Iterator[str]:
    site = study.site
    if site.rotation is None:
        if site.rotation_time is not None:
            yield "site.rotation_time is a time in [site.rotation], and there is none; add it, or leave the key out"
        return
    yield from _body_problems(site)
    yield from _time_problems(site, site.rotation.days)
    yield from _turn_problems(site.rotation)
    if study.sky.bodies:
        yield (
            "[sky] asks what landers at rest see over a day of the body, and with [site.rotation] no day is like "
            "another; leave one of the two out"
        )


def _body_problems(site: SiteSection) -> Iterator[str]:
    if site.body not in SYNCHRONOUS or not site.partner:
        body = f"site.body is {show(site.body)}" if site.partner else "site.partner is false"
        names = ", ".join(f'"{name}"' for name in SYNCHRONOUS)
        yield (
            f"{body}; allowed with [site.rotation]: {names} with its partner, whose torque turns it; change that, or "
            "leave the table out"
        )
        return
    for key in ("spin_period", "kernels"):
        if getattr(site, key):
            yield (
                f"site.{key} is given; with [site.rotation] the body turns once an orbit in the mean, as the built-in "
                "one does; leave one of the two out"
            )


def _turn_problems(rotation: RotationSection) -> Iterator[str]:
    rate = math.hypot(*rotation.spin)
    most = LONGEST_TURN / DAY / rate if rate > 0.0 else math.inf
    if rotation.days > most:
        yield (
            f"site.rotation.days is {rotation.days:g} with a site.rotation.spin of {rate:.3g} rad/s, by which the body "
            f"turns {rate * rotation.days * DAY:.3g} rad; allowed: at most {LONGEST_TURN:g} rad, "
            f"site.rotation.days = {most:.3g}, as all of it is integrated before the first landing; lower the days or "
            "the spin"
        )


def _time_problems(site: SiteSection, days: float) -> Iterator[str]:
    if site.rotation_time is None:
        return
    latest = usual_reach(site.rotation_time)[1]
    if latest > days * DAY:
        yield (
            f"site.rotation_time reaches {latest:.6g} s; allowed: at most {days * DAY:.6g} s, which is "
            f"site.rotation.days = {days:g}; lower it, or give more days"
        )
