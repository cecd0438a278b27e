"""Which bed a lander meets where the ground is unknown, and what a journey on each kind of it is expected to take."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.planning.planner import plan_of
from lithobrake.pipeline.runs.beds import bed_recipe
from lithobrake.pipeline.site import with_site_gravity
from lithobrake.pipeline.study_folder import StudyFolder
from lithobrake.study import Study, StudyError, check_tables, load_tables

QUICK = Path(__file__).parents[3] / "scenarios" / "quick.toml"
BEDS, LANDERS = 6, 300


def study(kinds: dict[str, Any], **ground: Any) -> Study:
    tables = load_tables(QUICK) | {"bed": {"bed_count": BEDS}, "ground": {"kind": kinds} | ground}
    return with_site_gravity(check_tables(tables, QUICK.parent))


def gravel(size: float, weight: float = 1.0) -> dict[str, Any]:
    return {"weight": weight, "grain_size": size}


@pytest.mark.parametrize(("patch", "is_another"), [(20.0, True), (200.0, False)])
def test_another_patch_begins_after_the_length_that_a_study_gives(patch: float, is_another: bool) -> None:
    """Patches are cubes: from the middle of one of 20 m the next begins after 10 m, that of 200 m does not."""
    kinds = {"fine": gravel(0.09, 0.5), "coarse": gravel(0.3, 0.5)}
    grounds = DrawnDesign(study(kinds, unknown="patchy", patch=patch)).grounds
    first = 200.0 * np.array([0.2, -0.8, 0.2]) + 10.0
    own, *next_door = (first + np.array([shift, 3.0, 0.0]) for shift in (9.0, 11.0, 29.0))
    assert [grounds.bed_at(lander, 2, first, own) for lander in range(LANDERS)] == [2] * LANDERS
    met = np.array([[grounds.bed_at(lander, 2, first, place) for place in next_door] for lander in range(LANDERS)])
    # Both places lie in one patch.
    assert (met[:, 0] == met[:, 1]).all()
    counts = np.bincount(met[:, 0], minlength=BEDS)
    if is_another:
        # Any bed, its own among them, as often as another: 50 of 300, with a standard deviation of 6.5.
        assert np.abs(counts - LANDERS / BEDS).max() < 26
    else:
        assert counts[2] == LANDERS


def test_a_kind_of_ground_costs_what_a_study_of_it_alone_costs(tmp_path: Path) -> None:
    both = {"fine": gravel(0.09, 0.5), "coarse": gravel(0.3, 0.5)}

    def prices(kinds: dict[str, Any]) -> dict[str, tuple[float, float] | None]:
        plan = plan_of(DrawnDesign(study(kinds)), "quick", StudyFolder(tmp_path / "out"), 1)
        return {kind.kind: kind.journey_s for kind in plan.kinds}

    found = prices(both)
    assert list(found) == ["fine", "coarse"]
    assert found["coarse"] == pytest.approx(prices({"coarse": gravel(0.3)})["coarse"], rel=1e-12)
    fine, coarse = found.values()
    assert fine is not None
    assert coarse is not None
    assert fine[0] > 2.0 * coarse[0] > 0.0


def test_patches_of_a_body_have_its_own_weights() -> None:
    """Of two kinds in unknown shares, a lander meets the first in other patches as often as its body has it."""
    share = {"distribution": "uniform", "lower": 0.1, "upper": 0.9}
    kinds = {"fine": gravel(0.09) | {"weight": share}, "coarse": gravel(0.3) | {"weight": share}}
    grounds = DrawnDesign(study(kinds, unknown="both", patch=20.0)).grounds
    first = np.full(3, 50.0)
    found = []
    for bed, own in enumerate(grounds.each):
        assert sum(own.weights) == pytest.approx(1.0)
        met = [grounds.each[grounds.bed_at(lander, bed, first, first + 20.0)].number for lander in range(LANDERS)]
        found.append(np.mean(met))
        # 300 draws: within three standard deviations.
        assert found[-1] == pytest.approx(own.weights[1], abs=3.0 * 0.5 / LANDERS**0.5)
    assert max(found) - min(found) > 0.2


def test_a_packing_is_drawn_for_each_bed_and_changes_no_other_draw() -> None:
    plain = {"fine": gravel(0.09, 0.5), "coarse": gravel(0.3, 0.5)}
    packed = plain | {"fine": gravel(0.09, 0.5) | {"pour_friction": 0.2}}
    law = {"distribution": "uniform", "lower": 0.1, "upper": 0.9}
    uncertain = plain | {"fine": gravel(0.09, 0.5) | {"pour_friction": law}}
    grounds = [DrawnDesign(study(kinds)).grounds.each for kinds in (plain, packed, uncertain)]
    for without, given in zip(grounds[0], grounds[1], strict=True):
        assert given == without._replace(pour_friction=0.2 if without.kind == "fine" else None)
    drawn = [one.pour_friction for one in grounds[2] if one.kind == "fine"]
    assert len(set(drawn)) == len(drawn) > 1
    assert all(friction is not None and 0.1 < friction < 0.9 for friction in drawn)
    assert all(one.pour_friction is None for one in grounds[2] if one.kind == "coarse")


def test_a_bed_is_poured_with_the_friction_of_its_packing() -> None:
    kinds = {"gravel": gravel(0.3) | {"pour_friction": 0.15}}
    assert bed_recipe(study(kinds), 0).material.friction == 0.15
    tables = load_tables(QUICK) | {"bed": {"bed_count": BEDS}, "ground": {"kind": {"gravel": gravel(0.3)}}}
    own = bed_recipe(with_site_gravity(check_tables(tables, QUICK.parent)), 0).material
    assert own.friction == pytest.approx(0.65)
    assert replace(own, friction=0.15) == bed_recipe(study(kinds), 0).material


@pytest.mark.parametrize("value", [-0.1, {"distribution": "uniform", "lower": -0.2, "upper": 0.3}])
def test_a_friction_below_zero_is_refused_by_the_key_of_its_kind(value: Any) -> None:
    with pytest.raises(StudyError, match=r"ground\.kind\.gravel\.pour_friction"):
        study({"gravel": gravel(0.3) | {"pour_friction": value}})


@pytest.mark.parametrize("key", ["yield_strength", "restitution_speed"])
def test_grains_of_a_pour_keep_one_restitution(key: str) -> None:
    tables = load_tables(QUICK)
    tables |= {"bed": {"bed_count": BEDS}, "ground": {"kind": {"gravel": gravel(0.3)}}}
    plain, falling = (
        with_site_gravity(check_tables(tables | {"grain": tables["grain"] | more}, QUICK.parent))
        for more in ({}, {key: 7e3})
    )
    assert falling.touchdown_medians()[f"grain.{key}"] == 7e3
    assert bed_recipe(falling, 0) == bed_recipe(plain, 0)
