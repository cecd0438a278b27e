"""Write docs/validation/emulator_peers.md from what benchmarks/emulator_peers.py has measured.

python benchmarks/emulator_peers_page.py
"""

import statistics
import sys
from collections.abc import Sequence
from pathlib import Path

from emulator_peers import ANY_RUN, EXPANSION, KINDS, OWN, TABLE
from emulator_rivals import RIVALS
from emulator_truths import PUBLISHED, TRUTHS
from harness import PAGES, Row, read_rows

sys.path.append(str(Path(__file__).parents[1] / "validation"))
from page_text import broken, table

PAGE = PAGES / "emulator_peers.md"
# Hilscher (2024), master's thesis with code, file error.txt: of degree 5, median of ten designs.
PUBLISHED_SPCE = {("bimodal", 400): 0.0201, ("bimodal", 800): 0.0149, ("bimodal", 1600): 0.0077}
PUBLISHED_PROCESS = {("bimodal", 400): 0.068, ("bimodal", 800): 0.065, ("bimodal", 1600): 0.063}
HEADS = {
    OWN: "`fit`", "near rows": "near runs", "process and residuals": "Gaussian process", "forest rows": "forest",
    "Gaussian mixture": "mixture", EXPANSION: "`fit_stochastic_expansion`", ANY_RUN: "any run",
}  # fmt: skip
BEGIN = """\
# Emulators compared with alternatives

How accurate is the emulator compared with other methods fitted to the same runs?

On eight known distributions with 150 and 300 runs, `fit` has the smallest error in {best} of {count} cases. Its error
is {least} to {most} times that of resampling the runs without regard to the inputs ("any run").

`emulator.fit` estimates the conditional distribution of a stochastic model from runs ([Emulators](../emulator.md)). The
alternatives use scikit-learn:

- **near runs**: resampling of the k nearest runs; k has the lowest energy score on held-out groups;
- **Gaussian process**: its mean, with a length scale for each input, plus its leave-one-out residuals;
- **forest**: resampling of runs by how often they share a leaf of five runs with the point;
- **mixture**: a Gaussian mixture of inputs and outputs; BIC chooses the number of components.

## Eight known distributions

`benchmarks/emulator_truths.py` defines them. Runs come in groups of ten that share a small effect. The table lists the
energy distance between the emulated and the true distribution of the outputs, at 60 new inputs (200 samples each,
without bias), divided by that of resampling any of the runs. 0 means equal to the truth; 1 means that the inputs are
not used. Values are means over {seeds} seeds, with the standard error for `fit` in brackets. The best of a row is bold.

"""
PUBLISHED_TEXT = """
For "capture in a ring", the root mean square error of the probability of capture over 500 inputs, with 150 and 300
runs,
is: {captures}.

## Published cases

The cases are the bimodal one of [Zhu-2023] and geometric Brownian motion (with `lower=0`), on Latin hypercubes without
repeats. The table lists the mean over 200 inputs of the squared Wasserstein distance, divided by the variance of the
output (1000 levels, 4000 samples). Values are the median (worst) of {rivals} seeds; for the first two methods on the
bimodal case, of {seeds}.

"""
SIR_TEXT = """
"Published" values are those of a Python implementation of stochastic expansions of degree 5 and of a Gaussian process,
from the files of Hilscher's thesis (2024). They are medians of ten designs of that work. Its worst expansions had
0.038,
3.8 and 0.12.

The next table has the same distance for UQLab's stochastic SIR model: 500 runs without repeats and 100 validation
points
of 10 000 runs (`StochasticSIR/SIR2d.mat` of UQLab 2.1, not part of this repository).

"""
END = """
## Limits

The eight distributions were chosen for this benchmark and have up to twelve inputs. The published values were not
computed again.

## Reproduce this page

`python benchmarks/emulator_peers.py` computes the rows and `python benchmarks/emulator_peers_page.py` writes the page.
A
fit of `fit` to 300 runs takes {least:.1f} to {most:.1f} s of CPU time, one thread.
"""


def mean_error(rows: Sequence[Row]) -> tuple[float, float]:
    """Mean of the errors, and its standard error."""
    errors = [row["error"] for row in rows]
    spread = statistics.stdev(errors) / len(errors) ** 0.5 if len(errors) > 1 else 0.0
    return statistics.mean(errors), spread


def truth_table(rows: list[Row]) -> str:
    """A row for each truth and number of runs, a column for each method."""
    methods, lines = [OWN, *RIVALS], []
    for name in TRUTHS:
        for runs in (150, 300):
            own = [row for row in rows if row["case"] == name and row["runs"] == runs]
            found = {method: [row for row in own if row["method"] == method] for method in methods}
            if not all(found.values()):
                continue
            means = {method: mean_error(of_method) for method, of_method in found.items()}
            best = min(mean for mean, _ in means.values())
            cells = [f"**{mean:.2g}**" if mean == best else f"{mean:.2g}" for mean, _ in means.values()]
            cells[0] += f" ({means[OWN][1]:.1g})"
            lines.append([name, str(runs), *cells])
    return table(["distribution", "runs", *(HEADS[method] for method in methods)], lines)


def summary(rows: list[Row]) -> dict[str, str | int]:
    """In how many cases `fit` is best, of how many, and the least and largest of its mean errors."""
    cases = [(name, runs) for name in TRUTHS for runs in (150, 300)]
    means = [
        {method: mean_error(of)[0] for method in (OWN, *RIVALS)
         if (of := [row for row in rows if (row["case"], row["runs"], row["method"]) == (*case, method)])}
        for case in cases
    ]  # fmt: skip
    known = [one for one in means if len(one) == 1 + len(RIVALS)]
    own = [one[OWN] for one in known]
    best = sum(one[OWN] == min(one.values()) for one in known)
    return {"best": best, "count": len(known), "least": f"{min(own):.2g}", "most": f"{max(own):.2g}"}


def published_table(rows: list[Row]) -> str:
    """A row for each published case and number of runs."""
    methods, lines = [OWN, EXPANSION, *RIVALS, ANY_RUN], []
    for case, runs in sorted({(row["case"], row["runs"]) for row in rows if row["case"] in PUBLISHED}):
        cells = []
        for method in methods:
            errors = [row["error"] for row in rows if (row["case"], row["runs"], row["method"]) == (case, runs, method)]
            cells.append(f"{statistics.median(errors):.2g} ({max(errors):.2g})" if errors else "")
        known = [f"{of[case, runs]:.2g}" if (case, runs) in of else "" for of in (PUBLISHED_SPCE, PUBLISHED_PROCESS)]
        lines.append([case, str(runs), *cells, *known])
    heads = [HEADS[method] for method in methods]
    return table(["case", "runs", *heads, "published expansion", "published process"], lines)


def sir_table(rows: list[Row]) -> str:
    """A row for each method, without and with the bound."""
    lines = []
    for method, head in HEADS.items():
        errors = [
            [row["error"] for row in rows if (row["case"], row["method"]) == (case, method)] for case in SIR_CASES
        ]
        if any(errors):
            lines.append([head, *(f"{one[0]:.2g}" if one else "" for one in errors)])
    return table(["method", "no bound", "`lower=0`"], lines)


SIR_CASES = ("SIR", "SIR, lower=0")


def _captures(ring: Sequence[Row], method: str, runs: int) -> list[float]:
    """Errors of the chance of capture of a method with so many runs."""
    return [row["capture"] for row in ring if (row["method"], row["runs"]) == (method, runs)]


def main() -> None:
    """Write the page."""
    rows = read_rows(TABLE, KINDS)
    seeds, of_published = (len({row["seed"] for row in rows if row["case"] in cases}) for cases in (TRUTHS, PUBLISHED))
    rivals = len({row["seed"] for row in rows if row["case"] in PUBLISHED and row["method"] not in (OWN, EXPANSION)})
    ring = [row for row in rows if row["case"] == "capture in a ring"]
    captures = "; ".join(
        f"{HEADS[method]} {' and '.join(f'{statistics.mean(errors):.2f}' for errors in by_runs)}"
        for method in (OWN, ANY_RUN)
        if all(by_runs := [_captures(ring, method, runs) for runs in (150, 300)])
    )
    costs = [row["fit_cpu_s"] for row in rows if row["method"] == OWN and row["runs"] == 300]
    page = [
        BEGIN.format(seeds=seeds, **summary(rows)), truth_table(rows),
        PUBLISHED_TEXT.format(captures=captures, seeds=of_published, rivals=rivals), published_table(rows),
        SIR_TEXT, sir_table(rows), END.format(least=min(costs), most=max(costs)),
    ]  # fmt: skip
    text = broken("\n\n".join(page)) + "\n"
    PAGE.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
