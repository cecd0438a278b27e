"""What tests of scores share."""

import sys
from types import ModuleType

import pytest


@pytest.fixture(scope="session")
def scoringrules() -> ModuleType:
    """The library that scores are compared with; where it finds Numba it compiles all of its scores for seconds."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(sys.modules, "numba", None)
        import scoringrules
    return scoringrules
