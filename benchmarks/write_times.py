"""Write the table of times of docs/performance.md, between its two marks, from what other scripts have measured.

python benchmarks/write_times.py
"""

from harness import RESULTS, ROOT, read_document, read_rows
from page import table, two_digits

PAGE = ROOT / "docs" / "performance.md"
MARKS = ("<!-- Made by benchmarks/write_times.py. -->\n\n", "\n\n<!-- Here its table ends. -->")
# Studies of showcase/ that ran as a whole: what was run, the grains of each of their beds, and the file of their times.
# That of the paper was run again from nothing, on another bed than the one that is kept.
STUDIES = {
    "mission": ("`scenarios/mission.toml`", "96 grains", "showcase/mission/origin.json"),
    "first_bounce": ("`scenarios/first_bounce.toml`", "96 grains", "showcase/first_bounce/origin.json"),
    "drawn_700": ("`validation/studies/drawn_700.toml`", "400 grains", "showcase/drawn_700/origin.json"),
    "paper": ("`scenarios/paper.toml`", "1500 grains", "validation/paper_study_again.json"),
}
Row = list[str]


def seconds(value: float) -> str:
    return f"{two_digits(value)} s"


def study(name: str) -> Row:
    """A study of showcase/: its landings, its beds, and its time on a machine that others used too."""
    folder, (words, grains, times) = ROOT / "showcase" / name, STUDIES[name]
    made, results = read_document(ROOT / times), read_document(folder / "summary.json")["results"]
    landings = len({row["key"] for path in folder.glob("runs/*.csv") for row in read_rows(path, {}, others=str)})
    beds = f"{len(results['beds'])} beds" if len(results["beds"]) > 1 else "one bed"
    journeys = f"{results['journeys']} journeys, " if landings > results["journeys"] > 0 else ""
    clock = f"{two_digits(made['wall_s'] / 60.0)} min (load {made['load']:.0f})"
    return [words, f"{journeys}{landings} landings, {beds} of {grains}", seconds(made["cpu_s"]), clock]


def beds() -> list[Row]:
    """One pour of each kind of bed."""
    kinds = {
        "tile": "96 grains, ground that repeats", "quick": "150 grains between walls",
        "paper": "1500 grains between walls",
    }  # fmt: skip
    found = {name: read_document(RESULTS / f"pour_speed_{name}.json") for name in kinds}
    return [["", size, seconds(found[name]["cpu_s"]["new"] / found[name]["pours"]), ""] for name, size in kinds.items()]


def landings() -> list[Row]:
    plans = read_document(ROOT / "benchmarks" / "plan_estimate.json")
    of_plans = {name: {one["held_speed"]: one["cpu_s"] for one in plans[name]["result"]["landings"]}
                for name in ("first_bounce", "drawn_700")}  # fmt: skip
    slow = read_document(RESULTS / "slow_landings.json")
    (fine,) = (one for one in read_document(RESULTS / "fine_grains_resolved.json")["landings"]
               if one["held_speed"] == 0.03)  # fmt: skip
    return [
        ["", "96 grains, 0.4 m/s", seconds(of_plans["first_bounce"][0.0]), ""],
        ["", "96 grains, 3 to 20 mm/s, to rest or rebound", seconds(slow["ways"]["25:0.3:0"]["cpu_s_mean"]), ""],
        ["", "400 grains, 0.42 m/s (`held_speed` 0.03)", seconds(of_plans["drawn_700"][0.03]), ""],
        ["", "10 800 grains (`held_speed` 0.03)", seconds(fine["cpu_s"]), ""],
    ]


def flights() -> list[Row]:
    rows = read_document(ROOT / "benchmarks" / "flight_speed.json")["rows"]
    cpu_s = {row["gravity"]: row["cpu_s"] for row in rows if row.get("partner") and row["flights"] == 100_000}
    return [
        ["", "100 000 of up to 12 h, gravity from a table, with partner", seconds(cpu_s["table"]), ""],
        ["", "100 000, gravity summed over 1920 facets, with partner", seconds(cpu_s["exact"]), ""],
    ]


def fits() -> list[Row]:
    rows = read_rows(RESULTS / "emulator_peers.csv", {}, others=str)
    costs = [float(row["fit_cpu_s"]) for row in rows if (row["method"], row["runs"]) == ("fit", "300")]
    return [["", "fit to 300 landings", f"{two_digits(min(costs))} to {seconds(max(costs))}", ""]]


def starts() -> list[Row]:
    """The first start on a machine, and the same command again."""
    pieces = read_document(RESULTS / "first_answer.json")["pieces"]

    def row(words: str, piece: str, cache: str) -> Row:
        new = pieces[piece][cache]["new"]
        return ["", words, seconds(new["cpu_s"]), seconds(new["clock_s"])]

    return [
        row("kernels of the engine compiled, once per machine, on two cores", "steps", "empty"),
        row("`lithobrake land scenarios/first_bounce.toml` from empty caches", "land", "empty"),
        row("the same with kernels and bed on disk", "land", "filled"),
    ]


def times() -> str:
    """The table of times."""
    parts = {
        "One bed, poured and settled": beds(), "One landing": landings(), "Flights": flights(), "Emulator": fits(),
        "First start": starts(),
    }  # fmt: skip
    rows = [study(name) for name in STUDIES]
    for name, own in parts.items():
        rows += [[f"**{name}**", *own[0][1:]], *own[1:]]
    return table(["what", "problem size", "CPU time", "on the clock"], rows)


def page() -> str:
    """docs/performance.md with this table."""
    before, rest = PAGE.read_text(encoding="utf-8").split(MARKS[0])
    return before + MARKS[0] + times() + MARKS[1] + rest.split(MARKS[1])[1]


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
