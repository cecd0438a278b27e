"""What an emulator makes of laws that bend, branch or scatter as they like; its mean law, and its ridges."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from scipy import special

from lithobrake import emulator
from lithobrake.chaos import Normal, Uniform, latin_hypercube, sobol_sequence
from lithobrake.emulator import latent_variable
from lithobrake.emulator.mean_law import MOST_TERMS, candidate_terms, found_inputs, mean_law, terms_up_to
from lithobrake.emulator.ridge_ladder import Rung, Smoother, TermTable, best_ladder

from ..quick_studies import quick_studies

COUNT = 300


@pytest.fixture
def quick() -> Iterator[None]:
    """For what looks at laws that are chosen without any doubt, however few beds are left out at a time."""
    with quick_studies(), pytest.MonkeyPatch.context() as patch:
        patch.setattr(latent_variable, "FOLDS", 3)
        yield


def inputs_of(count: int) -> dict[str, Uniform]:
    return {f"x{k}": Uniform(-1.0, 1.0) for k in range(count)}


@pytest.mark.usefixtures("quick")
def test_the_odds_of_two_branches_are_followed() -> None:
    inputs, random = inputs_of(2), np.random.default_rng(0)
    x = latin_hypercube(inputs, COUNT, seed=0)
    upper = random.random(COUNT) < special.expit(3.0 * x[:, 0])
    model = emulator.fit(inputs, x, np.where(upper, 1.5, -1.5) + 0.3 * random.standard_normal(COUNT), form="rows")
    places = np.array([-0.8, -0.3, 0.3, 0.8])
    drawn = model.sample(np.column_stack([places, np.zeros(4)]), 4000)[:, :, 0]
    # Some forty runs lie as near as rows are drawn from: their odds are good to 0.08.
    np.testing.assert_allclose((drawn > 0.0).mean(axis=1), special.expit(3.0 * places), atol=0.16)
    # Little lies between the branches, which are ten deviations apart: rows of places nearby are shifted by the mean.
    assert (np.abs(drawn) < 0.5).mean() < 0.1


@pytest.mark.usefixtures("quick")
def test_a_bump_of_the_scatter_is_followed() -> None:
    inputs, random = inputs_of(2), np.random.default_rng(0)
    x = latin_hypercube(inputs, COUNT, seed=1)
    scale = 0.15 + np.exp(-((x[:, 0] / 0.3) ** 2))
    model = emulator.fit(inputs, x, scale * random.standard_normal(COUNT), form="rows")
    near, far = model.sample([[0.0, 0.0], [0.8, 0.0]], 4000)[:, :, 0].std(axis=1)
    # 1.15 and 0.15; a logarithm that is linear makes both one.
    assert 0.85 < near < 1.5
    assert 0.10 < far < 0.25


@pytest.mark.usefixtures("quick")
def test_two_of_twelve_inputs_are_followed() -> None:
    inputs, random = inputs_of(12), np.random.default_rng(0)
    x, fresh = latin_hypercube(inputs, COUNT, seed=2), latin_hypercube(inputs, 200, seed=3)

    def law(points: np.ndarray) -> np.ndarray:
        return np.asarray(np.sin(2.5 * points[:, 0]) + 1.5 * points[:, 1] ** 2)

    model = emulator.fit(inputs, x, law(x) + 0.2 * random.standard_normal(COUNT), form="rows")
    error = model.sample(fresh, 500)[:, :, 0].mean(axis=1) - law(fresh)
    # Ten terms that count leave 0.2 sqrt(10 / 300) = 0.04; of the square alone 0.45 would be left.
    assert np.sqrt(np.mean(error**2)) < 0.08


@pytest.mark.usefixtures("quick")
def test_a_smooth_solver_without_scatter_is_reproduced() -> None:
    inputs = inputs_of(2)
    x, fresh = latin_hypercube(inputs, 100, seed=4), latin_hypercube(inputs, 200, seed=5)

    def law(points: np.ndarray) -> np.ndarray:
        return np.asarray(np.sin(3.0 * points[:, 0]) + points[:, 1] ** 2 * points[:, 0])

    drawn = emulator.fit(inputs, x, law(x)).sample(fresh, 50)[:, :, 0]
    assert np.sqrt(np.mean((drawn - law(fresh)[:, None]) ** 2)) < 1e-3 * law(fresh).std()


@pytest.mark.usefixtures("quick")
def test_branches_that_cross_are_as_near_as_a_published_expansion_makes_them() -> None:
    """The bimodal case of [Zhu-2023], 400 runs: the published expansion of degree 5 has 0.020 (0.010 to 0.038)."""
    inputs = {"x": Uniform(0.0, 1.0)}

    def drawn(x: np.ndarray, count: int, random: np.random.Generator) -> np.ndarray:
        half = 0.8 * (5.0 * x - 2.5)
        branch = np.where(random.random((len(x), count)) < 0.4, half, -half)
        return np.asarray(4.0 * np.sin(np.pi * x) ** 2 + branch + 0.8 * random.standard_normal((len(x), count)))

    points = latin_hypercube(inputs, 100, seed=9)
    truth, levels = drawn(points, 2000, np.random.default_rng(8)), (np.arange(500) + 0.5) / 500
    x = latin_hypercube(inputs, 400, seed=0)
    found = emulator.fit(inputs, x, drawn(x, 1, np.random.default_rng(0))).sample(points, 2000)[:, :, 0]
    gaps = np.quantile(found, levels, axis=1) - np.quantile(truth, levels, axis=1)
    assert np.mean(gaps**2) / truth.var() < 0.03


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize(("centre", "distant"), [(10.0, (0,)), (1.0, ())])
def test_a_bound_that_is_far_bends_nothing(centre: float, distant: tuple[int, ...]) -> None:
    """A normal law far from its bound takes no logarithm; a lognormal one near it does."""
    inputs, random = inputs_of(1), np.random.default_rng(0)
    x = latin_hypercube(inputs, 200, seed=6)
    noise = random.standard_normal(200)
    y = centre + x[:, 0] + noise if distant else np.exp(x[:, 0] + noise)
    model = emulator.fit(inputs, x, y, lower=0.0, form="rows")
    assert model.runs.distant == distant
    assert (model.sample(x, 2000) > 0.0).all()


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize("lonely", [slice(10), slice(3, 4)])
def test_an_output_that_scatters_in_one_group_alone_has_no_expansion(lonely: slice) -> None:
    """Without that group nothing scatters, and a density has no width."""
    inputs = inputs_of(1)
    x, y = latin_hypercube(inputs, 60, seed=1), np.zeros(60)
    y[lonely] = 1.0 + x[lonely, 0]
    model = emulator.fit(inputs, x, y, groups=np.arange(60) // 10)
    assert model.expansion is None
    assert np.isfinite(model.sample(x, 20)).all()


@pytest.mark.usefixtures("quick")
def test_an_emulator_does_not_lose_to_its_runs() -> None:
    """On laws without inputs that count, chosen laws hardly pass the gate, and those that do cost little."""
    inputs, passed = inputs_of(2), 0
    for seed in range(3):
        random = np.random.default_rng(seed)
        x = latin_hypercube(inputs, 60, seed=seed)
        passed += emulator.fit(inputs, x, random.gamma(2.0, size=60)).follows_inputs
    # By luck a gain is above its error in 16 of 100; more than one of three with probability 0.07.
    assert passed <= 1


MEAN_LAW_INPUTS = {"a": Uniform(0.0, 2.0), "b": Normal(0.0, 1.0), "c": Uniform(-1.0, 1.0)}


def study(noise: float, count: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Runs x [count, 3] and y [count] of y = a + b / 3 + b (a - 1) + noise."""
    x, random = sobol_sequence(MEAN_LAW_INPUTS, count, seed=seed), np.random.default_rng(seed)
    return x, x[:, 0] + x[:, 1] / 3.0 + x[:, 1] * (x[:, 0] - 1.0) + noise * random.standard_normal(count)


def fitted(noise: float, count: int, seed: int, form: str | None = "rows") -> emulator.Emulator:
    """An emulator of a study; its mean law and what inputs it finds do not depend on the form of its draws."""
    return emulator.fit(MEAN_LAW_INPUTS, *study(noise, count, seed), form=form)


@pytest.mark.usefixtures("quick")
def test_indices_are_those_of_the_polynomial() -> None:
    found = fitted(noise=0.0, count=200, seed=0).mean_law()
    # Variances of a, b / 3 and their product: 1/3, 1/9 and 1/3.
    assert (found.mean[0], found.variance[0]) == (pytest.approx(1.0, abs=1e-9), pytest.approx(7.0 / 9.0, rel=1e-6))
    np.testing.assert_allclose(found.sobol_first[:, 0], [3.0 / 7.0, 1.0 / 7.0, 0.0], atol=1e-6)
    np.testing.assert_allclose(found.sobol_total[:, 0], [6.0 / 7.0, 4.0 / 7.0, 0.0], atol=1e-6)


@pytest.mark.parametrize("explained", [0.1, 0.3])
def test_the_share_of_the_inputs_is_freed_of_noise(explained: float) -> None:
    noise, ladder = np.sqrt(7.0 / 9.0 * (1.0 / explained - 1.0)), (Rung((1.0, 1.0, 1.0), (0.4, 0.4, 0.4), 2, 0.1),)
    shares = []
    for seed in range(100):
        x, y = study(noise, 240, seed)
        shares.append(mean_law(MEAN_LAW_INPUTS, x, y[:, None], [ladder], np.ones(240)).share[0])
    # A hundred studies with a standard deviation of about 0.05 each. Nine terms would add 9 / 240 of the noise to it.
    assert abs(np.mean(shares) - explained) < 2.0 * 0.05 / np.sqrt(100.0)


@pytest.mark.usefixtures("quick")
def test_an_emulator_says_the_share_of_the_inputs() -> None:
    # Degrees that it chooses, and the form that one of them draws by, are its own: three studies as above.
    forms = (None, "rows", "rows")
    shares = [fitted(np.sqrt(49.0 / 27.0), 240, *one).mean_law().share[0] for one in enumerate(forms)]
    assert abs(np.mean(shares) - 0.3) < 2.0 * 0.05 / np.sqrt(3.0)


@pytest.mark.usefixtures("quick")
def test_inputs_are_found_where_they_count() -> None:
    assert fitted(noise=1.0, count=200, seed=1).found_inputs() == {"a": True, "b": True, "c": False}


def test_without_effects_hardly_any_study_finds_one() -> None:
    # 90 % of studies find none; of 20, with probability 0.989, no more than 5 do. The test needs no emulator.
    found = []
    for seed in range(20):
        y = np.random.default_rng(seed).standard_normal((100, 1))
        found.append(
            found_inputs(MEAN_LAW_INPUTS, sobol_sequence(MEAN_LAW_INPUTS, 100, seed=seed), y, 0.9, seed=0).any()
        )
    assert sum(found) <= 5


@pytest.mark.parametrize("run_count", [3, 4, 5])
def test_runs_that_are_no_more_than_terms_tell_of_no_input(run_count: int, recwarn: pytest.WarningsRecorder) -> None:
    x = sobol_sequence(MEAN_LAW_INPUTS, run_count, seed=1)
    found = found_inputs(MEAN_LAW_INPUTS, x, x[:, :1] + 0.1 * x[:, 1:2], 0.9, seed=0)
    assert [str(one.message) for one in recwarn] == []
    assert found.any() == (run_count == 5)


@pytest.mark.usefixtures("quick")
def test_a_level_must_be_a_probability() -> None:
    with pytest.raises(ValueError, match=r"level is 90"):
        fitted(1.0, 60, 0).found_inputs(level=90)


INPUTS = {"a": Uniform(0.0, 1.0), "b": Uniform(0.0, 1.0), "c": Uniform(0.0, 1.0)}
TERMS = terms_up_to(INPUTS, 2)
RUN_COUNT = 120
MATRIX = TERMS.matrix(sobol_sequence(INPUTS, RUN_COUNT, seed=3))
NOISE = np.random.default_rng(2).standard_normal(RUN_COUNT)
DESIGN = TermTable(TERMS.indices, MATRIX, np.ones(RUN_COUNT))
LADDER = (Rung((1.0, 0.0, 1.0), (0.4, 0.4, 0.4), 2, 0.1, 0.7), Rung((0.0, 1.0, 0.0), (0.4, 0.4, 0.4), 1, 0.03, 0.2))


def test_linear_terms_come_first_in_the_order_of_the_inputs() -> None:
    np.testing.assert_array_equal(TERMS.indices[:3], np.eye(3))
    assert len(TERMS.indices) == 9


def test_a_rung_is_a_ridge_on_its_own_terms() -> None:
    rung = Rung((1.0, 0.0, 0.7), (0.5, 0.5, 0.3), 2, 0.1)
    coefficients = Smoother(DESIGN, (rung,)).coefficients(NOISE)
    factors = rung.factors(TERMS.indices)
    assert ((factors > 0.0) == (TERMS.indices[:, 1] == 0)).all()
    # The same by the penalty on each coefficient: a factor f divides it by f squared.
    kept = factors > 0.0
    centred = MATRIX[:, kept] - MATRIX[:, kept].mean(axis=0)
    penalty = np.diag(0.1 * RUN_COUNT / factors[kept] ** 2)
    expected = np.linalg.solve(centred.T @ centred + penalty, centred.T @ (NOISE - NOISE.mean()))
    np.testing.assert_allclose(coefficients[1:][kept], expected, rtol=1e-9)
    assert (coefficients[1:][~kept] == 0.0).all()


def test_leave_one_out_residuals_are_those_of_fits_without_the_run() -> None:
    rung = Rung((1.0, 1.0, 1.0), (0.4, 0.4, 0.4), 2, 1e-9)
    residual = Smoother(DESIGN, (rung,)).left_out(NOISE)
    for run in (0, 17, 80):
        rest = np.arange(RUN_COUNT) != run
        law = Smoother(DESIGN.of(rest), (rung,)).coefficients(NOISE[rest])
        assert residual[run] == pytest.approx(NOISE[run] - law[0] - MATRIX[run] @ law[1:], rel=1e-6)


def test_an_average_is_the_sum_of_its_rungs() -> None:
    whole = Smoother(DESIGN, LADDER).coefficients(NOISE)[1:]
    parts = [Smoother(DESIGN, (replace(rung, weight=1.0),)).coefficients(NOISE)[1:] for rung in LADDER]
    np.testing.assert_allclose(whole, 0.7 * parts[0] + 0.2 * parts[1], rtol=1e-9, atol=1e-12)


def test_weights_count_a_run_several_times() -> None:
    weights = np.random.default_rng(0).integers(0, 3, RUN_COUNT)
    repeated = np.repeat(np.arange(RUN_COUNT), weights)
    by_weight = Smoother(TermTable(TERMS.indices, MATRIX, weights.astype(float)), LADDER).coefficients(NOISE)
    copies = TermTable(TERMS.indices, MATRIX[repeated], np.ones(len(repeated)))
    np.testing.assert_allclose(by_weight, Smoother(copies, LADDER).coefficients(NOISE[repeated]), rtol=1e-9)


def test_a_strong_law_is_found_with_its_inputs_and_degree() -> None:
    linear, curved = MATRIX[:, 0] + 0.1 * NOISE, MATRIX[:, 0] + MATRIX[:, 3] + 0.1 * NOISE
    for target, degree in ((linear, 1), (curved, 2)):
        ladder = best_ladder(DESIGN, target)
        assert sum(rung.weight for rung in ladder if rung.amplitudes[0] > 0.0) == pytest.approx(1.0, abs=1e-6)
        assert abs(Smoother(DESIGN, ladder).coefficients(target)[1] - 1.0) < 0.05
        assert sum(rung.weight for rung in ladder if rung.degree >= degree) > 0.5


def test_noise_leaves_hardly_a_law() -> None:
    explained = []
    for seed in range(20):
        noise = np.random.default_rng(seed).standard_normal(RUN_COUNT)
        explained.append((Smoother(DESIGN, best_ladder(DESIGN, noise)).coefficients(noise)[1:] ** 2).sum())
    # Least squares on the nine terms would explain 9 / 120 of the noise.
    assert np.mean(explained) < 0.02


def test_a_constant_has_no_rungs() -> None:
    assert best_ladder(DESIGN, np.full(RUN_COUNT, 7.0)) == ()


def test_a_law_that_bends_is_followed_as_far_as_it_bends() -> None:
    """Of sin(4 a) among three inputs a ridge of two degrees leaves 0.99 of the variance, of 300 runs."""
    terms = candidate_terms(INPUTS)
    x, fresh = sobol_sequence(INPUTS, 300, seed=1), sobol_sequence(INPUTS, 500, seed=2)
    wave = np.sin(8.0 * x[:, 0] - 4.0) + 0.1 * np.random.default_rng(0).standard_normal(300)
    design = TermTable(terms.indices, terms.matrix(x), np.ones(300))
    coefficients = Smoother(design, best_ladder(design, wave)).coefficients(wave)
    truth = np.sin(8.0 * fresh[:, 0] - 4.0)
    error = coefficients[0] + terms.matrix(fresh) @ coefficients[1:] - truth
    # Fifteen terms of the one input that counts would leave 15 / 300 of the scatter's hundredth.
    assert np.mean(error**2) < 0.002 * np.var(truth)


@pytest.mark.parametrize("count", [1, 3, 5, 12, 14, 30])
def test_terms_are_no_more_than_runs_can_tell_apart(count: int) -> None:
    terms = candidate_terms({f"input {k}": Uniform(0.0, 1.0) for k in range(count)})
    np.testing.assert_array_equal(terms.indices[:count], np.eye(count))
    assert len(terms.indices) <= MOST_TERMS
    assert len(np.unique(terms.indices, axis=0)) == len(terms.indices)
