"""Estimates of the analysis lose nothing on their way into the results, and have the keys of summary.json."""

import numpy as np

from lithobrake.analysis import (
    IntervalEstimate,
    direction_estimate,
    failure_probability,
    share_estimate,
    variance_shares,
)
from lithobrake.chaos import Uniform
from lithobrake.pipeline.answer import typed_estimates as typed
from lithobrake.results.json_values import to_json

RANDOM = np.random.default_rng(4)
BED = np.arange(120) % 12
MET = (RANDOM.random(120) < 0.4).astype(float)


def test_a_fraction_has_every_field_of_its_estimate() -> None:
    known = np.where(np.arange(120) < 6, np.nan, MET)
    found = share_estimate(known, BED, emulator=0.5)
    table = to_json(typed.fraction(found))
    assert list(table) == [
        *("share", "lower", "upper", "level", "from", "next_bed", "if_missing", "missing", "emulator", "why"),
    ]
    assert table["from"] == found.source
    assert {key: table[key] for key in ("share", "lower", "upper", "missing", "emulator")} == {
        "share": found.share, "lower": found.lower, "upper": found.upper, "missing": 0.05, "emulator": 0.5
    }  # fmt: skip
    assert (table["next_bed"], table["if_missing"]) == (list(found.next_bed or ()), list(found.if_missing))


def test_parts_of_a_variance_have_share_and_bounds() -> None:
    inputs, x = {"a": Uniform(0.0, 1.0), "b": Uniform(0.0, 1.0)}, RANDOM.random((120, 2))
    found = variance_shares(inputs, x, x[:, 0] + 0.1 * RANDOM.standard_normal(120), BED, soil=["a"])
    table = to_json(typed.variance_parts(found, "the landings"))
    assert list(table) == [
        "soil", "soil_doubled", "terms", "soil_by_input", "arrival", "attitude", "bed", "place", "chaos", "of",
    ]  # fmt: skip
    assert table["soil"] == {"share": found.soil.value, "lower": found.soil.lower, "upper": found.soil.upper}
    assert (list(table["soil_by_input"]), table["chaos"]) == (["a"], None)


def test_a_direction_without_an_interval_has_none() -> None:
    found = direction_estimate(RANDOM.random(120), BED, why="one impact point")
    table = to_json(typed.direction(found, "the landings"))
    assert list(table) == ["mean_direction", "resultant_length", "of"]
    assert table["mean_direction"] == {"value": found.mean_direction, "lower": None, "upper": None}


def test_a_limit_state_has_its_runs() -> None:
    found = failure_probability(MET, BED)
    table = to_json(typed.limit_state("speed_out > 0.1", found, float(MET.sum()), {}))
    assert list(table) == [
        *("condition", "probability", "lower", "upper", "level", "source", "runs", "emulator", "tail_limit", "why"),
        *("failing_runs", "inputs", "statement"),
    ]
    assert list(table["runs"]) == ["share", "lower", "upper", "from", "next_bed", "if_missing", "missing"]
    assert table["runs"]["from"] == found.by_runs.source


def test_an_infinite_bound_is_none() -> None:
    found = typed.finite_estimate(IntervalEstimate(1.0, -np.inf, 2.0))
    assert (found.value, found.lower, found.upper) == (1.0, None, 2.0)
