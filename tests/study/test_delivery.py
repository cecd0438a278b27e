"""Deliveries by states, by a release and with correlations, and landers of several parts, in a study file."""

from copy import deepcopy
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lithobrake.pipeline.design.dependencies import touchdown_dependencies
from lithobrake.study import Study, StudyError, check_tables
from lithobrake.study.delivered_states import read_states
from lithobrake.study.lander_checks import lander_radius
from lithobrake.study.source import fixed_study
from lithobrake.touchdown.lander_model import lander

from ..paper_tables import SMALL_GROUND, paper_tables, with_keys

TABLES: dict[str, Any] = {
    **SMALL_GROUND, "lander": {"shape": "box", "edges": [0.1, 0.1, 0.227], "mass": 2.0}, "journey": {"count": 2},
    "site": {"body": "dimorphos"},
}  # fmt: skip
AIM = {"latitude_deg": 10.0, "longitude_deg": 20.0}
RELEASE = {"position": [0.0, 200.0, 0.0], "velocity": [0.0, -0.05, 0.0]}
FLOWN = {**AIM, "frame": "body_fixed", "release": RELEASE}
NORMAL = {"distribution": "normal", "mean": 0.0, "std": 10.0}
SPEED = {"distribution": "uniform", "lower": 0.04, "upper": 0.07}
SURFACE = {**AIM, "speed": SPEED, "incidence_deg": 20.0, "north_error": NORMAL, "east_error": NORMAL}
STATES = "time_s,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s\n0,0,200,0,0,-0.05,0\n1,0,210,0,0,-0.05,0\n"


def checked(delivery: dict[str, Any], folder: Path = Path(), **changes: dict[str, Any]) -> Study:
    return check_tables(with_keys(deepcopy(TABLES) | {"delivery": delivery}, changes), folder)


def refused(delivery: dict[str, Any], folder: Path = Path(), **changes: dict[str, Any]) -> str:
    with pytest.raises(StudyError) as error:
        checked(delivery, folder, **changes)
    return str(error.value)


def test_a_release_needs_neither_speed_nor_incidence() -> None:
    study = checked(FLOWN)
    assert study.impact.speed is None
    assert "impact.speed" not in study.touchdown_values()
    assert study.delivery.is_flown


def test_one_standard_deviation_stands_for_three() -> None:
    study = checked(FLOWN | {"release": RELEASE | {"position_std": 30, "velocity_std": [0.01, 0.0, 0.02]}})
    assert study.delivery.release.position_std == (30.0, 30.0, 30.0)
    assert study.delivery.release.velocity_std == (0.01, 0.0, 0.02)


def covariance(**entries: float) -> list[list[float]]:
    """Variances of 100 and 1e-4, with entries by row and column, as r1c2."""
    matrix = np.diag([100.0] * 3 + [1e-4] * 3)
    for place, value in entries.items():
        matrix[int(place[1]) - 1, int(place[3]) - 1] = value
    return matrix.tolist()


@pytest.mark.parametrize(("matrix", "words"), [
    ([[1.0]], "allowed: 6 rows of 6 numbers"),
    ([["1"] * 6] * 6, "write finite numbers without quotes"),
    (covariance(r2c2=-1.0), "has -1 as the variance in row 2"),
    (covariance(r1c1=1e308), "has 1e+308 as the variance in row 1; allowed: 0 to 1e+18, the square of 1e+09 m"),
    (covariance(r4c4=1e13), "has 1e+13 as the variance in row 4; allowed: 0 to 1e+12, the square of 1e+06 m/s"),
    (covariance(r2c1=5.0), "has 5 in row 2, column 1 and 0 in row 1, column 2; allowed: a symmetric matrix"),
    (covariance(r4c1=0.2, r1c4=0.2), "has 0.2 in row 4, column 1; allowed: -0.1 to 0.1"),
    (covariance(r2c1=90.0, r1c2=90.0, r3c2=90.0, r2c3=90.0, r3c1=-90.0, r1c3=-90.0),
     "has the eigenvalue -0.8; allowed: none below 0"),
])  # fmt: skip
def test_what_is_no_covariance_is_refused(matrix: Any, words: str) -> None:
    said = refused(FLOWN | {"release": RELEASE | {"covariance": matrix}})
    assert "delivery.release.covariance" in said
    assert words in said


def test_covariances_without_full_rank_are_taken() -> None:
    checked(FLOWN | {"release": RELEASE | {"covariance": [[0.0] * 6] * 6}})
    one = np.outer([1.0, 2.0, 3.0, 1e-3, 2e-3, 3e-3], [1.0, 2.0, 3.0, 1e-3, 2e-3, 3e-3])
    checked(FLOWN | {"release": RELEASE | {"covariance": one.tolist()}})


@pytest.mark.parametrize(("delivery", "words"), [
    ({"release": RELEASE | {"position_std": 1.0}}, "takes position_std and velocity_std together"),
    ({"release": RELEASE | {"position_std": 1.0, "velocity_std": 0.0, "covariance": covariance()}},
     "has covariance and position_std; keep one"),
    ({"release": RELEASE | {"position_std": -1.0, "velocity_std": 0.0}},
     "allowed: 3 numbers, each at least 0 and at most 1e+09 [m]"),
    ({"release": RELEASE | {"velocity": [1e200, 0.0, 0.0]}}, "each at least -1e+06 and at most 1e+06 [m/s]"),
    ({"release": RELEASE | {"time": 1e300}}, "at least -1e+11 and at most 1e+11 [s]"),
    ({"speed": 0.1}, "delivery.speed is given, and the flight from [delivery.release] tells it"),
    ({"heading_deg": 10.0}, "delivery.heading_deg is given"),
    ({"north_error": NORMAL}, "delivery.north_error is given"),
    ({"frame": None}, "delivery.frame is missing"),
    ({"frame": "J2000"}, "allowed: body_fixed or icrf"),
    ({"frame": "icrf"}, "site.pole_right_ascension_deg is missing"),
    ({"latitude_deg": None}, "delivery.latitude_deg is missing"),
    ({"longitude_deg": SPEED}, "one number, that of the aim point"),
    ({"epoch": "soon"}, "delivery.epoch is 'soon'; allowed: a date and time"),
    ({"states": "no.csv"}, "delivery.states and [delivery.release] are both given"),
])  # fmt: skip
def test_keys_that_do_not_go_together_are_refused(delivery: dict[str, Any], words: str) -> None:
    given = {key: value for key, value in (FLOWN | delivery).items() if value is not None}
    assert words.replace("'", '"') in refused(given).replace("'", '"')


def test_landers_that_are_flown_to_the_ground_take_the_acceleration_of_where_they_are() -> None:
    said = refused(FLOWN, surface={"gravity": 5e-5}, journey={"touchdowns": 1})
    assert "surface.gravity is 5e-05, and landers that fly to the ground from a state take the acceleration" in said
    assert checked(FLOWN, journey={"touchdowns": 1}, monte_carlo={"sample_count": 0}).has_local_ground
    assert "delivery.frame goes with states or [delivery.release]" in refused(SURFACE | {"frame": "icrf"})


@pytest.mark.parametrize(("pairs", "words"), [
    ([["north_error", "east_error"]], "allowed: two keys and a number between -1 and 1"),
    ([["north_error", "east_error", 1.0]], "allowed: two keys and a number between -1 and 1"),
    ([["north_error", "east", 0.5]], "names 'east'"),
    ([["north_error", "incidence_deg", 0.5]], "names incidence_deg, which is 20"),
    ([["speed", "speed", 0.5]], "allowed: two different keys"),
    ([["speed", "east_error", 0.5], ["east_error", "speed", 0.4]], "the pair east_error and speed twice"),
    ([["north_error", "east_error", 0.9], ["north_error", "speed", -0.9], ["east_error", "speed", 0.9]],
     "weaken the correlations that contradict each other"),
])  # fmt: skip
def test_correlations_that_cannot_be_are_refused(pairs: Any, words: str) -> None:
    assert words.replace("'", '"') in refused(SURFACE | {"correlations": pairs}).replace("'", '"')


def test_an_expansion_has_no_correlated_inputs() -> None:
    """Its designs and indices are those of independent ones; where a lander arrives is none of its inputs."""
    angle, pair = {"distribution": "uniform", "lower": 0.0, "upper": 40.0}, ["speed", "incidence_deg", -0.3]
    given = {**SURFACE, "incidence_deg": angle, "correlations": [pair]}
    said = "delivery.correlations has speed and incidence_deg, and [expansion] takes all inputs as independent"
    assert said in refused(given, expansion={})
    assert checked(given | {"correlations": [["north_error", "speed", 0.3]]}, expansion={}).expansion is not None


def test_states_count_from_the_study_file_and_are_at_least_as_many_as_journeys(tmp_path: Path) -> None:
    (tmp_path / "states.csv").write_text(STATES)
    given = AIM | {"frame": "body_fixed", "states": "states.csv"}
    assert checked(given, tmp_path).delivery.states == str(tmp_path / "states.csv")
    said = refused(given, tmp_path, journey={"count": 3})
    assert "journey.count is 3 and delivery.states has 2 rows; allowed: at most as many journeys as rows" in said
    said = refused(given, tmp_path, design={"half_width": 0.1, "largest_run_count": 24})
    assert "design.largest_run_count is 24 and delivery.states has 2 rows" in said
    assert "other.csv cannot be read" in refused(given | {"states": "other.csv"}, tmp_path)


@pytest.mark.parametrize(("change", "words"), [
    (("x_m", "x"), "line 1: x has no unit; write it into the title, as x_m"),
    (("x_m", "x_kg"), "line 1: x_kg has the unit [kg]; allowed: m, km, cm"),
    (("vx_m_s", "vx_m"), "line 1: vx_m has the unit [m]; allowed: m/s, km/s"),
    (("x_m", "run"), "is no column"),
    (("vz_m_s", "vy_km_s"), "line 1: vy has two columns"),
    (("1,0,210,0,0,-0.05,0", "1,0,210,0,0,-0.05"), "line 3 has 6 cells; allowed: 7"),
    (("210", "many"), 'line 3: y is "many"; allowed: a finite number'),
    (("210", "nan"), "line 3: y is"),
    (("210", "1e308"), 'line 3: y is "1e308"; allowed: a finite number, at most 1e+09 m in size'),
    (("-0.05", "1e200"), 'line 2: vy is "1e200"; allowed: a finite number, at most 1e+06 m/s'),
    (("1,0,210", "1e300,0,210"), 'line 3: time is "1e300"; allowed: a finite number, at most 1e+11 s'),
    ((",y_m", ";y_m"), "has comma and semicolon; allowed: titles such as time_s, x_m"),
    ((STATES, STATES.replace(",", " ")), "has no separator"),
    ((STATES, STATES.replace(",", ";").replace("-0.05", "-0,05")), "a finite number, with a decimal point"),
    ((STATES[STATES.index("0,0,200") :], ""), "has no states"),
    (("time_s", "<xml>"), "is XML"),
    ((",vz_m_s", ""), "the column vz_m_s is missing"),
])  # fmt: skip
def test_tables_that_cannot_be_read_are_told_their_line(change: tuple[str, str], words: str, tmp_path: Path) -> None:
    path = tmp_path / "states.csv"
    path.write_text(STATES.replace(*change))
    with pytest.raises(ValueError, match=r"states\.csv") as error:
        read_states(path, "body_fixed", None, ())
    assert words.replace("'", '"') in str(error.value).replace("'", '"')


def test_units_stand_in_the_titles(tmp_path: Path) -> None:
    path = tmp_path / "states.csv"
    path.write_text("# of another tool\n\nvx_cm_s,vy_mm_s,vz_m_s,time_h,x_km,y_m,z_m\n1,2,3,0.5,4,5,6\n")
    found = read_states(path, "body_fixed", None, ())
    assert (found.time.tolist(), found.position.tolist()) == ([1800.0], [[4000.0, 5.0, 6.0]])
    assert (found.velocity[0], found.source) == (pytest.approx([0.01, 0.002, 3.0]), ["states.csv, line 4"])


def test_an_attitude_is_whole_and_of_length_one(tmp_path: Path) -> None:
    path = tmp_path / "states.csv"
    lines = STATES.splitlines()
    path.write_text(f"{lines[0]},q_w,q_x,q_y,q_z\n{lines[1]},1,0,0,0\n")
    with pytest.raises(ValueError, match="the column rate_x_rad_s, rate_y_rad_s, rate_z_rad_s is missing"):
        read_states(path, "body_fixed", None, ())
    titles = f"{lines[0]},q_w,q_x,q_y,q_z,rate_x_deg_s,rate_y_deg_s,rate_z_deg_s"
    path.write_text(f"{titles}\n{lines[1]},0,0.5,0,0,1,0,0\n")
    with pytest.raises(ValueError, match=r"line 2: q_w to q_z have the length 0\.5"):
        read_states(path, "body_fixed", None, ())
    path.write_text(f"{titles}\n{lines[1]},0,1,0,0,1,0,0\n")
    assert read_states(path, "body_fixed", None, ()).rates[0] == pytest.approx([np.pi / 180.0, 0.0, 0.0])


OEM = """CCSDS_OEM_VERS = 2.0
META_START
OBJECT_NAME = CUBESAT
CENTER_NAME = DIMORPHOS
REF_FRAME = ICRF
TIME_SYSTEM = UTC
META_STOP
2027-04-20T12:00:00.5 0 0.2 0 0 -5e-5 0
2027-04-20T12:00:10 0 0.2 0 0 -5e-5 0
"""


@pytest.mark.parametrize(("change", "frame", "words"), [
    (("REF_FRAME = ICRF", "REF_FRAME = TEME"), "icrf", "line 8: REF_FRAME is TEME"),
    (("", ""), "body_fixed", 'line 8: REF_FRAME is ICRF, and the states of the study are "body_fixed"'),
    (("DIMORPHOS", "DIDYMOS"), "icrf", "line 8: CENTER_NAME is DIDYMOS; allowed: DIMORPHOS"),
    (("-5e-5 0\n2027", "-5e-5\n2027"), "icrf", "line 8 has 6 words"),
    (("-5e-5 0\n2027", "fast 0\n2027"), "icrf", "line 8: could not convert"),
    (("2027-04-20T12:00:10", "20 April"), "icrf", "line 9 has 8 words"),
    (("CENTER_NAME = DIMORPHOS\n", ""), "icrf", "line 6: the segment has no CENTER_NAME"),
    (("META_START", "META_STOP"), "icrf", "the segment has no"),
    (("META_STOP\n", ""), "icrf", "line 7: the block META_START has no META_STOP before it; write it"),
    (("REF_FRAME", "TIME_SYSTEM = UTC\nREF_FRAME"), "icrf", "line 7: TIME_SYSTEM stands twice in its segment"),
    (("META_STOP\n", "META_STOP\nCOVARIANCE_START\n"), "icrf", "COVARIANCE_START has no COVARIANCE_STOP"),
    (("0 0.2 0 0 -5e-5 0\n2027", "0 1e308 0 0 -5e-5 0\n2027"), "icrf", "line 8: a number is not finite or too large"),
    (("META_STOP", "USEABLE_START_TIME = noon\nMETA_STOP"), "icrf", 'line 8: USEABLE_START_TIME is "noon"'),
    (("META_STOP", "USEABLE_START_TIME = 2027-04-21\nUSEABLE_STOP_TIME = 2027-04-20\nMETA_STOP"), "icrf",
     "line 9: USEABLE_STOP_TIME 2027-04-20 is before USEABLE_START_TIME 2027-04-21; swap them"),
])  # fmt: skip
def test_messages_that_cannot_be_read_are_refused_with_their_line(
    change: tuple[str, str], frame: str, words: str, tmp_path: Path
) -> None:
    path = tmp_path / "states.oem"
    path.write_text(OEM.replace(*change) if change[0] else OEM)
    with pytest.raises(ValueError, match=r"states\.oem") as error:
        read_states(path, frame, "2027-04-20T12:00:00", ("DIMORPHOS",))
    assert words in str(error.value)


def test_times_of_a_message_count_from_the_epoch(tmp_path: Path) -> None:
    path = tmp_path / "states.oem"
    path.write_text(OEM)
    found = read_states(path, "icrf", "2027-04-20T12:00:00", ("DIMORPHOS",))
    assert (found.time.tolist(), found.position[0].tolist()) == ([0.5, 10.0], [0.0, 200.0, 0.0])
    assert read_states(path, "icrf", None, ("DIMORPHOS",)).time.tolist() == [0.0, 9.5]


@pytest.mark.parametrize(("system", "epochs", "epoch", "times"), [
    ("UTC", ("2016-12-31T23:59:50", "2017-01-01T00:00:10"), None, [0.0, 21.0]),
    ("UTC", ("2016-366T23:59:60.5", "2017-001T01:00:00Z"), "2016-12-31T23:59:60", [0.5, 3601.0]),
    ("UTC", ("2016-12-31T23:59:50", "2017-01-01T00:00:10"), "2017-01-01T01:00:00+01:00", [-11.0, 10.0]),
    ("TAI", ("2016-12-31T23:59:50", "2017-01-01T00:00:10"), None, [0.0, 20.0]),
    ("TAI", ("2027-04-20T12:00:37", "2027-04-20T12:01:37"), "2027-04-20T12:00:00 UTC", [0.0, 60.0]),
    ("GPS", ("2027-04-20T12:00:18", "2027-04-20T12:01:18"), "2027-04-20T12:00:00Z", [0.0, 60.0]),
    ("TT", ("2027-04-20T12:00:00", "2027-04-20T12:01:00"), "2027-04-20T12:00:00 TT", [0.0, 60.0]),
    ("tdb", ("2027-04-20T12:00:00", "2027-04-20T12:01:00"), "2027-04-20T12:00:00 TDB", [0.0, 60.0]),
])  # fmt: skip
def test_times_of_a_message_are_seconds_in_any_time_system(
    system: str, epochs: tuple[str, str], epoch: str | None, times: list[float], tmp_path: Path
) -> None:
    read = read_states(timed(tmp_path, system, *epochs), "icrf", epoch, ("DIMORPHOS",))
    assert read.time.tolist() == pytest.approx(times, abs=1e-7)


@pytest.mark.parametrize(("system", "epoch", "words"), [
    ("UTC", "2027-366T00:00:00", 'line 8: the epoch is "2027-366T00:00:00", and 2027 has the days 001 to 365'),
    ("UTC", "2027-1T00:00:00", 'line 8: the epoch is "2027-1T00:00:00"; allowed: '),
    ("UTC", "0001-01-01T00:00:00+05:00", "and the year is 1; allowed: a date and time of the years 1900 to 2999"),
    ("MET", "2027-04-20T12:00:00", "in the time system MET; allowed: UTC, TAI, GPS, TT, TDB; mend the line"),
    ("TDB", "2027-04-20T12:00:00", 'write "2027-04-20T12:00:00 TDB" or "2027-04-20T12:00:00 UTC"'),
])  # fmt: skip
def test_epochs_that_are_none_or_of_an_open_time_system_are_refused(
    system: str, epoch: str, words: str, tmp_path: Path
) -> None:
    with pytest.raises(ValueError, match=r"states\.oem|delivery\.epoch is") as error:
        read_states(timed(tmp_path, system, epoch, epoch), "icrf", "2027-04-20T12:00:00", ("DIMORPHOS",))
    assert words in str(error.value)


def timed(folder: Path, system: str, *epochs: str) -> Path:
    """A message whose states are at these epochs of a time system."""
    path, (head, *_) = folder / "states.oem", OEM.partition("2027")
    rows = "".join(f"{epoch} 0 0.2 0 0 -5e-5 0\n" for epoch in epochs)
    path.write_text(head.replace("UTC", system) + rows)
    return path


BOOM = {"shape": "box", "edges": [1.5, 0.01, 0.02], "centre": [0.93, 0.0, 0.01], "mass": 0.05}
# A quarter turn about z.
ASIDE = {**BOOM, "centre": [0.0, 0.86, 0.0], "orientation": [1.0, 0.0, 0.0, 1.0]}
FOOT = {"shape": "sphere", "diameter": 0.06, "centre": [-0.15, 0.1, -0.1], "density": 1000.0, "restitution": 0.1}


def tables(**changes: Any) -> dict[str, Any]:
    found = deepcopy(paper_tables())
    found["bed"]["width"] = [6.0, 6.0]
    box = {"shape": "box", "edges": [0.366, 0.226, 0.1], "mass": 12.0, "part": {"boom": BOOM, "aside": ASIDE}}
    found["lander"] = {**box, **changes}
    return found


def study(**changes: Any) -> Study:
    return check_tables(tables(**changes), Path())


def test_reach_and_masses_are_those_of_the_engine() -> None:
    one = study(part={"boom": BOOM, "aside": ASIDE, "foot": FOOT})
    body = lander(one, one.touchdown_medians())
    # Edges and corners of hulls are rounded, by a fiftieth of their least width at most.
    assert lander_radius(one.lander) == pytest.approx(body.reach, rel=1e-3)
    assert body.own_mass == pytest.approx(12.0 - 0.1 - 1000.0 * np.pi / 6.0 * 0.06**3)
    assert [part.shape.volume for part in body.parts[:2]] == pytest.approx([3e-4, 3e-4])
    np.testing.assert_allclose(np.ptp(body.parts[1].shape.vertices, axis=0), [0.01, 1.5, 0.02], atol=1e-12)
    assert body.parts[2].material.restitution == 0.1
    assert body.parts[0].material.restitution == body.material.restitution


def test_centre_of_mass_and_inertia_are_the_sums_over_point_like_parts() -> None:
    """Two heavy balls far out: m d^2 about each axis across, by hand."""
    ball = {"shape": "sphere", "diameter": 0.01, "mass": 1.0}
    ends = {"one": {**ball, "centre": [1.0, 0.0, 0.0]}, "two": {**ball, "centre": [0.0, 1.0, 0.0]}}
    one = study(part=ends, mass=2.0 + 1e-6)
    body = lander(one, one.touchdown_medians()).body
    np.testing.assert_allclose(body.centre_of_mass, [0.5, 0.5, 0.0], atol=1e-6)
    np.testing.assert_allclose(body.inertia, [[0.5, 0.5, 0], [0.5, 0.5, 0], [0, 0, 1.0]], atol=1e-4)


def test_what_is_given_stands_in_the_axes_of_the_lander() -> None:
    one = study(centre_of_mass={"x": 0.01, "z": -0.02}, inertia=[0.2, 0.3, 0.4, 0.05, 0.0, -0.02])
    body = lander(one, one.touchdown_medians()).body
    np.testing.assert_allclose(body.centre_of_mass, [0.01, 0.0, -0.02])
    np.testing.assert_allclose(body.inertia, [[0.2, 0.05, 0.0], [0.05, 0.3, -0.02], [0.0, -0.02, 0.4]])


def test_uncertain_properties_of_parts_are_inputs_by_their_keys() -> None:
    law = {"distribution": "uniform", "lower": 0.1, "upper": 0.3}
    one = study(part={"foot": {**FOOT, "restitution": law}}, centre_of_mass={"y": {**law, "lower": -0.1}})
    values = one.touchdown_medians()
    assert values["lander.part.foot.restitution"] == pytest.approx(0.2)
    values |= {"lander.part.foot.restitution": 0.15, "lander.centre_of_mass.y": 0.05}
    made = lander(one, values)
    assert (made.parts[0].material.restitution, made.body.centre_of_mass[1]) == (0.15, 0.05)


def test_numbers_of_a_run_stand_in_the_tables_of_parts() -> None:
    one = study(part={"foot": FOOT}, centre_of_mass={"y": 0.0})
    given = {"lander.part.foot.restitution": 0.4, "lander.centre_of_mass.y": 0.03}
    orientation = {f"impact.orientation.{part}": float(part == "w") for part in "wxyz"}
    fixed = fixed_study(one, {**one.touchdown_medians(), **orientation, **given})
    assert (fixed.lander.part["foot"].restitution, fixed.lander.centre_of_mass.y) == (0.4, 0.03)
    for key in ("lander.part.foot", "lander.part.hand.restitution", "lander.part.foot.speed"):
        with pytest.raises(StudyError, match=key):
            fixed_study(one, {**one.touchdown_medians(), **orientation, key: 0.4})


def test_a_landing_depends_on_the_parts_and_on_nothing_more_without_any() -> None:
    assert "parts" not in touchdown_dependencies(study(part={}))
    one, other = (touchdown_dependencies(study(part={"boom": {**BOOM, "mass": mass}})) for mass in (0.05, 0.06))
    assert one != other


@pytest.mark.parametrize(("changes", "words"), [
    ({"part": {"a b": BOOM}}, ["lander.part.a b is no name"]),
    ({"part": {"a": {**BOOM, "diameter": 0.1}}}, ["lander.part.a.diameter does not go with this shape"]),
    ({"part": {"a": {**BOOM, "mass": None}}}, ["lander.part.a takes mass or density", "neither"]),
    ({"part": {"a": {**BOOM, "density": 2.0}}}, ["lander.part.a takes mass or density", "both"]),
    ({"part": {"a": {**BOOM, "mass": 12.5}}}, ["lander.part has 12.5 kg", "raise it"]),
    ({"part": {"a": {**BOOM, "edges": [1.5, 1e-3, 0.1]}}}, ["lander.part.a.edges", "thicken the box"]),
    ({"part": {"a": {**BOOM, "orientation": [0, 0, 0, 0]}}}, ["lander.part.a.orientation", "[1, 0, 0, 0]"]),
    ({"part": {"a": {**BOOM, "resitution": 0.2}}}, ["lander.part.a.resitution", "did you mean restitution?"]),
    ({"part": {"a": {**BOOM, "shape": "hull"}}}, ["lander.part.a.file is missing"]),
    ({"part": {"a": {**BOOM, "unit": "mm"}}}, ["lander.part.a.unit"]),
    ({"part": {"a": {**BOOM, "centre": [9.0, 0.0, 0.0]}}}, ["bed.width", "with its parts, reaches"]),
    ({"inertia": [0.1, 0.1, 0.3]}, ["lander.inertia", "as every body has it"]),
    ({"inertia": [1.0, 1.0, 1.0, 0.9, 0.9, -0.9]}, ["lander.inertia", "as every body has it"]),
    ({"inertia": [0.5, 0.5, 1.0, 0.5, 0.0, 0.0]}, ["lander.inertia", "as every body has it"]),
    ({"inertia": [1.0, 1.0, -1.0]}, ["lander.inertia", "moments above 0"]),
    ({"inertia": [1.0, 1.0, 1.0, 0.0]}, ["lander.inertia", "3 or 6 numbers"]),
])  # fmt: skip
def test_parts_that_make_no_lander_are_refused(changes: dict[str, Any], words: list[str]) -> None:
    found = tables(**changes)
    for part in found["lander"].get("part", {}).values():
        for key in [key for key, value in part.items() if value is None]:
            del part[key]
    with pytest.raises(StudyError) as refusal:
        check_tables(found, Path())
    assert len(refusal.value.problems) <= 2
    assert all(word in str(refusal.value) for word in words)


def test_an_uncertain_diameter_does_not_go_with_parts() -> None:
    ball = {"shape": "sphere", "diameter": {"distribution": "uniform", "lower": 0.1, "upper": 0.2}, "mass": 1.0}
    found = tables()
    found["lander"] = {**ball, "part": {"boom": BOOM}}
    with pytest.raises(StudyError, match=r"lander\.diameter is uncertain"):
        check_tables(found, Path())
