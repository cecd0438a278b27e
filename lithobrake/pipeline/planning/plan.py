"""What a study will do: how many of each it will make, how long that takes, how much room, and what to know of it."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from lithobrake.pipeline.inference.expected_inference import ExpectedInference
from lithobrake.pipeline.planning.expected_time import Span
from lithobrake.pipeline.planning.expected_width import ExpectedHalfWidth
from lithobrake.pipeline.planning.planned_beds import PlannedBeds, PlannedBoulders, PlannedGrains, PlannedTile
from lithobrake.pipeline.planning.planned_ground import PlannedGround
from lithobrake.pipeline.planning.planned_runs import PlannedRuns
from lithobrake.pipeline.planning.planned_soils import PlannedSoils
from lithobrake.pipeline.planning.runs_a_bed import RunsABed


@dataclass(frozen=True)
class Plan:
    """What a study will do.

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
    runs_a_bed      of a drawn study, beside the number that is best for the time; None for others
    grains          of the beds; None where all have one size
    boulders        of the beds; None where there are none
    tile            of ground that repeats; None where it does not
    site_slope_deg  of the ground at the site, against gravity and rotation together
    ground          of the first touchdowns of journeys; None for other studies
    soils           of regions of the body; None where it has one soil
    delivery        where and when landers that are delivered as states reach the ground; None for others
    inference       what observed bounces would say of the inputs; None where that is not asked
    """

    study: str
    folder: str
    stages: tuple[str, ...]
    made: Mapping[str, tuple[int, int]]
    beds: tuple[PlannedBeds, ...]
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
    grains: PlannedGrains | None = None
    boulders: PlannedBoulders | None = None
    tile: PlannedTile | None = None
    ground: PlannedGround | None = None
    soils: PlannedSoils | None = None
    delivery: str | None = None
    inference: ExpectedInference | None = None

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
