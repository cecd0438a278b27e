"""Write docs/validation/mascot.md and its figure from mascot.csv, beds.csv and mascot.json.

python validation/mascot/write_page.py
"""

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from answers import BOUNCING, HERE, MEASURED, OBSERVED, TAILS, answer, column, farther, ratio, rows_of, said
from drawing import figure
from ground import BOULDER_BEDS, FLATTEST, GRAIN, GRAIN_BEDS, INDEX, coverage
from harness import PAGES, Row, read_document, read_rows
from mascot import SETTINGS
from page import made, table, write_page, yes

from lithobrake.report.figures.style import INK, INPUT_COLOURS, WASH

NAMES = {
    "time_s": "time to rest [s]", "contacts": "contacts", "path_m": "path [m]",
    "settled_s": "time until within 0.1 m of rest [s]",
}  # fmt: skip
UNITS = {"time_s": "s", "contacts": "contacts", "path_m": "m"}
BOULDERS = ("at the surface", "below the surface")
LINES = ("-", "--", "-.", ":")
WORDS = {
    "time_s": "time from the first contact to rest [s]", "contacts": "contacts, the first included",
    "path_m": "path [m]",
}  # fmt: skip
NONE, NOT_INSIDE = "none of the three", "outside"


def percent(share: float) -> str:
    return f"{100.0 * share:.0f} %"


def verdicts(settings: dict[str, list[Row]]) -> str:
    """The first list: what is inside the central 80 % of each setting, and what is not."""
    return "\n".join(f"- {head(name)} {verdict(settings[name])}" for name in (*BOULDERS, "grains alone"))


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
    if len(words) < 2:
        return "".join(words) or NONE
    return f"{', '.join(words[:-1])} and {words[-1]}"


def table_of_answers(settings: dict[str, list[Row]]) -> str:
    lines = []
    for setting, rows in settings.items():
        for name, measured in (MEASURED | OBSERVED).items():
            one = answer(column(rows, name), measured)
            low, high = one.interval
            lines.append((
                setting, str(len(rows)), NAMES[name], f"{measured:g}",
                f"{said(one.middle)} ({said(one.low)} to {said(one.high)})",
                f"{one.below:.2f} ({low:.2f} to {high:.2f})", yes(one.agrees),
            ))  # fmt: skip
    heads = ("first contact", "landers", "quantity", "MASCOT", "here: median (central 80 %)",
             "fraction below MASCOT (90 % interval)", "in the central 80 %")  # fmt: skip
    return table(heads, lines)


def table_of_bounces(settings: dict[str, list[Row]]) -> str:
    """The first contact of each setting, and what else the journeys were."""
    lines = []
    for setting, rows in settings.items():
        left = ratio(rows)
        low, middle, high = np.quantile(left, [0.1, 0.5, 0.9])
        distance = np.quantile(column(rows, "distance_m"), [0.1, 0.5, 0.9])
        lines.append((
            setting, f"{1.0 - len(left) / len(rows):.2f}", f"{middle:.2f} ({low:.2f} to {high:.2f})",
            f"{left.std():.2f}", f"{np.nanmedian(column(rows, 'rebound_elevation_deg')):.0f}",
            f"{distance[1]:.1f} ({distance[0]:.1f} to {distance[2]:.1f})",
            f"{column(rows, 'touchdowns').mean():.1f}", f"{np.mean(column(rows, 'time_s') < BOUNCING):.2f}",
        ))  # fmt: skip
    heads = ("first contact", "fraction that stays there", "rebound / impact speed: median (80 %)",
             "standard deviation", "rebound elevation [deg]", "distance [m]: median (80 %)", "mean landings",
             "fraction at rest within 105 min")  # fmt: skip
    return table(heads, lines)


def halves(rows: list[Row]) -> str:
    """The landers of a setting by halves of what may decide."""
    lines = []
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
            lines.append((words.format(text), *medians))
    return table(("half of the landers", "time to rest [s]", "contacts", "path [m]"), lines)


def readings(rows: list[Row]) -> str:
    """What other readings of the four contacts would say."""
    contacts = column(rows, "contacts")
    return ", ".join(f"{count} ({answer(contacts, float(count)).below:.2f})" for count in (4, 5, 6))


def stopped(rows: list[Row]) -> str:
    """What fewer rows said: nobody may choose the number of landers by what came out."""
    counts = range(20, len(rows), 20)
    found = [answer(column(rows[:count], "time_s"), MEASURED["time_s"]).below for count in counts]
    return listed([f"{below:.2f} of the first {count}" for below, count in zip(found, counts, strict=True)])


def last_way(settings: dict[str, list[Row]]) -> str:
    """How long the last 0.1 m take."""
    times = []
    for setting in BOULDERS:
        rows = settings[setting]
        low, middle, high = np.quantile(column(rows, "time_s") - column(rows, "settled_s"), [0.1, 0.5, 0.9])
        times.append(f"{middle:.0f} s ({low:.0f} to {high:.0f}) {setting}")
    return " and ".join(times)


def table_of_beds() -> str:
    """The beds, and how deep their boulders lie."""
    lines = []
    for row in read_rows(HERE / "beds.csv", {"kind": str}):
        cover = "-" if row["boulder_m"] == 0.0 else f"{row['cover_asked_m']:.2f}, {row['cover_m']:.2f}"
        boulder = "none" if row["boulder_m"] == 0.0 else f"{row['boulder_m']:.2f}"
        sizes = f"{row['width_m']:.2f}", f"{row['grains']:.0f}"
        lines.append((f"{row['kind']} {row['bed'] + 1:.0f}", boulder, *sizes, cover))
    return table(("bed", "boulder [m]", "width [m]", "grains", "top under the grains: asked, found [m]"), lines)


def thuillet(settings: dict[str, list[Row]]) -> str:
    """Whether a boulder raises speed ratio and scatter, more so near the surface."""
    found = {name: ratio(settings[name]) for name in ("grains alone", *reversed(BOULDERS))}
    medians, spreads = ([float(of(one)) for one in found.values()] for of in (np.median, np.std))
    both = zip(found, medians, spreads, strict=True)
    words = "; ".join(f"{name} {middle:.2f} and {spread:.2f}" for name, middle, spread in both)
    shown = {
        (True, True): "both", (True, False): "it for the ratio, not for the scatter",
        (False, True): "it for the scatter, not for the ratio", (False, False): "neither",
    }[medians == sorted(medians), spreads == sorted(spreads)]  # fmt: skip
    return f"{shown}: median and standard deviation of those that leave are {words}."


def of_landers(settings: dict[str, list[Row]], to: Path) -> None:
    """Distribution functions of the three quantities, with the central 80 % of each marked, and MASCOT."""
    with figure(to, 1, 3, (9.2, 3.7), sharey=True) as (drawn, axes):
        for axis, (name, measured) in zip(axes, MEASURED.items(), strict=True):
            axis.axhspan(*TAILS, color=WASH, zorder=0)
            for ink, line, (setting, rows) in zip(INPUT_COLOURS, LINES, settings.items(), strict=False):
                values = np.sort(column(rows, name))
                part = (np.arange(len(values)) + 1.0) / len(values)
                axis.step(values, part, line, where="post", color=ink, label=f"{setting} ({len(values)})")
            axis.axvline(measured, color=INK, lw=1.0, label="MASCOT")
            most = max(float(np.quantile(column(rows, name), 0.98)) for rows in settings.values())
            axis.set(xlabel=WORDS[name], xlim=(0.0, max(most, 1.2 * measured)), ylim=(0.0, 1.0))
        axes[0].set(ylabel="share of the landers")
        handles, labels = axes[0].get_legend_handles_labels()
        title = {"title": "first contact (landers)", "title_fontsize": 8}
        drawn.legend(handles, labels, loc="outside lower center", ncols=5, **title)


def main() -> None:
    settings = {name: rows_of(name) for name in SETTINGS}
    of_landers(settings, PAGES / "mascot.png")
    kept, surface = read_document(HERE / "mascot.json"), settings["at the surface"]
    load = f"load {kept['load']:.0f}"
    cost = f"{kept['cpu_s_of_rows']:.0f} s of CPU time for {sum(map(len, settings.values()))} landers"
    write_page(
        "mascot", first=verdicts(settings), answers=table_of_answers(settings), bounces=table_of_bounces(settings),
        thuillet=thuillet(settings), halves=halves(surface), stopped=stopped(surface), last=last_way(settings),
        readings=readings(surface), beds=table_of_beds(), index=f"{INDEX:g}", flattest=f"{FLATTEST:g}",
        fewest=percent(coverage(FLATTEST)), most=percent(coverage(INDEX)), boulder_beds=BOULDER_BEDS,
        grain_beds=GRAIN_BEDS, grain=f"{GRAIN[0]:g} to {GRAIN[1]:g}", exponent=f"{0.5 * (INDEX + FLATTEST):g}",
        made=f"The landers: {made(kept, 'one thread', load)}; {cost}, without the beds.",
    )  # fmt: skip


if __name__ == "__main__":
    main()
