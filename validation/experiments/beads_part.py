"""What the table of the ball dropped into beads says: rows of the page's table, and tables of its own."""

import math
from pathlib import Path

from draw import of_drops
from fits import (
    FALL,
    LIGHT,
    Estimate,
    below_first_touch,
    below_mean_surface,
    column,
    density_exponent,
    diameter_exponent,
    drop_exponents,
    mean_of,
    scale,
    stopping,
    without_beads,
)  # fmt: skip
from sphere_bed import Row, read_rows
from table_lines import FIGURES, HERE, Lines, line, said

UNMEASURED = Estimate(0.42, 0.03, 0)  # of the slope of a heap, where none was measured: what glass beads have
SURFACES = {"the mean surface": below_mean_surface, "the first touch": below_first_touch}
DROPS = 12
CELL = ("density", "diameter", "fall")  # what tells drops into one bed apart


def named(rows: list[Row], size: float, series: str) -> list[Row]:
    """Return the rows of a series in beads of a size [m]."""
    return [row for row in rows if row["name"].startswith(f"{1e3 * size:g}mm_{series}")]


def sizes_of(rows: list[Row]) -> list[float]:
    """Return the mean sizes [m] of beads into which all twelve balls were dropped, finest first."""
    return [size for size in sorted({row["bead_size"] for row in rows}) if len(named(rows, size, "drop_")) == DROPS]


def of_diameters(rows: list[Row], size: float) -> list[Row]:
    """Return the drops of balls of several diameters at one density and fall."""
    drops = named(rows, size, "drop_")
    return [row for row in drops if (row["density"], row["fall"]) == (LIGHT, FALL)] + named(rows, size, "diameter_")


def beads_part(work: Path) -> tuple[Lines, str, dict[str, Estimate]]:
    """Return rows, tables, and estimates of the ball dropped into beads; the rows are those of the finest beads."""
    every = read_rows(HERE / "ball_into_beads.csv")
    heaps = read_rows(HERE / "repose.csv")
    slope = mean_of([math.tan(math.radians(row["angle_deg"])) for row in heaps]) if heaps else UNMEASURED
    law = 0.14 / slope.value
    sizes = sizes_of(every)
    drops, sized = named(every, sizes[0], "drop_"), of_diameters(every, sizes[0])
    told = f"0.14 / {slope.value:.2f} = {law:.3f}, unverified"
    lines = []
    for where, depth_of in SURFACES.items():
        density, total = drop_exponents(drops, depth_of(drops))
        prefactor = mean_of(list(depth_of(drops) / scale(drops)))
        lines += [
            line(f"depth below {where}: exponent of the ball's density", 0.5, density, 0.05, "1/2"),
            line(f"depth below {where}: exponent of the total drop distance", 1 / 3, total, 0.05, "1/3"),
            line(f"depth below {where}: prefactor", law, prefactor, 0.25 * law, told),
        ]
        if len(sized) > 2:
            exponent = diameter_exponent(sized, depth_of(sized))
            lines.append(line(f"depth below {where}: exponent of the ball's diameter", 2 / 3, exponent, 0.05, "2/3"))
    lines.append(line("stopping time over depth / impact speed", 3.0, mean_of(stopping(drops)), 0.75, "3"))
    of_drops([named(every, size, "drop_") for size in sizes], slope, work, FIGURES / "ball_into_beads.png")
    density, total = drop_exponents(drops, below_mean_surface(drops))
    tables = "\n\n".join((size_table(every, sizes), drop_table(every, sizes), bed_table(every)))
    return lines, tables, {"density": density, "total": total}


def size_table(every: list[Row], sizes: list[float]) -> str:
    """Return the table of exponents over the size of the beads, with the limit of beads without size."""
    table = (
        "| beads [mm] | beads | filled | touch above the mean surface [beads] | exponent of density, from the mean "
        "surface | from the first touch | of drop distance | from the first touch | of diameter | from the first "
        "touch | stopping time v/d |\n|---|---|---|---|---|---|---|---|---|---|---|"
    )
    for size in sizes:
        drops, sized = named(every, size, "drop_"), of_diameters(every, size)
        first = drops[0]
        table += (
            f"\n| {1e3 * size:g} | {int(first['beads'])} | {first['bulk_density'] / 2500.0:.3f} "
            f"| {column(drops, 'touch_height').mean() / size:.2f} | {exponents(drops, sized)} "
            f"| {said(mean_of(stopping(drops)))} |"
        )
    if len(sizes) > 2:
        drops = without_beads([named(every, size, "drop_") for size in sizes], CELL)
        table += f"\n| to 0, a straight line in each drop | | | | {exponents(drops, [])} | |"
    return table


def exponents(drops: list[Row], sized: list[Row]) -> str:
    """Return the cells of the exponents of density, drop distance and diameter, each from either surface."""
    pairs = [drop_exponents(drops, depth_of(drops)) for depth_of in SURFACES.values()]
    cells = [said(pair[k]) for k in range(2) for pair in pairs]
    if len(sized) < 3:
        return " | ".join([*cells, "-", "-"])
    return " | ".join([*cells, *(said(diameter_exponent(sized, depth_of(sized))) for depth_of in SURFACES.values())])


def drop_table(every: list[Row], sizes: list[float]) -> str:
    """Return the table of depths and stopping times of the same balls in beads of each size."""
    names = [f"{1e3 * size:g}" for size in sizes]
    heads = [
        *(f"depth in {name} mm [cm]" for name in names), *(f"below first touch, {name} mm" for name in names),
        *(f"stopping time v/d, {name} mm" for name in names),
    ]  # fmt: skip
    table = "| density [kg/m3] | diameter [mm] | fall [m] | " + " | ".join(heads) + " |\n" + "|---" * (3 + len(heads))
    found = [
        {tuple(row[key] for key in CELL): row for row in named(every, size, "drop_") + named(every, size, "diameter_")}
        for size in sizes
    ]
    for cell in sorted({cell for rows in found for cell in rows}):
        own = [rows.get(cell) for rows in found]
        cells = [
            f"{100 * float(depth_of([row])[0]):.2f}" if row else "-" for depth_of in SURFACES.values() for row in own
        ]
        cells += [f"{stopping([row])[0]:.1f}" if row else "-" for row in own]
        table += f"|\n| {cell[0]:g} | {1e3 * cell[1]:g} | {cell[2]:g} | " + " | ".join(cells) + " "
    return table + "|"


def bed_table(every: list[Row]) -> str:
    """Return the table of other beds: a light and a heavy ball from .1 m, and the exponent of density of the two."""
    table = (
        "| bed | beads | filled | depth of 2200 kg/m3 [cm] | of 15000 kg/m3 | exponent of density | "
        "from the first touch | stopping time v/d, 2200 kg/m3 |\n|---|---|---|---|---|---|---|---|"
    )
    by_name = {row["name"]: row for row in every}
    pairs = [(f"{1e3 * size:g}mm_drop_2200_0.1", f"{1e3 * size:g}mm_drop_15000_0.1") for size in sizes_of(every)]
    pairs += [(name.removesuffix("_heavy"), name) for name in by_name if name.endswith("_heavy")]
    for light_name, heavy_name in pairs:
        light, heavy = by_name[light_name], by_name[heavy_name]
        name = light_name.replace("_drop_2200_0.1", ", as above").replace("mm_", " mm, ").replace("mm,", " mm,")
        table += (
            f"\n| {name.replace('_', ' ').replace('  ', ' ')} | {int(light['beads'])} "
            f"| {light['bulk_density'] / 2500.0:.3f} "
            f"| {100 * light['deepest']:.2f} | {100 * heavy['deepest']:.2f} | "
            + " | ".join(f"{density_exponent(light, heavy, depth_of):.2f}" for depth_of in SURFACES.values())
            + f" | {stopping([light])[0]:.1f} |"
        )
    return table
