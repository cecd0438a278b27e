"""A finished study with flights; worker processes import its model by name, so this folder is put on the path."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))

import export_models

import lithobrake
from lithobrake.results import StudyResults

from ..pipeline.journeys.bouncing_lander import run_without_emulator
from ..quick_studies import quick_studies
from .delivered import delivered_tables


@pytest.fixture(scope="session")
def results(tmp_path_factory: pytest.TempPathFactory) -> StudyResults:
    out = tmp_path_factory.mktemp("export") / "out"
    with quick_studies():
        lithobrake.run(export_models.study_with_flights(), out, workers=1, model=export_models.bounce, report=False)
    return lithobrake.open_study(out)


@pytest.fixture(scope="session")
def bouncing(tmp_path_factory: pytest.TempPathFactory) -> StudyResults:
    """Those of a study whose first landers are followed over their bounces on the soil."""
    out = tmp_path_factory.mktemp("bounces") / "out"
    with quick_studies():
        lithobrake.run(export_models.study_with_bounces(), out, workers=1, model=export_models.bounce, report=False)
    return lithobrake.open_study(out)


@pytest.fixture(scope="session")
def delivered(tmp_path_factory: pytest.TempPathFactory) -> StudyResults:
    """Those of a study of journeys from states along ICRF."""
    home = tmp_path_factory.mktemp("delivered")
    run_without_emulator(delivered_tables(home), home / "out")
    # Nothing that is passed on needs the file of the states.
    (home / "states.csv").unlink()
    return lithobrake.open_study(home / "out")
