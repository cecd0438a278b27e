"""Where and how the landers of a study of journeys come down first: what the delivery is, whatever the ground does."""

import numpy as np

from lithobrake.analysis import highest_density
from lithobrake.files.reading import read_rows
from lithobrake.pipeline.answer.dispersion_statistics import place_ellipses
from lithobrake.pipeline.answer.regions import SHARES, rest_regions
from lithobrake.pipeline.design.rough_ground import MEAN_INCIDENCE
from lithobrake.pipeline.folder.study_folder import AGAIN
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.results.journey_results import DeliveryResults
from lithobrake.vocabulary.quantities import FLIGHTS_FILE, TOUCHDOWNS_FILE

LEVELS = (0.05, 0.5, 0.95)
POSITION = tuple(f"position_{axis}" for axis in "xyz")


def delivery_results(job: Job, first: DesignRuns, journey_count: int) -> DeliveryResults:
    """Those of a folder; first: its first touchdowns. Raises DamagedFileError for files that are not a study's."""
    columns = ("touchdown", "latitude_deg", "longitude_deg", *POSITION)
    rows = [row for row in read_rows(job.folder / TOUCHDOWNS_FILE, columns, AGAIN) if row["touchdown"] == "0"]
    latitude, longitude = (np.array([float(row[name]) for row in rows]) for name in columns[1:3])
    density = highest_density(np.array([[float(row[name]) for name in POSITION] for row in rows]), SHARES)
    flights = read_rows(job.folder / FLIGHTS_FILE, ("begin_s",), AGAIN)
    descents = np.array([-float(row["begin_s"]) for row in flights if float(row["begin_s"]) < 0.0])
    return DeliveryResults(
        count=len(rows),
        of=journey_count,
        speed=_spread(first.inputs["impact.speed"]),
        incidence_deg=_spread(first.inputs.get(MEAN_INCIDENCE, first.inputs["impact.incidence_deg"])),
        descent_s=_spread(descents) if len(descents) else None,
        ellipse=place_ellipses(job.study, latitude, longitude),
        regions=rest_regions(density),
        why_no_regions=density.why,
    )


def _spread(values: np.ndarray) -> tuple[float, float, float]:
    low, median, high = np.quantile(values, LEVELS).tolist()
    return low, median, high
