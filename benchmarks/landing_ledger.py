"""How well the ledger of energy closes over whole landings, with grains held and without.

    python benchmarks/landing_ledger.py BED_FOLDER --landings 16

lands drawn landings of validation/studies/drawn_700.toml (soils, places, headings and attitudes) on two beds of GRAINS
grains, which are poured into BED_FOLDER where they are not there yet, in each of WAYS, and sums the ledger from the
touchdown to the end. landing_ledger.json gets a row a way: mean of what is missing over the energy of the impact, its
error, and the largest.
"""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
from harness import VALIDATION_STUDIES, Row, command_line, origin, timed, write_document
from landing_ensembles import beds_of, drawn_study, draws

from lithobrake.touchdown import Bed, Lander, Landing
from lithobrake.touchdown.outcome_judge import OutcomeJudge
from lithobrake.touchdown.simulation import moving_reach, release, run_until_looked_at

GRAINS, WIDTH, BEDS = 200, 1.8, 2
# Steps a contact, and shares of the lander's speed below which collisions take fewer, and grains are held.
WAYS = [
    (25.0, 0.0, 0.0), (25.0, 0.1, 0.0), (25.0, 0.3, 0.0), (25.0, 0.3, 0.03), (25.0, 0.3, 0.1), (100.0, 0.0, 0.0),
    (100.0, 0.3, 0.0),
]  # fmt: skip
STUDY = VALIDATION_STUDIES / "drawn_700.toml"
RESULTS = Path(__file__).with_suffix(".json")


def missing(bed: Bed, lander: Lander, landing: Landing, steps: float, resolved: float, held: float) -> float:
    """What the ledger lacks in the end, over the energy of the impact, on a bed that takes on its soil at once."""
    world = bed.world(landing.grain, bed.gravity, landing.contact)
    world.gravity = np.array(landing.gravity)
    number = release(world, bed, lander, landing)
    world.time_step = world.shortest_contact(landing.speed) / steps
    world.watch(number)
    judge = OutcomeJudge(bed, lander, landing, world, number, 0)
    reach = moving_reach(bed.grain_diameter, lander, landing)
    contact = replace(landing.contact, steps_per_contact=steps, resolved_speed=resolved, held_speed=held)
    landing = replace(landing, contact=contact)
    before = world.energy()["total"]
    while judge.ended is None:
        run_until_looked_at(world, judge.motion, lander, landing, bed.grain_diameter, reach)
        judge.look()
    return (world.energy()["total"] - before) / (0.5 * lander.mass * landing.speed**2)


def main() -> None:
    given = command_line(__doc__, "beds", landings=16).parse_args()
    study = drawn_study(STUDY, BEDS, 0.1)
    small = study.bed.model_copy(update={"grain_count": GRAINS, "width": (WIDTH, WIDTH)})
    study = study.model_copy(update={"bed": small})
    beds, cases = beds_of(study, given.beds), list(draws(study, given.landings))
    rows: list[Row] = []
    for way in WAYS:
        found, cpu = timed(lambda way=way: [missing(beds[bed], *case, *way) for bed, *case in cases])
        errors = np.array(found)
        rows.append({
            "steps_per_contact": way[0], "resolved_speed": way[1], "held_speed": way[2], "mean": float(errors.mean()),
            "error_of_mean": float(errors.std(ddof=1) / len(errors) ** 0.5), "largest": float(abs(errors).max()),
            "cpu_s": cpu,
        })  # fmt: skip
        print(json.dumps(rows[-1]), flush=True)
    command = f"benchmarks/landing_ledger.py BED_FOLDER --landings {given.landings}"
    write_document(RESULTS, {**origin(command), "landings": given.landings, "ways": rows})


if __name__ == "__main__":
    main()
