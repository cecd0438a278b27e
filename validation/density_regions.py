"""How large regions of highest density are, and what they hold of the next places, for normal clouds.

    python validation/density_regions.py [--clouds 200]
    python validation/density_regions.py --page    the table of docs/estimates.md, from what was made

A row a number of places, ratio of the cloud's axes and share: the area over that of the region of the normal law, mean
and standard deviation over clouds, and the share of 2000 further places within the outlines.
Writes density_regions.csv and .json beside this file.
"""

import math
import sys
from collections.abc import Iterator
from itertools import product
from pathlib import Path

import numpy as np
from matplotlib.path import Path as Outline

from lithobrake.analysis import highest_density
from lithobrake.analysis.equal_area import latitude_longitude

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from harness import Row, command_line, read_rows, rounded, write_made, write_rows
from page import table

TABLE = Path(__file__).with_suffix(".csv")
COLUMNS = ("places", "axes", "share", "clouds", "area_ratio", "area_deviation", "held")
COUNTS, AXES, NEXT = (48, 96, 240, 1000), (1.0, 4.0), 2000
SHARES = (0.5, 0.95)
RADIUS, SPREAD = 100.0, 2.0


def cloud(count: int, axes: float, random: np.random.Generator) -> np.ndarray:
    """Places [m] of a normal cloud on the plane that touches the body at latitude and longitude 0."""
    north, east = random.normal(size=(2, count))
    return np.column_stack([np.full(count, RADIUS), SPREAD * axes * east, SPREAD * north])


def rows(cloud_count: int) -> Iterator[Row]:
    for count in COUNTS:
        for axes in AXES:
            random, found = np.random.default_rng([count, int(axes)]), {share: [] for share in SHARES}
            for _ in range(cloud_count):
                regions = highest_density(cloud(count, axes, random), SHARES).regions
                following = latitude_longitude(cloud(NEXT, axes, random))
                for region in regions:
                    exact = -2.0 * math.pi * math.log(1.0 - region.share) * SPREAD**2 * axes
                    # A place within a hole lies within two outlines.
                    inside = sum(Outline(line).contains_points(following).astype(int) for line in region.outlines) % 2
                    found[region.share].append((region.area_m2 / exact, inside.mean()))
            for share, both in found.items():
                ratio, held = np.array(both).T
                yield {
                    "places": count, "axes": axes, "share": share, "clouds": cloud_count, "area_ratio": ratio.mean(),
                    "area_deviation": ratio.std(ddof=1), "held": held.mean(),
                }  # fmt: skip


def page_table() -> str:
    """What was made, as a table in Markdown: a line a number of places and ratio of axes."""
    made = {(row["places"], row["axes"], row["share"]): row for row in read_rows(TABLE, {"places": int})}
    lines = []
    for count, axes in product(COUNTS, AXES):
        both = (made[count, axes, share] for share in SHARES)
        cells = (f"{one['area_ratio']:.2f} ({one['area_deviation']:.2f}) | {one['held']:.2f}" for one in both)
        lines.append((str(count), f"{axes:g} to 1", *cells))
    heads = (word for share in SHARES for word in (f"area of {100 * share:.0f} % / exact", "inside"))
    return table(["places", "ratio of the axes of the cloud", *heads], lines) + "\n"


def main() -> None:
    options = command_line(__doc__, clouds=200, page=False).parse_args()
    if options.page:
        print(page_table())
        return
    write_rows(TABLE, COLUMNS, (print(*row.values()) or row for row in map(rounded, rows(options.clouds))))
    write_made(TABLE, f"validation/density_regions.py --clouds {options.clouds}")


if __name__ == "__main__":
    main()
