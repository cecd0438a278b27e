"""Write docs/validation/ballistic_descent.md and its figures from ballistic_descent.csv and reliable_sites.csv.

python validation/ballistic_descent/write_page.py
"""

import sys
from itertools import product
from pathlib import Path

import numpy as np
from ballistic_descent import DISTANCES, HERE, KINDS, LATITUDES, LONGITUDES, MAP_DISTANCE, RESTITUTIONS, SPEEDS, TABLE
from bands import Band, band_of
from reliable_part import BAR, LEVELS, PUBLISHED, inside, quantity, reliable_numbers, sites
from reliable_part import draw as draw_sites

from lithobrake.report.figures.style import INK

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from drawing import figure, plt
from harness import PAGES, Row, read_document, read_rows
from page import made, table, write_page
from quantities import keep_quantities

GROUNDS = (*(f"e = {one:g}" for one in RESTITUTIONS), "soil")


def shares(rows: list[Row], ground: str, distance: float, latitude: float, column: str = "at_rest") -> np.ndarray:
    """The values of a column by longitude from the side away from the primary, [longitudes]."""
    chosen = [
        row for row in rows if (row["ground"], row["distance_m"], row["latitude_deg"]) == (ground, distance, latitude)
    ]
    chosen.sort(key=lambda row: (row["longitude_deg"] + 180.0) % 360.0)
    return np.array([row[column] for row in chosen])


def bands(rows: list[Row], ground: str) -> dict[float, list[Band]]:
    """By the distance of the release the band on the equator at each level."""
    return {
        distance: [band_of(LONGITUDES, shares(rows, ground, distance, 0.0), level) for level in LEVELS]
        for distance in DISTANCES
    }


def band_table(rows: list[Row], ground: str) -> str:
    lines = []
    for distance, found in bands(rows, ground).items():
        cells = [f"**{band}**" if band.agrees(PUBLISHED, BAR) else str(band) for band in found]
        highest = shares(rows, ground, distance, 0.0)
        place = LONGITUDES[int(highest.argmax())]
        lines.append([f"{distance:g}", *cells, f"{highest.max():.2f}", f"{place:g}"])
    levels = (f"fraction ≥ {level:g}" for level in LEVELS)
    return table(["release [m]", *levels, "highest fraction", "at longitude [deg]"], lines)


def latitude_table(rows: list[Row]) -> str:
    """Shares at rest by latitude and ground, mean over the published band and over all other longitudes."""
    lines = []
    for ground, latitude in product(GROUNDS, LATITUDES):
        found = shares(rows, ground, MAP_DISTANCE, latitude)
        lines.append((title(ground), f"{latitude:g}", *(f"{found[one].mean():.2f}" for one in (inside(), ~inside()))))
    return table(("ground", "latitude [deg]", "longitudes 320 to 20", "other longitudes"), lines)


def draw(rows: list[Row], to: Path) -> None:
    """Shares at rest over longitude: a curve for each distance, a panel for each ground."""
    with figure(to, 2, 2, (9.2, 6.4), dpi=110, sharex=True, sharey=True) as (drawn, axes):
        colours = plt.get_cmap("viridis")(np.linspace(0.0, 0.85, len(DISTANCES)))
        shown = (LONGITUDES + 180.0) % 360.0 - 180.0
        order = np.argsort(shown)
        for axis, ground in zip(axes.flat, GROUNDS, strict=True):
            axis.axvspan(PUBLISHED.begin - 360.0, PUBLISHED.end - 360.0, color=INK, alpha=0.08, lw=0.0)
            for colour, distance in zip(colours, DISTANCES, strict=True):
                found = shares(rows, ground, distance, 0.0)
                axis.plot(shown[order], found[order], color=colour, label=f"released at {distance:g} m")
            axis.set_title("soil of the mission study" if ground == "soil" else title(ground))
            axis.set_ylim(0.0, 1.03)
            axis.set_xticks(np.arange(-180, 181, 60))
        for axis in axes[1]:
            axis.set_xlabel("longitude from the side away from Didymos [deg east]")
        for axis in axes[:, 0]:
            axis.set_ylabel("fraction at rest on Dimorphos")
        drawn.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=len(DISTANCES))


def mean_shares(rows: list[Row], ground: str, distance: float) -> list[float]:
    """Mean shares at rest in the published band and elsewhere, at the least and then at the best speed."""
    found = []
    for column in ("at_rest_at_least_speed", "at_rest"):
        values = shares(rows, ground, distance, 0.0, column)
        found += [float(values[inside()].mean()), float(values[~inside()].mean())]
    return found


def mean_table(rows: list[Row]) -> str:
    heads = ("ground", "release [m]", "lowest speed: 320 to 20", "others", "best speed: 320 to 20", "others")
    return table(heads, (
        (title(ground), f"{distance:g}", *(f"{one:.2f}" for one in mean_shares(rows, ground, distance)))
        for ground, distance in product(GROUNDS, DISTANCES)
    ))  # fmt: skip


def numbers(rows: list[Row]) -> dict[str, object]:
    hard = [ground for ground in GROUNDS if ground != "soil"]
    real = [
        band for ground in hard for found in bands(rows, ground).values() for band in found
        if str(band) not in ("none", "all")
    ]  # fmt: skip
    turned = Band(PUBLISHED.begin + 180.0, PUBLISHED.end + 180.0)
    means = {(g, d): mean_shares(rows, g, d) for g in hard for d in DISTANCES}
    least = [one[0] - one[1] for (g, _), one in means.items() if g != hard[-1]]
    last = [one[0] - one[1] for (g, _), one in means.items() if g == hard[-1]]
    best = [one[2] - one[3] for (g, d), one in means.items() if d >= 300.0 and g != hard[-1]]
    speeds = [row["best_speed_m_s"] for row in rows
              if (row["ground"], row["distance_m"], row["latitude_deg"]) == ("soil", MAP_DISTANCE, 0.0)]  # fmt: skip
    return {
        "bar": f"{BAR:g}", "least_low": f"{min(least):+.2f}", "least_high": f"{max(least):+.2f}",
        "last_low": f"{min(last):+.2f}", "last_high": f"{max(last):+.2f}",
        "best_low": f"{min(best):.2f}", "best_high": f"{max(best):.2f}", "bounded": len(real),
        "agree": sum(band.agrees(PUBLISHED, BAR) for band in real),
        "other": sum(band.agrees(turned, BAR) for band in real),
        "soil_400": f"{100.0 * shares(rows, 'soil', 400.0, 0.0).min():.0f} %",
        "soil_1000": f"{100.0 * shares(rows, 'soil', 1000.0, 0.0).max():.0f} %", "sites": len(LONGITUDES),
        "landers": int(rows[0]["landers"]), "at_end": sum(speed > SPEEDS[-1] - 1e-9 for speed in speeds),
    }  # fmt: skip


def title(ground: str) -> str:
    return "soil" if ground == "soil" else f"hard ground, {ground}"


def main() -> None:
    rows = read_rows(HERE / TABLE, KINDS)
    kept = read_document((HERE / TABLE).with_suffix(".json"))
    draw(rows, PAGES / "ballistic_descent.png")
    tables = [f"### {title(ground).capitalize()}\n\n{band_table(rows, ground)}" for ground in GROUNDS]
    reliable, found = sites(), numbers(rows)
    draw_sites(reliable, PAGES / "ballistic_descent_reliable.png")
    found |= reliable_numbers(reliable, (found["agree"], found["bounded"]))
    keep_quantities("ballistic_descent", {"ballistic descents to Dimorphos": [quantity(reliable)]})
    write_page(
        "ballistic_descent", **found, radius=f"{kept['moon_radius_m']:.1f}", apart=f"{kept['apart_m']:.0f}",
        means=mean_table(rows), bands="\n\n".join(tables), map=f"{MAP_DISTANCE:g}", latitudes=latitude_table(rows),
        made=made(kept, f"{kept['cpu_s_of_rows']} s of CPU time"),
    )  # fmt: skip


if __name__ == "__main__":
    main()
