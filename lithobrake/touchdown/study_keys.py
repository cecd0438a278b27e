"""Which keys of the study file give the fields of the engine, for errors that a user of a study reads."""

import math
from collections.abc import Iterator
from contextlib import contextmanager
from typing import NamedTuple

from lithobrake.vocabulary.field_errors import FieldError


class StudyKey(NamedTuple):
    """What a field is called in a study; factor: of its value there; "": unit, allowed range and remedy as they are."""

    name: str
    factor: float | None = None
    unit: str = ""
    allowed: str = ""
    remedy: str = ""


MORE_STEPS = "raise contact.steps_per_contact"
# A contact model has the keys of its table.
CONTACT = ("shear_modulus_rule", "damping_mass", "pair_rule", "steps_per_contact", "stepping", "resolved_speed",
    "held_speed")  # fmt: skip
STUDY_KEYS = {
    "Landing.speed": StudyKey("impact.speed"),
    "Landing.incidence": StudyKey("impact.incidence_deg", math.degrees(1.0), "degrees", "is 0 <= value < 90 degrees"),
    "Landing.azimuth": StudyKey("impact.azimuth_deg", math.degrees(1.0), "degrees"),
    "Landing.place": StudyKey("impact.place"),
    "Landing.orientation": StudyKey("impact.orientation"),
    "Landing.spin": StudyKey("[impact.spin_x, spin_y, spin_z]"),
    "Landing.rotation": StudyKey("[surface.rotation_x, rotation_y, rotation_z]"),
    "Landing.gravity": StudyKey("surface.gravity with surface.slope_deg, as a vector,"),
    "Landing.time_limit": StudyKey("landing.time_limit"),
    "Landing.hop_height": StudyKey("journey.hop_height"),
    "Lander.mass": StudyKey("lander.mass"),
    "Lander.inertia": StudyKey("lander.inertia"),
    "add_body centre_of_mass": StudyKey("lander.centre_of_mass"),
    "Sphere.radius": StudyKey("lander.diameter", 2.0),
    "Box.lengths": StudyKey("lander.edges"),
    "Bed.width": StudyKey("bed.width"),
    "BedRecipe.grain_count": StudyKey("bed.grain_count"),
    "BedRecipe.cloud_point_count": StudyKey("bed.cloud_point_count"),
    "BedRecipe.width": StudyKey("bed.width"),
    "BedRecipe.sides": StudyKey("bed.sides"),
    "BedRecipe.gravity": StudyKey("bed.settle_gravity, or surface.gravity, with surface.slope_deg, as a vector,"),
    "BedRecipe.pour_gravity": StudyKey("bed.pour_gravity"),
    "Boulders.coverage": StudyKey("bed.boulders.coverage"),
    "Boulders.cover": StudyKey("bed.boulders.cover"),
    **{
        f"GrainSizes.{name}": StudyKey(f"{name} of bed.diameter, or of bed.boulders.diameter,")
        for name in ("distribution", "lower", "mean", "exponent")
    },
    "World.gravity": StudyKey("surface.gravity with surface.slope_deg, as a vector,"),
    "World.period": StudyKey(
        'bed.width with bed.sides = "periodic"', remedy="widen the bed, or take smaller grains or a smaller lander"
    ),
    "World.time_step": StudyKey("the time step of contact.steps_per_contact", remedy=MORE_STEPS),
    "World.run_locally steps_per_contact": StudyKey("contact.steps_per_contact", remedy="raise it"),
    **{f"ContactModel.{name}": StudyKey(f"contact.{name}") for name in CONTACT},
}


@contextmanager
def by_study_keys() -> Iterator[None]:
    """Name what the engine refuses by the keys of the study file, which is all that its user has written."""
    try:
        yield
    except FieldError as error:
        key = STUDY_KEYS.get(error.field)
        if key is None:
            raise
        value = error.value if key.factor is None else error.value * key.factor
        raise FieldError(
            key.name, value, key.allowed or error.allowed, key.remedy or error.remedy, key.unit or error.unit
        ) from error
