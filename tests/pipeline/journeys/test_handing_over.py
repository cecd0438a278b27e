"""Velocity, spin and attitude as they pass from a flight into a touchdown and back: nothing jumps."""

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from lithobrake.geometry.attitude import attitude_of, from_frame, spin_of
from lithobrake.pipeline.design.arrivals import attitude_inputs, impact_inputs, rotation_inputs
from lithobrake.smallbody import Body, built_in_body
from lithobrake.smallbody.bounce import impact_frame
from lithobrake.smallbody.built_in_bodies import top_shape
from lithobrake.smallbody.landers import Landers, follow
from lithobrake.smallbody.rotation import ground_spin
from lithobrake.smallbody.touchdown import Answers, ImpactStates, into_frame, out_of_frame
from lithobrake.touchdown.landing import outgoing
from lithobrake.vocabulary.outcomes import TouchdownOutcome
from lithobrake.vocabulary.quantities import (
    IMPACT_INCIDENCE,
    IMPACT_SPEED,
    ORIENTATION,
    ROTATION,
    SPIN,
    VELOCITY_OUT,
)

COUNT = 20


# Size, mass and spin of Bennu.
BENNU = Body(top_shape((565.0, 535.0, 508.0), 8.0, name="bennu"), 7.329e10, 15_466.0, "bennu")


@pytest.fixture(params=["dimorphos", "didymos", "bennu"])
def body(request: pytest.FixtureRequest) -> Body:
    return BENNU if request.param == "bennu" else built_in_body(request.param)


def test_a_state_passes_through_the_frame_of_a_touchdown_to_rounding(body: Body) -> None:
    """What a flight brings is what the bed gets, and what leaves the bed is what flies on, at any azimuth of the bed.

    A touchdown that changes nothing gives back the arriving velocity, spin and attitude.
    """
    random = np.random.default_rng(7)
    for _ in range(COUNT):
        facet = int(random.integers(len(body.shape.normals)))
        up = body.shape.normals[facet]
        velocity = 0.05 * random.normal(size=3)
        velocity -= 2.0 * max(0.0, float(velocity @ up)) * up
        spin, attitude = 0.02 * random.normal(size=3), Rotation.random(random_state=random)
        axes = impact_frame(velocity[None], up[None])[0]
        speed = float(np.linalg.norm(velocity))
        azimuth_deg = float(random.uniform(0.0, 360.0))
        row = impact_inputs(speed, math.acos(-float(velocity @ up) / speed))
        row |= attitude_inputs(axes, azimuth_deg, attitude, spin)
        azimuth, incidence = math.radians(azimuth_deg), math.radians(row[IMPACT_INCIDENCE])
        across = row[IMPACT_SPEED] * math.sin(incidence)
        on_bed = np.array(
            [across * math.cos(azimuth), across * math.sin(azimuth), -row[IMPACT_SPEED] * math.cos(incidence)]
        )
        orientation = np.array([row[name] for name in ORIENTATION])
        outputs = outgoing(on_bed, np.array([row[name] for name in SPIN]), orientation, azimuth, over_rim=False)
        left = out_of_frame(axes[None], np.array([[outputs[name] for name in VELOCITY_OUT]]))[0]
        assert np.abs(left - velocity).max() < 1e-14 * max(1.0, speed)
        assert np.abs(out_of_frame(axes[None], spin_of(outputs)[None])[0] - spin).max() < 1e-15
        assert ((from_frame(axes) * attitude_of(outputs)).inv() * attitude).magnitude() < 1e-7
        # The bed turns as the body does.
        turn = ground_spin(body.rotation, np.zeros(1), np.array([body.spin_period]))
        local = into_frame(axes[None], turn)[0]
        turned = rotation_inputs(local.tolist(), azimuth_deg)
        back = Rotation.from_rotvec([0.0, 0.0, -azimuth]).apply([turned[name] for name in ROTATION])
        assert np.abs(out_of_frame(axes[None], back[None])[0] - turn[0]).max() < 1e-18


class Mirror:
    """Touchdowns that throw a lander up again as it came, and note what they were told."""

    def __init__(self) -> None:
        self.met: list[ImpactStates] = []
        self.left: list[Answers] = []

    def answers(self, impacts: ImpactStates) -> Answers:
        found = Answers.unknown(len(impacts))
        found.outcome[:] = TouchdownOutcome.CLEAR
        angle = np.radians(impacts.incidence_deg)
        found.velocity[:, 0], found.velocity[:, 2] = impacts.speed * np.sin(angle), impacts.speed * np.cos(angle)
        found.spin[:] = impacts.local_spin
        self.met.append(impacts)
        self.left.append(found)
        return found


def test_a_flight_begins_with_what_a_touchdown_left_and_keeps_its_spin_among_the_stars(body: Body) -> None:
    random = np.random.default_rng(8)
    facets = random.integers(len(body.shape.normals), size=COUNT)
    up = body.shape.normals[facets]
    position = body.shape.vertices[body.shape.faces[facets]].mean(axis=1)
    across = np.cross(up, random.normal(size=(COUNT, 3)))
    across *= 0.004 / np.linalg.norm(across, axis=1, keepdims=True)
    velocity = across - 0.006 * up
    start, period = np.zeros(COUNT), np.full(COUNT, body.spin_period)
    angle = np.full(COUNT, math.degrees(math.atan2(0.004, 0.006)))
    spin = 0.01 * random.normal(size=(COUNT, 3))
    landers = Landers(
        body=body, duration=4.0 * 3600.0, gravity="exact", most=2, threads=1, start=start,
        mass=np.full(COUNT, body.mass), spin_period=period, position=position, axes=impact_frame(velocity, up),
        speed=np.linalg.norm(velocity, axis=1), incidence_deg=angle.copy(), mean_incidence_deg=angle.copy(),
        spin=spin.copy(),
    )  # fmt: skip
    mirror = Mirror()
    follow(landers, mirror)
    first, later = mirror.met[0], mirror.met[1]
    assert np.abs(out_of_frame(first.axes, mirror.left[0].velocity) - (velocity + 0.012 * up)).max() < 1e-16
    # A lander without an attitude of its own is a ball: its spin against the stars stays, and the ground turns on.
    assert len(later) >= 3
    for place, lander in enumerate(later.lander.tolist()):
        clock = np.array([later.clock[place]])
        own = spin[lander] + ground_spin(body.rotation, start[:1], period[:1])[0]
        found = later.spin[place] + ground_spin(body.rotation, clock, period[:1])[0]
        angle_turned = 2.0 * math.pi / body.spin_period * float(clock[0])
        back = Rotation.from_rotvec([0.0, 0.0, -angle_turned]).apply(own)
        assert np.abs(found - back).max() < 1e-14
