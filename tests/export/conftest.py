"""A finished study with flights; worker processes import its model by name, so this folder is put on the path."""

import sys
from pathlib import Path
from typing import Any

import pytest

sys.path.insert(0, str(Path(__file__).parent))

import export_models

import lithobrake
from lithobrake.results import StudyResults

from ..pipeline.journeys.bouncing_lander import run_without_emulator
from ..quick_studies import quick_studies
from ..report.conftest import finished as finished_folder
from ..report.finished_studies import asked_study
from .delivered import delivered_tables


def finished(tables: dict[str, Any], out: Path) -> StudyResults:
    with quick_studies():
        lithobrake.run(tables, out, workers=1, model=export_models.bounce, report=False)
    return lithobrake.open_study(out)


@pytest.fixture(scope="session")
def results(tmp_path_factory: pytest.TempPathFactory) -> StudyResults:
    return finished(export_models.study_with_flights(), tmp_path_factory.mktemp("export") / "out")


@pytest.fixture(scope="session")
def delivered(tmp_path_factory: pytest.TempPathFactory) -> StudyResults:
    """Those of a study of journeys from states along ICRF."""
    home = tmp_path_factory.mktemp("delivered")
    with quick_studies():
        run_without_emulator(delivered_tables(home), home / "out")
    # Nothing that is passed on needs the file of the states.
    (home / "states.csv").unlink()
    return lithobrake.open_study(home / "out")


@pytest.fixture(scope="session")
def asked_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Of 48 landers that are followed to rest, which the tests of the page read, too."""
    return finished_folder(tmp_path_factory, asked_study)
