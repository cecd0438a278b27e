"""Restitution that falls with speed: pairs against closed forms over four decades, and the energy of many bodies."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from lithobrake.dem import Box, ConvexHull, Material, Sphere, World
from lithobrake.dem.law.restitution import YIELD_PRESSURE, pair_law
from lithobrake.dem.law.yielding import dent_at
from lithobrake.smallbody.built_in_bodies import top_shape

ELASTIC = Material(density=2500.0, young_modulus=5e8, poisson_ratio=0.25, restitution=1.0, friction=0.0)
YIELDING = replace(ELASTIC, yield_strength=1e6)
VISCOUS = replace(ELASTIC, restitution=0.8, restitution_speed=0.02)
SPEEDS = np.logspace(-4.0, 0.0, 9)
# With a corner below the centre of mass.
ON_CORNER = tuple(Rotation.align_vectors([[0.0, 0.0, -1.0]], [[1.0, 1.0, 1.0]])[0].as_quat(scalar_first=True))


def rebound(shape: Sphere | Box, material: Material, speed: float, partner: str, steps: float = 200.0) -> float:
    """The speed of parting over that of meeting: of a body and a plane, or of two alike; a box on its corner."""
    world = World()
    turn = ON_CORNER if isinstance(shape, Box) else (1.0, 0.0, 0.0, 0.0)
    reach = 0.5 * math.hypot(*shape.lengths) if isinstance(shape, Box) else shape.radius
    body = world.add_body(shape, material, (0.0, 0.0, reach * (1.0 + 1e-9)), (0.0, 0.0, -speed), turn)
    if partner == "plane":
        world.add_plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), material)
    else:
        below = (1.0, 0.0, 0.0, 0.0)
        world.add_body(Sphere(0.05), material, (0.0, 0.0, -0.05), (0.0, 0.0, 0.0), below)
    # A corner is rounded, so the body meets what is below it a little later.
    world.run_locally(0.01 / speed, steps)
    while len(world.contacts()):
        world.run_locally(world.shortest_contact(speed), steps)
    relative = world.velocity[body, 2] - (world.velocity[1, 2] if partner != "plane" else 0.0)
    return float(relative / speed)


def yield_speed(world_mass: float, radius: float, material: Material) -> float:
    """The speed [m/s] at which a contact begins to yield: Hertz energy at the overlap with that pressure."""
    modulus = pair_law(material, material).young_modulus
    begins = radius * (0.5 * math.pi * YIELD_PRESSURE * material.yield_strength / modulus) ** 2
    energy = 0.4 * 4.0 / 3.0 * modulus * radius**0.5 * begins**2.5
    return math.sqrt(2.0 * energy / world_mass)


def elastic_plastic(ratio: float) -> float:
    """Restitution by the yield speed over the speed [Thornton-1998]."""
    if ratio >= 1.0:
        return 1.0
    square = ratio * ratio
    tail = (ratio / (ratio + 2.0 * math.sqrt(1.2 - 0.2 * square))) ** 0.25
    return math.sqrt(1.2 * math.sqrt(3.0) * (1.0 - square / 6.0)) * tail


def viscoelastic(root: float) -> float:
    """Restitution by the root of 3/2 A (K / m)^(2/5) v^(1/5), as a Pade approximant [Mueller-2011]."""
    above = 1.0 + 0.501086 * root
    return above / (above + 1.15345 * root**2 + 0.577977 * root**3 + 0.532178 * root**4)


CASES = [("sphere", "plane"), ("sphere", "sphere"), ("corner", "plane"), ("corner", "sphere")]


def pair_of(shape: str, partner: str, material: Material) -> tuple[Sphere | Box, float, float]:
    """A shape, and the mass [kg] and radius [m] that its contact has."""
    body: Sphere | Box = Sphere(0.05) if shape == "sphere" else Box((0.08, 0.08, 0.08))
    mass, curvature = body.volume * material.density, 1.0 / body.contact_radius
    if partner == "plane":
        return body, mass, 1.0 / curvature
    other = Sphere(0.05)
    return body, 1.0 / (1.0 / mass + 1.0 / (other.volume * material.density)), 1.0 / (curvature + 1.0 / 0.05)


@pytest.mark.parametrize(("shape", "partner"), CASES)
def test_a_contact_that_yields_rebounds_as_the_closed_form_says(shape: str, partner: str) -> None:
    body, mass, radius = pair_of(shape, partner, YIELDING)
    limit = yield_speed(mass, radius, YIELDING)
    assert SPEEDS[0] < limit < SPEEDS[-1]
    for speed in SPEEDS.tolist():
        assert rebound(body, YIELDING, speed, partner) == pytest.approx(elastic_plastic(limit / speed), rel=0.01)


@pytest.mark.parametrize(("shape", "partner"), CASES)
def test_a_viscoelastic_contact_rebounds_as_the_closed_form_says(shape: str, partner: str) -> None:
    from scipy.optimize import brentq

    body, _, _ = pair_of(shape, partner, VISCOUS)
    at_reference = brentq(lambda root: viscoelastic(root) - 0.8, 0.0, 1.0)
    for speed in SPEEDS.tolist():
        expected = viscoelastic(float(at_reference) * (speed / 0.02) ** 0.1)
        assert rebound(body, VISCOUS, speed, partner) == pytest.approx(expected, rel=0.01)


def test_plastic_contacts_fall_as_the_fourth_root_in_the_end() -> None:
    slow, fast = (elastic_plastic(ratio) for ratio in (1e-2, 1e-4))
    assert math.log(fast / slow) / math.log(1e2) == pytest.approx(-0.25, abs=0.002)
    soft = replace(YIELDING, yield_strength=1e5)
    ball = Sphere(0.05)
    found = [rebound(ball, soft, speed, "plane") for speed in (0.01, 1.0)]
    assert math.log(found[1] / found[0]) / math.log(100.0) == pytest.approx(-0.25, abs=0.01)


def test_a_dent_is_continuous_where_it_begins_and_takes_ever_more() -> None:
    law = pair_law(YIELDING, YIELDING)
    begins = 0.05 * (0.5 * math.pi * law.yield_pressure / law.young_modulus) ** 2
    before, after = (dent_at(begins * (1.0 + step), 0.05, law) for step in (-1e-9, 1e-9))
    assert after.force == pytest.approx(before.force, rel=1e-8)
    assert after.spring_back == pytest.approx(before.spring_back, rel=1e-8)
    lost = [dent_at(begins * factor, 0.05, law).lost for factor in (0.5, 1.0, 1.5, 3.0, 100.0)]
    assert lost[:2] == [0.0, 0.0]
    assert all(one < other for one, other in pairwise(lost[1:]))


def test_the_weaker_and_the_slower_material_counts() -> None:
    strong = replace(YIELDING, yield_strength=1e8)
    assert pair_law(strong, YIELDING).yield_pressure == pair_law(YIELDING, YIELDING).yield_pressure
    assert pair_law(ELASTIC, YIELDING).yield_pressure == pair_law(YIELDING, YIELDING).yield_pressure
    assert pair_law(ELASTIC, ELASTIC).yield_pressure == pair_law(ELASTIC, ELASTIC).viscosity == 0.0
    slower = replace(VISCOUS, restitution_speed=0.2)
    assert pair_law(slower, VISCOUS).viscosity == pair_law(slower, slower).viscosity
    # What loses nothing at the speed of its restitution loses nothing at any.
    assert pair_law(replace(ELASTIC, restitution_speed=0.1), ELASTIC).viscosity == 0.0


def test_collisions_of_all_sizes_are_alike() -> None:
    """At one speed the yield of a contact, unlike its viscosity, does not know its size: every bit scales."""
    found = [rebound(Sphere(radius), YIELDING, 0.125, "plane") for radius in (0.0625, 0.125, 1.0)]
    assert found[1] == pytest.approx(found[0], abs=1e-9)
    assert found[2] == pytest.approx(found[0], abs=1e-9)


@pytest.mark.parametrize("common", [False, True])
@pytest.mark.parametrize(
    "material",
    [
        replace(YIELDING, young_modulus=1e6, yield_strength=1e4, friction=0.5, restitution=0.7, surface_energy=0.01),
        replace(VISCOUS, young_modulus=1e6, friction=0.5),
    ],
    ids=["yielding", "viscous"],
)
def test_energy_is_never_created(material: Material, common: bool) -> None:
    """Blocks that tumble into a heap: the ledger closes, and what moves and is stored only ever falls."""
    random, world = np.random.default_rng(4), World((0.0, 0.0, -0.01))
    world.add_plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), material)
    for height in range(6):
        place = 0.02 * random.normal(size=3) + np.array([0.0, 0.0, 0.2 + 0.32 * height])
        turn, spin = random.normal(size=4), 0.3 * random.normal(size=3)
        world.add_body(Box((0.1, 0.12, 0.15)), material, tuple(place), (0.0, 0.0, -0.05), tuple(turn), tuple(spin))
    if common:
        world.time_step = world.shortest_contact(0.2) / 100.0
    energies = []
    for _ in range(50 if common else 120):
        if common:
            world.run(duration=0.5)
        else:
            world.run_locally(0.5, 100.0)
        energies.append(world.energy())
    kept = np.array([sum(one[name] for name in ("kinetic", "potential", "elastic", "cohesive")) for one in energies])
    total = np.array([one["total"] for one in energies])
    spent = kept[0] - kept[-1]
    assert spent > 0.1 * kept[0]
    assert (np.diff(kept) < 1e-4 * spent).all()
    assert np.abs(total - total[0]).max() < 0.01 * spent


def test_a_dent_as_deep_as_the_body_is_refused() -> None:
    soft = replace(YIELDING, young_modulus=1e6, yield_strength=300.0)
    world = World((0.0, 0.0, -0.01))
    world.add_plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), soft)
    world.add_body(Sphere(0.05), soft, (0.0, 0.0, 0.06), (0.0, 0.0, -0.5))
    with pytest.raises(FloatingPointError, match=r"yielded by 0\.0\d+ m .* raise yield_strength"):
        world.run_locally(10.0, 50.0)


def test_what_has_yielded_comes_to_rest_and_carries_its_weight() -> None:
    material = replace(YIELDING, young_modulus=1e6, yield_strength=500.0, restitution=0.5, friction=0.5)
    world = World((0.0, 0.0, -0.01))
    world.add_plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), material)
    ball = world.add_body(Sphere(0.05), material, (0.0, 0.0, 0.06), (0.0, 0.0, -0.1))
    world.run_locally(60.0, 50.0)
    assert abs(world.velocity[ball, 2]) < 1e-6
    assert world.contacts()["normal_force"].sum() == pytest.approx(0.01 * world.bodies[ball].mass, rel=1e-3)


def wall(kind: str, material: Material) -> World:
    """A world with a wall whose top is the origin: a plane, or a body too heavy to move."""
    world, heavy = World(), 1e9
    if kind == "plane":
        world.add_plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), material)
        return world
    if kind == "body":
        # A ball of facets, which the ball meets in the middle of one of them.
        points = top_shape((1.6, 1.6, 1.2), 0.05, name="wall").vertices
        hull = ConvexHull(points)
        corners = hull.vertices[hull.triangles]
        outward = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        facet = int(np.argmax(outward[:, 2] / np.linalg.norm(outward, axis=1)))
        normal = outward[facet] / np.linalg.norm(outward[facet])
        turn, _ = Rotation.align_vectors([[0.0, 0.0, 1.0]], [normal])
        place = -turn.apply(corners[facet].mean(axis=0) - hull.centroid)
        world.add_body(hull, material, tuple(place), orientation=tuple(turn.as_quat(scalar_first=True)), mass=heavy)
        return world
    block = Box((1.0, 1.0, 1.0))
    turn, depth = {
        "edge": (Rotation.from_rotvec([0.25 * math.pi, 0.0, 0.0]), 0.5 * 2.0**0.5),
        "corner": (Rotation.from_quat(ON_CORNER, scalar_first=True), 0.5 * 3.0**0.5),
    }.get(kind, (Rotation.identity(), 0.5))
    shape = ConvexHull(block.vertices) if kind == "face" else block
    orientation = tuple(turn.as_quat(scalar_first=True))
    world.add_body(shape, material, (0.0, 0.0, -depth), orientation=orientation, mass=heavy)
    return world


@pytest.mark.parametrize("kind", ["plane", "box", "face", "edge", "corner", "body"])
def test_a_ball_rebounds_alike_from_all_walls(kind: str) -> None:
    """A wall in pieces must not count twice: 0.5 of 0.610557 m/s, whatever the wall is made of."""
    material = replace(ELASTIC, young_modulus=1e8, restitution=0.5, friction=0.3)
    world, speed = wall(kind, material), 0.610557
    ball = world.add_body(Sphere(0.05), material, (0.0, 0.0, 0.051), (0.0, 0.0, -speed))
    world.run_locally(0.0005 / speed, 400.0)
    while world.position[ball, 2] < 0.052 and world.time < 1.0:
        world.run_locally(0.0005, 400.0)
    assert np.linalg.norm(world.velocity[ball]) / speed == pytest.approx(0.5, abs=1e-3)
    assert world.velocity[ball, 2] / speed == pytest.approx(0.5, abs=1e-3)
