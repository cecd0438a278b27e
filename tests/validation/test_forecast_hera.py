"""The forecast for Hera's CubeSats: its descents, its chances, and how it is scored."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from lithobrake.smallbody import dimorphos, fly
from lithobrake.study import read_study

ROOT = Path(__file__).parents[2]


pytestmark = pytest.mark.usefixtures("forecast_scripts")


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
    from branches import branches
    from landers import folder_name

    three = branches("juventas")[:3]

    def follow(branch, ground, count, work, workers, shown):
        if branch != three[0]:
            shown.progress(1.0, 2.0, "journeys")
        return [{"end": end} for end in ("at_rest", "partner")]

    monkeypatch.setattr(forecast, "follow", follow)
    monkeypatch.setattr(forecast, "LANDERS", ("juventas",))
    monkeypatch.setattr(forecast, "branches", lambda lander: three)
    monkeypatch.setattr(forecast, "COUNTS", {"soil": 240})
    (tmp_path / folder_name(three[1], "soil")).mkdir()
    rows, costs = forecast.run_all(tmp_path, 1)
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

    assert [plain(one) for one in (0.0, 0.2, 0.183, 1.04, 23.4, 242.1, 58_357.6)] == [
        "0", "0.20", "0.18", "1.0", "23", "240", "58000",
    ]  # fmt: skip


def test_the_page_has_a_row_for_each_variant_and_no_part_for_none() -> None:
    from write_page import variants_part

    row = {
        "variant": "held_speed 0.03", "lander": "milani", "landers": 24, "at_rest": 23, "at_rest_before": 24,
        "median_time_s": 1200.0, "median_time_before_s": 1500.0, "time_ratio": 0.8, "lower": 0.61, "upper": 1.02,
    }  # fmt: skip
    heading, rows, _ = variants_part([row])
    assert heading.startswith("## ")
    assert rows.endswith("| 23 and 24 of 24 | 20 and 25 | 0.80 (0.61-1.0) |")
    assert variants_part([]) == []
