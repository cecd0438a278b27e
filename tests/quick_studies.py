"""Studies that take less time at what the tests of their results do not look at: validation of emulators, pictures."""

from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from lithobrake.emulator import validation
from lithobrake.report.figures.style import STYLE


@contextmanager
def quick_studies() -> Iterator[None]:
    """Emulators are fitted anew without each quarter of the beds, and not without each bed; pictures are coarse.

    What an emulator is worth is tested in tests/emulator, and how pages look in tests/report.
    """
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(validation, "MOST_FOLDS", 4)
        patch.setitem(STYLE, "savefig.dpi", 50)
        yield
