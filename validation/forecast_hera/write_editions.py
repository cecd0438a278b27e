"""Write the pages of the forecast, docs/forecast_hera.md and docs/forecast_hera_editions.md, and the picture.

With an edition on unknown ground also its own page (write_unknown_ground.py).

    python validation/forecast_hera/write_editions.py

The last step of edition.py. The page of the first edition, docs/forecast_hera_2026_11_26.md, is not written again.
"""

import sys
import tomllib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[1]))
sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))

import numpy as np
import write_unknown_ground
from answers import FIRST_EDITION, FORECAST, HERE, digest
from assumptions import FIRST, UNKNOWN_GROUND
from branches import LANDERS
from changes import broad_sides, changes
from drawing import figure
from edition import EDITIONS, SUMS, assumed_landers, editions
from harness import Row, command_line, read_document, read_rows
from landers import KINDS, TABLE
from measurements import QUANTITIES, measurement_of
from page import table, write_page
from places import direction
from samples import BINS, FACES, GROUNDS
from write_page import DOCS, END_WORDS, SOIL, percent, plain

import lithobrake
from lithobrake.report.figures.style import INK, TRAINING

EXPECTED = "expected.toml"
# Of an outline: how often it passes one point where it is tangled, and how far the tangle reaches [deg].
REPEATED, TANGLE = 4, 20.0
Answers = dict[str, Any]
# What would speak against the forecast: a quantity, its first bin, and words.
CONTRADICTIONS = (
    ("time_min", 160.0, "160 min or more from the first contact to rest"),
    ("contacts", 9.0, "9 contacts or more until rest"),
    ("first_speed_ratio", 0.6, "first rebound with 0.6 of the impact speed or more"),
)
DIFFERENCES = {
    "at_rest": ("at rest [percentage points]", 100.0), "time_s": ("median time to rest [min]", 1.0 / 60.0),
    "broad_side": ("on a broad side [percentage points]", 100.0), "shift_m": ("shift of the mean place [m]", 1.0),
}  # fmt: skip
# The ground of the landers of an edition by its assumptions: in a table, and in a sentence of the first page.
GROUND_WORDS = {FIRST.name: "stones of 0.2 m", UNKNOWN_GROUND.name: "unknown: gravel, stones or rock"}
LANDINGS = {
    FIRST.name: "on rubble",
    UNKNOWN_GROUND.name: "on ground that has not been measured: gravel, stones up to 1 m, or bare rock",
}


def names_of(landers: Answers) -> list[str]:
    return [name.capitalize() for name in landers]


def between(one: dict[str, float], size: float) -> str:
    """A median, and the quantiles of 5 and 95 %."""
    median, lower, upper = (f"{one[key] / size:.0f}" for key in ("q50", "q05", "q95"))
    return f"{median} ({lower}-{upper})"


def probability_from(scored: dict[str, list[float]], name: str, least: float) -> float:
    """Of the bins of a quantity from a value upward, given rest."""
    return sum(scored[name][BINS[name].index(least) :])


def broad(landers: Answers, name: str) -> float:
    """Probability that one of the two largest faces is down, given rest."""
    return sum(landers[name]["soil"]["scored"]["face"][FACES.index(face)] for face in broad_sides(name))


def chances_table(landers: Answers) -> str:
    """Probabilities with intervals, and quantiles of the landers at rest."""
    soil, hard = ([landers[name][ground] for name in landers] for ground in GROUNDS)
    rows = [["**at rest on Dimorphos**", *(f"**{percent(of['ends']['at_rest'])}**" for of in soil)]]
    rows += [["at rest, if the ground were hard", *(percent(of["ends"]["at_rest"]) for of in hard)]]
    others = ("partner", "escaped", "under_way")
    shares = ("; ".join(f"{100 * of['ends'][end]['share']:.0f} %" for end in others) for of in soil)
    rows += [["; ".join(END_WORDS[end] for end in others), *shares]]
    for key, words, size in (
        ("time_s", "time from the first contact to rest [min]", 60.0),
        ("contacts", "contacts until rest", 1.0),
        ("distance", "distance from the aim point to rest [m]", 1.0),
    ):
        rows.append([f"{words}: median (5-95 %)", *(between(of["at_rest"][key], size) for of in soil)])
    sides = (f"{100 * broad(landers, name):.0f} %" for name in landers)
    return table(("", *names_of(landers)), [*rows, ["on one of the two broad sides", *sides]])


def contradictions_table(landers: Answers) -> str:
    rows = [
        [words, *(f"{100 * probability_from(landers[name][ground]['scored'], key, least):.0f} %"
                  for name in landers for ground in GROUNDS)]
        for key, least, words in CONTRADICTIONS
    ]  # fmt: skip
    heads = [f"{name}{', hard ground' if ground == 'hard' else ''}" for name in names_of(landers) for ground in GROUNDS]
    return table(("observation", *heads), rows)


def side_by_side(found: Sequence[tuple[str, Answers]]) -> str:
    """A row for each edition and lander."""
    rows = []
    for name in LANDERS:
        for date, document in found:
            of = document["landers"][name]["soil"]
            effective = document.get("effective", {}).get(name, {}).get("soil", of["landers"])
            region = of["regions"][0]
            area = f"{plain(region['area_m2'], 3)} ({plain(region['lower'], 3)}-{plain(region['upper'], 3)})"
            rows.append([
                name.capitalize(), date, GROUND_WORDS[assumptions_in(document)], f"{effective:.0f}",
                percent(of["ends"]["at_rest"]),
                median_of(of["at_rest"]["time_s"], 60.0), median_of(of["at_rest"]["distance"], 1.0), area,
                f"{100 * broad(document['landers'], name):.0f} %",
            ])  # fmt: skip
    heads = (
        "lander", "edition", "ground", "effective number of landers", "at rest", "median time to rest [min]",
        "median distance from the aim point [m]", "region of 50 % [m2]", "on a broad side",
    )  # fmt: skip
    return table(heads, rows)


def assumptions_in(document: Answers) -> str:
    """The name of the assumptions of an edition; the first one does not state it."""
    return str(document.get("assumptions", FIRST.name))


def against_table(found: Sequence[tuple[str, Answers]]) -> str:
    """What other assumptions changed, of each edition that has them."""
    rows = []
    for date, document in found:
        of = document.get("against", {})
        rows += [
            [
                name.capitalize(),
                date,
                of["edition"],
                *(difference(one[key], size) for key, (_, size) in DIFFERENCES.items()),
            ]
            for name, one in of.get("landers", {}).items()
        ]
    return table(("lander", "edition", "less that of", *(words for words, _ in DIFFERENCES.values())), rows)


def median_of(one: dict[str, float], size: float) -> str:
    value, lower, upper = (plain(one[key] / size) for key in ("q50", "median_lower", "median_upper"))
    return f"{value} ({lower}-{upper})"


def difference(one: dict[str, float], size: float) -> str:
    value, lower, upper = (f"{size * one[key]:+.1f}" for key in ("value", "lower", "upper"))
    return f"{value} ({lower} to {upper})"


def changes_table(found: Sequence[tuple[str, Row]], first: str) -> str:
    """What each measurement changed alone; first: words of the first column."""
    rows = []
    for date, one in found:
        number = f"{one['effective']:.0f}" if "effective" in one else ""
        said = [date, one["lander"].capitalize(), one["measurement"], number]
        if "note" in one:
            rows.append([*said, one["note"], *[""] * (len(DIFFERENCES) - 1)])
        else:
            rows.append([*said, *(difference(one[key], size) for key, (_, size) in DIFFERENCES.items())])
    heads = [first, "lander", "measurement", "effective number", *(words for words, _ in DIFFERENCES.values())]
    if not first:
        heads, rows = heads[1:], [row[1:] for row in rows]
    return table(heads, rows)


def expected_changes() -> list[tuple[str, Row]]:
    """What invented measurements would change."""
    given = tomllib.loads((HERE / EXPECTED).read_text(encoding="utf-8"))["measurement"]
    measurements = [measurement_of(one, f"{EXPECTED}, measurement {number}") for number, one in enumerate(given, 1)]
    rows = read_rows(FIRST_EDITION / TABLE, KINDS)
    return [("", row) for name in LANDERS for one in measurements for row in changes(rows, name, [one])]


def measured_part(found: Sequence[tuple[str, Answers]]) -> str:
    """Measurements of all editions, and what each changed; words where there are none."""
    listed = [(date, one) for date, document in found for one in document.get("measurements", [])]
    if not listed:
        return "No edition has a measurement yet: they stand on assumptions alone."
    sources = table(
        ("edition", "measurement", "published", "source"),
        [[date, one["words"], one["date"], one["source"]] for date, one in listed],
    )
    changed = [(date, row) for date, document in found for row in document.get("changes", [])]
    return f"{sources}\n\n{changes_table(changed, 'edition')}"


def basis(document: Answers) -> str:
    """What an edition stands on, in a sentence."""
    count = sum(one["used"] for one in document.get("measurements", []))
    if not count:
        return "No measurement by Hera is used yet."
    words = "One measurement replaces an assumption" if count == 1 else f"{count} measurements replace assumptions"
    return f"{words} ([which](forecast_hera_editions.md#measurements-and-what-each-changed))."


def quantities_table() -> str:
    rows = []
    for name, of in QUANTITIES.items():
        allowed = (
            ", ".join(of.names) if of.names else f"{of.lower:g} to {of.upper:g}".replace("e+0", "e").replace("e+", "e")
        )
        fresh = (
            "fresh landers" if of.key and of.column is None else "weights" if of.key or of.names else "recorded only"
        )
        rows.append([f"`{name}`", of.words, of.unit, allowed, "yes" if of.of_lander else "", fresh])
    return table(("quantity", "what it is", "unit", "allowed values or weights", "needs lander", "applied by"), rows)


def without_tangle(line: np.ndarray) -> np.ndarray:
    """A closed outline, latitude and longitude [deg], [count, 2], without its tangle about the far side of its map.

    Outlines are found on a flat map, whose rim is one point of the ball: an edge that meets the rim passes this point
    again and again. All within TANGLE of it becomes the point.
    """
    points, counts = np.unique(line, axis=0, return_counts=True)
    if counts.max() < REPEATED:
        return line
    rim = points[np.argmax(counts)]
    units = direction(*np.radians(line).T) @ direction(*np.radians(rim[:, None]))[0]
    far = np.flatnonzero(units < np.cos(np.radians(TANGLE)))
    # From behind the widest gap around to it.
    gaps = np.diff(far, append=far[0] + len(line))
    far = np.roll(far, -int(np.argmax(gaps)) - 1)
    return np.vstack([rim, line[far], rim])


def draw_places(rows: dict[str, list[Row]], landers: Answers, path: Path) -> None:
    """Places of rest on soil and the smallest region with half of them, a panel for each lander (equal area)."""
    with figure(path, 1, len(landers), (11.0, 3.1), sharey=True) as (_, axes):
        for ax, (name, of) in zip(axes, landers.items(), strict=True):
            for number, line in enumerate(of["soil"]["regions"][0]["outlines"]):
                latitude, longitude = without_tangle(np.array(line)).T
                # A line that crosses the date line is not drawn back over the whole map.
                longitude[1:][np.abs(np.diff(longitude)) > 180.0] = np.nan
                label = None if number else "smallest region with half of them"
                ax.plot(longitude, np.sin(np.radians(latitude)), color=INK, lw=1.6, label=label)
            own = [row for row in rows[name] if row["end"] == "at_rest"]
            weight = np.array([float(row["weight"]) for row in own])
            place = np.array([[float(row[f"{one}_deg"]) for one in ("longitude", "latitude")] for row in own]).T
            size = 9.0 * weight / weight.mean()
            ax.scatter(place[0], np.sin(np.radians(place[1])), s=size, color=SOIL, lw=0, label="places of rest")
            ax.plot([0.0, 180.0, -180.0], [0.0] * 3, "+", ms=11, mew=1.8, color=TRAINING, label="aim points")
            ticks = np.array([-90, -45, -20, 0, 20, 45, 90])
            ax.set_yticks(np.sin(np.radians(ticks)), [str(one) for one in ticks])
            ax.set_xticks(range(-180, 181, 90))
            ax.set(xlim=(-180, 180), ylim=(-1, 1), xlabel="east longitude [deg]; 0 faces Didymos")
            ax.grid(True)
            rest = of["soil"]["ends"]["at_rest"]
            ax.set_title(f"{name.capitalize()}: at rest with a probability of {100 * rest['share']:.0f} %")
        axes[0].set_ylabel("latitude [deg]")
        axes[0].legend(loc="lower left", bbox_to_anchor=(0.0, 1.12), ncols=3)


def write(folder: Path, docs: Path) -> None:
    """Write both pages and the picture, of the editions in a folder."""
    found = [(one.name, read_document(one / FORECAST)) for one in editions(folder)]
    date, document = found[-1]
    landers = document["landers"]
    words = dict.fromkeys(("weight", "end", "latitude_deg", "longitude_deg"), str)
    rows = {name: read_rows(folder / date / f"{name}_soil.csv", words, str) for name in landers}
    draw_places(rows, landers, docs / "forecast_hera.png")
    sums = {name: digest(folder / name / SUMS) for name, _ in found}
    write_page(
        "forecast_hera", docs, date=date, year=date[:4], chances=chances_table(landers), hash=sums[date],
        contradictions=contradictions_table(landers), basis=basis(document), version=lithobrake.__version__,
        landings=LANDINGS[assumptions_in(document)], left_out=write_unknown_ground.wings_words(),
    )  # fmt: skip
    hashes = table(("edition", "SHA-256 of its file SHA256SUMS"), [[name, f"`{one}`"] for name, one in sums.items()])
    write_page(
        "forecast_hera_editions", docs, editions=side_by_side(found), against=against_table(found),
        measured=measured_part(found),
        expected=changes_table(expected_changes(), ""), quantities=quantities_table(), hashes=hashes, date=date,
    )  # fmt: skip


def write_all(folder: Path, docs: Path) -> None:
    """Write these pages, and that of the newest edition on unknown ground, of the editions in a folder."""
    write(folder, docs)
    newest = assumed_landers(folder)
    if assumptions_in(read_document(newest / FORECAST)) == UNKNOWN_GROUND.name:
        write_unknown_ground.write(newest, docs)


def main() -> None:
    command_line(__doc__).parse_args()
    write_all(EDITIONS, DOCS)


if __name__ == "__main__":
    main()
