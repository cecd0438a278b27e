"""Compiling in the lighter way leaves the process as it was."""

import gc

import pytest

from lithobrake.compilation.lighter_compilation import NEW_OBJECTS, RareGarbageCollection


@pytest.mark.parametrize(("usual", "meanwhile"), [(700, NEW_OBJECTS), (0, 0), (10**6, 10**6)])
def test_garbage_is_collected_rarely_while_any_thread_compiles(usual: int, meanwhile: int) -> None:
    """Two that overlap: the first to begin is the first to end."""
    before, rare = gc.get_threshold(), RareGarbageCollection()
    gc.set_threshold(usual, 10, 10)
    try:
        rare.__enter__()
        rare.__enter__()
        assert gc.get_threshold()[0] == meanwhile
        rare.__exit__()
        assert gc.get_threshold()[0] == meanwhile
        rare.__exit__()
        assert gc.get_threshold() == (usual, 10, 10)
    finally:
        gc.set_threshold(*before)
