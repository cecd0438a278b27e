"""What one of the grounds that a study allows would give, and one body where these are patchy, too."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from lithobrake.analysis.ground_spread import median_over_grounds, share_over_grounds
from lithobrake.analysis.output_estimates import quantile_estimate
from lithobrake.analysis.share_estimate import share_estimate
from lithobrake.pipeline.answer.ground_answers import finer_ground, over_grounds
from lithobrake.pipeline.answer.journey_ends import JourneyTable

from ..design.test_bed_grounds import gravel, study

BEDS, EACH = 12, 8
SHARE = {"distribution": "uniform", "lower": 0.1, "upper": 0.9}


def ends() -> JourneyTable:
    """Bodies of which every second lets half of its landers go, and holds the others twice as long."""
    random, count = np.random.default_rng(5), BEDS * EACH
    bed = np.repeat(np.arange(BEDS), EACH)
    loose = bed % 2 == 1
    rests = ~loose | (np.arange(count) % 2 == 0)
    time = np.where(loose, 2000.0, 1000.0) * np.exp(0.2 * random.normal(size=count))
    numbers = dict.fromkeys(("contacts", "distance", "tilt_deg", "touchdowns"), np.ones(count)) | {"time_s": time}
    face = np.where(rests, "+z", "")
    return JourneyTable(np.where(rests, "at_rest", "escaped"), bed, numbers, np.zeros((count, 3)), face)


def asked(unknown: str) -> Any:
    kinds = {"fine": gravel(0.09, 0.5), "coarse": gravel(0.3, 0.5)}
    if unknown == "both":
        kinds = {name: kind | {"weight": SHARE} for name, kind in kinds.items()}
    return SimpleNamespace(study=study(kinds, unknown=unknown))


@pytest.mark.parametrize("unknown", ["everywhere", "both"])
def test_the_interval_is_that_of_one_body_by_the_bed_of_the_first_touchdown(unknown: str) -> None:
    table, design = ends(), asked(unknown)
    found = over_grounds(design, table)
    assert found is not None
    rests = table.rests.astype(float)
    assert found.at_rest == share_over_grounds(rests, table.bed)
    assert found.time_s == median_over_grounds(table.of_rest("time_s"), table.bed)
    # Bodies rest half or all of their landers: the mean is known far better than one body.
    mean = share_estimate(rests, table.bed).share
    assert found.at_rest.lower is not None
    assert mean.lower is not None
    assert found.at_rest.lower < 0.55 < mean.lower
    assert found.time_s.lower is not None
    assert found.time_s.upper is not None
    assert found.time_s.lower < 900.0
    assert found.time_s.upper > 2000.0


def test_a_body_of_patches_is_every_body() -> None:
    assert over_grounds(asked("patchy"), ends()) is None


def test_the_finest_beds_have_an_answer_of_their_own() -> None:
    """Every third bed is of the finest grains, which stand for half of four octaves of half of the ground."""
    fine = {"weight": 0.5, "grain_size": {"distribution": "log_uniform", "lower": 0.01, "upper": 0.16}}
    kinds, table = {"fine": fine, "coarse": gravel(0.3, 0.5)}, ends()
    each = [SimpleNamespace(kind="fine", size=0.04 if bed % 3 == 0 else 0.1) for bed in range(BEDS)]
    found = finer_ground(  # type: ignore[arg-type]
        SimpleNamespace(study=study(kinds, finest=0.04), grounds=SimpleNamespace(each=each)), table
    )
    assert found is not None
    assert (found.finest_m, found.share) == (0.04, pytest.approx(0.25))
    own = table.bed % 3 == 0
    rests = table.rests[own]
    assert found.journeys == own.sum() == 32
    assert found.at_rest is not None
    # Two of these four beds let half of their landers go.
    assert (found.at_rest.count, found.at_rest.share.value) == (24, 0.75)
    times, beds = table.numbers["time_s"][own][rests], table.bed[own][rests]
    assert found.time_s == quantile_estimate(times, beds, 0.5)
    assert found.time_s.value == pytest.approx(np.median(times))
    assert finer_ground(SimpleNamespace(study=study({"coarse": gravel(0.3)})), table) is None  # type: ignore[arg-type]
    elsewhere = table.taken(np.flatnonzero(~own))
    alone = finer_ground(  # type: ignore[arg-type]
        SimpleNamespace(study=study(kinds, finest=0.04), grounds=SimpleNamespace(each=each)), elsewhere
    )
    assert alone is not None
    assert (alone.journeys, alone.at_rest, alone.time_s) == (0, None, None)
