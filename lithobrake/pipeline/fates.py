"""What became of the landers: shares with their intervals, times and speeds, ellipses, and where they rest."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from lithobrake.pipeline.flights import QUANTILES, flight_numbers, read_table
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.samples import Samples
from lithobrake.site import site_body
from lithobrake.study import Study

# How a journey from bounce to bounce may end (docs/flights.md).
ENDS = ("settled", "lofted", "outside", "flying", "escaped", "partner", "sliding", "bouncing")
Rows = Sequence[dict[str, str]]


def landing_results(job: Job, samples: Samples, flights: list[dict[str, str]]) -> dict[str, Any]:
    """The parts of the summary that come from flights and journeys."""
    study = job.study
    results: dict[str, Any] = {}
    results["shares"] = shares(samples, flights)
    results["flights"] = flight_numbers(flights) | job.folder.read_json("flights.json")
    results["ellipses"] = ellipses(study, flights, ("impact",))
    results["without_scatter"] = None
    if samples.without_scatter is not None:
        alone = read_table(job.folder, "flights_without_scatter.csv")
        results["without_scatter"] = {
            "shares": shares(samples.expansion_alone(), alone),
            "flights": flight_numbers(alone),
            "ellipses": ellipses(study, alone, ("impact",)),
        }
    results["rest"] = _rest(job)
    return results


def shares(samples: Samples, flights: list[dict[str, str]]) -> dict[str, Any]:
    """What became of the samples, as shares of all that were looked at, with their 95 % intervals.

    When not all leaving samples flew, only the samples up to the last that flew are looked at: they are a random part
    of all, so each share is a plain binomial one. `remains` = captured, no outward velocity, or down again in time.
    """
    total = len(samples.stays)
    if len(flights) < int((~samples.stays).sum()):
        total = int(flights[-1]["sample"]) + 1
    captured, stays = samples.captured[:total], samples.stays[:total]
    counts = {"captured": int(captured.sum()), "no_outward_velocity": int((stays & ~captured).sum())}
    statuses = [row["status"] for row in flights]
    counts |= {status: statuses.count(status) for status in ("impact", "flying", "escaped", "partner")}
    counts["remains"] = counts["captured"] + counts["no_outward_velocity"] + counts["impact"]
    table: dict[str, Any] = {"sample_count": total, "flight_count": len(flights)}
    return table | {name: proportion(count, total) for name, count in counts.items()}


def ellipses(study: Study, rows: Rows, statuses: Sequence[str]) -> dict[str, Any] | None:
    """Ellipses that hold half and 95 % of the places of the rows with these statuses; None where there are none.

    The axes in metres are the angles times the radius at the middle.
    """
    from lithobrake.analysis import landing_ellipses

    down = [row for row in rows if row["status"] in statuses]
    latitude, longitude = (np.array([float(row[f"{name}_deg"]) for row in down]) for name in ("latitude", "longitude"))
    found = landing_ellipses(latitude, longitude)
    if found is None:
        return None
    centre = site_body(study).shape.surface_point(found.latitude_deg, found.longitude_deg)
    radius = float(np.linalg.norm(centre))
    return {
        "latitude_deg": found.latitude_deg,
        "longitude_deg": found.longitude_deg,
        "heading_deg": found.heading_deg,
        "shares": [
            {"share": share, "semi_axes_deg": list(axes), "semi_axes_m": (np.radians(axes) * radius).tolist()}
            for share, axes in found.semi_axes_deg.items()
        ],
    }


def _rest(job: Job) -> dict[str, Any]:
    """What became of the samples that were followed, on each ground."""
    rows, known = read_table(job.folder, "rest.csv"), job.folder.read_json("rest.json")
    table: dict[str, Any] = {"why_no_soil": known["why_no_soil"], "trained_ranges": known["trained_ranges"]}
    for ground in ("soil", "hard"):
        part = [row for row in rows if row["ground"] == ground]
        table[ground] = _ends(job.study, part, known["trained_ranges"]) if part else None
    return table


def _ends(study: Study, rows: Rows, ranges: dict[str, list[float]]) -> dict[str, Any]:
    """Shares of each end with their 95 % intervals, and the numbers of the landers that settled."""
    statuses = [row["status"] for row in rows]
    table: dict[str, Any] = {"sample_count": len(rows)}
    table |= {name: proportion(statuses.count(name), len(rows)) for name in ENDS}
    settled = [row for row in rows if row["status"] == "settled"]
    for name in ("time_s", "path_length", "rebounds") if settled else ():
        values = np.array([float(row[name]) for row in settled])
        table[name] = {f"quantile_{level:g}": float(np.quantile(values, level)) for level in QUANTILES}
    table["ellipses"] = ellipses(study, rows, ("settled",))
    lowest = ranges.get("impact.speed", [0.0])[0]
    # Most journeys that leave the range of the runs have become too slow for it.
    too_slow = sum(row["status"] == "outside" and float(row["impact_speed"]) < lowest for row in rows)
    table["outside_too_slow"] = proportion(too_slow, len(rows))
    return table


def proportion(count: int, total: int) -> dict[str, Any]:
    """A count, its share of a total, and the 95 % interval of that."""
    from lithobrake.analysis import wilson_interval

    lower, upper = wilson_interval(count, total)
    return {"count": count, "share": count / total, "lower": lower, "upper": upper}
