"""The face of the part: counting is light to import, and every public name is found or missed by its own name."""

import subprocess
import sys

import pytest

from lithobrake import chaos

COUNT_WITHOUT_ARRAYS = """
import sys
from lithobrake.chaos import smolyak_count, term_count
assert (term_count(3, 2), smolyak_count(2, 1)) == (10, 5)
print({"numpy", "scipy", "sklearn", "numba"} & set(sys.modules))
"""


def test_counting_imports_no_arrays() -> None:
    finished = subprocess.run([sys.executable, "-c", COUNT_WITHOUT_ARRAYS], capture_output=True, text=True)
    assert (finished.stdout, finished.stderr) == ("set()\n", "")


def test_a_name_that_is_not_there_is_missed_by_name() -> None:
    with pytest.raises(AttributeError, match=r"^No lithobrake\.chaos attribute smolyack$"):
        chaos.smolyack  # noqa: B018
    with pytest.raises(ImportError, match=r"^cannot import name 'smolyack' from 'lithobrake\.chaos'"):
        from lithobrake.chaos import smolyack  # noqa: F401
