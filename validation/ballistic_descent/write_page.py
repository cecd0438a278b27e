"""Write docs/validation/ballistic_descent.md and its figure from ballistic_descent.csv.

python validation/ballistic_descent/write_page.py
"""

import json
import sys
from pathlib import Path

import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt
import numpy as np
from ballistic_descent import DISTANCES, HERE, KINDS, LATITUDES, LONGITUDES, MAP_DISTANCE, RESTITUTIONS, TABLE
from bands import Band, band_of

from lithobrake.report.figures.style import INK, STYLE

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from harness import PAGES, Row, read_rows

LEVELS = (0.5, 0.7, 0.8, 0.9)  # shares at rest from which a site counts as reliable
PUBLISHED = Band(320.0, 380.0)  # deg east of the meridian that looks away from the primary
BAR = 10.0  # deg, for either end of the band
GROUNDS = (*(f"e = {one:g}" for one in RESTITUTIONS), "soil")
HEAD = """# Ballistic descents to Dimorphos

Written by `python validation/ballistic_descent/write_page.py`.

[Celik-2019] and [Sanchez-2017] ask where a lander without propulsion can be released so that it
lands reliably on the moon of a binary: circular restricted three-body problem, touchdown along the
local vertical, release errors of 90 m and 2 cm/s (3 sigma), restitution as the design parameter.
Their result for the larger moons: longitudes 320 to 20 degrees near the equator.

Here: {sites} sites on a ball of Dimorphos' volume ({radius:.1f} m), {apart:.0f} m from Didymos.
Each is met along its vertical at 24 speeds from 4.8 to 14 cm/s. The descent is integrated back in
time to the release, at a distance from the moon's centre; from there {landers} landers with errors
fly on, in the gravity of both bodies, bounce and come to rest, or not. A site's share at rest is
that of its best speed: no touchdown speed does better.

Only the abstracts could be read. They name neither the distance of the release, nor the share that
counts as reliable, nor where longitude 0 lies, so distances and shares are scanned. Longitudes are
counted east from the meridian that looks away from Didymos, as the axis from the larger to the
smaller body has it in the three-body problem.

![Share at rest](ballistic_descent.png)
"""


def shares(rows: list[Row], ground: str, distance: float, latitude: float, column: str = "at_rest") -> np.ndarray:
    """The values of a column by longitude from the side away from the primary, [longitudes]."""
    chosen = [
        row for row in rows if (row["ground"], row["distance_m"], row["latitude_deg"]) == (ground, distance, latitude)
    ]
    chosen.sort(key=lambda row: (row["longitude_deg"] + 180.0) % 360.0)
    return np.array([row[column] for row in chosen])


def band_table(rows: list[Row], ground: str) -> tuple[list[str], int, int]:
    """Lines of the bands on the equator of a ground, how many agree with the published one, and of how many."""
    lines = [
        "| release [m] | " + " | ".join(f"share >= {level:g}" for level in LEVELS) + " | highest share | there [deg] |",
        "|---|" + "---|" * (len(LEVELS) + 2),
    ]
    agree = count = 0
    for distance in DISTANCES:
        found = shares(rows, ground, distance, 0.0)
        cells = []
        for level in LEVELS:
            band = band_of(LONGITUDES, found, level)
            agrees = band.agrees(PUBLISHED, BAR)
            count, agree = count + 1, agree + agrees
            cells.append(f"**{band}**" if agrees else str(band))
        place = LONGITUDES[int(found.argmax())]
        lines.append(f"| {distance:g} | " + " | ".join(cells) + f" | {found.max():.2f} | {place:g} |")
    return lines, agree, count


def latitude_table(rows: list[Row]) -> list[str]:
    """Lines of the shares at rest by latitude and ground, mean over all longitudes and over the published band."""
    turned = (LONGITUDES - PUBLISHED.begin) % 360.0 <= PUBLISHED.end - PUBLISHED.begin
    lines = ["| ground | latitude [deg] | longitudes 320 to 20 | all others |", "|---|---|---|---|"]
    for ground in GROUNDS:
        for latitude in LATITUDES:
            found = shares(rows, ground, MAP_DISTANCE, latitude)
            lines.append(f"| {ground} | {latitude:g} | {found[turned].mean():.2f} | {found[~turned].mean():.2f} |")
    return lines


def draw(rows: list[Row], to: Path) -> None:
    """Shares at rest over longitude: a curve for each distance, a panel for each ground."""
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(2, 2, figsize=(9.2, 6.4), sharex=True, sharey=True, constrained_layout=True)
        colours = plt.get_cmap("viridis")(np.linspace(0.0, 0.85, len(DISTANCES)))
        shown = (LONGITUDES + 180.0) % 360.0 - 180.0
        order = np.argsort(shown)
        for axis, ground in zip(axes.flat, GROUNDS, strict=True):
            axis.axvspan(PUBLISHED.begin - 360.0, PUBLISHED.end - 360.0, color=INK, alpha=0.08, lw=0.0)
            for colour, distance in zip(colours, DISTANCES, strict=True):
                found = shares(rows, ground, distance, 0.0)
                axis.plot(shown[order], found[order], color=colour, label=f"released at {distance:g} m")
            axis.set_title("soil of the mission study" if ground == "soil" else f"hard ground, {ground}")
            axis.set_ylim(0.0, 1.03)
            axis.set_xticks(np.arange(-180, 181, 60))
        for axis in axes[1]:
            axis.set_xlabel("longitude from the side away from Didymos [deg east]")
        for axis in axes[:, 0]:
            axis.set_ylabel("share at rest on Dimorphos")
        axes[0, 1].legend(loc="lower right")
        figure.savefig(to, dpi=110)
        plt.close(figure)


def verdict(counts: dict[str, tuple[int, int]]) -> list[str]:
    """One line for each ground."""
    return [f"- {ground}: {agree} of {count} bands have both ends within {BAR:g} degrees of 320 and 20."
            for ground, (agree, count) in counts.items()]  # fmt: skip


def main() -> None:
    """Write page and figure."""
    rows = read_rows(HERE / TABLE, KINDS)
    made = json.loads((HERE / TABLE).with_suffix(".json").read_text(encoding="utf-8"))
    draw(rows, PAGES / "ballistic_descent.png")
    sites = len(LONGITUDES) * (2 * len(LATITUDES) - 1)
    numbers = {"radius": made["moon_radius_m"], "apart": made["apart_m"], "landers": int(rows[0]["landers"])}
    lines = [HEAD.format(sites=sites, **numbers)]
    tables = {ground: band_table(rows, ground) for ground in GROUNDS}
    lines += ["## Does the published band come out?", "", *verdict({g: (t[1], t[2]) for g, t in tables.items()}), ""]
    lines += [(HERE / "verdict.md").read_text(encoding="utf-8"), "## Bands on the equator", ""]
    lines += ["Longitudes [deg] of the band that holds the highest share; bold: both ends agree.", ""]
    for ground, (table, _, _) in tables.items():
        name = "Soil: each impact repeats a simulated touchdown of `scenarios/mission.toml`" if ground == "soil" else ""
        lines += [f"### {ground[0].upper() + ground[1:]}", "", *([name + ".", ""] if name else []), *table, ""]
    lines += [f"## Other latitudes, released at {MAP_DISTANCE:g} m", "", *latitude_table(rows), ""]
    lines += [f"`{made['command']}`, {made['date']}, {made['machine']},", f"{made['cpu_s_of_rows']} s of CPU time."]
    (PAGES / "ballistic_descent.md").write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
