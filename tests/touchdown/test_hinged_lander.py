"""Landers with parts on hinges: their masses, their motion as one, and the rigid lander that stiff hinges make."""

import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from lithobrake.dem import Box, ConvexHull, Material, Part, World, rotation_matrices
from lithobrake.touchdown import Bed, ContactModel, Hinge, HingedPart, Lander, beam_link, hinge_stiffness, land
from lithobrake.touchdown.lander_bodies import LanderBodies, add_lander
from lithobrake.touchdown.outcome_judge import RestWatch, rest_time

from .landings import ROCK, landing

SKIN = Material(young_modulus=1e6, poisson_ratio=0.25, restitution=0.6, friction=0.4, density=1000.0)
TURN = np.array([0.8, 0.3, -0.4, 0.2]) / np.linalg.norm([0.8, 0.3, -0.4, 0.2])


def part(length: float, mass: float, side: float, hinge: Hinge | None, skin: Material = SKIN) -> Part:
    """A bar along x beside a box of 0.3 m."""
    centre = np.array([side * (0.15 + 0.5 * length), 0.02, 0.03])
    shape = ConvexHull(Box((length, 0.03, 0.02)).vertices + centre)
    material = replace(skin, density=mass / shape.volume)
    return Part(shape, material) if hinge is None else HingedPart(shape, material, hinge=hinge)


def lander(stiffness: float | None, material: Material = SKIN, **changes: Any) -> Lander:
    """A box with two bars, fixed (None) or on hinges."""
    parts = []
    for side in (-1.0, 1.0):
        hinge = None if stiffness is None else Hinge((0.15 * side, 0.02, 0.03), stiffness, 0.05)
        parts.append(part(0.4 if side > 0.0 else 0.3, 0.2, side, hinge, material))
    given: dict[str, Any] = {"mass": 3.0, "centre_of_mass": np.array([0.01, -0.02, 0.005])} | changes
    return Lander(shape=Box((0.3, 0.2, 0.15)), material=material, parts=tuple(parts), **given)


def test_bodies_on_hinges_have_together_the_mass_and_inertia_of_the_study() -> None:
    whole, hinged = lander(None).body, lander(1.0)
    world = World(time_step=1e-3)
    place, velocity, spin = np.array([1.0, 2.0, 3.0]), np.array([0.1, 0.2, -0.3]), (0.3, -0.2, 0.5)
    number = add_lander(world, hinged, place, velocity, tuple(TURN), spin)
    assert world.mass.sum() == pytest.approx(3.0, rel=1e-14)
    motion = LanderBodies(world, hinged, number).motion()
    np.testing.assert_allclose(motion.position, place, rtol=1e-13)
    np.testing.assert_allclose(motion.velocity, velocity, rtol=1e-13)
    np.testing.assert_allclose(motion.spin, spin, rtol=1e-12)
    rotation = rotation_matrices(TURN[None])[0]
    expected = rotation @ whole.inertia @ rotation.T @ spin
    np.testing.assert_allclose(motion.angular_momentum, expected, rtol=1e-12)
    assert world.kinetic_energy.sum() == pytest.approx(motion.kinetic_energy, rel=1e-12)
    assert LanderBodies(world, hinged, number).lowest(motion) == pytest.approx(
        hinged.lowest(place, rotation), rel=1e-12
    )


def test_an_inertia_that_is_none_without_the_hinged_parts_is_refused() -> None:
    with pytest.raises(
        ValueError,
        match=r"Lander\.inertia is .* kg m2; allowed is .*body from which the 2 parts on hinges can",
    ):
        lander(1.0, inertia=np.diag([0.01, 0.011, 0.012]))


def after_a_blow(stiffness: float | None) -> np.ndarray:
    """Velocity and spin of a lander after an elastic blow of a bar on a smooth floor, as one."""
    smooth = replace(SKIN, restitution=1.0, friction=0.0)
    world = World(time_step=1e-3)
    world.add_plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), smooth)
    body = lander(stiffness, material=smooth)
    turn = np.array([np.cos(0.2), 0.05, np.sin(0.2), 0.0])
    turn /= np.linalg.norm(turn)
    low = body.lowest(np.zeros(3), rotation_matrices(turn[None])[0])
    place, velocity = np.array([0.0, 0.0, 0.001 - low]), np.array([0.02, 0.0, -0.1])
    number = add_lander(world, body, place, velocity, tuple(turn), (0.0, 0.1, 0.0))
    world.watch(number)
    world.run_locally(0.1, 100.0)
    assert world.first_touch is not None
    assert not world.is_touched
    motion = LanderBodies(world, body, number).motion()
    return np.concatenate([motion.velocity, 0.3 * motion.spin])


def test_stiff_hinges_make_the_rigid_lander() -> None:
    """The error falls at least as one over the stiffness.

    The blow is elastic: damping of a contact on a part is that for the mass of the part, however stiff its hinge.
    """
    rigid = after_a_blow(None)
    scale = np.abs(rigid).max()
    error = [float(np.abs(after_a_blow(stiffness) - rigid).max()) / scale for stiffness in (1e3, 1e4, 1e5)]
    assert error[0] < 0.1
    assert error[1] < 0.1 * error[0]
    assert error[2] < 0.1 * error[1]
    # A soft one is another lander.
    assert np.abs(after_a_blow(10.0) - rigid).max() > 0.1 * scale


def test_parts_on_hinges_have_to_rest_too() -> None:
    body, gravity = lander(1.0), 1e-4
    world = World(time_step=1e-3)
    number = add_lander(world, body, np.zeros(3), np.zeros(3), (1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    bodies, patience = LanderBodies(world, body, number), rest_time(body, gravity)
    still, swings = RestWatch(body, gravity), RestWatch(body, gravity)
    ends = []
    for time in np.linspace(0.0, 1.01 * patience, 20):
        ends = [still.is_over(time, bodies.motion(), *bodies.part_motions())]
        turned = [replaced(one, 0.1 * (time > 0.5 * patience)) for one in bodies.part_motions()]
        ends.append(swings.is_over(time, bodies.motion(), *turned))
    assert ends == [True, False]


def replaced(motion: Any, angle: float) -> Any:
    return motion._replace(orientation=np.array([np.cos(0.5 * angle), 0.0, np.sin(0.5 * angle), 0.0]))


# A box of 8 cm with two panels of 8 cm, on ground that repeats after half a metre.
PANELS = tuple(
    HingedPart(
        ConvexHull(Box((0.08, 0.05, 0.006)).vertices + np.array([0.08 * side, 0.0, 0.0])), replace(ROCK, density=500.0),
        hinge=Hinge((0.04 * side, 0.0, 0.0), 0.02, 0.05, limit=0.5),
    )
    for side in (-1.0, 1.0)
)  # fmt: skip
SMALL = Lander(shape=Box((0.08, 0.06, 0.05)), mass=0.6, material=ROCK, parts=PANELS)


def test_a_lander_with_panels_on_hinges_comes_to_rest_and_is_seen_as_one(ground: Bed) -> None:
    one = landing(hop_height=0.5, speed=0.02, time_limit=600.0)
    outcome = land(ground, SMALL, one, frame_count=30)
    assert outcome.status == "captured"
    again = land(ground, SMALL, one)
    assert again.outputs == outcome.outputs
    assert outcome.frames is not None
    # Grains, and the lander as one.
    assert outcome.frames["position"].shape[1:] == (len(ground.grains) + 1, 3)
    assert outcome.frames["orientation"].shape[1:] == (len(ground.grains) + 1, 4)
    assert outcome.frames["force"].shape[1:] == (len(ground.grains) + 1,)
    # At rest the ground carries it, and in flight its joints count for nothing.
    assert outcome.frames["force"][:, -1].min() < 1e-12
    assert outcome.frames["force"][-1, -1] == pytest.approx(0.6 * 5e-4, rel=0.3)
    # Nothing is left of its motion, that of the panels included.
    assert outcome.outputs["energy_lost"] == pytest.approx(0.5 * 0.6 * 0.02**2, rel=0.05)


def test_common_steps_refuse_a_lander_with_hinges(bed: Bed) -> None:
    one = landing(contact=ContactModel(steps_per_contact=25.0, stepping="global"))
    with pytest.raises(ValueError, match=r"ContactModel\.stepping is .?global.?; allowed is .local. for a lander with"):
        land(bed, SMALL, one)


def test_a_frequency_gives_the_stiffness_of_the_hinge_of_a_boom() -> None:
    link = beam_link(1.5, 0.022, 6.7)
    bar = part(link.length, link.mass, 1.0, None)
    # Thin beside its length, a bar has the inertia of a rod.
    assert hinge_stiffness(bar, (0.15, 0.02, 0.03), 6.7) == pytest.approx(link.stiffness, rel=1e-3)


@pytest.mark.parametrize(("values", "said"), [
    ({"stiffness": 0.0}, "Hinge.stiffness is 0.0 N m/rad; allowed is a finite value above 0"),
    ({"damping_ratio": 1.5}, "Hinge.damping_ratio is 1.5; allowed is a value from 0 to 1"),
    ({"limit": 2.0}, "Hinge.limit is 2.0 rad; allowed is a value from 0 to 1.5708"),
    ({"point": (0.0, np.nan, 0.0)}, "Hinge.point is "),
])  # fmt: skip
def test_what_is_no_hinge_is_refused(values: dict[str, Any], said: str) -> None:
    given: dict[str, Any] = {"point": (0.1, 0.0, 0.0), "stiffness": 1.0, "damping_ratio": 0.1} | values
    with pytest.raises(ValueError, match=re.escape(said)):
        Hinge(**given)
