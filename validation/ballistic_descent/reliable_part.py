"""Tables, figure and numbers of reliable_sites.csv on the page of the ballistic descents."""

import sys
from pathlib import Path

import numpy as np
from ballistic_descent import DISTANCES, HERE, LONGITUDES
from bands import Band, band_of
from reliable_sites import FOLLOWED, KINDS, NEAR, PLACES, RESTITUTIONS, SOIL_DISTANCES, TABLE, UNKNOWN

from lithobrake.report.figures.style import INK

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from drawing import figure, plt
from harness import Row, read_document, read_rows
from page import made, table
from quantities import CODE, Quantity

LEVELS = (0.5, 0.7, 0.8, 0.9)  # chances to meet the moon, and shares at rest, that count as reliable
PUBLISHED = Band(320.0, 380.0)  # deg east of the meridian that looks away from the primary
MIDDLE = 0.5 * (PUBLISHED.begin + PUBLISHED.end) % 360.0
BAR = 10.0  # deg, for either end of the band
GROUNDS = ("gravel", "stones", "rock", UNKNOWN)
TICKS = np.arange(-180, 181, 60)


def sites() -> list[Row]:
    return read_rows(HERE / TABLE, KINDS)


def values(rows: list[Row], release: str, ground: str, distance: float, column: str) -> np.ndarray:
    """The values of a column by longitude from the side away from the primary, [longitudes]."""
    wanted = (release, ground, distance)
    chosen = [row for row in rows if (row["release"], row["ground"], row["distance_m"]) == wanted]
    chosen.sort(key=lambda row: (row["longitude_deg"] + 180.0) % 360.0)
    return np.array([row[column] for row in chosen])


def bands(rows: list[Row], release: str) -> dict[tuple[float, float], list[Band]]:
    """By restitution and distance the band at each level."""
    return {
        (one, distance): [
            band_of(LONGITUDES, values(rows, release, f"e = {one:g}", distance, "reaches"), level) for level in LEVELS
        ]
        for one in RESTITUTIONS
        for distance in DISTANCES
    }


def bounded(rows: list[Row], release: str) -> list[Band]:
    """The bands that have ends."""
    every = [band for found in bands(rows, release).values() for band in found]
    return [band for band in every if str(band) not in ("none", "all")]


def off_middle(band: Band) -> float:
    """How far the middle of a band is from that of the published one [deg]."""
    return abs((0.5 * (band.begin + band.end) - MIDDLE + 180.0) % 360.0 - 180.0)


def reliable_table(rows: list[Row]) -> str:
    """Bands of releases outside."""
    lines = []
    for (restitution, distance), found in bands(rows, "outside").items():
        cells = [f"**{band}**" if band.agrees(PUBLISHED, BAR) else str(band) for band in found]
        lines.append((f"{restitution:g}", f"{distance:g}", *cells))
    return table(("e", "release [m]", *(f"chance ≥ {level:g}" for level in LEVELS)), lines)


def definition_table(rows: list[Row], before: tuple[int, int]) -> str:
    """How many bands agree by each definition; before: how many did, of how many, at the best speed."""
    lines = [("the best of 24", "anywhere", "at rest", str(before[1]), str(before[0]), "")]
    for release in PLACES:
        found = bounded(rows, release)
        near = sum(off_middle(band) <= BAR for band in found)
        agree = sum(band.agrees(PUBLISHED, BAR) for band in found)
        lines.append(
            ("from the restitution", release, "chance to meet the moon", str(len(found)), str(agree), str(near))
        )
    heads = ("touchdown speed", "release", "reliable by", "bands", "agree", f"middle within {BAR:g} deg of {MIDDLE:g}")
    return table(heads, lines)


def inside() -> np.ndarray:
    """Which longitudes lie in the published band."""
    return np.asarray((LONGITUDES - PUBLISHED.begin) % 360.0 <= PUBLISHED.end - PUBLISHED.begin)


def ground_table(rows: list[Row]) -> str:
    """Kinds of ground: shares at rest in the published band and elsewhere, and the band of most landers."""
    lines = []
    for ground in GROUNDS:
        for distance in SOIL_DISTANCES:
            rested = values(rows, "outside", ground, distance, "at_rest")
            cells = (f"{one:.2f}" for one in (rested[inside()].mean(), rested[~inside()].mean(), rested.max()))
            found = (str(band_of(LONGITUDES, rested, level)) for level in LEVELS)
            lines.append((ground, f"{distance:g}", *cells, *found))
    heads = ("ground", "release [m]", "320 to 20", "others", "highest")
    return table((*heads, *(f"fraction ≥ {level:g}" for level in LEVELS)), lines)


def draw(rows: list[Row], to: Path) -> None:
    """Chances over longitude: a panel for each place of release and ground, a curve for each distance."""
    panels = [("anywhere", "e = 0.7"), *(("outside", f"e = {one:g}") for one in (0.5, 0.7, 0.8, 0.9))]
    with figure(to, 2, 3, (11.5, 6.4), dpi=110, sharex=True, sharey=True) as (drawn, axes):
        colours = dict(zip(DISTANCES, plt.get_cmap("viridis")(np.linspace(0.0, 0.85, len(DISTANCES))), strict=True))
        shown = (LONGITUDES + 180.0) % 360.0 - 180.0
        order = np.argsort(shown)
        for axis, (release, ground) in zip(axes.flat, [*panels, ("outside", UNKNOWN)], strict=True):
            axis.axvspan(PUBLISHED.begin - 360.0, PUBLISHED.end - 360.0, color=INK, alpha=0.08, lw=0.0)
            is_soil = ground == UNKNOWN
            for distance in SOIL_DISTANCES if is_soil else DISTANCES:
                found = values(rows, release, ground, distance, "at_rest" if is_soil else "reaches")
                axis.plot(shown[order], found[order], color=colours[distance], label=f"released at {distance:g} m")
            axis.set_title(f"{UNKNOWN}: at rest" if is_soil else f"{ground}, released {release}")
            axis.set_ylim(0.0, 1.03)
            axis.set_xticks(TICKS)
        for axis in axes[1]:
            axis.set_xlabel("longitude from the side away [deg east]")
        axes[0, 0].set_ylabel("chance to meet Dimorphos")
        axes[1, 0].set_ylabel("chance, or fraction at rest")
        drawn.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=len(DISTANCES))


def reliable_numbers(rows: list[Row], before: tuple[int, int]) -> dict[str, object]:
    """What the words of the page have of these sites; before: bands that agree at the best speed, and all."""
    outside, anywhere = bounded(rows, "outside"), bounded(rows, "anywhere")
    kept = read_document((HERE / TABLE).with_suffix(".json"))
    middles = [0.5 * (band.begin + band.end) % 360.0 for band in outside]
    first = {one: values(rows, "outside", f"e = {one:g}", DISTANCES[0], "reaches") > 0.0 for one in RESTITUTIONS}
    left = [f"{found.sum()} of {len(found)} for {one:g}" for one, found in first.items()]
    tops = [
        LONGITUDES[int(values(rows, "anywhere", f"e = {one:g}", distance, "reaches").argmax())]
        for one in RESTITUTIONS for distance in DISTANCES
    ]  # fmt: skip
    speeds = [row["speed_m_s"] for row in rows if row["ground"].startswith("e = ")]
    followed = (FOLLOWED[0], f"e = {FOLLOWED[1]:g}")
    both = [
        row["reaches"] - row["at_rest"] for row in rows
        if (row["release"], row["ground"]) == followed and row["reaches"] > 0.0
    ]  # fmt: skip
    means = np.array([
        [values(rows, "outside", ground, away, "at_rest")[inside()].mean() for away in SOIL_DISTANCES]
        for ground in GROUNDS
    ])  # fmt: skip
    return {
        "kinds_apart": f"{np.ptp(means, axis=0).max():.2f}",
        "releases_apart": f"{(means[-1, 0] - means[-1, -1]):.2f}",
        "definitions": definition_table(rows, before), "reliable": reliable_table(rows), "grounds": ground_table(rows),
        "outside": len(outside), "outside_agree": sum(one.agrees(PUBLISHED, BAR) for one in outside),
        "anywhere": len(anywhere), "anywhere_agree": sum(one.agrees(PUBLISHED, BAR) for one in anywhere),
        "near_middle": sum(off_middle(one) <= BAR for one in outside), "left": ", ".join(left),
        "middle_low": f"{min(middles):.0f}", "middle_high": f"{max(middles):.0f}",
        "facing": sum(90.0 < top < 270.0 for top in tops), "tops": len(tops),
        "slowest": f"{100.0 * min(speeds):.1f}", "fastest": f"{100.0 * max(speeds):.1f}",
        "l1": " to ".join(f"{100.0 * one:.1f}" for one in kept["closing_m_s"][1]),
        "l2": " to ".join(f"{100.0 * one:.1f}" for one in kept["closing_m_s"][0]),
        "rest_apart": f"{np.mean(both):.2f}", "rest_most": f"{max(both):.2f}",
        "soil_near": f"{SOIL_DISTANCES[0]:g}", "soil_far": f"{SOIL_DISTANCES[-1]:g}", "soil_repeats": NEAR,
        "followed": f"{FOLLOWED[1]:g}", "reliable_made": made(kept, f"{kept['cpu_s_of_rows']} s of CPU time"),
    }  # fmt: skip


def quantity(rows: list[Row]) -> Quantity:
    """The published band beside those of the published definitions: it agrees if more than half of them do."""
    found = bounded(rows, "outside")
    agree = sum(band.agrees(PUBLISHED, BAR) for band in found)
    here = f"{agree} of {len(found)} bands, over restitutions, releases and levels that are not published"
    return Quantity(
        CODE, "ends of the band of reliable longitudes on the equator [deg]", str(PUBLISHED), here, "",
        f"{BAR:g} deg, more than half of the bands", agree > 0.5 * len(found), "reliable_sites",
    )  # fmt: skip
