"""A limit state too rare for the runs of a study: subset simulation whose landings are made, and kept in the ledger.

Each landing is a point of independent standard normal numbers, which its soil, place, azimuth and attitude follow from,
and its bed, which a chain keeps from its start. The points follow from the margins of those before them, so one that is
stopped and begun again asks for the same landings, finds them in the ledger, and goes on where it was.
"""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from scipy.special import ndtr

from lithobrake.analysis import SubsetResult, subset_simulation
from lithobrake.analysis.subset_simulation import limit_state_margin, limit_state_met
from lithobrake.campaign import DaskExecutor, LocalExecutor
from lithobrake.campaign.single_run import Model
from lithobrake.files.reading import hashed_seed
from lithobrake.pipeline.answer.run_answers import OF_TOUCHDOWN, values_of_runs, why_no_interval
from lithobrake.pipeline.design.dependencies import touchdown_keys
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.job import Job, Silent, StudyProgress
from lithobrake.pipeline.runs.landings import touchdowns
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.sequential_sampling import grown
from lithobrake.pipeline.site import with_site_gravity
from lithobrake.pipeline.study_folder import StudyFolder
from lithobrake.pipeline.study_run import run_study
from lithobrake.statements.limits import few_origins, rare_limit_state
from lithobrake.study import Study, StudySource
from lithobrake.study.limit_state_checks import named_condition
from lithobrake.vocabulary.constants import LEAST_PROBABILITY
from lithobrake.vocabulary.limit_state import LimitState

# Landings of a level are made in chains of ten.
CHAIN, FEWEST = 10, 20
# A landing is dear, and a probability below 1e-6 is less sure than what a study assumes.
MOST_LEVELS = 6


def rare_failure(
    source: StudySource,
    out: Path,
    name: str,
    *,
    landing_count: int = 500,
    worker_count: int | None = None,
    scheduler: str | None = None,
    model: Model | None = None,
    shown: StudyProgress | None = None,
) -> dict[str, Any]:
    """Estimate the probability of a rare limit state by subset simulation, and write rare_NAME.json to the folder.

    landing_count: of a level, each a tenth as probable as the one before; all else: as for `run_study`, which pours
    the beds first. Raises ValueError for a limit state that has no distance, and for what `run_study` refuses.
    """
    shown = shown or Silent()
    state = _limit_state(source.study, name)
    if landing_count < FEWEST or landing_count % CHAIN:
        raise ValueError(f"--landings is {landing_count}; allowed: multiples of {CHAIN} from {FEWEST}; take 500")
    run_study(source, out, until="bed", worker_count=worker_count, scheduler=scheduler, model=model, shown=shown)
    folder = StudyFolder(out)
    with folder.alone(), DaskExecutor(scheduler) if scheduler is not None else LocalExecutor(worker_count) as executor:
        study = with_site_gravity(source.study)
        design = grown(DrawnDesign(study), folder)
        landings = Landings(Job(design, source.tables, folder, executor, shown, model), name, state)
        if not study.has_soil:
            shown.say("A program that is random beyond its inputs widens the interval.")
        shown.begin(f"landings of {name}", 1, 1)
        try:
            found = landings.simulation(landing_count)
        except BaseException:
            # What is under way would be waited for otherwise; finished landings are in the ledger.
            executor.shutdown(cancel_futures=True)
            raise
        if landings.reused_count:
            shown.say(f"{landings.reused_count} of {found.evaluation_count} landings are known and reused")
        content = landings.told(found, landing_count)
        folder.write_json(f"rare_{name}.json", content)
    return content


@dataclass
class Landings:
    """The landings of a subset simulation, as margins of points.

    scale: of the first level's outputs. keys: of all landings so far, in the ledger.
    """

    job: Job
    name: str
    state: LimitState
    scale: dict[str, float] = field(default_factory=dict)
    keys: list[str] = field(default_factory=list)
    made_count: int = 0
    reused_count: int = 0
    unknown_count: int = 0

    @property
    def dimension(self) -> int:
        """How many numbers a point has; the last picks the bed."""
        return len(self.job.design.coordinates) + 1

    def simulation(self, landing_count: int) -> SubsetResult:
        return subset_simulation(
            self.margins,
            self.dimension,
            points_per_level=landing_count,
            kept=[self.dimension - 1],
            groups=self.beds,
            most_levels=MOST_LEVELS,
            seed=hashed_seed(self.job.study.seed, "rare", self.name),
        )

    def beds(self, points: np.ndarray) -> np.ndarray:
        """Beds of points [count, dimension], [count]."""
        shares = np.clip(ndtr(points[:, -1]), LEAST_PROBABILITY, 1.0 - LEAST_PROBABILITY)
        # Below 1, as the clip above keeps the last bed from being passed.
        return (shares * self.job.study.bed_count).astype(int)

    def margins(self, points: np.ndarray) -> np.ndarray:
        """Land at standard normal points [count, dimension], and say how far each is from the limit state, [count].

        Raises ValueError for an output that no landing has.
        """
        study = self.job.study
        shares = np.clip(ndtr(points), LEAST_PROBABILITY, 1.0 - LEAST_PROBABILITY)
        laws = self.job.design.coordinates.values()
        x = np.column_stack([law.ppf(share) for law, share in zip(laws, shares.T, strict=False)])
        rows = self.job.design.rows_at(self.beds(points).tolist(), x)
        self.keys += touchdown_keys(study, rows, 0)
        # Noted before they are made, so that whoever looks meanwhile can tell them from runs of the study.
        self.job.folder.note_rare(self.name, self.keys)
        made = touchdowns(self.job, rows, f"{self.name}, after {self.made_count}", 0)
        self.made_count += len(made.records)
        self.reused_count += made.reused_count
        values = values_of_runs(DesignRuns.of(made))
        # The thresholds of all levels are compared with each other, so margins keep the scale of the first.
        self.scale = self.scale or {output: self._spread(output, values[output]) for output in self.state.outputs}
        self.unknown_count += int(np.isnan(limit_state_met(self.state, values)).sum())
        return limit_state_margin(self.state, values, self.scale)

    def _spread(self, output: str, values: np.ndarray) -> float:
        """Standard deviation of an output of the first level; 1 where it does not vary. Raises ValueError for none."""
        if not np.isfinite(values).any():
            raise ValueError(
                f"limit_states.{self.name} uses {output}, which no landing has; have the program that simulates the "
                "touchdowns return it, or choose another limit state"
            )
        return float(np.nanstd(values)) or 1.0

    def told(self, found: SubsetResult, landing_count: int) -> dict[str, Any]:
        study, why = self.job.study, why_no_interval(self.job.study)
        content = {
            "condition": self.state.text,
            "probability": found.probability.value,
            "lower": None if why else found.probability.lower,
            "upper": None if why else found.probability.upper,
            "why": why,
            "level": found.probability.level,
            "coefficient_of_variation": found.coefficient_of_variation,
            "origins": found.origins,
            "warning": few_origins(found.origins, study.bed_count) if found.reached else None,
            "reached": found.reached,
            "rarest": found.probability.value if found.reached else found.probability.upper,
            "levels": len(found.thresholds),
            "thresholds": found.thresholds.tolist(),
            "shares": found.shares.tolist(),
            "landings_a_level": landing_count,
            "landings": found.evaluation_count,
            "without_known_end": self.unknown_count,
            "beds": study.bed_count,
            "inputs": self._medians(found.failing),
        }
        return content | {"statement": rare_limit_state(self.name, content)}

    def _medians(self, failing: np.ndarray) -> dict[str, dict[str, float | None]]:
        """Median of each input among points that fail [count, dimension], and by its law; None where there are none."""
        laws = self.job.design.inputs
        return {
            name: {"median": float(law.ppf(np.median(share))) if len(share) else None, "median_of_all": law.median}
            for (name, law), share in zip(laws.items(), ndtr(failing).T, strict=False)
        }


def _limit_state(study: Study, name: str) -> LimitState:
    """The limit state of a name. Raises ValueError where there is none, or landings have no distance from it."""
    state = LimitState.of(named_condition(study, "NAME", name))
    if state.journey:
        raise ValueError(
            f"limit_states.{name} is of whole journeys ({state.journey[0]}), and subset simulation makes first "
            "touchdowns alone; read its probability in the summary of the study"
        )
    words = [word for word in state.fates if word not in OF_TOUCHDOWN]
    if words or not state.outputs:
        word = (words or state.fates)[0]
        raise ValueError(
            f"limit_states.{name} uses {word}, which is true or false, but subset simulation needs a distance; "
            "use an output of the touchdown, as in speed_out > 0.1, or read the probability in the summary of the study"
        )
    return state
