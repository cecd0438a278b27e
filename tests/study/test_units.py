"""Units of the inputs of runs come from the schema of the study file, those of outputs from one table."""

import tomllib
from pathlib import Path

from lithobrake.outputs import OUTPUTS
from lithobrake.study import check_tables
from lithobrake.study.template import template
from lithobrake.study.units import OUTPUT_UNITS, input_units
from lithobrake.touchdown import OUTPUTS as OUTPUTS_OF_A_TOUCHDOWN
from lithobrake.touchdown_model import draw, medians


def test_every_input_of_a_run_has_its_unit() -> None:
    study = check_tables(tomllib.loads(template()), Path())
    inputs, units = draw(study, medians(study), 1), input_units()
    # The number of the bed that a run draws counts nothing.
    assert set(inputs) - set(units) == {"bed"}
    assert (units["grain.young_modulus"], units["grain.friction"], units["impact.incidence_deg"]) == ("Pa", "-", "deg")
    assert (units["lander.surface_energy"], units["impact.place.x"], units["surface.gravity"]) == ("J/m2", "m", "m/s2")


def test_every_output_has_its_unit() -> None:
    assert {*OUTPUTS, *OUTPUTS_OF_A_TOUCHDOWN} == set(OUTPUT_UNITS)
