"""One landing of a study's lander over ten thousand grains: what it costs, with grains held and with none.

    python benchmarks/fine_grains.py scenarios/first_bounce.toml --diameter 0.023 --grains 1200 --held 0.1 0.03 \
        --bed BED.h5 --out FILE

So many grains are poured in a box of a third of the study's width. Eight mirror images of that bed stand round it, and
all nine settle under the local gravity, by the criteria of every bed. The study's first drawn landing comes down on the
middle. BED.h5 keeps the bed, which is not made again where it is there; FILE.json gets a row a share as it comes.
"""

import json
import tomllib
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
from harness import Row, command_line, origin, timed, write_document
from landing_ensembles import draws

from lithobrake.dem import ConvexHull
from lithobrake.pipeline.runs.beds import bed_recipe
from lithobrake.pipeline.site import with_site_gravity
from lithobrake.study import Study, check_tables
from lithobrake.touchdown import Bed, BedRecipe, land, pour_bed, pouring
from lithobrake.touchdown.bed import boxed_world

TILES = 3


def study_of(path: Path, diameter: float, grain_count: int) -> Study:
    """The study with finer grains, and every landing at the middle of its bed."""
    tables = tomllib.loads(path.read_text())
    sizes = {"distribution": "constant", "value": diameter}
    tables["bed"] |= {"diameter": sizes, "grain_count": TILES**2 * grain_count, "bed_count": 1}
    tables["impact"] |= {"place": {"x": 0.0, "y": 0.0}, "orientation": "random", "azimuth_deg": "random"}
    return with_site_gravity(check_tables(tables, path.parent))


def mirrored(bed: Bed) -> Iterator[tuple[list[ConvexHull], np.ndarray, np.ndarray]]:
    """Grains, positions and orientations of nine images of a bed, each the mirror image of its neighbours."""
    hulls = {}
    for across in (False, True):
        for along in (False, True):
            mirror = np.array([-1.0 if across else 1.0, -1.0 if along else 1.0, 1.0])
            hulls[across, along] = [ConvexHull(grain.vertices * mirror) for grain in bed.grains]
    for i in range(-1, 2):
        for j in range(-1, 2):
            mirror = np.array([-1.0 if i else 1.0, -1.0 if j else 1.0, 1.0])
            place = bed.position * mirror + np.array([i * bed.width[0], j * bed.width[1], 0.0])
            turn = bed.orientation * np.array([1.0, mirror[1], mirror[0], mirror[0] * mirror[1]])
            yield hulls[i != 0, j != 0], place, turn


def wide_bed(bed: Bed, recipe: BedRecipe) -> Bed:
    """Nine images of a bed side by side, at rest together."""
    images = list(mirrored(bed))
    grains = [grain for hulls, _, _ in images for grain in hulls]
    place = np.concatenate([place for _, place, _ in images])
    turn = np.concatenate([turn for _, _, turn in images])
    width = (TILES * bed.width[0], TILES * bed.width[1])
    material = replace(recipe.material, restitution=max(pouring.SETTLING_RESTITUTION, recipe.material.restitution))
    world = boxed_world(grains, place, turn, width, material, recipe.gravity, recipe.contact)
    recorder = pouring.Recorder(bed.grain_diameter)
    pouring.settle(world, recorder, recipe, True, lambda done: None)
    return pouring.finished(world, recorder, replace(recipe, width=width), grains, np.tile(bed.diameter, TILES**2))


def main() -> None:
    parser = command_line(__doc__, "study", diameter=0.023, grains=1200, bed=Path, out=Path)
    parser.add_argument("--held", type=float, nargs="+", default=[])
    given = parser.parse_args()
    study = study_of(given.study, given.diameter, given.grains)
    whole = bed_recipe(study, 0)
    third = (whole.width[0] / TILES, whole.width[1] / TILES)
    recipe = replace(whole, grain_count=given.grains, width=third, sides="walls")
    command = f"benchmarks/fine_grains.py {given.study} --diameter {given.diameter} --grains {given.grains} --held "
    command += " ".join(str(share) for share in given.held)
    if not given.bed.exists():
        wide_bed(pour_bed(recipe), recipe).save(given.bed)
    bed = Bed.load(given.bed)
    rows: list[Row] = []
    _, lander, landing = next(draws(study, 1))
    # Compiles, and finds the cores of the hulls, as the first landing of a process does.
    land(bed, lander, replace(landing, time_limit=1e-3))
    for share in given.held:
        one = replace(landing, contact=replace(landing.contact, held_speed=share))
        outcome, cpu = timed(lambda one=one: land(bed, lander, one))
        row = {"held_speed": share, "cpu_s": cpu, "simulated_s": outcome.simulated_time}
        rows.append(row | {"outcome": str(outcome.status), **outcome.outputs})
        content = {**origin(command), "grains": len(bed.grains), "landings": rows}
        write_document(given.out.with_suffix(".json"), content)
        print(json.dumps(rows[-1]), flush=True)


if __name__ == "__main__":
    main()
