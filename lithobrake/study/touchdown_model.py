"""One touchdown as a model: from the numbers of the study file, by dotted key, to what came out."""

import math
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from lithobrake import __version__
from lithobrake.files.reading import source_hash
from lithobrake.geometry.attitude import pointed
from lithobrake.study import Study
from lithobrake.study.ground_sections import Constant, PowerLaw
from lithobrake.study.lander_section import LanderSection, PartSection
from lithobrake.study.quantity import median
from lithobrake.vocabulary.callbacks import Progress, silent
from lithobrake.vocabulary.material_properties import PROPERTIES, SURFACE_PROPERTIES
from lithobrake.vocabulary.quantities import IMPACT_AZIMUTH, IMPACT_INCIDENCE, IMPACT_SPEED, ORIENTATION

if TYPE_CHECKING:
    from lithobrake.dem import Box, ConvexHull, Material, Part, Sphere
    from lithobrake.study.ground_sections import Bell, Between
    from lithobrake.touchdown import Bed, Boulders, ContactModel, GrainSizes, Lander, Landing, Outcome
    from lithobrake.vocabulary.array_types import Array

Values = Mapping[str, float]
PLACE = ("impact.place.x", "impact.place.y")
# Height of the lowest hop that leaves the bed, in largest diameters of the lander, where the study says nothing.
HOP_PER_LANDER = 3.0
TIME_LEFT = "journey.time_left"
# What the engine calls things by its own names, and what they are in a study file.
# Replaced one after the other, so longer names stand before those that they begin with.
STUDY_WORDS = {
    "World time_step": "the time step (a contact has contact.steps_per_contact of them)",
    ": make it smaller": ": raise contact.steps_per_contact",
    "positions are no longer finite numbers": "positions are no longer finite numbers; raise contact.steps_per_contact",
    "World period is": 'bed.width with bed.sides = "periodic" is',
    "BedRecipe.gravity": "surface.gravity with surface.slope_deg",
    "BedRecipe.boulders.": "bed.boulders.",
    "BedRecipe.": "bed.",
    "Landing.incidence": "impact.incidence_deg, in radians,",
    "Landing.azimuth": "impact.azimuth_deg, in radians,",
    "Landing.gravity": "surface.gravity",
    "Landing.time_limit": "landing.time_limit",
    "Landing.": "impact.",
    "Lander.": "lander.",
    "add_body ": "lander.",
    "Sphere radius": "half of lander.diameter",
    "Box lengths": "lander.edges",
}
# Where the code stands that decides what a touchdown gives.
# Workers of a cluster may have another version, and results of other code are other results: the hash is part of the
# keys of beds and runs, and each call compares it.
ENGINE_PARTS = (
    "dem",
    "touchdown",
    "geometry/bed_limits.py",
    "geometry/mesh.py",
    "geometry/mesh_files.py",
    "study/touchdown_model.py",
    "vocabulary/material_properties.py",
)
# In all beds that a process keeps: 1000 take 13 MB. Each run takes another bed, and reading one takes longer than to
# land on it.
GRAINS_KEPT = 40_000
_beds: dict[tuple[Path, int, int], "Bed"] = {}


def main_shape(section: LanderSection, values: Mapping[str, float]) -> "Sphere | Box | ConvexHull":
    """The shape of the lander without its parts; values: of the study by dotted key."""
    from lithobrake.dem import Box, Sphere
    from lithobrake.touchdown import read_hull

    if section.edges is not None:
        return Box(section.edges)
    if section.file is not None:
        return read_hull(Path(section.file), section.unit)
    return Sphere(values["lander.diameter"] / 2)


def part_shape(section: PartSection) -> "Sphere | ConvexHull":
    from lithobrake.dem import Box, ConvexHull, Sphere, rotation_matrices
    from lithobrake.touchdown import read_hull

    if section.diameter is not None:
        return Sphere(section.diameter / 2, section.centre)
    own = Box(section.edges) if section.edges is not None else read_hull(Path(str(section.file)), section.unit)
    turn = np.array(section.orientation)
    rotation = rotation_matrices((turn / np.linalg.norm(turn))[None])[0]
    return ConvexHull(own.vertices @ rotation.T + np.array(section.centre))


def lander_parts(
    section: LanderSection, values: Mapping[str, float], properties: Mapping[str, float]
) -> "tuple[Part, ...]":
    """The parts of the lander; properties: of its own material, which a part has unless others are given."""
    from lithobrake.dem import Material, Part

    parts = []
    for name, part in section.part.items():
        shape = part_shape(part)
        density = part.density if part.mass is None else part.mass / shape.volume
        own: dict[str, Any] = {key: values.get(f"lander.part.{name}.{key}", value) for key, value in properties.items()}
        parts.append(Part(shape, Material(density=float(density or 0.0), **own)))
    return tuple(parts)


def given_centre(section: LanderSection, values: Mapping[str, float]) -> "Array | None":
    """The centre of mass [m], [3], where the study gives it."""
    if section.centre_of_mass is None:
        return None
    return np.array([values[f"lander.centre_of_mass.{axis}"] for axis in "xyz"])


def given_inertia(section: LanderSection) -> "Array | None":
    """The inertia [kg m2], [3, 3], where the study gives it."""
    if section.inertia is None:
        return None
    tensor = np.diag(section.inertia[:3])
    if len(section.inertia) == 6:
        for (i, j), element in zip(((0, 1), (0, 2), (1, 2)), section.inertia[3:], strict=True):
            tensor[i, j] = tensor[j, i] = element
    return tensor


def medians(study: Study) -> dict[str, float]:
    """Every scalar that the touchdown reads, uncertain ones at their median, by dotted key, in the file's units."""
    return {name: median(value) for name, value in study.touchdown_values().items()}


@dataclass(frozen=True)
class TouchdownModel:
    """A touchdown of a study, for any process: called with all its numbers, drawn ones included, it lands once.

    engine: hash of the code that decides what a touchdown gives, where the study is coordinated.
    """

    study: Study
    bed_paths: tuple[Path, ...]
    engine: str

    def __call__(self, values: dict[str, float], seed: int) -> dict[str, Any]:
        """Land once and say the outcome and the outputs [SI]. Raises ValueError where the code is another one."""
        outcome = self.land(values)
        return {"outcome": outcome.status, "outputs": outcome.outputs}

    def land(
        self,
        values: Mapping[str, float],
        frame_count: int = 0,
        progress: Progress = silent,
    ) -> "Outcome":
        """Land once, and record about so many frames. Raises ValueError where the code is another one."""
        from lithobrake.touchdown import land

        refuse_other_code(self.engine)
        bed = stored_bed(self.bed_paths[round(values["bed"])])
        with in_words_of_the_study():
            return land(bed, lander(self.study, values), landing(self.study, values), frame_count, progress)


@contextmanager
def in_words_of_the_study() -> Iterator[None]:
    """Say what the engine refuses by the keys of the study file, which is all that its user has written."""
    try:
        yield
    except (ValueError, FloatingPointError) as error:
        text = str(error)
        for engine, study in STUDY_WORDS.items():
            text = text.replace(engine, study)
        # Either may be a kind of its own that takes no text.
        raise (ValueError if isinstance(error, ValueError) else FloatingPointError)(text) from error


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


def stored_bed(path: Path) -> "Bed":
    """Read a bed, once for all runs of a process as long as the file stays the same and there is room for it."""
    from lithobrake.touchdown import Bed

    status = path.stat()
    key = path, status.st_mtime_ns, status.st_size
    # The last is the one that was used last.
    _beds[key] = bed = _beds.pop(key, None) or Bed.load(path)
    while len(_beds) > 1 and sum(len(one.grains) for one in _beds.values()) > GRAINS_KEPT:
        del _beds[next(iter(_beds))]
    return bed


def draw(
    study: Study, values: Values, seed: int, region: tuple[tuple[float, float], tuple[float, float]] | None
) -> dict[str, float]:
    """The values of a run with what it draws by chance, or is given in its place.

    region: ends of x and y between which impact points are drawn [m]; None: the point is given.

    bed: number of the bed; impact.place.x and .y [m], impact.azimuth_deg, impact.orientation.w to .z. All are drawn,
    whether used or not, so that each has the same random numbers in every study. A run takes the bed with the largest
    number of its own: one more bed takes its part of the runs over, and all others stay on theirs (rendezvous hashing).

    Source: [Thaler-1998].
    """
    # A stream of its own, as the number of beds decides how much is taken from it: the other draws stay as they are.
    bed = int(np.argmax(np.random.Generator(np.random.PCG64([seed, 1])).random(study.bed_count)))
    generator = np.random.Generator(np.random.PCG64(seed))
    fractions, turn = generator.random(2), generator.random()
    # Four normal numbers point evenly over the unit quaternions.
    quaternion = generator.standard_normal(4)
    impact = study.impact
    if region is None:
        place = [values[name] for name in PLACE]
    else:
        place = [low + part * (high - low) for part, (low, high) in zip(fractions.tolist(), region, strict=True)]
    azimuth = 360 * turn if impact.azimuth_deg == "random" else values[IMPACT_AZIMUTH]
    if impact.orientation != "random":
        quaternion = given_attitude(study, *generator.random(2).tolist())
    orientation = (quaternion / np.linalg.norm(quaternion)).tolist()
    return {
        **values,
        "bed": float(bed),
        **dict(zip(PLACE, place, strict=True)),
        IMPACT_AZIMUTH: float(azimuth),
        **dict(zip(ORIENTATION, orientation, strict=True)),
    }


def given_attitude(study: Study, distance: float, direction: float) -> np.ndarray:
    """The attitude that the study gives, off by its error of pointing as two uniform numbers say."""
    orientation = np.array(study.impact.orientation)
    if study.impact.pointing_error_deg is None:
        return orientation
    return pointed(orientation, math.radians(study.impact.pointing_error_deg), distance, direction)


def contact(study: Study) -> "ContactModel":
    from lithobrake.touchdown import ContactModel

    return ContactModel(**study.contact.model_dump())


def grain_sizes(study: Study) -> "GrainSizes":
    return sizes_of(study.bed.diameter)


def boulders(study: Study) -> "Boulders | None":
    from lithobrake.touchdown import Boulders

    section = study.bed.boulders
    if section is None:
        return None
    return Boulders(sizes=sizes_of(section.diameter), coverage=section.coverage, cover=section.cover)


def sizes_of(sizes: "Constant | Between | Bell | PowerLaw") -> "GrainSizes":
    from lithobrake.touchdown import GrainSizes

    if isinstance(sizes, Constant):
        return GrainSizes(distribution="constant", lower=sizes.value, upper=sizes.value)
    if isinstance(sizes, PowerLaw):
        exponent = sizes.differential_exponent
        return GrainSizes(distribution="power_law", lower=sizes.lower, upper=sizes.upper, exponent=exponent)
    return GrainSizes(**sizes.model_dump())


def grain(values: Values) -> "Material":
    from lithobrake.dem import Material

    properties: dict[str, Any] = {name: values[f"grain.{name}"] for name in PROPERTIES}
    return Material(**properties)


def lander(study: Study, values: Values) -> "Lander":
    """The lander; what is not said about its material is that of the grains, and of a part that of the lander."""
    from lithobrake.dem import Material
    from lithobrake.touchdown import Lander

    section = study.lander
    shape = main_shape(section, values)
    properties: dict[str, Any] = {
        name: values.get(f"lander.{name}", values[f"grain.{name}"]) for name in SURFACE_PROPERTIES
    }
    # The density of the material plays no part: the mass is given.
    material = Material(density=values["lander.mass"] / shape.volume, **properties)
    return Lander(
        shape=shape, mass=values["lander.mass"], material=material, inertia=given_inertia(section),
        parts=lander_parts(section, values, properties), centre_of_mass=given_centre(section, values),
    )  # fmt: skip


def landing(study: Study, values: Values) -> "Landing":
    """How the lander arrives, on which soil, under which acceleration; values with what was drawn."""
    from lithobrake.touchdown import Landing

    w, x, y, z = (values[name] for name in ORIENTATION)
    return Landing(
        grain=grain(values),
        speed=values[IMPACT_SPEED],
        incidence=math.radians(values[IMPACT_INCIDENCE]),
        azimuth=math.radians(values[IMPACT_AZIMUTH]),
        place=(values[PLACE[0]], values[PLACE[1]]),
        orientation=(w, x, y, z),
        spin=(values["impact.spin_x"], values["impact.spin_y"], values["impact.spin_z"]),
        gravity=acceleration(values, values["surface.gravity"]),
        # What is left of a journey.
        time_limit=min(values.get(TIME_LEFT, study.journey.duration), study.landing.time_limit or math.inf),
        hop_height=hop_height(study, values),
        contact=contact(study),
    )


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
