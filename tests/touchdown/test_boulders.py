"""Beds with boulders, beds of spheres, and the smallest bed."""

import math
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lithobrake.dem import Box, ConvexHull, Material, Sphere, World
from lithobrake.geometry.bed_limits import BOULDER_REACH
from lithobrake.touchdown import (
    Bed,
    Boulders,
    ContactModel,
    GrainSizes,
    Lander,
    land,
    pour_bed,
    settling,
    smallest_bed,
    wave_speed,
)
from lithobrake.touchdown.bed import heights_at
from lithobrake.touchdown.grains import SOLID_FRACTION, cut_below, free_places, lowered, place_boulders, surface_among
from lithobrake.touchdown.pouring import rain

from .landings import LANDER, landing

WIDTH = (0.8, 0.8)
SIZES = GrainSizes(distribution="power_law", lower=0.15, upper=0.4, exponent=3.65)


def boulders(coverage: float = 0.2, cover: tuple[float, float] = (0.0, 0.0), sizes: GrainSizes = SIZES) -> Boulders:
    return Boulders(sizes=sizes, coverage=coverage, cover=cover)


def one_size(diameter: float) -> GrainSizes:
    return GrainSizes(distribution="constant", lower=diameter, upper=diameter)


@pytest.fixture(scope="module")
def ground(recipe: Any) -> Bed:
    one = boulders(0.25 * math.pi * (0.34 / 0.8) ** 2, (-0.06, -0.06), one_size(0.34))
    return pour_bed(recipe(sides="periodic", width=WIDTH, grain_count=96, boulders=one))


def test_a_boulder_rests_among_the_grains_as_deep_as_asked(ground: Bed) -> None:
    assert (ground.boulder_count, len(ground.grains)) == (1, 97)
    assert ground.history["kinetic_ratio"][-1] < settling.KINETIC_RATIO
    # It has not turned over, nor has it been lifted.
    assert abs(ground.orientation[0, 0]) > 0.999
    vertices = ground.grains[0].vertices[:, 2] - ground.grains[0].centroid[2]
    assert ground.position[0, 2] + vertices.min() == pytest.approx(0.0, abs=2e-3)
    # The grains are 0.08 m wide; their surface is known before the pour to a part of that.
    x, y = np.meshgrid(*(np.linspace(-0.4, 0.4, 60, endpoint=False),) * 2, indexing="ij")
    beside = ground.boulder_height(x, y) == -math.inf
    grains = heights_at(x, y, ground.grains[1:], ground.position[1:], ground.orientation[1:], ground.period)
    surface = float(np.maximum(grains, 0.0)[beside].mean())
    assert ground.position[0, 2] + vertices.max() - surface == pytest.approx(0.06, abs=0.04)


def test_a_boulder_is_no_grain_to_the_rules_of_rest(ground: Bed) -> None:
    assert ground.grain_diameter == pytest.approx(ground.diameter[1:].mean())
    assert ground.diameter[0] > 2.0 * ground.grain_diameter


def test_a_bed_with_boulders_is_read_as_it_was_written(ground: Bed, tmp_path: Path) -> None:
    ground.save(tmp_path / "bed.h5")
    read = Bed.load(tmp_path / "bed.h5")
    assert read.boulder_count == 1
    assert (read.position == ground.position).all()


def test_the_grains_are_those_of_the_bed_without_boulders(recipe: Any) -> None:
    """Boulders have random numbers of their own."""
    bed = {"sides": "periodic", "width": WIDTH, "grain_count": 12, "seed": 3}
    plain = pour_bed(recipe(**bed))
    among = pour_bed(recipe(**bed, boulders=boulders(0.3, sizes=one_size(0.4))))
    assert among.boulder_count >= 1
    assert (among.diameter[among.boulder_count :] == plain.diameter).all()


def test_the_mean_coverage_over_beds_is_that_asked_for() -> None:
    asked, area = boulders(0.13), 0.9 * 1.1
    counts = [asked.count(area, (k + 0.5) / 1000) for k in range(1000)]
    mean = asked.mean_count(area)
    assert (set(counts), np.mean(counts)) == ({int(mean), int(mean) + 1}, pytest.approx(mean, abs=1e-3))
    square = np.mean(SIZES.draw((np.arange(1000) + 0.5) / 1000) ** 2)
    assert mean * 0.25 * math.pi * square / area == pytest.approx(0.13)


def test_boulders_are_apart_through_the_period() -> None:
    width = (1.2, 1.2)
    places = free_places(np.random.default_rng(2), [0.3, 0.2, 0.1], width, width)
    for k, reach in enumerate((0.3, 0.2, 0.1)):
        for place, other in zip(places[:k], (0.3, 0.2), strict=False):
            way = places[k] - place
            way -= 1.2 * np.rint(way / 1.2)
            assert np.linalg.norm(way) > reach + other
    hulls, place = place_boulders(boulders(0.25, (-1.0, -1.0)), np.random.default_rng(3), 14, 0.1, width, width)
    assert all(hull.bounding_radius < BOULDER_REACH * 0.4 for hull in hulls)
    corners = [hull.vertices + at for hull, at in zip(hulls, place, strict=True)]
    for k, one in enumerate(corners):
        for other in corners[:k]:
            way = one[:, None, :2] - other[None, :, :2]
            way -= 1.2 * np.rint(way / 1.2)
            assert np.linalg.norm(way, axis=2).min() > 0.0


def test_boulders_without_room_are_refused() -> None:
    with pytest.raises(ValueError, match=r"find no room beside each other.*lower bed\.boulders\.coverage"):
        free_places(np.random.default_rng(0), [0.4, 0.4], (1.0, 1.0), (1.0, 1.0))


@pytest.mark.parametrize(
    ("coverage", "cover", "words"),
    [(0.0, (0.0, 0.0), "coverage is 0.0; allowed is 0 < value <= 0.3"), (0.1, (0.2, 0.1), "the smaller first")],
)
def test_a_coverage_or_cover_of_no_bed_is_refused(coverage: float, cover: tuple[float, float], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        boulders(coverage, cover)


def test_what_is_cut_off_at_a_height_has_the_volume_above_it() -> None:
    box = ConvexHull(Box((1.0, 2.0, 4.0)).vertices + np.array([0.0, 0.0, 1.0]))
    cut = cut_below(box, 0.0)
    assert (cut.volume, cut.vertices[:, 2].min()) == (pytest.approx(6.0), 0.0)
    assert cut_below(box, -2.0) is box


def test_a_boulder_goes_where_its_top_is_to_be_and_never_floats() -> None:
    box = Box((1.0, 1.0, 1.0))
    assert lowered(box, 0.4).volume == pytest.approx(0.4)
    assert lowered(box, 0.4).vertices[:, 2].max() == pytest.approx(0.4, abs=1e-5)
    on_the_floor = lowered(box, 3.0)
    assert on_the_floor.vertices[:, 2].min() == pytest.approx(0.0, abs=1e-5)
    assert on_the_floor.volume == pytest.approx(1.0)


def test_grains_fill_what_a_boulder_leaves() -> None:
    """A cube of 1 m on 4 m2, half of it in the grains: 4 h = V / 0.6 + h, with its top 1 - h above the surface."""
    volume = SOLID_FRACTION * 1.5
    assert surface_among([Box((1.0, 1.0, 1.0))], np.array([-0.5]), volume, 4.0) == pytest.approx(0.5, abs=1e-5)
    # The same height without it takes more grains.
    assert surface_among([], np.zeros(0), SOLID_FRACTION * 2.0, 4.0) == pytest.approx(0.5)


def test_rain_stays_clear_of_boulders(ground: Bed) -> None:
    grains = ground.grains[1:40]
    position, turned = rain(np.random.default_rng(1), grains, WIDTH, WIDTH, ground.grains[:1],
        ground.position[:1])  # fmt: skip
    assert (turned[0] == (1.0, 0.0, 0.0, 0.0)).all()
    way = position[1:] - position[0]
    way[:, :2] -= 0.8 * np.rint(way[:, :2] / 0.8)
    reach = np.array([grain.bounding_radius for grain in grains]) + ground.grains[0].bounding_radius
    assert (np.linalg.norm(way, axis=1) > reach - 1e-12).all()


VALIDATION = Path(__file__).parents[2] / "validation"


def test_spheres_rest_on_ground_that_repeats_and_are_landed_on(
    recipe: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "path", [str(VALIDATION), *sys.path])
    from sphere_beds import SphereBed, pour_spheres

    asked = recipe(sides="periodic", width=(0.5, 0.5), grain_count=32,
        sizes=GrainSizes(distribution="constant", lower=0.1, upper=0.1))  # fmt: skip
    rock = replace(asked.material, rolling_friction=0.1)
    poured = pour_spheres(replace(asked, material=rock))
    assert poured.history["unbalanced_force"][-1] < settling.UNBALANCED_FORCE
    poured.save(tmp_path / "bed.h5")
    bed = SphereBed.of(Bed.load(tmp_path / "bed.h5"))
    world = bed.world(rock, asked.gravity, ContactModel())
    assert {type(body.shape) for body in world.bodies} == {Sphere}
    np.testing.assert_allclose([body.shape.bounding_radius for body in world.bodies], 0.05)
    assert land(bed, LANDER, landing(grain=rock, time_limit=5.0)).outputs["peak_acceleration"] > 0.0


def rock(young_modulus=1e7):
    return Material(young_modulus=young_modulus, poisson_ratio=0.25, restitution=1.0, friction=0.0, density=2500.0)


def test_wave_runs_through_a_chain_at_its_speed():
    """Nesterenko (1983): the wave in a chain of touching spheres, struck by one of them."""
    diameter, speed, count = 0.1, 0.1, 60
    world = World((0.0, 0.0, 0.0))
    for k in range(count):
        world.add_body(Sphere(0.05), rock(), (diameter * k, 0, 0), velocity=(speed if k == 0 else 0.0, 0, 0))
    times = []
    for probe in (20, 50):
        while world.velocity[probe, 0] < 0.25 * speed:
            world.run(steps=1)
        times.append(world.time)
    measured = 30 * diameter / (times[1] - times[0])
    # What runs on is a solitary wave about five grains long whose peak is 0.68 of the striker's speed.
    assert wave_speed(rock(), diameter, 0.68 * speed) == pytest.approx(measured, rel=0.05)


def test_rule_does_not_depend_on_speed_or_stiffness():
    """Wave speed goes with v^(1/5) E^(2/5), contact time with their inverse."""
    lander = Lander(shape=Sphere(0.1), mass=2.0, inertia=None, material=rock())
    width, depth = smallest_bed(lander, rock(), 0.05, 0.1)
    assert smallest_bed(lander, rock(1e6), 0.05, 0.4) == pytest.approx((width, depth), rel=1e-9)
    assert width == pytest.approx(0.2 + 2.0 * depth, rel=1e-12)
    assert 0.05 < depth < 0.2


def test_rule_grows_with_the_mass_of_the_lander():
    depths = [
        smallest_bed(Lander(shape=Sphere(0.1), mass=mass, inertia=None, material=rock()), rock(), 0.05, 0.1)[1]
        for mass in (0.1, 1.0, 10.0)
    ]
    assert depths == sorted(depths)
    assert math.isfinite(depths[-1])
