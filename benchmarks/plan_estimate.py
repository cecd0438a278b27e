"""How right `lithobrake plan` is: steps and times of a bed and of landings, expected and as they come.

    python benchmarks/plan_estimate.py quick 24

pours the bed of scenarios/quick.toml and makes 24 of its landings, one after the other, and keeps what came beside what
was expected in benchmarks/plan_estimate.json. The constants of expected_steps.py,
expected_time.py and pace.py in lithobrake/pipeline/planning were taken from there.
"""

import argparse
import json
import statistics
import time
from pathlib import Path
from typing import Any

from origin import origin

from lithobrake.dem import World
from lithobrake.pipeline.planning.expected_steps import FALLS, SETTLING, STEPS_PER_PERIOD, ExpectedSoil
from lithobrake.pipeline.planning.expected_time import landing_time, pour_time
from lithobrake.pipeline.planning.pace import REFERENCE, probe
from lithobrake.study import read_study
from lithobrake.touchdown import Bed, Landing, land, pour_bed, simulation
from lithobrake.touchdown.settling import PERIODS_RELAXED

STUDIES = Path(__file__).parents[1] / "scenarios"
RESULTS = Path(__file__).with_suffix(".json")


class Clock:
    """Steps of all worlds and CPU time [s], by what they were spent on."""

    def __init__(self) -> None:
        """Count from now on."""
        self.steps: dict[str, float] = {}
        self.seconds: dict[str, float] = {}
        self.what, self.since = "", time.process_time()
        run = World.run

        def counted(world: World, duration: float | None = None, *, steps: int | None = None) -> None:
            began = world.time
            run(world, duration, steps=steps)
            taken = round((world.time - began) / world.time_step)
            self.steps[self.what] = self.steps.get(self.what, 0.0) + taken

        World.run = counted  # type: ignore[method-assign]

    def begin(self, what: str) -> None:
        """Spend on something else from now on."""
        now = time.process_time()
        self.seconds[self.what] = self.seconds.get(self.what, 0.0) + now - self.since
        self.what, self.since = what, now


def poured(soil: ExpectedSoil, clock: Clock) -> tuple[Bed, dict[str, Any]]:
    """Pour the bed; give it, and how it was."""
    clock.begin("falling")
    bed = pour_bed(soil.recipe, lambda done, what: clock.begin("falling" if what == "pouring grains" else "settling"))
    clock.begin("")
    falling, settling = clock.steps["falling"], clock.steps["settling"]
    expected = soil.pour_steps()
    least = SETTLING * STEPS_PER_PERIOD * soil._settling_periods()
    return bed, {
        "falls": FALLS * falling / (expected - least),
        "settling": SETTLING * settling / least,
        "steps": falling + settling,
        "expected_steps": expected,
        "cpu_s": clock.seconds["falling"] + clock.seconds["settling"],
        "expected_s": pour_time(soil),
        "depth_m": bed.surface_height,
        "expected_depth_m": soil.depth,
    }


def landed(bed: Bed, soil: ExpectedSoil, clock: Clock) -> list[dict[str, Any]]:
    """Make the landings; say how each was."""
    relax, rows = simulation.relax, []

    def watched(world: World, bed: Bed, event: Landing) -> None:
        clock.begin("relaxing")
        relax(world, bed, event)
        clock.begin("touching")

    simulation.relax = watched
    for body, event in soil.landings[1:]:
        clock.steps, clock.seconds = {}, {}
        outcome = land(bed, body, event)
        clock.begin("")
        steps = clock.steps
        rows.append(
            {
                "status": outcome.status,
                "speed_m_s": event.speed,
                "crossings": outcome.simulated_time * event.speed / (2.0 * body.shape.bounding_radius + soil.diameter),
                "relaxing": steps["relaxing"] / (STEPS_PER_PERIOD * PERIODS_RELAXED),
                "relaxing_us_a_step": 1e6 * clock.seconds["relaxing"] / steps["relaxing"],
                "touching_us_a_step": 1e6 * clock.seconds["touching"] / steps["touching"],
                "steps": sum(steps.values()),
                "expected_steps": sum(soil.landing_steps(body, event)),
                "cpu_s": clock.seconds["relaxing"] + clock.seconds["touching"],
                "expected_s": landing_time(soil, body, event),
            }
        )
        print(json.dumps(rows[-1]), flush=True)
    return rows


def measure(name: str, count: int) -> dict[str, Any]:
    """Pour the bed of a study and make so many of its landings."""
    study = read_study(STUDIES / f"{name}.toml")
    soil = ExpectedSoil.of(study, len(study.touchdown_values()))
    soil = ExpectedSoil(soil.recipe, soil.grains, soil.landings[: count + 1])
    paces, clock = [probe() / REFERENCE], Clock()
    bed, pour = poured(soil, clock)
    print(json.dumps(pour), flush=True)
    rows = landed(bed, soil, clock)
    paces.append(probe() / REFERENCE)
    means = {key: statistics.fmean(row[key] for row in rows) for key in rows[0] if key != "status"}
    pace = statistics.fmean(paces)
    right = {
        "pour": pour["cpu_s"] / (pace * pour["expected_s"]),
        "landing": means["cpu_s"] / (pace * means["expected_s"]),
    }
    return {"grains": soil.recipe.grain_count, "paces": paces, "pour": pour, "landings": count, "mean": means} | {
        "found_over_expected": right
    }


def main() -> None:
    """Measure one study."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("study", choices=sorted(path.stem for path in STUDIES.glob("*.toml")))
    parser.add_argument("count", type=int)
    chosen = parser.parse_args()
    known = json.loads(RESULTS.read_text()) if RESULTS.exists() else {}
    command = f"benchmarks/plan_estimate.py {chosen.study} {chosen.count}"
    known[chosen.study] = {"result": measure(chosen.study, chosen.count), **origin(command)}
    RESULTS.write_text(json.dumps(known, indent=1) + "\n")
    print(json.dumps(known[chosen.study]))


if __name__ == "__main__":
    main()
