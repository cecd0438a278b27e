"""What became of the landers that were followed on other ground."""

import numpy as np

from lithobrake.analysis import LEVEL, wilson_interval
from lithobrake.files.reading import read_rows
from lithobrake.pipeline.answer.dispersion_statistics import NORMAL_QUANTILE_90, Rows, ellipses, site_results
from lithobrake.pipeline.answer.run_answers import place_regions
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.journeys.hard_ground import EQUIVALENT, EXPANSION, HARD
from lithobrake.pipeline.study_folder import AGAIN
from lithobrake.results.dispersion import FollowedLanders
from lithobrake.results.run_results import CountedShare
from lithobrake.statements.touchdowns import followed
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.file_names import REST_FILE
from lithobrake.vocabulary.number_words import QUANTILES
from lithobrake.vocabulary.outcomes import JourneyEnd
from lithobrake.vocabulary.quantities import UNKNOWN_END

# Columns of rest.csv by the names of the results.
NUMBERS = {
    "time_s": "time_s", "distance_m": "distance", "path_length": "path_length", "touchdowns": "touchdowns",
    "slid_length": "slid_length", "slid_time_s": "slid_time_s",
}  # fmt: skip
# A failed landing is none of theirs.
ENDS = tuple(end for end in JourneyEnd if end != JourneyEnd.FAILED)
# The bounds of landers on hard ground stand for their number alone; other models bring errors that nothing measures.
NO_INTERVAL = "The error of the model that gives the rebounds is not known."


def followed_results(job: Job) -> dict[str, FollowedLanders]:
    """The landers of each ground; empty where none was followed."""
    if not job.study.hard_ground.count:
        return {}
    rows = read_rows(job.folder / REST_FILE, ("ground", "end"), AGAIN)
    parts = {ground: [row for row in rows if row["ground"] == ground] for ground in (HARD, EQUIVALENT, EXPANSION)}
    return {ground: _followed(job, ground, part) for ground, part in parts.items() if part}


def _followed(job: Job, ground: str, rows: Rows) -> FollowedLanders:
    total, ends = len(rows), [row["end"] for row in rows]
    known, rests = total - ends.count(UNKNOWN_END), [row for row in rows if row["end"] == JourneyEnd.AT_REST]
    why = None if ground == HARD else NO_INTERVAL
    return FollowedLanders(
        count=total,
        ends={end.value: _counted(ends.count(end), known, why) for end in ENDS},
        unknown=ends.count(UNKNOWN_END) / total,
        slid=_counted(sum(float(row["slid_length"]) > 0.0 for row in rows), total, why),
        **{name: _quantiles(rests, column) for name, column in NUMBERS.items()},
        ellipses=ellipses(job.site, rests),
        regions=place_regions(site_results(job.site), rests),
        of=followed(ground, total),
        level=LEVEL if why is None else None,
        why=why,
    )


def _counted(count: int, total: int, why: str | None) -> CountedShare:
    """A count and its share of a total, with the error of sampling unless `why` says that there is none to state.

    Source: [Wilson-1927].
    """
    if why is not None or not total:
        return CountedShare(count, Estimate(count / max(total, 1), None, None))
    return CountedShare(count, Estimate(count / total, *wilson_interval(count, total, NORMAL_QUANTILE_90)))


def _quantiles(rows: Rows, name: str) -> dict[str, float]:
    values = np.array([float(row[name]) for row in rows])
    if not len(values):
        return {}
    return {f"quantile_{level:g}": float(np.quantile(values, level)) for level in QUANTILES}
