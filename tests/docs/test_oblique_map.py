"""The map of what becomes of landers: what is counted as what, and that its files agree."""

import json
import math
import sys
from importlib import import_module
from types import ModuleType

import pytest
from blocks import ROOT

FOLDER = ROOT / "validation" / "experiments"


@pytest.fixture(scope="module")
def oblique_map() -> ModuleType:
    sys.path[:0] = [str(FOLDER), str(ROOT / "benchmarks")]
    try:
        return import_module("oblique_map")
    finally:
        del sys.path[:2]


@pytest.mark.parametrize(
    ("status", "way", "kind"),
    [
        ("captured", 0.02, "stop"), ("clear", 0.02, "bounce"), ("clear", 0.2, "along"),
        ("left_sideways", 0.2, "along"), ("left_sideways", 0.02, "lost"), ("left_sideways", math.nan, "lost"),
        ("time_limit", 0.2, "lost"),
    ],
)  # fmt: skip
def test_a_landing_is_told_by_its_outcome_and_its_way(
    oblique_map: ModuleType, status: str, way: float, kind: str
) -> None:
    assert oblique_map.kind({"shape": "sphere", "status": status, "way": way}) == kind


def test_the_summary_is_that_of_the_table(oblique_map: ModuleType) -> None:
    kept = json.loads((FOLDER / "oblique_map.json").read_text(encoding="utf-8"))
    found = json.loads(json.dumps(oblique_map.cells(oblique_map.noted(FOLDER / "oblique_map.csv"))))
    assert found == kept["cells"]
    assert all(sum(share["count"] for share in entry["shares"].values()) == entry["landings"] for entry in found)
