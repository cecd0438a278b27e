"""The density of an emulator is about that of its draws: it integrates to their chances, and falls where they do."""

import numpy as np
import pytest

from lithobrake import emulator
from lithobrake.chaos import Uniform, sobol_sequence
from lithobrake.emulator import Emulator
from lithobrake.emulator.residual_rows import SMOOTHING_FACTOR

INPUTS = {"friction": Uniform(0.0, 1.0), "speed": Uniform(0.0, 1.0)}
SOIL = [[0.7, 0.4]]
GRID = np.linspace(1e-3, 1.0 - 1e-3, 1500)


@pytest.fixture(scope="module")
def model() -> Emulator:
    """An output between 0 and 1, one without bounds, a rider, and a tenth of the runs without outputs."""
    random, x = np.random.default_rng(1), sobol_sequence(INPUTS, 160, seed=2)
    first = 2.0 * x[:, 0] - 1.0 + 0.6 * random.standard_normal(160)
    second = first + x[:, 1] + random.gamma(2.0, 0.4, 160)
    y = np.column_stack([1.0 / (1.0 + np.exp(-first)), second, random.uniform(size=160)])
    outcome = np.where(random.random(160) < 0.1, "captured", "clear")
    y[outcome == "captured"] = np.nan
    return emulator.fit(
        INPUTS, x, y, outcome=outcome, lower=[0.0, -np.inf, -np.inf], upper=[1.0, np.inf, np.inf],
        riders=["place"], output_names=["share", "height", "place"],
    )  # fmt: skip


def densities(model: Emulator, name: str, grid: np.ndarray, **errors: float) -> np.ndarray:
    return np.exp([model.log_density({name: value}, SOIL, errors=errors)[0] for value in grid.tolist()])


def test_the_density_of_an_output_integrates_to_the_chance_of_having_outputs(model: Emulator) -> None:
    clear = model.outcome_probability(SOIL)[0, model.outcome_names.index("clear")]
    assert np.trapezoid(densities(model, "share", GRID), GRID) == pytest.approx(clear, rel=1e-3)
    heights = np.linspace(-10.0, 15.0, 1500)
    assert np.trapezoid(densities(model, "height", heights), heights) == pytest.approx(clear, rel=1e-6)


def test_draws_fall_where_a_density_with_their_kernels_says(model: Emulator, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("lithobrake.emulator.observed_density.DENSITY_FACTOR", SMOOTHING_FACTOR)
    drawn = model.sample(SOIL, 40_000, seed=3)[0]
    clear = np.isfinite(drawn[:, 0]).mean()
    steps = np.linspace(0.1, 0.95, 8)
    density = densities(model, "share", GRID)
    expected = [np.trapezoid(np.where(step >= GRID, density, 0.0), GRID) for step in steps]
    # Four standard deviations of a share of 40000 draws.
    assert [(drawn[:, 0] <= step).mean() for step in steps] == pytest.approx(expected, abs=0.01)
    assert clear == pytest.approx(np.trapezoid(density, GRID), abs=0.01)


def test_what_is_not_observed_drops_out(model: Emulator) -> None:
    heights = np.linspace(-10.0, 15.0, 1200)
    joint = np.exp([model.log_density({"share": 0.6, "height": one}, SOIL)[0] for one in heights.tolist()])
    assert np.trapezoid(joint, heights) == pytest.approx(np.exp(model.log_density({"share": 0.6}, SOIL)[0]), rel=1e-6)


def test_an_error_blurs_the_density(model: Emulator) -> None:
    heights = np.linspace(-10.0, 15.0, 1500)
    sharp, blurred = densities(model, "height", heights), densities(model, "height", heights, height=0.5)
    kernel = np.exp(-0.5 * ((heights[:, None] - heights) / 0.5) ** 2) / (0.5 * np.sqrt(2.0 * np.pi))
    assert blurred == pytest.approx(np.trapezoid(kernel * sharp, heights, axis=1), abs=1e-6)


def test_an_outcome_alone_has_its_chance_and_what_lies_beyond_a_bound_none(model: Emulator) -> None:
    captured = model.outcome_probability(SOIL)[0, model.outcome_names.index("captured")]
    assert model.log_density({}, SOIL, outcome="captured")[0] == pytest.approx(np.log(captured))
    assert model.log_density({"share": 1.2}, SOIL)[0] == -np.inf


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"observed": {"place": 0.5}}, "place is observed as 0.5; allowed: finite numbers of share, height"),
        ({"observed": {"share": np.nan}}, "observed share is nan"),
        ({"observed": {"share": 0.5}, "errors": {"height": 0.1}}, "the error of height is 0.1"),
        ({"observed": {"share": 0.5}, "errors": {"share": -0.1}}, "the error of share is -0.1"),
        ({"observed": {"share": 0.5}, "errors": {"share": 1e300}},
         r"is 1e\+300, but must be a finite number of at least 0 and of at most 1e\+100"),
        ({"observed": {"share": 0.5}, "outcome": "captured"}, "outcome is 'captured', which has no outputs"),
        ({"observed": {}, "outcome": "lost"}, "outcome is 'lost'; allowed: captured, clear"),
    ],
)  # fmt: skip
def test_names_and_values_that_cannot_be_are_refused(model: Emulator, arguments: dict, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        model.log_density(x=SOIL, **arguments)
