"""How the journeys of a study ended, over beds: shares, times, places, attitudes, soils and sky."""

import math
from dataclasses import dataclass, replace

import numpy as np

from lithobrake.analysis import highest_density, quantile_estimate, share_estimate
from lithobrake.files.reading import read_rows
from lithobrake.pipeline.answer.run_answers import KNOWN, SHARES, rest_regions, unknown_runs, why_no_interval
from lithobrake.pipeline.design.lander_attitude import seen, tells_attitude
from lithobrake.pipeline.design.soils import Soils
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.study_folder import AGAIN, StudyFolder
from lithobrake.results.journey_results import JourneyRest, RestQuantiles, SideResults, SkyResults, SoilResults
from lithobrake.results.run_results import CountedShare
from lithobrake.statements.ends import journeys_at_rest
from lithobrake.study import Study
from lithobrake.study.lander_section import side_words, sides_down
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.file_names import JOURNEYS_FILE, SKY_FILE, TOUCHDOWNS_FILE
from lithobrake.vocabulary.journey_names import JOURNEY_NUMBERS, SKY_HOURS
from lithobrake.vocabulary.number_words import HIGH, LOW, MEDIAN
from lithobrake.vocabulary.outcomes import JourneyEnd, TouchdownOutcome
from lithobrake.vocabulary.quantities import IMPACT_SPEED, SIDES, SOIL

Sides = dict[str, SideResults]
NUMBERS = tuple(name for name in JOURNEY_NUMBERS if name not in SKY_HOURS)


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
            numbers={name: numbers(name) for name in NUMBERS},
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

    @property
    def unknown(self) -> np.ndarray:
        """Of which journeys the end is not known: a landing or flight of them failed."""
        failed: np.ndarray = self.end == JourneyEnd.FAILED.value
        return failed

    def told(self, met: np.ndarray) -> np.ndarray:
        """Whether each journey has met an event: 1, 0, or NaN where its end is not known [journey_count]."""
        return np.where(self.unknown, np.nan, met.astype(float))

    def of_rest(self, name: str) -> np.ndarray:
        """A number of each lander at rest, NaN of the others [journey_count]."""
        values: np.ndarray = np.where(self.rests, self.numbers[name], np.nan)
        return values

    @property
    def has_sides(self) -> bool:
        """Whether all at rest have a side that is down: a program may tell of some alone, which are no sample."""
        faces = self.face[self.rests]
        return len(faces) > 0 and bool((faces != "").all())


def end_shares(study: Study, table: JourneyTable) -> dict[str, CountedShare]:
    """The share of each end; those but failed add up to 1, and their bounds hold whatever failed journeys came to."""
    why = why_no_interval(study)
    failed = JourneyEnd.FAILED
    met = {end: table.end == end.value for end in JourneyEnd}
    return {end.value: end_share(one if end is failed else table.told(one), table.bed, why) for end, one in met.items()}


def journey_rest(study: Study, table: JourneyTable) -> JourneyRest:
    """Where, when and how the landers rest."""
    why, rests = why_no_interval(study), table.rests

    def quantiles(name: str) -> RestQuantiles:
        values = table.of_rest(name)
        counts = name == "contacts"
        return RestQuantiles(
            *(
                quantile_estimate(values, table.bed, level, counts=counts, why=why, missing=table.unknown)
                for level in (MEDIAN, HIGH)
            )
        )

    density = highest_density(table.position[rests], SHARES)
    return JourneyRest(
        of=journeys_at_rest(int(rests.sum()), len(rests)),
        time_s=quantiles("time_s"),
        contacts=quantiles("contacts"),
        distance_m=quantiles("distance"),
        regions=rest_regions(density),
        faces=face_shares(table, why),
        tilt_deg=quantiles("tilt_deg") if table.has_sides else None,
        why_no_regions=density.why,
    )


def face_shares(table: JourneyTable, why: str | None) -> dict[str, CountedShare]:
    """The share of the landers at rest on each side, by name; one of unknown end may rest on any, or nowhere."""
    asked = table.taken(np.flatnonzero(table.rests | table.unknown))
    names = np.unique(table.face[table.rests]) if table.has_sides else ()
    return {str(name): end_share(asked.told(asked.face == name), asked.bed, why) for name in names}


def end_share(
    met: np.ndarray, bed: np.ndarray, why: str | None = None, explained: np.ndarray | None = None
) -> CountedShare:  # fmt: skip
    """The share of the journeys that have met an event [journey_count], with its interval over beds.

    met: NaN where that is not known. explained: what something else predicts of each, of mean 0 over all journeys;
    taken off. why: there is no interval.
    """
    if not np.isfinite(met.astype(float)).any():
        return CountedShare(0, Estimate(math.nan, None, None, why_missing=why or "no end is known"))
    found = share_estimate(met.astype(float), bed, explained=explained, why=why)
    return CountedShare(int(np.nansum(met)), found.share)


def first_sides(study: Study, runs: DesignRuns, returns: np.ndarray) -> Sides:
    """By side what the first touchdowns gave; empty where there is one side alone, or attitudes are not told.

    returns: share of the flights of each run that return, [run_count], NaN where that is not known.
    """
    side, bed, why = _sides(study, runs), runs.inputs["bed"], why_no_interval(study)
    ratio, lost = runs.output("speed_out") / runs.inputs[IMPACT_SPEED], unknown_runs(runs)
    found = {}
    for name in _named(side):
        own = side == name
        share = share_estimate(returns[own], bed[own], why=why).share
        found[name] = SideResults(
            words=side_words(study.lander, name),
            landings=int(own.sum()),
            speed_ratio=quantile_estimate(ratio[own], bed[own], MEDIAN, why=why, missing=lost[own]),
            returns=CountedShare(int((returns[own] == 1.0).sum()), share),
        )
    return found


def with_journeys(study: Study, sides: Sides, runs: DesignRuns, touchdowns: DesignRuns, table: JourneyTable) -> Sides:
    """The same with what the journeys of these first touchdowns came to, and what all their touchdowns did."""
    side, every, why = _sides(study, runs), _sides(study, touchdowns), why_no_interval(study)
    captured = np.array(touchdowns.outcomes) == TouchdownOutcome.CAPTURED
    captured = np.where(unknown_runs(touchdowns), np.nan, captured.astype(float))
    found = {}
    for name, one in sides.items():
        own, those = side == name, every == name
        time = table.of_rest("time_s")[own]
        found[name] = replace(
            one,
            at_rest=end_share(table.told(table.rests)[own], table.bed[own], why),
            time_s=quantile_estimate(time, table.bed[own], MEDIAN, why=why, missing=table.unknown[own]),
            touchdowns=int(those.sum()),
            rests=end_share(captured[those], touchdowns.inputs["bed"][those], why),
        )
    return found


def _sides(study: Study, runs: DesignRuns) -> np.ndarray:
    """The side that faces the ground at each touchdown [run_count]; "" where attitudes are not told."""
    if not tells_attitude(runs.inputs):
        return np.full(runs.run_count, "")
    return sides_down(study.lander, seen(runs.inputs)[0])


def _named(side: np.ndarray) -> list[str]:
    """The sides that occur, where they are several."""
    names = np.unique(side).tolist()
    return names if len(names) > 1 else []


def soil_shares(job: Job, table: JourneyTable) -> dict[str, SoilResults]:
    """By region, in the order of the study file and elsewhere last; empty for a study that has one soil."""
    if not job.study.soil:
        return {}
    rows = read_rows(job.folder / TOUCHDOWNS_FILE, ("journey", "outcome", "body", *SOIL), AGAIN)
    # Regions are of the body of the site, and so is the ground elsewhere.
    rows = [row for row in rows if row["body"] == job.site.ground_names[0]]
    journey, soil = np.array([int(row["journey"]) for row in rows]), np.array([row["soil"] for row in rows])
    outcome = np.array([row["outcome"] for row in rows])
    captured = np.where(np.isin(outcome, KNOWN), (outcome == TouchdownOutcome.CAPTURED).astype(float), np.nan)
    soils, why, found = Soils(job.site), why_no_interval(job.study), {}
    for name, area in soils.area_shares().items():
        there = soil == name
        rests = np.isin(np.arange(len(table.end)), journey[there & (captured == 1.0)])
        found[name] = SoilResults(
            area_share=area,
            touchdowns=int(there.sum()),
            rests=end_share(captured[there], table.bed[journey[there]], why)
            if np.isfinite(captured[there]).any()
            else None,
            at_rest=end_share(table.told(rests), table.bed, why),
            outlines=soils.outlines(name),
        )
    return found


def sky_results(study: Study, folder: StudyFolder, table: JourneyTable) -> dict[str, SkyResults]:
    """By the body that the study asks for; empty where it asks for none or no lander rests."""
    if not study.sky.bodies or not table.rests.any():
        return {}
    rows = read_rows(folder / SKY_FILE, ("journey", "body", "day_fraction", "least_day_fraction"), AGAIN)
    # Rows of landers on the partner are left out here.
    rows = [row for row in rows if table.rests[int(row["journey"])]]
    return {name: _of(study, [row for row in rows if row["body"] == name], table) for name in study.sky.bodies}


def _of(study: Study, rows: list[dict[str, str]], table: JourneyTable) -> SkyResults:
    """The results of one body."""
    why, own = why_no_interval(study), [int(row["journey"]) for row in rows]
    # A lander of unknown end may rest where it sees the body at all times, or never.
    bed, open_ = np.concatenate([table.bed[own], table.bed[table.unknown]]), np.full(table.unknown.sum(), np.nan)
    lost = np.arange(len(bed)) >= len(own)

    def column(name: str) -> np.ndarray:
        return np.concatenate([[float(row[name] or "nan") for row in rows], open_])

    def quantile(values: np.ndarray, level: float = MEDIAN) -> Estimate:
        return quantile_estimate(values, bed, level, why=why, missing=lost)

    def never(values: np.ndarray) -> CountedShare:
        return end_share(np.where(lost, np.nan, values == 0.0), bed, why)

    def probability(values: np.ndarray) -> Estimate:
        return share_estimate(values, bed, why=why).share

    seen = column("day_fraction")
    sides = {side: column(f"side_{side}") for side in SIDES if rows[0][f"side_{side}"]}
    return SkyResults(
        day_fraction=quantile(seen),
        day_fraction_q05=quantile(seen, LOW),
        least_day_fraction=quantile(column("least_day_fraction")),
        probability=probability(seen),
        never=never(seen),
        sides={side: quantile(values) for side, values in sides.items()},
        side_probabilities={side: probability(values) for side, values in sides.items()},
        dark_sides={side: never(values) for side, values in sides.items()},
    )
