"""Emulators of studies whose tests do not look at what emulators are worth: they choose among less."""

from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from lithobrake.emulator import fitting, form_choice, law, mean_law, ridge_ladder
from lithobrake.pipeline import site_arrivals, site_grid
from lithobrake.pipeline.answer import emulated_ends, journey_limit_states, option_answers, question_answers
from lithobrake.pipeline.commands import emulator_job, requirement, site_maps
from lithobrake.pipeline.expansion import expansion_samples
from lithobrake.pipeline.first_touchdown import emulator
from lithobrake.pipeline.journeys import (
    delivered_landers,
    delivery_options,
    emulated_journeys,
    first_arrivals,
    touchdown_emulator,
)

# Refits of an emulator, where studies have fifty.
REFITS = 20
WITH_REFITS = (
    site_grid, emulated_ends, question_answers, option_answers, journey_limit_states, site_maps, expansion_samples,
    emulator, delivery_options, first_arrivals, touchdown_emulator, delivered_landers, site_arrivals,
    requirement, emulator_job,
)  # fmt: skip


@contextmanager
def few_terms() -> Iterator[None]:
    """Emulators look at few products and powers, try a part of the penalties and of the folds, average few rungs and
    are refitted a few times; they follow each lander of the journeys a few times.

    tests/emulator tests all of them. Whether it stands inside another of its kind makes no difference.
    """
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(mean_law, "MOST_TERMS", 24)
        patch.setattr(ridge_ladder, "PENALTIES", (1e-4, 1e-2, 0.3))
        patch.setattr(ridge_ladder, "LEAST_WEIGHT", 0.03)
        patch.setattr(ridge_ladder, "FADES_FIRST", (-0.9,))
        patch.setattr(fitting, "FOLDS", 3)
        patch.setattr(fitting, "OUTCOME_FOLDS", 2)
        for module in (emulated_journeys, emulated_ends):
            patch.setattr(module, "COPIES", 6)
        patch.setattr(law, "INVERSE_PENALTIES", (1e-4, 0.1))
        for module in WITH_REFITS:
            patch.setattr(module, "REFIT_COUNT", REFITS)
        yield


@contextmanager
def fewest_terms() -> Iterator[None]:
    """Emulators of studies whose tests ask only that there is one choose among next to nothing and follow each lander
    twice.
    """
    with few_terms(), pytest.MonkeyPatch.context() as patch:
        patch.setattr(mean_law, "MOST_TERMS", 8)
        patch.setattr(ridge_ladder, "PENALTIES", (1e-2,))
        patch.setattr(form_choice, "MOST_FOLDS", 2)
        patch.setattr(fitting, "FOLDS", 2)
        patch.setattr(law, "INVERSE_PENALTIES", (1e-2,))
        for module in (emulated_journeys, emulated_ends):
            patch.setattr(module, "COPIES", 2)
        for module in WITH_REFITS:
            patch.setattr(module, "REFIT_COUNT", REFITS // 2)
        yield
