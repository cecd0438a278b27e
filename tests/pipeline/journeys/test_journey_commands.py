"""What commands show of journeys, while they are followed and after."""

import json
import shutil
from pathlib import Path

from lithobrake.pipeline import study_status
from lithobrake.results import StudyResults
from lithobrake.vocabulary.outcomes import JourneyEnd

from ...command_line import lithobrake
from .bouncing_lander import FAILS, LEAVES, STUCK


def test_status_counts_the_ends_of_the_journeys(journeys: StudyResults) -> None:
    found = study_status(journeys.folder)
    assert found.runs is not None
    assert found.runs.journeys is not None
    touchdowns = journeys.touchdowns.row_count
    assert found.runs.journeys.lines() == [
        f"journeys: 48 of 48 ended: 43 at rest, 3 escaped, 1 under way, 1 failed; {touchdowns} touchdowns"
    ]
    assert found.runs.tally.total == touchdowns
    assert found.runs.others == 0
    assert "first touchdowns:" in found.runs.lines()
    content = json.loads(json.dumps(found.to_json()))
    assert content["runs"]["journeys"]["ends"][JourneyEnd.AT_REST] == 43


def test_status_counts_what_the_ledger_tells_while_journeys_are_followed(
    journeys: StudyResults, tmp_path: Path
) -> None:
    folder = tmp_path / "half"
    shutil.copytree(journeys.folder, folder)
    for name in ("journeys.csv", "touchdowns.csv", "arcs.csv"):
        (folder / name).unlink()
    found = study_status(folder).runs
    assert found is not None
    assert found.journeys is not None
    # A lander that left is under way until its flight has an end.
    known = 48 - len(LEAVES)
    at_rest = known - len(FAILS) - len(STUCK)
    assert found.journeys.lines() == [
        f"journeys: {known} of 48 ended so far: {at_rest} at rest, 1 under way, 1 failed; "
        f"{journeys.touchdowns.row_count} touchdowns"
    ]
    assert found.others == 0


def test_runs_have_columns_of_journey_and_touchdown(journeys_folder: Path) -> None:
    shown = lithobrake("runs", journeys_folder)
    assert shown.returncode == 0
    lines = shown.stdout.splitlines()
    assert "touch-" in lines[0]
    assert lines[1].split()[:3] == ["wall", "journey", "down"]
