"""The results that the repository keeps: each has the ledger that its summary counts."""

import csv
import json
from collections import Counter

import pytest
from blocks import ROOT


@pytest.mark.parametrize("study", ["paper", "drawn_170", "drawn_700", "first_bounce", "mission"])
def test_kept_ledgers_have_the_runs_of_their_summaries(study: str) -> None:
    folder = ROOT / "showcase" / study
    results = json.loads((folder / "summary.json").read_text(encoding="utf-8"))["results"]
    designs = results.get("designs") or {"drawn": results["runs"]}
    for name, design in designs.items():
        with (folder / "runs" / f"{name}.csv").open(newline="", encoding="utf-8") as file:
            outcomes = Counter(row["outcome"] for row in csv.DictReader(file))
        assert outcomes == design["outcomes"], name
