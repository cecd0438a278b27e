"""Write docs/validation/emulator_peers.md from what benchmarks/emulator_peers.py has measured.

python benchmarks/emulator_peers_page.py
"""

import statistics
from collections.abc import Sequence

from emulator_peers import ANY_RUN, KINDS, OWN, TABLE
from emulator_rivals import RIVALS
from emulator_truths import PUBLISHED, TRUTHS
from harness import Row, read_rows
from page import table, write_page

# Hilscher (2024), master's thesis with code, file error.txt: of degree 5, median of ten designs.
PUBLISHED_SPCE = {("bimodal", 400): 0.0201, ("bimodal", 800): 0.0149, ("bimodal", 1600): 0.0077}
PUBLISHED_PROCESS = {("bimodal", 400): 0.068, ("bimodal", 800): 0.065, ("bimodal", 1600): 0.063}
HEADS = {
    OWN: "`fit`", "near rows": "nearby runs", "process and residuals": "Gaussian process", "forest rows": "forest",
    "Gaussian mixture": "mixture", ANY_RUN: "any run",
}  # fmt: skip


def mean_error(rows: Sequence[Row]) -> tuple[float, float]:
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
    methods, lines = [OWN, *RIVALS, ANY_RUN], []
    for case, runs in sorted({(row["case"], row["runs"]) for row in rows if row["case"] in PUBLISHED}):
        cells = []
        for method in methods:
            errors = [row["error"] for row in rows if (row["case"], row["runs"], row["method"]) == (case, runs, method)]
            cells.append(f"{statistics.median(errors):.2g} ({max(errors):.2g})" if errors else "")
        known = [f"{of[case, runs]:.2g}" if (case, runs) in of else "" for of in (PUBLISHED_SPCE, PUBLISHED_PROCESS)]
        lines.append([case, str(runs), *cells, *known])
    heads = [HEADS[method] for method in methods]
    return table(["case", "runs", *heads, "published expansion", "published process"], lines)


def _captures(ring: Sequence[Row], method: str, runs: int) -> list[float]:
    """Errors of the chance of capture of a method with so many runs."""
    return [row["capture"] for row in ring if (row["method"], row["runs"]) == (method, runs)]


def main() -> None:
    rows = read_rows(TABLE, KINDS)
    seeds, of_published = (len({row["seed"] for row in rows if row["case"] in cases}) for cases in (TRUTHS, PUBLISHED))
    rivals = len({row["seed"] for row in rows if row["case"] in PUBLISHED and row["method"] != OWN})
    ring = [row for row in rows if row["case"] == "capture in a ring"]
    captures = "; ".join(
        f"{HEADS[method]} {' and '.join(f'{statistics.mean(errors):.2f}' for errors in by_runs)}"
        for method in (OWN, ANY_RUN)
        if all(by_runs := [_captures(ring, method, runs) for runs in (150, 300)])
    )
    costs = [row["fit_cpu_s"] for row in rows if row["method"] == OWN and row["runs"] == 300]
    write_page(
        "emulator_peers", seeds=seeds, **summary(rows), truths=truth_table(rows), captures=captures,
        published_seeds=of_published, rivals=rivals, published=published_table(rows),
        shortest=min(costs), longest=max(costs),
    )  # fmt: skip


if __name__ == "__main__":
    main()
