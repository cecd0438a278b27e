"""Files: what an earlier version wrote is read, what a later one wrote is refused, and nothing in them is executed."""

import json
import pickle
from pathlib import Path

import numpy as np
import pytest

from lithobrake.chaos import Empirical, Uniform, fit, fit_stochastic, load, load_stochastic, sobol_sequence
from lithobrake.chaos.storage import FORMAT_VERSION

VERSION_1 = Path(__file__).with_name("expansion_version_1.json")
INPUTS = {"a": Uniform(0.0, 1.0), "b": Uniform(0.0, 1.0)}


def test_a_file_of_format_version_1_is_read():
    assert json.loads(VERSION_1.read_text())["format_version"] == 1
    surrogate = load(VERSION_1)
    assert surrogate.input_names == ["speed", "modulus", "size", "grade"]
    assert surrogate.inputs["grade"] == Empirical([1.0, 2.0, 4.0])
    # The file holds v = speed**2 + log10(modulus) and w = size * grade.
    x = np.array([[0.5, 1e7, 1.0, 2.0], [0.2, 3e6, 2.5, 4.0]])
    expected = np.column_stack([x[:, 0] ** 2 + np.log10(x[:, 1]), x[:, 2] * x[:, 3]])
    assert np.allclose(surrogate(x), expected, rtol=1e-9)
    # Uniform(0.1, 0.9)**2 and log-uniform over two decades: means 0.91 / 3 and 7.
    assert surrogate.mean[0] == pytest.approx(0.91 / 3.0 + 7.0, rel=1e-9)
    assert surrogate.residuals.shape == (3, 2)
    assert surrogate.report["outputs"]["v"]["method"] == "ols"


def test_what_version_1_lacks_is_no_reason_to_refuse_it(tmp_path):
    content = json.loads(VERSION_1.read_text())
    content["a_key_of_a_later_version"] = {"x": 1}
    content["report"] = {}
    path = tmp_path / "model.json"
    path.write_text(json.dumps(content))
    assert np.isfinite(load(path).mean).all()


@pytest.mark.parametrize("version", [FORMAT_VERSION + 1, 99, 0, -1, "1", True, None, 1.5])
def test_another_format_version_is_refused_in_one_sentence(version, tmp_path):
    x = np.repeat(sobol_sequence(INPUTS, 12), 2, axis=0)
    y = x[:, 0] + np.random.default_rng(0).normal(size=24)
    makers = {load: fit(INPUTS, x, y, degree=1), load_stochastic: fit_stochastic(INPUTS, x, y)}
    path = tmp_path / "model.json"
    for read, surrogate in makers.items():
        surrogate.save(path)
        content = json.loads(path.read_text())
        content["format_version"] = version
        path.write_text(json.dumps(content))
        with pytest.raises(ValueError, match=r"model\.json has format_version [^\n]*: install [^\n]*$"):
            read(path)


def test_code_in_a_file_stays_text(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code = "__import__('pathlib').Path('hit').touch()"
    x = sobol_sequence(INPUTS, 12)
    fit({code: INPUTS["a"], "b": INPUTS["b"]}, x, x[:, 0], degree=1, output_names=[code]).save("model.json")
    surrogate = load("model.json")
    assert surrogate.input_names[0] == surrogate.output_names[0] == code
    content = json.loads(Path("model.json").read_text())
    for kind in (code, "__class__", "Distribution", "lithobrake.chaos.distributions.Uniform"):
        content["inputs"][0]["kind"] = kind
        Path("model.json").write_text(json.dumps(content))
        with pytest.raises(ValueError, match="damaged"):
            load("model.json")

    class Hit:
        def __reduce__(self):
            return Path.touch, (Path("hit"),)

    Path("model.json").write_bytes(pickle.dumps(Hit()))
    with pytest.raises(ValueError, match="not JSON"):
        load("model.json")
    assert not Path("hit").exists()


@pytest.mark.parametrize(("key", "value"), [
    ("coefficients", [[1.0]]),
    ("coefficients", "many"),
    ("multi_indices", [[-1, 0, 0, 0]]),
    ("inputs", []),
    ("inputs", [{"name": "a"}]),
    ("output_names", None),
    ("residuals", [[1.0]]),
    ("residuals", [[1.0, float("nan")]]),
    ("residuals", [[1.0, 2.0, 3.0, 4.0]]),
    ("report", 3),
    ("multi_indices", [[0, 0, 0]]),
    ("multi_indices", [[0, 0, 0, 0.5]]),
    ("multi_indices", [[0, 0, 0, True]]),
    ("multi_indices", [[0, 0, 0, 10**30]]),
    ("multi_indices", [[0, 0, 0, 0]] * 2),
    ("multi_indices", []),
    ("output_names", "vw"),
    ("output_names", ["v", "v"]),
    ("one_dimensional", "no"),
    ("one_dimensional", True),
])  # fmt: skip
def test_damaged_content_is_refused_with_the_name_of_the_file(key, value, tmp_path):
    content = {**json.loads(VERSION_1.read_text()), key: value}
    path = tmp_path / "model.json"
    path.write_text(json.dumps(content))
    with pytest.raises(ValueError, match=r"model\.json is damaged"):
        load(path)


def test_numbers_of_a_file_that_are_none_are_refused(tmp_path):
    path = tmp_path / "model.json"
    for broken in (float("nan"), float("inf"), None):
        content = json.loads(VERSION_1.read_text())
        content["coefficients"][1][0] = broken
        path.write_text(json.dumps(content))
        with pytest.raises(ValueError, match="coefficients must be rows of 2 finite numbers"):
            load(path)
    content = json.loads(VERSION_1.read_text())
    content["inputs"][1]["name"] = content["inputs"][0]["name"]
    path.write_text(json.dumps(content))
    with pytest.raises(ValueError, match="name of its own"):
        load(path)
    path.write_text("[" * 100_000)
    with pytest.raises(ValueError, match="not JSON"):
        load(path)


def test_parts_of_a_file_that_do_not_belong_together_are_refused(tmp_path):
    x = np.repeat(sobol_sequence(INPUTS, 12), 2, axis=0)
    y = x[:, 0] + np.random.default_rng(0).normal(size=24)
    path = tmp_path / "model.json"
    fit_stochastic(INPUTS, x, y).save(path)
    assert np.isfinite(load_stochastic(path).sample(x)).all()
    whole = json.loads(path.read_text())
    other = {**whole["log_variance"], "output_names": ["z"]}
    for change in ({"correlation": [[float("nan")]]}, {"correlation": [[1.0], [1.0]]}, {"log_variance": other}):
        path.write_text(json.dumps({**whole, **change}))
        with pytest.raises(ValueError, match="damaged"):
            load_stochastic(path)


def test_a_folder_is_refused_in_one_sentence(tmp_path):
    with pytest.raises(ValueError, match="is no regular file: give a file that save wrote"):
        load(tmp_path)
    with pytest.raises(ValueError, match="is a folder; name a file"):
        load(VERSION_1).save(tmp_path)
