"""Bounces on hard ground and on ground with a table of restitution, and journeys made of flights and bounces."""

import dataclasses
import math
from pathlib import Path

import numpy as np
import pytest

from lithobrake.smallbody import (
    Body,
    HardSurface,
    Impacts,
    Launch,
    Rebounds,
    RestitutionTable,
    Shape,
    didymos,
    fly,
    hop,
)
from lithobrake.smallbody.restitution_table import LEVELS, cells

from .meshes import CUBE_FACES, cube_vertices


@pytest.fixture(scope="module")
def plain() -> Body:
    """A cube of 200 m that does not turn: near the middle of its top, gravity is nearly plumb and constant."""
    return Body(Shape(cube_vertices(200.0), CUBE_FACES), mass=2e10, spin_period=math.inf)


def impacts(speed: float, incidence: float, outward: float = -1e-4) -> Impacts:
    return Impacts(np.array([speed]), np.array([incidence]), np.zeros((1, 3)), np.array([outward]), np.arange(1))


def test_hard_surface_limits_the_tangential_impulse_by_friction():
    random = np.random.default_rng(0)
    steep = HardSurface(0.6, 0.5, friction=0.3)(impacts(0.2, 0.2), random)
    down, along = 0.2 * math.cos(0.2), 0.2 * math.sin(0.2)
    # Steep: friction could stop more than is lost; half of the horizontal speed is kept.
    assert steep.velocity[0] == pytest.approx([0.5 * along, 0.0, 0.6 * down])
    flat = HardSurface(0.6, 0.5, friction=0.3)(impacts(0.2, 1.4), random)
    down, along = 0.2 * math.cos(1.4), 0.2 * math.sin(1.4)
    # Flat: it slides, and loses friction times the normal impulse.
    assert flat.velocity[0] == pytest.approx([along - 0.3 * 1.6 * down, 0.0, 0.6 * down])
    assert not steep.captured[0]
    assert HardSurface(0.6)(impacts(1e-4, 0.0), random).captured[0]
    assert not HardSurface(0.6)(impacts(1e-4, 0.0, outward=1e-5), random).captured[0]
    with pytest.raises(ValueError, match="normal_restitution is"):
        HardSurface(1.2)


def test_bounces_of_a_ball_follow_the_geometric_series(plain):
    """Thrown up at v from a plane it bounces at e v, e e v ...: flights of 2 v / g, 2 e v / g ..."""
    origin = np.array([3.0, 2.0, 100.0])
    push = -float(plain.acceleration(origin)[2])
    speed, restitution = 0.004, 0.5
    surface = HardSurface(restitution, rest_height=1e-3)
    end = hop(plain, Launch(origin, [0.0, 0.0, speed]), surface, 86400.0, gravity="exact")
    assert end.status[0] == "settled"
    # A rebound of e**n v rises (e**n v)**2 / 2 g; the first one below the height of rest is the end.
    rebounds = math.floor(math.log(math.sqrt(2.0 * push * 1e-3) / speed) / math.log(restitution))
    assert end.bounce_count[0] == rebounds
    # Gravity weakens by some thousandths over the 0.09 m that the first flight rises.
    expected = 2.0 * speed / push * (1.0 - restitution ** (rebounds + 1)) / (1.0 - restitution)
    assert end.time[0] == pytest.approx(expected, rel=5e-3)
    assert end.latitude[0] == pytest.approx(math.degrees(math.atan2(100.0, math.hypot(3.0, 2.0))), abs=0.1)


def test_journeys_end_in_each_way(plain):
    start, up = np.array([3.0, 2.0, 100.0]), np.array([0.0, 0.0, 1.0])

    def unknown(hit: Impacts, random: np.random.Generator) -> Rebounds:
        nothing = np.zeros(len(hit.speed), dtype=bool)
        return Rebounds(np.full((len(hit.speed), 3), np.nan), hit.spin, nothing, ~nothing)

    assert hop(plain, Launch(start, 0.01 * up), unknown, 1e5, gravity="exact").status[0] == "outside"
    assert hop(plain, Launch(start, 0.01 * up), HardSurface(1.0), 1e3, gravity="exact").status[0] == "flying"
    assert hop(plain, Launch(start, 1.0 * up), HardSurface(1.0), 1e5, gravity="exact").status[0] == "escaped"
    limited = hop(plain, Launch(start, 0.002 * up), HardSurface(1.0), 1e5, gravity="exact", bounce_limit=3)
    assert (limited.status[0], limited.bounce_count[0]) == ("bouncing", 3)


def test_a_launch_has_one_value_for_all_landers_or_one_for_each(plain):
    place = np.array([[3.0, 2.0, 100.0], [-3.0, 1.0, 100.0]])
    with pytest.raises(ValueError, match=r"launch: mass has shape \(3,\) for 2 landers; it must be \(\)"):
        hop(plain, Launch(place, [0.0, 0.0, 0.01], mass=[1e10, 2e10, 3e10]), HardSurface(0.5), 1e3)
    told: list[float] = []
    nobody = hop(plain, Launch(place[:0], place[:0]), HardSurface(0.5), 1e3, gravity="exact", progress=told.append)
    assert (len(nobody.status), told) == (0, [1.0])


def test_the_frame_of_an_impact_and_the_spin_are_carried(plain):
    """A bounce that turns by a right angle to the left of the way it came, and gives a spin about the normal."""

    def aside(hit: Impacts, random: np.random.Generator) -> Rebounds:
        along = hit.speed * np.sin(hit.incidence)
        up = hit.speed * np.cos(hit.incidence)
        spin = np.tile([0.0, 0.0, 0.5], (len(along), 1))
        none = np.zeros(len(along), dtype=bool)
        return Rebounds(np.stack([0.0 * along, along, up], axis=1), spin, none, none)

    start = np.array([-1.0, 0.3, 100.0])
    end = hop(plain, Launch(start, [0.01, 0.0, 0.01]), aside, 1e5, gravity="exact", bounce_limit=1)
    first = hop(plain, Launch(start, [0.01, 0.0, 0.01]), aside, 1e5, gravity="exact", bounce_limit=0)
    assert first.position[0, 0] > start[0] + 0.5
    assert abs(first.position[0, 1] - start[1]) < 0.1
    assert end.position[0, 1] > first.position[0, 1] + 0.5
    assert end.spin[0] == pytest.approx([0.0, 0.0, 0.5])
    again = hop(plain, Launch(start, [0.01, 0.0, 0.01]), aside, 1e5, gravity="exact", bounce_limit=1)
    assert np.array_equal(again.position, end.position)


def test_a_bounce_is_told_which_lander_it_is(plain):
    """The second of three lands and stays; the others bounce once more, and each keeps the last impact it had."""
    seen = []

    def only_the_second_stays(hit: Impacts, random: np.random.Generator) -> Rebounds:
        seen.append(hit.lander.tolist())
        up = np.stack([0.0 * hit.speed, 0.0 * hit.speed, 0.5 * hit.speed], axis=1)
        return Rebounds(up, hit.spin, hit.lander == 1, np.zeros(len(hit.speed), dtype=bool))

    start, up = np.array([[3.0, 2.0, 100.0], [-3.0, 1.0, 100.0], [0.0, 4.0, 100.0]]), np.array([0.0, 0.0, 4e-3])
    end = hop(plain, Launch(start, up), only_the_second_stays, 1e5, gravity="exact", bounce_limit=1)
    assert seen == [[0, 1, 2]]
    assert end.status.tolist() == ["bouncing", "settled", "bouncing"]
    assert end.impact_speed == pytest.approx([2e-3, 4e-3, 2e-3], rel=5e-3)
    assert (end.incidence < 0.1).all()
    away = hop(plain, Launch(start[0], 250.0 * up), only_the_second_stays, 1e5, gravity="exact")
    assert away.status[0] == "escaped"
    assert np.isnan(away.impact_speed[0])


def test_a_lander_that_only_its_own_motion_holds_down_slides_until_it_leaves_the_ground():
    """Westward along the equator of Didymos it stays down, though the ground there throws off what lies on it."""
    body = didymos(partner=False)
    origin, axes = body.local_frame(0.0, 0.0, 270.0)
    assert axes[2] @ body.effective_acceleration(origin) > 0.0
    launch = Launch(origin, 0.15 * axes[0])
    stuck = hop(body, launch, HardSurface(0.6), 1e5, gravity="exact")
    assert (stuck.status[0], stuck.slid_length[0]) == ("lofted", 0.0)
    assert 5 < stuck.bounce_count[0] < 100
    # Friction takes the motion that holds it down, and the spin throws it off.
    short = hop(body, launch, HardSurface(0.6), 4000.0, friction=0.1, gravity="exact")
    assert short.status[0] == "sliding"
    assert short.slid_time[0] > 3000.0
    end = hop(body, launch, HardSurface(0.6), 1e5, friction=0.6, gravity="exact")
    assert end.status[0] == "flying"
    assert end.slid_time[0] > 1000.0
    assert end.path_length[0] > 100.0


def test_flights_that_are_noted_lead_from_bounce_to_bounce_and_change_nothing():
    """Made again one by one, they end to the last bit where the next begins; the ends of journeys stay the same."""
    body = didymos(partner=False)
    origin, axes = body.local_frame([40.0, 0.0, 50.0], [0.0, 10.0, 90.0])
    launch = Launch(origin, 0.1 * axes[:, 2] + 0.05 * axes[:, 0], time=[5.0, 6.0, 7.0], mass=[5e11, 5.2e11, 5.4e11])
    settings = {"friction": 0.6, "gravity": "exact"}
    noted = hop(body, launch, HardSurface(0.7), 2e4, arc_landers=2, **settings)
    plain = hop(body, launch, HardSurface(0.7), 2e4, **settings)
    for name in ("status", "time", "position", "spin", "bounce_count", "path_length", "slid_length", "impact_speed"):
        assert np.array_equal(getattr(noted, name), getattr(plain, name), equal_nan=name == "impact_speed"), name
    arcs = noted.arcs
    assert len(plain.arcs.lander) == 0
    assert sorted(set(arcs.lander.tolist())) == [0, 1]
    assert (np.diff(arcs.lander) >= 0).all()
    again = fly(
        *(body, arcs.position, arcs.velocity, 2e4 - arcs.begin),
        gravity="exact", start_time=arcs.clock, mass=arcs.mass, spin_period=arcs.spin_period,
    )  # fmt: skip
    assert np.array_equal(arcs.begin + again.time, arcs.end)
    follows = (arcs.lander[1:] == arcs.lander[:-1]) & (arcs.begin[1:] == arcs.end[:-1])
    assert follows.sum() > 3
    assert np.array_equal(again.position[:-1][follows], arcs.position[1:][follows])
    assert np.array_equal(arcs.clock, np.array([5.0, 6.0])[arcs.lander] + arcs.begin)
    assert (arcs.end[np.searchsorted(arcs.lander, [0, 1], side="right") - 1] <= noted.time[:2]).all()


def test_between_flights_a_lander_may_slide():
    """What is captured on steep ground begins its first flight after it has slid off the ground."""
    body = didymos(partner=False)
    origin, axes = body.local_frame(0.0, 0.0, 270.0)
    launch = Launch(origin, 0.15 * axes[0])
    end = hop(body, launch, HardSurface(0.6), 1e5, friction=0.6, gravity="exact", arc_landers=1)
    gaps = end.arcs.begin[1:] - end.arcs.end[:-1]
    assert (gaps >= 0.0).all()
    assert gaps.sum() + end.arcs.begin[0] == pytest.approx(end.slid_time[0])


@pytest.mark.parametrize("friction", [-1.0, math.nan])
def test_a_friction_below_0_is_refused(plain, friction):
    with pytest.raises(ValueError, match=r"friction is .* at least 0"):
        hop(plain, Launch([0.0, 0.0, 1.0], [0.0, 0.0, 0.0]), HardSurface(1.0), 1.0, friction=friction)


def even(lower: float, upper: float) -> np.ndarray:
    """Quantiles of a uniform law, the same in all of 2 by 1 cells."""
    return np.tile(np.interp(LEVELS, [0.0, 1.0], [lower, upper]), (2, 1, 1))


TABLE = RestitutionTable(
    np.array([0.0, 0.1, 0.2]),
    np.array([0.0, 90.0]),
    {
        "normal_restitution": even(0.2, 0.6) * [[[1.0]], [[0.5]]],
        "tangential_restitution": even(0.5, 0.9),
        "azimuth_deg": even(-30.0, 30.0),
        "friction": even(0.1, 0.3),
    },
    np.array([[0.8], [0.0]]),
    np.array([[0.0], [0.25]]),
    np.array([[400], [300]]),
    np.array([[12], [10]]),
    rest_height=0.0,
)


def alike_impacts(speed: float, count: int = 20_000) -> Impacts:
    every = np.ones(count)
    return Impacts(speed * every, np.radians(60.0) * every, np.zeros((count, 3)), -1e-4 * every, np.arange(count))


def test_draws_have_the_quantiles_and_the_correlation_of_their_cell() -> None:
    found = TABLE(alike_impacts(0.05), np.random.default_rng(1))
    normal = found.velocity[:, 2] / (0.05 * np.cos(np.radians(60.0)))
    along = np.hypot(found.velocity[:, 0], found.velocity[:, 1]) / (0.05 * np.sin(np.radians(60.0)))
    # A uniform law over 0.4 has this deviation; four standard errors of the mean.
    luck = 4 * 0.4 / np.sqrt(12 * 20_000)
    assert normal.mean() == pytest.approx(0.4, abs=luck)
    assert along.mean() == pytest.approx(0.7, abs=luck)
    # Uniform scores of normal ones that correlate by 0.8: 6/pi asin(0.4).
    assert np.corrcoef(normal, along)[0, 1] == pytest.approx(6 / np.pi * np.arcsin(0.4), abs=0.02)
    assert np.abs(np.degrees(np.arctan2(found.velocity[:, 1], found.velocity[:, 0]))).max() <= 30.0
    assert not found.captured.any()


def test_an_impact_beyond_the_table_is_that_of_the_next_cell_and_some_stay() -> None:
    found = TABLE(alike_impacts(5.0), np.random.default_rng(2))
    assert found.captured.mean() == pytest.approx(0.25, abs=4 * np.sqrt(0.25 * 0.75 / 20_000))
    assert (found.velocity[:, 2] / (5.0 * np.cos(np.radians(60.0)))).max() <= 0.3
    assert cells(TABLE.speed, np.array([-1.0, 0.0, 0.1, 0.2, 9.0])).tolist() == [0, 0, 1, 1, 1]


def test_a_rebound_that_hardly_rises_is_the_end() -> None:
    lazy = dataclasses.replace(TABLE, rest_height=1.0)
    assert lazy(alike_impacts(1e-3), np.random.default_rng(3)).captured.all()


def test_a_table_is_read_as_it_was_written(tmp_path: Path) -> None:
    TABLE.save(tmp_path / "table.csv")
    read = RestitutionTable.read(tmp_path / "table.csv", rest_height=0.0)
    one, other = (table(alike_impacts(0.05, 50), np.random.default_rng(4)).velocity for table in (TABLE, read))
    assert np.array_equal(one, other)
    assert (read.runs.tolist(), read.captured.tolist()) == ([[12], [10]], [[0.0], [0.25]])
    assert (tmp_path / "table.csv").read_text().startswith("speed_from [m/s],speed_to [m/s],incidence_from_deg,")
