"""What commands show of journeys, while they are followed and after."""

import json
import re
import shutil
from pathlib import Path

from lithobrake.pipeline import run_study, study_status
from lithobrake.pipeline.job import Silent
from lithobrake.pipeline.runs.solver import function_identity
from lithobrake.results import StudyResults
from lithobrake.study import StudySource
from lithobrake.vocabulary.outcomes import JourneyEnd

from ...command_line import lithobrake
from .bouncing_lander import FAILS, LEAVES, STUCK, bounce, journey_tables
from .without_emulator import run_without_emulator

TABLES = ("journeys.csv", "touchdowns.csv", "arcs.csv")


def test_status_counts_the_ends_of_the_journeys(journeys: StudyResults) -> None:
    found = study_status(journeys.folder)
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
    for name in TABLES:
        (folder / name).unlink()
    found = study_status(folder).runs
    # A lander that left is under way until its flight has an end.
    known = 48 - len(LEAVES)
    at_rest = known - len(FAILS) - len(STUCK)
    assert found.journeys.lines() == [
        f"journeys: {known} of 48 ended so far: {at_rest} at rest, 1 under way, 1 failed; "
        f"{journeys.touchdowns.row_count} touchdowns"
    ]
    assert found.others == 0


def test_status_counts_no_touchdown_of_an_earlier_delivery(journeys: StudyResults, tmp_path: Path) -> None:
    folder = tmp_path / "edited"
    shutil.copytree(journeys.folder, folder)
    edited = journey_tables(delivery={"incidence_deg": 25.0})
    made = run_without_emulator(edited, folder).touchdowns.row_count
    for name in TABLES:
        (folder / name).unlink()
    found = study_status(folder).runs
    assert found.journeys.touchdowns == made
    assert found.others == journeys.touchdowns.row_count


class Looks(Silent):
    """Looks at the status of a study once, while its journeys are followed."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.told, self.seen = folder, "", list[str]()

    def progress(self, done: float, total: float, what: str, detail: str = "", /) -> None:
        """Look when half of the journeys have ended."""
        if what == "journeys" and done >= 24 and not self.seen:
            self.told, self.seen = detail.splitlines()[0], study_status(self.folder).lines()


def test_status_says_how_far_the_process_is_that_follows_journeys(tmp_path: Path) -> None:
    looks = Looks(tmp_path / "out")
    source = StudySource.of_tables(journey_tables(), function_identity(bounce))
    run_study(source, looks.folder, until="runs", worker_count=1, model=bounce, shown=looks)
    assert re.fullmatch(r"(2[4-9]|3\d) of 48 journeys, \d+ touchdowns, at rest so far \d+ \+- \d+ %", looks.told)
    assert looks.told in looks.seen


def test_runs_have_columns_of_journey_and_touchdown(journeys_folder: Path) -> None:
    shown = lithobrake("runs", journeys_folder)
    assert shown.returncode == 0
    lines = shown.stdout.splitlines()
    assert "touch-" in lines[0]
    assert lines[1].split()[:3] == ["wall", "journey", "down"]
