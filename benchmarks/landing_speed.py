"""The same landings by two checkouts of the project in turn: what each costs, and the ratio of their CPU times.

    git worktree add OLD b9326c2
    python benchmarks/landing_speed.py OLD . --study scenarios/paper.toml --beds BED_FOLDER --region 0.2 --landings 20
        --contact '{"stepping": "local", "steps_per_contact": 15, "held_speed": 0.1}'
        --old-contact '{"steps_per_contact": 50}' --out FILE

Every landing is drawn by this checkout (soil, place, heading, attitude) and handed to either as plain numbers, so
that both make the same one, on the same bed, or, where the first checkout cannot read today's beds, on those of the
same recipes that it has poured into the folder of --old-beds; the first checkout lands with what --old-contact
changes in the study's contact section (its own defaults, where they were others), the second with what --contact
changes. Each has a process of its own, whose kernels were compiled before; landings are made in turn. FILE.csv gets a
row a landing and checkout as it comes, FILE.json the sums; the last line printed says the ratio.
"""

import json
import sys
from collections.abc import Callable, Iterator
from dataclasses import asdict
from pathlib import Path
from typing import Any

from harness import Checkout, Row, answer_lines, command_line, in_turn

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

    def prepared(one: Row) -> Callable[[], Row]:
        given, body = one["landing"], one["lander"]
        given |= {"grain": Material(**given["grain"]), "contact": ContactModel(**given["contact"])}
        landing = Landing(**{name: tuple(value) if isinstance(value, list) else value for name, value in given.items()})
        lander = Lander(shape=Box(body["edges"]), mass=body["mass"], material=Material(**body["material"]))
        # A process of a study reads a bed once for all its landings.
        bed = beds[one["bed"]] = beds.get(one["bed"]) or Bed.load(one["bed"])

        def landed() -> Row:
            outcome = land(bed, lander, landing)
            row = {"outcome": str(outcome.status), "simulated_s": outcome.simulated_time}
            return row | {name: outcome.outputs[name] for name in TOLD}

        return landed

    answer_lines(prepared)


def main() -> None:
    # The other checkout has other modules: what lands imports the public face alone.
    from landing_ensembles import beds_of, drawn_study, draws

    parser = command_line(__doc__, "old", "new", study=Path, bed_count=2, region=0.1, landings=20, out=Path)
    parser.add_argument("--beds", type=Path, required=True, help="folder; beds are poured into it")
    parser.add_argument("--old-beds", type=Path, help="folder of the first checkout's own beds")
    parser.add_argument("--contact", type=json.loads, default={}, help="what the second changes of the contact section")
    parser.add_argument("--old-contact", type=json.loads, default={}, help="what the first changes of it")
    given = parser.parse_args()
    study = drawn_study(given.study, given.bed_count, given.region)
    beds_of(study, given.beds)
    checkouts = {
        name: Checkout(folder, __file__, "--landing") for name, folder in (("old", given.old), ("new", given.new))
    }
    changes = {"old": given.old_contact, "new": given.contact}

    def cases() -> Iterator[dict[str, Row]]:
        for number, (bed, body, arrival) in enumerate(draws(study, given.landings)):
            one = case(given.beds.resolve() / f"bed_{bed}.h5", body, arrival)
            landing = one["landing"]
            piece = {
                name: one | {"landing": landing | {"contact": landing["contact"] | change}}
                for name, change in changes.items()
            }
            if given.old_beds:
                piece["old"]["bed"] = str(given.old_beds.resolve() / f"bed_{bed}.h5")
            if number == 0:
                # Compiles.
                for name, checkout in checkouts.items():
                    checkout.answer(piece[name] | {"landing": piece[name]["landing"] | {"time_limit": 1e-3}})
            yield piece

    command = (
        f"benchmarks/landing_speed.py OLD . --study {given.study} --beds BED_FOLDER --bed-count {given.bed_count} "
        f"--region {given.region} --landings {given.landings} --contact '{json.dumps(given.contact)}' "
        f"--old-contact '{json.dumps(given.old_contact)}'{' --old-beds OLD_BED_FOLDER' if given.old_beds else ''}"
    )
    columns = ["landing", "checkout", "outcome", "simulated_s", "cpu_s", *TOLD]
    in_turn(checkouts, cases(), 0, columns, given.out, command, "landings")


if __name__ == "__main__":
    if sys.argv[1:] == ["--landing"]:
        land_cases()
    else:
        main()
