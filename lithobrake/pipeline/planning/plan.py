"""What a study will do: counts, time, room and what to know of it, in words."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from lithobrake.pipeline.inferred_study import ExpectedInference
from lithobrake.pipeline.planning import planned_ground
from lithobrake.pipeline.planning.expected_difference import ExpectedDifference
from lithobrake.pipeline.planning.expected_steps import PlannedRuns
from lithobrake.pipeline.planning.expected_time import Span
from lithobrake.pipeline.planning.expected_width import ExpectedHalfWidth, RunsABed
from lithobrake.vocabulary.number_words import thousands, unit_of_time

# One, and more.
NAMES = {
    "beds": ("bed", "beds"),
    "landings": ("preview landing", "preview landings"),
    "touchdowns": ("touchdown", "touchdowns"),
    "journeys to rest": ("journey to rest", "journeys to rest"),
    "samples": ("sample", "samples"),
    "flights": ("flight", "flights"),
    "journeys": ("journey from bounce to bounce", "journeys from bounce to bounce"),
}


@dataclass(frozen=True)
class Plan:
    """Planned runs of a study, with their time, disk space, expected half-width and warnings.

    study           its title
    folder          where
    stages          titles of those that are to be made
    made            how many beds, touchdowns, samples, ... are to be made, at least and at most
    beds            of the study, with those that need not be poured; the most of them that a half width may ask for
                    behind it, where that is not known yet
    runs            the touchdowns with the fewest and with the most kept inputs, or that a half width may ask for; one,
                    where these are known
    half_width      to expect of the answer; None where that cannot be said
    process_count   here; None for a cluster
    seconds         from and to, by what takes them; None where nobody knows
    basis           where the seconds come from, in a sentence
    bytes           of all files when finished, by what they hold
    free_bytes      where the folder is
    warnings        in sentences, the most important first
    runs_a_bed      and the number that is best for the time; None without landers on several beds
    grains          of the beds; None where all have one size
    boulders        of the beds; None where there are none
    tile            of ground that repeats; None where it does not
    site_slope_deg  of the ground at the site, against gravity and rotation together
    ground          of the first touchdowns of journeys; None for other studies
    soils           of regions of the body; None where it has one soil
    delivery        where and when landers that are delivered as states reach the ground; None for others
    inference       what observed bounces would say of the inputs; None where that is not asked
    difference      how well the difference to another study will be known; None where that is not asked
    """

    study: str
    folder: str
    stages: tuple[str, ...]
    made: Mapping[str, tuple[int, int]]
    beds: tuple[planned_ground.PlannedBeds, ...]
    runs: tuple[PlannedRuns, ...]
    half_width: ExpectedHalfWidth | None
    process_count: int | None
    seconds: Mapping[str, Span | None]
    basis: str
    bytes: Mapping[str, int]
    free_bytes: int
    warnings: tuple[str, ...]
    site_slope_deg: float
    runs_a_bed: RunsABed | None = None
    grains: planned_ground.PlannedGrains | None = None
    boulders: planned_ground.PlannedBoulders | None = None
    tile: planned_ground.PlannedTile | None = None
    ground: planned_ground.PlannedGround | None = None
    soils: planned_ground.PlannedSoils | None = None
    kinds: tuple[planned_ground.PlannedKind, ...] = ()
    delivery: str | None = None
    inference: ExpectedInference | None = None
    difference: ExpectedDifference | None = None

    @property
    def time(self) -> Span:
        """Time of all that is known [s], from and to."""
        spans = [span for span in self.seconds.values() if span is not None]
        return sum(lower for lower, _ in spans), sum(upper for _, upper in spans)

    def to_json(self) -> dict[str, Any]:
        """All of it as JSON values."""
        runs = [asdict(one) | {"known": len(one.known), "new": one.new, "total": one.total} for one in self.runs]
        beds = [asdict(one) | {"new": one.new} for one in self.beds]
        return asdict(self) | {"beds": beds, "runs": runs, "time": self.time}


def plan_lines(plan: Plan) -> list[str]:
    """Return the whole plan as lines of text."""
    lines = [f"{plan.study}, in {plan.folder}"]
    if not plan.stages:
        lines += ["Nothing to do: all files are current."]
    else:
        lines += [f"To make: {_made(plan)}."]
        lines += [f"Beds: {_beds(plan)}."] if plan.beds[0].total else []
        lines += [plan.runs_a_bed.line()] if plan.runs_a_bed else []
        lines += [f"Touchdowns: {_designs(plan)}.", f"Time: {_time(plan)}."]
        lines += [f"  {what}: {_seconds(*part)}" for what, part in plan.seconds.items() if part is not None]
        lines += [f"  {plan.basis}"]
    lines += [_site(plan.site_slope_deg)]
    lines += [plan.ground.line()] if plan.ground else []
    lines += [plan.soils.line()] if plan.soils else []
    lines += [kind.line() for kind in plan.kinds]
    lines += [plan.delivery] if plan.delivery else []
    lines += [plan.tile.line()] if plan.tile else []
    lines += [plan.grains.line()] if plan.grains else []
    lines += [plan.boulders.line()] if plan.boulders else []
    size, free = bytes_in_words(sum(plan.bytes.values())), bytes_in_words(plan.free_bytes)
    lines += [f"Disk: about {size} when finished; {free} are free."]
    lines += plan.half_width.lines() if plan.half_width else []
    lines += plan.difference.lines() if plan.difference else []
    lines += plan.inference.lines() if plan.inference else []
    lines += [f"Warnings: {len(plan.warnings) or 'none'}."]
    return lines + [f"  {number}. {warning}" for number, warning in enumerate(plan.warnings, start=1)]


def brief_lines(plan: Plan, command: str) -> list[str]:
    """A plan in three lines; command: what says all of it."""
    count = len(plan.warnings)
    said = "No warnings." if count == 0 else f"{count} warning{'s, the first' * (count > 1)}: {plan.warnings[0]}"
    return [
        f"To make: {_made(plan)}.",
        f"Expected: {_time(plan)}; {bytes_in_words(sum(plan.bytes.values()))} on disk when finished.",
        f"{said} Full plan: {command}",
    ]


def _made(plan: Plan) -> str:
    counts = [f"{_range(*ends)} {NAMES[what][ends[1] > 1]}" for what, ends in plan.made.items() if ends[1]]
    return ", ".join(counts) or "summary and report"


def _beds(plan: Plan) -> str:
    fewest, most = plan.beds[0], plan.beds[-1]
    there = f"{most.in_folder} in the folder, {most.in_library} in the library of beds"
    return f"{_range(fewest.total, most.total)}; {there}, {_range(fewest.new, most.new)} to pour"


def _site(slope_deg: float) -> str:
    if slope_deg > 90.0:
        return "Site: gravity and rotation together eject objects that rest on the ground."
    return f"Site: the ground slopes by {slope_deg:.0f} deg against gravity and rotation together."


def _designs(plan: Plan) -> str:
    fewest, most = plan.runs[0], plan.runs[-1]
    if most.drawn:
        side = f", {most.side} side runs" if most.side else ""
        until = ", until design.half_width is met" if fewest is not most else ""
        drawn, total = _range(fewest.drawn, most.drawn), _range(fewest.total, most.total)
        if plan.made["journeys to rest"][1]:
            known = f"{len(most.known)} first touchdowns are known and reused"
            return f"{drawn} journeys{until}, mostly of one to four touchdowns each; {known}"
        return f"{drawn} drawn{until}{side}; {total} in all, of which {len(most.known)} are known and reused"
    kept = (
        f"{_range(fewest.kept_count, most.kept_count)} kept inputs" if fewest is not most else f"{most.kept_count} kept"
    )
    asked = (
        f"{most.screening} screening, {_range(fewest.refined, most.refined)} refined ({kept}), {most.test} test runs"
    )
    return f"{asked}; {_range(fewest.total, most.total)} in all, of which {len(most.known)} are known and reused"


def _time(plan: Plan) -> str:
    workers = plan.process_count
    where = f" on {workers} process{'es' * (workers != 1)}" if workers else ""
    unknown = [what for what, span in plan.seconds.items() if span is None]
    if not unknown:
        return f"about {_seconds(*plan.time)}{where}"
    why = "before some have been made" if workers else "on a cluster"
    return f"about {_seconds(*plan.time)}{where}, and the {' and '.join(unknown)}, whose time is not known {why}"


def _seconds(lower: float, upper: float) -> str:
    (first, unit), (last, other) = (
        (seconds / size, sign) for seconds in (lower, upper) for size, sign in [unit_of_time(seconds)]
    )
    if unit == other:
        return f"{_range(first, last)} {unit}"
    return f"{_rounded(first)} {unit} to {_rounded(last)} {other}"


def bytes_in_words(count: float) -> str:
    for limit, unit, size in ((1e6, "kB", 1e3), (1e9, "MB", 1e6), (1e12, "GB", 1e9)):
        if count < limit:
            return f"{_rounded(count / size)} {unit}"
    return f"{_rounded(count / 1e12)} TB"


def _range(lower: float, upper: float) -> str:
    """Two numbers, or one where they read the same; without a lower end where that is none."""
    ends = [thousands(end) if isinstance(end, int) else _rounded(end) for end in (lower, upper)]
    if ends[0] == ends[1]:
        return ends[0]
    return f"up to {ends[1]}" if lower == 0 else f"{ends[0]} to {ends[1]}"


def _rounded(number: float) -> str:
    """Two digits, never in powers of ten."""
    return f"{float(f'{number:.2g}'):.15g}"
