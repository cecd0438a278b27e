"""Which slopes does a rigid footpad hold on ice grains under Enceladus' gravity, at 1 m/s, sintered or not?

    python validation/low_speed/footpad_on_ice.py --work FOLDER --out FOLDER [--names NAME ...]

Speed, gravity and the three pads are those of [Harmon-2023], whose grains are level sets of ice that bond where they
touch; ours are spheres that pull on each other. Mass, sizes, pulls and what counts as held are ours. Rows that stand in
footpad_on_ice.csv are not run again.
"""

import itertools
import math
import sys
import time
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from lithobrake.dem import ConvexHull, Material, World

sys.path.extend([str(Path(__file__).parents[1] / "experiments"), str(Path(__file__).parents[2] / "benchmarks")])
from plate_into_loose_grains import Soil, kept
from result_rows import Row, note, options_of, read_rows
from sphere_bed import Floats, add_beads

HERE = Path(__file__).parent
NAME = "footpad_on_ice.csv"
GRAVITY, SPEED = 0.113, 1.0  # m/s2, m/s: Enceladus, and the source
PAD, THICK, MASS = 0.3, 0.06, 25.0  # m, m, kg, of a pad and what it carries
CORNERS = 24
GRAIN, WIDTH, DEPTH = 0.06, 0.75, 0.36  # m
PULLS = {"none": 0.0, "some": 1000.0, "much": 5000.0}  # Pa: of a contact over the square of the mean diameter
SETTLED, DRAG = 0.5, 3.0  # s, 1/s, before the pad comes
LOOK, LONGEST = 0.02, 3.0  # s
FLOWN = 0.02  # m above where it began
CALM_SPEED, CALM_LOOKS = 0.01, 5  # m/s, looks
# Grains that fill less of the space lie apart at first; of another restitution they lose more.
LOOSE, RESTITUTION, DAMPED = 0.5, 0.5, 0.2
STEPS = {RESTITUTION: 60.0, DAMPED: 100.0}  # in the shortest contact
HELD_SLIP, HELD_SPEED = 0.5 * PAD, 0.02  # m, m/s: more of either, and the slope does not hold the pad
BORNE = 0.5 * PAD  # m deep at most, and the ground bears the pad


class Trial(NamedTuple):
    """What a run follows from."""

    pad: str
    slope_deg: float
    sintering: str
    seed: int
    filled: float = 0.58
    restitution: float = RESTITUTION

    @property
    def name(self) -> str:
        loose = ", loose" if self.filled == LOOSE else ""
        damped = ", damped" if self.restitution == DAMPED else ""
        return f"{self.pad}, {self.slope_deg:g} deg, {self.sintering}, {self.seed}{loose}{damped}"


def ring(radius: float, height: float) -> Floats:
    turn = np.linspace(0.0, 2.0 * np.pi, CORNERS, endpoint=False)
    return np.column_stack([radius * np.cos(turn), radius * np.sin(turn), np.full(CORNERS, height)])


def pad_of(name: str) -> ConvexHull:
    """Return a pad of one diameter, its lowest point at 0: a disc, a cone of 45 degrees or a hemisphere."""
    reach = 0.5 * PAD
    if name == "disk":
        return ConvexHull(np.concatenate([ring(reach, 0.0), ring(reach, THICK)]))
    if name == "cone":
        return ConvexHull(np.concatenate([np.zeros((1, 3)), ring(reach, reach)]))
    dips = np.radians([0.0, 30.0, 60.0])
    rings = [ring(reach * math.cos(dip), reach * (1.0 - math.sin(dip))) for dip in dips]
    return ConvexHull(np.concatenate([np.zeros((1, 3)), *rings]))


PADS = ("hemisphere", "cone", "disk")
TRIALS = (
    *(Trial(pad, 0.0, sintering, 1) for sintering in PULLS for pad in PADS),
    *(Trial(pad, slope, sintering, 1) for slope, sintering, pad in
      itertools.product((15.0, 20.0), ("some", "much"), PADS)),
    *(Trial(pad, slope, sintering, 1, LOOSE) for slope, sintering, pad in
      ((0.0, "none", "hemisphere"), (0.0, "none", "disk"), *itertools.product((0.0, 15.0, 20.0), ("some",), PADS))),
    *(Trial(pad, 15.0, "some", 1, LOOSE, DAMPED) for pad in PADS[::2]),
)  # fmt: skip
NAMES = {trial.name: trial for trial in TRIALS}


def soil(trial: Trial) -> Soil:
    return Soil(
        filled=trial.filled, grain=GRAIN, width=WIDTH, depth=DEPTH, friction=0.6, rolling_friction=0.1,
        cohesion=PULLS[trial.sintering], density=920.0, young_modulus=1e6, speed=SPEED, seed=trial.seed,
    )  # fmt: skip


def ice(trial: Trial) -> Material:
    return replace(soil(trial).material, restitution=trial.restitution)


def settled(trial: Trial, work: Path) -> World:
    """Return a bed on a slope: x runs down it, z is its normal."""
    ground = soil(trial)
    place, radius = kept(ground, work)
    slope = math.radians(trial.slope_deg)
    world = World((GRAVITY * math.sin(slope), 0.0, -GRAVITY * math.cos(slope)), None, period=(WIDTH, WIDTH))
    add_beads(world, radius, ice(trial), place)
    world.add_plane((0, 0, -DEPTH), (0, 0, 1), ice(trial))
    world.drag = DRAG
    world.time_step = world.shortest_contact(SPEED) / STEPS[trial.restitution]
    world.run(duration=SETTLED)
    world.drag = 0.0
    return world


def top_under(world: World) -> float:
    """Return the height [m] of the highest grain below the pad."""
    near = np.hypot(world.position[:, 0], world.position[:, 1]) < 0.5 * PAD
    return float(world.position[near, 2].max()) + 0.6 * GRAIN


def landed(trial: Trial, work: Path) -> tuple[Row, Floats]:
    """Let a pad come down along gravity; return the row and the path: time [s], place [m, 3] and velocity [m/s, 3].

    Places count from where its lowest point meets the level of the highest grain below it. The pad hardly turns: the
    lander is on it.
    """
    start, slope = time.process_time(), math.radians(trial.slope_deg)
    world = settled(trial, work)
    stuff, shape = replace(ice(trial), cohesion_force=0.0), pad_of(trial.pad)
    begin = (0.0, 0.0, top_under(world) + 0.5 * PAD)
    body = world.add_body(
        shape, stuff, begin, (SPEED * math.sin(slope), 0.0, -SPEED * math.cos(slope)), mass=MASS,
        centre_of_mass=(0.0, 0.0, 0.5 * PAD), inertia=1e3 * MASS * np.eye(3),
    )  # fmt: skip
    path = [np.array([0.0, 0.0, 0.0, 0.0, *world.velocity[body]])]
    while not ended(np.array(path)):
        world.run(duration=LOOK)
        path.append(np.array([world.time - SETTLED, *(world.position[body] - begin), *world.velocity[body]]))
    way = np.array(path)
    return {"grains": body, **read_off(way), "cpu_s": time.process_time() - start}, way


def ended(way: Floats) -> bool:
    """Whether a pad has flown off, reached the floor, stood still for some looks, or taken its longest."""
    flown = way[-1, 3] > FLOWN and way[-1, 6] > 0.0
    still = len(way) > CALM_LOOKS and bool((np.linalg.norm(way[-CALM_LOOKS:, 4:7], axis=1) < CALM_SPEED).all())
    return flown or still or way[-1, 3] < 0.1 * GRAIN - DEPTH or way[-1, 0] > LONGEST


def read_off(way: Floats) -> Row:
    """Return depth and way along the slope [m], and the speeds [m/s] upwards after the deepest place and at last."""
    deepest = int(np.argmin(way[:, 3]))
    return {
        "deepest": -float(way[:, 3].min()), "slip": float(np.hypot(way[-1, 1], way[-1, 2])),
        "rebound_speed": max(float(way[deepest:, 6].max()), 0.0),
        "last_speed": float(np.linalg.norm(way[-1, 4:7])), "followed": float(way[-1, 0]),
    }  # fmt: skip


def main() -> None:
    given = options_of(__doc__, HERE, names=tuple(NAMES))
    ran = {row["name"] for row in read_rows(given.out / NAME)}
    for name in given.names:
        if name not in ran:
            row, way = landed(NAMES[name], given.work)
            np.savetxt(given.work / f"footpad_{name.replace(' ', '_').replace(',', '')}.txt", way)
            note(given.out / NAME, {"name": name, **NAMES[name]._asdict(), **row})


if __name__ == "__main__":
    main()
