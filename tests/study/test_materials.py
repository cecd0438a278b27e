"""A property of a material stands in one table; study file, labels and law have it from there."""

from pathlib import Path

import pytest

import lithobrake
from lithobrake.dem import Material
from lithobrake.dem.bodies.arrays import Laws
from lithobrake.dem.law.restitution import PairLaw
from lithobrake.statements.labels import INPUT_LABELS
from lithobrake.study.ground_sections import GrainSection, SoilGrainSection
from lithobrake.study.lander_section import LanderSection, PartSection
from lithobrake.study.units import limits
from lithobrake.vocabulary.material_properties import PROPERTIES, SURFACE_PROPERTIES

DEM = Path(lithobrake.__file__).parent / "dem"


@pytest.mark.parametrize("name", PROPERTIES)
def test_each_property_has_unit_and_range_of_the_table_wherever_it_is_a_key(name: str) -> None:
    known, tables = PROPERTIES[name], (GrainSection, SoilGrainSection, LanderSection, PartSection)
    for table in (table for table in tables if name in table.model_fields):
        found = limits(table.model_fields[name])
        assert found is not None
        ends = (found.unit, found.above, found.at_least, found.below, found.at_most)
        assert ends == (known.unit, known.above, known.at_least, known.below, known.at_most)
    assert GrainSection.model_fields[name].is_required() == (known.default is None)
    assert f"grain.{name}" in INPUT_LABELS


@pytest.mark.parametrize("name", PROPERTIES)
def test_the_file_of_the_law_is_there(name: str) -> None:
    assert (DEM / f"{PROPERTIES[name].law}.py").is_file()


def test_landers_and_parts_have_every_property_of_a_surface() -> None:
    for table in (LanderSection, PartSection):
        assert [name for name in table.model_fields if name in SURFACE_PROPERTIES] == list(SURFACE_PROPERTIES)


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("young_modulus", 0.0, "a finite value above 0 Pa"), ("poisson_ratio", 0.5, "0 <= value < 0.5"),
        ("restitution", 1.5, "0 < value <= 1"), ("friction", -0.1, "a finite value of at least 0"),
        ("surface_energy", float("inf"), "a finite value of at least 0 J/m2"),
    ],
)  # fmt: skip
def test_a_material_refuses_what_the_study_file_refuses(name: str, value: float, words: str) -> None:
    given = {key: 0.25 for key, known in PROPERTIES.items() if known.default is None}
    with pytest.raises(ValueError, match=f"Material.{name} is {value!r}; allowed is {words}: change it"):
        Material(**{**given, name: value})


def test_the_law_of_a_pair_is_that_of_all_pairs_in_one_order() -> None:
    assert PairLaw._fields == Laws._fields
