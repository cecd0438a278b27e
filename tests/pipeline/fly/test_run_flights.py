"""Flights of single runs: their sites, and the share of them that comes down again."""

from pathlib import Path

import numpy as np
import pytest

from lithobrake.analysis import share_estimate
from lithobrake.pipeline import StudyFolder
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.emulate.outgoing import VELOCITY
from lithobrake.pipeline.fly.flights import Starts, fly_starts
from lithobrake.pipeline.fly.run_sites import FLIGHT_COUNT, run_sites
from lithobrake.pipeline.job import Job, Silent
from lithobrake.pipeline.site import SITE_KEYS, Site
from lithobrake.study import Study, check_tables

from ...synthetic_landings import WEAK
from ..synthetic_lander import outputs_of, synthetic_tables

UNCERTAIN = {
    "mass": {"distribution": "uniform", "lower": 5.2e11, "upper": 5.4e11},
    "north_error": {"distribution": "uniform", "lower": -20.0, "upper": 20.0},
}


def study(**site: object) -> Study:
    return check_tables(synthetic_tables(site=site), Path())


def test_headings_of_a_run_are_in_equal_steps_from_a_first_one_of_its_own() -> None:
    sites = run_sites(Site(study(**UNCERTAIN)), 30)
    assert set(sites) == set(SITE_KEYS)
    steps = np.diff(np.sort(sites["heading_deg"], axis=1), axis=1)
    assert steps == pytest.approx(np.full((30, FLIGHT_COUNT - 1), 360.0 / FLIGHT_COUNT))
    assert len(np.unique(sites["heading_deg"][:, 0])) == 30
    # Each law is met once in each of its equal parts, in an order that has nothing to do with the headings.
    places = np.sort(np.ceil((sites["north_error"] + 20.0) / 40.0 * FLIGHT_COUNT), axis=1)
    assert np.array_equal(places, np.tile(np.arange(1, FLIGHT_COUNT + 1), (30, 1)))
    assert np.isfinite(sites["mass"]).all()
    mixed = [np.corrcoef(sites["heading_deg"][run], sites["north_error"][run])[0, 1] for run in range(30)]
    assert abs(np.mean(mixed)) < 0.1
    assert np.all(sites["latitude_deg"] == 0.0)


def test_more_runs_and_one_more_uncertain_number_change_no_site() -> None:
    few, many = run_sites(Site(study(**UNCERTAIN)), 5), run_sites(Site(study(**UNCERTAIN)), 9)
    assert all(np.array_equal(few[key], many[key][:5]) for key in SITE_KEYS)
    alone = run_sites(Site(study(mass=UNCERTAIN["mass"])), 5)
    assert all(np.array_equal(few[key], alone[key]) for key in ("mass", "heading_deg", "partner_longitude_deg"))


def test_ten_times_as_many_flights_leave_the_interval_as_it_is() -> None:
    _, y, outcome, bed = WEAK.study(60, 12, 3)
    left, drawn = np.flatnonzero(outcome == "clear"), study()
    velocity = np.array([[outputs_of(y[run])[name] for name in VELOCITY] for run in left])
    job = Job(DrawnDesign(drawn), Site(drawn), {}, StudyFolder.only_read(Path()), None, Silent())  # type: ignore[arg-type]
    width = []
    for count in (FLIGHT_COUNT, 10 * FLIGHT_COUNT):
        sites = {key: values.ravel() for key, values in run_sites(Site(drawn), len(left), count).items()}
        start = Starts(np.repeat(left, count), np.repeat(velocity, count, axis=0), sites)
        flown = fly_starts(job, start, "")
        found = share_estimate((flown.status == "impact").reshape(-1, count).mean(axis=1), bed[left])
        width.append(found.upper - found.lower)
    assert width[1] == pytest.approx(width[0], rel=0.03)
