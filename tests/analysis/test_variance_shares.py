"""Where the scatter of an output comes from: components of beds, shares that add up, side runs."""

import math
from typing import Any

import numpy as np
import pytest
from scipy import stats

from lithobrake.analysis import VarianceShares, chaos_variance, soil_total_effect, variance_shares
from lithobrake.analysis.confidence import bed_components, numbered_beds
from lithobrake.chaos import Empirical, Uniform, sobol_sequence
from lithobrake.vocabulary.estimate import Estimate

INPUTS = {"friction": Uniform(0.2, 0.9), "restitution": Uniform(0.3, 0.9), "speed": Uniform(0.05, 0.15)}
SOIL = ("friction", "restitution")


def on_beds(bed_count: int, on_each: int, correlation: float, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Values of variance 1 on beds of equal counts."""
    rng, bed = np.random.default_rng(seed), np.repeat(np.arange(bed_count), on_each)
    effects = math.sqrt(correlation) * rng.standard_normal(bed_count)
    return effects[bed] + math.sqrt(1.0 - correlation) * rng.standard_normal(len(bed)), bed


def split(seed: int, twins: np.ndarray | None = None, count: int = 240) -> VarianceShares:
    """Shares of a model with 0.3 soil, 0.2 arrival, 0.1 bed, 0.4 the rest."""
    x = sobol_sequence(INPUTS, count, seed=seed)
    u = np.column_stack([math.sqrt(3.0) * entry.germ(x[:, k]) for k, entry in enumerate(INPUTS.values())])
    # A stream of its own for each, or the scramble of the sequence and the scatter would be of the same draws.
    bed = np.random.default_rng([seed, 1]).permutation(np.arange(count) % 24)
    scatter, order = on_beds(24, count // 24, 0.2, 1000 + seed)[0], np.argsort(np.argsort(bed, kind="stable"))
    y = math.sqrt(0.2) * u[:, 0] + math.sqrt(0.1) * u[:, 0] * u[:, 1]
    y += math.sqrt(0.2) * u[:, 2] + math.sqrt(0.5) * scatter[order]
    return variance_shares(INPUTS, x, y, bed, soil=SOIL, twins=twins)


def test_mean_squares_are_those_of_the_analysis_of_variance() -> None:
    values, bed = on_beds(6, 8, 0.3, 1)
    found = bed_components(values, bed)
    assert found.squares.sum() / 5 / found.within == pytest.approx(stats.f_oneway(*values.reshape(6, 8)).statistic)
    assert (found.counts, found.within_freedom) == (pytest.approx(np.full(5, 8.0)), 42)


def test_the_variance_of_beds_is_that_of_a_mixed_model() -> None:
    models = pytest.importorskip("statsmodels.formula.api", reason="statsmodels is not installed")
    pandas = pytest.importorskip("pandas", reason="pandas is not installed")
    values, bed = on_beds(12, 10, 0.3, 2)
    fit = models.mixedlm("y ~ 1", pandas.DataFrame({"y": values, "bed": bed}), groups="bed").fit(reml=True)
    found = bed_components(values, bed)
    # For equal counts, restricted likelihood and analysis of variance agree where beds differ; theirs is iterated.
    assert found.within == pytest.approx(float(fit.scale), rel=1e-4)
    assert found.bed_variance == pytest.approx(float(fit.cov_re.iloc[0, 0]), rel=1e-3)


@pytest.mark.parametrize("correlation", [0.0, 0.05, 0.2])
def test_the_interval_of_the_correlation_is_exact_for_equal_counts(correlation: float) -> None:
    inside = []
    for seed in range(400):
        interval = bed_components(*on_beds(12, 10, correlation, seed)).correlation
        inside.append(interval.lower <= correlation <= interval.upper)
    # Three standard deviations of 400 draws; without an effect the lower end is cut, so only the upper can miss.
    assert np.mean(inside) == pytest.approx(0.95 if correlation == 0.0 else 0.9, abs=0.045)


def test_what_beds_owe_to_inputs_is_not_their_own() -> None:
    rng, estimates = np.random.default_rng(0), []
    for seed in range(200):
        values, bed = on_beds(12, 10, 0.0, seed)
        terms = rng.standard_normal((120, 30)) + rng.standard_normal((12, 30))[bed]
        estimates.append(bed_components(values + terms.sum(axis=1), bed, terms).bed_variance)
    assert np.mean(estimates) == pytest.approx(0.0, abs=3.0 * np.std(estimates) / math.sqrt(200))


def test_unequal_counts_do_not_matter() -> None:
    inside = []
    for seed in range(400):
        values, bed = on_beds(12, 20, 0.2, seed)
        kept = np.random.default_rng(seed).random(240) < np.linspace(0.2, 0.9, 12)[bed]
        interval = bed_components(values[kept], numbered_beds(bed[kept], kept.sum())).correlation
        inside.append(interval.lower <= 0.2 <= interval.upper)
    assert np.mean(inside) == pytest.approx(0.9, abs=0.045)


def test_the_parts_add_up_and_are_free_of_bias() -> None:
    twins = math.sqrt(2.0 * 0.05) * np.random.default_rng(0).standard_normal(12)
    found = [split(seed, twins) for seed in range(60)]
    for one in found:
        parts = (one.soil, one.arrival, one.bed, one.place, one.chaos)
        assert sum(part.value for part in parts) == pytest.approx(1.0)
        assert sum(one.unbiased.values()) == pytest.approx(1.0)
        assert list(one.unbiased) == ["soil", "arrival", "bed", "chaos", "place"]
        assert all(0.0 <= part.lower <= part.value <= part.upper <= 1.0 for part in parts)
    expected = {"soil": 0.3, "arrival": 0.2, "bed": 0.1}
    for name, share in expected.items():
        estimates = np.array([one.unbiased[name] for one in found])
        assert estimates.mean() == pytest.approx(share, abs=3.0 * estimates.std() / math.sqrt(60))
        inside = [getattr(one, name).lower <= share <= getattr(one, name).upper for one in found]
        assert 0.78 <= np.mean(inside) <= 1.0
    place = [one.place for one in found]
    chaos = [one.chaos.value for one in found]
    truth = 0.4 - np.mean(chaos)
    assert 0.78 <= np.mean([part.lower <= truth <= part.upper for part in place]) <= 1.0
    friction = np.array([one.soil_by_input["friction"].value for one in found])
    assert friction.mean() == pytest.approx(0.2, abs=3.0 * friction.std() / math.sqrt(60))


def test_the_attitude_is_a_part_of_its_own() -> None:
    found = []
    for seed in range(60):
        rng = np.random.default_rng(seed)
        x = sobol_sequence(INPUTS, 240, seed=seed)
        scatter, bed = on_beds(24, 10, 0.1, seed)
        attitude = rng.standard_normal((240, 6))
        y = math.sqrt(0.2) * math.sqrt(3.0) * INPUTS["friction"].germ(x[:, 0]) + attitude[:, 0] * math.sqrt(0.1)
        y += attitude[:, 4] * math.sqrt(0.05) + math.sqrt(0.65) * scatter
        found.append(variance_shares(INPUTS, x, y, bed, soil=tuple(INPUTS), attitude=attitude))
    estimates = np.array([one.unbiased["attitude"] for one in found])
    assert estimates.mean() == pytest.approx(0.15, abs=3.0 * estimates.std() / math.sqrt(60))
    assert 0.78 <= np.mean([one.attitude.lower <= 0.15 <= one.attitude.upper for one in found]) <= 1.0
    soil = np.array([one.unbiased["soil"] for one in found])
    assert soil.mean() == pytest.approx(0.2, abs=3.0 * soil.std() / math.sqrt(60))
    for one in found:
        parts = (one.soil, one.attitude, one.bed, one.place)
        assert sum(part.value for part in parts) == pytest.approx(1.0)


def test_soil_of_ranges_twice_as_wide_is_at_least_what_four_times_its_variance_is() -> None:
    def shares(width: float) -> VarianceShares:
        inputs = {"friction": Uniform(0.5 - 0.1 * width, 0.5 + 0.1 * width), "restitution": Uniform(0.0, 1.0)}
        x, rng = sobol_sequence(inputs, 960, seed=3), np.random.default_rng(3)
        y = 4.0 * x[:, 0] + x[:, 0] ** 2 + 0.5 * rng.standard_normal(960)
        return variance_shares(inputs, x, y, np.arange(960) % 24, soil=tuple(inputs))

    narrow, wide = shares(1.0), shares(2.0)
    assert narrow.terms == "terms of first and second degree"
    assert narrow.soil_doubled.value == pytest.approx(wide.soil.value, abs=0.03)
    assert narrow.soil_doubled.lower < wide.soil.value < narrow.soil_doubled.upper


def test_too_few_runs_leave_the_attitude_out_rather_than_the_soil() -> None:
    x, rng = sobol_sequence(INPUTS, 24, seed=1), np.random.default_rng(0)
    attitude, y, bed = rng.standard_normal((24, 6)), rng.standard_normal(24), np.arange(24) % 6
    found = variance_shares(INPUTS, x, y, bed, soil=SOIL, attitude=attitude)
    assert found.attitude is None
    with pytest.raises(ValueError, match=r"attitude has shape \(12, 6\)"):
        variance_shares(INPUTS, x, y, bed, soil=SOIL, attitude=attitude[:12])


def test_beds_whose_runs_are_alike_have_the_variance_of_runs_that_nearly_are() -> None:
    values, bed = np.repeat(np.random.default_rng(0).standard_normal(6), 4), np.repeat(np.arange(6), 4)
    exact = bed_components(values, bed)
    near = bed_components(values + 1e-6 * np.random.default_rng(1).standard_normal(24), bed)
    assert exact.within == 0.0
    assert exact.variance_at(0.9) == pytest.approx(near.variance_at(0.9), rel=1e-4)


def test_an_event_on_one_bed_alone_has_parts_with_bounds() -> None:
    """Without that bed nothing varies, so its parts are told with an interval that reaches far."""
    random = np.random.default_rng(4)
    x, bed = random.uniform(size=(48, 1)), np.repeat(np.arange(6), 8)
    y = np.where((bed == 2) & (x[:, 0] > np.median(x[bed == 2])), 1.0, 0.0)
    found = variance_shares({"friction": Uniform(0.0, 1.0)}, x, y, bed, soil=("friction",))
    assert found is not None
    for one in (found.soil, found.bed):
        assert 0.0 <= one.lower <= one.value <= one.upper <= 1.0
    assert found.soil.upper > found.soil.value


def test_where_inputs_do_nothing_none_is_found() -> None:
    found = []
    for seed in range(60):
        x = sobol_sequence(INPUTS, 144, seed=seed)
        y, bed = on_beds(12, 12, 0.05, seed)
        found.append(variance_shares(INPUTS, x, np.random.default_rng(seed).permutation(y), bed, soil=tuple(INPUTS)))
    soil = np.array([one.unbiased["soil"] for one in found])
    assert abs(soil.mean()) < 0.02
    assert soil.min() < 0.0
    assert found[0].arrival is None
    assert np.mean([part.lower > 0.0 for one in found for part in one.soil_by_input.values()]) <= 0.1
    for part in [part for one in found for part in (one.soil, one.bed, *one.soil_by_input.values())]:
        # Nothing found is not nothing for sure, and what is printed lies within its interval.
        assert part.upper > 0.001
        assert 0.0 <= part.lower <= part.value <= part.upper <= 1.0
    # Where everything may be the remainder its interval reaches so far.
    alone = [one for one in found if one.unbiased["soil"] > 0.0 and one.soil.lower == one.bed.lower == 0.0]
    assert np.mean([one.place.upper == 1.0 for one in alone]) > 0.9


def test_beds_that_differ_less_than_chance_have_an_upper_bound_above_0() -> None:
    values = np.tile(np.random.default_rng(0).standard_normal(10), 12)
    x = sobol_sequence(INPUTS, 120, seed=1)
    found = variance_shares(INPUTS, x, values, np.repeat(np.arange(12), 10), soil=tuple(INPUTS))
    assert found.unbiased["bed"] < 0.0 == found.bed.value == found.bed.lower
    # As wide as that of beds which differ as chance has it: F of 11 and about 105 degrees of freedom, ten runs each.
    chance = (1.0 / stats.f.ppf(0.05, 11, 105) - 1.0) / 10.0
    assert found.bed.upper == pytest.approx(chance / (1.0 + chance), rel=0.25)


def test_twins_that_differ_by_more_than_the_whole_leave_no_interval_without_width() -> None:
    twins = 3.0 * np.random.default_rng(0).standard_normal(12)
    found = split(0, twins)
    assert found.unbiased["chaos"] > 1.0 == found.chaos.value == found.chaos.upper
    # Chi-square of 12.
    assert found.chaos.lower == pytest.approx(12.0 / stats.chi2.ppf(0.95, 12))
    assert found.unbiased["place"] < 0.0 == found.place.value
    assert found.place.lower == 0.0 < found.place.upper


def test_few_runs_drop_terms_and_then_the_answer() -> None:
    rng = np.random.default_rng(0)
    answers = []
    for count in (40, 24, 12, 8):
        x = sobol_sequence(INPUTS, count, seed=1)
        answers.append(variance_shares(INPUTS, x, rng.standard_normal(count), np.arange(count) % 4, soil=SOIL))
    assert [one is None for one in answers] == [False, False, False, True]
    x = sobol_sequence(INPUTS, 40, seed=1)
    assert variance_shares(INPUTS, x, rng.standard_normal(40), np.zeros(40), soil=SOIL) is None
    assert variance_shares(INPUTS, x, np.ones(40), np.arange(40) % 4, soil=SOIL) is None


def test_runs_without_the_output_are_left_out() -> None:
    x = sobol_sequence(INPUTS, 120, seed=1)
    y, bed = on_beds(12, 10, 0.1, 1)
    holed = y.copy()
    holed[::9] = np.nan
    kept = np.isfinite(holed)
    assert variance_shares(INPUTS, x, holed, bed, soil=SOIL) == variance_shares(
        INPUTS, x[kept], y[kept], bed[kept], soil=SOIL
    )


def test_every_soil_input_has_its_part_and_chaos_none_without_twins() -> None:
    found = split(0)
    assert list(found.soil_by_input) == list(SOIL)
    assert found.chaos is None


def test_twins_tell_chaos() -> None:
    found = chaos_variance([1.0, -1.0, 2.0, np.nan])
    assert found.value == pytest.approx(1.0)
    assert (found.lower, found.upper) == pytest.approx((3.0 / 7.8147, 3.0 / 0.35185), rel=1e-4)
    rng = np.random.default_rng(1)
    intervals = [chaos_variance(math.sqrt(2.0) * rng.standard_normal(12)) for _ in range(400)]
    assert 0.85 <= np.mean([one.lower <= 1.0 <= one.upper for one in intervals]) <= 0.95
    with pytest.raises(ValueError, match="no difference is known"):
        chaos_variance([np.nan])


def test_pairs_tell_the_total_effect_of_the_soil() -> None:
    """The Ishigami function's total index of its third input is 0.2437 (a = 7, b = 0.1)."""
    rng = np.random.default_rng(2)

    def ishigami(x: np.ndarray) -> np.ndarray:
        return np.sin(x[0]) * (1.0 + 0.1 * x[2] ** 4) + 7.0 * np.sin(x[1]) ** 2

    found: list[Estimate] = []
    for _ in range(200):
        pair = np.pi * rng.uniform(-1.0, 1.0, (3, 40))
        other = np.vstack([pair[:2], np.pi * rng.uniform(-1.0, 1.0, 40)])
        y = ishigami(np.pi * rng.uniform(-1.0, 1.0, (3, 240)))
        found.append(soil_total_effect(ishigami(pair) - ishigami(other), y))
    assert np.mean([one.value for one in found]) == pytest.approx(0.2437, abs=0.03)
    assert np.mean([one.lower <= 0.2437 <= one.upper for one in found]) >= 0.78
    few = soil_total_effect([3.0, -2.0, 2.5], np.random.default_rng(3).standard_normal(60))
    assert few.lower < few.value == few.upper == 1.0
    assert soil_total_effect(np.zeros(20), y) == Estimate(0.0, 0.0, 0.0)
    with pytest.raises(ValueError, match="two or more"):
        soil_total_effect([1.0], y)


@pytest.mark.parametrize(("given", "words"), [
    ({"x": np.full((12, 1), 3.0)}, "x has 12 of 12 points outside the inputs"),
    ({"y": np.zeros(11)}, r"y has shape \(11,\); allowed: one number for each of the 12 runs"),
    ({"soil": "a"}, "soil is 'a'; allowed: some of the inputs a"),
    ({"soil": ["b"]}, r"soil is \['b'\]; allowed: some of the inputs a"),
])  # fmt: skip
def test_runs_that_do_not_fit_together_are_refused(given: dict[str, Any], words: str) -> None:
    runs: dict[str, Any] = {"x": np.zeros((12, 1)), "y": np.arange(12.0), "soil": ["a"]} | given
    with pytest.raises(ValueError, match=words):
        variance_shares({"a": Uniform(-1.0, 1.0)}, runs["x"], runs["y"], np.arange(12) % 3, soil=runs["soil"])


@pytest.mark.parametrize("count", [2, 3])
def test_kinds_of_ground_are_told_apart_whatever_their_number(count: int) -> None:
    """Of 24 beds with sizes of their own: what differs by the kind alone is found at the kind, not at the size."""
    rng = np.random.default_rng(3)
    bed = np.repeat(np.arange(24), 12)
    kind, size = np.arange(24) % count, (np.arange(24) // count).astype(float)
    inputs = {"ground.kind": Empirical(kind.tolist()), "ground.grain_size": Empirical(size.tolist())} | INPUTS
    u = np.column_stack([one.ppf(rng.random(len(bed))) for one in INPUTS.values()])
    x = np.column_stack([kind[bed], size[bed], u])
    y = (kind == count - 1)[bed] + 0.25 * rng.standard_normal(len(bed))
    found = variance_shares(inputs, x, y, bed, soil=("ground.kind", "ground.grain_size", *SOIL))
    assert found is not None
    variance = float(np.var(kind == count - 1))
    of_kind = variance / (variance + 0.25**2)
    assert found.soil_by_input["ground.kind"].value == pytest.approx(of_kind, abs=0.06)
    assert found.soil_by_input["ground.grain_size"].value < 0.06
