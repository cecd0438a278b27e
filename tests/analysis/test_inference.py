"""From bounces to inputs: against a posterior in closed form, and what is said where nothing is learnt."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from lithobrake import emulator
from lithobrake.analysis import (
    Observation,
    bed_shares,
    beds_statement,
    identifiability,
    infer,
    predictive_p_value,
)
from lithobrake.chaos import Normal, sobol_sequence
from lithobrake.emulator import Emulator

from ..pipeline.few_terms import few_terms
from ..quick_studies import quick_studies

# A response that follows the first input and not the second: y = slope * friction + scatter, all normal.
INPUTS = {"friction": Normal(0.0, 1.0), "density": Normal(0.0, 1.0)}
SLOPE, SCATTER = 1.0, 0.7


@pytest.fixture(scope="module", autouse=True)
def quick() -> Iterator[None]:
    """Emulators of these straight laws choose among less."""
    with quick_studies(), few_terms():
        yield


@pytest.fixture(scope="module")
def model() -> Emulator:
    random, x = np.random.default_rng(1), sobol_sequence(INPUTS, 300, seed=2)
    # Scatter in equal steps of probability, so that 300 runs have the moments of the law.
    scatter = stats.norm.ppf((random.permutation(300) + 0.5) / 300)
    return emulator.fit(
        INPUTS, x, SLOPE * x[:, 0] + SCATTER * scatter, groups=np.arange(300) % 30, output_names=["speed"]
    )


def closed_form(values: list[float], error: float = 0.0) -> tuple[float, float]:
    """Mean and standard deviation of friction given these responses, each with an error."""
    precision = 1.0 + len(values) * SLOPE**2 / (SCATTER**2 + error**2)
    return sum(values) * SLOPE / (SCATTER**2 + error**2) / precision, precision**-0.5


def moments(values: np.ndarray, weights: np.ndarray) -> tuple[float, float]:
    mean = float(weights @ values)
    return mean, float(np.sqrt(weights @ (values - mean) ** 2))


@pytest.mark.parametrize(("values", "error"), [([1.2], 0.0), ([1.2], 0.8), ([0.9, 1.4, 0.4, 1.1], 0.0)])
def test_the_posterior_of_a_linear_law_is_met(model: Emulator, values: list[float], error: float) -> None:
    seen = [Observation({"speed": value}, {"speed": error} if error else {}) for value in values]
    found = infer(model, seen, refit_count=5, point_count=1024)
    mean, deviation = closed_form(values, error)
    # 300 runs know the mean of a soil to about a twentieth of the scatter.
    assert moments(found.points[:, 0], found.weights) == pytest.approx((mean, deviation), abs=0.1)
    learnt = found.learnt()
    assert learnt["friction"].sd_ratio == pytest.approx(deviation, abs=0.1)
    exact = 0.5 * (mean**2 + deviation**2 - 1.0) - np.log(deviation)
    assert learnt["friction"].information == pytest.approx(exact, abs=0.15)
    assert learnt["friction"].after.lower < mean < learnt["friction"].after.upper
    assert learnt["density"].sd_ratio == pytest.approx(1.0, abs=0.05)
    assert learnt["density"].information < 0.03
    assert found.statement().endswith("; the data say nothing about density.")


BED = 0.4


@pytest.fixture(scope="module")
def on_beds() -> Emulator:
    """The same response, of whose scatter beds have a part of the variance: 60 of 5 runs each."""
    random, x = np.random.default_rng(6), sobol_sequence(INPUTS, 300, seed=2)
    bed = np.arange(300) % 60
    effects, rest = (stats.norm.ppf((random.permutation(count) + 0.5) / count) for count in (60, 300))
    scatter = np.sqrt(BED) * effects[bed] + np.sqrt(1.0 - BED) * rest
    return emulator.fit(INPUTS, x, SLOPE * x[:, 0] + SCATTER * scatter, groups=bed, output_names=["speed"])


def test_bounces_on_one_bed_share_its_effect(on_beds: Emulator) -> None:
    values = [0.9, 1.4, 0.4, 1.1]
    alone = [Observation({"speed": value}) for value in values]
    found = infer(on_beds, [replace(one, bed="tray") for one in alone], refit_count=0, point_count=1024)
    # Their mean has the variance of the bed, and a fourth of the rest.
    share = bed_shares(on_beds)["speed"]
    precision = 1.0 + SLOPE**2 / (SCATTER**2 * (share + (1.0 - share) / 4))
    mean = np.mean(values) * (1.0 - 1.0 / precision) / SLOPE
    assert share == pytest.approx(BED, abs=0.12)
    assert moments(found.points[:, 0], found.weights) == pytest.approx((mean, precision**-0.5), abs=0.1)
    apart = infer(on_beds, alone, refit_count=0, point_count=1024)
    assert apart.learnt()["friction"].sd_ratio < 0.85 * found.learnt()["friction"].sd_ratio
    named = infer(on_beds, [replace(one, bed=str(k)) for k, one in enumerate(alone)], refit_count=0, point_count=1024)
    assert (named.weights == apart.weights).all()


def test_which_bounces_share_a_bed_is_said(on_beds: Emulator, model: Emulator) -> None:
    one = Observation({"speed": 1.0}, bed="tray")
    assert beds_statement(on_beds, [one]) is None
    apart = beds_statement(on_beds, [one, Observation({"speed": 1.2})])
    assert apart.startswith("The 2 bounces count as on beds of their own")
    shared = beds_statement(on_beds, [one, one, Observation({"speed": 1.2})])
    assert shared.startswith("Of the 3 bounces 2 share bed tray; of the scatter at one soil the bed has: speed ")


def test_a_shared_bed_needs_runs_that_share_beds() -> None:
    x = sobol_sequence(INPUTS, 40, seed=2)
    lone = emulator.fit(INPUTS, x, x[:, 0] + 0.1 * np.random.default_rng(2).standard_normal(40))
    with pytest.raises(ValueError, match="no bed of the emulator has two runs with outputs"):
        infer(lone, [Observation({"y0": 1.0}, bed="tray")] * 2, refit_count=0)


def test_many_bounces_take_points_near_those_that_carry_weight(model: Emulator) -> None:
    # They scatter as the law does: thirty that are alike would speak for soils with less scatter.
    values = (1.5 + SCATTER * stats.norm.ppf((np.arange(30) + 0.5) / 30)).tolist()
    found = infer(model, [Observation({"speed": value}) for value in values], refit_count=0, point_count=1024)
    assert found.is_reliable
    assert len(found.points) == 1024
    mean, deviation = closed_form(values)
    # What thirty responses leave is as small as what the emulator does not know of the law.
    assert moments(found.points[:, 0], found.weights) == pytest.approx((mean, deviation), abs=0.1)
    assert found.learnt()["density"].sd_ratio == pytest.approx(1.0, abs=0.2)


def test_what_is_known_of_a_bounce_is_not_inferred_and_what_it_draws_anew_teaches_less(model: Emulator) -> None:
    known = infer(model, [Observation({"speed": 1.2}, known={"density": 0.5})], refit_count=0)
    assert list(known.inputs) == ["friction"]
    assert known.points.shape[1] == 1
    seen = [Observation({"speed": value}) for value in (0.9, 1.4, 0.4, 1.1)]
    anew = infer(model, seen, own=["friction"], refit_count=0)
    assert anew.learnt()["density"].sd_ratio == pytest.approx(1.0, abs=0.05)


def test_a_bounce_that_the_model_does_not_give_is_told(model: Emulator, monkeypatch: pytest.MonkeyPatch) -> None:
    # A probability of 0.05 from a hundred draws is known to 0.02.
    monkeypatch.setitem(predictive_p_value.__globals__, "REPLICATES", 100)
    monkeypatch.setitem(predictive_p_value.__globals__, "POSTERIOR_POINTS", 50)
    # Walkers that the odd one needs go a shorter way.
    monkeypatch.setitem(infer.__globals__, "LENGTH", 8.0)
    usual, odd = Observation({"speed": 0.8}), Observation({"speed": 9.0}, {"speed": 0.1})
    posteriors = [infer(model, [one], refit_count=0, point_count=1024) for one in (usual, odd)]
    assert predictive_p_value(model, posteriors[0], usual) > 0.2
    assert predictive_p_value(model, posteriors[1], odd) < 0.05


def test_how_many_bounces_halve_an_uncertainty_is_that_of_the_linear_law(model: Emulator) -> None:
    found = identifiability(model, ["speed"], truths=2)
    # 1 + n slope^2 / scatter^2 = 4.
    assert found["friction"].bounces == pytest.approx(3.0 * (SCATTER / SLOPE) ** 2, rel=0.3)
    assert found["friction"].sd_ratio[1] == pytest.approx(closed_form([0.0])[1], abs=0.05)
    assert found["density"].bounces is None
    assert found["density"].sd_ratio[1] == pytest.approx(1.0, abs=0.05)


@pytest.mark.parametrize(("observations", "own", "words"), [
    ([], [], "0 observations; give at least one"),
    ([Observation({})], [], "1 observations; give at least one, each with outputs or an outcome"),
    ([Observation({"speed": 1.0}, known={"mass": 1.0})], [], "mass is no input of the emulator"),
    ([Observation({"speed": 1.0})], ["friction", "density"], "nothing is left to infer"),
])  # fmt: skip
def test_observations_that_cannot_be_are_refused(
    model: Emulator, observations: list[Observation], own: list[str], words: str
) -> None:
    with pytest.raises(ValueError, match=words):
        infer(model, observations, own=own)


def test_bounds_that_follow_the_inputs_are_asked_for_at_the_points() -> None:
    random, x = np.random.default_rng(3), sobol_sequence(INPUTS, 120, seed=4)
    upper = 1.0 + 0.1 * np.exp(0.1 * x[:, 1])[:, None]
    y = upper[:, 0] / (1.0 + np.exp(-x[:, 0] - 0.5 * random.standard_normal(120)))
    bounded = emulator.fit(INPUTS, x, y, lower=0.0, upper=upper, output_names=["speed"], form="rows")
    seen = [Observation({"speed": 0.9})]
    with pytest.raises(ValueError, match="upper is missing, but it differed between the runs"):
        infer(bounded, seen, refit_count=0, point_count=4096)
    found = infer(
        bounded, seen, refit_count=0, point_count=4096,
        bounds=lambda points: (None, 1.0 + 0.1 * np.exp(0.1 * points[:, 1:])),
    )  # fmt: skip
    # A speed so near the bound is that of a slippery soil.
    assert found.learnt()["friction"].after.value > 0.5
