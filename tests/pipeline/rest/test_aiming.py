"""Aims of a study, from its file to its page; and hard ground with the restitution that a soft surface implies."""

import dataclasses
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import lithobrake
from lithobrake.files.reading import read_rows
from lithobrake.pipeline.answer.journey_limit_states import UNKNOWN
from lithobrake.pipeline.first_touchdown.bounce_laws import implied
from lithobrake.pipeline.journeys.landers import ways_from_aims
from lithobrake.results import StudyResults
from lithobrake.results.study_files import json_values
from lithobrake.smallbody import HardSurface, Impacts, didymos
from lithobrake.statements.limits import options
from lithobrake.study import StudyError
from lithobrake.study.reader import check_tables

from ...synthetic_landings import WEAK
from ..few_terms import REFITS, fewest_terms
from ..synthetic_lander import SyntheticLander, synthetic_tables

ARRIVAL = {
    "speed": {"distribution": "uniform", "lower": 0.005, "upper": 0.4},
    "incidence_deg": {"distribution": "uniform", "lower": 0.0, "upper": 88.0},
}
AIM: dict[str, Any] = {
    "grid": {"delivery.speed": [0.1, 0.3], "delivery.incidence_deg": [10.0, 40.0, 60.0]},
    "within": ["incidence_deg < 45", "distance_p95 < 500"],
    "lander_count": 2,
}
FEW = {"design": {"run_count": 48}, "monte_carlo": {"sample_count": 200}, "flight": {"flight_count": 100}}


# Refits that follow landers from the options, where others have twice as many.
FEW_REFITS = REFITS // 2
# So much resistance that no captured lander rolls far, which takes most of the time elsewhere.
HARD = {"count": 10, "rolling_friction": 2.0}


def tables(**aim: Any) -> dict[str, Any]:
    return synthetic_tables(**FEW, impact=ARRIVAL, site={"latitude_deg": 75.0}, hard_ground=HARD, aim={**AIM, **aim})


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> StudyResults:
    model = SyntheticLander(dataclasses.replace(WEAK, capture=0.2), follows_speed=True)
    with fewest_terms():
        return lithobrake.run(tables(), tmp_path_factory.mktemp("aims") / "out", workers=1, model=model)


@pytest.fixture(scope="module")
def found(results: StudyResults) -> dict[str, Any]:
    return results.summary["results"]["aim"]


def test_every_aim_has_its_shares_on_both_grounds_with_intervals(results: StudyResults, found: dict[str, Any]) -> None:
    assert [aim["values"] for aim in found["aims"]] == [[v, i] for v in (0.1, 0.3) for i in (10.0, 40.0, 60.0)]
    rows = read_rows(results.folder / "aim.csv", ("ground", "aim", "status"), "")
    assert len(rows) == 2 * 6 * found["lander_count"] == 2 * 6 * 2 * FEW_REFITS
    for number, aim in enumerate(found["aims"]):
        for ground in ("soil", "hard"):
            ends = [row["status"] for row in rows if row["ground"] == ground and int(row["aim"]) == number]
            share = aim[ground]["settled"]
            unknown = sum(end in UNKNOWN for end in ends)
            assert share["share"] == pytest.approx(ends.count("at_rest") / (len(ends) - unknown))
            assert aim[ground]["missing"] == pytest.approx(unknown / len(ends))
            assert 0.0 <= share["lower"] <= share["share"] <= share["upper"] <= 1.0
    assert 0.0 < found["aims"][3]["soil"]["time_p95"]["value"] < 86_400.0
    assert found["aims"][3]["hard"]["distance_p95"]["lower"] < found["aims"][3]["hard"]["distance_p95"]["value"]


def test_the_best_keeps_the_limits_and_says_how_sure_it_is(found: dict[str, Any]) -> None:
    best = found["best_on_soil"]
    allowed = [number for number, aim in enumerate(found["aims"]) if aim["soil"]["allowed"]]
    shares = {number: found["aims"][number]["soil"]["settled"]["share"] for number in allowed}
    assert {number % 3 for number in allowed} <= {0, 1}
    assert shares[best["aim"]] == max(shares.values())
    assert sum(aim["soil"]["share_of_refits"] for aim in found["aims"]) == pytest.approx(1.0)
    gap = shares[best["aim"]] - shares[best["next"]]
    assert best["difference"]["value"] == pytest.approx(gap)
    assert best["difference"]["lower"] < gap < best["difference"]["upper"]
    assert best["own"]["lower"] <= best["own"]["share"] <= best["own"]["upper"]
    # What the choice of the best of several adds is taken off its share.
    assert best["own"]["share"] < shares[best["aim"]]
    assert set(best["not_worse"]) <= set(allowed) - {best["aim"]}
    assert all(found["best_on_hard"][key] is None for key in ("share_of_refits", "own", "not_worse"))


def test_the_statement_has_the_share_without_selection_and_names_what_is_alike(results: StudyResults) -> None:
    found = results.results.aim
    best, allowed = found.best_on_soil, sum(aim.soil.allowed for aim in found.aims)
    assert f": {100 * best.own.value:.0f} % (90 % interval " in found.statement
    assert "of the refits" not in found.statement
    told = options(replace(found, best_on_soil=replace(best, not_worse=(1,))))
    assert told.startswith(f"2 of {allowed} delivery options within ")
    assert " cannot be distinguished from the best, with 90 % confidence: delivery.speed = 0.1, " in told
    told = options(replace(found, best_on_soil=replace(best, not_worse=())))
    assert told.startswith(f"One of {allowed} delivery options within ")
    assert " is better than every other, with 90 % confidence. Most landers come to rest with delivery.speed = " in told


def test_every_key_is_described_and_the_page_shows_the_aims(results: StudyResults, found: dict[str, Any]) -> None:
    assert json_values(results.results) == results.summary["results"]
    assert found["statement"] in results.headline
    assert "ost landers come to rest with delivery.speed = " in found["statement"]
    assert "Delivery options" in (results.folder / "report" / "index.html").read_text(encoding="utf-8")
    assert [path.name for path in (results.folder / "report").glob("*_aim.png")]


def test_ways_over_the_ground_are_arcs() -> None:
    body, site = didymos(), {"latitude_deg": np.zeros(2), "longitude_deg": np.zeros(2)}
    places = body.shape.surface_point(np.zeros(2), np.array([90.0, 0.0]))
    radius = float(np.linalg.norm(body.shape.surface_point(0.0, 0.0)))
    assert ways_from_aims(body, site, places) == pytest.approx([0.5 * np.pi * radius, 0.0])


@pytest.mark.parametrize(("aim", "words"), [
    ({"grid": {"delivery.sped": [0.1]}}, r'aim\.grid\."delivery\.sped" is no aim; .* did you mean delivery\.speed'),
    ({"grid": {"delivery.speed": [0.1, 0.9]}}, r"ascending values from 0\.005 to 0\.4"),
    ({"grid": {"delivery.speed": [0.2, 0.1]}}, "ascending values"),
    ({"within": ["incidence_deg"]}, r'aim\.within has "incidence_deg"; allowed: one of speed, incidence_deg, at_rest'),
    ({"within": ["latitude_deg < 3"]}, "allowed: one of speed, incidence_deg"),
    ({"grid": {}}, r"aim\.within is given without aim\.grid"),
    ({"grid": {"delivery.speed": np.linspace(0.01, 0.4, 501).tolist()}}, "at most 3 and 500"),
])  # fmt: skip
def test_aims_that_cannot_be_are_refused(aim: dict[str, Any], words: str) -> None:
    with pytest.raises(StudyError, match=words):
        check_tables(tables(**aim), Path())


def test_hard_ground_implies_itself() -> None:
    """The rebounds of a hard surface give back the numbers that it was made of."""
    random = np.random.default_rng(1)
    speed, incidence = random.uniform(0.01, 0.4, 200), random.uniform(0.1, 1.2, 200)
    nothing, lander = np.zeros((200, 3)), np.arange(200)
    for friction in (np.inf, 0.1):
        impacts = Impacts(speed, incidence, nothing, np.full(200, -1e-4), lander)
        found = implied(speed, incidence, HardSurface(0.6, 0.8, friction)(impacts, random).velocity)
        assert found["normal_restitution"] == pytest.approx(0.6)
        slides = found["tangential_restitution"] > 0.8 + 1e-9
        assert found["tangential_restitution"][~slides] == pytest.approx(0.8)
        assert found["friction"][slides] == pytest.approx(friction)
        assert slides.any() == np.isfinite(friction)
