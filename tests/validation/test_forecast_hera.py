"""The forecast for Hera's CubeSats: its descents, its chances, its answers, and how it is scored."""

import argparse
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from lithobrake.smallbody import dimorphos, fly
from lithobrake.study import read_study

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
    return place + (np.random.default_rng(seed).normal(size=(count, 2)) * spread) @ np.linalg.svd(normal[None])[2][1:]


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
    assert comparison(document(0.85, "1"), document(0.95, "1"))[-1].endswith("1 outside: juventas, soil: share at_rest")


def test_times_of_a_variant_are_compared_lander_by_lander() -> None:
    from variants import beside

    before = [{"bed": k // 2, "end": "at_rest", "time_s": 10.0 + k} for k in range(12)]
    rows = [{**one, "time_s": 2.0 * one["time_s"]} for one in before]
    rows[0]["end"] = "under_way"
    found = beside(rows, before)
    assert (found["at_rest"], found["at_rest_before"], found["landers"]) == (11, 12, 12)
    assert [found[key] for key in ("time_ratio", "lower", "upper")] == pytest.approx([2.0, 2.0, 2.0])


def rows(counts: dict[str, dict[str, int]], lander: str = "juventas") -> list[dict]:
    """Landers by branch and end, each on a bed of its own."""
    found = []
    for branch, ends in counts.items():
        for end, count in ends.items():
            found += [
                {"lander": lander, "branch": branch, "ground": "soil", "end": end, "bed": len(found) + k}
                for k in range(count)
            ]
    return found


def test_a_descent_comes_down_straight_on_its_aim_with_the_speed_of_its_mirror_image():
    from descent import DISTANCE, FASTER, least_speed, release

    body = replace(dimorphos(extents=(193.0, 148.0, 120.0)), mass=2.93e9)
    for longitude in (0.0, 180.0):
        tip = body.shape.surface_point(0.0, longitude)
        up = np.array([math.cos(math.radians(longitude)), 0.0, 0.0])
        state = release(body, longitude)
        assert np.linalg.norm(state["position"]) == pytest.approx(DISTANCE, rel=1e-3)
        end = fly(body, state["position"], state["velocity"], 3.0e4, gravity="table")
        assert end.status[0] == "impact"
        assert end.impact_speed[0] == pytest.approx(FASTER * least_speed(body, tip, up), rel=1e-3)
        assert math.degrees(end.incidence[0]) < 0.2
        assert end.position[0] == pytest.approx(tip, abs=0.2)


def test_branches_share_no_draws_and_the_first_is_the_study_file() -> None:
    from branches import LANDERS, SCENARIOS, branches

    for lander in LANDERS:
        seeds = [one.tables(240)["seed"] for one in branches(lander)]
        assert len(set(seeds)) == len(seeds)
        assert seeds[0] == read_study(SCENARIOS / f"{lander}.toml").seed


def test_chances_weigh_branches_and_nothing_is_impossible():
    from answers import branch_weights, shares
    from branches import branches
    from samples import ENDS, sample

    names = [one.name for one in branches("juventas")]
    found = sample(
        rows({name: {"at_rest": 8} if "rolling" not in name else {"escaped": 8} for name in names}), "juventas", "soil"
    )
    weights = branch_weights(found, "juventas", at_rest=False)
    assert weights.sum() == pytest.approx(1.0)
    mean, draws = shares(found, "end", weights)
    # Perks' prior: a quarter of a lander at each end.
    rolling = next(one.weight for one in branches("juventas") if "rolling" in one.name)
    assert mean[ENDS.index("at_rest")] == pytest.approx((1.0 - rolling) * 8.25 / 9.0 + rolling * 0.25 / 9.0)
    assert mean.sum() == pytest.approx(1.0)
    assert (mean > 0.0).all()
    assert draws.mean(axis=0) == pytest.approx(mean, abs=0.01)


def test_landers_of_one_bed_count_less():
    from answers import CORRELATION, design_effect
    from samples import sample

    landers = rows({"rolling, at the surface": {"at_rest": 6}})
    assert design_effect(sample(landers, "juventas", "soil"), np.ones(6, dtype=bool)) == 1.0
    for row in landers:
        row["bed"] = row["bed"] % 2
    assert design_effect(sample(landers, "juventas", "soil"), np.ones(6, dtype=bool)) == 1.0 + 2.0 * CORRELATION


def test_cells_have_equal_area_and_go_east_from_the_date_line():
    from samples import BANDS, SECTORS, cells

    directions = np.random.default_rng(1).standard_normal((24_000, 3))
    latitude = np.degrees(np.arcsin(directions[:, 2] / np.linalg.norm(directions, axis=1)))
    longitude = np.degrees(np.arctan2(directions[:, 1], directions[:, 0]))
    counts = np.bincount(cells(latitude, longitude), minlength=SECTORS * BANDS)
    assert counts == pytest.approx(1000.0, abs=5.0 * math.sqrt(1000.0))
    south_west, north_east = cells(np.array([-89.0, 89.0]), np.array([-179.0, 179.0]))
    assert (south_west, north_east) == (0, SECTORS * BANDS - 1)


def test_an_observation_costs_the_bits_of_its_probability():
    from score import scores

    assert scores({"end": [0.5, 0.25, 0.125, 0.125]}, {"end": 2, "face": 1}) == {"end": 3.0}


def test_quantiles_weigh_landers():
    from answers import LEVELS, quantiles

    values, weight = np.array([3.0, 1.0, 2.0]), np.array([1.0, 1.0, 8.0])
    assert quantiles(values, weight)[LEVELS.index(0.5)] == pytest.approx(2.0)


def test_ranks_are_those_within_branches() -> None:
    """Each branch falls, while both together rise."""
    from answers import rank_correlation
    from samples import Sample

    branch = np.repeat([0, 1], 20)
    speed = np.concatenate([np.arange(20.0), 100.0 + np.arange(20.0)])
    time = np.concatenate([-np.arange(20.0), 1000.0 - np.arange(20.0)])
    rows = [{"speed": a, "time_s": b, "bed": k} for k, (a, b) in enumerate(zip(speed, time, strict=True))]
    found = rank_correlation(Sample(rows, branch, np.ones(40)), "speed", "time_s")
    assert [found[key] for key in ("value", "lower", "upper")] == pytest.approx([-1.0, -1.0, -1.0])


def test_who_misses_dimorphos_does_not_touch_down() -> None:
    from answers import touched_down
    from samples import Sample

    rows = [{"speed": 0.05, "end": "at_rest"}, {"speed": 0.05, "end": "partner"}, {"speed": np.nan, "end": "escaped"}]
    assert touched_down(Sample(rows, np.zeros(3), np.ones(3))) == {"landers": 2, "at_rest": 1}


def test_what_is_there_by_the_same_code_is_kept_with_what_it_cost(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture
) -> None:
    """Landers are made up; of three studies one was there already, and another was begun before."""
    import forecast
    from assumptions import Assumptions
    from branches import branches
    from landers import folder_name

    three = branches("juventas")[:3]

    def follow(branch, ground, count, work, workers, shown, assumptions, measurements):
        if branch != three[0]:
            shown.progress(1.0, 2.0, "journeys")
        return [{"end": end} for end in ("at_rest", "partner")]

    monkeypatch.setattr(forecast, "follow", follow)
    monkeypatch.setattr(forecast, "LANDERS", ("juventas",))
    monkeypatch.setattr(forecast, "simulated_branches", lambda lander, measurements: three)
    (tmp_path / folder_name(three[1], "soil")).mkdir()
    rows, costs = forecast.run_all(tmp_path, 1, (), Assumptions("soil alone", {"soil": 240}))
    assert len(rows) == 6
    said = capsys.readouterr().out
    assert "2 of 3: juventas, small libration, ballistic, near end, soil" in said
    assert said.count("1 of 2 landers at rest; kept, made by the same code of the engine") == 1
    assert [(one["study"], one["landers"], one["from_nothing"]) for one in costs] == [
        ("juventas, small libration, ballistic, near end, soil", 2, False),
        ("juventas, large libration, at the surface, near end, soil", 2, True),
    ]
    assert "; about " in said


def test_other_code_of_the_hard_ground_makes_its_landers_again() -> None:
    from grounds import DrawnRestitution

    from lithobrake.pipeline.runs.solver import function_identity

    assert function_identity(DrawnRestitution()) == function_identity(DrawnRestitution())
    assert function_identity(DrawnRestitution()) != function_identity(DrawnRestitution("other"))


def test_numbers_of_the_page_have_their_digits_and_no_exponent() -> None:
    from write_page import plain

    assert [plain(one) for one in (0.0, 0.2, 0.183, 1.04, 23.4, 242.1, 58_357.6)] == ["0", "0.20", "0.18", "1.0", "23",
        "240", "58000"]  # fmt: skip


def test_the_page_has_a_row_for_each_variant_and_no_part_for_none() -> None:
    from write_page import variants_part

    row = {"variant": "held_speed 0.03", "lander": "milani", "landers": 24, "at_rest": 23, "at_rest_before": 24,
        "median_time_s": 1200.0, "median_time_before_s": 1500.0, "time_ratio": 0.8, "lower": 0.61,
        "upper": 1.02}  # fmt: skip
    text = variants_part([row])
    assert text.startswith("## ")
    assert "| 23 and 24 of 24 | 20 and 25 | 0.80 (0.61-1.0) |\n\n" in text
    assert variants_part([]) == ""
