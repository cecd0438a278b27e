"""A map of sites of a finished study: its landers elsewhere, what is answered, its intervals, its files."""

import csv
import json
import math
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from lithobrake.analysis import EqualAreaCells
from lithobrake.cli import app
from lithobrake.export import write_site_cells
from lithobrake.files.reading import read_rows
from lithobrake.pipeline import map_sites, site_lines, site_map_files, write_site_map
from lithobrake.pipeline.answer.emulated_ends import Refits
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.job import Job, Silent
from lithobrake.pipeline.journeys.touchdown_emulator import TouchdownEmulator
from lithobrake.pipeline.runs.solver import function_identity
from lithobrake.pipeline.site import with_site_gravity
from lithobrake.pipeline.site_grid import (
    MOST_UNKNOWN,
    PLACES,
    SiteGround,
    SiteLanders,
    all_at_rest,
    site_arrivals,
    site_cells,
)
from lithobrake.report.figures.site_figures import drawn_and_flat
from lithobrake.results import StudyResults
from lithobrake.results.site_results import SiteMap
from lithobrake.results.study_files import json_values, results_in
from lithobrake.statements.sites import compared, everywhere, page_answer
from lithobrake.study.source import StudySource
from lithobrake.vocabulary.number_words import LEVEL

from ...smallbody.meshes import sphere_mesh
from ..few_terms import REFITS
from .bouncing_lander import bounce, journey_tables

CELLS, LANDERS = 24, 100


def source_of(**changes: dict[str, Any]) -> StudySource:
    return StudySource.of_tables(journey_tables(**changes), function_identity(bounce))


def job_of(source: StudySource) -> Job:
    """What the parts of a map read of a job; no executor makes anything."""
    study = with_site_gravity(source.study)
    nothing: Any = None
    return Job(DrawnDesign(study), source.tables, nothing, nothing, Silent())


@pytest.fixture(scope="session")
def site_map(journeys_folder: Path) -> SiteMap:
    return map_sites(source_of(), journeys_folder, cell_count=CELLS, lander_count=LANDERS, worker_count=1, model=bounce)


def test_landers_are_delivered_to_every_cell_as_the_study_delivers_them() -> None:
    job, cells = job_of(source_of()), EqualAreaCells.of(CELLS)
    begin = site_arrivals(job, cells, LANDERS)
    latitude, longitude = job.site.body.shape.latitude_longitude(begin.origin)
    assert (cells.cell_of(latitude, longitude).reshape(CELLS, LANDERS) == np.arange(CELLS)[:, None]).all()
    speed = begin.column("impact.speed").reshape(CELLS, LANDERS)
    assert (speed == speed[0]).all()
    assert np.unique(speed[0]).size == LANDERS
    assert (np.bincount(begin.refit[:LANDERS], minlength=REFITS) == LANDERS / REFITS).all()
    # A heading from north toward east: the way of a lander, seen from where it comes down.
    heading = np.radians(begin.site["heading_deg"])
    up, ahead = begin.axes[:, 2], begin.axes[:, 0]
    north = np.array([0.0, 0.0, 1.0]) - up[:, 2:] * up
    north /= np.linalg.norm(north, axis=1, keepdims=True)
    along = np.cos(heading)[:, None] * north + np.sin(heading)[:, None] * np.cross(north, up)
    # The pole laid into a facet is not quite the direction of growing latitude, least near the poles.
    assert (ahead * along).sum(axis=1).min() > 0.9


def test_what_the_emulator_does_not_know_is_not_answered(site_map: SiteMap) -> None:
    assert len(site_map.cells) == CELLS
    for cell in site_map.cells:
        assert (cell.ends is None) == (cell.unknown > MOST_UNKNOWN)
        assert (cell.beyond == "") == (cell.unknown == 0.0)
    assert {word for cell in site_map.cells for word in cell.beyond.split(", ")} <= {
        *("", "gravity", "slope", "impact speed", "impact angle")
    }
    assert sum(cell.journeys for cell in site_map.cells) == 48


def test_an_end_that_no_lander_has_is_limited_by_the_journeys_and_not_by_their_touchdowns(site_map: SiteMap) -> None:
    """48 journeys on 12 beds: (1 - q) (2 - q) (3 - q) (4 - q) / 4! to the 12th is 0.1."""
    assert site_map.touchdowns > 48
    partners = [cell.ends.partner for cell in site_map.cells if cell.ends is not None and cell.unknown == 0.0]
    assert partners
    for one in partners:
        assert one.value == 0.0
        assert one.upper is not None
        assert math.prod((j - one.upper) / j for j in range(1, 5)) ** 12 == pytest.approx(0.1)


def test_a_cell_with_too_many_unknown_ends_is_hatched_and_says_why() -> None:
    cells = EqualAreaCells.of(4)
    end = np.full((4, LANDERS), "at_rest", dtype="<U10")
    beyond = np.full((4, LANDERS), "", dtype="<U24")
    # Of the first cell eleven in a hundred are unknown, of the second ten; half of the third escapes.
    end[0, :11], beyond[0, :8], beyond[0, 8:11] = "unknown", "surface.gravity", "impact.speed"
    end[1, :10], beyond[1, :10] = "unknown", "surface.slope_deg"
    end[2, : LANDERS // 2] = "escaped"
    refit, time = np.tile(np.arange(LANDERS) % REFITS, (4, 1)), np.tile(np.arange(LANDERS) * 60.0, (4, 1))
    landers = SiteLanders(end, time, 0.1 * time, refit, beyond)
    ground = SiteGround(np.tile(np.linspace(0.0, 24.0, 24), (4, 1)), np.full((4, 24), 5e-5), {})
    fitted = Refits(bed_count=12, run_count=100, why=None)
    first, second, third, last = site_cells(cells, landers, ground, fitted, np.array([0, 3, 0, 1]), {})
    assert (first.ends, first.beyond, first.unknown) == (None, "gravity, impact speed", 0.11)
    assert (second.ends.at_rest.value, second.beyond, second.journeys) == (1.0, "slope", 3)
    assert second.ends.at_rest.lower < 0.9 < (second.ends.at_rest.upper or 0.0)
    assert third.ends.at_rest.value == third.ends.escaped.value == 0.5
    assert not third.not_worse
    assert last.not_worse
    assert last.ends.time_s.value == pytest.approx(60.0 * 0.5 * (LANDERS - 1))
    assert last.slope_deg.mean == pytest.approx(12.0)
    assert (last.slope_deg.low, last.slope_deg.high) == pytest.approx((1.2, 22.8))
    assert all_at_rest(landers, fitted).value == pytest.approx((90 + 50 + 100) / (90 + 100 + 100))


@pytest.mark.parametrize(("touchdowns", "slow"), [(None, ""), (1, "impact.speed")])
def test_impacts_are_beyond_the_first_range_that_they_leave(touchdowns: int | None, slow: str) -> None:
    """To rest no impact is too slow; an emulator of first touchdowns alone knows no slower ones."""
    journey = {} if touchdowns is None else {"touchdowns": touchdowns}
    design = job_of(source_of(journey=journey)).design
    ranges = {"impact.speed": (0.1, 0.2), "surface.gravity": (4e-5, 5e-5)}
    emulator = TouchdownEmulator(design, [], None, np.zeros(0), ranges, np.zeros((0, 3)), 0.0, 0.0)
    found = emulator.beyond(
        {"impact.speed": np.array([0.15, 0.01, 0.3, 0.15]), "surface.gravity": np.array([4.5e-5, 5e-5, 1e-5, 1e-5])}
    )
    assert found.tolist() == ["", slow, "impact.speed", "surface.gravity"]


def test_a_cell_has_what_the_journeys_of_the_study_have_there(site_map: SiteMap, journeys: StudyResults) -> None:
    own = int(EqualAreaCells.of(CELLS).cell_of([10.0], [-60.0])[0])
    ends, rests = site_map.cells[own].ends, journeys.journeys["end"] == "at_rest"
    assert ends.at_rest.upper is not None
    assert ends.at_rest.lower <= rests.mean() <= ends.at_rest.upper
    total = ends.at_rest.value + ends.partner.value + ends.escaped.value + ends.under_way.value
    assert total == pytest.approx(1.0, abs=0.02)
    assert ends.time_s.value == pytest.approx(np.median(journeys.journeys["time_s"][rests]), rel=0.4)
    assert ends.distance_m.value == pytest.approx(np.median(journeys.journeys["distance"][rests]), rel=0.5)


def test_emulator_and_landings_are_compared_lander_by_lander(site_map: SiteMap, journeys: StudyResults) -> None:
    whole, *regions = site_map.agreement
    assert (whole.latitude_deg, whole.journeys) == (None, 48)
    assert whole.landings.value == pytest.approx(np.mean(journeys.journeys["end"] == "at_rest"))
    rows = [row for row in read_rows(journeys.folder / "emulated.csv", ("landers",), "") if row["landers"] == "own"]
    by_lander = []
    for number in range(48):
        ends = [row["end"] for row in rows if int(row["journey"]) == number and row["end"] != "unknown"]
        by_lander.append(ends.count("at_rest") / len(ends))
    assert whole.emulator.value == pytest.approx(np.mean(by_lander))
    assert whole.difference.value == pytest.approx(whole.emulator.value - whole.landings.value)
    assert whole.agrees
    assert [one.journeys for one in regions] == [48]
    assert "they agree" in site_map.statement


def test_bounds_hold_whatever_becomes_of_landers_of_unknown_end() -> None:
    fitted = Refits(bed_count=12, run_count=100, why=None)
    refit, met = np.repeat(np.arange(REFITS), 4), np.tile([True, True, False, False], REFITS)
    plain = fitted.share_of_known(met, np.ones(len(met), dtype=bool), refit)
    # One lander in four is unknown, and did not meet it as far as one sees.
    lacking = fitted.share_of_known(met, np.tile([True, True, True, False], REFITS), refit)
    assert plain.value == 0.5
    assert (lacking.value, lacking.lower) == (pytest.approx(2.0 / 3.0), plain.lower)
    assert lacking.upper > 0.75


def test_the_ground_of_a_ball_is_level_and_has_half_of_the_light(tmp_path: Path) -> None:
    vertices, faces = sphere_mesh(12)
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in (80.0 * vertices).tolist()]
    lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces.tolist()]
    (tmp_path / "ball.obj").write_text("\n".join(lines), encoding="utf-8")
    site = {"body": str(tmp_path / "ball.obj"), "mass": 4.0e9, "spin_period": 1e7}
    tables = {
        **journey_tables(),
        "site": site,
        "sky": {"sun_latitude_deg": 0.0, "earth_latitude_deg": 0.0, "mask_deg": 30.0},
    }
    job, cells = job_of(StudySource.of_tables(tables, function_identity(bounce))), EqualAreaCells.of(CELLS)
    ground = SiteGround.of(job, cells)
    assert ground.slope_deg.shape == (CELLS, PLACES)
    assert ground.slope_deg.max() < 6.0
    assert ground.gravity == pytest.approx(np.full((CELLS, PLACES), 6.6743e-11 * 4.0e9 / 80.0**2), rel=0.05)
    assert ground.light["sun"].mean() == pytest.approx(0.5, abs=0.02)
    # Higher than 30 degrees over a place of latitude b a body over the equator stands for arccos(0.5 / cos b) / pi.
    for number, (south, north, _, _) in enumerate(cells.bounds_deg.tolist()):
        sines = np.linspace(math.sin(math.radians(south)), math.sin(math.radians(north)), 401)
        seen = np.arccos(np.minimum(0.5 / np.sqrt(np.maximum(1.0 - sines**2, 1e-12)), 1.0)) / math.pi
        assert ground.light["earth"][number].mean() == pytest.approx(seen.mean(), abs=0.03)


def test_the_ground_of_dimorphos_is_that_of_the_body_with_its_partner() -> None:
    job = job_of(source_of())
    ground = SiteGround.of(job, EqualAreaCells.of(CELLS))
    alone = np.degrees(job.site.body.slope(*EqualAreaCells.of(CELLS).centres_deg.T))
    # Without the partner's tide slopes differ by up to some degrees, and not by more.
    assert np.abs(ground.slope_deg.mean(axis=1) - alone).max() < 8.0
    assert set(ground.light) == {"sun", "earth"}
    # Earth stands over the equator and is seen from 30 degrees above the ground on: at the poles never.
    assert ground.light["earth"][0].max() < 0.05


def test_a_map_is_written_as_page_numbers_table_and_polygons(site_map: SiteMap, tmp_path: Path) -> None:
    page, numbers, table = write_site_map(site_map, "the study file", tmp_path / "sites")
    assert (page, numbers, table) == site_map_files(tmp_path / "sites")
    assert results_in(SiteMap, json.loads(numbers.read_text(encoding="utf-8"))) == site_map
    text = page.read_text(encoding="utf-8")
    assert text.count("<figure") == 3
    header, below = text.split("</header>")
    # The line at the top, then the comparison with landings where it is drawn: no number twice on one screen.
    assert site_map.statement == f"{page_answer(site_map)} {compared(site_map)}"
    assert page_answer(site_map).replace(" %", "&nbsp;%").replace(" h ", "&nbsp;h ") in header
    assert "by the emulator" not in header
    assert compared(site_map).replace(" %", "&nbsp;%") in below
    assert header.count(f"{site_map.landers} landers") == 1
    with table.open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == CELLS
    for row, cell in zip(rows, site_map.cells, strict=True):
        assert float(row["south_deg"]) == cell.south_deg
        assert (row["at_rest"] == "") == (cell.ends is None)
    polygons = json.loads(write_site_cells(site_map, tmp_path / "sites").read_text(encoding="utf-8"))
    ring = polygons["features"][3]["geometry"]["coordinates"][0]
    cell = site_map.cells[3]
    assert [cell.west_deg, cell.south_deg] == ring[0] == ring[-1]
    # Counter-clockwise, as GeoJSON has it: the area by the trapezoids is above 0.
    area = sum(0.5 * (a[0] - b[0]) * (a[1] + b[1]) for a, b in pairwise(ring))
    assert area == pytest.approx((cell.east_deg - cell.west_deg) * (cell.north_deg - cell.south_deg))
    radius = float(polygons["body_frame"].split('sphere",')[1].split(",")[0])
    assert radius == pytest.approx((0.75 * job_of(source_of()).site.body.shape.volume / math.pi) ** (1 / 3), rel=1e-6)
    assert site_lines(site_map)[0] == site_map.statement
    assert site_map.level == LEVEL
    assert json_values(site_map)["landers"] == LANDERS


@pytest.mark.parametrize(("words", "message"), [
    (["--landers", "75"], f"--landers is 75; allowed: multiples of {REFITS} from {2 * REFITS}; take 200"),
    (["--cells", "3"], "cells is 3"),
    (["--cells", "20000", "--landers", "200"], "makes 4000000 landers; allowed: up to 2000000"),
])  # fmt: skip
def test_counts_that_make_no_map_are_refused(words: list[str], message: str, tmp_path: Path) -> None:
    study = tmp_path / "study.toml"
    CliRunner().invoke(app, ["new", str(tmp_path / "study")])
    result = CliRunner().invoke(app, ["sites", str(study), "--out", str(tmp_path / "out"), *words])
    assert result.exit_code == 2
    assert message in result.stderr
    assert not (tmp_path / "out").exists()


def test_studies_that_deliver_nothing_elsewhere_are_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"this study has none; set journey.emulated_count above 0"):
        map_sites(StudySource.read(Path("scenarios/first_bounce.toml")), tmp_path)


def test_a_map_that_is_there_is_not_replaced(tmp_path: Path) -> None:
    CliRunner().invoke(app, ["new", str(tmp_path / "study")])
    there = tmp_path / "out" / "sites" / "sites.csv"
    there.parent.mkdir(parents=True)
    there.write_text("mine", encoding="utf-8")
    result = CliRunner().invoke(app, ["sites", str(tmp_path / "study.toml"), "--out", str(tmp_path / "out")])
    assert result.exit_code == 2
    assert "sites.csv exists" in result.stderr
    assert there.read_text(encoding="utf-8") == "mine"


def test_a_number_that_is_the_same_at_every_site_is_a_sentence_and_no_map(site_map: SiteMap) -> None:
    """Sunlight of half a day everywhere; a slope that differs is drawn."""
    half, some = (replace(site_map.cells[0].slope_deg, mean=value) for value in (0.5, 0.4))
    cells = [replace(cell, light={"sun": half}) for cell in site_map.cells]
    drawn, flat = drawn_and_flat(replace(site_map, cells=cells))
    assert flat == [("sunlight [% of a day]", 50.0)]
    assert everywhere(flat) == " Sunlight: 50 % of a day at every site."
    assert "slope against gravity [deg]" in [sheet.title for sheet in drawn]
    cells[0] = replace(cells[0], light={"sun": some})
    assert drawn_and_flat(replace(site_map, cells=cells))[1] == []
