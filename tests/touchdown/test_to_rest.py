"""How landings end: at rest after low hops, over the rim by the judge; landers with parts; beds that repeat."""

import dataclasses
import math
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import h5py
import numpy as np
import pytest

from lithobrake.dem import (
    BodyMotion,
    Box,
    ConvexHull,
    Material,
    Part,
    Sphere,
    World,
    folded,
    period_of,
    rotation_matrices,
)
from lithobrake.geometry.bed_limits import longest_reach
from lithobrake.touchdown import OUTPUTS, Bed, BedRecipe, ContactModel, Lander, Landing, land, pour_bed, settling
from lithobrake.touchdown.bed import boxed_world, height_map
from lithobrake.touchdown.grains import make_grain, make_grain_within
from lithobrake.touchdown.landing import picture
from lithobrake.touchdown.outcome_judge import REST_WAY, OutcomeJudge, RestWatch, rest_time
from lithobrake.touchdown.pouring import rain
from lithobrake.touchdown.simulation import release
from lithobrake.vocabulary.quantities import ORIENTATION_OUT, TO_REST

from .landings import LANDER, ROCK, landing

GRAVITY = 5e-4
BOUNCY = replace(ROCK, restitution=0.9, friction=0.3)


def slow(**changes: Any) -> Landing:
    of_rest = {"speed": 0.02, "incidence": 0.5, "time_limit": 1000.0, "hop_height": 0.3}
    return landing(**{**of_rest, "contact": ContactModel(held_speed=0.03), **changes})


def test_near_grains_are_held_once_an_impact_is_over_or_the_lander_cannot_leave(
    ground: Bed, monkeypatch: pytest.MonkeyPatch
) -> None:
    run, seen = World.run_locally, []

    def noted(world: World, *args: Any, **options: Any) -> None:
        number = len(world.bodies) - 1
        turning = np.linalg.norm(world.spin[number]) * LANDER.reach
        speed = float(np.linalg.norm(world.velocity[number]) + turning)
        since = world.time - world.watched["last_contact"]
        seen.append((speed, world.first_touch is None, speed * since, options))
        run(world, *args, **options)

    monkeypatch.setattr(World, "run_locally", noted)
    land(ground, LANDER, slow())
    # Half of its smallest edge: no lander slower than that can rise higher.
    leaving = math.sqrt(GRAVITY * LANDER.smallest_edge)
    for speed, is_coming, gone, options in seen:
        may_leave = is_coming or (gone <= 0.5 * ground.grain_diameter and speed >= leaving)
        assert (options["reach"] > 0.0) == may_leave
        assert options["calm_speed"] == (None if may_leave else pytest.approx(5.0 * options["held_speed"]))
        assert options["held_speed"] == pytest.approx(0.03 * max(speed, leaving))
    assert {options["reach"] > 0.0 for _, _, _, options in seen} == {True, False}


def test_a_slow_lander_comes_to_rest_on_a_side(ground: Bed) -> None:
    outcome = land(ground, LANDER, slow(), frame_count=20)
    outputs = outcome.outputs
    assert outcome.status == "captured"
    assert {*TO_REST, *ORIENTATION_OUT} <= outputs.keys()
    assert outputs["duration"] == outcome.simulated_time < 1000.0
    assert outputs["duration"] > rest_time(LANDER, GRAVITY)
    assert outputs["contacts"] >= 1.0
    assert math.hypot(*(outputs[name] for name in ORIENTATION_OUT)) == pytest.approx(1.0)
    # The frame is that of the incoming velocity: the lander came 0.3 rad from x, and went on that way.
    way = outcome.frames["position"][-1, -1] - outcome.frames["position"][0, -1]
    turned = complex(*way[:2]) * complex(math.cos(0.3), -math.sin(0.3))
    assert outputs["displacement_x"] == pytest.approx(turned.real, abs=2e-3)
    assert outputs["displacement_y"] == pytest.approx(turned.imag, abs=2e-3)
    assert outputs["displacement_z"] == pytest.approx(way[2], abs=2e-3)
    # Nothing is left that could lift it by a thousandth of its size.
    assert outputs["energy_lost"] == pytest.approx(0.5 * 0.6 * 0.02**2, rel=0.05)


def test_it_leaves_for_a_hop_that_rises_higher_than_asked_and_no_other(ground: Bed) -> None:
    # It falls on a side; whether one lander stays is chance, and of three places most throw it up.
    lander = replace(LANDER, material=BOUNCY)
    flat: dict[str, Any] = {"grain": BOUNCY, "speed": 0.1, "incidence": 0.2, "orientation": (1.0, 0.0, 0.0, 0.0)}
    places = ((0.1, 0.05), (0.0, 0.0), (-0.1, 0.1))
    found = [land(ground, lander, slow(hop_height=0.2, place=place, **flat)) for place in places]
    left = [one for one in found if one.status == "clear"]
    assert len(left) >= 2
    assert {one.status for one in found} <= {"clear", "captured"}
    for one in left:
        assert 0.5 * one.outputs["velocity_out_z"] ** 2 / GRAVITY + ground.grain_diameter + 0.1 > 0.2
    low = land(ground, lander, slow(hop_height=100.0, place=places[1], **flat))
    assert low.status == "captured"
    assert low.outputs["contacts"] > 1.0


def test_where_gravity_points_outward_nothing_rests(ground: Bed) -> None:
    assert rest_time(LANDER, -1e-5) == math.inf
    assert land(ground, LANDER, slow(gravity=(0.0, 0.0, 1e-5), speed=0.05)).status == "clear"


def motion(position: tuple[float, float, float], angle: float = 0.0) -> BodyMotion:
    turn = np.array([math.cos(0.5 * angle), math.sin(0.5 * angle), 0.0, 0.0])
    zero = np.zeros(3)
    return BodyMotion(np.array(position), zero, turn, angular_momentum=zero, spin=zero, mass=1.0)


def test_rest_asks_for_no_motion_of_any_point_for_as_long_as_toppling_takes() -> None:
    edge, patience = LANDER.smallest_edge, rest_time(LANDER, GRAVITY)
    assert patience == pytest.approx(math.sqrt(edge / GRAVITY))
    still, sways, turns = (RestWatch(LANDER, GRAVITY) for _ in range(3))
    times = np.linspace(0.0, 1.01 * patience, 40)
    way = 1.5 * REST_WAY * edge
    for time in times:
        ends = [
            still.is_over(time, motion((0.0, 0.0, 0.1))),
            sways.is_over(time, motion((way * (time > 0.5 * patience), 0.0, 0.1))),
            turns.is_over(time, motion((0.0, 0.0, 0.1), way / LANDER.shape.bounding_radius * (time > 0.5 * patience))),
        ]
    assert ends == [True, False, False]


@pytest.mark.parametrize("height", [0.0, -1.0, math.inf, math.nan])
def test_a_hop_height_that_is_none_is_refused(height: float) -> None:
    with pytest.raises(ValueError, match=r"Landing\.hop_height"):
        slow(hop_height=height)


BALL = Lander(shape=Sphere(0.1), mass=1.0, material=ROCK)
BED = SimpleNamespace(width=(1.0, 1.0), period=None, surface_height=0.5, grain_diameter=0.1, boulder_count=0)
LANDING = SimpleNamespace(
    azimuth=0.0, time_limit=10.0, hop_height=None, contact=SimpleNamespace(steps_per_contact=50.0)
)


def world(velocity=(0.1, 0.0, 0.05), touches=False, touched=1.0, x=0.6):
    """A lander low over the grains, at x [m], after a blow."""
    motion = BodyMotion(np.array([x, 0.0, 0.62]), np.array(velocity), np.array([1.0, 0.0, 0.0, 0.0]),
        angular_momentum=np.zeros(3), spin=np.array([0.0, 1.0, 0.0]), mass=1.0)  # fmt: skip
    return SimpleNamespace(time=1.0, time_step=1e-3, gravity=np.array([0.0, 0.0, -1e-4]), touch_duration=touched,
        first_touch=None if touched is None else 0.5, motion_of=lambda number: motion, is_touched=touches,
        watched={"peak_force": 1.0})  # fmt: skip


def judged(**changes):
    judge = OutcomeJudge(BED, BALL, LANDING, world(**changes), 0, 0)
    judge.look()
    return judge


def test_a_lander_that_flies_up_over_the_rim_is_clear_and_says_so():
    judge = judged()
    assert judge.ended == "clear"
    outputs = judge.outcome().outputs
    assert outputs["over_rim"] == 1.0
    assert (outputs["velocity_out_x"], outputs["velocity_out_z"]) == (0.1, 0.05)


@pytest.mark.parametrize("changes", [
    {"velocity": (0.1, 0.0, -0.05)},
    {"touches": True},
    {"touched": None},
    # Too slow to lift itself by half its size: not known to leave, and never said to stay.
    {"velocity": (1e-3, 0.0, 1e-3)},
], ids=["goes down", "still touches", "has not touched", "too slow"])  # fmt: skip
def test_any_other_lander_over_the_rim_is_missing(changes):
    judge = judged(**changes)
    assert judge.ended == "left_sideways"
    assert np.isnan(judge.outcome().outputs["velocity_out_x"])
    assert np.isnan(judge.outcome().outputs["over_rim"])


def test_a_low_lander_over_the_bed_is_still_open():
    assert judged(x=0.4).ended is None


@pytest.mark.parametrize(("boulder_at", "ended"), [(0.4, None), (0.34, None), (0.1, "clear")])
def test_over_a_boulder_a_lander_is_clear_above_its_top(boulder_at, ended):
    """The lander, 0.1 m in radius at x = 0.4 m, is 0.12 m over the clear height of the grains, and under 0.6 m."""
    boulder = {"boulder_count": 1, "boulder_height": lambda x, y: np.where(np.abs(x - boulder_at) < 0.05, 0.6, -np.inf)}
    bed = SimpleNamespace(**(vars(BED) | {"surface_height": 0.3} | boulder))
    judge = OutcomeJudge(bed, BALL, LANDING, world(x=0.4), 0, 0)
    judge.look()
    assert judge.ended == ended
    assert judge.ground() == (pytest.approx((0.6, 0.6)) if ended is None else pytest.approx((0.3, 0.4)))


SKIN = Material(young_modulus=1e6, poisson_ratio=0.25, restitution=0.6, friction=0.4, density=1000.0)
SLANTED = np.array([0.8, 0.3, -0.4, 0.2]) / np.linalg.norm([0.8, 0.3, -0.4, 0.2])
BAR = ConvexHull(Box((0.12, 0.01, 0.01)).vertices + np.array([0.09, 0.0, 0.0]))
FOOT = Sphere(0.012, (-0.02, 0.01, -0.04))


def with_parts(**changes):
    parts = Part(BAR, SKIN), Part(FOOT, SKIN)
    return Lander(**{"shape": Box((0.06, 0.05, 0.04)), "mass": 0.4, "material": SKIN, "parts": parts, **changes})


def slanted(**changes):
    given = {"grain": SKIN, "speed": 0.2, "orientation": tuple(SLANTED), "spin": (0.1, 0.0, 0.2), "time_limit": 3.0}
    return landing(**{**given, "contact": ContactModel(), **changes})


def test_the_lowest_point_is_that_of_the_part_that_hangs_lowest():
    lander, rotation = with_parts(), rotation_matrices(SLANTED[None])[0]
    points = [shape.vertices for shape in (lander.shape, BAR)]
    ends = [((p - lander.body.centre_of_mass) @ rotation[2]).min() for p in points]
    ends.append((FOOT.centroid - lander.body.centre_of_mass) @ rotation[2] - FOOT.radius)
    assert lander.lowest(np.array([0.0, 0.0, 2.0]), rotation) == pytest.approx(2.0 + min(ends), abs=1e-15)
    assert min(ends) == ends[2]


def test_a_lander_starts_with_its_lowest_point_above_every_grain_in_reach(bed):
    lander, one = with_parts(), slanted()
    world = bed.world(one.grain, bed.gravity, one.contact)
    turns = rotation_matrices(world.orientation)[:, 2]
    tops = [(hull.vertices - hull.centroid) @ turn for hull, turn in zip(bed.grains, turns, strict=True)]
    top = max(height + rise.max() for height, rise in zip(world.position[:, 2], tops, strict=True))
    number = release(world, bed, lander, one)
    low = lander.lowest(world.position[number], rotation_matrices(world.orientation[number][None])[0])
    assert low == pytest.approx(top, abs=1e-12)


def test_parts_heavier_than_the_lander_are_refused():
    with pytest.raises(ValueError, match=r"Lander\.mass is 0\.001 kg; allowed is more than the .* kg of its parts"):
        with_parts(mass=0.001)


def test_a_part_that_touches_first_turns_the_lander(bed):
    """The same lander with and without its bar, whose tip comes down first."""
    tip_down = (np.cos(0.5), 0.0, np.sin(0.5), 0.0)
    given = slanted(orientation=tip_down, spin=(0.0, 0.0, 0.0), incidence=0.0, time_limit=1.0)
    spun = []
    for parts in ((), (Part(BAR, SKIN),)):
        outcome = land(bed, with_parts(parts=parts), given)
        assert outcome.status in {"clear", "captured", "left_sideways", "time_limit"}
        spun.append(np.array(outcome.orientation))
    assert abs(spun[0] @ spun[1]) < 1.0 - 1e-4


def test_the_same_landing_gives_the_same_bits_and_a_picture_of_all_parts(bed, tmp_path):
    lander, one = with_parts(), slanted()
    found = [land(bed, lander, one, frame_count=4) for _ in range(2)]
    np.testing.assert_equal(found[0].outputs, found[1].outputs)
    assert found[0].orientation == found[1].orientation
    found[0].save_frames(tmp_path / "landing.h5", bed, lander, one)
    drawn = picture(lander)
    with h5py.File(tmp_path / "landing.h5") as file:
        start, faces = file["vertex_start"][-2:], file["face_start"][-2:]
        assert start[1] - start[0] == len(drawn.vertices)
        assert faces[1] - faces[0] == len(drawn.triangles)
    # Surfaces of the parts, closed and outward: their volume is that of the parts.
    a, b, c = (drawn.vertices[drawn.triangles[:, k]] for k in range(3))
    ball = ConvexHull(picture(with_parts(shape=FOOT, parts=())).vertices).volume
    expected = Box((0.06, 0.05, 0.04)).volume + BAR.volume + ball
    assert np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6.0 == pytest.approx(expected)


def test_a_centre_of_mass_at_the_centroid_lands_as_a_plain_lander(bed):
    """The first rebound, before small differences have grown."""
    plain = with_parts(parts=())
    given = dataclasses.replace(plain, centre_of_mass=np.zeros(3))
    one, other = (land(bed, lander, slanted(time_limit=0.3)) for lander in (plain, given))
    assert one.status == other.status
    np.testing.assert_allclose(other.orientation, one.orientation, atol=1e-9)
    assert other.outputs["energy_lost"] == pytest.approx(one.outputs["energy_lost"], rel=1e-6)


WIDTH = (0.52, 0.56)
SLOPE = math.radians(20.0)


def floor_force(world: World) -> np.ndarray:
    """The sum of all forces of a world's floor on the bodies [N]."""
    contacts = world.contacts()
    on_floor = contacts[contacts["body_b"] < 0]
    return -(on_floor["normal_force"][:, None] * on_floor["normal"] + on_floor["tangential_force"]).sum(axis=0)


def test_a_bed_that_repeats_is_at_rest_without_walls(ground: Bed) -> None:
    assert ground.history["kinetic_ratio"][-1] < settling.KINETIC_RATIO
    assert ground.history["unbalanced_force"][-1] < settling.UNBALANCED_FORCE
    assert (np.abs(ground.position[:, :2]).max(axis=0) <= 0.5 * np.array(WIDTH)).all()
    # Grains lie where a wall would keep their centroids away.
    assert (np.abs(ground.position[:, :2]).max(axis=0) > 0.5 * np.array(WIDTH) - 0.02).all()
    assert 0.4 < ground.solid_fraction < 0.8
    world = ground.world(ROCK, ground.gravity, ContactModel())
    assert len(world.planes) == 1
    contacts = world.contacts()
    between = contacts[contacts["body_b"] >= 0]
    way = world.position[between["body_b"]] - world.position[between["body_a"]]
    assert (np.abs(way[:, :2]) > 0.5 * np.array(WIDTH)).any(axis=0).all()


def test_its_file_keeps_that_it_repeats_and_older_files_have_walls(ground: Bed, tmp_path: Path) -> None:
    ground.save(tmp_path / "bed.h5")
    again = Bed.load(tmp_path / "bed.h5")
    assert (again.sides, again.period) == ("periodic", WIDTH)
    with h5py.File(tmp_path / "bed.h5", "r+") as file:
        del file.attrs["sides"]
        file.attrs["format_version"] = 1
    assert Bed.load(tmp_path / "bed.h5").period is None


def test_no_grain_is_longer_than_the_ground_allows() -> None:
    """One of some thousands would be; it is drawn again, and all others are the same grains."""
    longest, seeds = 1.05, range(120, 160)
    plain = [make_grain(np.random.default_rng(seed), 14, 0.1) for seed in seeds]
    within = [make_grain_within(np.random.default_rng(seed), 14, 0.1, longest) for seed in seeds]
    too_long = [grain.bounding_radius > longest * 0.1 for grain in plain]
    assert 0 < sum(too_long) < 10
    for one, other, is_drawn_again in zip(plain, within, too_long, strict=True):
        assert other.bounding_radius <= longest * 0.1
        assert np.array_equal(one.vertices, other.vertices) != is_drawn_again
    assert longest_reach(14) == 1.25
    assert 1.05 < longest_reach(17) < 1.25


def test_rain_touches_no_image(recipe: Any) -> None:
    generator, period = np.random.default_rng(1), (0.4, 0.45)
    grains = [make_grain(generator, 14, 0.1) for _ in range(30)]
    position, _ = rain(generator, grains, period, period)
    reach = np.array([grain.bounding_radius for grain in grains])
    gap = np.linalg.norm(folded(position[:, None] - position, period_of(period)), axis=2) - reach[:, None] - reach
    assert gap[np.triu_indices(30, 1)].min() > -1e-12


def test_the_surface_is_the_same_wherever_the_ground_is_cut(ground: Bed) -> None:
    here = height_map(ground.grains, ground.position, ground.orientation, WIDTH, WIDTH)
    assert here.mean() == ground.surface_height
    # A shift by whole cells of the map rolls it.
    shift = np.array([3 * WIDTH[0] / here.shape[0], 5 * WIDTH[1] / here.shape[1], 0.0])
    moved = folded(ground.position + shift, period_of(WIDTH))
    there = height_map(ground.grains, moved, ground.orientation, WIDTH, WIDTH)
    assert there == pytest.approx(np.roll(here, (3, 5), axis=(0, 1)), abs=1e-9)


def test_a_landing_is_the_same_wherever_the_ground_is_cut(ground: Bed) -> None:
    """With common steps: see tests/dem/test_world.py."""
    outcomes = []
    for shift in ((0.0, 0.0), (0.21, -0.17)):
        bed = replace(ground, position=folded(ground.position + np.array([*shift, 0.0]), period_of(WIDTH)))
        contact = ContactModel(steps_per_contact=25.0, stepping="global")
        outcomes.append(land(bed, LANDER, landing(place=shift, incidence=1.0, contact=contact)))
    one, other = outcomes
    assert one.status == other.status == "clear"
    for name in OUTPUTS:
        assert one.outputs[name] == pytest.approx(other.outputs[name], rel=1e-4, abs=1e-6)


def test_a_flat_throw_stays_on_the_ground_and_says_how_far_it_came(ground: Bed, bed: Bed) -> None:
    dull = replace(ROCK, restitution=0.05, friction=0.1)
    flat = landing(grain=dull, incidence=1.35, speed=0.8, place=(0.1, 0.0), gravity=(0.0, 0.0, -0.3))
    # How far one comes depends on the grain that it meets first.
    thrown = [land(ground, LANDER, replace(flat, place=(0.1, y)), frame_count=20) for y in (0.0, 0.1)]
    outcome = max((one for one in thrown if one.status == "captured"), key=lambda one: one.outputs["periods_travelled"])
    assert set(outcome.outputs) == {*OUTPUTS, "periods_travelled"}
    path = np.linalg.norm(np.diff(outcome.frames["position"][:, -1, :2], axis=0), axis=1).sum()
    # The path until the last touch is a part of the whole one.
    assert 1.0 < outcome.outputs["periods_travelled"] < 1.05 * path / min(WIDTH)
    assert land(bed, LANDER, flat).status == "left_sideways"
    assert "periods_travelled" not in land(bed, LANDER, landing()).outputs


def test_a_place_beyond_the_tile_is_that_in_it(ground: Bed) -> None:
    """In its first contact, in fine steps: a rounding decides when a step begins."""
    fine = ContactModel(steps_per_contact=200.0)
    one, other, elsewhere = (
        land(ground, LANDER, landing(place=place, time_limit=0.3, contact=fine))
        for place in ((0.1, 0.2), (0.1 + 2 * WIDTH[0], 0.2), (0.2, 0.2))
    )
    assert one.status == other.status
    assert one.outputs["peak_acceleration"] == pytest.approx(other.outputs["peak_acceleration"], rel=1e-3)
    assert one.outputs["peak_acceleration"] != pytest.approx(elsewhere.outputs["peak_acceleration"], rel=1e-3)


@pytest.mark.parametrize("friction", [0.5, 0.2])
def test_a_bed_on_a_slope_is_held_by_its_floor(friction: float, recipe: Any) -> None:
    """Also with less friction than the tangent of the slope, 0.36, as the floor is rough."""
    gravity = (5e-4 * math.sin(SLOPE), 0.0, -5e-4 * math.cos(SLOPE))
    soil = replace(ROCK, friction=friction)
    made: BedRecipe = recipe(sides="periodic", width=(0.5, 0.5), grain_count=32, gravity=gravity, material=soil)
    bed = pour_bed(made)
    assert bed.history["unbalanced_force"][-1] < settling.UNBALANCED_FORCE
    world = bed.world(made.material, gravity, made.contact)
    period = settling.rest_period(made.material, bed.grain_diameter, 5e-4)
    world.drag = 1.0 / period
    assert settling.rests(world, period, 5.0, lambda: settling.unbalanced_force(world) < 1e-2)
    weight = float(world.mass.sum()) * np.array(gravity)
    assert floor_force(world) == pytest.approx(-weight, abs=0.02 * float(np.linalg.norm(weight)))


def test_only_the_floor_of_ground_on_a_slope_is_rough() -> None:
    def floor(sides: str, slope: float) -> Material:
        gravity = (1e-4 * math.sin(slope), 0.0, -1e-4 * math.cos(slope))
        nothing = [], np.zeros((0, 3)), np.zeros((0, 4))
        return boxed_world(*nothing, WIDTH, ROCK, gravity, ContactModel(), sides).planes[0].material

    assert floor("periodic", 0.0) == floor("walls", SLOPE) == ROCK
    assert floor("periodic", SLOPE) == replace(ROCK, friction=2.0 * math.tan(SLOPE), rough=True)
    assert floor("periodic", 0.1) == replace(ROCK, rough=True)


def test_sides_that_are_none_are_refused(recipe: Any) -> None:
    with pytest.raises(ValueError, match=r"BedRecipe.sides is 'open'; allowed is \"walls\" or \"periodic\""):
        recipe(sides="open")


def test_a_tile_in_which_the_lander_would_meet_itself_is_refused(ground: Bed) -> None:
    long = Lander(shape=Box((0.25, 0.06, 0.05)), mass=0.6, material=ROCK)
    with pytest.raises(ValueError, match=r"World\.period is"):
        land(ground, long, landing())
