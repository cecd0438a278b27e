"""Emulators of every kind that a bounce law may be of, fitted in small, and laws read in both languages."""

import importlib.util
import subprocess
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
import pytest

from lithobrake import emulator
from lithobrake.chaos import Distribution, LogUniform, Normal, Uniform
from lithobrake.emulator import Emulator, fitting, ridge_ladder
from lithobrake.export import ExportOptions
from lithobrake.export.bounce_law import LAW, READERS, write_bounce_law
from lithobrake.geometry.attitude import AttitudeTerms
from lithobrake.pipeline.first_touchdown.explorer_tables import tables_of_refits
from lithobrake.results import NamedEmulator
from lithobrake.results.table import ExplorerAttitude, Table
from lithobrake.vocabulary.quantities import ORIENTATION_OUT, Quantity

from ..pipeline.few_terms import few_terms
from ..quick_studies import quick_studies

RUNS, BEDS = 60, 6
OUTPUTS = (
    "speed_out",
    "elevation_out",
    "spin_out",
    "azimuth_out",
    "spin_out_x",
    "spin_out_y",
    "spin_out_z",
    "duration",
)
GIVEN: dict[str, Distribution] = {
    "grain.friction": Normal(0.6, 0.1), "impact.speed": LogUniform(0.02, 0.2),
    "impact.incidence_deg": Uniform(0.0, 60.0),
}  # fmt: skip
BOUND = {
    "height": 0.3, "across": 0.4, "time_limit": 0.0, "smallest": 0.002, "largest": 0.005, "mass_power": -1.0,
    "diameter_power": 0.0, "impact.speed": 0.06, "impact.spin_x": 0.2, "impact.spin_y": 0.0, "impact.spin_z": 0.1,
    "lander.mass": 2.0, "surface.gravity": 4e-5, "surface.slope_deg": 3.0,
}  # fmt: skip
TERMS: dict[str, AttitudeTerms | None] = {
    "ball": None,
    "box": AttitudeTerms.of_box(np.array([0.1, 0.2, 0.3])),
    "cube": AttitudeTerms.of_box(np.array([0.1, 0.1, 0.1])),
    "mesh": AttitudeTerms.of_body(np.array([[2.0, 0.1, 0.0], [0.1, 3.0, 0.2], [0.0, 0.2, 4.0]])),
}


@contextmanager
def any_fit() -> Iterator[None]:
    """Emulators are fitted by few penalties and folds, and look for no distant bounds: a law holds what was fitted,
    well or not. Those with distant bounds have them put in.
    """
    with quick_studies(), few_terms(), pytest.MonkeyPatch.context() as patch:
        patch.setattr(ridge_ladder, "PENALTIES", (1e-2, 0.3))
        patch.setattr(fitting, "FOLDS", 2)
        patch.setattr(fitting, "with_distant_bounds", lambda runs, terms, matrix: runs)
        yield


class Results(SimpleNamespace):
    """What a law is written from, of no study."""

    emulator: NamedEmulator
    folder: Path


def known_results(lander: str) -> Results:
    """Touchdowns of a lander that leave with some of their speed, and their emulator."""
    random, terms = np.random.default_rng(5), TERMS[lander]
    ranges = {} if terms is None else {f"attitude.{name}": Uniform(*ends) for name, ends in terms.ranges.items()}
    inputs = GIVEN | ranges
    x = np.column_stack([law.ppf(random.random(RUNS)) for law in inputs.values()])
    y, upper = _landings(x, random)
    outcome = np.where(
        random.random(RUNS) < 0.15, "captured", np.where(random.random(RUNS) < 0.1, "time_limit", "clear")
    )
    y[outcome != "clear"] = np.nan
    model = emulator.fit(
        inputs, x, y, groups=np.arange(RUNS) % BEDS, outcome=outcome, lower=[0.0] * 3 + [-np.inf] * 5, upper=upper,
        riders=OUTPUTS[3:], outcomes=("clear", "captured", "time_limit"), output_names=OUTPUTS,
    )  # fmt: skip
    touchdowns = {
        "touchdown": np.arange(RUNS) % 3, "outcome": outcome, "surface.gravity": np.full(RUNS, 4e-5),
        "surface.slope_deg": np.full(RUNS, 3.0), "displacement_x": random.random(RUNS), **_attitudes(random),
        **dict(zip(inputs, x.T, strict=True)), **dict(zip(OUTPUTS, y.T, strict=True)),
    }  # fmt: skip
    touchdowns["duration"] = np.where(outcome == "captured", random.random(RUNS), y[:, 7])
    table = Table.of("touchdown", {name: (Quantity("", ""), values) for name, values in touchdowns.items()})
    study = {"title": f"A {lander}", "lander": {"shape": lander}, "ground": None}
    return of_model(Results(touchdowns=table, study=study, folder=Path("study")), model, lander)


def of_model(results: Results, model: Emulator, lander: str) -> Results:
    """The same results with another emulator of the same touchdowns."""
    terms = TERMS[lander]
    kind = None if terms is None else ExplorerAttitude(
        tuple(f"attitude.{name}" for name in terms.ranges), terms.axes.tolist(), terms.has_sides, terms.is_cube, {}
    )  # fmt: skip
    explorer = replace(tables_of_refits(model.refits(2, 1), BOUND), attitude=kind)
    named = NamedEmulator(model, {}, lambda: BOUND, kind)
    return Results(**vars(results) | {"touchdown_explorer": explorer, "emulator": named})


def _landings(x: np.ndarray, random: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Outputs of touchdowns and their upper bounds, [RUNS, 8] each."""
    friction, speed, incidence = x.T[:3]
    allowed = np.sqrt(speed**2 + 0.005 * 0.05 + 2e-5)
    share = 0.5 * np.exp(-friction + 0.01 * incidence - random.gamma(2.0, 0.3, RUNS))
    axis = random.standard_normal((RUNS, 3))
    rate = random.uniform(0.05, 0.3, RUNS) * allowed / 0.045
    y = np.column_stack([share * speed, random.uniform(0.1, 1.4, RUNS), rate,
                         random.uniform(-3.0, 3.0, RUNS), axis, random.uniform(5.0, 60.0, RUNS)])  # fmt: skip
    upper = np.full(y.shape, np.inf)
    upper[:, 0], upper[:, 1], upper[:, 2] = allowed, 0.5 * np.pi, allowed / np.sqrt(0.002)
    return y, upper


def _attitudes(random: np.random.Generator) -> dict[str, np.ndarray]:
    drawn = random.standard_normal((RUNS, 4))
    return dict(zip(ORIENTATION_OUT, (drawn / np.linalg.norm(drawn, axis=1, keepdims=True)).T, strict=True))


def written(results: Any, folder: Path) -> Path:
    """The law of results, with its readers beside it."""
    write_bounce_law(results, [folder / name for name in (LAW, *READERS)], ExportOptions())
    return folder / LAW


def reader(folder: Path) -> ModuleType:
    """The reader in Python that an export has laid into a folder."""
    spec = importlib.util.spec_from_file_location("carried_bounce_law", folder / READERS[0])
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def compiled(folder: Path, compiler: str) -> Path:
    """A program that draws from a law, of the reader in C that an export has laid into a folder."""
    program = folder / "draw_law"
    own = Path(__file__).with_name("draw_law.c")
    flags = ["-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-O1", f"-I{folder}"]
    words = [compiler, *flags, str(own), str(folder / READERS[2]), "-lm", "-o", str(program)]
    ended = subprocess.run(words, capture_output=True, text=True, check=False)
    assert ended.returncode == 0, ended.stderr
    return program


def lines_of(program: Path, law: Path, asked: Sequence[Sequence[float]]) -> list[str]:
    """What the program says to each row of seed, draw, fit, attitude, spin and conditions."""
    given = "\n".join(" ".join(f"{value:.17g}" for value in row) for row in asked)
    ended = subprocess.run([str(program), str(law)], input=given, capture_output=True, text=True, check=False)
    assert ended.returncode == 0, ended.stderr
    return ended.stdout.splitlines()


class GivenNumbers:
    """The random numbers of a law in the place of a generator, in the order in which an emulator asks for them."""

    def __init__(self, law: ModuleType, seed: int, draws: Sequence[int]) -> None:
        """Take the numbers of some draws of a seed."""
        places = [[law.uniform(seed, draw, place) for place in range(law.SOIL)] for draw in draws]
        table = np.array(places)
        self.uniforms = iter((table[:, law.OUTCOME], table[:, law.ROW]))
        self.normals = np.array([law._normals(row[law.NOISE :].tolist()) for row in table])

    def random(self, shape: tuple[int, int]) -> np.ndarray:
        """Uniform numbers, first those of the outcome, then those of the row."""
        return next(self.uniforms).reshape(shape)

    def standard_normal(self, shape: tuple[int, ...]) -> np.ndarray:
        """Normal numbers of the smoothing."""
        return self.normals.reshape(shape)


def given_numbers(patch: pytest.MonkeyPatch, law: ModuleType, seed: int, draws: Sequence[int]) -> None:
    """Have emulators draw by the numbers of a law, once."""
    patch.setattr("lithobrake.emulator.model.random_numbers", lambda _: GivenNumbers(law, seed, draws))


def middle(ranges: Mapping[str, tuple[float, float]], share: float) -> dict[str, float]:
    """Conditions at a share of their ranges; without an end about 0.6."""
    ends = {name: (low, high) if np.isfinite([low, high]).all() else (0.3, 0.9) for name, (low, high) in ranges.items()}
    return {name: low + share * (high - low) for name, (low, high) in ends.items()}
