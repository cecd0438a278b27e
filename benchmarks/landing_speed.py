"""The same landings by two checkouts of the project in turn: what each costs, and the ratio of their CPU times.

    git worktree add OLD b9326c2
    python benchmarks/landing_speed.py OLD . --study scenarios/paper.toml --beds BED_FOLDER --region .2 --landings 20
        --contact '{"stepping": "local", "steps_per_contact": 15, "held_speed": 0.1}'
        --old-contact '{"steps_per_contact": 50}' --out FILE

Every landing is drawn by this checkout (soil, place, heading, attitude) and handed to either as plain numbers, so that
both make the same one; the first checkout lands with what --old-contact changes in the study's contact section (its own
defaults, where they were others), the second with what --contact changes. Each has a process of its own, whose kernels
were compiled before; landings are made in turn. FILE.csv gets a row a landing and checkout as it comes, FILE.json the
sums; the last line printed says the ratio.
"""

import argparse
import csv
import json
import sys
import time
from dataclasses import asdict
from pathlib import Path
from typing import Any

Row = dict[str, Any]
LAW = ("shear_modulus_rule", "damping_mass", "pair_rule", "steps_per_contact")
TOLD = ("speed_out", "elevation_out", "spin_out", "contact_duration", "penetration")


def case(bed: Path, body: Any, arrival: Any) -> Row:
    """One landing as plain numbers; the lander must be a box."""
    given = asdict(arrival)
    given["contact"] = {name: given["contact"][name] for name in LAW}
    return {
        "bed": str(bed), "landing": given,
        "lander": {"edges": list(body.shape.lengths), "mass": body.mass, "material": asdict(body.material)},
    }  # fmt: skip


def land_cases() -> None:
    """Land what comes in, a line a landing, and answer with a line each: with the package that is on the path."""
    from lithobrake.dem import Box, Material
    from lithobrake.touchdown import Bed, ContactModel, Lander, Landing, land

    beds: dict[str, Bed] = {}
    for line in sys.stdin:
        one = json.loads(line)
        given, body = one["landing"], one["lander"]
        given |= {"grain": Material(**given["grain"]), "contact": ContactModel(**given["contact"])}
        landing = Landing(**{name: tuple(value) if isinstance(value, list) else value for name, value in given.items()})
        lander = Lander(shape=Box(body["edges"]), mass=body["mass"], material=Material(**body["material"]))
        # A process of a study reads a bed once for all its landings.
        bed = beds[one["bed"]] = beds.get(one["bed"]) or Bed.load(one["bed"])
        start = time.process_time()
        row: Row
        try:
            outcome = land(bed, lander, landing)
            row = {"outcome": str(outcome.status), "simulated_s": outcome.simulated_time}
            row |= {name: outcome.outputs[name] for name in TOLD}
        except (ValueError, FloatingPointError) as error:
            row = {"outcome": f"failed: {error}"}
        print(json.dumps(row | {"cpu_s": time.process_time() - start}), flush=True)


def main() -> None:
    """Land in turn, write, tell the ratio."""
    # The other checkout has other modules: what lands imports the public face alone.
    from checkouts import Checkout
    from landing_ensembles import beds_of, drawn_study, draws
    from origin import origin

    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old", type=Path)
    parser.add_argument("new", type=Path)
    parser.add_argument("--study", type=Path, required=True)
    parser.add_argument("--beds", type=Path, required=True, help="folder; beds are poured into it")
    parser.add_argument("--bed-count", type=int, default=2)
    parser.add_argument("--region", type=float, default=0.1)
    parser.add_argument("--landings", type=int, default=20)
    parser.add_argument("--contact", type=json.loads, default={}, help="what the second changes of the contact section")
    parser.add_argument("--old-contact", type=json.loads, default={}, help="what the first changes of it")
    parser.add_argument("--out", type=Path, required=True)
    given = parser.parse_args()
    study = drawn_study(given.study, given.bed_count, given.region)
    beds_of(study, given.beds)
    checkouts = {
        name: Checkout(folder, __file__, "--landing") for name, folder in (("old", given.old), ("new", given.new))
    }
    sums, finished = dict.fromkeys(checkouts, 0.0), 0
    command = (
        f"benchmarks/landing_speed.py OLD . --study {given.study} --beds BED_FOLDER --bed-count {given.bed_count} "
        f"--region {given.region} --landings {given.landings} --contact '{json.dumps(given.contact)}' "
        f"--old-contact '{json.dumps(given.old_contact)}'"
    )
    with given.out.with_suffix(".csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, ["landing", "checkout", "outcome", "simulated_s", "cpu_s", *TOLD])
        writer.writeheader()
        for number, (bed, body, arrival) in enumerate(draws(study, given.landings)):
            one = case(given.beds.resolve() / f"bed_{bed}.h5", body, arrival)
            contact = one["landing"]["contact"]
            for name, checkout in checkouts.items():
                one["landing"]["contact"] = contact | (given.contact if name == "new" else given.old_contact)
                if number == 0:
                    # Compiles.
                    checkout.answer(one | {"landing": one["landing"] | {"time_limit": 1e-3}})
                row = checkout.answer(one)
                sums[name] += row["cpu_s"]
                writer.writerow({"landing": number, "checkout": name, **row})
                file.flush()
            finished += 1
            text = json.dumps({**origin(command), "landings": finished, "cpu_s": sums}, indent=1)
            given.out.with_suffix(".json").write_text(text + "\n")
    print(
        f"{finished} landings: {sums['old']:.1f} s and {sums['new']:.1f} s of CPU: 1 / {sums['old'] / sums['new']:.1f}"
    )


if __name__ == "__main__":
    if sys.argv[1:] == ["--landing"]:
        land_cases()
    else:
        main()
