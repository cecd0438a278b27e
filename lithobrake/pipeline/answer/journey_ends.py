"""How the journeys of a study ended, with intervals over beds: shares, times, places and attitudes at rest."""

from dataclasses import dataclass

import numpy as np

from lithobrake.analysis import highest_density, quantile_estimate, share_estimate
from lithobrake.files.reading import read_rows
from lithobrake.pipeline.answer.regions import SHARES, rest_regions
from lithobrake.pipeline.answer.scope import why_no_interval
from lithobrake.pipeline.folder.study_folder import AGAIN, StudyFolder
from lithobrake.results.journey_results import EndShare, JourneyRest, RestQuantile, RestQuantiles
from lithobrake.study import Study
from lithobrake.vocabulary.outcomes import JourneyEnd
from lithobrake.vocabulary.quantities import JOURNEYS_FILE

MEDIAN, Q95 = 0.5, 0.95


@dataclass(frozen=True)
class JourneyTable:
    """journeys.csv, all arrays [journey_count]; position [m], [journey_count, 3], body-fixed, NaN where it has none."""

    end: np.ndarray
    bed: np.ndarray
    numbers: dict[str, np.ndarray]
    position: np.ndarray
    face: np.ndarray

    @classmethod
    def load(cls, folder: StudyFolder) -> "JourneyTable":
        """Those of a folder. Raises DamagedFileError for another file."""
        rows = read_rows(folder / JOURNEYS_FILE, ("journey", "bed", "end", "face"), AGAIN)
        titles = {title.split(" ")[0]: title for title in rows[0]}

        def numbers(name: str) -> np.ndarray:
            return np.array([float(row[titles[name]] or "nan") for row in rows])

        return cls(
            end=np.array([row["end"] for row in rows]),
            bed=np.array([int(row["bed"]) for row in rows]),
            numbers={name: numbers(name) for name in ("time_s", "contacts", "distance", "tilt_deg", "touchdowns")},
            position=np.column_stack([numbers(f"position_{axis}") for axis in "xyz"]),
            face=np.array([row["face"] for row in rows]),
        )

    def taken(self, which: np.ndarray) -> "JourneyTable":
        """Some of the journeys, by their numbers."""
        numbers = {name: values[which] for name, values in self.numbers.items()}
        return JourneyTable(self.end[which], self.bed[which], numbers, self.position[which], self.face[which])

    @property
    def touchdowns(self) -> int:
        """How many landings all of them have."""
        return int(self.numbers["touchdowns"].sum())

    @property
    def rests(self) -> np.ndarray:
        """Which landers came to rest."""
        at_rest: np.ndarray = self.end == JourneyEnd.AT_REST.value
        return at_rest


def end_shares(study: Study, table: JourneyTable) -> dict[str, EndShare]:
    """The share of each end; they add up to 1."""
    why = why_no_interval(study)
    return {end.value: end_share(table.end == end.value, table.bed, why) for end in JourneyEnd}


def journey_rest(study: Study, table: JourneyTable) -> JourneyRest:
    """Where, when and how the landers rest."""
    why, rests = why_no_interval(study), table.rests

    def quantiles(name: str) -> RestQuantiles:
        values = np.where(rests, table.numbers[name], np.nan)
        counts = name == "contacts"
        return RestQuantiles(*(rest_quantile(values, table.bed, level, why, counts=counts) for level in (MEDIAN, Q95)))

    density = highest_density(table.position[rests], SHARES)
    faces = table.face[rests]
    has_sides = bool((faces != "").any())
    return JourneyRest(
        of=f"{int(rests.sum())} of {len(rests)} journeys that ended at rest",
        time_s=quantiles("time_s"),
        contacts=quantiles("contacts"),
        distance_m=quantiles("distance"),
        regions=rest_regions(density),
        faces={str(face): end_share(faces == face, table.bed[rests], why) for face in np.unique(faces) if has_sides},
        tilt_deg=quantiles("tilt_deg") if has_sides else None,
        why_no_regions=density.why,
    )


def rest_quantile(
    values: np.ndarray, bed: np.ndarray, level: float, why: str | None, *, counts: bool = False
) -> RestQuantile:  # fmt: skip
    """A quantile of values [count], NaN where there is none, with its interval over beds.

    why: there is no interval; counts: whether the values are whole numbers.
    """
    one = quantile_estimate(values, bed, level, counts=counts, why=why)
    return RestQuantile(one.value, one.lower, one.upper, one.why)


def end_share(
    met: np.ndarray, bed: np.ndarray, why: str | None = None, explained: np.ndarray | None = None
) -> EndShare:  # fmt: skip
    """The share of the journeys that have met an event [journey_count], with its interval over beds.

    explained: what something else predicts of each, of mean 0 over all journeys; taken off. why: there is no interval.
    """
    found = share_estimate(met.astype(float), bed, explained=explained, why=why)
    return EndShare(int(met.sum()), found.share, found.lower, found.upper, found.why)
