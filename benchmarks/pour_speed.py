"""The same beds poured by two checkouts of the project in turn: what each costs, and what came of it.

    git worktree add OLD b9326c2
    python benchmarks/pour_speed.py OLD . --study scenarios/paper.toml --pours 3 --tile 0.56 --out FILE

Each bed is that of the study with another seed, handed to either as plain numbers. With --tile the second checkout
pours ground that repeats after so many metres, with as many grains an area, in place of a box. Each checkout has a
process of its own, whose kernels are compiled by a small bed before; beds are poured in turn, without a library.
FILE.csv gets a row a bed and checkout as it comes, FILE.json the sums; the last line printed says the ratio.
"""

import math
import sys
from collections.abc import Callable, Iterator
from dataclasses import asdict, replace
from pathlib import Path

from harness import Checkout, Row, answer_lines, command_line, in_turn

LAW = ("shear_modulus_rule", "damping_mass", "pair_rule", "steps_per_contact")
TOLD = ("solid_fraction", "coordination_number", "surface_height", "surface_top")
COMPILED_BY = 8  # grains


def recipe_of(study: Path, seed: int) -> Row:
    """The recipe of a study's first bed with another seed, as plain numbers."""
    from lithobrake.pipeline.runs.beds import bed_recipe
    from lithobrake.pipeline.site import with_site_gravity
    from lithobrake.study import read_study

    recipe = asdict(replace(bed_recipe(with_site_gravity(read_study(study)), 0), seed=seed))
    recipe["contact"] = {name: recipe["contact"][name] for name in LAW}
    # Older checkouts know of walls alone.
    del recipe["sides"]
    return recipe


def tile_of(recipe: Row, width: float) -> Row:
    """The recipe for ground that repeats after a width [m], with as many grains an area; that of a box for 0."""
    if width == 0.0:
        return recipe
    count = round(recipe["grain_count"] * width**2 / math.prod(recipe["width"]))
    return recipe | {"grain_count": count, "width": [width, width], "sides": "periodic"}


def pour_recipes() -> None:
    """Pour what comes in, a line a recipe, and answer with a line each: with the package that is on the path."""
    from lithobrake.dem import Material
    from lithobrake.touchdown import BedRecipe, ContactModel, GrainSizes, pour_bed

    def prepared(given: Row) -> Callable[[], Row]:
        made = {"sizes": GrainSizes, "material": Material, "contact": ContactModel}
        given |= {name: kind(**given[name]) for name, kind in made.items()}
        recipe = BedRecipe(
            **{name: tuple(value) if isinstance(value, list) else value for name, value in given.items()}
        )

        def poured() -> Row:
            bed = pour_bed(recipe)
            row = {"outcome": "at rest", "simulated_s": float(bed.history["time"][-1])}
            return row | {name: getattr(bed, name) for name in TOLD}

        return poured

    answer_lines(prepared)


def main() -> None:
    given = command_line(__doc__, "old", "new", study=Path, pours=3, tile=0.0, out=Path).parse_args()
    checkouts = {
        name: Checkout(folder, __file__, "--pouring") for name, folder in (("old", given.old), ("new", given.new))
    }

    def recipes() -> Iterator[dict[str, Row]]:
        for seed in range(1, given.pours + 1):
            recipe = recipe_of(given.study, seed)
            if seed == 1:
                small = [width * math.sqrt(COMPILED_BY / recipe["grain_count"]) for width in recipe["width"]]
                width = [max(value, 2.0 * recipe["sizes"]["upper"]) for value in small]
                for checkout in checkouts.values():
                    checkout.answer(recipe | {"grain_count": COMPILED_BY, "width": width})
            yield {"old": recipe, "new": tile_of(recipe, given.tile)}

    command = f"benchmarks/pour_speed.py OLD . --study {given.study} --pours {given.pours} --tile {given.tile}"
    columns = ["seed", "checkout", "outcome", "simulated_s", "cpu_s", *TOLD]
    in_turn(checkouts, recipes(), 1, columns, given.out, command, "pours")


if __name__ == "__main__":
    if sys.argv[1:] == ["--pouring"]:
        pour_recipes()
    else:
        main()
