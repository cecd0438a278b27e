"""What landers at rest see of the sky: the table, the results, the page, and what is refused."""

import csv
import math
import re
from copy import deepcopy
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lithobrake.pipeline.site import Site
from lithobrake.pipeline.sky.seen_from_rest import rows_of, sky_dependencies
from lithobrake.pipeline.sky.where_they_stand import Days, where_it_stands
from lithobrake.results import StudyResults
from lithobrake.smallbody import Body, didymos, dimorphos
from lithobrake.smallbody.built_in_bodies import top_shape
from lithobrake.study import Study, StudyError, StudySource, check_tables
from lithobrake.study.lander_sides import SIDES
from lithobrake.vocabulary.quantities import SKY

from ...paper_tables import paper_tables
from ...smallbody.kernels import write_kernels
from .bouncing_lander import journey_tables

BALL = Body(top_shape((200.0, 200.0, 200.0), ridge_height=0.0, name="ball"), 1e9, 1e4)


def sky_rows(folder: Path, body: str) -> list[dict[str, str]]:
    with (folder / "sky.csv").open(newline="") as file:
        return [row for row in csv.DictReader(file) if row["body"] == body]


def test_every_lander_at_rest_has_a_row_for_each_body(journeys: StudyResults, journeys_folder: Path) -> None:
    at_rest = np.flatnonzero(journeys.journeys["end"] == "at_rest")
    for body in ("sun", "earth"):
        assert [int(row["journey"]) for row in sky_rows(journeys_folder, body)] == at_rest.tolist()


def test_latitudes_are_drawn_from_their_distribution(journeys_folder: Path) -> None:
    sun = np.array([float(row["latitude_deg"]) for row in sky_rows(journeys_folder, "sun")])
    assert -10.0 <= sun.min() < -5.0 < 5.0 < sun.max() <= 10.0
    assert {float(row["latitude_deg"]) for row in sky_rows(journeys_folder, "earth")} == {0.0}


def test_sides_see_a_part_of_what_the_lander_sees(journeys_folder: Path) -> None:
    """A side and the one opposite never face a body at once, and three of six do where it is seen."""
    for row in sky_rows(journeys_folder, "sun"):
        seen, sides = float(row["day_fraction"]), [float(row[f"side_{side}"]) for side in SIDES]
        assert 0.3 < seen < 0.56, "below 45 degrees of latitude, with the Sun within 10 of the equator"
        for first, second in zip(sides[::2], sides[1::2], strict=True):
            assert first + second == pytest.approx(seen)


def lander(
    x: float, y: float = 0.0, z: float = 0.0, turn: tuple[float, ...] = (1.0, 0.0, 0.0, 0.0)
) -> dict[str, float]:
    """A lander at rest at a place [m], its axes turned against those of the body by a quaternion."""
    found = {"journey": 0.0, "position_x": x, "position_y": y, "position_z": z}
    return found | dict(zip((f"attitude_{part}" for part in "wxyz"), turn, strict=True))


def equator(body: Body, one: dict[str, float], mask: float = 0.0, beam: float = 90.0) -> dict[str, float]:
    """What a lander sees of a body over the equator, by column."""
    (row,) = rows_of(body, [one], "earth", Days(np.zeros((1, 1))), mask, beam)
    return dict(zip(SKY, row, strict=True))


def test_the_side_that_looks_up_faces_a_body_over_the_equator() -> None:
    """Axes of the lander along those of the body, at longitude 0: +x looks up, +y to the east, -x into the ground."""
    found = equator(BALL, lander(100.0))
    assert found["day_fraction"] == found["least_day_fraction"] == pytest.approx(0.5, abs=0.01)
    assert found["side_+x"] == pytest.approx(found["day_fraction"])
    assert found["side_-x"] == 0.0
    assert found["side_+y"] == found["side_-y"] == pytest.approx(0.25, abs=0.01)
    assert found["side_+z"] == found["side_-z"] == 0.0


def test_a_mask_and_a_beam_leave_a_part_of_the_day() -> None:
    found = equator(BALL, lander(100.0), mask=30.0, beam=45.0)
    assert found["day_fraction"] == pytest.approx(1.0 / 3.0, abs=0.01)
    assert found["side_+x"] == pytest.approx(90.0 / 360.0, abs=0.01)
    # East is reached by what stands lower than 45 degrees, and is seen above 30.
    assert found["side_+y"] == pytest.approx(15.0 / 360.0, abs=0.01)


def test_didymos_hides_what_is_behind_it_from_the_side_that_faces_it() -> None:
    """2 arcsin(R / d) of the day, with the extents of Didymos along its equator; nothing on the other side."""
    assert equator(dimorphos(partner=False), lander(88.5))["day_fraction"] == pytest.approx(0.5, abs=0.01)
    body = dimorphos()
    hidden = 2.0 * math.asin(425.0 / (body.orbit.distance - 88.5)) / (2.0 * math.pi)
    assert hidden > 0.12
    assert equator(body, lander(88.5))["day_fraction"] == pytest.approx(0.5 - hidden, abs=0.01)
    assert equator(body, lander(-88.5))["day_fraction"] == pytest.approx(0.5, abs=0.01)


def test_dimorphos_goes_round_and_hides_little_of_any_sky_of_didymos() -> None:
    """Seen from its middle, 2 arcsin(R / d) of all that is up half the day."""
    body = didymos()
    hidden = 2.0 * math.asin(87.75 / 2.0 / body.orbit.distance) / (2.0 * math.pi)
    assert 0.5 - 3.0 * hidden - 0.01 < equator(body, lander(425.5))["day_fraction"] < 0.5


def sky_study(**changes: dict[str, Any]) -> tuple[Study, Site]:
    tables = journey_tables(**changes)
    tables["sky"] = changes.get("sky", {})
    study = StudySource.of_tables(tables).study
    return study, Site(study)


POLE = {"pole_right_ascension_deg": 0.0, "pole_declination_deg": 90.0}
ORBIT = {
    "semi_major_axis_au": 2.0, "eccentricity": 0.0, "inclination_deg": 0.0, "node_deg": 0.0, "perihelion_deg": 0.0,
    "mean_anomaly_deg": 0.0, "epoch": "2027-04-20T00:00:00",
}  # fmt: skip


def test_a_year_has_days_of_all_seasons(tmp_path: Path) -> None:
    """Over a year of a circle the Sun goes once to either side, by the obliquity of the pole; and its mean day at a
    latitude is half a day, its worst day the shortest."""
    pytest.importorskip("spiceypy")
    pytest.importorskip("erfa")
    span = {"date": "2027-04-20T00:00:00", "until": "2030-02-16T02:32:00", "orbit": ORBIT}
    study, site = sky_study(site=POLE, sky=span)
    assert study.sky.bodies == ("sun", "earth")
    days = where_it_stands(study, site, "sun")
    assert days.latitude.shape == (48, 24)
    parts = 2.0 * np.pi * (np.arange(24) + 0.5) / 24
    expected = -np.degrees(np.arcsin(np.sin(np.radians(84381.448 / 3600.0)) * np.sin(parts)))
    assert days.latitude[0] == pytest.approx(expected, abs=0.05)
    north = math.radians(50.0)
    place = [100.0 * math.cos(north), 0.0, 100.0 * math.sin(north)]
    (row,) = rows_of(BALL, [lander(*place)], "sun", days, 0.0, 90.0)
    found, up = dict(zip(SKY, row, strict=True)), BALL.shape.normals[BALL.shape.nearest(np.array([place]))[1]][0]
    lit = np.arccos(np.clip(-math.tan(math.asin(up[2])) * np.tan(np.radians(expected)), -1.0, 1.0)) / np.pi
    assert found["day_fraction"] == pytest.approx(lit.mean(), abs=0.005)
    assert found["least_day_fraction"] == pytest.approx(lit.min(), abs=0.01)


def test_an_orbiter_on_a_circle_or_in_a_table_is_seen_from_below_it(tmp_path: Path) -> None:
    """A table over one place sees all of the time that its rows there stand for."""
    study, site = sky_study(sky={"orbiter": {"altitude": 200.0, "inclination_deg": 0.0}})
    places = where_it_stands(study, site, "orbiter")
    radius = site.body.shape.radius + 200.0
    assert np.linalg.norm(places.position, axis=1) == pytest.approx(np.full(720, radius))
    (row,) = rows_of(BALL, [lander(100.0)], "orbiter", places, 0.0, 90.0)
    found = dict(zip(SKY, row, strict=True))
    assert found["day_fraction"] == pytest.approx(math.acos(100.0 / radius) / math.pi, abs=0.01)
    assert found["latitude_deg"] == ""
    table = tmp_path / "orbiter.csv"
    table.write_text("time_s,x_km,y_km,z_km,vx_m_s,vy_m_s,vz_m_s\n0,1,0,0,0,0,0\n100,-1,0,0,0,0,0\n400,1,0.1,0,0,0,0\n")
    study, site = sky_study(sky={"orbiter": {"states": str(table)}})
    (row,) = rows_of(BALL, [lander(100.0)], "orbiter", where_it_stands(study, site, "orbiter"), 0.0, 90.0)
    assert row[3] == pytest.approx((50.0 + 150.0) / 400.0)
    before = sky_dependencies(study)
    table.write_text(table.read_text().replace("400,", "500,"))
    assert sky_dependencies(study) != before


def write_sky_kernel(path: Path) -> dict[int, np.ndarray]:
    """An ephemeris in which Sun, Earth and an orbiter stand still about Didymos; their places [km] by number."""
    spice = pytest.importorskip("spiceypy")
    places = {10: np.array([1e8, 2e8, -3e7]), 399: np.array([1e8, 5e7, 4e7]), -91: np.array([3.0, -4.0, 5.0])}
    times = np.array([8.4e8, 8.5e8, 8.6e8, 8.7e8])
    handle = spice.spkopn(str(path), "test", 0)
    for number, place in places.items():
        states = np.tile([*place, 0.0, 0.0, 0.0], (4, 1))
        spice.spkw09(handle, number, 920065803, "J2000", times[0], times[-1], "still", 3, 4, states, times)
    spice.spkcls(handle)
    return places


def test_kernels_tell_where_sun_earth_and_orbiter_stand(tmp_path: Path) -> None:
    kernels = write_kernels(tmp_path)
    places = write_sky_kernel(tmp_path / "sky.bsp")
    names = [str(path) for path in (*kernels, tmp_path / "sky.bsp")]
    date = "2026-11-22T12:00:00"
    tables = {"site": {"body": "didymos", "kernels": names}, "sky": {"date": date, "until": "2026-11-24T00:00:00"}}
    tables["sky"]["orbiter"] = {"kernel_name": "-91"}
    study, site = sky_study(**tables)
    right_ascension, declination = np.radians([69.327, -72.725])
    pole = np.array(
        [
            math.cos(declination) * math.cos(right_ascension),
            math.cos(declination) * math.sin(right_ascension),
            math.sin(declination),
        ]
    )
    for name, number in (("sun", 10), ("earth", 399)):
        place = places[number]
        latitude = math.degrees(math.asin(place @ pole / np.linalg.norm(place)))
        assert where_it_stands(study, site, name).latitude == pytest.approx(np.full((48, 24), latitude), abs=1e-9)
    orbiter = where_it_stands(study, site, "orbiter").position
    assert orbiter[:, 2] == pytest.approx(np.full(720, 1e3 * places[-91] @ pole), abs=1e-6)
    assert np.linalg.norm(orbiter, axis=1) == pytest.approx(np.full(720, 1e3 * math.sqrt(50.0)))
    tables["site"]["kernels"] = names[:-1]
    with pytest.raises(StudyError, match=r"sky\.date: kernels .*add the kernel that has it"):
        sky_study(**tables)


@pytest.mark.parametrize(("sky", "words"), [
    ({"date": "soon"}, "allowed: a UTC date and time such as"),
    ({"date": "2027-04-20", "orbit": ORBIT}, "site.pole_right_ascension_deg is missing"),
    ({"date": "2027-04-20"}, "sky.orbit is missing"),
    ({"date": "2027-04-20", "until": "2027-04-19", "orbit": ORBIT}, "allowed: later than sky.date"),
    ({"date": "2027-04-20", "sun_latitude_deg": 3.0, "orbit": ORBIT}, "leave one of the two out"),
    ({"until": "2027-04-20"}, "sky.until goes with sky.date"),
    ({"orbiter": {}}, r"\[sky.orbiter\] has nothing; allowed: one of altitude, states, kernel_name"),
    ({"orbiter": {"altitude": 1.0, "kernel_name": "HERA"}}, "sky.orbiter.altitude and sky.orbiter.kernel_name"),
    ({"orbiter": {"kernel_name": "HERA"}}, "site.kernels is missing"),
    ({"orbiter": {"states": "nowhere.csv"}}, "cannot be read"),
    ({"orbiter": {"states": "x", "inclination_deg": 3.0}}, "is that of a circle"),
    ({"sun_latitude_deg": 3.0, "beam_deg": 30.0}, "sky.beam_deg is of Earth and the orbiter"),
    ({"earth_latitude_deg": 3.0, "beam_deg": 91.0}, "above 0 and at most 90"),
])  # fmt: skip
def test_a_sky_that_cannot_be_is_refused(sky: dict[str, Any], words: str) -> None:
    pytest.importorskip("spiceypy")
    pytest.importorskip("erfa")
    with pytest.raises(StudyError, match=words):
        sky_study(sky=sky)


def test_the_summary_and_the_page_have_it(journeys: StudyResults, journeys_folder: Path) -> None:
    found = journeys.results.sky
    seen = [float(row["day_fraction"]) for row in sky_rows(journeys_folder, "sun")]
    assert found["sun"].day_fraction.value == pytest.approx(np.median(seen), abs=0.01)
    assert found["sun"].day_fraction_q05.value <= found["sun"].day_fraction.value
    assert found["sun"].never.count == 0
    assert set(found["earth"].sides) == set(SIDES)
    assert found["sun"].probability.share == pytest.approx(np.mean(seen), abs=1e-9)
    assert found["sun"].probability.lower < found["sun"].probability.share < found["sun"].probability.upper
    up = np.mean([float(row["side_+z"]) for row in sky_rows(journeys_folder, "sun")])
    assert found["sun"].side_probabilities["+z"].share == pytest.approx(up, abs=1e-9)
    said = next(line for line in journeys.results.answer if line.startswith("Visible from the place of rest"))
    median = re.search(r"the Sun (\d+) \(\d+-\d+\) % of the time, Earth ", said)
    assert median
    assert int(median[1]) == pytest.approx(100.0 * np.median(seen), abs=1.0)


def test_the_sky_without_journeys_is_refused() -> None:
    tables = deepcopy(paper_tables())
    tables["sky"] = {"sun_latitude_deg": 0.0}
    with pytest.raises(StudyError, match="leave one out or add the other"):
        check_tables(tables, Path())
    tables["sky"] = {"mask_deg": 10.0}
    with pytest.raises(StudyError, match="leave it out, or ask for one"):
        check_tables(tables, Path())
    tables["sky"] = {"sun_latitude_deg": 91.0}
    with pytest.raises(StudyError, match="at least -90 and at most 90"):
        check_tables(tables, Path())
