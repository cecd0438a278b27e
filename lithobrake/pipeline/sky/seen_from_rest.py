"""What each lander at rest sees of the Sun and of Earth over a day of the body, and which of its sides face them."""

from typing import TYPE_CHECKING, Any

import numpy as np

from lithobrake.files.hashing import hashed_seed
from lithobrake.files.reading import read_rows
from lithobrake.pipeline.fly.flights import write_table
from lithobrake.pipeline.folder.study_folder import AGAIN
from lithobrake.pipeline.job import Job
from lithobrake.study import Study
from lithobrake.study.lander_sides import SIDES
from lithobrake.study.quantity import Scalar, Uncertain
from lithobrake.vocabulary.outcomes import JourneyEnd
from lithobrake.vocabulary.quantities import JOURNEYS_FILE, SKY, SKY_FILE

if TYPE_CHECKING:
    from lithobrake.smallbody import Shape

# Outward, by the lander's own axes, in the order of SIDES.
NORMALS = np.array([sign * np.eye(3)[axis] for axis in range(3) for sign in (1.0, -1.0)])


def sky_files(study: Study) -> list[str]:
    """What the stage writes: nothing where the study does not ask for the sky."""
    return [SKY_FILE] if study.sky.bodies else []


def sky_dependencies(study: Study) -> Any:
    """What of the study the stage depends on, beside the journeys."""
    return study.sky.model_dump(mode="json")


def look_up(job: Job) -> None:
    """Write sky.csv, a row for each body far away and lander at rest."""
    sky, journeys = job.study.sky, _at_rest(job)
    rows = [
        row
        for name, latitude in sky.bodies.items()
        for row in _rows(job.site.body.shape, journeys, name, _latitudes(job, name, latitude), sky.mask_of(name))
    ]
    write_table(job.folder, SKY_FILE, tuple(SKY), rows, SKY)


def _at_rest(job: Job) -> list[dict[str, float]]:
    """Number, place and attitude of each lander at rest; NaN where it has no attitude."""
    names = ("journey", *(f"position_{axis}" for axis in "xyz"), *(f"attitude_{part}" for part in "wxyz"))
    rows = read_rows(job.folder / JOURNEYS_FILE, ("journey", "end", "attitude_w"), AGAIN)
    found = []
    for row in rows:
        values = {title.split(" ")[0]: value for title, value in row.items()}
        if values["end"] == JourneyEnd.AT_REST:
            found.append({name: float(values[name] or "nan") for name in names})
    return found


def _latitudes(job: Job, name: str, latitude: Scalar) -> np.ndarray:
    """The latitude [deg] over which a body stands for each journey; more journeys change no earlier one."""
    from lithobrake.chaos.design import sample_inputs

    count = job.study.design.run_count
    if not isinstance(latitude, Uncertain):
        return np.full(count, latitude)
    law = {f"sky.{name}_latitude_deg": latitude.to_chaos()}
    drawn: np.ndarray = sample_inputs(law, count, hashed_seed(job.study.seed, "sky"))[:, 0]
    return drawn


def _rows(
    shape: "Shape", journeys: list[dict[str, float]], name: str, latitudes: np.ndarray, mask: float
) -> list[list[Any]]:
    """The rows of one body."""
    from scipy.spatial.transform import Rotation

    from lithobrake.smallbody import day_directions, seen_over_a_day

    if not journeys:
        return []
    latitude = latitudes[[int(one["journey"]) for one in journeys]]
    place = np.array([[one[f"position_{axis}"] for axis in "xyz"] for one in journeys])
    up = shape.normals[shape.nearest(place)[1]]
    seen = seen_over_a_day(shape, place, up, latitude, mask)
    directions = day_directions(latitude)
    rows = []
    for number, one in enumerate(journeys):
        quaternion = [one[f"attitude_{part}"] for part in "wxyz"]
        sides: list[Any] = [""] * len(SIDES)
        if np.isfinite(quaternion).all():
            normals = Rotation.from_quat(quaternion, scalar_first=True).apply(NORMALS)
            sides = ((directions[number] @ normals.T > 0.0) & seen[number][:, None]).mean(axis=0).tolist()
        rows.append([int(one["journey"]), name, float(latitude[number]), float(seen[number].mean()), *sides])
    return rows
