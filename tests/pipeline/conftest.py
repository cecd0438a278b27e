"""Studies in the process of these tests are quick, and one of journeys is made once for all that read and show it."""

from collections.abc import Iterator
from pathlib import Path

import pytest

import lithobrake
from lithobrake.results import StudyResults

from ..quick_studies import blank_pictures, quick_studies
from .few_terms import few_terms
from .journeys.bouncing_lander import bounce, journey_tables


@pytest.fixture(scope="module", autouse=True)
def quick() -> Iterator[None]:
    """See both; fixtures of a session are made before, and ask for it themselves."""
    with quick_studies(), few_terms(), blank_pictures():
        yield


@pytest.fixture(scope="session")
def journeys_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a study of 48 journeys, five of which do not end at rest; nobody writes to it but its report."""
    folder = tmp_path_factory.mktemp("journeys") / "study"
    with quick_studies(), few_terms():
        lithobrake.run(journey_tables(), folder, workers=1, model=bounce, report=False)
    return folder


@pytest.fixture
def journeys(journeys_folder: Path) -> StudyResults:
    return lithobrake.open_study(journeys_folder)
