"""Studies of journeys for tests of what their touchdowns came to, and not of the emulator of these."""

from pathlib import Path
from typing import Any

import pytest

import lithobrake
from lithobrake.emulator import training
from lithobrake.results import StudyResults

from .bouncing_lander import bounce


def run_without_emulator(
    tables: dict[str, Any], folder: Path, model: Any = bounce, report: bool = False
) -> StudyResults:
    """Run a study to its summary, or its page, as if too few landers had left the ground for an emulator, which would
    take most of its time.
    """
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(training, "FEWEST", 1_000_000)
        return lithobrake.run(tables, folder, workers=1, model=model, report=report)
