"""The restitution, friction and scatter that the soil of a study implies, as a table over speed and incidence."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.pipeline.emulate.outgoing import VELOCITY
from lithobrake.pipeline.emulate.samples import CAPTURED, Samples, touchdown_values
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.study import Study
from lithobrake.vocabulary.outcomes import TouchdownOutcome

if TYPE_CHECKING:
    from lithobrake.smallbody import RestitutionTable

FILE = "restitution.csv"
ARRIVAL = ("impact.speed", "impact.incidence_deg")
CLEAR_RUN, CAPTURED_RUN, *_ = TouchdownOutcome
# Cells along each side, and landers that leave which a cell has in the mean; fewer make fewer cells.
MOST_CELLS, CELL_COUNT = 4, 50
# A cell with fewer that leave has the quantiles of all.
FEWEST = 10


def restitution_table(study: Study, samples: Samples, runs: DesignRuns) -> "RestitutionTable":
    """The table of draws of the emulator, and how many runs and samples each cell has.

    Cells hold equal shares of speeds and of incidences. Raises ValueError where no sample leaves the surface.
    """
    from lithobrake.smallbody.restitution_table import LEVELS, RestitutionTable, cells

    arrival = [touchdown_values(study, samples.input_names, samples.inputs, name) for name in ARRIVAL]
    leaves, ended = samples.leaves, samples.leaves | (samples.outcome == CAPTURED)
    if not leaves.any():
        raise ValueError("no sample leaves the surface, so the soil implies no restitution; set rest.count to 0")
    side = max(1, min(MOST_CELLS, math.isqrt(int(leaves.sum()) // CELL_COUNT)))
    edges = [np.quantile(one, np.linspace(0.0, 1.0, side + 1)) for one in arrival]

    def place(values: Sequence[np.ndarray]) -> np.ndarray:
        row, column = (cells(*one) for one in zip(edges, values, strict=True))
        return row * side + column

    def counts(of: np.ndarray) -> np.ndarray:
        return np.bincount(of, minlength=side**2).reshape(side, side)

    velocity = np.column_stack([samples.output(name) for name in VELOCITY])[leaves]
    values = implied(arrival[0][leaves], np.radians(arrival[1][leaves]), velocity)
    own = [place(arrival)[leaves] == cell for cell in range(side**2)]
    used = [one if one.sum() >= FEWEST else np.ones(len(one), dtype=bool) for one in own]
    quantiles = {
        name: np.reshape([np.quantile(one[cell], LEVELS) for cell in used], (side, side, len(LEVELS)))
        for name, one in values.items()
    }
    pairs = [(values["normal_restitution"][cell], values["tangential_restitution"][cell]) for cell in used]
    of_samples, of_runs = counts(place(arrival)[ended]), np.isin(runs.outcomes, (CLEAR_RUN, CAPTURED_RUN))
    stay = counts(place(arrival)[ended & ~leaves]) / np.maximum(of_samples, 1)
    correlation = np.reshape([_score_correlation(*pair) for pair in pairs], (side, side))
    in_runs = counts(place([runs.inputs[name][of_runs] for name in ARRIVAL]))
    found = (quantiles, correlation, stay, of_samples, in_runs, study.rest.rest_height)
    return RestitutionTable(edges[0], edges[1], *found)


def implied(speed: np.ndarray, incidence: np.ndarray, velocity: np.ndarray) -> dict[str, np.ndarray]:
    """What hard ground would have had to be, [count] each, at speeds [m/s] and incidences [rad] with these rebounds.

    velocity: in the frame of the touchdown [m/s], [count, 3]. Restitutions are ratios of the speeds along the normal
    and along the ground; an impact without horizontal velocity has none along the ground, told as 0.
    """
    down, along = speed * np.cos(incidence), speed * np.sin(incidence)
    level = np.hypot(velocity[:, 0], velocity[:, 1])
    change = np.hypot(velocity[:, 0] - along, velocity[:, 1])
    return {
        "normal_restitution": velocity[:, 2] / down,
        "tangential_restitution": np.divide(level, along, out=np.zeros_like(level), where=along > 0.0),
        "azimuth_deg": np.degrees(np.arctan2(velocity[:, 1], velocity[:, 0])),
        "friction": change / (velocity[:, 2] + down),
    }


def _score_correlation(one: np.ndarray, other: np.ndarray) -> float:
    """Correlation of the normal scores, which no transformation of either changes; 0 where one does not vary."""
    from scipy import special, stats

    if min(np.ptp(one), np.ptp(other)) == 0.0:
        return 0.0
    scores = [special.ndtri((stats.rankdata(values) - 0.5) / len(values)) for values in (one, other)]
    return float(np.corrcoef(*scores)[0, 1])
