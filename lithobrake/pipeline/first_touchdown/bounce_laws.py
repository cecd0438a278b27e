"""What a bounce on soil needs beside its model: inputs of later impacts, equivalent hard ground, and friction."""

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.first_touchdown.samples import CAPTURED, VELOCITY, Samples, touchdown_values
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.study import Study
from lithobrake.study.quantity import uncertain
from lithobrake.touchdown.lander_model import lander
from lithobrake.touchdown.soil import grain_sizes
from lithobrake.vocabulary.outcomes import TouchdownOutcome
from lithobrake.vocabulary.quantities import ARRIVAL, IMPACT_INCIDENCE, IMPACT_SPEED, SPIN

if TYPE_CHECKING:
    from lithobrake.smallbody import Impacts, RestitutionTable

RESTITUTION_FILE = "restitution.csv"
CLEAR_RUN, CAPTURED_RUN, *_ = TouchdownOutcome
# Cells along each side, and landers that leave which a cell has in the mean; fewer make fewer cells.
MOST_CELLS, CELL_COUNT = 4, 50
# A cell with fewer that leave has the quantiles of all.
FEWEST = 10
# Effective friction over friction of the contacts: a line through pushes as slow as captured landers.
INTERCEPT, SLOPE = 0.49, 0.32
# Frictions, and smallest edges of the lander in grains, between which it was measured.
FRICTIONS, EDGES = (0.2, 0.8), (0.55, 1.7)
# Grains whose mean size stands for all.
GRAINS = 1000


def why_no_soil(study: Study) -> str | None:
    """Why the soil cannot be asked about the impacts after the first; None where it can."""
    # Without these among the uncertain inputs the expansion says nothing about an impact unlike the first.
    absent = [name for name in ARRIVAL if name not in uncertain(study.touchdown_values())]
    if not absent:
        return None
    return (
        f"{' and '.join(absent)} {'is' if len(absent) == 1 else 'are'} no uncertain input, so the runs do not "
        "cover later impacts; give it a distribution that covers them"
    )


def inputs_at(
    impacts: "Impacts", inputs: Mapping[str, np.ndarray], ranges: Mapping[str, tuple[float, float]]
) -> tuple[np.ndarray, np.ndarray]:
    """All inputs at the impacts, [count, input_count], and which of these are outside the ranges, [count].

    inputs: of each lander. Those outside have the inputs of the first impact in place of theirs.
    """
    felt = {IMPACT_SPEED: impacts.speed, IMPACT_INCIDENCE: np.degrees(impacts.incidence)}
    felt |= dict(zip(SPIN, impacts.spin.T, strict=True)) | {"surface.gravity": -impacts.effective_acceleration}
    x = np.column_stack([values[impacts.lander] for values in inputs.values()])
    outside = np.zeros(len(x), dtype=bool)
    for index, name in enumerate(inputs):
        if name in felt:
            lower, upper = ranges[name]
            known = (felt[name] >= lower) & (felt[name] <= upper)
            x[known, index] = felt[name][known]
            outside |= ~known
    return x, outside


def hard_ground_only(why: str) -> str:
    """That journeys from bounce to bounce leave the soil out, in a sentence."""
    return f"Journeys from bounce to bounce are on hard ground only: {why}."


def restitution_table(study: Study, samples: Samples, runs: DesignRuns) -> "RestitutionTable":
    """The table of draws of the emulator, and how many runs and samples each cell has.

    Cells hold equal shares of speeds and of incidences. Raises ValueError where no sample leaves the surface.
    """
    from lithobrake.smallbody.bounce import LEVELS, RestitutionTable, cells

    arrival = [touchdown_values(study, samples.input_names, samples.inputs, name) for name in ARRIVAL]
    leaves, ended = samples.leaves, samples.leaves | (samples.outcome == CAPTURED)
    if not leaves.any():
        raise ValueError("no sample leaves the surface, so the soil implies no restitution; set hard_ground.count to 0")
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
    found = (quantiles, correlation, stay, of_samples, in_runs, study.hard_ground.rest_height)
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


def has_measured_size(design: DrawnDesign) -> bool:
    """Whether the study's lander is one that the law was measured for: one hull, no ball, about as large as a grain."""
    study = design.study
    if not study.has_soil or study.lander.shape == "sphere" or study.lander.part:
        return False
    sizes = grain_sizes(study).draw((np.arange(GRAINS) + 0.5) / GRAINS)
    least, largest = EDGES
    return bool(least <= lander(study, design.medians).smallest_edge / sizes.mean() <= largest)


def effective_friction(friction: np.ndarray) -> np.ndarray:
    """Friction that stops a lander on hulls, by that of its contacts; beyond the measured ones that of the end."""
    return INTERCEPT + SLOPE * np.clip(friction, *FRICTIONS)
