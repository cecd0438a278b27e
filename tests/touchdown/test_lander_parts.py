"""Landings of landers with parts: where they start, what touches, and that one of one hull is as before."""

import dataclasses

import h5py
import numpy as np
import pytest

from lithobrake.dem import Box, ConvexHull, Material, Part, Sphere, rotation_matrices
from lithobrake.touchdown import ContactModel, Lander, Landing, land
from lithobrake.touchdown.landing import picture
from lithobrake.touchdown.simulation import release

SKIN = Material(young_modulus=1e6, poisson_ratio=0.25, restitution=0.6, friction=0.4, density=1000.0)
SLANTED = np.array([0.8, 0.3, -0.4, 0.2]) / np.linalg.norm([0.8, 0.3, -0.4, 0.2])
BAR = ConvexHull(Box((0.12, 0.01, 0.01)).vertices + np.array([0.09, 0.0, 0.0]))
FOOT = Sphere(0.012, (-0.02, 0.01, -0.04))


def with_parts(**changes):
    parts = Part(BAR, SKIN), Part(FOOT, SKIN)
    return Lander(**{"shape": Box((0.06, 0.05, 0.04)), "mass": 0.4, "material": SKIN, "parts": parts, **changes})


def landing(**changes):
    values = {
        "grain": SKIN, "speed": 0.2, "incidence": 0.2, "azimuth": 0.3, "place": (0.0, 0.0),
        "gravity": (0.0, 0.0, -5e-4), "orientation": tuple(SLANTED), "spin": (0.1, 0.0, 0.2),
        "time_limit": 3.0, "contact": ContactModel(),
    }  # fmt: skip
    return Landing(**{**values, **changes})


def test_the_lowest_point_is_that_of_the_part_that_hangs_lowest():
    lander, rotation = with_parts(), rotation_matrices(SLANTED[None])[0]
    points = [shape.vertices for shape in (lander.shape, BAR)]
    ends = [((p - lander.body.centre_of_mass) @ rotation[2]).min() for p in points]
    ends.append((FOOT.centroid - lander.body.centre_of_mass) @ rotation[2] - FOOT.radius)
    assert lander.lowest(np.array([0.0, 0.0, 2.0]), rotation) == pytest.approx(2.0 + min(ends), abs=1e-15)
    assert min(ends) == ends[2]


def test_a_lander_starts_with_its_lowest_point_above_every_grain_in_reach(bed):
    lander, one = with_parts(), landing()
    world = bed.world(one.grain, bed.gravity, one.contact)
    turns = rotation_matrices(world.orientation)[:, 2]
    tops = [(hull.vertices - hull.centroid) @ turn for hull, turn in zip(bed.grains, turns, strict=True)]
    top = max(height + rise.max() for height, rise in zip(world.position[:, 2], tops, strict=True))
    number = release(world, bed, lander, one)
    low = lander.lowest(world.position[number], rotation_matrices(world.orientation[number][None])[0])
    assert low == pytest.approx(top, abs=1e-12)


def test_parts_heavier_than_the_lander_are_refused():
    with pytest.raises(ValueError, match=r"Lander\.mass is 0\.001 kg, and its parts have"):
        with_parts(mass=0.001)


def test_a_part_that_touches_first_turns_the_lander(bed):
    """The same lander with and without its bar, whose tip comes down first."""
    tip_down = (np.cos(0.5), 0.0, np.sin(0.5), 0.0)
    spun = []
    for parts in ((), (Part(BAR, SKIN),)):
        lander = with_parts(parts=parts)
        outcome = land(bed, lander, landing(orientation=tip_down, spin=(0.0, 0.0, 0.0), incidence=0.0))
        assert outcome.status in {"clear", "captured", "left_sideways", "time_limit"}
        spun.append(np.array(outcome.orientation))
    assert abs(spun[0] @ spun[1]) < 1.0 - 1e-4


def test_the_same_landing_gives_the_same_bits_and_a_picture_of_all_parts(bed, tmp_path):
    lander, one = with_parts(), landing()
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
    one, other = (land(bed, lander, landing(time_limit=0.3)) for lander in (plain, given))
    assert one.status == other.status
    np.testing.assert_allclose(other.orientation, one.orientation, atol=1e-9)
    assert other.outputs["energy_lost"] == pytest.approx(one.outputs["energy_lost"], rel=1e-6)
