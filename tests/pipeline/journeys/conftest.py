"""A finished study of journeys, made once for all tests of what reads and shows it."""

from pathlib import Path

import pytest

import lithobrake
from lithobrake.results import StudyResults

from ...quick_studies import quick_studies
from .bouncing_lander import bounce, journey_tables


@pytest.fixture(scope="session")
def journeys_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a study of 48 journeys, five of which do not end at rest, with its page."""
    folder = tmp_path_factory.mktemp("journeys") / "study"
    with quick_studies():
        lithobrake.run(journey_tables(), folder, workers=1, model=bounce, report=False)
    return folder


@pytest.fixture
def journeys(journeys_folder: Path) -> StudyResults:
    return lithobrake.open_study(journeys_folder)
