"""Kinds of ground in a study file: what each bed draws, what its bed has to be, presets, refusals."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lithobrake.study import Study, StudyError, check_tables, load_tables
from lithobrake.study.checks import narrowest_period
from lithobrake.study.ground_beds import finer_share, finest, grounds, mean_weights, of_ground, on_ground
from lithobrake.study.ground_presets import GROUND_PRESETS

QUICK = Path(__file__).parents[2] / "scenarios" / "quick.toml"
GRAVEL = {"weight": 0.75, "grain_size": {"distribution": "log_uniform", "lower": 0.09, "upper": 0.4}}
SHARE = {"distribution": "uniform", "lower": 0.2, "upper": 0.6}
KINDS: dict[str, Any] = {"gravel": GRAVEL, "rock": {"weight": 0.25, "rock": True}}


def tables(**ground: Any) -> dict[str, Any]:
    """The quick study on such ground."""
    found = load_tables(QUICK)
    return found | {"bed": {"bed_count": 24, "pour_gravity": 0.5}, "ground": {"kind": KINDS} | ground}


def study(**ground: Any) -> Study:
    return check_tables(tables(**ground), QUICK.parent)


def test_beds_draw_kinds_by_weight_and_sizes_by_their_law() -> None:
    drawn = grounds(study())
    kinds = [one.kind for one in drawn]
    # A sequence that fills the square evenly: 18 and 6 of 24, but for one.
    assert abs(kinds.count("gravel") - 18) <= 1
    sizes = np.log([one.size for one in drawn if one.kind == "gravel"])
    assert sizes.min() >= math.log(0.09)
    assert sizes.max() <= math.log(0.4)
    assert sizes.mean() == pytest.approx(0.5 * math.log(0.09 * 0.4), abs=0.1)
    # Rock is three times as large as the lander, whose diagonal is 0.267 m.
    assert [one.size for one in drawn if one.kind == "rock"] == pytest.approx(
        [3.0 * math.hypot(0.1, 0.1, 0.227)] * kinds.count("rock")
    )


def test_uncertain_weights_are_those_of_a_body() -> None:
    """Shares 0.2 to 0.6 and 1 - 0.4 = 0.6 of them all: each body's add up to 1, and their mean is that of many."""
    whole = study(kind={"gravel": GRAVEL | {"weight": SHARE}, "rock": {"weight": 0.6, "rock": True}})
    drawn, mean = grounds(whole), mean_weights(whole)
    assert [math.fsum(one.weights) for one in drawn] == pytest.approx([1.0] * len(drawn))
    first = [one.weights[0] for one in drawn]
    assert 0.25 <= min(first) < 0.3 < 0.45 < max(first) <= 0.5
    # The mean of w / (w + 0.6) over the range, in closed form.
    exact = 1.0 - 0.6 * math.log(1.2 / 0.8) / 0.4
    assert mean == pytest.approx({"gravel": exact, "rock": 1.0 - exact}, abs=1e-4)
    assert np.mean([one.kind == "gravel" for one in drawn]) == pytest.approx(exact, abs=0.1)


def test_more_beds_change_the_ground_of_none() -> None:
    few = study()
    many = few.model_copy(update={"bed": few.bed.model_copy(update={"bed_count": 40})})
    assert grounds(many)[:24] == grounds(few)


@pytest.mark.parametrize("size", [0.09, 0.12, 0.4, 2.0])
def test_a_bed_is_as_wide_and_deep_as_grains_and_lander_ask(size: float) -> None:
    kind = {"weight": 1.0, "grain_size": size, "size_ratio": 2.0}
    whole = study(kind={"one": kind})
    bed = on_ground(whole, 0).bed
    assert bed.width[0] == bed.width[1] == pytest.approx(narrowest_period(on_ground(whole, 0)), abs=1.001e-3)
    sizes = bed.diameter
    assert sizes.distribution == "uniform"
    assert (sizes.lower + sizes.upper) / 2.0 == pytest.approx(size)
    assert sizes.upper / sizes.lower == pytest.approx(2.0)
    # Mean volume of diameters uniform between two ends, of which 60 % fill the bed.
    volume = math.pi / 6.0 * (sizes.lower + sizes.upper) * (sizes.lower**2 + sizes.upper**2) / 4.0
    depth = bed.grain_count * volume / (0.6 * bed.width[0] ** 2)
    assert depth == pytest.approx(max(2.2 * size, 0.6 * math.hypot(0.1, 0.1, 0.227)), rel=0.02)


def test_a_kind_has_materials_of_its_own() -> None:
    own = {"weight": 1.0, "grain_size": 0.1, "grain": {"friction": 0.3, "surface_energy": 1e-3}}
    found = of_ground(study(kind={"one": own}), grounds(study(kind={"one": own}))[0])
    assert (found.grain.friction, found.grain.surface_energy) == (0.3, 1e-3)
    assert found.grain.density == 2500.0


def test_the_grains_of_the_likeliest_kind_are_not_those_of_the_others() -> None:
    own = {"gravel": GRAVEL | {"grain": {"friction": 0.9}}, "rock": {"weight": 0.25, "rock": True}}
    whole, plain = study(kind=own), study()
    assert whole.grain == plain.grain
    assert whole.bed == plain.bed
    of_kind = {one.kind: of_ground(whole, one).grain.friction for one in grounds(whole)}
    assert of_kind == {"gravel": 0.9, "rock": plain.grain.friction}


def test_finer_ground_is_stood_for_by_the_finest_beds() -> None:
    fine = {"weight": 0.5, "grain_size": {"distribution": "log_uniform", "lower": 0.01, "upper": 0.16}}
    whole = study(finest=0.04, kind={"fine": fine, "rock": {"weight": 0.5, "rock": True}})
    assert min(one.size for one in grounds(whole)) == 0.04
    # Half of four octaves of half of the ground.
    assert finer_share(whole) == pytest.approx(0.25)
    assert finer_share(study()) == 0.0
    assert finest(study()) == pytest.approx(math.hypot(0.1, 0.1, 0.227) / 3.0)


@pytest.mark.parametrize("name", list(GROUND_PRESETS))
def test_a_preset_is_named_in_a_word(name: str) -> None:
    found = check_tables(tables() | {"ground": name.capitalize()}, QUICK.parent)
    assert found.ground is not None
    assert math.fsum(kind.weight for kind in found.ground.kind.values()) == pytest.approx(1.0)
    assert len(grounds(found)) == 24


REFUSED: list[tuple[dict[str, Any], str]] = [
    ({"ground": "dimorfos"}, 'study.toml: ground is "dimorfos"; allowed: a table [ground], or a name out of dimorphos'),
    ({"ground": "dimorfos"}, "did you mean dimorphos?"),
    ({"ground": 3}, "ground is 3; allowed: a table"),
    ({"ground": {}}, "[ground] has no kind"),
    ({"ground": {"kind": {"gravel": GRAVEL}}}, "add up to 0.75 (gravel 0.75); allowed: 1"),
    ({"ground": {"kind": KINDS, "unknown": "both"}}, 'ground.unknown is "both" and no ground.kind.NAME.weight is'),
    ({"ground": {"kind": {"one": GRAVEL | {"weight": SHARE}}}}, "one.weight is uncertain, and there is no other kind"),
    ({"ground": {"kind": {"one": GRAVEL | {"weight": SHARE | {"upper": 1.5}}}}}, "ground.kind.one.weight is"),
    ({"ground": {"kind": {"one": {"weight": 1.0}}}}, "ground.kind.one.grain_size is missing"),
    ({"ground": {"kind": {"one": {"weight": 1.5, "grain_size": 0.1}}}}, "ground.kind.one.weight is 1.5"),
    ({"ground": {"kind": {"one": {"weight": True, "grain_size": 0.1}}}}, "ground.kind.one.weight is true"),
    ({"ground": {"kind": {"one": GRAVEL | {"weight": 1.0, "grain_size": -0.1}}}}, "ground.kind.one.grain_size is -0.1"),
    ({"ground": {"kind": {"one": {"weight": 1.0, "grain_size": 0.01}}, "finest": 0.005}}, "at most 5000 grains"),
    ({"ground": {"kind": {"one": {"weight": 1.0, "grain_size": 0.2, "rock": True}}}}, "is rock; allowed: blocks of at"),
    ({"ground": {"kind": {"one": {"weight": 1.0, "grain_size": 0.1, "grain": {"surface_energy": 1e6}}}}}, "kind.one: "),
    (
        {
            "ground": {
                "kind": {
                    "one": {"weight": 1.0, "grain_size": 0.1}
                    | {"grain": {"density": {"distribution": "uniform", "lower": 1e3, "upper": 2e3}}}
                }
            }
        },
        "ground.kind.one.grain.density is uncertain and grain.density is not",
    ),
    ({"ground": {"kind": KINDS, "unknown": "nowhere"}}, "ground.unknown is"),
    ({"monte_carlo": {"sample_count": 100}}, "monte_carlo.sample_count is 100 beside [ground]"),
    (
        {"expansion": {"points": "sobol_sequence", "screening_count": 60, "refined_count": 60}},
        "[expansion] stands beside [ground]",
    ),
    ({"ground": {"kind": KINDS, "patch": 0.0}}, "ground.patch is 0"),
    ({"ground": {"kind": KINDS, "pach": 1.0}}, "ground.pach is not a known key; did you mean patch?"),
    ({"soil": {"pond": {"slope_deg": [0.0, 5.0], "ground": "gravle"}}}, 'ground is "gravle"; allowed: a kind of'),
    ({"bed": {"grain_count": 96}}, "bed.grain_count stands beside [ground]"),
    ({"bed": {"sides": "walls"}}, 'bed.sides is "walls"; allowed with [ground] is "periodic"'),
    ({"lander": {"shape": "hull", "file": "absent.obj", "mass": 2.0}}, "absent.obj"),
]


@pytest.mark.parametrize(("changed", "said"), REFUSED)
def test_a_ground_that_is_none_is_refused_in_one_sentence_each(changed: dict[str, Any], said: str) -> None:
    with pytest.raises(StudyError) as refused:
        check_tables(tables() | changed, QUICK.parent)
    assert any(said in problem for problem in refused.value.problems), refused.value.problems
    assert len(refused.value.problems) == 1
