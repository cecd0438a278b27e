"""Two small beds for all tests of a process, poured once: 24 grains in a box, 48 on ground that repeats."""

import pytest

from lithobrake.touchdown import BedRecipe, ContactModel, GrainSizes, pour_bed

from .landings import ROCK


def small_recipe(**changes):
    values = {
        "grain_count": 24, "sizes": GrainSizes(distribution="uniform", lower=0.09, upper=0.11), "cloud_point_count": 14,
        "width": (0.36, 0.36), "material": ROCK, "gravity": (0.0, 0.0, -5e-4), "pour_gravity": 0.5, "seed": 6,
        "contact": ContactModel(steps_per_contact=25.0),
    }  # fmt: skip
    return BedRecipe(**{**values, **changes})


@pytest.fixture(scope="session")
def recipe():
    return small_recipe


@pytest.fixture(scope="session")
def bed():
    return pour_bed(small_recipe())


@pytest.fixture(scope="session")
def ground():
    return pour_bed(small_recipe(sides="periodic", width=(0.52, 0.56), grain_count=48))
