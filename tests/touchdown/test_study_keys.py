"""What the engine refuses, as a user of a study reads it."""

import inspect
import math
import pickle

import pytest

from lithobrake import dem, touchdown
from lithobrake.study import known_keys
from lithobrake.touchdown.study_keys import STUDY_KEYS, by_study_keys
from lithobrake.vocabulary.field_errors import FieldError


@pytest.mark.parametrize(("raised", "said"), [
    (FieldError("World.time_step", 1e-3, "is at most 5e-4 s", "make it smaller", "s"),
     "the time step of contact.steps_per_contact is 0.001 s; allowed is at most 5e-4 s: raise "
     "contact.steps_per_contact"),
    (FieldError("Landing.speed", 0.0, "is a finite value above 0 m/s"),
     "impact.speed is 0.0; allowed is a finite value above 0 m/s: change it"),
    (FieldError("Landing.incidence", math.pi, "is 0 <= value < pi/2 rad"),
     "impact.incidence_deg is 180.0 degrees; allowed is 0 <= value < 90 degrees: change it"),
    (FieldError("Sphere.radius", -0.1, "is a finite value above 0", unit="m"),
     "lander.diameter is -0.2 m; allowed is a finite value above 0: change it"),
    (FieldError("Landing.hop_height", 0.0, "is a finite height above 0 m"),
     "journey.hop_height is 0.0; allowed is a finite height above 0 m: change it"),
    (FieldError("World.run duration", -1.0, "is a finite value of at least 0", unit="s"),
     "World.run duration is -1.0 s; allowed is a finite value of at least 0: change it"),
])  # fmt: skip
def test_a_refused_field_is_named_by_its_key_in_the_study(raised: FieldError, said: str) -> None:
    # As a worker hands it over.
    with pytest.raises(FieldError) as caught, by_study_keys():
        raise pickle.loads(pickle.dumps(raised))
    assert str(caught.value) == said


@pytest.mark.parametrize("field", STUDY_KEYS)
def test_a_field_with_a_key_is_one_of_the_engine(field: str) -> None:
    owner, _, name = field.rpartition(" " if " " in field else ".")
    methods = {"add_body": dem.World.add_body, "World.run_locally": dem.World.run_locally}
    one = methods[owner] if owner in methods else getattr(touchdown if hasattr(touchdown, owner) else dem, owner)
    assert name in inspect.signature(one).parameters


def test_the_keys_of_fields_are_those_of_the_study_file() -> None:
    known = {f"{table}.{name}" for table, names in known_keys().items() for name in names}
    named = [word.strip("[],") for key in STUDY_KEYS.values() for word in key.name.split() if "." in word]
    assert set(named) <= known
