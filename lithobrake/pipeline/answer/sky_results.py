"""What landers at rest see of the sky, with intervals over beds."""

import numpy as np

from lithobrake.analysis import share_estimate
from lithobrake.files.reading import read_rows
from lithobrake.pipeline.answer.journey_ends import MEDIAN, JourneyTable, end_share, rest_quantile
from lithobrake.pipeline.answer.scope import why_no_interval
from lithobrake.pipeline.folder.study_folder import AGAIN, StudyFolder
from lithobrake.results.sky_results import Probability, SkyResults
from lithobrake.study import Study
from lithobrake.study.lander_sides import SIDES
from lithobrake.vocabulary.quantities import SKY_FILE

LOW = 0.05


def sky_results(study: Study, folder: StudyFolder, table: JourneyTable) -> dict[str, SkyResults]:
    """By the body that the study asks for; empty where it asks for none or no lander rests."""
    if not study.sky.bodies or not table.rests.any():
        return {}
    rows = read_rows(folder / SKY_FILE, ("journey", "body", "day_fraction", "least_day_fraction"), AGAIN)
    return {name: _of(study, [row for row in rows if row["body"] == name], table) for name in study.sky.bodies}


def _of(study: Study, rows: list[dict[str, str]], table: JourneyTable) -> SkyResults:
    """The results of one body."""
    why, bed = why_no_interval(study), table.bed[[int(row["journey"]) for row in rows]]

    def column(name: str) -> np.ndarray:
        return np.array([float(row[name] or "nan") for row in rows])

    def probability(values: np.ndarray) -> Probability:
        found = share_estimate(values, bed, why=why)
        return Probability(found.share, found.lower, found.upper, found.why)

    seen = column("day_fraction")
    sides = {side: column(f"side_{side}") for side in SIDES if rows[0][f"side_{side}"]}
    return SkyResults(
        day_fraction=rest_quantile(seen, bed, MEDIAN, why),
        day_fraction_q05=rest_quantile(seen, bed, LOW, why),
        least_day_fraction=rest_quantile(column("least_day_fraction"), bed, MEDIAN, why),
        probability=probability(seen),
        never=end_share(seen == 0.0, bed, why),
        sides={side: rest_quantile(values, bed, MEDIAN, why) for side, values in sides.items()},
        side_probabilities={side: probability(values) for side, values in sides.items()},
        dark_sides={side: end_share(values == 0.0, bed, why) for side, values in sides.items()},
    )
