"""What tests of scores share."""

from types import ModuleType

import pytest


@pytest.fixture(scope="session")
def scoringrules() -> ModuleType:
    """The library that scores are compared with, which compiles for seconds where it is imported."""
    import scoringrules

    return scoringrules
