"""Which deliveries still meet a requirement: the admissible region of a study's limit state over its delivery."""

import math
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from lithobrake.analysis.unseen_event import limit_of_runs
from lithobrake.campaign.single_run import Model
from lithobrake.files.atomic import atomic_path, write_rows
from lithobrake.pipeline.answer.emulated_ends import Refits
from lithobrake.pipeline.answer.journey_ends import JourneyTable
from lithobrake.pipeline.answer.run_answers import is_on_one_ground
from lithobrake.pipeline.commands.emulator_job import (
    MOST_LANDERS,
    emulator_job,
    refuse_lander_count,
    refuse_no_emulator,
)
from lithobrake.pipeline.delivery_grid import (
    Asked,
    follow_deliveries,
    region_corners,
    required_deliveries,
    requirement_edges,
    simulate_corners,
)
from lithobrake.pipeline.job import Job, Silent, StudyProgress
from lithobrake.results.requirement_results import Requirement
from lithobrake.statements.requirements import (
    delivery_rows,
    edge_rows,
    edge_statement,
    requirement_statement,
    simulated_rows,
    simulated_statement,
)
from lithobrake.study import Study, StudySource
from lithobrake.study.limit_state_checks import named_condition, option_states
from lithobrake.study.question_checks import MOST_AIMS, MOST_AXES, option_problem
from lithobrake.study.units import input_units
from lithobrake.vocabulary.constants import REFIT_COUNT
from lithobrake.vocabulary.journey_names import JOURNEY_WORDS
from lithobrake.vocabulary.limit_state import LimitState
from lithobrake.vocabulary.quantities import PURE, REST_NUMBERS

# Simulated journeys of a corner, at least: fewer say nothing of a probability.
FEWEST_SIMULATED = 12
# Values of each parameter where none are counted, by how many parameters there are.
VALUES = (21, 9, 6)
# Of the edges along one parameter so many are told, at values of the others from the first to the last.
TOLD = 3
TABLE, EDGES, FIGURE, CORNERS = (f"requirement{end}" for end in (".csv", "_edges.csv", ".png", "_corners.csv"))


def find_requirement(
    source: StudySource,
    out: Path,
    name: str,
    grid: Mapping[str, Sequence[float]],
    *,
    probability: float = 0.9,
    confidence: float = 0.9,
    lander_count: int = 1000,
    simulated_count: int = 0,
    worker_count: int | None = None,
    scheduler: str | None = None,
    model: Model | None = None,
    shown: StudyProgress | None = None,
) -> Requirement:
    """Find the deliveries of a study that meet a limit state of its journeys with at least this probability.

    grid: ascending values of one to three delivery options by dotted key, as `aim.grid` has them; all combinations are
    deliveries. confidence: level of the intervals. lander_count: landers that the emulator follows for each delivery, a
    multiple of its refits, at least two of each; simulated_count: journeys that are simulated at each corner of the
    admissible region, 0 for none; all else: as for `run_study`, which makes the journeys and their emulator first.
    Raises ValueError for what cannot be asked of the study, and for what `run_study` refuses.
    """
    shown = shown or Silent()
    asked = _asked(source.study, name, grid, probability, confidence)
    _refuse_counts(source.study, len(asked.options), lander_count, simulated_count)
    title = f"requirement of {name}"
    with emulator_job(
        source, out, title, worker_count=worker_count, scheduler=scheduler, model=model, shown=shown
    ) as job:  # fmt: skip
        return _found(job, name, asked, lander_count, simulated_count)


def _found(job: Job, name: str, asked: Asked, lander_count: int, simulated_count: int) -> Requirement:
    table = JourneyTable.load(job.folder)
    fitted = Refits.of_journeys(job.study, table)
    if fitted.why is not None:
        raise ValueError(f"the study gives no interval, and a requirement is met by one. {fitted.why}")
    _refuse_unreachable(asked, fitted)
    landers = follow_deliveries(job, asked, lander_count)
    deliveries = required_deliveries(job, asked, landers, fitted)
    corners, units = region_corners(asked, deliveries), input_units()
    return Requirement(
        name=name,
        condition=asked.state.text,
        required=asked.required,
        level=asked.level,
        names=tuple(asked.grid),
        units=tuple(units[key].removeprefix(PURE) for key in asked.grid),
        grid=tuple(tuple(values) for values in asked.grid.values()),
        deliveries=deliveries,
        edges=requirement_edges(asked, deliveries),
        corners=corners,
        simulated=simulate_corners(job, asked, landers, fitted, corners, simulated_count) if simulated_count else (),
        landers=lander_count,
        refits=REFIT_COUNT,
        beds=fitted.bed_count,
        one_ground=is_on_one_ground(job.study),
    )


def _refuse_unreachable(asked: Asked, fitted: Refits) -> None:
    """Raise ValueError where so few journeys could not show the probability even if all of them met the limit state."""
    most = 1.0 - limit_of_runs(fitted.run_count, fitted.bed_count, asked.level)
    if asked.required > most:
        raise ValueError(
            f"probability is {asked.required:g}, and the journeys of the study, on {fitted.bed_count} beds, can show "
            f"at most {most:.3g} with a confidence of {asked.level:g}; lower it, or follow more journeys "
            "(journey.count)"
        )


def _asked(
    study: Study, name: str, grid: Mapping[str, Sequence[float]], probability: float, confidence: float
) -> Asked:
    """The requirement. Raises ValueError, before anything runs, for one that cannot be asked of the study."""
    if study.journey.touchdowns == 1:
        raise ValueError(
            "journey.touchdowns is 1, and a requirement is on where landers come to rest; allowed: a study that "
            "follows them to rest; leave the key out"
        )
    refuse_no_emulator(study, "a requirement")
    for key, share in (("probability", probability), ("confidence", confidence)):
        if not math.isfinite(share) or not 0.0 < share < 1.0:
            raise ValueError(f"{key} is {share:g}; allowed: above 0 and below 1, as 0.9; correct it")
    state = _limit_state(study, name)
    if not 1 <= len(grid) <= MOST_AXES:
        raise ValueError(f"{len(grid)} delivery parameters are given; allowed: 1 to {MOST_AXES}; give other ones")
    for key, values in grid.items():
        wrong = option_problem(study, key, values, key) or (f"{key} has one value; give two" if len(values) < 2 else "")
        if wrong:
            raise ValueError(wrong)
    if study.site.roughness_deg and "delivery.incidence_deg" in grid:
        raise ValueError(
            "delivery.incidence_deg is asked for, and site.roughness_deg draws the ground under each lander by its own "
            "incidence; leave one of the two out"
        )
    return Asked(state, probability, confidence, grid)


def _limit_state(study: Study, name: str) -> LimitState:
    """The limit state of a name. Raises ValueError for none, and for one that the emulator cannot decide."""
    state = LimitState.of(named_condition(study, "NAME", name))
    if name in option_states(study):
        return state
    told = ", ".join((*REST_NUMBERS, *JOURNEY_WORDS))
    if not state.journey:
        raise ValueError(
            f"limit_states.{name} is of first touchdowns; allowed: one of whole journeys, which uses {told}; name such "
            "a one"
        )
    lacking = [one for one in state.journey if one not in (*REST_NUMBERS, *JOURNEY_WORDS)]
    raise ValueError(
        f"limit_states.{name} uses {lacking[0]}, which the emulator does not know; allowed: {told}; leave it out"
    )


def _refuse_counts(study: Study, deliveries: int, landers: int, simulated: int) -> None:
    """Raise ValueError for counts of deliveries and landers that cannot be."""
    if deliveries > MOST_AIMS:
        raise ValueError(f"the ranges make {deliveries} deliveries; allowed: up to {MOST_AIMS}; count fewer values")
    refuse_lander_count(landers, 1000)
    beds = study.with_run_count(study.design.most_runs).bed_count
    # On one lander a bed nothing tells grounds from chance.
    if is_on_one_ground(study) and landers <= beds:
        raise ValueError(
            f"--landers is {landers}, and the study may have {beds} beds of unknown ground; allowed: more landers than "
            f"beds; take {REFIT_COUNT * (2 * beds // REFIT_COUNT + 1)}"
        )
    if landers * deliveries > MOST_LANDERS:
        raise ValueError(
            f"--landers {landers} for {deliveries} deliveries makes {landers * deliveries} landers; allowed: up to "
            f"{MOST_LANDERS}; take fewer of either"
        )
    if simulated and simulated < FEWEST_SIMULATED:
        raise ValueError(f"--check is {simulated}; allowed: 0, or at least {FEWEST_SIMULATED} journeys; take more")
    if simulated and study.journey.touchdowns is not None:
        raise ValueError(
            f"--check is {simulated}, and journey.touchdowns = {study.journey.touchdowns} ends landings before landers "
            "rest; leave one of the two out"
        )


def grid_of_ranges(ranges: Sequence[str]) -> dict[str, tuple[float, ...]]:
    """Values by key, evenly over ranges such as "delivery.speed=0.05:0.2" or, with their number, "...=0.05:0.2:7".

    Raises ValueError for a text that is no range.
    """
    found: dict[str, tuple[float, ...]] = {}
    usual = VALUES[min(len(ranges), len(VALUES)) - 1] if ranges else 0
    for text in ranges:
        key, _, words = text.partition("=")
        parts = words.split(":")
        try:
            ends, count = [float(one) for one in parts[:2]], int(parts[2]) if len(parts) == 3 else usual
        except ValueError:
            ends, count = [], 0
        # A range that is reversed, say.
        if len(ends) != 2 or len(parts) > 3 or count < 2 or not all(map(math.isfinite, ends)) or ends[0] >= ends[1]:
            raise ValueError(
                f"--over is {text!r}; allowed: KEY=FROM:TO or KEY=FROM:TO:COUNT with FROM below TO and at least two "
                "values, as delivery.speed=0.05:0.2:9; write it so"
            )
        if key in found:
            raise ValueError(f"--over names {key} twice; allowed: each parameter once; leave one out")
        found[key] = tuple(np.linspace(ends[0], ends[1], count).tolist())
    return found


def requirement_files(folder: Path, *, simulated: bool) -> tuple[Path, ...]:
    """The files of a requirement in a folder: deliveries, edges, picture and, of simulated journeys, corners."""
    return tuple(folder / name for name in (TABLE, EDGES, FIGURE, *([CORNERS] if simulated else [])))


def write_requirement(found: Requirement, folder: Path) -> tuple[Path, ...]:
    """Write the tables and the picture of a requirement into a folder; returns the files.

    Corners of another requirement that are there are removed.
    """
    from lithobrake.report.figures.requirement_figure import requirement_figure
    from lithobrake.report.figures.style import figure_style

    paths = requirement_files(folder, simulated=bool(found.simulated))
    for path, (titles, rows) in zip(
        (*paths[:2], *paths[3:]), (delivery_rows(found), edge_rows(found), simulated_rows(found)), strict=False
    ):
        write_rows(path, titles, rows)
    if not found.simulated:
        (folder / CORNERS).unlink(missing_ok=True)
    with figure_style(), atomic_path(paths[2]) as draft:
        requirement_figure(found).savefig(draft, format="png", metadata={"Software": None})
    return paths


def requirement_lines(found: Requirement) -> list[str]:
    """A requirement for a terminal: how many deliveries meet it, where that ends, what landings say of the corners."""
    lines = [requirement_statement(found)]
    for along in range(len(found.names)):
        own = [one for one in found.edges if one.along == along]
        told = dict.fromkeys(round(k * (len(own) - 1) / max(TOLD - 1, 1)) for k in range(TOLD))
        lines += [f"  {edge_statement(found, own[k])}" for k in told]
    return [*lines, *(f"  {simulated_statement(found, one)}" for one in found.simulated)]
