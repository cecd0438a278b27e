"""Beds that repeat: they rest, they are the same wherever they are cut, and no lander is lost over an edge."""

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

from lithobrake.dem import Box, Material, World, folded, period_of
from lithobrake.geometry.longest_grain import longest_reach
from lithobrake.touchdown import OUTPUTS, Bed, BedRecipe, ContactModel, Lander, land, pour_bed, settling
from lithobrake.touchdown.bed import boxed_world
from lithobrake.touchdown.grains import make_grain, make_grain_within
from lithobrake.touchdown.pouring import rain
from lithobrake.touchdown.surface import height_map

from .landings import LANDER, ROCK, landing

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
    longest, seeds = 1.05, range(200)
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
    way = folded(position[:, None] - position, period_of(period))
    gap = np.linalg.norm(way, axis=2) - reach[:, None] - reach
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
    """With common steps: see tests/dem/test_period.py."""
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
    thrown = [land(ground, LANDER, replace(flat, place=(0.1, y)), frame_count=20) for y in (0.0, 0.1, 0.2, 0.3)]
    captured = [one for one in thrown if one.status == "captured"]
    outcome = max(captured, key=lambda one: one.outputs["periods_travelled"])
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
    made: BedRecipe = recipe(sides="periodic", width=WIDTH, grain_count=48, gravity=gravity, material=soil)
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
    with pytest.raises(ValueError, match="World period is"):
        land(ground, long, landing())
