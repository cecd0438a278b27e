"""What the explorer of one touchdown evaluates: the refits of the emulator of all touchdowns as tables."""

from dataclasses import replace

import numpy as np

from lithobrake.files.atomic import atomic_path
from lithobrake.geometry.attitude_terms import AttitudeTerms
from lithobrake.pipeline.design.lander_attitude import PREFIX
from lithobrake.pipeline.emulate.explorer_tables import save_explorer, tables_of_refits
from lithobrake.pipeline.emulated.touchdown_emulator import TouchdownEmulator
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.energy_bound import bound_numbers
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.results.explorer_tables import ExplorerAttitude
from lithobrake.study import Study
from lithobrake.study.lander_sides import directions_of_sides, side_words
from lithobrake.vocabulary.quantities import JOURNEY_DESIGN, SPIN

FILE = "touchdown_explorer.h5"


def write_explorer(job: Job, emulator: TouchdownEmulator) -> None:
    """Write touchdown_explorer.h5, of the refits that landers follow."""
    runs = DesignRuns.load(job.folder, JOURNEY_DESIGN)
    # Only the size of the spin counts for the energy: an arrival without one of its own has that of the median.
    spin = np.linalg.norm([runs.inputs[name] for name in SPIN], axis=0)
    bound = {
        **bound_numbers(job.design, emulator.bed_height),
        **dict(zip(SPIN, (float(np.median(spin)), 0.0, 0.0), strict=True)),
        "across": emulator.across,
        "time_limit": 0.0,
    }
    tables = tables_of_refits(emulator.refits, bound)
    save_explorer(job.folder / FILE, replace(tables, attitude=_attitude(job.study, emulator.terms)))


def _attitude(study: Study, terms: AttitudeTerms | None) -> ExplorerAttitude | None:
    """What draws attitudes in the explorer."""
    if terms is None:
        return None
    names = tuple(f"{PREFIX}{name}" for name in terms.ranges)
    sides = {side_words(study.lander, side): downs for side, downs in directions_of_sides(study.lander).items()}
    return ExplorerAttitude(names, terms.axes.tolist(), terms.has_sides, terms.is_cube, sides)


def write_reason(job: Job, why: str) -> None:
    """Write touchdown_explorer.h5 of a study without an emulator: the reason alone."""
    import h5py

    with atomic_path(job.folder / FILE) as draft, h5py.File(draft, "w") as file:
        file.attrs["why"] = why
