"""Answers of the forecast for made-up landers, against closed forms."""

import argparse
import math
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).parents[2]


pytestmark = pytest.mark.usefixtures("forecast_scripts")


def landers(weight: np.ndarray | None = None, bed: np.ndarray | None = None, **columns: np.ndarray):
    """Landers with these columns, each on a bed of its own, of one branch."""
    from samples import Sample

    count = len(next(iter(columns.values())))
    table = {"bed": np.arange(count) if bed is None else bed, **columns}
    rows = [dict(zip(table, row, strict=True)) for row in zip(*table.values(), strict=True)]
    return Sample(rows, np.zeros(count, dtype=int), np.full(count, 1.0 / count) if weight is None else weight)


def cloud(count: int, axes: np.ndarray, direction: list[float], spread: tuple[float, float], seed: int) -> np.ndarray:
    """A normal cloud [m] on the plane that touches an ellipsoid in a direction, [count, 3]."""
    unit = np.array(direction) / np.linalg.norm(direction)
    place = unit / np.linalg.norm(unit / axes)
    normal = place / axes**2
    across = np.linalg.svd(normal[None])[2][1:]
    return place + (np.random.default_rng(seed).normal(size=(count, 2)) * spread) @ across


def test_the_ground_of_a_spheroid_has_its_closed_form() -> None:
    from places import DIRECTIONS, even_directions, ground_area

    a, c = 96.5, 40.0
    e = math.sqrt(1.0 - (c / a) ** 2)
    exact = 2.0 * math.pi * a**2 * (1.0 + (1.0 - e**2) / e * math.atanh(e))
    found = ground_area(even_directions(DIRECTIONS), np.array([a, a, c])).mean() * 4.0 * math.pi
    assert found == pytest.approx(exact, rel=1e-4)


@pytest.mark.parametrize("direction", [[-1.0, 0.0, 0.0], [1.0, 0.3, 1.0]])
def test_a_normal_cloud_on_an_ellipsoid_covers_the_ground_of_its_law(direction: list[float]) -> None:
    """The share p lies within -2 ln(1 - p) of its squared distance; at the second place the ground leans by 39 deg."""
    from places import areas

    spread, axes = (9.0, 5.0), np.array([100.0, 80.0, 40.0])
    found, ground = areas(cloud(800, axes, direction, spread, 1), axes)
    exact = [-2.0 * math.log(1.0 - one.share) * math.pi * spread[0] * spread[1] for one in found]
    # Four standard deviations of the area of so many points (0.045); a ball as large has 0.78 of it where it leans.
    assert ground == pytest.approx(exact, rel=0.18)


def test_the_interval_of_an_area_is_that_of_so_many_beds() -> None:
    """Three landers lie nearly together on each of 60 beds; over other beds the area scatters by 0.21 of it."""
    from places import NORMAL_90, regions

    beds, axes = 60, np.array([100.0, 80.0, 40.0])
    middle = cloud(beds, axes, [1.0, 0.0, 0.0], (9.0, 5.0), 2)
    places = np.repeat(middle, 3, axis=0) + np.random.default_rng(3).normal(size=(3 * beds, 3)) * [0.0, 0.5, 0.5]
    columns = {f"position_{axis}": places[:, k] for k, axis in enumerate("xyz")}
    half, most = regions(landers(bed=np.repeat(np.arange(beds), 3), **columns), axes)
    error = (half["upper"] - half["lower"]) / (2.0 * NORMAL_90 * half["area_m2"])
    assert error == pytest.approx(0.21, rel=0.35)
    for one in (half, most):
        assert one["lower"] < -2.0 * math.log(1.0 - one["share"]) * math.pi * 45.0 < one["upper"]
    # Ground of the ellipsoid, by quadrature.
    assert half["area_m2"] / half["of_ground"] == pytest.approx(66_742.3, rel=0.001)


def test_quantiles_of_two_branches_are_those_of_their_mixture() -> None:
    """Nine tenths are even from 0 to 1 and the others even from 10 to 11, whatever the numbers of landers."""
    from answers import number

    values = np.concatenate([(np.arange(50) + 0.5) / 50.0, 10.0 + (np.arange(200) + 0.5) / 200.0])
    weight = np.concatenate([np.full(50, 0.9 / 50.0), np.full(200, 0.1 / 200.0)])
    found = number(landers(weight, bed=np.arange(250) % 20, time_s=values), "time_s")
    exact = {"q05": 0.05 / 0.9, "q25": 0.25 / 0.9, "q50": 0.5 / 0.9, "q75": 0.75 / 0.9, "q95": 10.5}
    assert {name: found[name] for name in exact} == pytest.approx(exact, abs=1e-6)


def test_the_interval_of_a_median_is_that_of_beds_drawn_again() -> None:
    """The median of n even values has the error 1 / (2 sqrt(n)) of their range; those of a bed count as one."""
    from answers import number

    values = np.random.default_rng(5).permutation((np.arange(100) + 0.5) / 100.0)
    for each in (1, 3):
        found = number(landers(bed=np.repeat(np.arange(100), each), time_s=np.repeat(values, each)), "time_s")
        assert found["median_upper"] - found["median_lower"] == pytest.approx(2.0 * 1.645 * 0.05, rel=0.2)
        assert found["median_lower"] < 0.5 < found["median_upper"]


def test_rank_correlations_are_those_of_a_normal_law() -> None:
    """Spearman's correlation of a normal law of correlation r is 6 / pi asin(r / 2); its error (1 - r^2) / sqrt(n)."""
    from answers import rank_correlation

    r, count = 0.6, 400
    x, y = np.random.default_rng(6).normal(size=(2, count))
    found = rank_correlation(landers(speed=x, time_s=r * x + math.sqrt(1.0 - r**2) * y), "speed", "time_s")
    exact = 6.0 / math.pi * math.asin(r / 2.0)
    assert found["lower"] < exact < found["upper"]
    assert found["upper"] - found["lower"] == pytest.approx(2.0 * 1.645 * (1.0 - r**2) / math.sqrt(count), rel=0.25)
    none = rank_correlation(landers(speed=x, time_s=y), "speed", "time_s")
    assert none["lower"] < 0.0 < none["upper"]


@pytest.mark.parametrize(("changes", "words"), [
    ({"latitude_deg": 10.0}, "give both"),
    ({"latitude_deg": -95.0, "longitude_deg": 10.0}, "allowed: -90 to 90"),
    ({"contacts": math.nan}, "--contacts is nan"),
])  # fmt: skip
def test_an_observation_that_cannot_be_is_refused(changes: dict[str, float], words: str) -> None:
    from score import observed_bins

    names = ("time_min", "contacts", "first_speed_ratio", "latitude_deg", "longitude_deg", "face")
    with pytest.raises(SystemExit, match=words):
        observed_bins(argparse.Namespace(**(dict.fromkeys(names) | {"end": "at_rest"} | changes)))


def test_what_is_scored_costs_the_bits_of_its_share(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of one branch, 7 of 8 landers rest within 20 to 40 min, of another none; each bin has an eighth of one before."""
    import answers
    import samples
    from branches import Branch
    from score import scores

    both = tuple(Branch("juventas", name, "", "", weight, {}) for name, weight in (("one", 0.25), ("other", 0.75)))
    for module in (answers, samples):
        monkeypatch.setattr(module, "branches", lambda lander: both)
    minutes = {"one": [25.0] * 7 + [700.0], "other": [5.0] * 8}
    rows = [
        {"lander": "juventas", "branch": name, "ground": "soil", "end": "at_rest", "bed": k, "time_s": 60.0 * time}
        for name, times in minutes.items()
        for k, time in enumerate(times)
    ]
    of = samples.sample(rows, "juventas", "soil")
    mean, _ = answers.shares(of, "time_min", answers.branch_weights(of, "juventas", at_rest=True))
    assert len(samples.BINS["time_min"]) == 8
    exact = [(0.25 * 0.125 + 0.75 * 8.125) / 9.0, (0.25 * 7.125 + 0.75 * 0.125) / 9.0]
    assert mean[[0, 2]] == pytest.approx(exact)
    assert scores({"time_min": mean.tolist()}, {"time_min": 2})["time_min"] == pytest.approx(-math.log2(exact[1]))


def test_a_forecast_made_again_is_compared_number_by_number() -> None:
    from compare import comparison

    def document(share: float, code: str) -> dict:
        median = {"q50": 20.0, "median_lower": 18.0, "median_upper": 22.0}
        end = {"share": share, "lower": 0.8, "upper": 0.9}
        region = {"share": 0.5, "area_m2": 9000.0, "lower": 7000.0, "upper": 11000.0}
        of = {"ends": {"at_rest": end}, "at_rest": {"time_s": median}, "regions": [region], "by_branch": []}
        return {"sha256": {"code": code, "studies": {"juventas": "a"}}, "landers": {"juventas": {"soil": of}}}

    same = comparison(document(0.85, "1"), document(0.85, "1"))
    assert same[0] == "code: the same"
    assert same[-1] == "3 numbers: 3 the same, 0 others within the interval stated before, 0 outside"
    moved = comparison(document(0.85, "1"), document(0.88, "2"))
    assert moved[0] == "code: 1 before, 2 after"
    assert "juventas, soil: share at_rest: 0.85 (0.8 to 0.9) before, 0.88 after: within" in moved
    far = comparison(document(0.85, "1"), document(0.95, "1"))
    assert far[-1].endswith("1 outside: juventas, soil: share at_rest")


def test_times_of_a_variant_are_compared_lander_by_lander() -> None:
    from variants import beside

    before = [{"bed": k // 2, "end": "at_rest", "time_s": 10.0 + k} for k in range(12)]
    rows = [{**one, "time_s": 2.0 * one["time_s"]} for one in before]
    rows[0]["end"] = "under_way"
    found = beside(rows, before)
    assert (found["at_rest"], found["at_rest_before"], found["landers"]) == (11, 12, 12)
    assert [found[key] for key in ("time_ratio", "lower", "upper")] == pytest.approx([2.0, 2.0, 2.0])
