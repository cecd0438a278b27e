"""Write docs/validation/mascot.md and its figure from mascot.csv, beds.csv and mascot.json.

python validation/mascot/write_page.py
"""

import json
import sys
import textwrap
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
sys.path.append(str(Path(__file__).parents[1]))
from answers import BOUNCING, HERE, MEASURED, OBSERVED, answer, column, farther, ratio, rows_of, said
from draw import of_landers
from ground import BOULDER_BEDS, FLATTEST, GRAIN, GRAIN_BEDS, INDEX, coverage
from harness import PAGES, Row, read_rows
from mascot import SETTINGS
from page_text import broken
from page_words import TEXT

NAMES = {
    "time_s": "time to rest [s]", "contacts": "contacts", "path_m": "path [m]",
    "settled_s": "time until within 0.1 m of rest [s]",
}  # fmt: skip
UNITS = {"time_s": "s", "contacts": "contacts", "path_m": "m"}
BOULDERS = ("at the surface", "below the surface")
NONE, NOT_INSIDE = "none of the three", "outside"


def wrapped_item(text: str) -> str:
    """An item of a list in lines."""
    return textwrap.fill(text, 98, initial_indent="- ", subsequent_indent="  ")


def percent(share: float) -> str:
    """A share in percent."""
    return f"{100.0 * share:.0f} %"


def verdicts(settings: dict[str, list[Row]]) -> str:
    """The first list: what is inside the central 80 % of each setting, and what is not."""
    return "\n".join(wrapped_item(f"{head(name)} {verdict(settings[name])}") for name in (*BOULDERS, "grains alone"))


def head(setting: str) -> str:
    """The first contact of a setting, as the head of a list item."""
    return f"**{'First contact on ' + setting if setting == 'grains alone' else 'Boulder ' + setting}.**"


def verdict(rows: list[Row]) -> str:
    """Whether the landers of a setting have what was measured."""
    agree = {name: answer(column(rows, name), measured) for name, measured in MEASURED.items()}
    said_of = {name: f"{MEASURED[name]:g} {word}" for name, word in UNITS.items()}
    inside, outside, edge = (
        listed([said_of[name] for name, one in agree.items() if chosen(one)])
        for chosen in (lambda one: one.agrees, lambda one: not one.agrees, lambda one: one.is_open)
    )
    still = sum(row["end"] != "at rest" for row in rows)
    text = (
        f"MASCOT's {inside} {'lies' if sum(one.agrees for one in agree.values()) == 1 else 'lie'} in the central 80 %"
    )
    text += f" of {len(rows)} landers" + (f"; {outside} {NOT_INSIDE}. " if outside != NONE else ". ")
    if edge != NONE:
        text += f"For {edge} this is not certain: the 90 % interval of the fraction below it contains 0.1 or 0.9. "
    if not agree["time_s"].agrees or agree["time_s"].is_open:
        seen = answer(column(rows, "settled_s"), OBSERVED["settled_s"])
        text += (
            f"{percent(agree['time_s'].below)} of the landers come to rest within 663 s; {percent(seen.below)} are "
            "within 0.1 m of their place of rest by then. "
        )
    text += f"{still} landers still move after four hours. " if still else "All come to rest. "
    return text + (
        f"{percent(farther(rows))} are farther from the mean than MASCOT, by the Mahalanobis distance of the "
        "logarithms of the three numbers."
    )


def listed(words: list[str]) -> str:
    """Words as a list in a sentence."""
    if len(words) < 2:
        return "".join(words) or NONE
    return f"{', '.join(words[:-1])} and {words[-1]}"


def table_of_answers(settings: dict[str, list[Row]]) -> str:
    """Each quantity of each setting."""
    lines = [
        "| first contact | landers | quantity | MASCOT | here: median (central 80 %) "
        "| fraction below MASCOT (90 % interval) | in the central 80 % |",
        "|---|---|---|---|---|---|---|",
    ]
    for setting, rows in settings.items():
        for name, measured in (MEASURED | OBSERVED).items():
            one = answer(column(rows, name), measured)
            low, high = one.interval
            lines.append(
                f"| {setting} | {len(rows)} | {NAMES[name]} | {measured:g} | {said(one.middle)} ({said(one.low)} to "
                f"{said(one.high)}) | {one.below:.2f} ({low:.2f} to {high:.2f}) | {'yes' if one.agrees else 'no'} |"
            )
    return "\n".join(lines)


def table_of_bounces(settings: dict[str, list[Row]]) -> str:
    """The first contact of each setting, and what else the journeys were."""
    lines = [
        "| first contact | fraction that stays there | rebound / impact speed: median (80 %) | standard deviation "
        "| rebound elevation [deg] | distance [m]: median (80 %) | mean landings | fraction at rest within 105 min |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for setting, rows in settings.items():
        left = ratio(rows)
        low, middle, high = np.quantile(left, [0.1, 0.5, 0.9])
        distance = np.quantile(column(rows, "distance_m"), [0.1, 0.5, 0.9])
        lines.append(
            f"| {setting} | {1.0 - len(left) / len(rows):.2f} | {middle:.2f} ({low:.2f} to {high:.2f}) "
            f"| {left.std():.2f} | {np.nanmedian(column(rows, 'rebound_elevation_deg')):.0f} "
            f"| {distance[1]:.1f} ({distance[0]:.1f} to {distance[2]:.1f}) "
            f"| {column(rows, 'touchdowns').mean():.1f} | {np.mean(column(rows, 'time_s') < BOUNCING):.2f} |"
        )
    return "\n".join(lines)


def halves(rows: list[Row]) -> str:
    """The landers of a setting by halves of what may decide."""
    lines = ["| half of the landers | time to rest [s] | contacts | path [m] |", "|---|---|---|---|"]
    for name, words in (
        ("stands_out_m", "boulder stands out there by {} m"),
        ("boulder_m", "boulder of {} m"),
        ("restitution", "restitution {}"),
        ("friction", "friction {}"),
    ):
        values = column(rows, name)
        middle = float(np.median(values))
        for half, text in ((values <= middle, f"at most {middle:.2f}"), (values > middle, f"more than {middle:.2f}")):
            medians = (said(float(np.median(column(rows, key)[half]))) for key in MEASURED)
            lines.append(f"| {words.format(text)} | {' | '.join(medians)} |")
    return "\n".join(lines)


def readings(rows: list[Row]) -> str:
    """What other readings of the four contacts would say."""
    shares = [f"{count} ({answer(column(rows, 'contacts'), float(count)).below:.2f})" for count in (4, 5, 6)]
    return f"The fraction of landers at the surface below each count is: {', '.join(shares)}."


def stopped(rows: list[Row]) -> str:
    """Where the runs were stopped, and what fewer rows said: nobody may choose the number by what came out."""
    parts = []
    for count in range(20, len(rows), 20):
        one = answer(column(rows[:count], "time_s"), MEASURED["time_s"])
        parts.append(f"{one.below:.2f} of the first {count}")
    return (
        "150 landers with a boulder at the surface and 150 with one below it were planned. Computing time ended the "
        f"runs at the numbers in the table. To judge this choice: at the surface, {listed(parts)} landers come to "
        "rest within 663 s."
    )


def last_way(settings: dict[str, list[Row]]) -> str:
    """How long the last 0.1 m take."""
    times = []
    for setting in BOULDERS:
        low, middle, high = np.quantile(
            column(settings[setting], "time_s") - column(settings[setting], "settled_s"), [0.1, 0.5, 0.9]
        )
        times.append(f"{middle:.0f} s ({low:.0f} to {high:.0f}) {setting}")
    return f"The last 0.1 m and the 35 s take (median and central 80 %) {' and '.join(times)}."


def table_of_beds() -> str:
    """The beds, and how deep their boulders lie."""
    lines = [
        "| bed | boulder [m] | width [m] | grains | top under the grains: asked, found [m] |",
        "|---|---|---|---|---|",
    ]
    for row in read_rows(HERE / "beds.csv", {"kind": str}):
        cover = "-" if row["boulder_m"] == 0.0 else f"{row['cover_asked_m']:.2f}, {row['cover_m']:.2f}"
        boulder = "none" if row["boulder_m"] == 0.0 else f"{row['boulder_m']:.2f}"
        lines.append(
            f"| {row['kind']} {row['bed'] + 1:.0f} | {boulder} | {row['width_m']:.2f} | {row['grains']:.0f} | {cover} |"
        )
    return "\n".join(lines)


def thuillet(settings: dict[str, list[Row]]) -> str:
    """Whether a boulder raises speed ratio and scatter, more so near the surface."""
    found = {name: ratio(settings[name]) for name in ("grains alone", *reversed(BOULDERS))}
    medians = [float(np.median(one)) for one in found.values()]
    spreads = [float(one.std()) for one in found.values()]
    words = [
        f"{name} {middle:.2f} and {spread:.2f}" for name, middle, spread in zip(found, medians, spreads, strict=True)
    ]
    rises = medians == sorted(medians), spreads == sorted(spreads)
    words_of = {
        (True, True): "The landers here show both",
        (True, False): "The landers here show it for the ratio, not for the scatter",
        (False, True): "The landers here show it for the scatter, not for the ratio",
        (False, False): "The landers here show neither",
    }
    return (
        "[Thuillet-2021] found that a boulder in the bed raises the speed ratio and its scatter, more so near the "
        f"surface. {words_of[rises]}: median and standard deviation of those that leave are {'; '.join(words)}."
    )


def main() -> None:
    """Write the page."""
    settings = {name: rows_of(name) for name in SETTINGS}
    of_landers(settings, PAGES / "mascot.png")
    kept = json.loads((HERE / "mascot.json").read_text())
    surface = settings["at the surface"]
    page = TEXT.format(
        first=verdicts(settings), answers=table_of_answers(settings), bounces=table_of_bounces(settings),
        thuillet=thuillet(settings), halves=halves(surface),
        stopped=stopped(surface), last=last_way(settings), readings=readings(surface), beds=table_of_beds(),
        index=f"{INDEX:g}", flattest=f"{FLATTEST:g}", fewest=percent(coverage(FLATTEST)),
        most=percent(coverage(INDEX)), boulder_beds=BOULDER_BEDS, grain_beds=GRAIN_BEDS,
        grain=f"{GRAIN[0]:g} to {GRAIN[1]:g}", exponent=f"{0.5 * (INDEX + FLATTEST):g}",
        made=(
            f"The landers: `{kept['command']}`, {kept['date']}, {kept['machine']}, one thread, load "
            f"{kept['load']:.0f}; {kept['cpu_s_of_rows']:.0f} s of CPU time for {sum(map(len, settings.values()))} "
            "landers, without the beds."
        ),
    )  # fmt: skip
    (PAGES / "mascot.md").write_text(broken(page) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
