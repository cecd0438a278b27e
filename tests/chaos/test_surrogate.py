"""Evaluation, scores and files of a surrogate; the face of the part, and its threads; files of other versions."""

import hashlib
import json
import pickle
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from threadpoolctl import threadpool_info, threadpool_limits

from lithobrake import chaos
from lithobrake.chaos import (
    Empirical,
    LogUniform,
    Normal,
    TruncatedNormal,
    Uniform,
    d_optimal,
    fit,
    fit_stochastic,
    gradient,
    load,
    load_stochastic,
    sobol_sequence,
)
from lithobrake.chaos.storage import FORMAT_VERSION
from lithobrake.chaos.training_data import one_thread

INPUTS = {"speed": Uniform(0.1, 0.9), "modulus": LogUniform(1e6, 1e8)}


def written(folder, content):
    """A file model.json of this content."""
    path = folder / "model.json"
    path.write_text(json.dumps(content))
    return path


@pytest.fixture(scope="module")
def surrogate():
    x = sobol_sequence(INPUTS, 60)
    return fit(INPUTS, x, np.column_stack([x[:, 0] ** 2, np.log(x[:, 1])]), degree=2, output_names=["v", "w"])


def test_evaluation_equals_the_polynomial(surrogate):
    x = sobol_sequence(INPUTS, 5000, seed=5)
    assert np.allclose(surrogate(x), np.column_stack([x[:, 0] ** 2, np.log(x[:, 1])]), rtol=1e-12)
    assert np.array_equal(surrogate(x)[:7], surrogate(x[:7])) or np.allclose(surrogate(x)[:7], surrogate(x[:7]), 1e-14)


def test_points_outside_are_refused_or_warned(surrogate):
    x = np.array([[0.5, 1e7], [0.95, 1e7], [0.5, 1e5]])
    with pytest.raises(ValueError, match="2 of 3 points are outside"):
        surrogate(x)
    with pytest.warns(UserWarning, match="2 of 3 points are outside"):
        values = surrogate(x, outside="warn")
    assert np.all(np.isfinite(values))
    with pytest.raises(ValueError, match="outside"), np.errstate(all="raise"):
        surrogate([[0.5, -1.0]], outside="warn")
    with pytest.raises(ValueError, match="finite"):
        surrogate([[np.nan, 1e7]])
    with pytest.raises(ValueError, match="shape"):
        surrogate([[0.5]])


def test_scores_follow_their_definitions(surrogate):
    x = sobol_sequence(INPUTS, 50, seed=8)
    truth = surrogate(x)
    y = truth.copy()
    y[:, 0] *= -1.25
    score = surrogate.score(x, y)
    assert (score["v"]["mape"], len(score["v"]["ape"])) == (pytest.approx(180.0), 50)
    error = truth[:, 0] - y[:, 0]
    assert score["v"]["rmse"] == pytest.approx(np.sqrt(np.mean(error**2)))
    assert score["v"]["std"] == pytest.approx(np.std(y[:, 0]))
    assert score["v"]["rrmse"] == pytest.approx(score["v"]["rmse"] / score["v"]["std"])
    assert score["v"]["q2"] == pytest.approx(1.0 - score["v"]["rrmse"] ** 2)
    assert score["w"]["rmse"] < 1e-10
    with pytest.raises(ValueError, match="finite"):
        surrogate.score(x, y * np.nan)


def test_file_gives_back_the_same_bits(surrogate, tmp_path):
    path = tmp_path / "model.json"
    surrogate.save(path)
    again = load(path)
    x = sobol_sequence(INPUTS, 100, seed=2)
    assert np.array_equal(again(x), surrogate(x))
    assert np.array_equal(again.multi_indices, surrogate.multi_indices)
    assert (again.inputs, again.output_names) == (surrogate.inputs, surrogate.output_names)
    assert again.report == surrogate.report
    assert np.array_equal(again.residuals, surrogate.residuals)
    content = json.loads(path.read_text())
    assert content["format_version"] == 1
    assert content["inputs"][1] == {"name": "modulus", "kind": "log_uniform", "lower": 1e6, "upper": 1e8}


def test_file_is_strict_json_for_every_input(tmp_path):
    inputs = {"a": TruncatedNormal(0.0, 1.0, 0.0, np.inf), "b": Empirical([1.0, 2.0, 4.0]), "c": Normal(0.0, 1.0)}
    x = sobol_sequence(inputs, 30)
    fit(inputs, x, x[:, 0], degree=1).save(tmp_path / "model.json")

    def refuse(text):
        raise AssertionError(text)

    json.loads((tmp_path / "model.json").read_text(), parse_constant=refuse)
    assert load(tmp_path / "model.json").inputs == inputs


def test_wrong_files_are_refused(surrogate, tmp_path):
    path = tmp_path / "model.json"
    for text in ("not json", "[]", "{}", '{"format": "lithobrake expansion", "format_version": 99}'):
        path.write_text(text)
        with pytest.raises(ValueError, match=r"model\.json"):
            load(path)
    surrogate.save(path)
    content = json.loads(path.read_text())
    for key in ("inputs", "coefficients", "multi_indices"):
        with pytest.raises(ValueError, match="damaged"):
            load(written(tmp_path, {k: v for k, v in content.items() if k != key}))


def test_constant_output_has_no_variance_and_zero_indices():
    x = sobol_sequence(INPUTS, 30)
    surrogate = fit(INPUTS, x, np.full(30, 0.1), degree=2)
    assert (surrogate.mean, surrogate.variance, surrogate.sobol_first.tolist()) == (0.1, 0.0, [0.0, 0.0])
    assert surrogate.score(x, np.full(30, 0.1))["y"]["q2"] == 1.0


def test_compiled_and_plain_evaluation_agree(surrogate, monkeypatch):
    from lithobrake.chaos import evaluation

    pytest.importorskip("numba", reason="numba is not installed")
    x = sobol_sequence(INPUTS, evaluation.COMPILED_FROM + 77, seed=4)
    compiled = surrogate(x)
    monkeypatch.setattr(evaluation, "compiled_loop", lambda: None)
    assert np.allclose(compiled, surrogate(x), rtol=1e-13, atol=1e-13)


def test_part_works_without_numba(tmp_path):
    code = (
        "import sys; sys.modules['numba'] = None\n"
        "from lithobrake.chaos import Uniform, fit, sobol_sequence\n"
        "inputs = {'a': Uniform(0, 1)}\n"
        "x = sobol_sequence(inputs, 30000)\n"
        "print(fit(inputs, x[:50], x[:50, 0] ** 2, degree=2)(x).mean())\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert float(done.stdout) == pytest.approx(1.0 / 3.0, abs=1e-3)


def test_index_sets_can_be_limited():
    x = sobol_sequence(INPUTS, 60)
    assert fit(INPUTS, x, x[:, 0] ** 3, degree=4, max_degrees=[4, 1]).multi_indices.max(axis=0).tolist() == [4, 1]
    hyperbolic = fit(INPUTS, x, x[:, 0] ** 3, degree=4, q_norm=0.5)
    # Nine powers of one input and the product, whose norm is (1 + 1)**2 = 4.
    assert hyperbolic.term_count == 10
    assert fit(INPUTS, x, x[:, 0] ** 3, max_degrees=[5, 0]).multi_indices[:, 1].max() == 0
    with pytest.raises(ValueError, match="max_degrees"):
        fit(INPUTS, x, x[:, 0], degree=2, max_degrees=[1])
    with pytest.raises(ValueError, match="max_degrees"):
        fit(INPUTS, x, x[:, 0], method="omp", max_degrees=[1, 1])


COUNT_WITHOUT_ARRAYS = """
import sys
from lithobrake.chaos import smolyak_count, term_count
assert (term_count(3, 2), smolyak_count(2, 1)) == (10, 5)
print({"numpy", "scipy", "sklearn", "numba"} & set(sys.modules))
"""


def test_counting_imports_no_arrays() -> None:
    finished = subprocess.run([sys.executable, "-c", COUNT_WITHOUT_ARRAYS], capture_output=True, text=True)
    assert (finished.stdout, finished.stderr) == ("set()\n", "")


def test_a_name_that_is_not_there_is_missed_by_name() -> None:
    with pytest.raises(AttributeError, match=r"^No lithobrake\.chaos attribute smolyack$"):
        chaos.smolyack  # noqa: B018
    with pytest.raises(ImportError, match=r"^cannot import name 'smolyack' from 'lithobrake\.chaos'"):
        from lithobrake.chaos import smolyack  # noqa: F401


def digest_on(threads: int) -> str:
    """A hash of expansions, their values and slopes, and of a design, where linear algebra may take so many threads."""
    inputs = {name: Uniform(0.0, 1.0) for name in "abcde"}
    digest = hashlib.sha256()
    with threadpool_limits(threads):
        x = sobol_sequence(inputs, 120)
        y = np.column_stack([np.minimum(x[:, 0], x[:, 1]) + x[:, 2] * x[:, 3], np.sin(x @ np.arange(5.0))])
        one = fit(inputs, x, y[:, 0], method="gaussian_process")
        for made in (one, fit(inputs, x, y, degree=3), fit(inputs, x[:60], y[:60], method="omp", degree=3)):
            digest.update(made.coefficients.tobytes() + made(x).tobytes() + gradient(made, x).tobytes())
        digest.update(d_optimal(inputs, 60, degree=3).tobytes())
    return digest.hexdigest()


def test_same_bits_on_one_thread_and_on_four() -> None:
    assert digest_on(1) == digest_on(4)


def test_the_number_of_threads_comes_back() -> None:
    before = [(entry["filepath"], entry["num_threads"]) for entry in threadpool_info()]
    with one_thread():
        assert all(entry["num_threads"] == 1 for entry in threadpool_info())
    known = dict(before)
    assert all(entry["num_threads"] == known.get(entry["filepath"], 1) for entry in threadpool_info())


VERSION_1 = Path(__file__).with_name("expansion_version_1.json")
UNIT = {"a": Uniform(0.0, 1.0), "b": Uniform(0.0, 1.0)}


def test_a_file_of_format_version_1_is_read():
    assert json.loads(VERSION_1.read_text())["format_version"] == 1
    surrogate = load(VERSION_1)
    assert surrogate.input_names == ["speed", "modulus", "size", "grade"]
    assert surrogate.inputs["grade"] == Empirical([1.0, 2.0, 4.0])
    # The file holds v = speed**2 + log10(modulus) and w = size * grade.
    x = np.array([[0.5, 1e7, 1.0, 2.0], [0.2, 3e6, 2.5, 4.0]])
    assert np.allclose(surrogate(x), np.column_stack([x[:, 0] ** 2 + np.log10(x[:, 1]), x[:, 2] * x[:, 3]]), rtol=1e-9)
    # Uniform(0.1, 0.9)**2 and log-uniform over two decades: means 0.91 / 3 and 7.
    assert surrogate.mean[0] == pytest.approx(0.91 / 3.0 + 7.0, rel=1e-9)
    assert surrogate.residuals.shape == (3, 2)
    assert surrogate.report["outputs"]["v"]["method"] == "ols"


def test_what_version_1_lacks_is_no_reason_to_refuse_it(tmp_path):
    content = {**json.loads(VERSION_1.read_text()), "a_key_of_a_later_version": {"x": 1}, "report": {}}
    assert np.isfinite(load(written(tmp_path, content)).mean).all()


@pytest.mark.parametrize("version", [FORMAT_VERSION + 1, 99, 0, -1, "1", True, None, 1.5])
def test_another_format_version_is_refused_in_one_sentence(version, tmp_path):
    x = np.repeat(sobol_sequence(UNIT, 12), 2, axis=0)
    y = x[:, 0] + np.random.default_rng(0).normal(size=24)
    makers = {load: fit(UNIT, x, y, degree=1), load_stochastic: fit_stochastic(UNIT, x, y)}
    path = tmp_path / "model.json"
    for read, surrogate in makers.items():
        surrogate.save(path)
        content = {**json.loads(path.read_text()), "format_version": version}
        with pytest.raises(ValueError, match=r"model\.json has format_version [^\n]*: install [^\n]*$"):
            read(written(tmp_path, content))


def test_code_in_a_file_stays_text(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code = "__import__('pathlib').Path('hit').touch()"
    x = sobol_sequence(UNIT, 12)
    fit({code: UNIT["a"], "b": UNIT["b"]}, x, x[:, 0], degree=1, output_names=[code]).save("model.json")
    surrogate = load("model.json")
    assert surrogate.input_names[0] == surrogate.output_names[0] == code
    content = json.loads(Path("model.json").read_text())
    for kind in (code, "__class__", "Distribution", "lithobrake.chaos.distributions.Uniform"):
        content["inputs"][0]["kind"] = kind
        with pytest.raises(ValueError, match="damaged"):
            load(written(tmp_path, content))

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
    with pytest.raises(ValueError, match=r"model\.json is damaged"):
        load(written(tmp_path, {**json.loads(VERSION_1.read_text()), key: value}))


def test_numbers_of_a_file_that_are_none_are_refused(tmp_path):
    for broken in (float("nan"), float("inf"), None):
        content = json.loads(VERSION_1.read_text())
        content["coefficients"][1][0] = broken
        with pytest.raises(ValueError, match="coefficients must be rows of 2 finite numbers"):
            load(written(tmp_path, content))
    content = json.loads(VERSION_1.read_text())
    content["inputs"][1]["name"] = content["inputs"][0]["name"]
    with pytest.raises(ValueError, match="name of its own"):
        load(written(tmp_path, content))
    (tmp_path / "model.json").write_text("[" * 100_000)
    with pytest.raises(ValueError, match="not JSON"):
        load(tmp_path / "model.json")


def test_parts_of_a_file_that_do_not_belong_together_are_refused(tmp_path):
    x = np.repeat(sobol_sequence(UNIT, 12), 2, axis=0)
    y = x[:, 0] + np.random.default_rng(0).normal(size=24)
    path = tmp_path / "model.json"
    fit_stochastic(UNIT, x, y).save(path)
    assert np.isfinite(load_stochastic(path).sample(x)).all()
    whole = json.loads(path.read_text())
    other = {**whole["log_variance"], "output_names": ["z"]}
    for change in ({"correlation": [[float("nan")]]}, {"correlation": [[1.0], [1.0]]}, {"log_variance": other}):
        with pytest.raises(ValueError, match="damaged"):
            load_stochastic(written(tmp_path, {**whole, **change}))


def test_a_folder_is_refused_in_one_sentence(tmp_path):
    with pytest.raises(ValueError, match="is no regular file: give a file that save wrote"):
        load(tmp_path)
    with pytest.raises(ValueError, match="is a folder; name a file"):
        load(VERSION_1).save(tmp_path)
