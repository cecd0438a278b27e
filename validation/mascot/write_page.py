"""Write docs/validation/mascot.md and its figure from mascot.csv, beds.csv and mascot.json.

python validation/mascot/write_page.py
"""

import json
import sys
import textwrap
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from answers import BOUNCING, HERE, MEASURED, OBSERVED, answer, column, farther, ratio, rows_of, said
from draw import of_landers
from ground import BOULDER_BEDS, FLATTEST, GRAIN, GRAIN_BEDS, INDEX, coverage
from harness import PAGES, Row, read_rows
from mascot import SETTINGS
from page_text import TEXT

NAMES = {
    "time_s": "time to rest [s]", "contacts": "contacts", "path_m": "path [m]",
    "settled_s": "time until within 0.1 m of rest [s]",
}  # fmt: skip
UNITS = {"time_s": "s", "contacts": "contacts", "path_m": "m"}
BOULDERS = ("at the surface", "below the surface")


def wrapped(text: str) -> str:
    """A paragraph in lines."""
    return "\n".join(textwrap.wrap(text, 98))


def percent(share: float) -> str:
    """A share in percent."""
    return f"{100.0 * share:.0f} %"


def verdicts(settings: dict[str, list[Row]]) -> str:
    """The first sentences: what is inside the central 80 %, and what is not."""
    sentences = []
    for setting in BOULDERS:
        rows = settings[setting]
        agree = {name: answer(column(rows, name), measured) for name, measured in MEASURED.items()}
        inside = [f"{MEASURED[name]:g} {word}" for name, word in UNITS.items() if agree[name].agrees]
        outside = [f"{MEASURED[name]:g} {word}" for name, word in UNITS.items() if not agree[name].agrees]
        moving = sum(row["end"] != "at rest" for row in rows)
        end = f"{moving} still move after four hours" if moving else "none is lost"
        text = (
            f"First contact on a boulder {setting}: {len(rows) - moving} of {len(rows)} landers come to rest, {end}. "
        )
        text += f"{listed(inside)} {'lie' if len(inside) > 1 else 'lies'} in the central 80 % of what they give"
        text += f"; {listed(outside)} {'do' if len(outside) > 1 else 'does'} not. " if outside else ". "
        edge = [f"{MEASURED[name]:g} {word}" for name, word in UNITS.items() if agree[name].is_open]
        if edge:
            text += f"For {listed(edge)} more landers may change this, as the table's interval holds a limit. "
        if not agree["time_s"].agrees or agree["time_s"].is_open:
            seen = answer(column(rows, "settled_s"), OBSERVED["settled_s"])
            text += (
                f"{percent(agree['time_s'].below)} of the landers need less than 663 s until they rest; "
                f"{percent(seen.below)} until they stay within 0.1 m of that place, which is how well MASCOT's path is "
                "known. "
            )
        sentences.append(
            f"{text}{percent(farther(rows))} of the landers are farther from the middle in all three together."
        )
    return " ".join([*sentences, on_grains(settings["grains alone"])])


def on_grains(rows: list[Row]) -> str:
    """What landers without any boulder say."""
    inside = [f"{MEASURED[name]:g} {word}" for name, word in UNITS.items()
              if answer(column(rows, name), MEASURED[name]).agrees]  # fmt: skip
    edge = [f"{MEASURED[name]:g} {word}" for name, word in UNITS.items()
            if answer(column(rows, name), MEASURED[name]).is_open]  # fmt: skip
    which = "all three" if len(inside) == len(UNITS) else listed(inside)
    verb = "is" if len(inside) == 1 else "are"
    few = f", {listed(edge)} so near to a limit that more landers may change it" if edge else ""
    return f"On grains alone, without a boulder, {which} {verb} inside ({len(rows)} landers{few})."


def listed(words: list[str]) -> str:
    """Words as a list in a sentence."""
    if len(words) < 2:
        return "".join(words) or "none of the three"
    return f"{', '.join(words[:-1])} and {words[-1]}"


def table_of_answers(settings: dict[str, list[Row]]) -> str:
    """Each quantity of each setting."""
    lines = [
        "| first contact | landers | quantity | MASCOT | ours: median (80 %) | below MASCOT, 90 % interval | inside |",
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
        "| first contact | stays there | speed after over before: median (80 %) | sd | elevation [deg] "
        "| distance [m] | landings | under 105 min |",
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
    return wrapped(
        'The source says "four intermediate surface contacts" after the first. With the first counted, and with the '
        "one in which it settles, these are five or six. The part of the landers at the surface below each: "
        f"{', '.join(shares)}."
    )


def stopped(rows: list[Row]) -> str:
    """Where the runs were stopped, and what fewer rows said: nobody may choose the number by what came out."""
    parts = []
    for count in range(20, len(rows), 20):
        one = answer(column(rows[:count], "time_s"), MEASURED["time_s"])
        parts.append(f"{one.below:.2f} of the first {count}")
    return wrapped(
        "150 landers with a boulder at and below the surface each were planned; the time for the runs ended them at "
        f"the numbers in the table. So that this end can be judged: at the surface {listed(parts)} landers rest within "
        "663 s."
    )


def last_way(settings: dict[str, list[Row]]) -> str:
    """How long the last 0.1 m take."""
    times = []
    for setting in BOULDERS:
        low, middle, high = np.quantile(
            column(settings[setting], "time_s") - column(settings[setting], "settled_s"), [0.1, 0.5, 0.9]
        )
        times.append(f"{middle:.0f} s ({low:.0f} to {high:.0f}) {setting}")
    return wrapped(f"The last 0.1 m and the 35 s take, in the median and the central 80 %, {' and '.join(times)}.")


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
        (True, True): "so it is here",
        (True, False): "the ratio does so here, the scatter does not",
        (False, True): "the scatter does so here, the ratio does not",
        (False, False): "neither is so here",
    }
    return wrapped(
        "[Thuillet-2021]: a boulder in the bed raises the ratio of speeds and its scatter, more so nearer to the "
        f"surface. Median and standard deviation of those that leave: {', '.join(words)}; {words_of[rises]}."
    )


def main() -> None:
    """Write the page."""
    settings = {name: rows_of(name) for name in SETTINGS}
    of_landers(settings, PAGES / "mascot.png")
    told = json.loads((HERE / "mascot.json").read_text())
    surface = settings["at the surface"]
    page = TEXT.format(
        first=wrapped(verdicts(settings)), answers=table_of_answers(settings), bounces=table_of_bounces(settings),
        thuillet=thuillet(settings), halves=halves(surface),
        stopped=stopped(surface), last=last_way(settings), readings=readings(surface), beds=table_of_beds(),
        index=f"{INDEX:g}", flattest=f"{FLATTEST:g}", fewest=percent(coverage(FLATTEST)),
        most=percent(coverage(INDEX)), boulder_beds=BOULDER_BEDS, grain_beds=GRAIN_BEDS,
        grain=f"{GRAIN[0]:g} to {GRAIN[1]:g}", exponent=f"{0.5 * (INDEX + FLATTEST):g}",
        made=wrapped(
            f"`{told['command']}`, {told['date']}, {told['machine']}, one thread, load {told['load']:.0f}; "
            f"{told['cpu_s_of_rows']:.0f} s of CPU time in the rows of {sum(map(len, settings.values()))} landers, "
            "without the beds."
        ),
    )  # fmt: skip
    (PAGES / "mascot.md").write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main()
