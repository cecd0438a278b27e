"""What tests of the validation share."""

import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def forecast_scripts():
    """The scripts of the forecast import each other by name, as they do from the command line."""
    before = list(sys.path)
    sys.path[:0] = [str(ROOT / "validation" / "forecast_hera"), str(ROOT / "validation"), str(ROOT / "benchmarks")]
    yield
    sys.path[:] = before
