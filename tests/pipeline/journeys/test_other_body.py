"""A study on Dimorphos whose landers reach Didymos, and go on there to rest."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lithobrake.results import StudyResults
from lithobrake.smallbody import didymos
from lithobrake.vocabulary.outcomes import JourneyEnd

from .bouncing_lander import bounce, journey_tables, run_without_emulator

# From the trailing side, with less than what leaves the binary [m/s].
THROWN = 0.1
TABLES = {
    "delivery": {"latitude_deg": 0.0, "longitude_deg": 60.0},
    "journey": {"count": 24, "duration": 345600.0, "emulated_count": 0},
    "sky": {"sun_latitude_deg": 0.0, "mask_deg": 0.0},
}


def thrown(inputs: dict[str, float], seed: int) -> dict[str, Any]:
    """The first touchdown throws two of three landers toward Didymos; all others end as those of the bouncing lander."""
    journey, touchdown = int(inputs["journey"]), int(inputs["touchdown"])
    # None of the journeys fails here.
    found = bounce({**inputs, "journey": 1e6}, seed)
    if touchdown > 0 or journey % 3 == 0:
        return found
    up = THROWN + 0.002 * (journey % 12)
    out = {"speed_out": up, "elevation_out": 0.5 * math.pi, "velocity_out_x": 0.0, "velocity_out_z": up}
    zero = {"azimuth_out": 0.0, "velocity_out_y": 0.0, "spin_out": 1e-3, "spin_out_x": 0.0, "spin_out_y": 1e-3}
    return {"outcome": "clear", "outputs": found["outputs"] | out | zero | {"spin_out_z": 0.0}}


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> StudyResults:
    folder = tmp_path_factory.mktemp("other_body") / "out"
    return run_without_emulator(journey_tables(**TABLES), folder, thrown, report=True)


def places(table: Any, rows: np.ndarray) -> np.ndarray:
    return np.column_stack([table[f"position_{axis}"] for axis in "xyz"])[rows]


def test_ends_add_up_and_rows_name_the_body(found: StudyResults) -> None:
    journeys, ends = found.journeys, found.results.ends
    print({name: one.count for name, one in ends.items()})
    there = journeys["body"] == "didymos"
    assert sum(one.count for one in ends.values()) == journeys.row_count
    assert sum(one.share.value for one in ends.values()) == pytest.approx(1.0)
    assert (journeys["end"][there] == JourneyEnd.PARTNER).sum() == ends[JourneyEnd.PARTNER].count > 2
    height = didymos(partner=False).shape.height(places(journeys, there))
    assert np.abs(height).max() < 1e-6
    # The distance from the aim point is one over the ground of Dimorphos.
    assert np.isnan(journeys["distance"][there]).all()
    assert set(journeys["body"][journeys["end"] == JourneyEnd.AT_REST].tolist()) == {"dimorphos"}
