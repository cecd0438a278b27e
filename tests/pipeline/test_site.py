"""The site: where an error of delivery leads, accelerations there, and the flights of single runs from it."""

import math
import re
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lithobrake.analysis import share_estimate
from lithobrake.pipeline import StudyFolder
from lithobrake.pipeline.answer.dispersion_statistics import site_results
from lithobrake.pipeline.answer.study_summary import summary_dependencies
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.first_touchdown.flights import Starts, flight_dependencies, fly_starts
from lithobrake.pipeline.first_touchdown.run_flights import FLIGHT_COUNT, run_sites
from lithobrake.pipeline.first_touchdown.samples import VELOCITY
from lithobrake.pipeline.job import Job, Silent
from lithobrake.pipeline.site import SITE_KEYS, Site, with_site_gravity
from lithobrake.smallbody import Body
from lithobrake.smallbody.built_in_bodies import top_shape
from lithobrake.statements.labels import end_words
from lithobrake.study import Study, StudyError, check_tables
from lithobrake.study.template import template
from lithobrake.vocabulary.constants import GRAVITATIONAL_CONSTANT

from ..geometry.test_mesh_files import PRODUCT, mesh, write_kernel
from ..paper_tables import with_keys
from ..synthetic_landings import WEAK
from .synthetic_lander import outputs_of, synthetic_tables


def changed(**sections: dict[str, Any]) -> Study:
    return check_tables(with_keys(tomllib.loads(template()), sections), Path())


@pytest.mark.parametrize("latitude", [0.0, 60.0, 90.0])
@pytest.mark.parametrize(("north", "east"), [(30.0, 0.0), (-90.0, 120.0), (0.0, 400.0)])
def test_an_error_goes_over_the_ground_by_its_length_however_long(latitude: float, north: float, east: float) -> None:
    """On a ball of 100 m an error of s metres is an arc of s / 100 rad, in the direction of its components."""
    body = Body(top_shape((200.0, 200.0, 200.0), ridge_height=0.0), 1e10, 1e5)
    site = {"latitude_deg": latitude, "longitude_deg": 25.0, "heading_deg": 0.0, "north_error": 0.0, "east_error": 0.0}
    columns = {key: np.array([value, value]) for key, value in site.items()}
    columns |= {"north_error": np.array([0.0, north]), "east_error": np.array([0.0, east])}
    (aim, there), axes = body.delivered_frame(*columns.values())
    radius, length = float(np.linalg.norm(aim)), math.hypot(north, east)
    ahead = axes[0] @ there / np.linalg.norm(there)
    assert aim @ there / radius / np.linalg.norm(there) == pytest.approx(math.cos(length / radius), abs=1e-12)
    # The frame is that of a facet, of which a corner is two thirds of 180 / 31 degrees off the normal, 0.068 rad.
    assert ahead[:2] == pytest.approx(np.array([north, -east]) / length * math.sin(length / radius), abs=0.07)


def test_the_slope_at_a_site_of_a_mesh_is_known_before_a_run(tmp_path: Path) -> None:
    """The middle of a facet of an octahedron lies plumb under its normal; a corner is acos(1 / sqrt 3) off."""
    body = {"body": str(mesh(tmp_path, "# Units: km\n")), "mass": 3e12, "spin_period": 1e9, "longitude_deg": 45.0}
    middle = math.degrees(math.asin(1.0 / math.sqrt(3.0)))
    assert Site(changed(site=body | {"latitude_deg": middle})).slope_deg == pytest.approx(0.0, abs=1e-3)
    assert 20.0 < Site(changed(site=body | {"latitude_deg": 85.0})).slope_deg < 55.0


PHOBOS = {"mass": 1.06e16, "spin_period": 27_553.8, "latitude_deg": 0.0, "longitude_deg": 0.0}
MARS = {"name": "Mars", "mass": 6.417e23, "diameter": 6.779e6}


def phobos(folder: Path, file: str = "phobos_v2.obj", **site: Any) -> Site:
    """An ellipsoid with the extents of Phobos, 26.06 x 22.8 x 18.28 km."""
    shape = top_shape((26_060.0, 22_800.0, 18_280.0), 0.0)
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in shape.vertices.tolist()]
    lines += [f"f {a} {b} {c}" for a, b, c in (shape.faces + 1).tolist()]
    (folder / file).write_text("\n".join(lines))
    return Site(changed(site=PHOBOS | {"body": str(folder / file)} | site))


def test_weight_below_a_planet_lacks_three_times_the_centrifugal_acceleration(tmp_path: Path) -> None:
    """Of a moon that keeps one face to it: n2 x by its turning, and 2 n2 x, with higher terms of x / d, by the tide.

    n2 d3 = G (M + m): d = 9374 km of 27 553.8 s. At the end of the long axis x = 13.03 km.
    """
    alone, both = phobos(tmp_path), phobos(tmp_path, partner_body=MARS)
    turning, x = (2.0 * math.pi / PHOBOS["spin_period"]) ** 2, 13_030.0
    pull = GRAVITATIONAL_CONSTANT * MARS["mass"]
    distance = ((pull + GRAVITATIONAL_CONSTANT * PHOBOS["mass"]) / turning) ** (1.0 / 3.0)
    assert both.body.orbit.distance == pytest.approx(distance, rel=1e-5)
    assert both.body.orbit.rate == 0.0
    tide = pull / (distance - x) ** 2 - pull / distance**2
    assert both.acceleration[2] - alone.acceleration[2] == pytest.approx(tide, rel=1e-4)
    assert tide == pytest.approx(2.0 * turning * x, rel=3e-3)
    # 3.5 mm/s2 by a point mass there become 2.1; the ellipsoid, whose ends are nearer, pulls by 1.3 mm/s2 more.
    assert [-1e3 * site.acceleration[2] for site in (both, alone)] == pytest.approx([3.46, 4.82], abs=0.01)
    assert both.values["partner_longitude_deg"] == 0.0
    assert both.slope_deg == pytest.approx(0.0, abs=2.0)
    assert site_results(both).partner == "Mars"


def test_a_body_that_is_known_to_have_a_partner_is_warned_of_without_it(tmp_path: Path) -> None:
    site = phobos(tmp_path)
    (words,) = site.cautions
    assert words.startswith("Phobos orbits with Mars, which this study leaves out")
    assert 'name = "Mars", mass = 6.417e+23 and diameter = 6.779e+06' in words
    assert site_results(site).cautions == (words,) == tuple(site.remarks[:1])
    assert phobos(tmp_path, partner=False).cautions == ()
    assert phobos(tmp_path, partner_body=MARS).cautions == ()
    assert phobos(tmp_path, "moon.obj").cautions == ()
    assert phobos(tmp_path, "moon.obj", name="Phobos").cautions == (words,)


def test_the_orbit_of_a_partner_follows_from_its_distance_as_from_its_period(tmp_path: Path) -> None:
    """Another body is over every longitude in turn."""
    given = {"name": "Other", "mass": 1e15, "diameter": 5e3, "distance": 4e5}
    site = phobos(tmp_path, partner_body=given)
    assert site.body.orbit.distance == pytest.approx(4e5, rel=1e-12)
    again = phobos(tmp_path, partner_body=given | {"distance": None, "period": site.body.partner.period})
    assert again.body.orbit.distance == pytest.approx(4e5, rel=1e-12)
    assert site.values["partner_longitude_deg"].parameters == {"lower": -180.0, "upper": 180.0}
    assert flight_dependencies(site.study) != flight_dependencies(again.study)


def test_a_partner_has_a_spin_and_a_flattening_of_its_own(tmp_path: Path) -> None:
    """Without them it is a ball that keeps one face to the body. A spheroid has C - A = m (a^2 - c^2) / 5."""
    given = {"name": "Other", "mass": 1e15, "diameter": 5e3, "distance": 4e5}
    plain = phobos(tmp_path, partner_body=given).body.partner
    assert plain.body.spin_period == plain.period
    own = phobos(tmp_path, partner_body=given | {"spin_period": 8136.0, "polar_diameter": 4e3}).body.partner.body
    assert own.spin_period == 8136.0
    assert own.shape.volume == pytest.approx(0.8 * math.pi / 6.0 * 5e3**3, rel=1e-9)
    # The ball of facets is round by its moments of inertia as a whole to a few parts in a million.
    assert own.flattening == pytest.approx((2.5e3**2 - 2e3**2) / 5.0, rel=1e-5)


def test_a_lander_goes_on_on_a_small_body_and_not_on_a_planet(tmp_path: Path) -> None:
    small = {"name": "Other", "mass": 1e15, "diameter": 5e3, "distance": 4e5}
    assert phobos(tmp_path, partner_body=small, name="Phobos").ground_names == ("Phobos", "Other")
    assert phobos(tmp_path, partner_body=MARS, name="Phobos").ground_names == ("Phobos",)
    said = [end_words(site_results(phobos(tmp_path, partner_body=one)))["partner"] for one in (small, MARS)]
    assert said == ["at rest on Other", "on Mars"]


def test_a_density_is_a_mass_over_the_volume_of_the_shape(tmp_path: Path) -> None:
    volume, mass = phobos(tmp_path).body.shape.volume, PHOBOS["mass"]
    uncertain = {"distribution": "uniform", "lower": 1800.0, "upper": 1900.0}
    site = phobos(tmp_path, mass=None, density=uncertain)
    assert site.values["mass"].parameters == pytest.approx({"lower": 1800.0 * volume, "upper": 1900.0 * volume})
    assert site.body.density == pytest.approx(1850.0)
    assert phobos(tmp_path, mass=None, density=mass / volume).body.mass == pytest.approx(mass, rel=1e-12)
    built_in = changed(site={"body": "dimorphos", "density": 2400.0})
    assert Site(built_in).body.density == pytest.approx(2400.0)


@pytest.mark.parametrize(("site", "words"), [
    ({"density": 2000.0}, r"site.mass is 1.06e\+16 and site.density 2000; keep one"),
    ({"mass": None}, "site.mass is missing; a body read from a mesh needs its mass, or site.density"),
    ({"mass": None, "density": 2.0}, "site.density makes that a bulk density of 2 kg/m3"),
    ({"partner_body": MARS | {"period": 1e5, "distance": 1e7}}, "either follows from the other and both masses"),
    ({"partner_body": MARS | {"distance": 9.376e6}}, "an orbit of 27563.7 s, and spin_period is 27553.8 s"),
    ({"partner_body": MARS, "partner": False}, "site.partner_body is given, and site.partner is false; keep one"),
    ({"partner_body": MARS, "body": "dimorphos"}, 'and site.body is "dimorphos", which has its own'),
    ({"partner_body": MARS | {"name": "<b>"}}, "site.partner_body.name is \"<b>\"; allowed: 1 to 40 letters"),
    ({"partner_body": {"mass": 1e10}}, "site.partner_body.diameter is missing"),
    ({"partner_body": MARS | {"name": "Phobos"}, "name": "Phobos"}, "the name of the body itself; allowed: another"),
    ({"partner_body": MARS | {"polar_diameter": 7e6}}, "allowed: up to its diameter, 6.779e\\+06 m"),
    ({"partner_body": MARS | {"polar_diameter": 0.0}}, "site.partner_body.polar_diameter is 0; allowed: above 0"),
    ({"partner_body": MARS | {"spin_period": 0.5}}, "site.partner_body.spin_period is 0.5; allowed: at least 1"),
    ({"partner_body": MARS | {"spin_period": -3600.0}}, "site.partner_body.spin_period is -3600"),
    ({"partner_body": MARS | {"spin_period": math.inf}}, "site.partner_body.spin_period is inf"),
])  # fmt: skip
def test_partners_and_densities_that_cannot_be_are_refused(site: dict[str, Any], words: str, tmp_path: Path) -> None:
    with pytest.raises(StudyError, match=words):
        phobos(tmp_path, **site)


def test_unlike_accelerations_of_touchdown_and_site_are_told() -> None:
    def warned(gravity: Any, latitude: float) -> str | None:
        return Site(changed(surface={"gravity": gravity}, site={"latitude_deg": latitude})).gravity_warning

    # 1.4e-5 m/s2 outwards at the equator, 2.2e-4 m/s2 inwards near the pole.
    assert "5e-05 m/s2 inward" in str(warned(5e-5, 0.0))
    assert "1.39e-05 m/s2 outward," in str(warned(5e-5, 0.0))
    assert "bed.settle_gravity" in str(warned(5e-5, 0.0))
    assert "inward, so touchdown" in str(warned(5e-5, 80.0))
    assert warned(1e-4, 80.0) is None
    assert warned(6e-4, 80.0) is None
    assert "0.0008 m/s2 inward" in str(warned(8e-4, 80.0))
    assert warned({"distribution": "uniform", "lower": 1e-5, "upper": 1e-4}, 80.0) is None
    site = changed(surface={"gravity": "site"}, bed={"settle_gravity": 2e-5}, site={"latitude_deg": 0.0})
    assert Site(site).gravity_warning is None


def test_a_spin_period_in_hours_is_asked_back() -> None:
    said = r"is 11\.4 s, and .* push outward by .* m/s2.*is it in hours\? write seconds, 41040"
    with pytest.raises(StudyError, match=said):
        with_site_gravity(changed(surface={"gravity": "site"}, site={"body": "dimorphos", "spin_period": 11.4}))
    # At the equator of Didymos, which turns so fast that it throws off what lies there.
    with pytest.raises(StudyError, match=r"push outward by 1\.39e-05 m/s2.*move the site, or give bed\.settle_gravity"):
        with_site_gravity(changed(surface={"gravity": "site"}, site={"latitude_deg": 0.0}))


def test_the_escape_speed_is_that_of_the_potential_at_the_site() -> None:
    study = changed(site={"latitude_deg": 80.0, "partner": False})
    body = Site(study).body
    radius = float(np.linalg.norm(body.shape.surface_point(80.0, 0.0)))
    # Far from a point mass, and still within some per cent of it.
    assert Site(study).escape_speed == pytest.approx(math.sqrt(2.0 * body.gravitational_parameter / radius), rel=0.08)
    assert Site(study).escape_speed != Site(changed(site={"latitude_deg": 0.0, "partner": False})).escape_speed


def test_the_body_may_be_a_shape_kernel_of_spice(tmp_path: Path) -> None:
    write_kernel(pytest.importorskip("spiceypy"), tmp_path / "rock.bds", 1)
    site = {"body": str(tmp_path / "rock.bds"), "mass": 2.6e12, "spin_period": 2e4}
    body = Site(changed(site=site)).body
    # An octahedron with corners at a kilometre: kernels have no other unit.
    assert body.shape.volume == pytest.approx(4.0 / 3.0 * 1e9)
    with pytest.raises(ValueError, match="says km"):
        changed(site=site | {"unit": "m"})


def test_the_product_of_an_archive_is_named_by_the_label_of_its_mesh(tmp_path: Path) -> None:
    """Given by its label, or found beside the mesh; another version of it makes the summary anew, not the flights."""
    path = mesh(tmp_path, label=PRODUCT.format(file="rock.obj"))
    label = path.with_suffix(".xml")
    given, found = (changed(site={"body": str(one), "mass": 3e12, "spin_period": 1e4}) for one in (label, path))
    for study in (given, found):
        told = site_results(Site(study))
        assert (told.body, told.product_id) == ("mesh", "urn:nasa:pds:rocks:data:rock::3.0")
        assert told.extents_m == (2e3, 2e3, 2e3)
    assert flight_dependencies(given) == flight_dependencies(found)
    before = flight_dependencies(found), summary_dependencies(found)
    label.write_text(label.read_text().replace("3.0", "4.0"))
    assert flight_dependencies(found) == before[0]
    assert summary_dependencies(found) != before[1]
    assert site_results(Site(changed())).product_id is None
    # A mesh or a label that is edited is read again in the same process.
    path.write_text("\n".join(re.sub("^(v.*)1", r"\g<1>3", line) for line in path.read_text().splitlines()))
    assert site_results(Site(given)).extents_m == (6e3, 6e3, 6e3)
    label.write_text(label.read_text().replace("<unit>km", "<unit>m"))
    assert site_results(Site(given)).extents_m == (6.0, 6.0, 6.0)
    label.write_text(PRODUCT.format(file="other.obj"))
    with pytest.raises(ValueError, match=r"study\.toml: site\.body: .*rock\.xml: this label names other\.obj"):
        changed(site={"body": str(label), "mass": 3e12, "spin_period": 1e4})


UNCERTAIN = {
    "mass": {"distribution": "uniform", "lower": 5.2e11, "upper": 5.4e11},
    "north_error": {"distribution": "uniform", "lower": -20.0, "upper": 20.0},
}


def study(**site: object) -> Study:
    return check_tables(synthetic_tables(site=site), Path())


def test_headings_of_a_run_are_in_equal_steps_from_a_first_one_of_its_own() -> None:
    sites = run_sites(Site(study(**UNCERTAIN)), 30)
    assert set(sites) == set(SITE_KEYS)
    steps = np.diff(np.sort(sites["heading_deg"], axis=1), axis=1)
    assert steps == pytest.approx(np.full((30, FLIGHT_COUNT - 1), 360.0 / FLIGHT_COUNT))
    assert len(np.unique(sites["heading_deg"][:, 0])) == 30
    # Each law is met once in each of its equal parts, in an order that has nothing to do with the headings.
    places = np.sort(np.ceil((sites["north_error"] + 20.0) / 40.0 * FLIGHT_COUNT), axis=1)
    assert np.array_equal(places, np.tile(np.arange(1, FLIGHT_COUNT + 1), (30, 1)))
    assert np.isfinite(sites["mass"]).all()
    mixed = [np.corrcoef(sites["heading_deg"][run], sites["north_error"][run])[0, 1] for run in range(30)]
    assert abs(np.mean(mixed)) < 0.1
    assert np.all(sites["latitude_deg"] == 0.0)


def test_more_runs_and_one_more_uncertain_number_change_no_site() -> None:
    few, many = run_sites(Site(study(**UNCERTAIN)), 5), run_sites(Site(study(**UNCERTAIN)), 9)
    assert all(np.array_equal(few[key], many[key][:5]) for key in SITE_KEYS)
    alone = run_sites(Site(study(mass=UNCERTAIN["mass"])), 5)
    assert all(np.array_equal(few[key], alone[key]) for key in ("mass", "heading_deg", "partner_longitude_deg"))


def test_four_times_as_many_flights_leave_the_interval_as_it_is() -> None:
    _, y, outcome, bed = WEAK.study(60, 12, 3)
    left, drawn = np.flatnonzero(outcome == "clear"), study()
    velocity = np.array([[outputs_of(y[run])[name] for name in VELOCITY] for run in left])
    job = Job(DrawnDesign(drawn), {}, StudyFolder.only_read(Path()), None, Silent())  # type: ignore[arg-type]
    width = []
    for count in (FLIGHT_COUNT, 4 * FLIGHT_COUNT):
        sites = {key: values.ravel() for key, values in run_sites(Site(drawn), len(left), count).items()}
        flown = fly_starts(job, Starts(np.repeat(left, count), np.repeat(velocity, count, axis=0), sites), "")
        found = share_estimate((flown.status == "impact").reshape(-1, count).mean(axis=1), bed[left]).share
        width.append(found.upper - found.lower)
    assert width[1] == pytest.approx(width[0], rel=0.03)
