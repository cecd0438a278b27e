"""One touchdown of a study: from its numbers, by dotted key in the units of the study file, to what came out [SI]."""

import math
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from lithobrake import __version__, touchdown
from lithobrake.files.reading import source_hash
from lithobrake.study import Study
from lithobrake.touchdown.lander_model import lander
from lithobrake.touchdown.soil import Values, grain
from lithobrake.touchdown.study_keys import by_study_keys
from lithobrake.vocabulary.callbacks import Progress, silent
from lithobrake.vocabulary.quantities import (
    IMPACT_AZIMUTH,
    IMPACT_INCIDENCE,
    IMPACT_SPEED,
    ORIENTATION,
    PLACE,
    ROTATION,
    SPIN,
    TIME_LEFT,
)

# Height of the lowest hop that leaves the bed, in largest diameters of the lander, where the study says nothing.
HOP_PER_LANDER = 3.0
# Where the code stands that decides what a touchdown gives.
# Workers of a cluster may have another version, and results of other code are other results: the hash is part of the
# keys of beds and runs, and each call compares it.
ENGINE_PARTS = (
    "dem",
    "touchdown",
    "geometry/bed_limits.py",
    "geometry/mesh.py",
    "geometry/mesh_files.py",
    "vocabulary/material_properties.py",
)
# In all beds that a process keeps: 1000 take 13 MB. Each run takes another bed, and reading one takes longer than to
# land on it.
GRAINS_KEPT = 40_000
_beds: dict[tuple[Path, int, int], "touchdown.Bed"] = {}


@dataclass(frozen=True)
class TouchdownModel:
    """A touchdown of a study, for any process: called with all its numbers, drawn ones included, it lands once.

    engine: hash of the code that decides what a touchdown gives, where the study is coordinated.
    """

    study: Study
    bed_paths: tuple[Path, ...]
    engine: str

    def __call__(self, values: Values, seed: int) -> dict[str, Any]:
        """Land once and give the outcome and the outputs [SI]. Raises ValueError where the code is another one."""
        outcome = self.land(values)
        return {"outcome": outcome.status, "outputs": outcome.outputs}

    def land(
        self,
        values: Values,
        frame_count: int = 0,
        progress: Progress = silent,
    ) -> "touchdown.Outcome":
        """Land once, and record about so many frames. Raises ValueError where the code is another one."""
        refuse_other_code(self.engine)
        bed = stored_bed(self.bed_paths[round(values["bed"])])
        with by_study_keys():
            body, arrival = lander(self.study, values), landing(self.study, values)
            return touchdown.land(bed, body, arrival, frame_count, progress)


@cache
def engine_hash() -> str:
    return source_hash(*ENGINE_PARTS)


def refuse_other_code(engine: str) -> None:
    """Raise ValueError where the code of this process is not that of the coordinator, whose hash `engine` is."""
    if engine_hash() != engine:
        raise ValueError(
            f"this worker has the code {engine_hash()} and the coordinator {engine}; install the same version of "
            "lithobrake on both"
        )


def touchdown_version() -> str:
    """The version of the package and of the code that decides what a touchdown gives, as the ledger keeps it."""
    return f"{__version__}+{engine_hash()}"


def stored_bed(path: Path) -> "touchdown.Bed":
    """Read a bed, once for all runs of a process as long as the file stays the same and there is room for it."""
    status = path.stat()
    key = path, status.st_mtime_ns, status.st_size
    # The last is the one that was used last.
    _beds[key] = bed = _beds.pop(key, None) or touchdown.Bed.load(path)
    while len(_beds) > 1 and sum(len(one.grains) for one in _beds.values()) > GRAINS_KEPT:
        del _beds[next(iter(_beds))]
    return bed


def landing(study: Study, values: Values) -> "touchdown.Landing":
    """How the lander arrives, on which soil, under which acceleration; values with what was drawn."""
    w, x, y, z = (values[name] for name in ORIENTATION)
    spin_x, spin_y, spin_z = (values[name] for name in SPIN)
    turn_x, turn_y, turn_z = (values[name] for name in ROTATION)
    return touchdown.Landing(
        grain=grain(values),
        speed=values[IMPACT_SPEED],
        incidence=math.radians(values[IMPACT_INCIDENCE]),
        azimuth=math.radians(values[IMPACT_AZIMUTH]),
        place=(values[PLACE[0]], values[PLACE[1]]),
        orientation=(w, x, y, z),
        spin=(spin_x, spin_y, spin_z),
        gravity=acceleration(values, values["surface.gravity"]),
        rotation=(turn_x, turn_y, turn_z),
        # What is left of a journey.
        time_limit=min(values.get(TIME_LEFT, study.journey.duration), study.landing.time_limit or math.inf),
        hop_height=hop_height(study, values),
        contact=contact(study),
    )


def contact(study: Study) -> "touchdown.ContactModel":
    return touchdown.ContactModel(**study.contact.model_dump())


def hop_height(study: Study, values: Values) -> float | None:
    """Height [m] of the lowest hop that leaves the bed; None where every departure from the ground does."""
    given = study.journey.hop_height
    if given is None:
        return HOP_PER_LANDER * 2.0 * lander(study, values).reach
    return given or None


def acceleration(values: Values, size: float) -> tuple[float, float, float]:
    """Acceleration of this size [m/s2] in the bed's frame, tilted as the slope says."""
    slope, downhill = math.radians(values["surface.slope_deg"]), math.radians(values["surface.slope_azimuth_deg"])
    along = size * math.sin(slope)
    return along * math.cos(downhill), along * math.sin(downhill), -size * math.cos(slope)
