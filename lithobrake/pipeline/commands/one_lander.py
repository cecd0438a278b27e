"""One landing of a study file, or one lander followed from delivery to its end, made at once."""

import math
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from lithobrake.campaign import Record, RunStatus, run_key
from lithobrake.pipeline.design.arrivals import on_local_ground
from lithobrake.pipeline.design.dependencies import touchdown_dependencies
from lithobrake.pipeline.design.drawn_design import GRAIN, DrawnDesign
from lithobrake.pipeline.design.random_inputs import draw
from lithobrake.pipeline.design.soils import Soils
from lithobrake.pipeline.journeys.campaign import Journeys
from lithobrake.pipeline.journeys.first_arrivals import Arrivals
from lithobrake.pipeline.journeys.landers import StudyLanders
from lithobrake.pipeline.runs.beds import bed_recipe, compile_kernels
from lithobrake.pipeline.runs.energy_bound import energy_warning
from lithobrake.pipeline.site import with_site_gravity
from lithobrake.results import JourneyMotion, JourneyTrack, TouchdownFacts
from lithobrake.results.journey_track import HEADS, descent_time
from lithobrake.results.motions import MovingBodies
from lithobrake.study import Study, StudyError, fixed_study
from lithobrake.touchdown.lander_model import lander
from lithobrake.touchdown.study_keys import by_study_keys
from lithobrake.touchdown.touchdown_model import landing, touchdown_version
from lithobrake.vocabulary.callbacks import Progress, silent
from lithobrake.vocabulary.outcomes import JourneyEnd
from lithobrake.vocabulary.plain_text import closest
from lithobrake.vocabulary.quantities import (
    GROUND,
    GROUND_KIND,
    GROUND_SIZE,
    JOURNEY,
    ROTATION,
    TIME_LEFT,
    TOUCHDOWN,
    Row,
)

if TYPE_CHECKING:
    from lithobrake.results.motions import MovingBodies
    from lithobrake.touchdown import Bed, Lander, Landing, Outcome

FRAMES = 120
# A number of TOML, and nothing else of it: no truth values, no comments, no second line.
_NUMBER = re.compile(r"[-+]?(inf|nan|\d+(_\d+)*(\.\d+(_\d+)*)?([eE][-+]?\d+)?)", re.ASCII)
# What a touchdown is given by when it is.
OF_JOURNEYS = ("journey", "touchdown", TIME_LEFT)
# Seeds of pours are told apart by the number of the bed in so many bits.
LAST_BED = 2**32 - 1


@dataclass(frozen=True)
class OneLanding:
    """A simulated landing with its inputs, bed and lander.

    values: every number that it read, by dotted key in the units of the study file, drawn ones included.
    """

    values: Row
    bed: "Bed"
    lander: "Lander"
    landing: "Landing"
    outcome: "Outcome"

    def lines(self) -> list[str]:
        """What came out, in lines: how it ended, and every output with its unit."""
        outcome = self.outcome
        rows = [f"The landing ended as {outcome.status} after {outcome.simulated_time:.4g} s."]
        for name, value in outcome.outputs.items():
            if name in TOUCHDOWN and not math.isnan(value):
                what = TOUCHDOWN[name]
                rows.append(f"  {name:<18} {value:>12.5g} {what.units:<6} {what.long_name}")
        return rows

    def to_json(self) -> dict[str, Any]:
        """The same for a program, with every number that was read; what is not known is null."""
        outputs = {name: None if math.isnan(value) else value for name, value in self.outcome.outputs.items()}
        return {
            "outcome": str(self.outcome.status), "simulated_time": self.outcome.simulated_time, "outputs": outputs,
            "inputs": self.values,
        }  # fmt: skip

    def bodies(self) -> "MovingBodies":
        """The hulls and how they moved, the lander last."""
        return MovingBodies.of_landing(self.outcome, self.bed, self.lander, self.landing)

    def save(self, path: Path) -> None:
        """Write hulls and frames to an HDF5 file, as a study keeps its landing."""
        self.outcome.save_frames(path, self.bed, self.lander, self.landing)


def landing_inputs(study: Study, changes: Iterable[str] = (), number: int = 0) -> Row:
    """Inputs of a run by its number from 0, with changes such as "grain.friction=0.4" applied.

    By dotted key, in the units of the study file; at the medians where the study draws no lander. Raises ValueError for
    a change of what a landing does not read or the study file may not have, a study without soil, or a number that no
    run of it has.
    """
    if not study.has_soil:
        raise ValueError("the study has a solver of its own and no soil to land on; get the motion from that solver")
    study = with_site_gravity(study)
    design = DrawnDesign(study)
    Soils(design.site).refuse()
    values = _values(design, number)
    own = (*OF_JOURNEYS, GROUND_KIND, GROUND_SIZE, *((*GROUND, *ROTATION) if study.has_local_ground else ()))
    free = {key: value for key, value in values.items() if key not in own}
    changed: dict[str, float] = {}
    for key, value in (_changed(change, free) for change in changes):
        if key in changed:
            raise ValueError(f"--set has {key} twice; give each key once")
        changed[key] = value
    if not changed:
        return values
    if design.is_flown:
        raise ValueError(
            f"--set names {', '.join(changed)}; allowed: nothing where a flight gives each lander its own impact and "
            "ground (delivery.states, delivery.release); change the study file and land again"
        )
    if study.soil and any(key.startswith(GRAIN) for key in changed):
        raise ValueError(
            f"--set names {', '.join(changed)}; allowed: no key of grain in a study with [soil], whose touchdowns "
            "take the soil of their region; change the study file"
        )
    _refuse(study, free | changed)
    changed = _of_bed(design, values, changed)
    if not study.has_local_ground:
        return values | changed
    # The acceleration goes with the heading on the bed, and the tilt that soil can have with its friction.
    return on_local_ground(design.site, [values | changed], number)[0]


def _of_bed(design: DrawnDesign, values: Row, changed: Row) -> Row:
    """The changes with what another bed has of its own ground; what is given stays."""
    if "bed" not in changed or design.study.ground is None:
        return changed
    last = design.study.bed_count - 1
    if changed["bed"] > last:
        raise ValueError(f"--set bed is {changed['bed']:g}; allowed with [ground]: 0 to {last}, the beds of the study")
    return design.grounds.of(round(changed["bed"]), values) | changed


def land_one(study: Study, values: Row, progress: Progress = silent) -> OneLanding:
    """Simulate one landing with the inputs of `landing_inputs`.

    The bed is that of the study and the number that the values have, from the library or poured: another grain is
    another soil that is landed on, and not another bed.
    """
    study = with_site_gravity(study)
    return landed(study, values, bed_of(study, round(values["bed"]), progress), progress)


def bed_of(study: Study, number: int, progress: Progress) -> "Bed":
    """The bed of a number, from the library or poured; the study has the gravity of its site."""
    from lithobrake.touchdown import pour_bed, stored_or_poured
    from lithobrake.touchdown.bed import Bed

    # A folder of its own, since no file of a study is read or written here.
    with by_study_keys(), TemporaryDirectory(prefix="lithobrake-") as folder:
        recipe, path = bed_recipe(study, number), Path(folder) / "bed.h5"

        def pour() -> "Bed":
            compile_kernels(lambda done, total, what, *_: progress(done / total, what), joined=study.lander.is_hinged)
            return pour_bed(recipe, progress=progress)

        stored_or_poured(recipe, path, pour)
        return Bed.load(path)


def landed(
    study: Study, values: Row, bed: "Bed", progress: Progress
) -> OneLanding:  # fmt: skip
    """Land once with all that a landing reads on this bed; the study has the gravity of its site."""
    from lithobrake.touchdown import land

    with by_study_keys():
        body, arrival = lander(study, values), landing(study, values)
        return OneLanding(values, bed, body, arrival, land(bed, body, arrival, FRAMES, progress))


def _values(design: DrawnDesign, number: int) -> Row:
    study = design.study
    if not study.design.run_count:
        return draw(study, design.medians, study.seed, design.region)
    last = study.design.most_runs - 1
    if not 0 <= number <= last:
        raise ValueError(f"the number of a run is {number}; allowed: 0 to {last}, the runs of the study")
    return design.row(number)


def _refuse(study: Study, values: Mapping[str, float]) -> None:
    try:
        fixed_study(study, {key: value for key, value in values.items() if key != "bed"})
    except StudyError as error:
        raise ValueError(f"--set: {'; '.join(error.problems)}") from error


def _changed(change: str, values: Row) -> tuple[str, float]:
    """The key and the number of a change. Raises ValueError where it is none."""
    key, sign, text = (part.strip() for part in change.partition("="))
    if not sign:
        raise ValueError(f"--set is {change!r}; allowed: KEY=VALUE, for example grain.friction=0.4")
    if key not in values:
        known = f"{closest(key, values)}; it uses {', '.join(values)}"
        raise ValueError(f"--set names {key!r}, which no landing of this study uses{known}")
    if not _NUMBER.fullmatch(text):
        raise ValueError(f"--set {key} is {text!r}; allowed: a number as in a study file, for example 0.4")
    value = float(text)
    if not math.isfinite(value):
        raise ValueError(f"--set {key} is {value:g}; allowed: a finite number")
    if key == "bed" and not (value == round(value) and 0.0 <= value <= LAST_BED):
        raise ValueError(f"--set {key} is {value:g}; allowed: a whole number from 0 to {LAST_BED}")
    return key, value


@dataclass(frozen=True, eq=False)
class OneJourney:
    """A journey with the landing of each of its touchdowns, in their order.

    lander: its place among those of `journeys`.
    """

    journeys: Journeys
    lander: int
    landings: tuple[OneLanding, ...]

    @property
    def track(self) -> JourneyTrack:
        """Where the lander went, and how it ended."""
        site, descent = self.journeys.design.site, _descent(self.journeys, self.lander)
        facts = [_facts(*one, descent) for one in zip(self._touchdowns, self.landings, strict=True)]
        row = dict(zip(JOURNEY, self.journeys.row(self.lander), strict=True))
        partner = None if site.body.partner is None else site.body.partner.body.name
        return JourneyTrack(row, tuple(facts), site.aim, site.aim_radius, site.body.shape.vertices, descent, partner)

    @property
    def _touchdowns(self) -> list[dict[str, Any]]:
        return self.journeys.touchdowns[self.lander]

    def motion(self) -> JourneyMotion:
        """The hulls of each touchdown and how they moved."""
        return JourneyMotion(self.track, [landing.bodies() for landing in self.landings])

    def save(self, paths: list[Path]) -> None:
        """Write hulls and frames of each touchdown to an HDF5 file, as a study keeps its landing."""
        for one, path in zip(self.landings, paths, strict=True):
            one.save(path)

    def to_json(self) -> dict[str, Any]:
        """The journey as a row of journeys.csv and its touchdowns, for a program; what is not known is null."""
        row = {name: None if cell == "" else cell for name, cell in self.track.row.items()}
        pairs = zip(self._touchdowns, self.landings, strict=True)
        return {**row, "touchdowns": [{**touchdown, **landing.to_json()} for touchdown, landing in pairs]}


def follow_one(
    study: Study, values: Row, tell: Callable[[str], None] = lambda line: None, progress: Progress = silent
) -> OneJourney:
    """Follow the lander whose first touchdown reads these values, see landing_inputs, to its end.

    tell: called with a line for each touchdown as soon as it is known how it ended, heads before the first. The bits
    are those of that journey in the study.
    """
    study = with_site_gravity(study)
    journeys, lander = _begun(study, values)
    bed, landings, context = bed_of(study, round(values["bed"]), progress), [], touchdown_dependencies(study)
    row: Row | None = values
    while row is not None:
        landings.append(landed(study, row, bed, progress))
        row = journeys.go_on(lander, _record(study, landings[-1], context))
        for line in [*(HEADS if len(landings) == 1 else ()), _line(journeys, lander, landings[-1])]:
            tell(line)
    return OneJourney(journeys, lander, tuple(landings))


def energy_gained(study: Study, landings: Iterable[OneLanding]) -> str | None:
    """Sentence on landings that left with more energy than impact and gravity supplied; None if none did."""
    study, made = with_site_gravity(study), list(landings)
    records = [_record(study, one, {}) for one in made]
    return energy_warning(DrawnDesign(study), records, max(float(one.bed.surface_height) for one in made))


def _begun(study: Study, values: Row) -> tuple[Journeys, int]:
    number, design = round(values["journey"]), DrawnDesign(study)
    if not design.is_flown:
        begin = Arrivals.of_rows(design.site, [values], number)
        return Journeys.of(StudyLanders.of(design, begin, study.journey.touchdowns)), 0
    # Journeys of a longer study begin with those of this one.
    design = design.with_run_count(max(study.design.run_count, number + 1))
    return Journeys.begun(design), number


def _record(study: Study, landing: OneLanding, context: Mapping[str, Any]) -> Record:
    """A landing as the ledger of the study has it; context: what it depends on beside its values."""
    # As in the ledger, where an output that is NaN is absent.
    outputs = {name: value for name, value in landing.outcome.outputs.items() if not math.isnan(value)}
    return Record(
        # All that is random is among the inputs, so the seed of the run has no effect.
        key=run_key(landing.values, study.seed, 0, context), status=RunStatus.DONE,
        outcome=str(landing.outcome.status), inputs=landing.values, outputs=outputs, draws={}, seed=0, replicate=0,
        attempts=1, reason=None, wall_s=None, cpu_s=None, host=None, version=touchdown_version(), started=None,
        ended=None,
    )  # fmt: skip


def _line(journeys: Journeys, lander: int, landing: OneLanding) -> str:
    facts, there = _facts(journeys.touchdowns[lander][-1], landing, _descent(journeys, lander)), None
    word, site, landers = str(journeys.landers.end[lander]), journeys.design.site, journeys.landers
    if not word:
        latitude, longitude = site.body.shape.latitude_longitude(landers.position[lander])
        there = site.ground_names[landers.ground[lander]], float(latitude), float(longitude)
    radius = site.aim_radius if facts.body == site.ground_names[0] else facts.radius
    return facts.line(facts.to_next(there, radius, JourneyEnd(word) if word else None))


def _descent(journeys: Journeys, lander: int) -> float:
    return descent_time([float(flight["begin_s"]) for flight in journeys.flights[lander]])


def _facts(touchdown: Mapping[str, Any], landing: OneLanding, descent: float) -> TouchdownFacts:
    return TouchdownFacts.of({**landing.values, **landing.outcome.outputs, **touchdown}, descent)
