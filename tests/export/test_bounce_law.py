"""A bounce law draws what the emulator of its study draws, in Python and in C, and refuses what it does not know."""

import runpy
import shutil
import zlib
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any, ClassVar

import numpy as np
import pytest
from scipy import stats
from scipy.spatial.transform import Rotation
from typer.testing import CliRunner

from lithobrake.cli import app
from lithobrake.export import export_study
from lithobrake.export.bounce_law import FITS, LAW, READERS
from lithobrake.pipeline import StudyFolder
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.journeys.touchdown_emulator import TouchdownEmulator
from lithobrake.results import StudyResults, open_study
from lithobrake.study import StudySource
from lithobrake.vocabulary.quantities import ORIENTATION_OUT

from ..pipeline.few_terms import few_terms
from .known_laws import (
    TERMS,
    Results,
    any_fit,
    compiled,
    given_numbers,
    known_results,
    lines_of,
    middle,
    of_model,
    reader,
    written,
)

EXAMPLES = Path(__file__).parents[2] / "examples"
SEED, DRAWS = 3, 80
COMPILER = shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")
NONE = [np.nan]


@pytest.fixture(scope="module")
def results(asked_folder: Path) -> StudyResults:
    return open_study(asked_folder)


@pytest.fixture(scope="module")
def folder(asked_folder: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What `lithobrake export` lays into a folder."""
    place = tmp_path_factory.mktemp("law")
    words = ["export", str(asked_folder), "--to", "bounce-law", "--out", str(place / "out")]
    assert CliRunner().invoke(app, words).exit_code == 0
    return place / "out"


@pytest.fixture(scope="module")
def program(folder: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A program that draws from a law by the reader in C."""
    if COMPILER is None:
        pytest.skip("no C compiler (cc, gcc, clang) is installed")
    place = tmp_path_factory.mktemp("c") / "out"
    shutil.copytree(folder, place)
    return compiled(place, COMPILER)


@pytest.fixture(scope="module")
def law(folder: Path) -> Any:
    return reader(folder).BounceLaw(folder / LAW)


def asked(law: Any, count: int, seed: int = 1) -> list[tuple[dict[str, float], np.ndarray, np.ndarray]]:
    """Conditions inside the ranges, attitudes w, x, y, z and spins of touchdowns."""
    random = np.random.default_rng(seed)
    ends = [tuple(middle(law.ranges, share).values()) for share in (0.0, 1.0)]
    attitudes = Rotation.random(count, rng=random).as_quat(scalar_first=True)
    x = random.uniform(*ends, size=(count, len(law.ranges)))
    spins = random.normal(0.0, 0.3, (count, 3))
    return [
        (dict(zip(law.conditions, row.tolist(), strict=True)), *pair)
        for row, *pair in zip(x, attitudes, spins, strict=True)
    ]


def test_the_export_has_the_law_and_its_readers(folder: Path, law: Any) -> None:
    assert {path.name for path in folder.iterdir() if path.is_file()} == {LAW, *READERS}
    text = (folder / LAW).read_text(encoding="utf-8")
    assert "z along the outward normal" in text
    assert max(map(len, text.partition("\nnames")[0].splitlines())) < 200
    assert law.fit_count == 1 + FITS
    assert dict(law.units)["impact.speed"] == "m/s"
    assert "import lithobrake" not in (folder / READERS[0]).read_text(encoding="utf-8")


@pytest.mark.parametrize("fit", [1, 7])
def test_the_law_draws_as_the_emulator_of_journeys(
    law: Any, folder: Path, asked_folder: Path, monkeypatch: pytest.MonkeyPatch, fit: int
) -> None:
    study = StudySource.read(asked_folder / "study.toml").study
    with few_terms():
        model = TouchdownEmulator.read(DrawnDesign(study), StudyFolder(asked_folder))
    assert {name: law.ranges[name] for name in model.ranges} == model.ranges
    given = asked(law, DRAWS)
    inputs = {name: np.array([one[name] for one, _, _ in given]) for name in law.conditions}
    attitudes = Rotation.from_quat(np.array([one for _, one, _ in given]), scalar_first=True)
    spins = np.array([one for *_, one in given])
    given_numbers(monkeypatch, reader(folder), SEED, range(DRAWS))
    answers = model.answers(inputs | model.attitude_of(attitudes), spins, np.full(DRAWS, fit - 1), 0)
    for number, (conditions, attitude, spin) in enumerate(given):
        one = law.draw(conditions, SEED, number, attitude=attitude, spin=spin, fit=fit)
        assert one.outcome == answers.outcome[number]
        if one.outcome == "clear":
            assert one.velocity == pytest.approx(answers.velocity[number], rel=1e-9, abs=1e-12)
            assert one.spin == pytest.approx(answers.spin[number], rel=1e-9, abs=1e-12)
            assert one.duration == answers.duration[number]
    assert {"clear", "captured"} <= set(answers.outcome.tolist())


def test_quantiles_are_those_of_the_emulator(law: Any, results: StudyResults) -> None:
    """Of random numbers of its own; both samples follow one law, so no test should be rarer than one in 10 000."""
    conditions = middle(law.ranges, 0.4)
    plain = {name: value for name, value in conditions.items() if name in results.emulator.inputs}
    of_package = results.emulator.sample(plain, 4000, seed=8)
    drawn = [law.draw(conditions, 11, number) for number in range(3000)]
    outcomes = [[list(one).count(name) for name in law.outcomes] for one in
                (of_package["outcome"].tolist(), [one.outcome for one in drawn])]  # fmt: skip
    met = np.array(outcomes)[:, np.sum(outcomes, axis=0) > 0]
    assert stats.chi2_contingency(met).pvalue > 1e-4
    left, clear = [one for one in drawn if one.outcome == "clear"], of_package["outcome"] == "clear"
    for part in ("velocity", "spin"):
        vectors = np.array([getattr(one, part) for one in left])
        for axis, name in enumerate("xyz"):
            theirs = of_package[f"{part}_out_{name}"][clear]
            if np.ptp(theirs) > 0.0:
                assert stats.ks_2samp(vectors[:, axis], theirs).pvalue > 1e-4, (part, name)
    speeds = [np.linalg.norm([one.velocity for one in left], axis=1), of_package["speed_out"][clear]]
    levels = [np.quantile(one, [0.05, 0.25, 0.5, 0.75, 0.95]) for one in speeds]
    # Standard errors of quantiles of 3000 draws are a few hundredths of the interquartile range.
    assert np.abs(levels[0] - levels[1]).max() < 0.12 * (levels[0][3] - levels[0][1])
    assert stats.ks_2samp([one.duration for one in left], of_package["duration"][clear]).pvalue > 1e-4


def test_what_is_drawn_with_its_landing_is_of_one_landing(law: Any, results: StudyResults) -> None:
    touchdowns, conditions = results.touchdowns, middle(law.ranges, 0.3)
    left, rests = (touchdowns.where(touchdowns["outcome"] == name) for name in ("clear", "captured"))
    attitudes = np.column_stack([rests[name] for name in ORIENTATION_OUT])
    seen = set()
    for number in range(400):
        one = law.draw(conditions, SEED, number)
        seen.add(one.outcome)
        if one.outcome == "clear":
            assert one.attitude.tolist() == [left[name][one.row] for name in ORIENTATION_OUT]
            assert one.way.tolist() == [left["displacement_x"][one.row], left["displacement_y"][one.row], 0.0]
            assert np.arctan2(*one.velocity[1::-1]) == pytest.approx(left["azimuth_out"][one.row])
        elif one.outcome == "captured":
            row = int(np.flatnonzero((attitudes == one.attitude).all(axis=1))[0])
            assert (one.way[0], one.duration) == (rests["displacement_x"][row], rests["duration"][row])
            assert one.velocity.tolist() == [0.0, 0.0, 0.0]
        else:
            assert np.isnan(one.velocity).all()
    assert {"clear", "captured"} <= seen


def test_soils_are_those_of_the_landers(law: Any, results: StudyResults) -> None:
    first = results.touchdowns.where(results.touchdowns["touchdown"] == 0)
    names = [name for name in law.conditions if name.startswith("grain.")]
    known = {tuple(row) for row in np.column_stack([first[name] for name in names]).tolist()}
    drawn = [tuple(law.soil(SEED, journey).values()) for journey in range(200)]
    assert list(law.soil(SEED, 0)) == names
    assert set(drawn) <= known
    assert len(set(drawn)) > 0.8 * len(known)


def kinds(lander: str) -> list[Results]:
    """Results of a lander; of a box also without an energy bound, with distant bounds, and with rows of near inputs."""
    own = known_results(lander)
    model = own.emulator.model
    if lander != "box":
        return [own]
    runs = model.runs
    upper = runs.upper.copy()
    upper[:, [0, 2]] = np.inf
    choices = replace(model.choices, widths=(np.inf, *(1.5,) * (len(runs.inputs) - 1)))
    others = [
        replace(model, runs=replace(runs, upper=upper)).reweighted(model.weights),
        replace(model, runs=replace(runs, distant=(0, 1))).reweighted(model.weights),
        replace(model, choices=choices),
    ]
    return [own, *(of_model(own, other, lander) for other in others)]


@pytest.mark.parametrize("lander", TERMS)
def test_laws_of_every_kind_draw_as_their_emulators(
    lander: str, program: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with any_fit():
        of_kinds = kinds(lander)
    for own in of_kinds:
        place = written(own, tmp_path)
        law, terms = reader(tmp_path).BounceLaw(place), TERMS[lander]
        given = asked(law, DRAWS)
        # Neither in the emulator nor elsewhere than about what all touchdowns had.
        assert law.ranges["surface.gravity"] == pytest.approx((3.6e-5, 4.4e-5))
        inputs = {
            name: np.array([one[name] for one, _, _ in given]) for name in own.emulator.inputs if name in law.units
        }
        if terms is not None:
            turned = Rotation.from_quat(np.array([one for _, one, _ in given]), scalar_first=True).as_matrix()
            found = terms.at(turned[:, 2], turned[:, 0])
            inputs |= dict(zip([f"attitude.{name}" for name in terms.ranges], found.T, strict=True))
        given_numbers(monkeypatch, reader(tmp_path), SEED, range(DRAWS))
        table = own.emulator.sample(inputs, 1)
        for number, (conditions, attitude, _) in enumerate(given):
            one = law.draw(conditions, SEED, number, attitude=attitude)
            assert one.outcome == table["outcome"][number]
            if one.outcome == "clear":
                theirs = [table[f"{part}_out_{axis}"][number] for part in ("velocity", "spin") for axis in "xyz"]
                assert [*one.velocity, *one.spin] == pytest.approx(theirs, rel=1e-9, abs=1e-12)
        assert_c_agrees(law, place, program, given[:40])


def assert_c_agrees(law: Any, place: Path, program: Path, given: list[Any]) -> None:
    """Both readers give the same numbers, with and without attitude and spin, by any fit."""
    rows, expected = [], []
    for number, (conditions, attitude, spin) in enumerate(given):
        told = number % 3 > 0
        fit = number % law.fit_count
        rows.append([SEED, number, fit, *(attitude if told else NONE * 4), *(spin if told else NONE * 3),
                     *conditions.values()])  # fmt: skip
        given_too = {"attitude": attitude, "spin": spin} if told else {}
        one = law.draw(conditions, SEED, number, fit=fit, **given_too)
        soil = conditions | law.soil(SEED, number)
        expected.append([law.outcomes.index(one.outcome), one.row, *one.velocity, *one.spin, *one.attitude,
                         one.duration, *one.way, *soil.values()])  # fmt: skip
    found = np.array([line.split() for line in lines_of(program, place, rows)], dtype=float)
    assert found == pytest.approx(np.array(expected), rel=1e-12, abs=1e-15, nan_ok=True)


def test_python_and_c_draw_the_same(law: Any, folder: Path, program: Path) -> None:
    assert_c_agrees(law, folder / LAW, program, asked(law, DRAWS, seed=2))
    # The last one is that of the refusal, in the same words.
    conditions = middle(law.ranges, 0.5) | {"impact.speed": 9.0}
    (said,) = lines_of(program, folder / LAW, [[1, 0, 0, *NONE * 7, *conditions.values()]])
    with pytest.raises(ValueError, match="but the law holds from") as refused:
        law.draw(conditions, 1, 0)
    assert said == str(refused.value)


@pytest.mark.parametrize(("change", "said"), [
    (lambda text: text[: len(text) // 2], "was cut short or changed"),
    (lambda text: text.replace("0.3", "0.4", 1), "was cut short or changed"),
    (lambda text: text.replace("\n", "\r\n"), "was cut short or changed"),
    (lambda text: text.replace("law 1", "law 2", 1), "has version 2, but this reader reads 1"),
    (lambda text: '{"format": "another"}', "is no bounce law of lithobrake: its first line is"),
    (lambda text: "", "is no bounce law"),
    (lambda text: summed(text.replace("numbers rows 3", "numbers rows 9", 1)), "is damaged"),
    (lambda text: summed(text.replace("names units", "words units", 1)), "is damaged"),
])  # fmt: skip
def test_another_file_is_refused_in_one_sentence(
    folder: Path, program: Path, tmp_path: Path, change: Any, said: str
) -> None:
    path = tmp_path / "law.txt"
    path.write_text(change((folder / LAW).read_text(encoding="utf-8")), encoding="utf-8", newline="")
    with pytest.raises(ValueError, match=said):
        reader(folder).BounceLaw(path)
    with pytest.raises(AssertionError, match=said):
        lines_of(program, path, [])


def summed(text: str) -> str:
    """A law with the sum of what it now holds."""
    body = text[: text.rindex("end ")]
    return f"{body}end {zlib.crc32(body.encode()):08x}\n"


@pytest.mark.parametrize(("change", "said"), [
    ({"impact.speed": 9.0}, "impact.speed is 9 m/s, but the law holds from"),
    ({"impact.speed": 1e-9}, "impact.speed is 1e-09 m/s, but the law holds from"),
    ({"surface.gravity": 9.81}, "surface.gravity is 9.81 m/s2"),
    ({"grain.friction": float("nan")}, "grain.friction is nan, but the law"),
    ({"grain.friction": float("inf")}, "grain.friction is inf, but the law"),
    ({"grain.friction": 0.1}, "grain.friction is 0.1, but the law holds from 0.5 to 0.9"),
])  # fmt: skip
def test_conditions_outside_the_range_are_refused(law: Any, folder: Path, change: dict[str, float], said: str) -> None:
    with pytest.raises(ValueError, match=said) as refused:
        law.draw(middle(law.ranges, 0.5) | change, 1, 0)
    assert type(refused.value).__name__ == "OutsideRangeError"


@pytest.mark.parametrize(("given", "said"), [
    ({"attitude": [0.0, 0.0, 0.0, 0.0]}, "allowed: a quaternion w, x, y, z that is not 0"),
    ({"attitude": [1.0, 0.0, 0.0]}, "allowed: a quaternion"),
    ({"spin": [0.0, float("inf"), 0.0]}, "allowed: three finite numbers"),
    ({"fit": 99}, "fit is 99; allowed: 0 to"),
])  # fmt: skip
def test_arguments_that_cannot_be_are_refused(law: Any, given: dict[str, Any], said: str) -> None:
    with pytest.raises(ValueError, match=said):
        law.draw(middle(law.ranges, 0.5), 1, 0, **given)


def test_missing_and_unknown_conditions_are_refused(law: Any) -> None:
    conditions = middle(law.ranges, 0.5)
    with pytest.raises(ValueError, match="give exactly"):
        law.draw(conditions | {"speed": 0.05}, 1, 0)
    del conditions["impact.speed"]
    with pytest.raises(ValueError, match="give exactly"):
        law.draw(conditions, 1, 0)


def test_draws_do_not_depend_on_each_other(law: Any, folder: Path) -> None:
    uniform = reader(folder).uniform
    # Output of SplitMix64 from state 0 on: the first of them mixes the seed, which starts the others.
    assert reader(folder)._mixed(0x9E3779B97F4A7C15) == 0xE220A8397B1DCDAF
    numbers = np.array([[uniform(seed, draw, place) for place in range(4)] for seed in range(3) for draw in range(700)])
    assert stats.kstest(numbers.ravel(), "uniform").pvalue > 1e-3
    assert np.abs(np.corrcoef(numbers.T) - np.eye(4)).max() < 0.08
    assert abs(np.corrcoef(numbers[:-1, 0], numbers[1:, 0])[0, 1]) < 0.08
    conditions = middle(law.ranges, 0.5)
    assert law.draw(conditions, 1, 5).outcome == law.draw(conditions, 1, 5).outcome
    assert np.array_equal(law.draw(conditions, 1, 5).velocity, law.draw(conditions, 1, 5).velocity, equal_nan=True)


def test_a_study_without_an_emulator_of_touchdowns_is_refused(delivered: StudyResults, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="has no emulator of touchdowns, of which a bounce law is made"):
        export_study(delivered, tmp_path, ["bounce-law"])
    assert not list(tmp_path.iterdir())


def test_landers_of_a_loop_of_its_own_end_as_those_of_the_study(folder: Path, results: StudyResults) -> None:
    """The body of the example is a sphere without a partner, so ends agree roughly."""
    ends = runpy.run_path(str(EXAMPLES / "bounce_law_loop.py"))["main"](str(folder), 60)
    assert results.results.emulated is not None
    rests = results.results.emulated.ends["at_rest"].share.value
    # Two standard errors of a fraction of 60 landers are 0.08 at 0.9.
    assert ends["captured"] / 60 == pytest.approx(rests, abs=0.15)
    assert ends["outside the range of the law"] < 6


def test_mujoco_goes_on_with_the_state_of_the_law(folder: Path) -> None:
    """A touchdown that gives back what it was asked about leaves the state as it was: frames and axes fit."""
    mujoco = pytest.importorskip("mujoco")
    example = runpy.run_path(str(EXAMPLES / "bounce_law_mujoco.py"))
    data = mujoco.MjData(mujoco.MjModel.from_xml_string(example["MODEL"]))
    data.qpos[3:7] = np.array([3.0, 5.0, -2.0, 7.0]) / np.sqrt(87.0)
    data.qvel[:] = (0.02, 0.01, -0.05, 0.1, 0.2, 0.3)
    before = np.concatenate([data.qpos, data.qvel])
    example["touch_down"](Unchanged(), data, {}, 0)
    assert np.concatenate([data.qpos, data.qvel]) == pytest.approx(before, abs=1e-14)
    assert example["main"](str(folder))[1] > 0


class Unchanged:
    """A law by which a touchdown changes nothing."""

    ranges: ClassVar = {"impact.speed": (0.0, 1.0)}

    def draw(self, conditions: dict[str, float], seed: int, draw: int, attitude: Any, spin: Any) -> SimpleNamespace:
        """Give back the arrival."""
        incidence = np.radians(conditions["impact.incidence_deg"])
        velocity = conditions["impact.speed"] * np.array([np.sin(incidence), 0.0, -np.cos(incidence)])
        state = {"velocity": velocity, "spin": np.array(spin), "attitude": np.array(attitude), "way": np.zeros(3)}
        return SimpleNamespace(outcome="clear", duration=0.0, **state)
