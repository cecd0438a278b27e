"""The attitude as an input of the emulator of first touchdowns, by landings that depend on it alone."""

from importlib import import_module
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

import lithobrake
from lithobrake import emulator
from lithobrake.geometry.attitude import seen_from_lander
from lithobrake.pipeline import served_models
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.design.lander_attitude import attitude_laws, drawn_attitudes
from lithobrake.pipeline.inferred_study import InferredStudy
from lithobrake.pipeline.runs.solver import function_identity
from lithobrake.pipeline.study_run import run_study
from lithobrake.results import StudyResults, open_study
from lithobrake.study import StudySource
from lithobrake.study.reader import check_tables
from lithobrake.vocabulary.quantities import IMPACT_AZIMUTH, ORIENTATION

from ..synthetic_lander import SOIL, synthetic_tables

BOX = {"shape": "box", "edges": [0.1, 0.1, 0.2], "mass": 1.0, "diameter": None}
# Nobody looks at where landers fly.
SHORT = {"flight_count": 10, "duration": 600.0}
TERMS = [f"attitude.{term}_z" for term in ("upright", "lean", "along")]
SLOWEST, FASTEST, NOISE = 0.02, 0.12, 0.004
UPRIGHT, LYING = (1.0, 0.0, 0.0, 0.0), (0.5**0.5, 0.5**0.5, 0.0, 0.0)


def tables(**changes: dict[str, Any]) -> dict[str, Any]:
    few = {"design": {"run_count": 96}, "monte_carlo": {"sample_count": 4000}, "flight": SHORT}
    return synthetic_tables(**{"lander": BOX, "hard_ground": {"count": 0}, **few, **changes})


def upright(inputs: dict[str, float]) -> float:
    """How upright the long axis is, from 0 to 1: the square of a component of the third row of the rotation."""
    w, x, y, z = (inputs[name] for name in ORIENTATION)
    return (1.0 - 2.0 * (x * x + y * y)) ** 2 / (w * w + x * x + y * y + z * z) ** 2


def by_attitude(inputs: dict[str, float], seed: int) -> dict[str, Any]:
    """A rebound as fast as the lander is upright, whatever the soil and the bed."""
    random = np.random.default_rng(seed)
    speed = max(SLOWEST + (FASTEST - SLOWEST) * upright(inputs) + NOISE * random.standard_normal(), 1e-3)
    elevation, spin = random.uniform(0.5, 1.2), random.uniform(0.05, 0.15)
    leaving = {"velocity_out_x": speed * np.cos(elevation), "velocity_out_z": speed * np.sin(elevation)}
    turning = {"spin_out_x": 0.0, "spin_out_y": spin, "spin_out_z": 0.0}
    return {"outcome": "clear", "outputs": leaving | {"velocity_out_y": 0.0} | turning}


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> StudyResults:
    return lithobrake.run(
        tables(), tmp_path_factory.mktemp("attitude") / "out", workers=1, model=by_attitude, report=False
    )


def test_the_emulator_follows_the_attitude(results: StudyResults) -> None:
    model = emulator.load(results.folder / "emulator.json")
    assert set(list(model.runs.inputs)[: -len(TERMS)]) == set(SOIL)
    assert list(model.runs.inputs)[-len(TERMS) :] == TERMS
    x = np.array([[law.median for law in model.runs.inputs.values()]] * 2)
    x[:, len(SOIL)] = 0.1, 0.9
    speed = model.sample(x, 400, 1, lower=model.runs.lower[0], upper=model.runs.upper[0])
    # A few of the draws are captured, as any may be.
    means = np.nanmean(speed[:, :, model.output_names.index("speed_out")], axis=1)
    assert means == pytest.approx([SLOWEST + 0.1 * (FASTEST - SLOWEST), SLOWEST + 0.9 * (FASTEST - SLOWEST)], rel=0.1)
    # Nearly all of the scatter of the speed; of resampled runs the score is far worse.
    speeds = results.results.emulator.scores.outputs["speed_out"]
    assert speeds.crps_skill > 0.7
    assert "attitude.upright_z" in results.results.emulator.found_inputs


def test_what_the_attitude_explains_is_a_part_of_the_variance(results: StudyResults) -> None:
    parts = results.results.variance_shares["speed_out"]
    # Of the variance of c^2 for a cosine c that is even over a sphere, 4 / 45, the noise adds little.
    whole = (FASTEST - SLOWEST) ** 2 * 4.0 / 45.0
    assert parts.attitude.value == pytest.approx(whole / (whole + NOISE**2), abs=0.05)
    assert parts.soil.value < 0.05


def test_samples_are_over_all_attitudes(results: StudyResults) -> None:
    samples = results.samples
    terms = np.column_stack([samples[name] for name in TERMS])
    # Means over all rotations: a third, and none of the others.
    assert terms.mean(axis=0) == pytest.approx([1.0 / 3.0, 0.0, 0.0], abs=0.03)
    assert np.corrcoef(terms[:, 0] - 1.0 / 3.0, samples["grain.friction"])[0, 1] == pytest.approx(0.0, abs=0.05)
    speed = np.asarray(samples["speed_out"])
    assert np.nanmean(speed) == pytest.approx(SLOWEST + (FASTEST - SLOWEST) / 3.0, rel=0.05)
    # The cosine of the long axis is even between 0 and 1.
    shares = np.array([0.25, 0.5, 0.75])
    expected = SLOWEST + (FASTEST - SLOWEST) * shares**2
    assert np.nanquantile(speed, shares) == pytest.approx(expected, abs=0.006)
    # So it is at any soil.
    soft = samples["grain.friction"] < 0.45
    assert np.nanmean(speed[soft]) == pytest.approx(np.nanmean(speed[~soft]), rel=0.06)


def test_whoever_gives_no_attitude_has_any(results: StudyResults) -> None:
    point = {name: law.median for name, law in list(results.emulator.model.runs.inputs.items())[: len(SOIL)]}
    speed = results.emulator.sample(point, 2000)["speed_out"]
    assert np.nanmean(speed) == pytest.approx(SLOWEST + (FASTEST - SLOWEST) / 3.0, rel=0.08)
    fixed = results.emulator.sample(point | dict(zip(TERMS, (1.0, 0.0, 0.0), strict=True)), 200)["speed_out"]
    assert np.nanmean(fixed) == pytest.approx(FASTEST, rel=0.1)
    attitude = results.explorer.attitude
    assert (attitude.input_names, attitude.drawn, len(attitude.sides)) == (tuple(TERMS), None, 2)


def test_a_server_takes_the_attitude_of_a_run(results: StudyResults, monkeypatch: pytest.MonkeyPatch) -> None:
    # A function has no beds, and study.toml does not name it.
    monkeypatch.setattr("lithobrake.pipeline.commands.serving.height_of_beds", lambda study, folder: 0.0)
    served = {one.name: one for one in served_models(results.folder / "study.toml", results.folder)}["emulator"]
    assert set(served.inputs) == set(SOIL)
    point = [results.emulator.model.runs.inputs[name].median for name in served.inputs]

    def mean(attitude: tuple[float, ...] | None, count: int) -> float:
        given = {} if attitude is None else dict(zip(ORIENTATION, attitude, strict=True)) | {IMPACT_AZIMUTH: 30.0}
        return float(np.mean([served.evaluate(point, {"seed": seed, "inputs": given})[1] for seed in range(count)]))

    assert mean(UPRIGHT, 20) == pytest.approx(FASTEST, rel=0.1)
    assert mean(LYING, 20) == pytest.approx(SLOWEST, rel=0.25)
    assert mean(None, 60) == pytest.approx(SLOWEST + (FASTEST - SLOWEST) / 3.0, rel=0.3)


def test_bounces_are_averaged_over_the_attitude(
    results: StudyResults, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("lithobrake.pipeline.inferred_study.height_of_beds", lambda study, folder: 0.0)
    for name, few in (("MOST_BOUNCES", 4), ("PRIOR_POINTS", 256), ("REPLICATES", 50)):
        monkeypatch.setattr(import_module("lithobrake.analysis.identifiability"), name, few)
    infer = import_module("lithobrake.analysis.bayesian_inference").infer
    monkeypatch.setitem(infer.__kwdefaults__, "refit_count", 8)
    path = tmp_path / "bounces.csv"
    path.write_text("speed_out\n0.03\n0.1\n", encoding="utf-8")
    inferred = InferredStudy.open(results.folder)
    content = inferred.infer(path)
    # Both speeds are those of some attitude, and neither says anything of the soil.
    assert set(content["inputs"]) == set(SOIL)
    assert all(one["sd_ratio"] > 0.9 for one in content["inputs"].values())
    assert min(content["predictive_p_value"]) > 0.05
    assert set(inferred.plan().inputs) == set(SOIL)
    path.write_text("attitude.upright_z,speed_out\n0.5,0.1\n", encoding="utf-8")
    with pytest.raises(ValueError, match=r"gives attitude.upright_z of a bounce; allowed: none"):
        inferred.infer(path)


def runs_of(**impact: Any) -> tuple[DrawnDesign, dict[str, np.ndarray]]:
    design = DrawnDesign(check_tables(tables(impact=impact), Path()))
    return design, {name: np.array([row[name] for row in design.rows]) for name in design.rows[0]}


def test_an_attitude_that_is_fixed_is_no_input() -> None:
    assert attitude_laws(*runs_of(orientation=[1.0, 0.0, 0.0, 0.0], azimuth_deg=0.0)) == {}
    # Upright about its axis a prism is the same from wherever it comes.
    assert attitude_laws(*runs_of(orientation=[1.0, 0.0, 0.0, 0.0])) == {}
    # Lying it is not.
    assert set(attitude_laws(*runs_of(orientation=list(LYING)))) == {"attitude.along_z"}
    ball = DrawnDesign(check_tables(synthetic_tables(), Path()))
    assert attitude_laws(ball, {name: np.array([row[name] for row in ball.rows]) for name in ball.rows[0]}) == {}


def test_a_pointed_lander_has_the_attitudes_of_its_runs() -> None:
    design, runs = runs_of(orientation=[1.0, 0.0, 0.0, 0.0], pointing_error_deg=30.0)
    laws = attitude_laws(design, runs)
    assert set(laws) == set(TERMS)
    least, most = laws["attitude.upright_z"].support
    # Within a cone of 30 degrees.
    assert 0.75 <= least < 0.78
    assert most <= 1.0
    normal, travel = seen_from_lander(
        np.column_stack([runs[name] for name in ORIENTATION]), np.radians(runs[IMPACT_AZIMUTH])
    )
    known = np.column_stack([normal[:, 2] ** 2, 2.0 * normal[:, 2] * travel[:, 2]])
    drawn = drawn_attitudes(design, runs, {}, 500, 3)
    found = np.column_stack([drawn[name] for name in TERMS[:2]])
    assert np.abs(found[:, None] - known[None]).max(axis=2).min(axis=1).max() < 1e-12
    # An azimuth that was sampled is kept: from the side a lander that leans along x leans no way.
    along = drawn_attitudes(design, runs, {IMPACT_AZIMUTH: np.full(500, 90.0)}, 500, 3)
    across = drawn_attitudes(design, runs, {IMPACT_AZIMUTH: np.full(500, 270.0)}, 500, 3)
    assert along["attitude.lean_z"] == pytest.approx(-across["attitude.lean_z"], abs=1e-12)


def test_the_tables_of_a_pointed_lander_have_its_attitudes(tmp_path: Path) -> None:
    changes = {"impact": {"orientation": [1.0, 0.0, 0.0, 0.0], "pointing_error_deg": 60.0}}
    changes["monte_carlo"] = {"sample_count": 200}
    source = StudySource.of_tables(tables(**changes), function_identity(by_attitude))
    run_study(source, tmp_path / "out", until="sample", worker_count=1, model=by_attitude)
    found = open_study(tmp_path / "out")
    attitude = found.explorer.attitude
    assert (len(attitude.drawn), attitude.sides) == (96, {})
    own = np.column_stack([found.runs[name] for name in ORIENTATION])
    known = np.sort(seen_from_lander(own, np.zeros(96))[0][:, 2] ** 2)
    assert np.sort(np.array(attitude.drawn)[:, 0]) == pytest.approx(known, abs=1e-12)
    with h5py.File(found.folder / "samples.h5") as file:
        assert list(file.attrs["input_names"])[-3:] == TERMS
    point = {name: law.median for name, law in list(found.emulator.model.runs.inputs.items())[: len(SOIL)]}
    speed = found.emulator.sample(point, 2000)["speed_out"]
    assert np.nanmean(speed) == pytest.approx(SLOWEST + (FASTEST - SLOWEST) * known.mean(), rel=0.05)
