"""A requirement against a law in closed form, its deliveries, its corners by landings, its files and its refusals."""

import csv
from copy import deepcopy
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from lithobrake.analysis.paired_differences import difference_bounds
from lithobrake.cli import app
from lithobrake.pipeline import delivery_grid, find_requirement, grid_of_ranges, requirement_lines, write_requirement
from lithobrake.pipeline.answer.emulated_ends import Refits
from lithobrake.pipeline.commands import emulator_job
from lithobrake.pipeline.delivery_grid import (
    Asked,
    GridLanders,
    required_deliveries,
    requirement_edges,
    simulate_corners,
)
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.journeys.delivery_options import option_landers
from lithobrake.pipeline.runs.solver import function_identity
from lithobrake.pipeline.site import with_site_gravity
from lithobrake.report.figures.requirement_figure import requirement_figure
from lithobrake.results.requirement_results import Requirement
from lithobrake.study import StudySource
from lithobrake.vocabulary.estimate import LEVEL
from lithobrake.vocabulary.limit_state import LimitState
from lithobrake.vocabulary.quantities import ERRORS
from lithobrake.vocabulary.requirement import Verdict

from ..few_terms import REFITS
from ..journeys.test_release_options import study_of
from .resting_lander import NEAR, SIGMA, admissible_errors, rest, resting_tables

SPEED = "delivery.speed"
GRID = {ERRORS: tuple(np.linspace(0.5, 1.5, 11).tolist()), SPEED: (0.045, 0.055, 0.065)}
LANDERS = 20 * REFITS


@pytest.fixture(scope="module")
def source(tmp_path_factory: pytest.TempPathFactory) -> StudySource:
    return StudySource.of_tables(resting_tables(tmp_path_factory.mktemp("ball")), function_identity(rest))


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("requirement") / "study"


@pytest.fixture(scope="module")
def found(source: StudySource, folder: Path) -> Requirement:
    return find_requirement(
        source, folder, "near", GRID, lander_count=LANDERS, simulated_count=24, worker_count=1, model=rest
    )


def test_landers_that_rest_at_once_have_the_edge_of_their_errors(found: Requirement) -> None:
    """P(distance < R) = 1 - exp(-R2 / 2 s2), so 0.9 needs errors of at most R / sqrt(2 ln 10) = 0.93 times 15 m."""
    truth = admissible_errors(0.9)
    assert truth == pytest.approx(0.932, abs=1e-3)
    own = [one.edge for one in found.edges if one.along == 0]
    assert len(own) == 3
    for edge in own:
        assert edge.falls
        assert edge.sure < truth < edge.possible
        assert edge.value == pytest.approx(truth, rel=0.06)
    for one in found.deliveries:
        chance = 1.0 - np.exp(-0.5 * (NEAR / SIGMA / one.values[0]) ** 2)
        assert one.probability.lower < chance < one.probability.upper
        assert one.probability.value == pytest.approx(chance, abs=0.04)
        # Nobody is told to meet it who does not, or not to who does.
        assert one.verdict is not (Verdict.NOT_MET if one.values[0] < truth else Verdict.MET)
    assert found.count(Verdict.MET) >= 9
    assert found.count(Verdict.NOT_MET) >= 9


def test_along_the_speed_every_value_is_admissible_or_none(found: Requirement) -> None:
    first, *_, last = [one.edge for one in found.edges if one.along == 1]
    assert np.isinf([first.value, first.sure, last.value, last.possible]).all()
    lines = requirement_lines(found)
    assert lines[0].startswith(f"{found.count(Verdict.MET)} of 33 deliveries meet near (distance < {NEAR}) with a prob")
    assert f"  {SPEED}: every value from 0.045 to 0.065 is admissible, where {ERRORS} is 0.5." in lines
    assert f"  {SPEED}: no value from 0.045 to 0.065 is admissible, where {ERRORS} is 1.5." in lines


def test_corners_lie_farthest_out_and_landings_agree(found: Requirement) -> None:
    largest = max(one.values[0] for one in found.deliveries if one.verdict is Verdict.MET)
    corners = [found.deliveries[one].values for one in found.corners]
    assert set(corners) == {(0.5, 0.045), (0.5, 0.065), (largest, 0.045), (largest, 0.065)}
    assert [one.values for one in found.simulated] == corners
    for one in found.simulated:
        assert one.journeys == 24
        assert one.landings.value > 0.85
        assert one.landings.level == one.emulator.level == LEVEL
        assert one.agrees


def test_landings_at_a_corner_are_compared_with_the_mean_of_the_emulator_over_beds(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A quarter of the landings on every bed meet it, and by the emulator three quarters: at 90 % these disagree.

    The interval of one ground, at the 99.9 % of the requirement, would hold the difference.
    """
    emulated, fitted = half_of_beds()
    landings = (np.arange(48) % 4 == 0).astype(float)
    beds, nothing = np.arange(48) // 4, np.full((1, 48), "")
    corner = GridLanders(landings[None], beds[None], beds[None], np.ones((1, 48), dtype=bool), nothing)
    delivered = SimpleNamespace(begin=SimpleNamespace(rows=range(48)))
    monkeypatch.setattr(delivery_grid, "option_landers", lambda *_: delivered)
    for name in ("WithLandings", "followed", "why_no_interval"):
        monkeypatch.setattr(delivery_grid, name, lambda *_: None)
    monkeypatch.setattr(GridLanders, "of", lambda *_: corner)
    job = SimpleNamespace(design=None, study=SimpleNamespace(ground=SimpleNamespace(unknown="everywhere")))
    asked = Asked(LimitState.of("distance < 30"), 0.5, 0.999, {ERRORS: (1.0,)})
    (one,) = simulate_corners(job, asked, emulated, fitted, [0], 48)
    assert (one.values, one.journeys) == ((1.0,), 48)
    assert (one.landings.value, one.emulator.value) == pytest.approx((0.25, 0.75))
    assert one.landings.level == one.emulator.level == LEVEL
    assert one.emulator.upper - one.emulator.lower < 0.25
    assert one.agrees is False
    of_one_ground = emulated.probability(0, fitted, asked.level, one_ground=True)
    least, most = difference_bounds(one.landings, of_one_ground)
    assert least < 0.0 < most


def test_deliveries_differ_by_what_is_chosen_alone(source: StudySource) -> None:
    """The errors of a lander are so many times its own, about their median; all else is the same."""
    design = DrawnDesign(with_site_gravity(source.study))
    begin = option_landers(design, [{ERRORS: 1.0}, {ERRORS: 2.0}, {ERRORS: 0.0, SPEED: 0.05}], 40).begin
    error, speed = begin.site["north_error"].reshape(3, 40), begin.column("impact.speed").reshape(3, 40)
    assert np.unique(error[0]).size == 40
    assert error[1] == pytest.approx(2.0 * error[0])
    assert (error[2] == 0.0).all()
    assert (speed[0] == speed[1]).all()
    assert (speed[2] == 0.05).all()
    assert (begin.site["heading_deg"].reshape(3, 40) == begin.site["heading_deg"][:40]).all()


@pytest.mark.parametrize("spread", [
    {"position_std": (3.0, 2.0, 1.0), "velocity_std": (0.001, 0.001, 0.001)},
    {"covariance": (np.diag([9.0, 4.0, 4.0, 1e-6, 1e-6, 1e-6]) + 1e-4 * (np.eye(6, k=3) + np.eye(6, k=-3))).tolist()},
])  # fmt: skip
def test_the_errors_of_a_release_are_one_input(spread: dict[str, Any]) -> None:
    """A factor moves every lander along its own error of position and velocity, however these are correlated."""
    study = study_of()
    release = {"position": study.delivery.release.position, "velocity": study.delivery.release.velocity, **spread}
    study = study_of(release=deepcopy(release))
    starts = []
    for factor in (0.0, 1.0, 2.5):
        own = study.delivery.model_copy(update={"release": study.delivery.release.with_errors(factor)})
        design = DrawnDesign(study.model_copy(update={"delivery": own}))
        start = design.flown_landers(0, 12)[0].flights.start
        starts.append(np.hstack([start.position, start.velocity]))
    assert np.ptp(starts[0], axis=0).max() < 1e-9
    assert starts[2] - starts[0] == pytest.approx(2.5 * (starts[1] - starts[0]), rel=1e-6, abs=1e-9)


def test_a_requirement_is_written_as_tables_and_picture(found: Requirement, tmp_path: Path) -> None:
    table, edges, picture, corners = write_requirement(found, tmp_path)
    with table.open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 33
    for row, one in zip(rows, found.deliveries, strict=True):
        assert (float(row[ERRORS]), float(row[f"{SPEED} [m/s]"])) == pytest.approx(one.values)
        assert (float(row["lower"]), row["verdict"]) == (one.probability.lower, one.verdict.value)
    with edges.open(encoding="utf-8") as file:
        lines = list(csv.DictReader(file))
    assert len(lines) == 3 + 11
    assert (lines[0]["along"], lines[0][ERRORS], lines[0]["admissible"]) == (ERRORS, "", "up to")
    assert float(lines[0]["edge"]) == found.edges[0].edge.value
    assert picture.stat().st_size > 1000
    assert len(corners.read_text(encoding="utf-8").splitlines()) == 1 + len(found.corners)
    # Of another requirement, none of whose corners are simulated, these say nothing.
    assert write_requirement(replace(found, simulated=()), tmp_path) == (table, edges, picture)
    assert not corners.exists()


def test_the_picture_has_a_cell_for_each_delivery_and_the_edge_with_both_ends(found: Requirement) -> None:
    (axes,) = requirement_figure(found).axes
    assert len(axes.patches) == 33
    assert len(axes.collections) == 3
    crossing = [one.get_paths()[0].vertices[:, 0].mean() for one in axes.collections]
    edge = found.edges[0].edge
    assert crossing == pytest.approx([edge.value, edge.sure, edge.possible], abs=1e-3)


def test_deliveries_whose_impacts_are_beyond_the_training_range_have_no_result() -> None:
    """Of 100 landers eleven, ten and none are of unknown outcome, and all others meet it: bounds hold for all."""
    met, beyond = np.ones((3, 100)), np.full((3, 100), "", dtype="<U24")
    met[0, :11], met[1, :10], beyond[0, :11], beyond[1, :10] = np.nan, np.nan, "surface.gravity", "impact.speed"
    refit = np.tile(np.arange(100) % REFITS, (3, 1))
    landers = GridLanders(met, refit % 12, refit, np.ones_like(refit, dtype=bool), beyond)
    asked = Asked(LimitState.of("distance < 30"), 0.9, 0.9, {ERRORS: (1.0, 2.0, 3.0)})
    fitted, job = Refits(12, tuple([20] * 12), None), SimpleNamespace(study=SimpleNamespace(ground=None))
    first, second, third = required_deliveries(job, asked, landers, fitted)
    assert (first.verdict, first.beyond, first.unknown) == (Verdict.OUTSIDE, "gravity", 0.11)
    # Nine in ten at least, and that with an error.
    assert (second.verdict, second.beyond) == (Verdict.OPEN, "impact speed")
    assert second.probability.lower < 0.9
    assert (third.verdict, third.beyond) == (Verdict.MET, "")
    edge = requirement_edges(asked, [first, second, third])[0].edge
    # The first value tells nothing of it.
    assert not edge.falls
    assert 2.0 < edge.sure <= 3.0


def half_of_beds() -> tuple[GridLanders, Refits]:
    """Landers of one delivery: on half of the beds all of them meet it, and on the others half do."""
    refit, bed = np.random.default_rng(6).permutation(960) % REFITS, np.arange(960) // 40
    met = np.where(bed % 2 == 0, 1.0, np.arange(960) % 2)
    landers = GridLanders(met[None], bed[None], refit[None], np.ones((1, 960), dtype=bool), np.full((1, 960), ""))
    return landers, Refits(24, tuple([20] * 24), None)


def test_on_unknown_ground_a_probability_is_that_of_one_ground() -> None:
    """One ground may have either share, whatever the mean over them is."""
    landers, fitted = half_of_beds()
    mean, one = (landers.probability(0, fitted, 0.9, one_ground=flag) for flag in (False, True))
    assert mean.value == one.value == pytest.approx(0.75)
    assert mean.upper - mean.lower < 0.25
    assert one.lower < 0.5
    assert one.upper > 0.99


@pytest.mark.parametrize(("asked", "said"), [
    ({"name": "far"}, r"NAME is 'far'; allowed: a name of \[limit_states\] \(near, fast, upright\); add it there"),
    ({"name": "fast"}, r"limit_states\.fast is of first touchdowns; allowed: one of whole journeys"),
    ({"name": "upright"}, r"limit_states\.upright uses face, which the emulator does not know"),
    ({"probability": 1.0}, r"probability is 1; allowed: above 0 and below 1"),
    ({"confidence": 0.0}, r"confidence is 0; allowed: above 0 and below 1"),
    ({"grid": {}}, "0 delivery parameters are given; allowed: 1 to 3"),
    ({"grid": {"delivery.sped": (0.05, 0.06)}}, r"delivery\.sped is no aim; allowed: .* did you mean delivery\.speed"),
    ({"grid": {"delivery.offset_up": (0.0, 1.0)}}, r"delivery\.offset_up is no aim; allowed: delivery\.speed"),
    ({"grid": {SPEED: (0.06, 0.05)}}, r"delivery\.speed is \[0\.06, 0\.05\]; allowed: ascending values from 0\.04 to"),
    ({"grid": {SPEED: (0.05, 0.5)}}, r"allowed: ascending values from 0\.04 to 0\.08, which the runs reach over"),
    ({"grid": {SPEED: (0.05,)}}, r"delivery\.speed has one value; give two"),
    ({"grid": {ERRORS: (-1.0, 1.0)}}, r"delivery\.errors is \[-1, 1\]; allowed: ascending values from 0 to 100"),
    ({"grid": {ERRORS: tuple(np.linspace(0.1, 2.0, 501))}}, "the ranges make 501 deliveries; allowed: up to 500"),
    ({"lander_count": 2 * REFITS + 1}, r"--landers is 41; allowed: multiples of 20 from 40; take 1000"),
    ({"lander_count": 10_000 * REFITS}, r"makes 6600000 landers; allowed: up to 2000000"),
    ({"simulated_count": 3}, r"--check is 3; allowed: 0, or at least 12 journeys"),
    ({"probability": 0.99}, r"probability is 0\.99, and the journeys of .*, on 12 beds, can show at most 0\.911"),
])  # fmt: skip
def test_what_cannot_be_asked_is_refused(
    asked: dict[str, Any], said: str, found: Requirement, source: StudySource, folder: Path
) -> None:
    words = {"name": "near", "grid": GRID, "lander_count": 2 * REFITS, **asked}
    with pytest.raises(ValueError, match=said):
        find_requirement(source, folder, words.pop("name"), words.pop("grid"), worker_count=1, model=rest, **words)


@pytest.mark.parametrize(("changes", "said"), [
    ({"journey": {"touchdowns": 1}}, r"journey\.touchdowns is 1, and a requirement is on where landers come to rest"),
    ({"journey": {"emulated_count": 0}}, r"this study has none; set journey\.emulated_count above 0"),
    ({"delivery": {"north_error": 0.0, "east_error": 0.0}}, r"delivery\.errors is no aim; allowed: delivery\.speed"),
])  # fmt: skip
def test_studies_that_cannot_be_asked_are_refused(changes: dict[str, Any], said: str, tmp_path: Path) -> None:
    tables = resting_tables(tmp_path)
    # Conditions on journeys are refused by a study that does not follow them.
    tables["limit_states"] = (
        {"fast": "speed_out > 0.1"} if "touchdowns" in changes.get("journey", {}) else {"near": "distance < 30"}
    )
    for table, keys in changes.items():
        tables[table] = {**tables[table], **keys}
    source = StudySource.of_tables(tables, function_identity(rest))
    with pytest.raises(ValueError, match=said):
        find_requirement(source, tmp_path / "out", "near", GRID, model=rest)
    assert not (tmp_path / "out").exists()


def test_simulated_corners_need_landings_that_end_at_rest(tmp_path: Path) -> None:
    tables = resting_tables(tmp_path)
    tables["journey"] |= {"touchdowns": 4}
    source = StudySource.of_tables(tables, function_identity(rest))
    with pytest.raises(ValueError, match=r"--check is 24, and journey\.touchdowns = 4 ends landings before"):
        find_requirement(source, tmp_path / "out", "near", GRID, lander_count=LANDERS, simulated_count=24, model=rest)


@pytest.mark.parametrize(("unknown", "landers", "refused"), [
    ("everywhere", 2 * REFITS, True), ("everywhere", 3 * REFITS, False), ("patchy", 2 * REFITS, False),
])  # fmt: skip
def test_of_unknown_ground_more_landers_than_beds_are_asked(
    unknown: str, landers: int, refused: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of 40 landers on 40 beds each has one, and none tells grounds from chance: said before anything runs."""
    tables = resting_tables(tmp_path)
    gravel = {"weight": 1.0, "grain_size": {"distribution": "log_uniform", "lower": 0.08, "upper": 0.4}}
    tables |= {"ground": {"kind": {"gravel": gravel}, "unknown": unknown}, "bed": {"bed_count": 40}}
    source = StudySource.of_tables(tables, function_identity(rest))
    monkeypatch.setattr(emulator_job, "run_study", _runs)
    said = r"--landers is 40, and the study may have 40 beds of unknown ground; allowed: more .*; take 100"
    with pytest.raises(ValueError if refused else Ran, match=said if refused else None):
        find_requirement(source, tmp_path / "out", "near", GRID, lander_count=landers, model=rest)


class Ran(Exception):
    """The study would have run."""


def _runs(*_: Any, **__: Any) -> None:
    raise Ran


@pytest.mark.parametrize("text", [
    "delivery.speed", "delivery.speed=0.1", "delivery.speed=0.2:0.1", "delivery.speed=0.1:0.1", "delivery.speed=a:b",
    "delivery.speed=0.1:0.2:1", "delivery.speed=0.1:0.2:3:4", "delivery.speed=0.1:inf", "delivery.speed=0.1:0.2:x",
])  # fmt: skip
def test_a_range_is_two_ascending_numbers_and_a_count(text: str) -> None:
    with pytest.raises(ValueError, match=r"--over is .*; allowed: KEY=FROM:TO or KEY=FROM:TO:COUNT"):
        grid_of_ranges([text])


def test_ranges_are_spread_evenly() -> None:
    assert grid_of_ranges(["a=0:1:3"]) == {"a": (0.0, 0.5, 1.0)}
    assert [len(one) for one in grid_of_ranges(["a=0:1", "b=0:1", "c=-1:1"]).values()] == [6, 6, 6]
    with pytest.raises(ValueError, match="--over names a twice; allowed: each parameter once"):
        grid_of_ranges(["a=0:1", "a=0:2"])


@pytest.mark.parametrize("name", ["requirement.csv", "requirement_corners.csv"])
def test_a_requirement_that_is_there_is_not_replaced(name: str, tmp_path: Path) -> None:
    """Nor are its corners removed where none are asked for."""
    CliRunner().invoke(app, ["new", str(tmp_path / "study")])
    there = tmp_path / "out" / name
    there.parent.mkdir(parents=True)
    there.write_text("mine", encoding="utf-8")
    words = ["requirement", str(tmp_path / "study.toml"), "near", "--over", "delivery.errors=1:2"]
    result = CliRunner().invoke(app, [*words, "--out", str(tmp_path / "out")])
    assert result.exit_code == 2
    assert f"{name} exists" in result.stderr
    assert there.read_text(encoding="utf-8") == "mine"
