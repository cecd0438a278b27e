"""Assumptions of the forecast: unknown ground, laws of restitution, and what they changed against other landers."""

import datetime
import shutil
from pathlib import Path

import numpy as np
import pytest

from lithobrake.study import StudySource
from lithobrake.study.ground_beds import grounds

ROOT = Path(__file__).parents[2]
FIRST = ROOT / "validation" / "forecast_hera" / "editions" / "2026-11-26"

pytestmark = pytest.mark.usefixtures("forecast_scripts")


def measured(**weights: float):
    from measurements import measurement_of

    given = {"quantity": "ground", "weights": weights, "date": datetime.date(2027, 1, 20), "source": "invented"}
    return measurement_of(given, "here")


def study(lander: str, number: int = 0, ground: str = "soil", measurements=()):
    from assumptions import UNKNOWN_GROUND
    from branches import branches

    tables = UNKNOWN_GROUND.study(branches(lander)[number], ground, 100, measurements)
    return StudySource.of_tables(tables).study


def landers(kinds: list[str], **columns) -> list[dict]:
    """Landers of Juventas on unknown ground while Dimorphos rolls, each on a bed of its own."""
    fixed = {
        "lander": "juventas", "branch": "rolling, at the surface", "ground": "soil", "end": "at_rest", "face": "+z",
        "law": "constant",
    }  # fmt: skip
    count = len(kinds)
    table = {"bed": range(count), "kind": kinds, **columns}
    return [{**fixed, **dict(zip(table, row, strict=True))} for row in zip(*table.values(), strict=True)]


def test_the_first_assumptions_leave_the_studies_of_the_first_edition() -> None:
    from assumptions import FIRST as ASSUMED
    from branches import LANDERS, branches

    for lander in LANDERS:
        for branch in branches(lander):
            assert ASSUMED.study(branch, "soil", 240) == branch.tables(240)


def test_each_bed_of_unknown_ground_has_a_kind_of_the_preset_and_a_law() -> None:
    """Kinds have the weights of the preset and laws a third each, over the beds of all branches within 2 points."""
    from assumptions import LAWS, PRESET
    from branches import branches

    shares, count = dict.fromkeys((*PRESET["kind"], *LAWS), 0.0), 0
    for number, branch in enumerate(branches("juventas")):
        own = study("juventas", number)
        count += own.journey.count
        assert own.bed_count == round(own.journey.count / 2)
        for one in grounds(own):
            for name in one.kind.split("_"):
                shares[name] += branch.weight / own.bed_count
    known = {name: one["weight"] for name, one in PRESET["kind"].items()} | dict.fromkeys(LAWS, 1.0 / 3.0)
    assert shares == pytest.approx(known, abs=0.022)
    assert count >= 100


def test_laws_of_restitution_are_apart() -> None:
    """Constant beds have neither strength nor speed, the others one; the hull leaves both to the grains."""
    from assumptions import RANGES

    own = study("juventas")
    assert (own.lander.yield_strength, own.lander.restitution_speed) == (0.0, 0.0)
    for name, kind in own.ground.kind.items():
        given = {key: kind.grain.values().get(key, getattr(own.grain, key)) for key in RANGES}
        is_off = {key: value == 0.0 for key, value in given.items()}
        law = name.split("_")[1]
        assert is_off == {"yield_strength": law != "yields", "restitution_speed": law != "viscoelastic"}, name


def test_the_strength_of_soft_grains_yields_at_the_speed_of_the_rock() -> None:
    """The speed goes with Y^(5/2) / E^2: that of the weakest and of the strongest ordinary chondrite."""
    from assumptions import SOFT, STRENGTHS

    for soft, (strength, modulus) in zip(STRENGTHS, ((6e6, 1e9), (2.6e8, 5e10)), strict=True):
        assert soft**2.5 / SOFT**2 == pytest.approx(strength**2.5 / modulus**2)


def test_hard_ground_is_that_of_the_first_assumptions() -> None:
    from assumptions import FIRST as ASSUMED
    from assumptions import UNKNOWN_GROUND
    from branches import branches

    for branch in branches("milani"):
        assert UNKNOWN_GROUND.study(branch, "hard", 400) == ASSUMED.study(branch, "hard", 400)


def test_measured_weights_of_kinds_weigh_landers_and_stand_in_fresh_studies() -> None:
    from samples import sample
    from weights import weighted

    given = measured(gravel=0.11, stones=0.5, rock=0.39)
    rows = landers(["gravel"] * 55 + ["stones"] * 25 + ["rock"] * 20, mass_kg=np.full(100, 3e9))
    of = sample(weighted(rows, "juventas", [given]), "juventas", "soil")
    kinds = of.column("kind")
    assert {name: of.weight[kinds == name].sum() for name in ("gravel", "stones", "rock")} == pytest.approx(
        given.weights
    )
    # Those that were simulated with it need none.
    of = sample(weighted(rows, "juventas", [given], [given]), "juventas", "soil")
    assert of.weight == pytest.approx(np.full(100, 0.01))
    none = measured(gravel=0.6, stones=0.4, rock=0.0)
    fresh = study("juventas", measurements=[none])
    assert sum(kind.weight for kind in fresh.ground.kind.values()) == pytest.approx(1.0)
    assert {name.split("_")[0] for name in fresh.ground.kind} == {"gravel", "stones"}
    with pytest.raises(ValueError, match="ground has rock, on which no lander was simulated; simulate fresh landers"):
        weighted(rows, "juventas", [given], [none])


def test_measurements_without_a_part_in_the_landers_are_refused(tmp_path: Path) -> None:
    from assumptions import FIRST as ASSUMED
    from assumptions import UNKNOWN_GROUND
    from edition import make_edition
    from measurements import measurement_of
    from weights import weighted

    date = datetime.date(2027, 1, 20)
    slope = {"quantity": "boulder_slope", "value": 3.0, "error": 0.2, "unit": "1", "date": date, "source": "invented"}
    with pytest.raises(
        ValueError, match=r"boulder_slope has no part in landers of unknown ground.*weights of .*ground"
    ):
        UNKNOWN_GROUND.refuse_unused([measurement_of(slope, "here")])
    given = measured(gravel=1.0, stones=0.0, rock=0.0)
    with pytest.raises(ValueError, match="ground has no part in landers of the first assumptions"):
        ASSUMED.refuse_unused([given])
    with pytest.raises(ValueError, match="these landers, which have one ground; take landers of unknown ground"):
        weighted(landers([""], mass_kg=[3e9]), "juventas", [given])
    file = tmp_path / "m.toml"
    file.write_text(
        '[[measurement]]\nquantity = "ground"\nweights = { gravel = 0.5, stones = 0.3, rock = 0.2 }\n'
        'date = 2027-01-20\nsource = "invented"\n', encoding="utf-8",
    )  # fmt: skip
    with pytest.raises(ValueError, match="which have one ground; allowed: landers of unknown ground"):
        make_edition(file, datetime.date(2027, 2, 1), FIRST, tmp_path / "editions")


def test_the_difference_of_other_landers_has_the_scatter_of_both() -> None:
    """Times of n beds have the error s / sqrt(n) of their mean; a half and a quarter of the landers rest."""
    from changes import apart

    random, count = np.random.default_rng(4), 400
    columns = {f"position_{axis}": np.zeros(count) for axis in "xyz"}

    def of(share: float, minutes: float) -> list[dict]:
        rests = np.arange(count) < share * count
        times = 60.0 * (minutes + random.normal(size=count))
        rows = landers(["gravel"] * count, time_s=times, **columns)
        return [{**row, "end": "at_rest" if rest else "escaped"} for row, rest in zip(rows, rests, strict=True)]

    found = apart(of(0.5, 20.0), of(0.25, 30.0), "juventas")
    assert found["at_rest"]["value"] == pytest.approx(-0.25)
    error = np.sqrt(0.5 * 0.5 / count + 0.25 * 0.75 / count)
    width = found["at_rest"]["upper"] - found["at_rest"]["lower"]
    assert width == pytest.approx(2.0 * 1.645 * error, rel=0.2)
    assert found["time_s"]["lower"] < 600.0 < found["time_s"]["upper"]
    assert found["time_s"]["value"] == pytest.approx(600.0, abs=30.0)


def test_groups_have_their_landers_whatever_their_branch() -> None:
    """3 of 4 on gravel rest and both on rock; Perks' prior adds a lander to each group."""
    from answers import by_group
    from samples import sample

    numbers = {name: np.arange(6.0) for name in ("time_s", "contacts", "distance", "first_speed_ratio")}
    rows = landers(["gravel"] * 4 + ["rock"] * 2, **numbers)
    rows[0]["end"] = "escaped"
    gravel, rock = by_group(sample(rows, "juventas", "soil"), "kind")
    assert (gravel["name"], gravel["landers"], gravel["beds"]) == ("gravel", 4, 4)
    assert gravel["at_rest"]["share"] == pytest.approx(3.25 / 5.0)
    assert rock["at_rest"]["share"] == pytest.approx(2.25 / 3.0)
    assert gravel["share"] + rock["share"] == pytest.approx(1.0)
    assert gravel["time_s"]["q50"] == pytest.approx(2.0)
    assert rock["at_rest"]["lower"] < rock["at_rest"]["share"] < rock["at_rest"]["upper"]


def test_measurements_weigh_the_newest_landers_without_any(tmp_path: Path) -> None:
    from edition import assumed_landers

    assert assumed_landers(tmp_path) == FIRST
    for day, names in ((1, ["landers.csv"]), (2, []), (3, ["landers.csv", "drawn.toml"])):
        own = tmp_path / f"2027-02-0{day}"
        own.mkdir()
        for name in (*names, "forecast.json"):
            shutil.copy(FIRST / "forecast.json", own / name)
    assert assumed_landers(tmp_path).name == "2027-02-01"


def test_the_tangle_of_an_outline_about_the_far_side_of_its_map_is_one_point() -> None:
    """A square of latitude and longitude whose corner was passed four times with teeth between; others stay."""
    from write_editions import without_tangle

    corner = [-50.0, 0.0]
    teeth = [corner, [-40.0, 1.0], corner, [-42.0, 2.0], corner, corner]
    side = [[-20.0, 10.0], [10.0, 20.0], [20.0, -10.0], [-20.0, -20.0]]
    found = without_tangle(np.array([*teeth, *side, corner]))
    assert found.tolist() == [corner, *side, corner]
    plain = np.array([*side, side[0]])
    assert without_tangle(plain) is plain


def test_pairs_that_are_all_alike_leave_an_interval() -> None:
    """None of 16 pairs differs: a difference of 0 within some per cent; 4 of 16 only after: a quarter."""
    from effects import rest_change

    before = [{"end": "at_rest" if number % 4 else "escaped", "bed": number // 2} for number in range(16)]
    same = rest_change(before, before)
    assert same["value"] == 0.0
    assert -0.12 < same["lower"] < -0.005
    assert 0.005 < same["upper"] < 0.12
    more = rest_change(before, [{**row, "end": "at_rest"} for row in before])
    assert more["value"] == pytest.approx(0.25)
    assert 0.05 < more["lower"] < 0.25 < more["upper"] < 0.5
