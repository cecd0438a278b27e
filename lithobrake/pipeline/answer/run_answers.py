"""What each run answers: its bed, its scope, what is missing, and which limit states it meets."""

from collections.abc import Mapping, Sequence

import numpy as np

from lithobrake.analysis import highest_density
from lithobrake.analysis.regions import HighestDensity
from lithobrake.analysis.subset_simulation import limit_state_met
from lithobrake.campaign import Record
from lithobrake.files.reading import read_rows
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.first_touchdown.run_flights import FATES as RUN_FATES
from lithobrake.pipeline.first_touchdown.run_flights import RETURNS as RETURNING
from lithobrake.pipeline.first_touchdown.run_flights import RUN_FLIGHTS_FILE
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.study_folder import AGAIN, StudyFolder
from lithobrake.results.dispersion import RestRegion
from lithobrake.results.run_results import MissingLandings, OutputRange
from lithobrake.results.site_results import SiteResults
from lithobrake.statements import ends as statements
from lithobrake.statements.ends import Scope
from lithobrake.study import Study
from lithobrake.vocabulary.limit_state import LimitState
from lithobrake.vocabulary.outcomes import CAPTURED, FATES, RETURNS, TouchdownOutcome
from lithobrake.vocabulary.quantities import OVER_RIM, TOUCHDOWN

# The stage after which every run has its answer.
ANSWERED_AFTER = "fly_runs"
FAILED = "failed"
KNOWN = (TouchdownOutcome.CLEAR, TouchdownOutcome.CAPTURED)
# In the order in which a sentence names them.
LOST = (TouchdownOutcome.LEFT_SIDEWAYS, TouchdownOutcome.TIME_LIMIT, FAILED)
# Share of the landings without an outcome above which a study warns of it [-].
WARNED = 0.02
# Words of a run that its touchdown alone decides; all others take flights.
OF_TOUCHDOWN = (CAPTURED,)
SHARES = (0.5, 0.95)
# Of more places than these, the first: they are samples, and the work grows with their square.
MOST_PLACES = 5000


def asks_rest(study: Study) -> bool:
    """Whether a study asks how many landers come to rest, rather than what their first touchdowns tell."""
    return study.journey.touchdowns != 1 and study.design.run_count > 0


def answers_rest(study: Study) -> bool:
    """Whether the half width of a study is that of the fraction at rest."""
    return asks_rest(study) and study.design.half_width_of is None


def answer_words(study: Study) -> str:
    """What the answers of a study's runs are a share of, in words."""
    if answers_rest(study):
        return "the fraction at rest"
    asked = study.design.half_width_of
    return "the return fraction" if asked is None else f"the probability of {asked}"


def read_shares(folder: StudyFolder) -> dict[str, float]:
    """What a folder's table of the flights of runs says of them, by key."""
    rows = read_rows(folder / RUN_FLIGHTS_FILE, ("design", "key", "returns"), AGAIN)
    return {row["key"]: float(row["returns"] or "nan") for row in rows if row["design"] == "drawn"}


def answers_of(
    keys: Sequence[str], known: Mapping[str, Record], flown: Mapping[str, float]
) -> tuple[np.ndarray, np.ndarray]:
    """Answer of each run that has ended and flown, from 0 to 1, NaN where it has none, and its bed, both [run_count].

    keys: of the runs that are asked for; known: runs that have ended, by key; flown: as flown_shares gives it.
    """
    answered = [key for key in keys if key in known and key in flown]
    return np.array([flown[key] for key in answered]), np.array([known[key].inputs["bed"] for key in answered])


def scope(study: Study) -> Scope:
    """What the runs of a study have in common, and when its flights and journeys end."""
    return Scope(
        has_soil=study.has_soil,
        bed_count=study.bed_count,
        one_place=DrawnDesign(study).one_place,
        random_attitude=study.impact.orientation == "random",
        has_scatter=study.monte_carlo.scatter,
        flight_time=study.flight.duration,
        journey_time=study.journey.duration,
        to_rest=asks_rest(study),
        touchdowns=study.journey.touchdowns,
        is_flown=study.delivery is not None and study.delivery.is_flown,
    )


def why_no_interval(study: Study) -> str | None:
    """Why drawn runs say nothing of other beds and places; None where they do."""
    return scope(study).why_no_interval


def is_on_one_ground(study: Study) -> bool:
    """Whether each bed stands for one body of those that a study allows, so that an answer has the interval of one."""
    return study.ground is not None and study.ground.unknown != "patchy"


def unknown_runs(runs: DesignRuns) -> np.ndarray:
    """Of which runs it is not known what became of them [run_count]."""
    lost: np.ndarray = ~np.isin(runs.outcomes, KNOWN)
    return lost


def missing_landings(outcomes: Mapping[str, int]) -> MissingLandings:
    """How many of the landings have no outcome, by how they ended; outcomes: landings by outcome."""
    lost = {str(name): outcomes[name] for name in LOST if outcomes.get(name)}
    count, total = sum(lost.values()), sum(outcomes.values())
    return MissingLandings(count, count / total if total else 0.0, lost)


def missing_warning(study: Study, outcomes: Mapping[str, int]) -> str | None:
    """What missing landings do to the numbers of a study, and how to avoid them; None for few or none."""
    found, total = missing_landings(outcomes), sum(outcomes.values())
    if found.share <= WARNED:
        return None
    return statements.missing_warning(found.count, total, found.outcomes, has_soil=study.has_soil)


def left_in_flight(runs: DesignRuns) -> np.ndarray:
    """Which runs left across the edge of the bed in flight, [run_count]: the nearest to those that are missing."""
    clear = np.array(runs.outcomes) == TouchdownOutcome.CLEAR
    found: np.ndarray = clear & (runs.output(OVER_RIM) == 1.0)
    return found


def described(known: np.ndarray, outcomes: Sequence[str]) -> str:
    """Which of the landings a number describes, in words; known: those that have one [run_count]."""
    return statements.described([outcome for outcome, one in zip(outcomes, known, strict=True) if one], len(outcomes))


def output_ranges(runs: DesignRuns) -> dict[str, OutputRange]:
    """What else the touchdowns gave, over distinct runs: median, smallest and largest."""
    table = {}
    for name in ("contact_duration", "penetration", "peak_acceleration", "energy_lost"):
        known = np.isfinite(runs.output(name))
        values = runs.output(name)[~np.isnan(runs.output(name))]
        if len(values):
            table[name] = OutputRange(
                float(np.median(values)), float(values.min()), float(values.max()), TOUCHDOWN[name].units,
                described(known, runs.outcomes),
            )  # fmt: skip
    return table


def failing_runs(state: LimitState, runs: DesignRuns, fates: np.ndarray) -> np.ndarray:
    """Share of the flights of each run that meet a limit state, NaN where nobody knows, [run_count].

    fates [run_count, len(RUN_FATES)]: how many of its flights ended so.
    """
    values = values_of_runs(runs)
    unflown = {word: np.full(runs.run_count, np.nan) for word in FATES if word != CAPTURED}
    found = limit_state_met(state, values | unflown)
    counts = fates.sum(axis=1)
    if set(state.fates) <= set(OF_TOUCHDOWN) or not counts.any():
        return found
    by_fate = np.column_stack([limit_state_met(state, values | _words(fate, runs.run_count)) for fate in RUN_FATES])
    met = np.where(fates > 0, fates * by_fate, 0.0).sum(axis=1)
    return np.where(counts > 0, met / np.maximum(counts, 1), found)


def values_of_runs(runs: DesignRuns) -> dict[str, np.ndarray]:
    """What limit states may name of touchdowns, [run_count] each: outputs, and whether the lander was captured."""
    outcomes = np.array(runs.outcomes)
    # A run without a known end was neither captured nor not.
    ended = np.isin(outcomes, [TouchdownOutcome.CLEAR, TouchdownOutcome.CAPTURED])
    captured = np.where(ended, (outcomes == CAPTURED).astype(float), np.nan)
    return {name: runs.output(name) for name in TOUCHDOWN} | {CAPTURED: captured}


def _words(fate: str, count: int) -> dict[str, np.ndarray]:
    """Whether each word of the grammar holds of flights that ended so, [count] each; `captured` is of the touchdown."""
    held = {word: word == fate for word in RUN_FATES} | {RETURNS: fate in RETURNING}
    return {word: np.full(count, float(one)) for word, one in held.items()}


def rest_regions(density: HighestDensity) -> tuple[RestRegion, ...]:
    """Regions of highest density as results."""
    return tuple(
        RestRegion(one.share, one.area_m2, one.largest_extent_m, tuple(map(_line, one.outlines)), one.island_extents_m)
        for one in density.regions
    )


def place_regions(site: SiteResults, rows: Sequence[dict[str, str]]) -> tuple[RestRegion, ...]:
    """Regions of the places of these rows, on a sphere of the radius at the site."""
    down = rows[:MOST_PLACES]
    if not down:
        return ()
    latitude, longitude = (
        np.radians([float(row[f"{name}_deg"]) for row in down]) for name in ("latitude", "longitude")
    )
    level = np.cos(latitude)
    directions = np.column_stack([level * np.cos(longitude), level * np.sin(longitude), np.sin(latitude)])
    return rest_regions(highest_density(float(np.linalg.norm(site.place_m)) * directions, SHARES))


def _line(outline: np.ndarray) -> tuple[tuple[float, float], ...]:
    return tuple((latitude, longitude) for latitude, longitude in outline.tolist())
