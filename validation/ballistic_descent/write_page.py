"""Write docs/validation/ballistic_descent.md and its figure from ballistic_descent.csv.

python validation/ballistic_descent/write_page.py
"""

import json
import re
import sys
import textwrap
from pathlib import Path

import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt
import numpy as np
from ballistic_descent import DISTANCES, HERE, KINDS, LATITUDES, LONGITUDES, MAP_DISTANCE, RESTITUTIONS, SPEEDS, TABLE
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

Here: {sites} sites on the equator, and as many at 20 and at 40 degrees for one distance (the model is
the same north and south), on a ball of Dimorphos' volume ({radius:.1f} m), {apart:.0f} m from
Didymos. Each is met along its vertical at 24 speeds from 4.8 to 14 cm/s. The descent is integrated
back in time to the release, at a distance from the moon's centre; from there {landers} landers with
the errors of [Celik-2019] fly on, in the gravity of both bodies, bounce and come to rest within two
days, or not. Hard ground keeps 0.9 of the speed along it, or what a friction of 0.6 leaves, and
captured landers slide with that friction. Soil: each impact repeats one of the 20 simulated
touchdowns of `scenarios/mission.toml` that are nearest in speed and incidence.

Only the abstracts could be read. They name neither the distance of the release, nor the share that
counts as reliable, nor where longitude 0 lies, and [Sanchez-2017] has other errors (1 sigma 10 m
and 1 cm/s). So distances and shares are scanned. Longitudes are counted east from the meridian that
looks away from Didymos, as the axis from the larger to the smaller body has it in the three-body
problem. The touchdown speed is read in two ways: the least of the 24 with which a descent from that
distance exists, and the one with which most landers come to rest, as restitution was the design
parameter from which touchdown speeds followed.

![Share at rest](ballistic_descent.png)
"""

VERDICT = """A band is the range of longitudes on the equator, around the highest share, in which at least a
given share of the landers comes to rest; its ends agree within {bar:g} degrees of 320 and 20.

- **At the least speed the band does not come out.** Descents at the least speed linger near the
  Lagrange points, where the errors of the release grow: the published longitudes are hardly
  better than the others (mean shares differ by {least_low:+.2f} to {least_high:+.2f} with e = 0.5 and 0.7).
- **At the best speed it does.** The published longitudes are better by {best_low:.2f} to
  {best_high:.2f} on hard ground from 300 m on with e = 0.5 and 0.7, and {agree} of the {bounded} bands of
  hard ground that are neither all nor none have both ends within {bar:g} degrees: those of some 60
  degrees' length. Wider ones belong to closer releases and lower shares. Counted from the side of
  Didymos, {other} do.
- **The distance matters as much as the site**, and what is published does not say it.
- **New: soil.** On the soil of the mission study nearly all that touch down rest, so that only
  descents that miss Dimorphos are lost: from 400 m every longitude keeps at least {soil_400:.0%} of
  the landers, from 1 km the best keeps {soil_1000:.0%}. At 600 m the best speed is the highest that was
  tried at {at_end} of {sites} longitudes, so shares there are lower bounds.

Shares have a standard error of up to 5 points ({landers} landers), and the best of 24 speeds is some
points too high.
"""
BANDS = """## Bands on the equator, at the best speed

Longitudes [deg] of the band that holds the highest share; bold: both ends agree.
"""


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


def band_table(rows: list[Row], ground: str) -> list[str]:
    """Lines of the bands on the equator of a ground."""
    lines = [
        "| release [m] | " + " | ".join(f"share >= {level:g}" for level in LEVELS) + " | highest share | there [deg] |",
        "|---|" + "---|" * (len(LEVELS) + 2),
    ]
    for distance, found in bands(rows, ground).items():
        cells = [f"**{band}**" if band.agrees(PUBLISHED, BAR) else str(band) for band in found]
        highest = shares(rows, ground, distance, 0.0)
        place = LONGITUDES[int(highest.argmax())]
        lines.append(f"| {distance:g} | " + " | ".join(cells) + f" | {highest.max():.2f} | {place:g} |")
    return lines


def latitude_table(rows: list[Row]) -> list[str]:
    """Lines of the shares at rest by latitude and ground, mean over all longitudes and over the published band."""
    turned = inside()
    lines = ["| ground | latitude [deg] | longitudes 320 to 20 | all others |", "|---|---|---|---|"]
    for ground in GROUNDS:
        for latitude in LATITUDES:
            found = shares(rows, ground, MAP_DISTANCE, latitude)
            lines.append(
                f"| {title(ground)} | {latitude:g} | {found[turned].mean():.2f} | {found[~turned].mean():.2f} |"
            )
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
            axis.set_title("soil of the mission study" if ground == "soil" else title(ground))
            axis.set_ylim(0.0, 1.03)
            axis.set_xticks(np.arange(-180, 181, 60))
        for axis in axes[1]:
            axis.set_xlabel("longitude from the side away from Didymos [deg east]")
        for axis in axes[:, 0]:
            axis.set_ylabel("share at rest on Dimorphos")
        figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=len(DISTANCES))
        figure.savefig(to, dpi=110)
        plt.close(figure)


def inside() -> np.ndarray:
    """Which longitudes lie in the published band."""
    return np.asarray((LONGITUDES - PUBLISHED.begin) % 360.0 <= PUBLISHED.end - PUBLISHED.begin)


def mean_shares(rows: list[Row], ground: str, distance: float) -> list[float]:
    """Mean shares at rest in the published band and elsewhere, at the least and then at the best speed."""
    found = []
    for column in ("at_rest_at_least_speed", "at_rest"):
        values = shares(rows, ground, distance, 0.0, column)
        found += [float(values[inside()].mean()), float(values[~inside()].mean())]
    return found


def mean_table(rows: list[Row]) -> list[str]:
    """Lines of the mean shares of every ground and distance."""
    head = "| ground | release [m] | least speed: 320 to 20 | all others | best speed: 320 to 20 | all others |"
    lines = [head, "|---|---|---|---|---|---|"]
    for ground in GROUNDS:
        for distance in DISTANCES:
            cells = " | ".join(f"{one:.2f}" for one in mean_shares(rows, ground, distance))
            lines.append(f"| {title(ground)} | {distance:g} | {cells} |")
    return lines


def verdict(rows: list[Row]) -> str:
    """What the rows say, in words."""
    hard = [ground for ground in GROUNDS if ground != "soil"]
    real = [
        band for ground in hard for found in bands(rows, ground).values() for band in found
        if str(band) not in ("none", "all")
    ]  # fmt: skip
    turned = Band(PUBLISHED.begin + 180.0, PUBLISHED.end + 180.0)
    means = {(g, d): mean_shares(rows, g, d) for g in hard for d in DISTANCES}
    least = [one[0] - one[1] for (g, _), one in means.items() if g != hard[-1]]
    best = [one[2] - one[3] for (g, d), one in means.items() if d >= 300.0 and g != hard[-1]]
    speeds = [row["best_speed_m_s"] for row in rows
              if (row["ground"], row["distance_m"], row["latitude_deg"]) == ("soil", MAP_DISTANCE, 0.0)]  # fmt: skip
    words = VERDICT.format(
        bar=BAR, least_low=min(least), least_high=max(least), best_low=min(best), best_high=max(best),
        agree=sum(band.agrees(PUBLISHED, BAR) for band in real), bounded=len(real),
        other=sum(band.agrees(turned, BAR) for band in real), soil_400=shares(rows, "soil", 400.0, 0.0).min(),
        soil_1000=shares(rows, "soil", 1000.0, 0.0).max(), sites=len(LONGITUDES), landers=int(rows[0]["landers"]),
        at_end=sum(speed > SPEEDS[-1] - 1e-9 for speed in speeds),
    )  # fmt: skip
    return wrapped(words.replace("%", " %"))


def wrapped(text: str) -> str:
    """Paragraphs and entries of lists in lines of a hundred characters."""
    filled = [
        textwrap.fill(" ".join(part.split()), 100, subsequent_indent="  " if part.startswith("- ") else "")
        for part in re.split(r"\n\n|\n(?=- )", text.strip())
    ]
    together = "\n".join(one if one.startswith("- ") else f"\n{one}\n" for one in filled).strip()
    return together + "\n"


def title(ground: str) -> str:
    """A ground in words."""
    return "soil" if ground == "soil" else f"hard ground, {ground}"


def main() -> None:
    """Write page and figure."""
    rows = read_rows(HERE / TABLE, KINDS)
    made = json.loads((HERE / TABLE).with_suffix(".json").read_text(encoding="utf-8"))
    draw(rows, PAGES / "ballistic_descent.png")
    numbers = {"radius": made["moon_radius_m"], "apart": made["apart_m"], "landers": int(rows[0]["landers"])}
    lines = [HEAD.format(sites=len(LONGITUDES), **numbers), "## Does the published band come out?", ""]
    lines += [*mean_table(rows), "", verdict(rows), BANDS]
    for ground in GROUNDS:
        lines += [f"### {title(ground).capitalize()}", "", *band_table(rows, ground), ""]
    lines += [f"## Other latitudes, released at {MAP_DISTANCE:g} m, at the best speed", "", *latitude_table(rows), ""]
    lines += [
        f"`{made['command']}`, {made['date']}, {made['machine']},",
        f"{made['cpu_s_of_rows']} s of CPU time, and that of the mission study where it is not there.",
    ]
    (PAGES / "ballistic_descent.md").write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
