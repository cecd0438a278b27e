"""Worker processes import the models of these tests by name, so their folder is put on the path; studies are quick."""

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))

from ..quick_studies import quick_studies


@pytest.fixture(scope="module", autouse=True)
def quick() -> Iterator[None]:
    with quick_studies():
        yield
