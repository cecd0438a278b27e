"""An emulator comes back from its file with the same draws, and a damaged file is refused."""

import json
from pathlib import Path

import numpy as np
import pytest

from lithobrake import emulator
from lithobrake.chaos import Uniform

INPUTS = {"a": Uniform(0.0, 1.0), "b": Uniform(-1.0, 1.0)}


def fitted(bounds_follow_inputs: bool = False) -> emulator.Emulator:
    """An emulator with all there is: bounds, a rider, an outcome without outputs and one that never was."""
    rng = np.random.default_rng(0)
    x = np.column_stack([rng.random(90), rng.uniform(-1.0, 1.0, 90)])
    limit = 1.0 + x[:, 0] if bounds_follow_inputs else np.full(90, 2.0)
    speed = limit / (1.0 + np.exp(-(x[:, 0] + 0.5 * rng.standard_normal(90))))
    y = np.column_stack([speed, rng.normal(size=90), rng.integers(5, size=90)])
    outcome = np.where(rng.random(90) < 0.1, "stuck", "free")
    y[outcome == "stuck"] = np.nan
    upper = np.column_stack([limit, np.full((90, 2), np.inf)])
    return emulator.fit(
        INPUTS, x, y, groups=np.arange(90) % 9, outcome=outcome, outcomes=("free", "stuck", "lost"),
        lower=[0.0, -np.inf, -np.inf], upper=upper, riders=("label",), output_names=("speed", "spin", "label"),
    )  # fmt: skip


@pytest.mark.parametrize("bounds_follow_inputs", [False, True])
def test_a_saved_emulator_comes_back_bit_for_bit(tmp_path: Path, bounds_follow_inputs: bool) -> None:
    model = fitted(bounds_follow_inputs)
    model.save(tmp_path / "model.json")
    again = emulator.load(tmp_path / "model.json")
    x, upper = model.runs.x[:20], np.full((20, 3), [2.5, np.inf, np.inf]) if bounds_follow_inputs else None
    np.testing.assert_array_equal(model.sample(x, 50, seed=3, upper=upper), again.sample(x, 50, seed=3, upper=upper))
    np.testing.assert_array_equal(model.outcome_probability(x), again.outcome_probability(x))
    first, second = model.refits(2, seed=1)[1], again.refits(2, seed=1)[1]
    np.testing.assert_array_equal(first.sample(x, 5, upper=upper), second.sample(x, 5, upper=upper))
    assert again.statement == model.statement
    assert again.found_inputs() == model.found_inputs()
    again.save(tmp_path / "again.json")
    assert (tmp_path / "again.json").read_bytes() == (tmp_path / "model.json").read_bytes()


def test_the_file_is_plain_json_that_says_what_it_is(tmp_path: Path) -> None:
    fitted().save(tmp_path / "model.json")

    def refuse(constant: str) -> None:
        raise AssertionError(f"{constant} is no JSON")

    content = json.loads((tmp_path / "model.json").read_text(), parse_constant=refuse)
    assert content["format"] == "lithobrake emulator"
    assert content["format_version"] == 1
    assert content["output_names"] == ["speed", "spin", "label"]
    assert content["upper"] == [[2.0, None, None]]


@pytest.mark.parametrize(
    ("key", "value"),
    [("location", [[0.0]]), ("rows", []), ("outcome", [7] * 90), ("riders", ["mass"]), ("multi_indices", [[0, 1]])],
)
def test_a_damaged_file_is_refused(tmp_path: Path, key: str, value: object) -> None:
    path = tmp_path / "model.json"
    fitted().save(path)
    path.write_text(json.dumps({**json.loads(path.read_text()), key: value}))
    with pytest.raises(ValueError, match=r"model\.json"):
        emulator.load(path)
