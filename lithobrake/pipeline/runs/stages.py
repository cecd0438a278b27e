"""The stages of beds and landings."""

from typing import Any

from lithobrake.pipeline.design.dependencies import bed_dependencies, bed_files, design_dependencies
from lithobrake.pipeline.design.drawn_design import SIDE_DESIGNS, beds_of_runs
from lithobrake.pipeline.design.place_region import place_region
from lithobrake.pipeline.runs.beds import pour_beds
from lithobrake.pipeline.runs.making_runs import make_drawn_runs, make_side_runs
from lithobrake.pipeline.runs.run_table import file_of
from lithobrake.pipeline.runs.shown_landing import (
    land_once,
    land_tellingly,
    landing_dependencies,
    landing_files,
    telling_files,
)
from lithobrake.pipeline.stage import Stage, same_files
from lithobrake.study import Study

# Beds and landings are known by the hash of the engine and of all that they follow from; this is how they are chosen
# and written down.
PARTS = (
    "pipeline/design",
    "pipeline/runs/energy_bound.py",
    "pipeline/runs/making_runs.py",
    "pipeline/runs/run_table.py",
    "pipeline/runs/touchdown_runs.py",
    "chaos",
    "vocabulary/quantities.py",
    "geometry/attitude.py",
)


def drawn_dependencies(study: Study) -> Any:
    """What the drawn runs depend on."""
    count = study.design.run_count
    return [design_dependencies(study), place_region(study), study.seed, count, beds_of_runs(study, count)]


def _side_files(study: Study) -> list[str]:
    return [file_of(design) for design in SIDE_DESIGNS] if study.design.side_runs else []


BED = Stage("bed", "bed", bed_files, pour_beds, dependencies=bed_dependencies)
FIRST_LANDING = Stage("landing", "preview landing", landing_files, land_once, ("bed",), landing_dependencies)
DRAWN_RUNS = Stage("runs", "runs", same_files(file_of("drawn")), make_drawn_runs, ("bed",), drawn_dependencies, PARTS)
SIDE_RUNS = Stage(
    "side_runs",
    "side runs",
    _side_files,
    make_side_runs,
    ("runs",),
    lambda study: [study.design.side_runs, study.design.twin_shift],
    PARTS,
)
TELLING_LANDING = Stage("telling_landing", "representative landing", telling_files, land_tellingly, ("runs",))
