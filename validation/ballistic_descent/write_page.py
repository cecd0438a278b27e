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

VERDICT = """A band is the range of longitudes on the equator, around the highest share, in which at least a
given share of the landers comes to rest; its ends agree within 10 degrees of 320 and 20.

- **The place agrees.** On hard ground with e = 0.5 and 0.7 the most reliable longitudes are those
  published, from every distance. They lie around a meridian west of the one that looks away from
  Didymos, as theirs do: the Coriolis acceleration turns descents through the far Lagrange point
  aside. Counted from the side of Didymos, no band of hard ground agrees.
- **The width depends on what is not published.** Both ends agree where distance and share bound the
  band to some 60 degrees: nine in ten from 400 m or eight in ten from 600 m with e = 0.5, eight in
  ten from 400 m or half from 1 km with e = 0.7. Closer releases and lower shares give wider bands.
- **The distance matters more than the site.** From 200 m nearly every longitude serves; from 1 km
  none keeps nine landers in ten. With e = 0.9 no site is reliable from 300 m on.
- **New: soil.** On the soil of the mission study nearly all that touch down rest, so that only
  descents that miss Dimorphos are lost: from up to 400 m every longitude keeps at least 84 % of the
  landers. From 600 m the side of Didymos is as good as the far one; from 1 km the far one is best.

Shares have a standard error of up to 5 points (100 landers), and each is the best of 24 speeds,
which raises it by some points. Of the restitutions the source scans none is named in its abstract.

## Bands on the equator

Longitudes [deg] of the band that holds the highest share; bold: both ends agree. Soil: each impact
repeats one of the 20 simulated touchdowns of `scenarios/mission.toml` that are nearest in speed and
incidence.
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
    turned = (LONGITUDES - PUBLISHED.begin) % 360.0 <= PUBLISHED.end - PUBLISHED.begin
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


def verdict(rows: list[Row]) -> list[str]:
    """One line for each ground: bands that agree, and where the highest shares lie."""
    lines = []
    for ground in GROUNDS:
        every = [band for found in bands(rows, ground).values() for band in found]
        real = [band for band in every if str(band) not in ("none", "all")]
        agree = sum(band.agrees(PUBLISHED, BAR) for band in real)
        other = sum(band.agrees(Band(PUBLISHED.begin + 180.0, PUBLISHED.end + 180.0), BAR) for band in real)
        tops = [LONGITUDES[int(shares(rows, ground, one, 0.0).argmax())] for one in DISTANCES]
        inside = sum((top - PUBLISHED.begin) % 360.0 <= PUBLISHED.end - PUBLISHED.begin for top in tops)
        lines.append(f"| {title(ground)} | {inside} of {len(tops)} | {len(real)} of {len(every)} | {agree} | {other} |")
    head = "| ground | highest share at 320 to 20 | bands, neither all nor none | both ends agree |"
    return [f"{head} if 0 looks at Didymos |", "|---|---|---|---|---|", *lines]


def title(ground: str) -> str:
    """A ground in words."""
    return "soil" if ground == "soil" else f"hard ground, {ground}"


def main() -> None:
    """Write page and figure."""
    rows = read_rows(HERE / TABLE, KINDS)
    made = json.loads((HERE / TABLE).with_suffix(".json").read_text(encoding="utf-8"))
    draw(rows, PAGES / "ballistic_descent.png")
    sites = len(LONGITUDES) * (2 * len(LATITUDES) - 1)
    numbers = {"radius": made["moon_radius_m"], "apart": made["apart_m"], "landers": int(rows[0]["landers"])}
    lines = [
        HEAD.format(sites=sites, **numbers),
        "## Does the published band come out?",
        "",
        *verdict(rows),
        "",
        VERDICT,
    ]
    for ground in GROUNDS:
        lines += [f"### {title(ground).capitalize()}", "", *band_table(rows, ground), ""]
    lines += [f"## Other latitudes, released at {MAP_DISTANCE:g} m", "", *latitude_table(rows), ""]
    lines += [f"`{made['command']}`, {made['date']}, {made['machine']},", f"{made['cpu_s_of_rows']} s of CPU time."]
    (PAGES / "ballistic_descent.md").write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
