"""What the rows of the sphere that settles say: rows of the page's table, and its section."""

import math

from draw import of_gravities
from fits import column, gravity_exponents
from result_rows import read_rows
from settling_in_other_gravities import DIAMETER, EARTH, GRAINS
from table_lines import FIGURES, HERE, Lines, line, table

BAR = 0.03


def settling_part() -> tuple[Lines, str]:
    """Return rows of the table, and the section's table."""
    every = read_rows(HERE / "settling_in_other_gravities.csv")
    rows = [row for row in every if row["young_modulus"] == GRAINS.young_modulus]
    found = gravity_exponents(rows)
    lines = [
        line("exponent of depth over gravity", 0.0, found["depth"], BAR, "0"),
        line("exponent of the time until it stops, over gravity", -0.5, found["stopping_time"], BAR, "-1/2"),
        line("exponent of the time to 90 % of the depth, over gravity", -0.5, found["time_to_90"], BAR, "-1/2"),
    ]
    of_gravities(rows, DIAMETER, FIGURES / "settling_in_other_gravities.png")
    heads = ("Young's modulus [Pa]", "gravity / Earth's", "simulations", "depth / diameter, mean +- standard deviation",
             "time until it stops [sqrt(D/g)], mean +- standard deviation", "time to 90 % of the depth [sqrt(D/g)]",
             "solid fraction")  # fmt: skip
    cells = []
    for modulus, share in sorted({(row["young_modulus"], row["share"]) for row in every}, reverse=True):
        own = [row for row in every if (row["young_modulus"], row["share"]) == (modulus, share)]
        unit = math.sqrt(DIAMETER / (EARTH * share))
        depth, stop, most = (column(own, name) for name in ("depth", "stopping_time", "time_to_90"))
        cells.append((
            f"{modulus:.0e}".replace("e+0", "e"), f"{share:g}", str(len(own)),
            f"{depth.mean() / DIAMETER:.3f} +- {depth.std() / DIAMETER:.3f}",
            f"{stop.mean() / unit:.3f} +- {stop.std() / unit:.3f}", f"{most.mean() / unit:.3f}",
            f"{column(own, 'bulk_density').mean() / 1000.0:.4f}",
        ))  # fmt: skip
    return lines, table(heads, cells)
