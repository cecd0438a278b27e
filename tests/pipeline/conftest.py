"""Studies of these tests take little time where nothing of theirs is looked at: fits and pictures."""

from collections.abc import Iterator

import pytest

from lithobrake.emulator import validation
from lithobrake.report.figures.style import STYLE


@pytest.fixture(scope="module", autouse=True)
def quick_studies() -> Iterator[None]:
    """Emulators are fitted anew without each quarter of the beds, and not without each of them; pictures are coarse.

    What the emulator is worth is tested in tests/emulator, and the page in tests/report.
    """
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(validation, "MOST_FOLDS", 4)
        patch.setitem(STYLE, "savefig.dpi", 50)
        yield
