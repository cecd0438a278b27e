"""A drawn study of synthetic landings from its file to its report: its shares against what is known of them."""

import csv
import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import lithobrake
from lithobrake.pipeline import StudyFolder, write_report_again
from lithobrake.pipeline.answer import run_estimates
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.first_touchdown import run_flights
from lithobrake.pipeline.first_touchdown.flights import Starts, fly_starts
from lithobrake.pipeline.first_touchdown.run_flights import run_sites
from lithobrake.pipeline.first_touchdown.samples import VELOCITY
from lithobrake.pipeline.job import Job, Silent
from lithobrake.pipeline.site import Site
from lithobrake.results import StudyResults
from lithobrake.results.study_files import json_values
from lithobrake.study import check_tables

from ..quick_studies import PATH_PARTS
from ..report.page_scripts import answer_of, explorer_data, needs_node
from ..synthetic_landings import SPEED_LIMIT, WEAK, random_soils
from .coarse_bodies import coarse_bodies
from .synthetic_lander import SyntheticLander, outputs_of, synthetic_tables

# Nothing here looks at hard ground.
SIDE = {"design": {"run_count": 150, "side_runs": True}, "hard_ground": {"count": 0}}


# Flights of a landing, one to each heading; tests/pipeline/test_site.py looks at what more of them tell.
FLIGHTS = 16


@pytest.fixture(scope="module", autouse=True)
def few_flights() -> Iterator[None]:
    with coarse_bodies(), pytest.MonkeyPatch.context() as patch:
        for module in (run_flights, run_estimates):
            patch.setattr(module, "FLIGHT_COUNT", FLIGHTS)
        patch.setattr(run_flights.run_sites, "__defaults__", (FLIGHTS,))
        yield


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> StudyResults:
    """A study of 150 landings with side runs, to its page."""
    folder = tmp_path_factory.mktemp("drawn") / "out"
    return lithobrake.run(synthetic_tables(**SIDE), folder, workers=1, model=SyntheticLander())


def flown_share(count: int) -> float:
    """Share of landings of the truth that come down again within the time of the study; none that is captured."""
    study, random = check_tables(synthetic_tables(), Path()), np.random.default_rng(5)
    landings = WEAK.draw(random_soils(count, random), random.standard_normal(count), random)
    left = np.flatnonzero(landings.outcome == "clear")
    velocity = np.array([[outputs_of(landings.y[run])[name] for name in VELOCITY] for run in left])
    site = {key: values[:, 0] for key, values in run_sites(Site(study), len(left), 1).items()}
    job = Job(DrawnDesign(study), {}, StudyFolder.only_read(Path()), None, Silent())  # type: ignore[arg-type]
    return float((fly_starts(job, Starts(left, velocity, site), "").status == "impact").sum()) / count


def test_the_share_of_the_runs_and_that_of_the_emulator_hold_the_truth(results: StudyResults) -> None:
    returns, truth = results.summary["results"]["returns"], flown_share(3000)
    assert returns["lower"] < truth < returns["upper"]
    assert 0.02 < returns["upper"] - returns["lower"] < 0.15
    assert (returns["from"], returns["level"], returns["why"]) == ("150 landings on 12 beds", 0.9, None)
    assert abs(returns["emulator"] - truth) < 0.05
    returning = results.summary["results"]["shares"]["returns"]
    assert returning["lower"] < truth < returning["upper"]
    assert results.summary["results"]["emulator"]["warning"] is None
    assert "90 % interval" in results.headline[0]
    # The runs' own flights, by the estimator of the return fraction; samples of the emulator stand apart.
    shares, emulated = results.summary["results"]["shares"], results.summary["results"]["samples"]["shares"]
    assert shares["returns"]["share"] == returns["share"]
    assert emulated["returns"]["lower"] < truth < emulated["returns"]["upper"]
    narrow, wide = (table["flying"]["upper"] - table["flying"]["lower"] for table in (shares, emulated))
    assert narrow < wide


def test_times_and_speeds_of_flights_are_of_the_runs_and_have_intervals(results: StudyResults) -> None:
    found = results.summary["results"]
    for name in ("time_s", "impact_speed", "impact_incidence_deg"):
        for key, (lower, upper) in found["flights"][name]["intervals"].items():
            assert lower < found["flights"][name][key] < upper
    with (results.folder / "run_impacts.csv").open() as file:
        assert sum(1 for _ in file) - 1 == found["shares"]["impact"]["count"]


@needs_node
def test_the_share_of_the_explorer_over_the_whole_law_is_that_of_the_emulator(results: StudyResults) -> None:
    program = """const { facts, law: packedLaw, flown: packedFlown } = given, starts = unpack(packedFlown);
      const flown = new Flown(starts.starts, starts.status), law = new Law(unpack(packedLaw), facts);
      flown.cells = new Uint16Array(starts.status.length);
      const { returns, known } = new Explorer(law, flown, facts).whole;
      const sum = (list) => list.reduce((all, one) => all + one, 0);
      return sum(returns) / sum(known);"""
    page = (results.folder / "report" / "index.html").read_text(encoding="utf-8")
    found = answer_of(("live/law.js", "live/flown.js", "live/explore.js"), program, explorer_data(page))
    share, flown = results.summary["results"]["returns"]["emulator"], results.flights.row_count
    # Both stand on the same flights; the study's share has the chance of so many drawn velocities beside.
    assert abs(found - share) < 3.0 * np.sqrt(share * (1.0 - share) / flown)


def test_the_ways_of_flights_lead_from_the_site_to_their_ends(results: StudyResults) -> None:
    (places, status), flights = results.flight_paths, results.flights
    assert places.shape == (16, PATH_PARTS + 1, 3)
    assert list(status) == list(flights["status"][:16])
    down = np.array(status) == "impact"
    ends = places[down, -1]
    latitude = np.degrees(np.arctan2(ends[:, 2], np.hypot(ends[:, 0], ends[:, 1])))
    longitude = np.degrees(np.arctan2(ends[:, 1], ends[:, 0]))
    # A thousandth of a degree is less than a centimetre.
    assert latitude == pytest.approx(flights["latitude_deg"][:16][down], abs=1e-3)
    assert longitude == pytest.approx(flights["longitude_deg"][:16][down], abs=1e-3)
    assert np.ptp(places[:, 0], axis=0) == pytest.approx(np.zeros(3), abs=1e-6)


def test_parts_of_the_variance_add_up_and_side_runs_tell_theirs(results: StudyResults) -> None:
    found = results.summary["results"]
    assert set(found["variance_shares"]) == {"speed_out", "elevation_out", "spin_out", "returns"}
    parts = found["variance_shares"]["speed_out"]
    # So few runs do not bear the attitude beside the soil.
    assert parts["attitude"] is None
    soil, bed, place, chaos = (parts[name]["share"] for name in ("soil", "bed", "place", "chaos"))
    assert place == pytest.approx(max(0.0, 1.0 - soil - bed - chaos))
    assert set(parts["soil_by_input"]) == {name for name in results.runs.columns if name.startswith("grain.")} - {
        "grain.poisson_ratio", "grain.cohesion_force", "grain.surface_energy", "grain.spinning_friction",
        "grain.yield_strength", "grain.restitution_speed"}  # fmt: skip
    # Another seed is another place to these landings, so a twin is as unlike its run as any other.
    assert parts["chaos"]["upper"] > 0.5
    side = found["runs"]["side_runs"]
    assert (side["soil_pairs"], side["twins"]) == (20, 12)
    assert set(side["chaos_deviation"]) == set(side["soil_total_effect"]) == set(found["variance_shares"])


def test_samples_leave_outwards_with_the_speed_that_was_drawn_and_energy_allows(results: StudyResults) -> None:
    samples = results.samples.where(results.samples["outcome"] == "clear")
    velocity = np.column_stack([samples[name] for name in VELOCITY])
    assert len(velocity) > 3500
    assert np.linalg.norm(velocity, axis=1) == pytest.approx(samples["speed_out"], rel=1e-12)
    assert velocity[:, 2].min() > 0.0
    assert samples["speed_out"].max() < SPEED_LIMIT * 1.001
    spin = np.column_stack([samples[f"spin_out_{axis}"] for axis in "xyz"])
    assert np.linalg.norm(spin, axis=1) == pytest.approx(samples["spin_out"], rel=1e-12)
    # The scatter of the runs is in the samples, and not their mean law alone.
    runs = results.runs["speed_out"][results.runs["outcome"] == "clear"]
    assert np.std(samples["speed_out"]) == pytest.approx(np.std(runs), rel=0.25)


def test_the_emulator_opens_and_every_key_of_the_summary_is_described(results: StudyResults) -> None:
    model = results.emulator.model
    drawn = results.emulator.sample({name: law.median for name, law in model.runs.inputs.items()}, 50)
    assert (drawn.row_count, drawn.columns["speed_out"].units) == (50, "m/s")
    assert drawn.columns["grain.young_modulus"].units == "Pa"
    left = drawn["outcome"] == "clear"
    assert np.isnan(drawn["speed_out"][~left]).all()
    velocity = np.column_stack([drawn[name] for name in VELOCITY])[left]
    assert np.linalg.norm(velocity, axis=1) == pytest.approx(drawn["speed_out"][left], rel=1e-12)
    assert json_values(results.results) == results.summary["results"]
    scores = results.summary["results"]["emulator"]["scores"]
    assert scores["speed_out"]["band_90"] == pytest.approx(0.9, abs=0.07)
    assert sum(scores["speed_out"]["pit"]) == model.runs.has_outputs.sum()


def test_the_page_opens_with_the_answer_and_is_written_again(results: StudyResults) -> None:
    page = results.folder / "report" / "index.html"
    first = page.read_text()
    opening = re.search(r'<p class="answer">(.*?)\.</p>', first)
    assert opening is not None
    share, _, action = opening[1].replace("&nbsp;", " ").partition(" of the landings ")
    assert f"{share} {action}" in results.headline[0]
    page.unlink()
    write_report_again(results.folder)
    assert page.read_text() == first


def test_a_captured_run_stays_where_the_ground_holds_it(results: StudyResults) -> None:
    with (results.folder / "run_flights.csv").open() as file:
        captured = [row for row in csv.DictReader(file) if row["outcome"] == "captured"]
    # At the equator of Didymos nothing lies on the ground.
    assert captured
    assert {(row["settled"], row["lofted"], float(row["returns"])) for row in captured} == {("0", str(FLIGHTS), 0.0)}
