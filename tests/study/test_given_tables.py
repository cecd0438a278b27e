"""A study of tables that a program made: their types are those of a study file, or can be turned into these."""

import tomllib
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lithobrake.study import StudySource
from lithobrake.study.template import template

TABLES = tomllib.loads(template())


def tables(section: str, **keys: Any) -> dict[str, Any]:
    return TABLES | {section: TABLES[section] | keys}


def test_scalars_and_arrays_of_numpy_are_numbers() -> None:
    given = tables("lander", mass=np.float32(2.5), edges=np.array([0.1, 0.1, 0.25]), restitution=np.longdouble(0.5))
    given |= {"seed": np.int64(7), "bed": TABLES["bed"] | {"width": (np.float64(0.6), 1)}}
    source = StudySource.of_tables(given)
    lander = source.study.lander
    assert (lander.mass, lander.edges, lander.restitution, source.study.seed) == (2.5, (0.1, 0.1, 0.25), 0.5, 7)
    # What the folder keeps is a study file that says the same.
    assert StudySource.of_tables(tomllib.loads(source.content.decode())).study == source.study
    assert isinstance(StudySource.of_tables(tables("site", partner=np.bool_(True))).study.site.partner, bool)


def test_a_path_is_text(tmp_path: Path) -> None:
    given = tables("lander", shape="hull", file=tmp_path / "absent.obj")
    del given["lander"]["edges"]
    with pytest.raises(ValueError, match=r"lander\.file is .*absent\.obj.; no such file"):
        StudySource.of_tables(given)


LOOP: dict[str, Any] = {}
LOOP["loop"] = LOOP


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (tables("lander", mass=Decimal(1)), "lander.mass is 1, of the type Decimal; allowed: numbers, text"),
        (tables("lander", mass=Fraction(1, 2)), "lander.mass is 1/2, of the type Fraction"),
        (tables("lander", mass=1j), "lander.mass is 1j, of the type complex"),
        (tables("lander", mass=None), "lander.mass is None, of the type NoneType"),
        (tables("lander", edges=[0.1, 0.1, b"x"]), "lander.edges.2 is b'x', of the type bytes"),
        (tables("lander", mass=np.ma.masked), "lander.mass is"),
        (TABLES | {"title": b"x"}, "title is b'x', of the type bytes"),
        (TABLES | {"title": "a\ud800"}, 'title is "a\\ud800", which UTF-8 cannot hold'),
        (TABLES | {3: {}}, "the study has the key 3; allowed: names in text"),
        (TABLES | {"limit_states": {"a\ud800": "stays"}}, 'a key of limit_states is "a\\ud800"'),
        (TABLES | {"lander": {3: 1}}, "lander has the key 3"),
        (TABLES | {"lander": LOOP}, "is nested too deeply"),
    ],
)
def test_a_value_of_another_type_is_refused_by_its_key_and_type(given: Any, words: str) -> None:
    with pytest.raises(ValueError, match=r"^study\.toml: [^\n]*$") as refused:
        StudySource.of_tables(given)
    assert words in str(refused.value)
    str(refused.value).encode()
