"""What the judge says of a lander whose centre has gone over the rim of the bed."""

from types import SimpleNamespace

import numpy as np
import pytest

from lithobrake.dem import BodyMotion, Material, Sphere
from lithobrake.touchdown import Lander
from lithobrake.touchdown.outcome_judge import OutcomeJudge

ROCK = Material(young_modulus=1e6, poisson_ratio=0.25, restitution=0.5, friction=0.5, density=2500.0)
LANDER = Lander(shape=Sphere(0.1), mass=1.0, material=ROCK)
BED = SimpleNamespace(width=(1.0, 1.0), period=None, surface_height=0.5, grain_diameter=0.1, boulder_count=0)
LANDING = SimpleNamespace(
    azimuth=0.0, time_limit=10.0, hop_height=None, contact=SimpleNamespace(steps_per_contact=50.0)
)


def world(velocity=(0.1, 0.0, 0.05), touches=False, touched=1.0, x=0.6):
    """A lander low over the grains, at x [m], after a blow."""
    motion = BodyMotion(
        np.array([x, 0.0, 0.62]), np.array(velocity), np.array([1.0, 0.0, 0.0, 0.0]), angular_momentum=np.zeros(3),
        spin=np.array([0.0, 1.0, 0.0]), mass=1.0,
    )  # fmt: skip
    return SimpleNamespace(
        time=1.0, time_step=1e-3, gravity=np.array([0.0, 0.0, -1e-4]), touch_duration=touched,
        first_touch=None if touched is None else 0.5, motion_of=lambda number: motion, is_touched=touches,
        watched={"peak_force": 1.0},
    )  # fmt: skip


def judged(**changes):
    judge = OutcomeJudge(BED, LANDER, LANDING, world(**changes), 0, 0)
    judge.look()
    return judge


def test_a_lander_that_flies_up_over_the_rim_is_clear_and_says_so():
    judge = judged()
    assert judge.ended == "clear"
    outputs = judge.outcome().outputs
    assert outputs["over_rim"] == 1.0
    assert (outputs["velocity_out_x"], outputs["velocity_out_z"]) == (0.1, 0.05)


@pytest.mark.parametrize(
    "changes",
    [
        {"velocity": (0.1, 0.0, -0.05)},
        {"touches": True},
        {"touched": None},
        # Too slow to lift itself by half its size: not known to leave, and never said to stay.
        {"velocity": (1e-3, 0.0, 1e-3)},
    ],
    ids=["goes down", "still touches", "has not touched", "too slow"],
)
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
    judge = OutcomeJudge(bed, LANDER, LANDING, world(x=0.4), 0, 0)
    judge.look()
    assert judge.ended == ended
    assert judge.ground() == (pytest.approx((0.6, 0.6)) if ended is None else pytest.approx((0.3, 0.4)))
