"""Planning a study: what is still to be made, and what that will cost."""

import shlex
import shutil
from collections.abc import Mapping, Set
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from lithobrake.campaign import available_cores
from lithobrake.pipeline.design.descents import descents_in_words
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.design.soils import Soils
from lithobrake.pipeline.inferred_study import ExpectedInference, InferredStudy
from lithobrake.pipeline.outdated_files import stage_keys
from lithobrake.pipeline.planning import expected_time
from lithobrake.pipeline.planning.expected_steps import ExpectedSoil, PlannedRuns, possible_runs
from lithobrake.pipeline.planning.expected_width import expected_width, runs_a_bed
from lithobrake.pipeline.planning.known_journeys import journeys_under_way
from lithobrake.pipeline.planning.plan import Plan, bytes_in_words
from lithobrake.pipeline.planning.planned_ground import (
    PlannedBeds,
    beds_of_all_sizes,
    planned_beds,
    planned_boulders,
    planned_grains,
    planned_ground,
    planned_kinds,
    planned_soils,
    planned_tile,
)
from lithobrake.pipeline.planning.study_warnings import study_warnings
from lithobrake.pipeline.runs.landings import known_runs
from lithobrake.pipeline.sequential_sampling import grown
from lithobrake.pipeline.site import with_site_gravity
from lithobrake.pipeline.sky_at_rest import refuse_hidden_orbiter
from lithobrake.pipeline.stages import EMULATOR, STAGES
from lithobrake.pipeline.study_folder import StudyFolder, refuse_others_folder
from lithobrake.study import Study, StudySource

MAKE_RUNS = frozenset({"screening_runs", "refined_runs", "test_runs", "runs", "side_runs"})
FOLLOWED = frozenset({"emulated", "hard_ground"})
SHOW_LANDINGS = frozenset({"landing", "telling_landing"})


def plan_study(path: Path, out: Path, worker_count: int | None = None, *, infers: bool = False) -> Plan:
    """Plan what `run_study` would do with the same arguments; writes nothing.

    infers: also what bounces on the soil of the study would say, by its emulator, within seconds.
    Raises ValueError for a study file that is refused, a folder of something else, a mesh that cannot be read, a ledger
    that is none.
    """
    planned = PlannedStudy.of(path, out, worker_count)
    plan = planned.plan
    return replace(plan, inference=_expected_inference(plan, planned.design.study, path)) if infers else plan


@dataclass(frozen=True)
class PlannedStudy:
    """A study that may be run: its file, folder, tables, what it draws, and the processes that it has."""

    path: Path
    folder: Path
    tables: Mapping[str, Any]
    design: DrawnDesign
    worker_count: int | None

    @classmethod
    def of(cls, path: Path, out: Path, worker_count: int | None = None) -> "PlannedStudy":
        """Read and check a study file and its folder; raises as plan_study."""
        source = StudySource.read(path)
        study, folder = with_site_gravity(source.study), StudyFolder.only_read(out)
        refuse_others_folder(source, out)
        design = DrawnDesign(study)
        Soils(design.site).refuse()
        refuse_hidden_orbiter(design.site)
        return cls(path, out, source.tables, grown(design, folder), worker_count)

    @property
    def name(self) -> str:
        """Its file, for messages."""
        return str(self.path)

    @cached_property
    def plan(self) -> Plan:
        """What it will do."""
        title = self.design.study.title or self.path.stem
        return plan_of(self.design, title, StudyFolder.only_read(self.folder), self.worker_count)


def _expected_inference(plan: Plan, study: Study, path: Path) -> ExpectedInference:
    why = None
    if not study.design.run_count:
        why = "their information follows from an emulator of drawn landers, and design.run_count is 0"
    elif EMULATOR.title in plan.stages:
        why = (
            "their information follows from the emulator, which does not exist yet; make it with: "
            f"{shlex.join(['lithobrake', 'run', str(path), '--out', plan.folder])}"
        )
    return ExpectedInference((), {}, why) if why else InferredStudy.open(Path(plan.folder)).plan()


def _delivery(design: DrawnDesign) -> str | None:
    return None if design.descents is None else descents_in_words(design.descents)


def plan_of(
    design: DrawnDesign, name: str, folder: StudyFolder, workers: int | None, *, on_cluster: bool = False
) -> Plan:
    study, keys = design.study, stage_keys(design.study)
    old = [one for one in STAGES if not folder.is_current(one.files(study), keys[one.name])]
    stale = {stage.name: stage.title for stage in old}
    known = known_runs(study, folder)
    runs = tuple(possible_runs(design, folder, "screen" not in stale, known))
    largest = design.with_run_count(study.design.most_runs) if runs[-1].drawn > runs[0].drawn else design
    # One entry where the number of runs is known: both are the same object then.
    beds = tuple(planned_beds(one.study, folder) for one in dict.fromkeys((design, largest)))
    made = _made(study, stale.keys(), runs, beds, journeys_under_way(design, folder, known))
    soils = _soils(design, runs[-1].kept_count)
    soil = soils[len(soils) // 2] if soils else None
    workers, ended = None if on_cluster else workers or available_cores(), [known[key] for key in runs[-1].known]
    sizes, free = expected_time.expected_bytes(largest, runs[-1], soil), _free(folder.path)
    return Plan(
        study=name,
        folder=str(folder.path),
        stages=tuple(stale.values()),
        made=made,
        beds=beds,
        runs=runs,
        half_width=expected_width(design, known, folder, soil),
        process_count=workers,
        seconds=expected_time.expected_seconds(design.site, made, soils, ended, workers) if stale else {},
        basis=expected_time.basis(made, soils, ended),
        bytes=sizes,
        free_bytes=free,
        warnings=(*(_no_room(sum(sizes.values()), free) if stale else ()), *study_warnings(design, soil)),
        site_slope_deg=design.site.slope_deg,
        runs_a_bed=runs_a_bed(study, soils, ended),
        grains=planned_grains(study),
        boulders=planned_boulders(study),
        tile=planned_tile(study),
        ground=planned_ground(design),
        soils=planned_soils(design.site),
        kinds=planned_kinds(design, lambda bed: _price(design, runs[-1].kept_count, bed)),
        delivery=_delivery(design),
    )


def _soils(design: DrawnDesign, kept_count: int) -> list[ExpectedSoil]:
    """Beds as those of a study, each standing for as many; none of a program of one's own."""
    if not design.study.has_soil:
        return []
    return [ExpectedSoil.of(design, kept_count, bed) for bed in beds_of_all_sizes(design)]


def _price(design: DrawnDesign, kept_count: int, bed: int) -> tuple[float, float] | None:
    """CPU time [s] of the touchdowns of a journey on the bed of a number."""
    if design.study.journey.touchdowns == 1:
        return None
    pace = expected_time.machine_pace() or 1.0
    return expected_time.journey_time([ExpectedSoil.of(design, kept_count, bed)], pace)


def _made(
    study: Study, stale: Set[str], runs: tuple[PlannedRuns, ...], beds: tuple[PlannedBeds, ...], under_way: int
) -> dict[str, tuple[int, int]]:
    """How many of each are to be made; under_way: journeys that go on after touchdowns that have ended."""
    new = [one.new for one in runs] if stale & MAKE_RUNS else [0]
    landings = len(stale & SHOW_LANDINGS) * study.has_soil
    touchdowns, journeys = (min(new), max(new)), (0, 0)
    if study.journey.touchdowns != 1 and stale & MAKE_RUNS:
        landers = [one.drawn_new for one in runs]
        touchdowns = touchdowns[0] - min(landers), touchdowns[1] - max(landers)
        journeys = min(landers) + under_way, max(landers) + under_way
    return {
        "beds": (beds[0].new, beds[-1].new),
        "landings": (landings, landings),
        "touchdowns": touchdowns,
        "journeys to rest": journeys,
        "samples": (study.sample_count,) * 2 if "sample" in stale else (0, 0),
        # How many samples leave the surface is known when they are drawn.
        "flights": (0, expected_time.flight_count(study) if "fly" in stale else 0),
        "journeys": (expected_time.followed_count(study),) * 2 if stale & FOLLOWED else (0, 0),
    }


def _no_room(needed: int, free: int) -> list[str]:
    if needed <= free:
        return []
    return [
        f"The files will take about {bytes_in_words(needed)} and only {bytes_in_words(free)} are free: make room, or "
        "choose another folder with --out."
    ]


def _free(path: Path) -> int:
    # The folder need not be there yet.
    place = next(parent for parent in (path.absolute(), *path.absolute().parents) if parent.is_dir())
    return shutil.disk_usage(place).free
