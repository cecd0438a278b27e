"""The same beds poured by two checkouts of the project in turn: what each costs, and what came of it.

    git worktree add OLD b9326c2
    python benchmarks/pour_speed.py OLD . --study scenarios/paper.toml --pours 3 --out FILE

Each bed is that of the study with another seed, handed to either as plain numbers. Each checkout has a process of its
own, whose kernels are compiled by a small bed before; beds are poured in turn, without a library. FILE.csv gets a row
a bed and checkout as it comes, FILE.json the sums; the last line printed says the ratio.
"""

import argparse
import csv
import json
import math
import sys
import time
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

Row = dict[str, Any]
LAW = ("shear_modulus_rule", "damping_mass", "pair_rule", "steps_per_contact")
TOLD = ("solid_fraction", "coordination_number", "surface_height", "surface_top")
COMPILED_BY = 8  # grains


def recipe_of(study: Path, seed: int) -> Row:
    """The recipe of a study's first bed with another seed, as plain numbers."""
    from lithobrake.pipeline.beds import bed_recipe
    from lithobrake.pipeline.site import with_site_gravity
    from lithobrake.study import read_study

    recipe = asdict(replace(bed_recipe(with_site_gravity(read_study(study)), 0), seed=seed))
    recipe["contact"] = {name: recipe["contact"][name] for name in LAW}
    return recipe


def pour_recipes() -> None:
    """Pour what comes in, a line a recipe, and answer with a line each: with the package that is on the path."""
    from lithobrake.dem import Material
    from lithobrake.touchdown import BedRecipe, ContactModel, GrainSizes, pour_bed

    for line in sys.stdin:
        given = json.loads(line)
        made = {"sizes": GrainSizes, "material": Material, "contact": ContactModel}
        given |= {name: kind(**given[name]) for name, kind in made.items()}
        recipe = BedRecipe(
            **{name: tuple(value) if isinstance(value, list) else value for name, value in given.items()}
        )
        start = time.process_time()
        row: Row
        try:
            bed = pour_bed(recipe)
            row = {"outcome": "at rest", "simulated_s": float(bed.history["time"][-1])}
            row |= {name: getattr(bed, name) for name in TOLD}
        except (ValueError, FloatingPointError) as error:
            row = {"outcome": f"failed: {error}"}
        print(json.dumps(row | {"cpu_s": time.process_time() - start}), flush=True)


def main() -> None:
    """Pour in turn, write, tell the ratio."""
    from checkouts import Checkout
    from origin import origin

    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old", type=Path)
    parser.add_argument("new", type=Path)
    parser.add_argument("--study", type=Path, required=True)
    parser.add_argument("--pours", type=int, default=3)
    parser.add_argument("--out", type=Path, required=True)
    given = parser.parse_args()
    checkouts = {
        name: Checkout(folder, __file__, "--pouring") for name, folder in (("old", given.old), ("new", given.new))
    }
    sums = dict.fromkeys(checkouts, 0.0)
    command = f"benchmarks/pour_speed.py OLD . --study {given.study} --pours {given.pours}"
    with given.out.with_suffix(".csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, ["seed", "checkout", "outcome", "simulated_s", "cpu_s", *TOLD])
        writer.writeheader()
        for seed in range(1, given.pours + 1):
            recipe = recipe_of(given.study, seed)
            for name, checkout in checkouts.items():
                if seed == 1:
                    small = [width * math.sqrt(COMPILED_BY / recipe["grain_count"]) for width in recipe["width"]]
                    least = 2.0 * recipe["sizes"]["upper"]
                    width = [max(value, least) for value in small]
                    checkout.answer(recipe | {"grain_count": COMPILED_BY, "width": width})
                row = checkout.answer(recipe)
                sums[name] += row["cpu_s"]
                writer.writerow({"seed": seed, "checkout": name, **row})
                file.flush()
            text = json.dumps({**origin(command), "pours": seed, "cpu_s": sums}, indent=1)
            given.out.with_suffix(".json").write_text(text + "\n")
    print(
        f"{given.pours} beds: {sums['old']:.1f} s and {sums['new']:.1f} s of CPU: 1 / {sums['old'] / sums['new']:.2f}"
    )


if __name__ == "__main__":
    if sys.argv[1:] == ["--pouring"]:
        pour_recipes()
    else:
        main()
