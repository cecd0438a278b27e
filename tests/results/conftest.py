"""Worker processes import the models of these tests by name, so their folder is put on the path; studies are quick."""

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))

from lithobrake.pipeline.first_touchdown import flights

from ..quick_studies import quick_studies


@pytest.fixture(scope="module", autouse=True)
def quick() -> Iterator[None]:
    """Paths of flights have few places, each of which is flown to from the start."""
    with quick_studies(), pytest.MonkeyPatch.context() as patch:
        patch.setattr(flights, "PARTS", 4)
        yield
