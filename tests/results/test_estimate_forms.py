"""Estimates of the analysis have the keys of summary.json where they stand in results, and lose nothing there."""

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pytest

from lithobrake.analysis import direction_estimate, failure_probability, share_estimate, variance_shares
from lithobrake.chaos import Uniform
from lithobrake.results.questions import LimitStateResult
from lithobrake.results.run_results import CountedShare, OutputDirection, ReturnFraction, VarianceParts
from lithobrake.results.study_files import json_values, results_in
from lithobrake.vocabulary.estimate import Estimate, Number, Share

RANDOM = np.random.default_rng(4)
BED = np.arange(120) % 12
MET = (RANDOM.random(120) < 0.4).astype(float)


@dataclass(frozen=True)
class Forms:
    """An estimate in each form, and one beside a count."""

    number: Number
    shares: Mapping[str, Share]
    counted: CountedShare


def test_an_estimate_comes_back_from_every_form_with_the_reason_of_a_missing_bound() -> None:
    without = Estimate(0.5, None, None, why_missing="one bed")
    forms = Forms(Estimate(math.nan, None, None, why_missing="no run"), {"a": without}, CountedShare(3, without))
    content = json_values(forms)
    assert content == {
        "number": {"value": None, "lower": None, "upper": None, "why": "no run"},
        "shares": {"a": {"share": 0.5, "lower": None, "upper": None, "why": "one bed"}},
        "counted": {"count": 3, "share": 0.5, "lower": None, "upper": None, "why": "one bed"},
    }
    assert results_in(Forms, json.loads(json.dumps(content, allow_nan=False))) == forms
    assert (forms.number.is_known, without.bounds, without.half_width) == (False, None, None)


def test_a_number_on_another_scale_has_its_bounds_there() -> None:
    assert Estimate(4.0, 1.0, None).on_scale(math.sqrt) == Estimate(2.0, 1.0, None)
    assert Estimate(4.0, 1.0, 9.0).half_width == 4.0


def test_a_fraction_has_every_field_of_its_estimate() -> None:
    known = np.where(np.arange(120) < 6, np.nan, MET)
    found = share_estimate(known, BED)
    fraction = ReturnFraction.of(found, 0.5)
    table = json_values(fraction)
    assert list(table) == [
        *("share", "lower", "upper", "level", "from", "next_bed", "if_missing", "missing", "emulator", "why"),
    ]
    assert table["from"] == found.from_
    assert {key: table[key] for key in ("share", "lower", "upper", "missing", "emulator")} == {
        "share": found.share.value, "lower": found.share.lower, "upper": found.share.upper, "missing": 0.05,
        "emulator": 0.5,
    }  # fmt: skip
    assert (table["next_bed"], table["if_missing"]) == (list(found.next_bed or ()), list(found.if_missing))
    assert results_in(ReturnFraction, table) == fraction


def test_parts_of_a_variance_have_share_and_bounds() -> None:
    inputs, x = {"a": Uniform(0.0, 1.0), "b": Uniform(0.0, 1.0)}, RANDOM.random((120, 2))
    found = variance_shares(inputs, x, x[:, 0] + 0.1 * RANDOM.standard_normal(120), BED, soil=["a"])
    assert found is not None
    table = json_values(VarianceParts.of_shares(found, "the landings"))
    assert list(table) == [
        *("soil", "soil_doubled", "terms", "soil_by_input", "arrival", "attitude", "bed", "place", "chaos", "of"),
    ]
    assert table["soil"] == {"share": found.soil.value, "lower": found.soil.lower, "upper": found.soil.upper}
    assert (list(table["soil_by_input"]), table["chaos"]) == (["a"], None)


def test_a_direction_without_an_interval_has_none() -> None:
    found = direction_estimate(RANDOM.random(120), BED, why="one impact point")
    table = json_values(OutputDirection(**vars(found), of="the landings"))
    assert list(table) == ["mean_direction", "resultant_length", "of"]
    assert table["mean_direction"] == {"value": found.mean_direction.value, "lower": None, "upper": None}


@pytest.mark.parametrize("why", [None, "one impact point"])
def test_a_limit_state_has_its_runs(why: str | None) -> None:
    found = failure_probability(MET, BED, why=why)
    limit_state = LimitStateResult(
        "speed_out > 0.1", found.probability, found.source, found.by_runs, found.by_emulator, found.tail_limit,
        why, float(MET.sum()), {}, "",
    )  # fmt: skip
    table = json_values(limit_state)
    assert list(table) == [
        *("condition", "probability", "lower", "upper", "level", "source", "runs", "emulator", "tail_limit", "why"),
        *("failing_runs", "inputs", "statement"),
    ]
    assert list(table["runs"]) == ["share", "lower", "upper", "from", "next_bed", "if_missing", "missing"]
    assert (table["runs"]["from"], table["why"]) == (found.by_runs.from_, why)
