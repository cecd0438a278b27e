"""Write docs/validation/contact.md, and every assertion of the physical tests to contact_tests.csv, from a run of them.

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
from harness import ROOT, origin
from page import table, write_page

ROWS = Path(__file__).with_name("contact_rows.csv")
ALL = Path(__file__).with_name("contact_tests.csv")


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


def facts(notes: Notes) -> Iterator[tuple[str, list[str]]]:
    """Yield the part and the cells of each known result; raises KeyError where a row has lost a test.

    Sources: Chung and Ooi (2011), Granular Matter 13, 643-656, tests 1 to 7; the rest is derived, as the tests say.
    """
    names = {test: name_of(test) for test in notes.outcome}
    with ROWS.open(newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            tests = row["tests"].split()
            if missing := set(tests) - set(names.values()):
                raise KeyError(f"no test {', '.join(missing)}: {ROWS.name} names it")
            met = all(notes.outcome[test] == "passed" for test, name in names.items() if name in tests)
            tolerance = re.sub(r"^\.", "0.", row["tolerance"])
            cells = [row["what"], row["expected"], tolerance, measured(notes, tests), "yes" if met else "no"]
            yield row["part"], cells


def write_tests(notes: Notes) -> None:
    """Write the last few assertions of every test, since a loop may repeat one many times."""
    with ALL.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["file", "test", "about", "compared", "outcome"])
        for test, outcome in notes.outcome.items():
            compared = "; ".join(short(expl) for expl in dict(notes.found.get(test, [])).values())
            name = test.split("::")[1].removeprefix("test_").replace("_", " ")
            writer.writerow([Path(test.split("::")[0]).name, name, short(notes.about[test]), compared, outcome])


def write(notes: Notes) -> None:
    known, parts = list(facts(notes)), []
    for part in dict.fromkeys(part for part, _ in known):
        heads = ["what", "expected", "tolerance", "measured", "reproduced"]
        parts += [f"## {part}", table(heads, [cells for one, cells in known if one == part])]
    write_page(
        "contact", passed=sum(outcome == "passed" for outcome in notes.outcome.values()), count=len(notes.outcome),
        met=sum(cells[-1] == "yes" for _, cells in known), rows=len(known), known="\n\n".join(parts),
        python=platform.python_version(), **origin("validation/make_contact_table.py"),
    )  # fmt: skip


def main() -> None:
    notes = Notes()
    with tempfile.TemporaryDirectory() as folder:
        # Compiled tests without the hook may lie about; nothing is read from them, and none are left.
        sys.pycache_prefix = folder
        code = pytest.main(
            ["-q", "-p", "no:cacheprovider", "-o", "enable_assertion_pass_hook=true", "-o", "verbosity_assertions=2",
             str(ROOT / "tests" / "physics")],
            plugins=[notes],
        )  # fmt: skip
    write(notes)
    write_tests(notes)
    sys.exit(code)


if __name__ == "__main__":
    main()
