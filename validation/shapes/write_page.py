"""Write docs/validation/shapes.md and its figure from the tables of slopes and of the ladder of meshes.

python validation/shapes/write_page.py
"""

import sys
from pathlib import Path

from meshes import HERE
from published import CLOSE_SHARE, CORRELATION, PUBLISHED, RMS_DEG, WITHIN, Published

from lithobrake.report.figures.style import INPUT_COLOURS, QUIET

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from drawing import figure
from harness import PAGES, Row, read_document, read_rows
from page import made, table, write_page, yes

HEADS = ("quantity", "published", "here", "here / published", "agrees", "cause shown by")
TURNED = "normals that face the centre, turned outward as the source turns them"
BY_AREA = "the mean by area, as this mesh has small facets where the ground is rough"
SMOOTHED = "each vertex moved half the way to the mean of its neighbours; the source averages vertices in cells"
NAMES = {
    "bennu_radar": "Bennu (radar)", "2008ev5": "2008 EV5", "eros": "Eros", "67p": "67P", "phobos": "Phobos",
    "bennu": "Bennu (OSIRIS-REx)", "itokawa": "Itokawa",
}  # fmt: skip
PANELS = (
    ("height_rms", "height [radii]", "Height, rms"), ("slope_rms_deg", "slope [deg]", "Slope at a place, rms"),
    ("gravity_median", "relative", "Gravity a tenth of a radius up, median"),
    ("apart", "distance [radii]", "Where the same lander ends, median"),
)  # fmt: skip
FINE, SLOPE, GRAVITY, END = 0.05, 5.0, 0.01, 0.05  # what the page asks of a mesh, beside the finest


def slopes() -> list[Row]:
    return read_rows(HERE / "slopes.csv", {"body": str, "mesh": str})


def ladder() -> list[Row]:
    return read_rows(HERE / "ladder.csv", {"body": str, "mesh": str, "case": str})


def agrees(value: float, one: Published) -> bool:
    return abs(value / one.value - 1.0) <= WITHIN


def cause_of(one: Published, rows: dict[str, Row]) -> str:
    """What brings a quantity that disagrees within the tolerance, with its value then; "not shown" where nothing does.

    rows: of the body at this density, by mesh.
    """
    if one.measure == "area_mean_deg":
        tried = [("public", "area_mean_turned_deg", TURNED)]
    else:
        tried = [("public", f"area_{one.measure}", BY_AREA), ("smoothed", one.measure, SMOOTHED),
                 ("smoothed", f"area_{one.measure}", f"both: {BY_AREA}; {SMOOTHED}")]  # fmt: skip
    for mesh, measure, words in tried:
        if agrees(rows[mesh][measure], one):
            return f"{words}: {rows[mesh][measure]:.4g}"
    return "not shown"


def quantities() -> list[tuple[bool, tuple[str, ...]]]:
    """Whether each quantity agrees, and its cells."""
    lines = []
    for one in PUBLISHED:
        own = {row["mesh"]: row for row in slopes() if (row["body"], row["density"]) == (one.body, one.density)}
        value = own["public"][one.measure]
        held = agrees(value, one)
        cause = "" if held else cause_of(one, own)
        lines.append(
            (held, (one.words, f"{one.value:g}", f"{value:.4g}", f"{value / one.value:.3f}", yes(held), cause))
        )
    every = read_rows(HERE / "slopes_facets.csv", {"body": str, "mesh": str})
    worst = min(row["correlation"] for row in every)
    largest, close = max(row["rms_deg"] for row in every), min(row["close_share"] for row in every)
    for words, shown, value, held in (
        ("correlation of slopes facet by facet", f"{CORRELATION:g}", f"{worst:.6f}", worst >= CORRELATION),
        ("rms difference facet by facet [deg]", f"{RMS_DEG:g}", f"{largest:.3f}", largest <= RMS_DEG),
        ("facets within 2 deg", f"{CLOSE_SHARE:.1%}", f"{close:.1%}", close >= CLOSE_SHARE),
    ):
        lines.append((held, (f"{words}, worst of {len(every)} meshes", shown, value, "", yes(held), "")))
    return lines


def facet_table() -> str:
    heads = ("mesh", "facets", "mean slope here [deg]", "polyhedral-gravity [deg]", "correlation", "rms [deg]",
             "largest [deg]", "largest at the same points [deg]")  # fmt: skip
    rows = read_rows(HERE / "slopes_facets.csv", {"body": str, "mesh": str})
    return table(heads, (
        (NAMES[row["body"]], f"{row['facets']:.0f}", f"{row['mean_deg']:.3f}", f"{row['other_mean_deg']:.3f}",
         f"{row['correlation']:.7f}", f"{row['rms_deg']:.3f}", f"{row['largest_deg']:.2f}",
         f"{row['largest_same_points_deg']:.0e}") for row in rows
    ))  # fmt: skip


def ladder_table() -> str:
    heads = ("body", "facets", "edge [radii]", "height, rms [radii]", "mean slope [deg]", "slope at a place, rms [deg]",
             "gravity, median", "same lander apart [radii]", "travelled [radii]", "at rest")  # fmt: skip
    return table(heads, (
        (NAMES[row["body"]] + " (shifted)" * (row["case"] == "shifted"), f"{row['facets']:.0f}",
         f"{row['edge_m'] / row['radius_m']:.3f}", f"{row['height_rms']:.4f}", f"{row['slope_deg']:.1f}",
         f"{row['slope_rms_deg']:.1f}", f"{100.0 * row['gravity_median']:.2g} %", f"{row['apart']:.2g}",
         f"{row['travelled']:.3f}", f"{100.0 * row['at_rest']:.0f} %") for row in ladder()
    ))  # fmt: skip


def draw() -> None:
    """Differences from the finest mesh over the length of an edge, four questions in four panels."""
    rows = [row for row in ladder() if row["case"] == "mesh" and row["height_rms"] > 1e-9]
    shifted = {row["body"]: row for row in ladder() if row["case"] == "shifted"}
    bodies = list(dict.fromkeys(row["body"] for row in rows))
    with figure(PAGES / "shapes.png", 2, 2, (9.2, 6.8), dpi=150) as (_, axes):
        for axis, (name, unit, title) in zip(axes.flat, PANELS, strict=True):
            for colour, body in zip(INPUT_COLOURS, bodies, strict=False):
                own = [row for row in rows if row["body"] == body]
                edge = [row["edge_m"] / row["radius_m"] for row in own]
                axis.plot(edge, [row[name] for row in own], "o-", color=colour, lw=1.6, ms=4, label=NAMES[body])
                if name == "apart":
                    axis.axhline(shifted[body][name], color=colour, lw=1.0, ls=":")
            axis.set(xscale="log", yscale="log", xlabel="edge of a facet [radii]", ylabel=unit)
            axis.set_title(title)
        for axis, value in zip(axes.flat, (None, SLOPE, GRAVITY, END), strict=True):
            if value is not None:
                axis.axhline(value, color=QUIET, lw=1.0, ls="--")
        axes[0, 0].legend(fontsize=8)


def enough(name: str, most: float) -> str:
    """Largest edge of a body's meshes, in radii, from which on all finer ones are within a difference; by body."""
    found = []
    for body in dict.fromkeys(row["body"] for row in ladder()):
        own = [row for row in ladder() if row["body"] == body and row["case"] == "mesh"]
        fine = [row for row in own if row["height_rms"] > 1e-9]
        kept = [row for k, row in enumerate(fine) if all(one[name] <= most for one in fine[k:])]
        found.append(
            f"{NAMES[body]} {kept[0]['facets']:.0f}" if kept else f"{NAMES[body]} none below {own[-1]['facets']:.0f}"
        )
    return ", ".join(found)


def main() -> None:
    lines = quantities()
    agreeing = sum(held for held, _ in lines)
    shown = sum(not held and cells[-1] != "not shown" for held, cells in lines)
    kept = {name: read_document(HERE / f"{name}.json") for name in ("slopes", "slopes_facets", "ladder")}
    write_page(
        "shapes", count=len(lines), agreeing=agreeing, shown=shown, open=len(lines) - agreeing - shown,
        quantities=table(HEADS, (cells for _, cells in lines)), facets=facet_table(), ladder=ladder_table(),
        within=f"{100.0 * WITHIN:g} %", gravity_enough=enough("gravity_median", GRAVITY),
        slope_enough=enough("slope_rms_deg", SLOPE), end_enough=enough("apart", END),
        slopes_made=made(kept["slopes"], f"{kept['slopes']['cpu_s']} s of CPU time"),
        ladder_made=made(kept["ladder"], f"{kept['ladder']['cpu_s']} s of CPU time"),
    )  # fmt: skip
    draw()
    print(f"{agreeing} of {len(lines)} agree, {shown} with a cause")


if __name__ == "__main__":
    main()
