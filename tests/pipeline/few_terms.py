"""Emulators of studies whose tests do not look at what emulators are worth: they choose among less."""

from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from lithobrake.emulator import fitting, law, mean_law, ridge_ladder


@contextmanager
def few_terms() -> Iterator[None]:
    """Emulators look at squares, products and a few powers, and try a part of the penalties and of the folds.

    tests/emulator tests all of them. Whether it stands inside another of its kind makes no difference.
    """
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(mean_law, "MOST_TERMS", 40)
        patch.setattr(ridge_ladder, "FADES_FIRST", (-0.9,))
        patch.setattr(fitting, "FOLDS", 3)
        patch.setattr(fitting, "OUTCOME_FOLDS", 3)
        patch.setattr(law, "INVERSE_PENALTIES", (1e-6, 1e-2, 0.3))
        yield
