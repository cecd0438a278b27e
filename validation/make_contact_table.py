"""Write docs/validation/contact.md: every assertion of the physical tests with what it found, from a run of them.

python validation/make_contact_table.py
"""

import csv
import platform
import re
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from harness import PAGES, ROOT, origin

PAGE = PAGES / "contact.md"
ROWS = Path(__file__).with_name("contact_rows.csv")
NOT_TESTS = (
    "Measured are the left sides of the comparisons that the tests make, among them some that only make",
    "sure that what is meant to happen does. Compression, angle of repose, Froude scaling and packings",
    "are in [bulk.md](bulk.md), the distances of a million pairs in",
    "`benchmarks/results/fuzz_distance.txt`.",
)
SECTIONS = {
    "test_two_bodies.py": "Two bodies",
    "test_contact_law.py": "The contact law",
    "test_resistance_and_cohesion.py": "Rolling, spinning, cohesion",
    "test_faces.py": "Faces",
    "test_many_bodies.py": "Many bodies",
}


class Notes:
    """Collects, for every test, what its assertions compared."""

    def __init__(self) -> None:
        self.found: dict[str, list[tuple[str, str]]] = {}
        self.about: dict[str, str] = {}
        self.outcome: dict[str, str] = {}

    def pytest_assertion_pass(self, item: pytest.Item, orig: str, expl: str) -> None:
        """Note one assertion that held: as it is written, and with its values."""
        self.found.setdefault(item.nodeid, []).append((orig, expl.splitlines()[0]))

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Note whether a test passed."""
        if report.when == "call" or report.failed:
            self.outcome[report.nodeid] = report.outcome

    def pytest_itemcollected(self, item: pytest.Item) -> None:
        """Note what a test is about: the first sentence under its name."""
        text = (getattr(item, "obj", None).__doc__ or "").strip().split("\n\n")[0]
        self.about[item.nodeid] = " ".join(text.split())


def short(text: str) -> str:
    """Shorten an explanation: six digits, no types, no calls."""
    text = re.sub(r"np\.(float64|True_|False_)(\(([^()]*)\))?", lambda m: m[3] or m[1].strip("_"), text)
    text = re.sub(r"-?\d+\.\d{5,}(e[-+]?\d+)?", lambda m: f"{float(m[0]):.6g}", text)
    return text.replace("|", "/").replace("\n", " ")[:160]


def name_of(test: str) -> str:
    """Return the name of a test function from the identity of one of its runs."""
    return test.split("::")[1].split("[")[0].removeprefix("test_")


def measured(notes: Notes, tests: list[str]) -> str:
    """Return what the tests found: the left side of each comparison, or "holds"; ";" between parameters."""
    found = []
    for test in notes.outcome:
        if name_of(test) not in tests:
            continue
        values = []
        for expl in dict(notes.found.get(test, [])).values():
            compared = re.match(r"(abs\()?(-?[\d.]+(e[-+]?\d+)?)\)? (==|<=|<|>=|>) ", short(expl).lstrip("("))
            values.append(compared[2] if compared else "holds")
        found.append(", ".join(dict.fromkeys(values)))
    return "; ".join(dict.fromkeys(found))


def facts(notes: Notes) -> Iterator[str]:
    """Tables of what is asked, with what was measured; raises KeyError where a row has lost a test.

    Sources: Chung and Ooi (2011), Granular Matter 13, 643-656, tests 1 to 7; the rest is derived, as the tests say.
    """
    names = {test: name_of(test) for test in notes.outcome}
    part = ""
    with ROWS.open(newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            if row["part"] != part:
                part = row["part"]
                yield from (
                    "",
                    f"## {part}",
                    "",
                    "| what | expected | tolerance | measured | |",
                    "|---|---|---|---|---|",
                )
            tests = row["tests"].split()
            if missing := set(tests) - set(names.values()):
                raise KeyError(f"no test {', '.join(missing)}: {ROWS.name} names it")
            met = all(notes.outcome[test] == "passed" for test, name in names.items() if name in tests)
            cells = row["what"], row["expected"], row["tolerance"], measured(notes, tests), "met" if met else "not met"
            yield f"| {' | '.join(cells)} |"


def rows(notes: Notes, file: str) -> Iterator[str]:
    """Table lines of one file: the last few assertions of every test, since a loop may repeat one many times."""
    for test, outcome in notes.outcome.items():
        if f"/{file}::" not in f"/{test}":
            continue
        name = test.split("::")[1].removeprefix("test_").replace("_", " ")
        written = dict(notes.found.get(test, []))
        checks = "<br>".join(f"`{short(expl)}`" for expl in written.values())
        yield f"| {name.replace('|', '/')} | {short(notes.about[test])} | {checks} | {outcome} |"


def main() -> None:
    """Run the tests and write the page."""
    notes = Notes()
    with tempfile.TemporaryDirectory() as folder:
        # Compiled tests without the hook may lie about; nothing is read from them, and none are left.
        sys.pycache_prefix = folder
        code = pytest.main(
            ["-q", "-p", "no:cacheprovider", "-o", "enable_assertion_pass_hook=true", "-o", "verbosity_assertions=2",
             str(ROOT / "tests" / "physics")],
            plugins=[notes],
        )  # fmt: skip
    passed = sum(outcome == "passed" for outcome in notes.outcome.values())
    made = origin("validation/make_contact_table.py")
    lines = [
        "# What the contact physics reproduces",
        "",
        "First the facts that were set before the code was written, then every physical test with what its",
        "assertions compared: what was found, and the value and tolerance asked for. Where a test repeats an",
        'assertion, the last one stands here; "True" is a comparison of arrays that held.',
        f"Written by `{made['command']}`; do not edit.",
        "",
        f"{made['date']}, {made['machine']}, Python {platform.python_version()}: "
        f"{passed} of {len(notes.outcome)} passed.",
    ]
    lines += [*facts(notes), "", *NOT_TESTS]
    for file, title in SECTIONS.items():
        title = f"All tests: {title[0].lower()}{title[1:]}"
        lines += ["", f"## {title}", "", "| test | what it is | found, and asked | outcome |", "|---|---|---|---|"]
        lines += rows(notes, file)
    PAGE.write_text("\n".join(lines) + "\n", encoding="utf-8")
    sys.exit(code)


if __name__ == "__main__":
    main()
