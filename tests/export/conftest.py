"""A finished study with flights; worker processes import its model by name, so this folder is put on the path."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))

import export_models

import lithobrake
from lithobrake.results import StudyResults


@pytest.fixture(scope="session")
def results(tmp_path_factory: pytest.TempPathFactory) -> StudyResults:
    """The results of a study on Dimorphos."""
    out = tmp_path_factory.mktemp("export") / "out"
    lithobrake.run(export_models.study_with_flights(), out, workers=1, model=export_models.bounce, report=False)
    return lithobrake.open_study(out)


@pytest.fixture(scope="session")
def bouncing(tmp_path_factory: pytest.TempPathFactory) -> StudyResults:
    """Those of a study whose first landers are followed over their bounces on the soil."""
    out = tmp_path_factory.mktemp("bounces") / "out"
    lithobrake.run(export_models.study_with_bounces(), out, workers=1, model=export_models.bounce, report=False)
    return lithobrake.open_study(out)
