"""Units of the inputs of runs come from the schema of the study file, those of all that comes out from one table."""

import tomllib
from pathlib import Path

from lithobrake.pipeline import flights
from lithobrake.pipeline.first_bounces import aiming
from lithobrake.pipeline.first_bounces import bounces_to_rest as rest
from lithobrake.pipeline.runs.run_table import PLAIN_COLUMNS
from lithobrake.study import check_tables
from lithobrake.study.template import template
from lithobrake.study.touchdown_model import draw, medians
from lithobrake.study.units import input_units, run_units
from lithobrake.touchdown import OUTPUTS as OUTPUTS_OF_A_TOUCHDOWN
from lithobrake.vocabulary.quantities import BEDS, FLIGHT, OUTPUTS, PERIODS_TRAVELLED, RUN, TO_REST, TOUCHDOWN, quantity


def test_every_input_of_a_run_has_its_unit() -> None:
    study = check_tables(tomllib.loads(template()), Path())
    inputs, units = draw(study, medians(study), 1), input_units()
    # The number of the bed that a run draws counts nothing.
    assert set(inputs) - set(units) == {"bed"}
    assert (units["grain.young_modulus"], units["grain.friction"], units["impact.incidence_deg"]) == ("Pa", "-", "deg")
    assert (units["lander.surface_energy"], units["impact.place.x"], units["surface.gravity"]) == ("J/m2", "m", "m/s2")


def test_every_output_has_its_unit() -> None:
    assert {*OUTPUTS, *OUTPUTS_OF_A_TOUCHDOWN, *TO_REST, PERIODS_TRAVELLED} == set(TOUCHDOWN)
    assert all(run_units()[name] and one.long_name for name, one in TOUCHDOWN.items())
    assert run_units()["peak_acceleration"] == "m/s2"


def test_every_column_of_the_tables_has_words() -> None:
    assert set(PLAIN_COLUMNS) <= set(RUN)
    own = {name for name in (*flights.COLUMNS, *rest.COLUMNS, *aiming.COLUMNS) if not name.startswith("site_")}
    assert own == set(FLIGHT)
    assert all(one.long_name for one in (FLIGHT | RUN | BEDS).values())
    # A name that ends with its unit has that unit.
    assert all(one.units == name.rpartition("_")[2] for name, one in FLIGHT.items() if name.endswith(("_s", "_deg")))


def test_columns_of_the_study_file_have_its_units_and_own_names_have_none() -> None:
    units = input_units()
    assert quantity("site_spin_period", FLIGHT, units) == ("s", "spin period of the sample", "", "")
    assert quantity("grain.young_modulus", TOUCHDOWN, units)[:2] == ("Pa", "grain, young modulus")
    assert quantity("grain.friction", TOUCHDOWN, units).units == ""
    # What a program of the user's own calls gravity need not be that of a bed.
    assert quantity("gravity", TOUCHDOWN, units) == ("", "gravity", "", "")
