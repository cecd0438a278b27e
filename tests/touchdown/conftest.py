"""One small bed for all tests of a process: 24 grains, poured once."""

import pytest

from lithobrake.dem import Material
from lithobrake.touchdown import BedRecipe, ContactModel, GrainSizes, pour_bed

ROCK = Material(young_modulus=1e6, poisson_ratio=0.25, restitution=0.5, friction=0.5, density=2500.0)


def small_recipe(**changes):
    values = {
        "grain_count": 24, "sizes": GrainSizes(distribution="uniform", lower=0.09, upper=0.11), "cloud_point_count": 14,
        "width": (0.36, 0.36), "material": ROCK, "gravity": (0.0, 0.0, -5e-4), "pour_gravity": 0.5, "seed": 6,
        "contact": ContactModel(steps_per_contact=25.0),
    }  # fmt: skip
    return BedRecipe(**{**values, **changes})


@pytest.fixture(scope="session")
def recipe():
    """The recipe of the small bed, with changes."""
    return small_recipe


@pytest.fixture(scope="session")
def bed():
    return pour_bed(small_recipe())
