"""Write docs/validation/shapes.md and its figure from the tables of slopes and of the ladder of meshes.

python validation/shapes/write_page.py
"""

import sys
from pathlib import Path

from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter
from meshes import HERE
from published import CLOSE_SHARE, CORRELATION, PUBLISHED, RMS_DEG, WITHIN, Published

from lithobrake.report.figures.style import INPUT_COLOURS, QUIET

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from drawing import figure
from harness import PAGES, Row, read_document, read_rows
from page import made, table, write_page, yes
from quantities import CODE, NOT_SHOWN, Quantity, counts, keep_quantities

HEADS = ("quantity", "published", "here", "here / published", "agrees", "cause shown by")
TURNED = "normals that face the centre, turned outward as the source turns them"
BY_AREA = "the mean by area, as this mesh has small facets where the ground is rough"
SMOOTHED = "each vertex moved half the way to the mean of its neighbours; the source averages vertices in cells"
NAMES = {
    "bennu_radar": "Bennu (radar)", "2008ev5": "2008 EV5", "eros": "Eros", "67p": "67P", "phobos": "Phobos",
    "bennu": "Bennu (OSIRIS-REx)", "itokawa": "Itokawa",
}  # fmt: skip
# What the page asks of a mesh beside the finest, and what of a mesh is as good as equal to it.
SLOPE, GRAVITY, END, EQUAL = 5.0, 0.01, 0.05, 1e-9
PANELS = (
    ("height_rms", "difference [radii]", "Height of a place, rms", None),
    ("slope_rms_deg", "difference [deg]", "Slope at a place, rms", SLOPE),
    ("gravity_median", "relative difference", "Gravity a tenth of a radius up, median", GRAVITY),
    ("apart", "distance [radii]", "Between ends of the same lander, median", END),
)


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
    return NOT_SHOWN


def quantities() -> list[Quantity]:
    """The quantities of the page."""
    lines = []
    for one in PUBLISHED:
        own = {row["mesh"]: row for row in slopes() if (row["body"], row["density"]) == (one.body, one.density)}
        value = own["public"][one.measure]
        held = agrees(value, one)
        cells = (one.words, f"{one.value:g}", f"{value:.4g}", f"{value / one.value:.3f}", f"{100.0 * WITHIN:.0f} %")
        lines.append(Quantity(CODE, *cells, held, "slopes", NOT_SHOWN if held else cause_of(one, own)))
    every = read_rows(HERE / "slopes_facets.csv", {"body": str, "mesh": str})
    worst = min(row["correlation"] for row in every)
    largest, close = max(row["rms_deg"] for row in every), min(row["close_share"] for row in every)
    for words, shown, value, held in (
        ("correlation of slopes facet by facet", f"{CORRELATION:g}", f"{worst:.6f}", worst >= CORRELATION),
        ("rms difference facet by facet [deg]", f"{RMS_DEG:g}", f"{largest:.3f}", largest <= RMS_DEG),
        ("facets within 2 deg", f"{CLOSE_SHARE:.1%}", f"{close:.1%}", close >= CLOSE_SHARE),
    ):
        cells = (f"{words}, worst of {len(every)} meshes", shown, value, "", "no worse than the source")
        lines.append(Quantity(CODE, *cells, held, "slopes_facets"))
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
    """Differences from the finest mesh over the count of facets, four questions in four panels."""
    rows = [row for row in ladder() if row["case"] == "mesh" and row["height_rms"] > EQUAL]
    bodies = list(dict.fromkeys(row["body"] for row in rows))
    with figure(PAGES / "shapes.png", 2, 2, (9.2, 6.8), dpi=150) as (_, axes):
        for axis, (name, unit, title, limit) in zip(axes.flat, PANELS, strict=True):
            for colour, body in zip(INPUT_COLOURS, bodies, strict=False):
                own = [row for row in rows if row["body"] == body]
                count, values = [row["facets"] for row in own], [row[name] for row in own]
                axis.plot(count, values, "o-", color=colour, lw=1.6, ms=4, label=NAMES[body])
            axis.set(xscale="log", yscale="log", xlabel="facets", ylabel=unit)
            for scale in (axis.xaxis, axis.yaxis):
                scale.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
                scale.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
                scale.set_minor_formatter(NullFormatter())
            axis.set_title(title)
            if limit:
                axis.axhline(limit, color=QUIET, lw=1.0, ls="--")
        axes[0, 0].legend(fontsize=8)


def enough(name: str, most: float) -> str:
    """Facets of the coarsest mesh of each body from which on all finer ones are within a difference."""
    found = []
    for body in dict.fromkeys(row["body"] for row in ladder()):
        own = [row for row in ladder() if row["body"] == body and row["case"] == "mesh"]
        coarse = [row for row in own if row["height_rms"] > EQUAL]
        kept = [row for k, row in enumerate(coarse) if all(one[name] <= most for one in coarse[k:])]
        said = f"{kept[0]['facets']:.0f}" if kept else f"the finest alone ({own[-1]['facets']:.0f})"
        found.append(f"{NAMES[body]} {said}")
    return ", ".join(found)


def ends() -> tuple[str, str]:
    """How far coarse meshes move the median distance travelled, at most, and the same lander, in parts of that."""
    changed, moved = [], []
    for body in dict.fromkeys(row["body"] for row in ladder()):
        *coarse, finest = (row for row in ladder() if row["body"] == body and row["case"] == "mesh")
        changed += [abs(row["travelled"] / finest["travelled"] - 1.0) for row in coarse]
        moved += [row["apart"] / finest["travelled"] for row in coarse]
    return f"{100.0 * max(changed):.0f} %", f"{100.0 * min(moved):.0f} to {100.0 * max(moved):.0f} %"


def equator() -> dict[str, str]:
    """Slopes of Bennu near its equator: published, by area, and after smoothing."""
    one = next(one for one in PUBLISHED if one.measure == "equator_deg")
    own = {row["mesh"]: row for row in slopes() if (row["body"], row["density"]) == (one.body, one.density)}
    return {
        "published_equator": f"{one.value:g}", "area_equator": f"{own['public']['area_equator_deg']:.2f}",
        "smooth_equator": f"{own['smoothed']['area_equator_deg']:.2f}",
    }  # fmt: skip


def main() -> None:
    travelled, moved = ends()
    lines = quantities()
    count, agreeing, shown, unknown = counts(lines)
    cells = ((one.quantity, one.other, one.here, one.error, yes(one.agrees), one.shown) for one in lines)
    kept = {name: read_document(HERE / f"{name}.json") for name in ("slopes", "slopes_facets", "ladder")}
    write_page(
        "shapes", count=count, agreeing=agreeing, shown=shown, open=unknown, quantities=table(HEADS, cells),
        facets=facet_table(), ladder=ladder_table(), within=f"{100.0 * WITHIN:g} %",
        gravity_enough=enough("gravity_median", GRAVITY),
        slope_enough=enough("slope_rms_deg", SLOPE), end_enough=enough("apart", END),
        travelled=travelled, moved=moved, **equator(),
        slopes_made=made(kept["slopes"], f"{kept['slopes']['cpu_s']} s of CPU time"),
        ladder_made=made(kept["ladder"], f"{kept['ladder']['cpu_s']} s of CPU time"),
    )  # fmt: skip
    keep_quantities("shapes", {"slopes of small bodies": lines})
    draw()


if __name__ == "__main__":
    main()
