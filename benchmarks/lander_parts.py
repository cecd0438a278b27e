"""What parts cost: CPU time of the same landings of a box alone, with a second main part, and with four booms, fixed
and on hinges.

    python benchmarks/lander_parts.py --bed BED_FILE --landings 3 --out FILE.csv --picture FILE.png

The box and the grains are those of scenarios/mission.toml, its soil at the medians. The bed is poured once into the
file; as booms reach over several of its periods, 4 x 4 copies of it side by side are the ground of the others: ground
that repeats fits itself. Each landing is followed for a minute; a row is written as it comes, and the picture is of
one landing with booms.
"""

import csv
import itertools
import os
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
from harness import command_line

from lithobrake.dem import Box, ConvexHull, Material, Part
from lithobrake.results import MovingBodies
from lithobrake.touchdown import (
    Bed,
    BedRecipe,
    ContactModel,
    GrainSizes,
    Hinge,
    HingedPart,
    Lander,
    Landing,
    beam_link,
    land,
    pour_bed,
)

ROCK = Material(young_modulus=6.3e5, poisson_ratio=0.25, restitution=0.6, friction=0.65, density=3300.0)
SKIN = replace(ROCK, friction=0.45, density=1450.0)
BOX, MASS, DIAMETER, WIDTH, COPIES = (0.366, 0.226, 0.1), 12.0, 0.15, (0.96, 0.96), 4
GRAVITY, SPEED, FOLLOWED = (0.0, 0.0, -4.5e-5), 0.08, 60.0
HELD = 0.03  # of the lander's speed
DRAWN = 1  # number of the landing in the picture


def part(edges: tuple[float, float, float], centre: tuple[float, float, float], mass: float) -> Part:
    """A box of a mass [kg] fixed to the lander."""
    shape = ConvexHull(Box(edges).vertices + np.array(centre))
    return Part(shape, replace(SKIN, density=mass / shape.volume))


BOOMS = tuple(
    part((1.5, 0.01, 0.01) if along else (0.01, 1.5, 0.01), (along, across, 0.0), 0.05)
    for along, across in ((0.933, 0.0), (-0.933, 0.0), (0.0, 0.863), (0.0, -0.863))
)
BOOM, BOOM_MASS, FREQUENCY, DAMPING = 1.5, 0.05, 6.7, 0.01  # m, kg, Hz


def hinged_boom(along: int, side: float) -> tuple[Part, Part]:
    """The link of a boom on its hinge, along an axis, and the fixed rest at its root."""
    link, surface = beam_link(BOOM, BOOM_MASS, FREQUENCY), 0.5 * BOX[along]
    found = []
    for length, begin, mass in (
        (link.length, BOOM - link.length, link.mass), (BOOM - link.length, 0.0, BOOM_MASS - link.mass),
    ):  # fmt: skip
        edges, centre = np.full(3, 0.01), np.zeros(3)
        edges[along], centre[along] = length, side * (surface + begin + 0.5 * length)
        found.append(part(tuple(edges.tolist()), tuple(centre.tolist()), mass))
    point = np.zeros(3)
    point[along] = side * (surface + BOOM - link.length)
    hinge = Hinge(tuple(point.tolist()), link.stiffness, DAMPING)
    return HingedPart(found[0].shape, found[0].material, hinge=hinge), found[1]


HINGED = tuple(itertools.chain(*(hinged_boom(along, side) for along in (0, 1) for side in (1.0, -1.0))))
SECOND = (part((0.2, 0.2, 0.1), (0.0, 0.0, 0.1), 3.0),)


def small_bed(path: Path) -> Bed:
    """One tile of ground, poured into the file where that is not there."""
    if not path.exists():
        sizes = GrainSizes(distribution="constant", lower=DIAMETER, upper=DIAMETER)
        recipe = BedRecipe(
            grain_count=96, sizes=sizes, cloud_point_count=14, width=WIDTH, material=ROCK, gravity=GRAVITY,
            pour_gravity=0.5, seed=1, sides="periodic",
        )  # fmt: skip
        pour_bed(recipe).save(path)
    return Bed.load(path)


def tiled(bed: Bed) -> Bed:
    """Copies of a bed side by side, one of them in the middle."""
    steps = np.arange(COPIES) - COPIES // 2
    shifts = [np.array([x * bed.width[0], y * bed.width[1], 0.0]) for x, y in itertools.product(steps, steps)]
    count = len(shifts)
    return replace(
        bed, grains=bed.grains * count, position=np.concatenate([bed.position + shift for shift in shifts]),
        orientation=np.tile(bed.orientation, (count, 1)), diameter=np.tile(bed.diameter, count),
        width=(COPIES * bed.width[0], COPIES * bed.width[1]), frames={}, history={},
    )  # fmt: skip


def landings(count: int) -> Iterator[Landing]:
    """So many landings in attitudes of their own."""
    generator = np.random.default_rng(1)
    for _ in range(count):
        w, x, y, z = generator.normal(size=4).tolist()
        yield Landing(
            grain=ROCK, speed=SPEED, incidence=0.4, azimuth=float(generator.uniform(0.0, 6.0)), place=(0.1, -0.05),
            orientation=(w, x, y, z), spin=(0.01, 0.005, 0.0), gravity=GRAVITY, time_limit=FOLLOWED, hop_height=1.3,
            contact=ContactModel(held_speed=HELD),
        )  # fmt: skip


def draw(bodies: MovingBodies, path: Path) -> None:
    """Draw a landing at four instants."""
    from lithobrake.report.figures.hulls import scene
    from lithobrake.report.figures.landing_figure import landing_figure
    from lithobrake.report.figures.style import figure_style

    with figure_style():
        landing_figure(scene(bodies, has_lander=True), 4).savefig(path, dpi=90)


def main() -> None:
    parser = command_line(__doc__, bed=Path, landings=3, out=Path, picture=Path)
    given = parser.parse_args()
    small = small_bed(given.bed)
    large = tiled(small)
    cases = {
        "box, one tile": (small, ()), "box": (large, ()), "second part": (large, SECOND), "booms": (large, BOOMS),
        "booms on hinges": (large, HINGED),
    }  # fmt: skip
    warm = next(landings(1))
    land(small, Lander(shape=Box(BOX), mass=MASS, material=SKIN), replace(warm, time_limit=1.0))
    with given.out.open("w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(["lander", "landing", "grains", "reach_m", "outcome", "followed_s", "cpu_s", "load"])
        for (number, landing), (name, (bed, parts)) in itertools.product(
            enumerate(landings(given.landings)), cases.items()
        ):
            lander = Lander(shape=Box(BOX), mass=MASS, material=SKIN, parts=parts)
            start = time.process_time()
            outcome = land(bed, lander, landing, frame_count=30 if name == "booms" else 0)
            spent = time.process_time() - start
            row = [name, number, len(bed.grains), f"{lander.reach:.3f}", outcome.status.value]
            table.writerow([*row, f"{outcome.simulated_time:.1f}", f"{spent:.2f}", f"{os.getloadavg()[0]:.1f}"])
            file.flush()
            if name == "booms" and number == DRAWN:
                draw(MovingBodies.of_landing(outcome, bed, lander, landing), given.picture)


if __name__ == "__main__":
    main()
