"""Where does rebound appear? A 2 cm ball on one cohesive soil, at equal speeds under four gravities.

    python validation/low_speed/same_soil_gravities.py --work FOLDER --out FOLDER [--drops 4] [--shares 0.01 1e-5]

The soil is the 6 mm grains as cohesive as lunar soil of ../experiments/who_rebounds.py; a drop is made as there. Rows
that stand in same_soil_gravities.csv are not run again. Source: [Brisset-2018].
"""

import itertools
import math
import sys
from dataclasses import replace
from pathlib import Path

sys.path.extend([str(Path(__file__).parents[1] / "experiments"), str(Path(__file__).parents[2] / "benchmarks")])
import who_rebounds
from result_rows import note, options_of, read_rows
from who_rebounds import DIAMETER, EARTH, PULLING

HERE = Path(__file__).parent
NAME = "same_soil_gravities.csv"
SHARES = (1e-2, 1e-5, 1e-4, 1e-3)  # of Earth's gravity
SPEEDS = (0.05, 0.2, 1.0)  # m/s
SOIL = PULLING


def froude(share: float, speed: float) -> float:
    """Return the Froude number of a ball of a speed [m/s] under a share of Earth's gravity."""
    return speed / math.sqrt(EARTH * share * DIAMETER)


def main() -> None:
    given = options_of(__doc__, HERE, drops=4, shares=SHARES)
    table = given.out / NAME
    ran = {(row["kind"], row["speed"], row["drop"]) for row in read_rows(table)}
    for number, share, speed in itertools.product(range(given.drops), given.shares, SPEEDS):
        name = f"{share:g} g"
        if (name, speed, number) in ran:
            continue
        # Kinds of equal pour share one: the loose grains of "6 mm".
        who_rebounds.KINDS[name] = replace(SOIL, share=share)
        row = who_rebounds.drop(given.work, name, froude(share, speed), number)
        note(table, {"share": share, "speed": speed, **row})


if __name__ == "__main__":
    main()
