"""Runs drawn out of one sequence: their laws, their beds, their attitudes."""

import tomllib
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from lithobrake.pipeline import stage_keys
from lithobrake.pipeline.design.dependencies import bed_files, pour_seed, touchdown_keys
from lithobrake.pipeline.design.drawn_design import DrawnDesign, beds_of_runs
from lithobrake.pipeline.design.lander_attitude import attitude_terms, independent_terms, seen, with_side_down
from lithobrake.pipeline.design.place_region import place_region, smallest_width
from lithobrake.study import Study, check_tables
from lithobrake.study.bed_section import LANDINGS_A_BED, default_bed_count
from lithobrake.study.lander_sides import directions_of_sides, side_words, sides_down
from lithobrake.study.template import template
from lithobrake.study.touchdown_model import PLACE, draw, medians
from lithobrake.vocabulary.quantities import ORIENTATION

from ..journeys.soil_journeys import STUDY

TABLES: dict[str, Any] = tomllib.loads(template()) | {"design": {"method": "drawn"}}
SOIL = ("grain.young_modulus", "grain.friction", "lander.restitution")
ARRIVAL = ("bed", *PLACE, "impact.azimuth_deg", *ORIENTATION)
REGION = {"x": [-0.1, 0.05], "y": [0.0, 0.02]}


def drawn(run_count: int = 240, seed: int = 1, **changes: dict[str, Any]) -> Study:
    """The template with so many runs out of the sequence, and with other keys in its tables."""
    tables = TABLES | {name: {**TABLES.get(name, {}), **keys} for name, keys in changes.items()}
    tables["design"] = {**tables["design"], "run_count": run_count}
    return check_tables(tables | {"seed": seed}, Path())


def columns(rows: list[dict[str, float]], *names: str) -> np.ndarray:
    return np.array([[row[name] for name in names] for row in rows])


@pytest.mark.parametrize(("few", "many"), [(2, 13), (12, 144), (115, 240), (240, 241), (599, 1200)])
@pytest.mark.parametrize("beds", [{}, {"bed": {"bed_count": 2}}], ids=["beds grow", "two beds"])
def test_more_runs_leave_every_run_with_its_bed_and_its_key(
    few: int, many: int, beds: dict[str, dict[str, Any]]
) -> None:
    first, second = drawn(few, **beds), drawn(many, **beds)
    before, after = DrawnDesign(first).rows, DrawnDesign(second).rows
    assert (len(before), len(after)) == (few, many)
    assert before == after[:few]
    assert touchdown_keys(first, before, 0) == touchdown_keys(second, after[:few], 0)
    assert set(bed_files(first)) <= set(bed_files(second))
    # A bed is poured from the same seed, however many there are.
    assert stage_keys(first)["bed"] == stage_keys(second)["bed"]
    assert stage_keys(first)["runs"] != stage_keys(second)["runs"]


@pytest.mark.parametrize("beds", [1, 5, 12, 24, 60])
def test_beds_that_are_given_have_equally_many_runs(beds: int) -> None:
    for run_count in (max(beds, 2), 60, 120, 143, 240):
        counts = Counter(beds_of_runs(drawn(run_count, bed={"bed_count": beds}), run_count))
        assert len(counts) == beds
        assert max(counts.values()) - min(counts.values()) <= 1


def test_beds_that_grow_with_the_runs_are_all_used_and_full_at_each_twenty() -> None:
    study = drawn(240)
    for run_count in range(2, 800):
        counts = Counter(beds_of_runs(study, run_count))
        assert set(counts) == set(range(default_bed_count(run_count, LANDINGS_A_BED)))
        # The newest bed fills next, and only where one has yet to be filled are the others ahead of it.
        *filled, newest = (counts[bed] for bed in range(len(counts)))
        assert max(filled) - min(filled) <= 1
        assert newest <= max(filled) or max(counts.values()) - min(counts.values()) <= 1
        if run_count % LANDINGS_A_BED == 0 and run_count >= 12 * LANDINGS_A_BED:
            assert set(counts.values()) == {LANDINGS_A_BED}


def test_blocks_of_beds_have_an_order_of_their_own_that_the_seed_decides() -> None:
    first, other = (np.array(beds_of_runs(drawn(96, seed), 96)).reshape(8, 12) for seed in (1, 2))
    assert first[0].tolist() == list(range(12))
    assert len({tuple(block) for block in first.tolist()}) == 8
    assert not np.array_equal(first[1:], other[1:])


def test_every_coordinate_is_spread_evenly_over_its_law() -> None:
    study = drawn(256, impact={"region": REGION})
    rows = DrawnDesign(study).rows
    names = (*SOIL, *PLACE, "impact.azimuth_deg")
    laws = [study.grain.young_modulus, study.grain.friction, study.lander.restitution]
    probability = [law.to_chaos().cdf(columns(rows, name)[:, 0]) for law, name in zip(laws, names, strict=False)]
    probability += [(columns(rows, PLACE[0])[:, 0] + 0.1) / 0.15, columns(rows, PLACE[1])[:, 0] / 0.02]
    probability += [columns(rows, "impact.azimuth_deg")[:, 0] / 360.0]
    for one in probability:
        # 256 points of a Sobol sequence: exactly one in each of 256 equal parts.
        assert np.array_equal(np.sort(np.floor(one * 256)), np.arange(256))
    assert np.abs(np.corrcoef(probability) - np.eye(len(names))).max() < 0.1
    attitudes = columns(rows, *ORIENTATION)
    assert np.linalg.norm(attitudes, axis=1) == pytest.approx(1.0, abs=1e-12)
    assert np.abs(attitudes.T @ attitudes / 256 - np.eye(4) / 4).max() < 0.03


def test_what_is_given_is_not_drawn_and_leaves_the_rest_as_it_was() -> None:
    free = DrawnDesign(drawn(40, impact={"region": REGION})).rows
    held = {"azimuth_deg": 30.0, "place": {"x": 0.01, "y": 0.02}, "orientation": [2, 0, 0, 0]}
    rows = DrawnDesign(drawn(40, impact=held)).rows
    assert np.array_equal(columns(free, "bed", *SOIL), columns(rows, "bed", *SOIL))
    expected = [0.01, 0.02, 30.0, 1.0, 0.0, 0.0, 0.0]
    assert np.array_equal(columns(rows, *ARRIVAL[1:]), np.tile(expected, (40, 1)))


def test_an_uncertain_place_or_azimuth_is_an_input_like_any_other() -> None:
    law = {"distribution": "uniform", "lower": 0.0, "upper": 10.0}
    rows = DrawnDesign(drawn(64, impact={"azimuth_deg": law})).rows
    assert np.array_equal(np.sort(np.floor(columns(rows, "impact.azimuth_deg")[:, 0] * 6.4)), np.arange(64))


def test_an_error_of_pointing_tilts_each_run_within_its_cone() -> None:
    rows = DrawnDesign(drawn(64, impact={"orientation": [1, 0, 0, 0], "pointing_error_deg": 10.0})).rows
    tilt = np.degrees(2.0 * np.arccos(columns(rows, ORIENTATION[0])[:, 0]))
    assert 9.0 < tilt.max() <= 10.0
    assert np.all(columns(rows, ORIENTATION[3]) == 0.0)


def test_the_papers_runs_take_an_error_of_pointing_too() -> None:
    arrival = {"orientation": [1, 0, 0, 0], "pointing_error_deg": 10.0}
    study = check_tables(TABLES | {"design": {"method": "paper"}, "impact": {**TABLES["impact"], **arrival}}, Path())
    draws = [draw(study, medians(study), seed) for seed in range(50)]
    assert 8.0 < np.degrees(2.0 * np.arccos(columns(draws, ORIENTATION[0])[:, 0])).max() <= 10.0
    # The error is drawn after all else, which is as it was without it.
    given = {**TABLES["impact"], "orientation": [1, 0, 0, 0]}
    without = check_tables(TABLES | {"design": {"method": "paper"}, "impact": given}, Path())
    before, no_attitude = draw(without, medians(without), 3), dict.fromkeys(ORIENTATION, 0.0)
    assert before | no_attitude == draws[3] | no_attitude


def test_places_are_drawn_where_the_smallest_bed_leaves_room() -> None:
    study = drawn(64, bed={"width": [0.8, 1.0], "grain_count": 400, "sides": "walls"})
    region, width = place_region(study), smallest_width(study)
    assert region == ((-0.5 * (0.8 - width), 0.5 * (0.8 - width)), (-0.5 * (1.0 - width), 0.5 * (1.0 - width)))
    places = columns(DrawnDesign(study).rows, *PLACE)
    assert np.all(np.abs(places) <= [region[0][1], region[1][1]])
    # Half of 64 parts of the way to each end.
    assert np.all(np.abs(places).max(axis=0) > 0.9 * np.array([region[0][1], region[1][1]]))


def test_places_are_drawn_all_over_ground_that_repeats() -> None:
    study = drawn(64, bed={"width": [0.8, 1.0], "grain_count": 400})
    assert place_region(study) == ((-0.4, 0.4), (-0.5, 0.5))
    assert np.all(np.abs(columns(DrawnDesign(study).rows, *PLACE)).max(axis=0) > 0.9 * np.array([0.4, 0.5]))


def test_a_bed_that_is_too_narrow_for_its_rule_is_landed_on_in_the_middle() -> None:
    # A heavy little ball is long in touch with a grain, and a wave goes far in that time.
    ball = {"shape": "sphere", "diameter": 0.05, "mass": 50.0, "restitution": TABLES["lander"]["restitution"]}
    narrow = {**TABLES["bed"], "width": [0.25, 2.0], "sides": "walls"}
    study = check_tables(TABLES | {"lander": ball, "bed": narrow}, Path())
    assert 0.25 < smallest_width(study) < 2.0
    along, across = place_region(study) or ()
    assert along == (0.0, 0.0)
    assert across[0] < 0.0 < across[1]


def test_two_seeds_share_no_pour_and_one_seed_repeats_its_own() -> None:
    seeds = {(seed, bed): pour_seed(drawn(seed=seed), bed) for seed in range(40) for bed in range(60)}
    assert len(set(seeds.values())) == len(seeds)
    assert seeds == {(seed, bed): pour_seed(drawn(700, seed=seed), bed) for seed, bed in seeds}
    assert all(0 <= seed < 2**53 for seed in seeds.values())


def test_soil_pairs_have_another_soil_and_arrive_alike() -> None:
    study = drawn(50)
    rows, pairs = DrawnDesign(study).rows, DrawnDesign(study).rows_of("soil_pairs")
    assert len(pairs) == 20
    assert np.array_equal(columns(rows[:20], *ARRIVAL), columns(pairs, *ARRIVAL))
    assert np.all(columns(rows[:20], *SOIL) != columns(pairs, *SOIL))
    assert len(DrawnDesign(drawn(7)).rows_of("soil_pairs")) == 7
    assert DrawnDesign(drawn(500)).rows_of("soil_pairs") == pairs


def test_twins_come_down_a_little_beside_and_nothing_else_differs() -> None:
    study = drawn(50, design={"method": "drawn", "side_runs": True, "twin_shift": 2e-4})
    rows, pairs = DrawnDesign(study).rows[:12], DrawnDesign(study).rows_of("twins")
    assert len(pairs) == 12
    shift = columns(pairs, *PLACE) - columns(rows, *PLACE)
    assert np.linalg.norm(shift, axis=1) == pytest.approx(2e-4)
    # In all directions, but for those toward a wall.
    assert len(np.unique(np.round(np.arctan2(shift[:, 1], shift[:, 0]), 6))) == 12
    assert np.all((shift * columns(rows, *PLACE)).sum(axis=1) <= 0.0)
    names = [name for name in rows[0] if name not in PLACE]
    assert np.array_equal(columns(rows, *names), columns(pairs, *names))


def study_of(text: str) -> Study:
    return check_tables(tomllib.loads(text), Path())


BOX = study_of(STUDY)
PRISM = study_of(STUDY.replace("[0.12, 0.1, 0.08]", "[0.08, 0.14, 0.08]"))
BALL = study_of(STUDY.replace('"box", edges = [0.12, 0.1, 0.08]', '"sphere", diameter = 0.1'))


def test_terms_follow_the_shape_and_a_ball_has_none() -> None:
    assert [attitude_terms(one).names for one in (BOX, PRISM)] == [("x", "z"), ("y",)]
    assert attitude_terms(BALL) is None
    assert independent_terms(DrawnDesign(BALL), {}) is None


def attitude_columns(turned: Rotation) -> dict[str, np.ndarray]:
    """Inputs of touchdowns of these attitudes in the bed."""
    quaternions = np.roll(turned.as_quat(), 1, axis=1)
    return dict(zip(ORIENTATION, quaternions.T, strict=True)) | {"impact.azimuth_deg": np.zeros(len(quaternions))}


def test_drawn_attitudes_have_independent_terms() -> None:
    found = independent_terms(DrawnDesign(BOX), attitude_columns(Rotation.random(20_000, rng=0)))
    assert found.mean(axis=0) == pytest.approx(np.zeros(6), abs=0.03)
    assert np.cov(found.T) == pytest.approx(np.eye(6), abs=0.04)


def test_one_attitude_has_no_terms_and_a_pointed_one_has_those_of_its_cone() -> None:
    one = study_of(STUDY.replace("[delivery]", "[delivery]\norientation = [1.0, 0.0, 0.0, 0.0]"))
    assert independent_terms(DrawnDesign(one), attitude_columns(Rotation.identity(20))) is None
    tilts = 0.1 * np.random.default_rng(1).standard_normal((400, 3))
    found = independent_terms(DrawnDesign(one), attitude_columns(Rotation.from_rotvec(tilts)))
    # Over the runs themselves they are exactly independent, however small the cone.
    assert found.mean(axis=0) == pytest.approx(np.zeros(found.shape[1]), abs=1e-9)
    assert found.T @ found / 400 == pytest.approx(np.eye(found.shape[1]), abs=1e-6)


def test_the_side_is_that_of_the_axis_nearest_to_the_normal() -> None:
    normal = np.array([[0.9, 0.3, -0.3], [-0.2, 0.8, 0.5], [0.1, 0.2, -0.9]])
    assert sides_down(BOX.lander, normal).tolist() == ["x", "y", "z"]
    assert sides_down(PRISM.lander, normal).tolist() == ["x or z", "y", "x or z"]
    assert sides_down(BALL.lander, normal).tolist() == ["", "", ""]
    assert side_words(BOX.lander, "z") == "z, 0.12 m x 0.1 m"
    assert side_words(PRISM.lander, "x or z") == "x or z, 0.14 m x 0.08 m"


@pytest.mark.parametrize("study", [BOX, PRISM])
def test_a_chosen_side_is_down_whatever_the_azimuth(study: Study) -> None:
    random = np.random.default_rng(2)
    for side, downs in directions_of_sides(study.lander).items():
        down, azimuth = np.array(downs)[random.integers(len(downs), size=40)], 360.0 * random.random(40)
        turned = with_side_down(down, azimuth, random.random(40))
        normal, travel = seen(dict(zip(ORIENTATION, turned.T, strict=True)) | {"impact.azimuth_deg": azimuth})
        assert normal == pytest.approx(-down, abs=1e-12)
        assert set(sides_down(study.lander, normal)) == {side}
        # It comes from all sides.
        assert np.linalg.norm(travel.mean(axis=0)) < 0.35
