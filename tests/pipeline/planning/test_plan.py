"""What `lithobrake plan` says of a study before it runs, beside what then comes of it."""

import json
import math
import os
import shutil
import subprocess
import sys
import tomllib
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq
from typer.testing import CliRunner

from lithobrake.campaign import Ledger, Record, RunStatus, available_cores
from lithobrake.cli import app
from lithobrake.pipeline import Plan, StudyFolder, plan_lines, plan_study, stage_keys
from lithobrake.pipeline.design.dependencies import pour_seed
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.first_touchdown.samples import Samples
from lithobrake.pipeline.job import Silent
from lithobrake.pipeline.planning import expected_time
from lithobrake.pipeline.planning.expected_steps import ExpectedSoil, PlannedRuns
from lithobrake.pipeline.planning.expected_time import (
    SPREAD,
    SPREAD_OF_TOUCHDOWNS,
    expected_bytes,
    landing_time,
    pour_time,
    run_time,
)
from lithobrake.pipeline.planning.plan import brief_lines
from lithobrake.pipeline.planning.planned_ground import planned_boulders, planned_grains, planned_ground, planned_tile
from lithobrake.pipeline.planning.planner import plan_of
from lithobrake.pipeline.planning.study_warnings import _missed, expected_loss, study_warnings
from lithobrake.pipeline.site import with_site_gravity
from lithobrake.pipeline.study_run import run_study
from lithobrake.results import open_study
from lithobrake.study import Study, StudyError, StudySource, check_tables, load_tables, read_study
from lithobrake.vocabulary.quantities import OUTPUTS

from ...paper_tables import with_keys
from ..ball_studies import BALL, FEW_RUNS, write_ball

HERE = Path(__file__).parents[3]
SCENARIOS = HERE / "scenarios"
FEW = FEW_RUNS | {
    "lower = 0.05, upper = 0.4": "lower = 0.1, upper = 0.3",
    "refined_level = 3": "refined_level = 2",
    "test_count = 10": "test_count = 3",
}


@pytest.fixture(autouse=True)
def idle_cores(monkeypatch: pytest.MonkeyPatch) -> None:
    """Other tests at work count for nothing."""
    monkeypatch.setattr(expected_time, "_load", lambda: 0.0)


def soft(**changes: dict[str, Any]) -> Study:
    """The study of one place with these keys of its sections changed."""
    return check_tables(with_keys(load_tables(SCENARIOS / "one_place.toml"), changes), SCENARIOS)


def journeys(roughness_deg: float) -> Study:
    tables = with_keys(load_tables(SCENARIOS / "one_ground.toml"), {"site": {"roughness_deg": roughness_deg}})
    return check_tables(tables, SCENARIOS)


def plan_for(study: Study, folder: StudyFolder, workers: int | None, *, on_cluster: bool = False) -> Plan:
    return plan_of(DrawnDesign(study), "quick", folder, workers, on_cluster=on_cluster)


def soil_of(study: Study) -> ExpectedSoil:
    return ExpectedSoil.of(DrawnDesign(study), len(DrawnDesign(study).inputs))


def test_the_runs_that_are_counted_are_those_that_are_made(tmp_path: Path) -> None:
    study, out = write_ball(tmp_path / "study.toml", FEW), tmp_path / "out"
    before = plan_study(study, out)
    fewest, most = before.runs
    assert (fewest.kept_count, most.kept_count, most.screening, most.test) == (1, 4, 9, 6)
    # Of the 41 nodes of level 2 nine are those of level 1; of the five of one input three.
    assert (fewest.refined, most.refined) == (2, 32)
    assert before.made["touchdowns"] == (fewest.total, most.total) == (17, 47)
    run_study(StudySource.read(study), out, worker_count=1, until="screen")
    screened = plan_study(study, out)
    (left,) = screened.runs
    assert (len(left.known), left.total) == (9, screened.made["touchdowns"][0] + 9)
    assert fewest.total <= left.total <= most.total
    run_study(StudySource.read(study), out, worker_count=1, until="test")
    assert len(open_study(out).ledger) == left.total
    tested = plan_study(study, out)
    assert tested.made["touchdowns"] == (0, 0)
    assert (tested.runs[0].new, tested.stages[0]) == (0, "samples")
    # One more test run in each set, and all others as before.
    more = write_ball(tmp_path / "study.toml", FEW | {"test_count = 10": "test_count = 4"})
    assert plan_study(more, out).made["touchdowns"] == (2, 2)


def test_the_plan_says_how_many_and_how_large_the_grains_of_a_size_law_are() -> None:
    """The number per diameter falls with D^-3 between 0.05 and 0.1 m, by either exponent."""
    found = []
    for key, exponent in (("exponent", 3.0), ("cumulative_exponent", 2.0)):
        sizes = {"distribution": "power_law", key: exponent, "lower": 0.05, "upper": 0.1}
        found.append(planned_grains(soft(bed={"diameter": sizes, "grain_count": 200, "width": [0.8, 1.0]})))
    assert (found[0], found[0].mean) == (found[1], pytest.approx(2.0 / 30.0, rel=1e-6))
    assert (found[0].smallest, found[0].largest, found[0].count_per_m2) == (0.05, 0.1, 250.0)
    # N(>D) = (D^-2 - 100) / (400 - 100) is 0.1 at D^-2 = 130.
    assert found[0].large == pytest.approx(130.0**-0.5, rel=1e-12)
    assert found[0].line() == (
        "Grains: 0.05 to 0.1 m in diameter, mean 0.0667 m; 250 per m2 of bed, of which 25 are larger than 0.0877 m."
    )
    assert planned_grains(soft()) is None


def test_the_plan_says_how_many_boulders_a_bed_has() -> None:
    """Discs of 0.2 m on a tenth of 1 m2 are 3.18."""
    rocks = {"diameter": {"distribution": "constant", "value": 0.2}, "coverage": 0.1}
    found = planned_boulders(soft(bed={"boulders": rocks, "width": [1.0, 1.0]}))
    assert found.line() == (
        "Boulders: 3.18 in a bed in the mean, 0.2 m in diameter, on 10 % of the ground; the largest of all beds is "
        "likely 0.2 m."
    )
    assert planned_boulders(soft()) is None


def test_the_plan_says_how_large_the_largest_boulder_likely_is() -> None:
    """Of N boulders half of all studies have none above D where N(>D) / N is 1 - 0.5^(1/N): here a power of -2."""
    sizes = {"distribution": "power_law", "cumulative_exponent": 2.0, "lower": 0.2, "upper": 2.0}
    study = soft(bed={"boulders": {"diameter": sizes, "coverage": 0.1}, "width": [9.5, 9.5], "bed_count": 7})
    found = planned_boulders(study)
    beyond = 1.0 - 0.5 ** (1.0 / (7.0 * found.count))
    square = 1.0 / (beyond * (0.2**-2 - 2.0**-2) + 2.0**-2)
    assert found.likely_largest == pytest.approx(square**0.5, rel=1e-9)
    assert 0.2 < found.likely_largest < 2.0


def test_the_plan_says_how_the_ground_of_the_first_touchdowns_lies() -> None:
    """Smooth ground slopes as the partner pulls; rough ground by what was asked for, as far as soil holds it."""
    smooth, rough = (planned_ground(DrawnDesign(with_site_gravity(journeys(angle)))) for angle in (0.0, 30.0))
    assert max(smooth.slope_deg) < 12.0
    assert smooth.steeper == 0.0
    # The median of a Rayleigh law whose rms is tan(30 deg).
    median = math.degrees(math.atan(math.tan(math.radians(30.0)) * math.sqrt(math.log(2.0))))
    assert (rough.slope_deg[0], rough.slope_deg[1]) == (pytest.approx(median, abs=4.0), pytest.approx(35.0))
    assert 0.1 < rough.steeper < 0.5
    assert "with a roughness of 30 deg rms; " in rough.line()
    assert smooth.line().startswith("First touchdowns: ")
    assert planned_ground(DrawnDesign(soft())) is None


def test_planning_makes_and_changes_nothing(tmp_path: Path) -> None:
    study, out = write_ball(tmp_path / "study.toml", FEW), tmp_path / "out"
    plan_study(study, out)
    assert [path.name for path in tmp_path.iterdir()] == ["study.toml"]
    run_study(StudySource.read(study), out, worker_count=1, until="screen")

    def everything() -> dict[Path, tuple[int, bytes]]:
        return {path: (path.stat().st_mtime_ns, path.read_bytes()) for path in out.rglob("*") if path.is_file()}

    before = everything()
    plan_study(study, out)
    assert everything() == before


def test_a_folder_that_a_run_refuses_is_refused_by_its_plan(tmp_path: Path) -> None:
    study, out = write_ball(tmp_path / "study.toml", FEW), tmp_path / "out"
    out.mkdir()
    (out / "thesis.tex").touch()
    with pytest.raises(ValueError, match=r"holds thesis\.tex, and no study made it; choose another folder"):
        plan_study(study, out)


def test_journeys_that_go_on_are_to_be_made_as_those_that_have_not_begun(tmp_path: Path) -> None:
    """Of nine one has failed, one has ended at rest, one aloft; four go on after one touchdown, two have none."""
    few = with_keys(load_tables(SCENARIOS / "one_ground.toml"), {"journey": {"count": 9}, "bed": {"bed_count": 9}})
    study = with_site_gravity(check_tables(few, SCENARIOS))
    design, folder = DrawnDesign(study), StudyFolder.only_read(tmp_path)
    later = [(f"later {one}", {**design.rows[one], "touchdown": 1.0, "impact.speed": 0.01}, 1, 0) for one in range(4)]
    with Ledger(tmp_path / "runs.sqlite") as ledger:
        ledger.queue([(key, row, 1, 0) for key, row in zip(design.keys, design.rows, strict=True)], version="")
        for number, key in enumerate(design.keys[:7]):
            ended = {"status": "done", "outcome": "captured" if number == 4 else "clear", "outputs": {}, "attempts": 1}
            ledger.finish(key, ended if number < 6 else {"status": "failed", "reason": "of a test", "attempts": 9})
        ledger.queue(later, version="", adds=True)
    plan = plan_for(study, folder, 1)
    assert plan.made["journeys to rest"] == (6, 6)
    assert ", 6 journeys to rest" in plan_lines(plan)[1]
    assert "touchdowns each; 7 first touchdowns are known" in "\n".join(plan_lines(plan))


def test_the_command_says_what_is_planned(tmp_path: Path) -> None:
    study, out = write_ball(tmp_path / "study.toml", FEW), tmp_path / "out"
    said = CliRunner().invoke(app, ["plan", str(study), "--out", str(out), "--workers", "1"])
    assert said.exit_code == 0, said.output
    assert "To make: 17 to 47 touchdowns, 10 000 samples, up to 50 flights, 200 journeys" in said.stdout
    assert "on 1 process, and the touchdowns, whose time is not known before some have been made" in said.stdout
    content = json.loads(CliRunner().invoke(app, ["plan", str(study), "--out", str(out), "--json"]).stdout)
    assert [one["total"] for one in content["runs"]] == [17, 47]
    assert content["seconds"]["touchdowns"] is None
    assert content["warnings"] == list(plan_study(study, out).warnings)


def test_a_run_begins_with_its_plan_in_three_lines(tmp_path: Path) -> None:
    study, said = write_ball(tmp_path / "study.toml", FEW), list[str]()

    class Begun(Exception):
        """The first stage."""

    class Shown(Silent):
        def begin(self, title: str, number: int, count: int) -> None:
            raise Begun

        def say(self, sentence: str) -> None:
            said.append(sentence)

    with pytest.raises(Begun):
        run_study(StudySource.read(study), tmp_path / "out", worker_count=1, shown=Shown())
    program, *plan = said
    assert program.startswith("This study names a program")
    assert len(plan) == 3
    assert plan[0].startswith("To make: 17 to 47 touchdowns")
    assert plan[1].startswith("Expected: about ")
    assert plan[2].startswith("2 warnings, the first: At the site gravity")
    assert plan[2].endswith(f"lithobrake plan {study} --out {tmp_path / 'out'}")


@pytest.mark.parametrize(("changes", "said"), [
    ({"speed = 0.15": "speed = 0"}, "impact.speed is 0; allowed: above 0 and at most 1000 [m/s]"),
    ({"mass = 1.0": "mas = 1.0"}, "lander.mas is not a known key; did you mean mass?"),
    ({"[flight]": '[site]\nbody = "open.obj"\nmass = 1e11\nspin_period = 8e3\n[flight]'}, "open.obj"),
])  # fmt: skip
def test_what_a_run_refuses_a_plan_refuses_in_its_words(changes: dict[str, str], said: str, tmp_path: Path) -> None:
    (tmp_path / "open.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 2 3 4\n")
    study = str(write_ball(tmp_path / "study.toml", FEW | changes))
    plan, run = (
        CliRunner().invoke(app, [word, study, "--out", str(tmp_path / word)]) for word in ("plan", "run")
    )  # fmt: skip
    assert (plan.exit_code, run.exit_code) == (2, 2)
    assert said in plan.stderr
    assert plan.stderr.strip() == run.stderr.strip()
    assert not (tmp_path / "plan").exists()


@pytest.mark.parametrize(("changes", "said"), [
    ({"site": {"latitude_deg": 0.0}}, "push outward"),
    ({"site": {"latitude_deg": 80.0}}, "surface.gravity is 5e-05 m/s2 inward, but gravity and rotation"),
    ({"bed": {"width": [0.55, 0.55], "grain_count": 30}}, "to avoid boundary reflections during the first impact"),
    ({"impact": {"place": {"x": -0.25}}}, "keep impact.place.x within 0.22 m"),
    ({"landing": {"time_limit": 1.0}}, "100 % of the touchdowns may last longer than landing.time_limit, 1 s"),
    ({"lander": {"restitution": 0.95}}, 'lander.restitution has no effect: contact.pair_rule = "smaller"'),
    ({"grain": {"young_modulus": {"distribution": "uniform", "lower": 1e5, "upper": 1e8}}},
     "grain.young_modulus is uniform from 100000 to 1e+08: 90 % of its values are above 1e+07"),
    ({"expansion": {"screening_level": 1, "screening_degree": 1, "screening_count": None}}, None),
    ({"expansion": {"screening_level": 2, "screening_degree": 3}}, "The screening fits 56 terms to 61 runs"),
    ({"bed": {"bed_count": 1}}, "All runs land at the same point of the same bed"),
])  # fmt: skip
def test_what_an_analyst_should_know_is_said(changes: dict[str, Any], said: str | None) -> None:
    kept = {name: {key: value for key, value in keys.items() if value is not None} for name, keys in changes.items()}
    study = soft(**kept)
    found = " ".join(study_warnings(DrawnDesign(study), soil_of(study)))
    assert said in found if said else "The screening fits" not in found


SEQUENCE = {"run_count": 144}


def drawn(*, design: dict[str, Any] | None = None, **changes: dict[str, Any]) -> Study:
    """The quick study with its runs out of the sequence, at places that are drawn unless the impact is changed."""
    tables = load_tables(SCENARIOS / "first_bounce.toml")
    tables["design"] = SEQUENCE | (design or {})
    tables["impact"] = {key: value for key, value in tables["impact"].items() if key != "place"}
    region = {"impact": {"region": {"x": [-0.1, 0.1], "y": [-0.1, 0.1]}}}
    return check_tables(with_keys(tables, region | changes), SCENARIOS)


@pytest.mark.parametrize(("changes", "said"), [
    ({}, None),
    ({"bed": {"bed_count": 1}}, "All runs land on one bed, and another bed would change the result"),
    # Student's t of 4, 7 and 11 degrees of freedom at 0.95: 2.132, 1.895 and 1.796.
    ({"bed": {"bed_count": 5}}, "on 5 beds, and the bed is the unit of an interval: so few make it 19 % wider"),
    ({"design": {"run_count": 8}}, "on 8 beds, and the bed is the unit of an interval: so few make it 5 % wider"),
    (
        {"impact": {"place": {"x": 0.0, "y": 0.1}}},
        "All runs land at the same point of their beds: give impact.region",
    ),
])  # fmt: skip
def test_a_sequence_on_few_beds_or_at_one_place_is_warned_of(changes: dict[str, Any], said: str | None) -> None:
    study = drawn(**changes)
    found = " ".join(study_warnings(DrawnDesign(study), soil_of(study)))
    assert said in found if said else "All runs" not in found and "the unit of an interval" not in found


def test_landings_that_will_leave_the_bed_laterally_are_warned_of_by_their_angle(tmp_path: Path) -> None:
    slanted = {"distribution": "uniform", "lower": 0.0, "upper": 88.0}
    steep, flat, wide = (
        drawn(impact={"incidence_deg": angle}, bed={"width": [w, w], "sides": "walls"})
        for angle, w in ((15.0, 0.7), (slanted, 0.7), (slanted, 3.0))
    )
    words = "may leave the bed laterally"
    assert words not in " ".join(study_warnings(DrawnDesign(steep), soil_of(steep)))
    assert words in " ".join(study_warnings(DrawnDesign(flat), soil_of(flat)))
    # 22 % of 300 landings of a study of first bounces over 0 to 88 deg, which this one is like.
    losses = [expected_loss(soil_of(one).landings[1:], min(one.bed.width)) for one in (steep, flat, wide)]
    assert losses == [pytest.approx(1 / 64), pytest.approx(0.22, abs=0.04), pytest.approx(0.07, abs=0.02)]


def test_the_smallest_tile_of_ground_that_repeats_is_said(tmp_path: Path) -> None:
    study = drawn()
    # The diagonal of the lander, 0.267 m, and 3.2 grains of 0.09 m; no study is accepted on a narrower tile.
    least = math.sqrt(0.1**2 + 0.1**2 + 0.227**2) + 3.2 * 0.09
    plan = plan_for(study, StudyFolder.only_read(tmp_path / "out"), 2)
    assert (plan.tile.width, plan.tile.smallest) == ((0.56, 0.56), pytest.approx(least))
    assert "the smallest tile for this lander and these grains is 0.556 m." in " ".join(plan_lines(plan))
    drawn(bed={"width": [least + 1e-9, least + 1e-9], "grain_count": 95})
    with pytest.raises(StudyError, match=r"bed.width is 0\.55.* at least 0\.555 m"):
        drawn(bed={"width": [least - 1e-3, least - 1e-3], "grain_count": 95})
    assert planned_tile(drawn(bed={"sides": "walls", "width": [0.7, 0.7]})) is None
    assert planned_tile(soft()) is None


def test_ground_that_repeats_loses_no_landing_and_is_warned_of_its_images() -> None:
    flat = {"distribution": "uniform", "lower": 0.0, "upper": 88.0}
    studies = (drawn(impact={"incidence_deg": flat}, bed={"grain_count": count}) for count in (150, 20))
    said = [" ".join(study_warnings(DrawnDesign(one), soil_of(one))) for one in studies]
    assert not any("laterally" in one or "over the edge" in one for one in said)
    assert "images" not in said[0]
    assert "to avoid reflections and waves of the lander's own images" in said[1]


def test_beds_of_folder_and_library_are_not_to_be_poured(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    study, kept = drawn(), set[int]()

    def is_stored(recipe: Any) -> bool:
        return any(recipe.seed == pour_seed(study, index) for index in kept)

    monkeypatch.setattr("lithobrake.touchdown.is_stored", is_stored)
    folder = StudyFolder(tmp_path / "out")
    plans = [plan_for(study, folder, 2)]
    kept |= {0, 1, 2, 3, 4}
    (folder.path / "beds").mkdir()
    (folder / "beds/bed_7.h5").touch()
    folder.note("bed", ["beds/bed_7.h5"], stage_keys(study)["bed"], 1.0)
    plans.append(plan_for(study, folder, 2))
    assert [(plan.beds[0].total, plan.beds[0].new) for plan in plans] == [(12, 12), (12, 6)]
    assert "Beds: 12; 1 in the folder, 5 in the library of beds, 6 to pour." in plan_lines(plans[1])
    assert "Site: gravity and rotation together eject objects that rest on the ground." in plan_lines(plans[1])
    level = "Site: the ground slopes by 12 deg against gravity and rotation together."
    assert level in plan_lines(replace(plans[1], site_slope_deg=12.3))
    assert plans[1].made["beds"] == (6, 6)
    assert plans[1].to_json()["beds"] == [{"total": 12, "in_folder": 1, "in_library": 5, "new": 6}]
    # Two at once: six rounds, then three.
    times = [plan.seconds["beds"] for plan in plans]
    assert times[1][0] / times[0][0] == pytest.approx(3 / 6)
    # Where nobody knows how fast the workers are.
    cluster = plan_for(study, folder, None, on_cluster=True)
    assert "and the beds and touchdowns, whose time is not known on a cluster" in brief_lines(cluster, "")[1]


def half_of_all_alike(beds: int, runs: int, correlation: float = 0.5) -> float:
    """Half the interval where all runs of all beds end alike, each bed beta-binomial: all do with a chance of 10 %."""
    size, number = 1.0 / correlation - 1.0, np.arange(runs)

    def chance(fraction: float) -> float:
        return float(np.prod((fraction * size + number) / (size + number))) ** beds

    return 0.5 * (1.0 - brentq(lambda fraction: chance(fraction) - 0.1, 0.1, 1.0 - 1e-9))


def test_a_plan_says_the_half_width_to_expect_and_what_that_stands_on(tmp_path: Path) -> None:
    folder = StudyFolder.only_read(tmp_path / "out")
    plan = plan_for(drawn(bed={"bed_count": 12}), folder, 2)
    found = plan.half_width
    # t(11) at 0.95 is 1.796; sd sqrt(rho / 12 + (1 - rho) / 144) with rho 0 and sd 0.04, rho 0.2 and sd 0.21.
    least, most = 1.796 * 0.04 * (1 / 144) ** 0.5, 1.796 * 0.21 * (0.2 / 12 + 0.8 / 144) ** 0.5
    assert least < found.lower < found.median < found.upper < most
    said = " ".join(plan_lines(plan))
    assert "90 % interval of the return fraction (144 runs on 12 beds): " in said
    assert f"By the resulting fraction: {100.0 * half_of_all_alike(12, 12):.2g} at 100 %." in said
    assert "standard deviation 0.04 to 0.21 of the return fraction from landing to landing; mean correlation" in said
    assert plan.to_json()["half_width"]["own_run_count"] == 0
    assert plan_for(drawn(bed={"bed_count": 1}), folder, 2).half_width is None
    assert plan_for(soft(), folder, 2).half_width is None


def test_journeys_are_promised_a_half_width_for_each_fraction_at_rest(tmp_path: Path) -> None:
    plan = plan_for(
        with_site_gravity(read_study(SCENARIOS / "one_ground.toml")), StudyFolder.only_read(tmp_path / "out"), 2
    )
    found, beds = plan.half_width, plan.runs_a_bed
    assert list(found.by_fraction) == ["100 %", "95 %", "80 %", "50 %"]
    # Half of them at rest: t(23) at 0.95 is 1.714.
    assert found.by_fraction["100 %"] == pytest.approx(half_of_all_alike(24, 4))
    assert 1.714 * (0.25 / 96) ** 0.5 < found.by_fraction["50 %"] < 1.714 * (0.25 * (0.1 / 24 + 0.9 / 96)) ** 0.5
    assert found.lower <= found.by_fraction["100 %"] < found.by_fraction["50 %"] < found.upper
    assert (beds.runs, beds.count, beds.correlation) == (("journey", "journeys"), 4.0, 0.07)
    assert 0.2 < beds.bed_cost < 0.8


def test_landings_that_leave_the_bed_widen_what_is_promised(tmp_path: Path) -> None:
    folder = StudyFolder.only_read(tmp_path / "out")
    flat = {"distribution": "uniform", "lower": 0.0, "upper": 88.0}
    walls, tile = (
        plan_for(drawn(bed={"width": [0.7, 0.7], "sides": sides}, impact={"incidence_deg": flat}), folder, 2).half_width
        for sides in ("walls", "periodic")
    )
    # Nobody knows what became of them: half of them is added on either side.
    assert walls.missing == pytest.approx(0.22, abs=0.04)
    assert walls.lower > tile.lower + 0.3 * walls.missing
    assert tile.missing == 0.0


def test_a_plan_says_how_many_runs_a_bed_are_best(tmp_path: Path) -> None:
    folder = StudyFolder.only_read(tmp_path / "out")
    plans = (plan_for(drawn(design={"run_count": 600}, bed=bed), folder, 2) for bed in ({}, {"bed_count": 300}))
    default, many = (plan.runs_a_bed for plan in plans)
    assert (default.count, many.count) == (20.0, 2.0)
    best = math.sqrt(many.bed_cost * 0.98 / 0.02)
    assert default.best == many.best == pytest.approx(best)
    # Cost of a run with its part of a bed, times variance: 1 at the best.
    loss = [(1.0 + many.bed_cost / one) * (1.0 + 0.02 * (one - 1.0)) for one in (2.0, best)]
    assert many.over_best == pytest.approx(loss[0] / loss[1] - 1.0)
    assert "bed.bed_count changes it" in many.line()
    assert plan_for(soft(), folder, 2).runs_a_bed is None


def test_a_half_width_that_is_asked_for_may_take_runs_and_beds_up_to_the_most(tmp_path: Path) -> None:
    study = drawn(design={"half_width": 0.02, "largest_run_count": 400})
    plan = plan_for(study, StudyFolder.only_read(tmp_path / "out"), 2)
    assert (plan.made["touchdowns"], plan.made["beds"]) == ((144, 400), (12, 20))
    assert "Touchdowns: 144 to 400 drawn, until design.half_width is met;" in " ".join(plan_lines(plan))


MEASURED_STUDIES = {name: SCENARIOS / f"{name}.toml" for name in ("first_bounce", "paper")} | {
    "drawn_700": HERE / "validation" / "studies" / "drawn_700.toml"
}


@pytest.mark.parametrize("name", MEASURED_STUDIES)
def test_beds_and_landings_are_expected_to_take_what_they_took(name: str) -> None:
    measured = json.loads((HERE / "benchmarks" / "plan_estimate.json").read_text())[name]["result"]
    pace = np.mean(measured["paces"])
    soil = soil_of(with_site_gravity(read_study(MEASURED_STUDIES[name])))
    assert 1.0 / SPREAD < pace * pour_time(soil) / measured["pour"]["cpu_s"] < SPREAD
    for one in measured["landings"]:
        contact = {"held_speed": one["held_speed"]}
        ways = [(lander, replace(event, contact=replace(event.contact, **contact))) for lander, event in soil.landings]
        expected = pace * np.mean([landing_time(soil, *way) for way in ways[1:]])
        assert 1.0 / SPREAD_OF_TOUCHDOWNS < expected / one["cpu_s"] < SPREAD_OF_TOUCHDOWNS


def test_a_disk_that_is_too_small_is_the_first_warning(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    room = shutil.disk_usage(tmp_path)
    monkeypatch.setattr(shutil, "disk_usage", lambda place: room._replace(free=2_000_000))
    plan = plan_study(write_ball(tmp_path / "study.toml", FEW), tmp_path / "not" / "yet")
    assert plan.warnings[0].startswith("The files will take about ")
    assert "only 2 MB are free" in plan.warnings[0]


# A ball near 50 degrees north of Didymos, over all impacts to come.
EVERY_IMPACT = """
lander = { shape = "sphere", diameter = 0.14, mass = 0.3, restitution = 0.9 }
surface = { gravity = 1e-4 }
contact = { pair_rule = "mean" }
design = { run_count = 144 }
journey = { touchdowns = 1 }
site = { latitude_deg = 50.0, heading_deg = 90.0 }
[bed]
grain_count = 110
width = [0.7, 0.7]
diameter = { distribution = "constant", value = 0.08 }
cloud_point_count = 10
pour_gravity = 0.1
[grain]
density = 2500.0
young_modulus = 1e6
poisson_ratio = 0.25
restitution = { distribution = "uniform", lower = 0.3, upper = 0.8 }
friction = 0.6
[impact]
speed = { distribution = "uniform", lower = 0.005, upper = 0.4 }
incidence_deg = { distribution = "uniform", lower = 0.0, upper = 88.0 }
"""


def test_a_study_that_has_all_it_needs_is_warned_of_the_edge_of_its_beds_alone() -> None:
    tables = tomllib.loads(EVERY_IMPACT)
    repeating, walled = (check_tables(with_keys(tables, {"bed": bed}), HERE) for bed in ({}, {"sides": "walls"}))
    assert study_warnings(DrawnDesign(repeating), soil_of(repeating)) == []
    (lost,) = study_warnings(DrawnDesign(walled), soil_of(walled))
    assert lost.startswith("About 13 % of the landings may leave the bed laterally")


def test_a_touchdown_is_expected_to_take_the_steps_of_its_contacts() -> None:
    soil = soil_of(soft(grain={"young_modulus": 1e6}))
    lander, landing = soil.landings[0]
    stiff = replace(landing, grain=replace(landing.grain, young_modulus=1e8))
    stiff_lander = replace(lander, material=replace(lander.material, young_modulus=1e8))
    # Hertz (1882): the time of a contact goes with the modulus to the power of -2/5, and with speed to that of -1/5.
    ratio = soil.landing_steps(stiff_lander, stiff) / soil.landing_steps(lander, landing)
    assert ratio == pytest.approx(100.0**0.4, rel=1e-9)
    slow = replace(landing, speed=0.5 * landing.speed)
    ratio = soil.landing_steps(lander, slow) / soil.landing_steps(lander, landing)
    assert ratio == pytest.approx(2.0 * 2.0**-0.2, rel=1e-9)
    brief = replace(landing, time_limit=0.5 * soil.touchdown_time(lander, landing))
    assert soil.landing_steps(lander, brief) == pytest.approx(0.5 * soil.landing_steps(lander, landing))


def test_a_bed_is_expected_as_deep_as_its_grains_fill_it() -> None:
    # 150 grains of 0.09 m as spheres of equal volume, three fifths of what they fill.
    depth = 150 * np.pi / 6.0 * 0.09**3 / 0.6 / 0.7**2
    assert soil_of(soft()).depth == pytest.approx(depth, rel=1e-9)
    assert soil_of(soft(bed={"grain_count": 300})).pour_steps() > soil_of(soft()).pour_steps()


def record(wall_s: float) -> Record:
    empty: dict[str, float] = {}
    return Record("", RunStatus.DONE, "clear", empty, empty, {}, 0, 0, 1, None, wall_s, wall_s, None, "", None, None)


def test_other_work_on_the_cores_raises_upper_ends(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder, cores = StudyFolder.only_read(tmp_path / "out"), available_cores()
    idle = plan_for(soft(), folder, 1)
    monkeypatch.setattr(expected_time, "_load", lambda: 3.0 * cores)
    busy = plan_for(soft(), folder, 1)
    for what, span in idle.seconds.items():
        assert busy.seconds[what] == pytest.approx((span[0], 4.0 * span[1]))
    assert "everything takes up to 4.0 times as long" in busy.basis
    assert "Other work" not in idle.basis


def test_runs_that_have_ended_tell_how_long_the_others_take() -> None:
    assert run_time([], [record(2.0)] * 4, 1.0) is None
    lower, upper = run_time([], [record(2.0)] * 5, 1.0) or (0.0, 0.0)
    assert lower < 2.0 < upper < 1.2 * 2.0
    # Five runs of 1 to 9 s have a mean of 5 s that is known to 2.8 s.
    wide = run_time([], [record(wall) for wall in (1.0, 3.0, 5.0, 7.0, 9.0)], 1.0) or (0.0, 0.0)
    assert wide == pytest.approx((5.0 / 1.5657, 5.0 * 1.5657), rel=1e-3)


def test_more_processes_than_cores_are_no_faster_and_a_cluster_has_no_known_time(tmp_path: Path) -> None:
    study, folder = soft(), StudyFolder.only_read(tmp_path / "out")
    cores = available_cores()

    def touchdowns(plan: Plan) -> Any:
        return plan.seconds["touchdowns"]

    one, all_cores, many = (plan_for(study, folder, count) for count in (1, cores, 8 * cores))
    assert touchdowns(one)[1] == pytest.approx(cores * touchdowns(all_cores)[1])
    assert touchdowns(many) == touchdowns(all_cores)
    cluster = plan_for(study, folder, None, on_cluster=True)
    assert touchdowns(cluster) is None
    assert "whose time is not known on a cluster" in brief_lines(cluster, "")[1]


def test_without_a_compiled_engine_the_pace_is_that_of_the_reference_machine(tmp_path: Path) -> None:
    code = "from lithobrake.pipeline.planning.expected_time import machine_pace; print(machine_pace())"
    environment = os.environ | {"LITHOBRAKE_CACHE": str(tmp_path)}
    shown = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, env=environment)
    assert shown.stdout.strip() == "None"
    assert list(tmp_path.rglob("*.nbi")) == []


def test_the_samples_take_the_room_that_is_expected(tmp_path: Path) -> None:
    study = read_study(BALL)
    names, count = list(DrawnDesign(study).inputs), study.monte_carlo.sample_count
    inputs, outputs = np.zeros((count, len(names))), np.zeros((count, len(OUTPUTS)))
    Samples(names, list(OUTPUTS), inputs, outputs, np.zeros(count, dtype=np.uint8)).save(StudyFolder(tmp_path))
    expected = expected_bytes(DrawnDesign(study), PlannedRuns(4, 41, 96, 20, frozenset()), None)["samples"]
    # Names and the layout of the file come on top.
    assert 0.0 < (tmp_path / "samples.h5").stat().st_size - expected < 2e4


@pytest.mark.parametrize(
    ("down", "words"), [([True, False, False], ["Only 1 of 3 landers"]), ([True, True, False], [])]
)
def test_a_delivery_that_mostly_misses_the_ground_is_a_warning(down: list[bool], words: list[str]) -> None:
    found = list(_missed(SimpleNamespace(descents=SimpleNamespace(touches_down=np.array(down)))))
    assert len(found) == len(words)
    assert all(word in one for one, word in zip(found, words, strict=True))
