"""What became of the landers: shares, times and speeds, ellipses, and where they rest."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from lithobrake.pipeline.answer.scope import scope
from lithobrake.pipeline.emulate.samples import MISSING, SAMPLE_OUTCOMES, Samples
from lithobrake.pipeline.fly.flights import QUANTILES, flight_numbers, read_table
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.site import Site
from lithobrake.study import Study
from lithobrake.vocabulary.outcomes import FlightStatus, JourneyStatus, SampleOutcome, TouchdownOutcome

# In the order of the summary.
FLIGHTS = (FlightStatus.IMPACT, FlightStatus.FLYING, FlightStatus.ESCAPED, FlightStatus.PARTNER)
NORMAL_QUANTILE_90 = 1.6448536269514722
Rows = Sequence[dict[str, str]]


def dispersion_results(job: Job, samples: Samples, flights: Rows, run_outcomes: Mapping[str, int]) -> dict[str, Any]:
    """The parts of the summary that come from flights and journeys; run_outcomes: how often each came in the runs."""
    study = job.study
    holds = Site(study).holds
    results: dict[str, Any] = {}
    results["shares"] = shares(samples, flights, run_outcomes, holds=holds) | {"why": scope(study).why}
    results["returns"] = return_fraction(study, results["shares"], sum(run_outcomes.values()))
    results["flights"] = flight_numbers(flights) | job.folder.read_json("flights.json")
    results["ellipses"] = ellipses(study, flights, FlightStatus.IMPACT)
    results["without_scatter"] = None
    if samples.without_scatter is not None:
        alone = read_table(job.folder, "flights_without_scatter.csv")
        results["without_scatter"] = {
            "shares": shares(samples.expansion_alone(), alone, run_outcomes, holds=holds),
            "flights": flight_numbers(alone),
            "ellipses": ellipses(study, alone, FlightStatus.IMPACT),
        }
    results["rest"] = rest_results(job)
    return results


def shares(samples: Samples, flights: Rows, run_outcomes: Mapping[str, int], *, holds: bool) -> dict[str, Any]:
    """What became of the samples, as shares of all that were looked at.

    When not all leaving samples flew, only the samples up to the last that flew are looked at: they are a random part
    of all. `returns` = down again in time, or captured where the site `holds` what lies there; `missing` = left
    sideways, in contact at the time limit, or outside, after which nobody knows where the lander is.
    upper_limit: of an outcome that none of the runs had, which its share of 0 does not say (95 %).
    """
    from lithobrake.analysis import upper_limit

    total = len(samples.outcome)
    if len(flights) < int(samples.leaves.sum()):
        total = int(flights[-1]["sample"]) + 1
    met = np.bincount(samples.outcome[:total], minlength=len(SAMPLE_OUTCOMES)).tolist()
    counts = dict(zip(SAMPLE_OUTCOMES, met, strict=True))
    del counts[SampleOutcome.CLEAR]
    statuses = [row["status"] for row in flights]
    counts |= {status: statuses.count(status) for status in FLIGHTS}
    counts["returns"] = counts[FlightStatus.IMPACT] + (counts[SampleOutcome.CAPTURED] if holds else 0)
    counts["missing"] = sum(counts[name] for name in MISSING)
    table: dict[str, Any] = {"sample_count": total, "flight_count": len(flights)}
    table |= {name: proportion(count, total) for name, count in counts.items()}
    for name in set(TouchdownOutcome) - {TouchdownOutcome.CLEAR, *run_outcomes}:
        table[name]["upper_limit"] = upper_limit(sum(run_outcomes.values()))
    return table


def return_fraction(study: Study, table: Mapping[str, Any], run_count: int) -> dict[str, Any]:
    """The return fraction, without an interval, which runs on one bed or at one place do not give."""
    total, returning = table["sample_count"], table["returns"]
    return {
        "share": returning["share"],
        "lower": None,
        "upper": None,
        "level": 0.9,
        "from": f"{total} samples of an expansion of {run_count} landings {scope(study).landings}",
        "next_bed": None,
        "if_missing": [returning["share"], returning["share"] + table["missing"]["share"]],
        "missing": table["missing"]["share"],
        "emulator": returning["share"],
        "why": scope(study).why,
    }


def ellipses(study: Study, rows: Rows, status: str) -> dict[str, Any] | None:
    """Ellipses that hold half and 95 % of the places of the rows with this status; None where there are none.

    The axes in metres are the angles times the radius at the middle.
    """
    from lithobrake.analysis import dispersion_ellipses

    down = [row for row in rows if row["status"] == status]
    latitude, longitude = (np.array([float(row[f"{name}_deg"]) for row in down]) for name in ("latitude", "longitude"))
    found = dispersion_ellipses(latitude, longitude)
    if found is None:
        return None
    centre = Site(study).body.shape.surface_point(found.latitude_deg, found.longitude_deg)
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


def rest_results(job: Job) -> dict[str, Any]:
    """What became of the samples that were followed, on each ground."""
    rows, known = read_table(job.folder, "rest.csv"), job.folder.read_json("rest.json")
    table: dict[str, Any] = {"why_no_soil": known["why_no_soil"], "trained_ranges": known["trained_ranges"]}
    for ground in ("soil", "hard", "equivalent"):
        part = [row for row in rows if row["ground"] == ground]
        table[ground] = _ends(job.study, part, known["trained_ranges"]) if part else None
        if part:
            table[ground]["of"] = followed_words(job.study, ground, len(part))
    if table["hard"] is not None:
        _put_sampling_intervals(table["hard"])
    return table


def followed_words(study: Study, ground: str, count: int) -> str:
    """Which journeys the numbers of a ground describe, and what of the study they depend on."""
    if ground == "hard":
        return (
            f"{count} journeys on the hard ground of [rest], from the impacts of the study file; no soil, bed or "
            "emulator takes part in them"
        )
    model = "expansion" if study.design.method == "paper" else "emulator"
    on = "" if ground == "soil" else " on hard ground with the restitution that the soil implies"
    return f"{count} journeys of samples of the {model}{on}"


def _put_sampling_intervals(table: dict[str, Any]) -> None:
    """Fill in the bounds of shares that depend on nothing but the samples drawn. Source: [Wilson-1927]."""
    from lithobrake.analysis import LEVEL, wilson_interval

    for entry in table.values():
        if isinstance(entry, dict) and "count" in entry:
            lower, upper = wilson_interval(entry["count"], table["sample_count"], NORMAL_QUANTILE_90)
            entry |= {"lower": lower, "upper": upper}
    table |= {"level": LEVEL, "why": None}


def _ends(study: Study, rows: Rows, ranges: dict[str, list[float]]) -> dict[str, Any]:
    """Shares of each end, and the numbers of the landers that settled."""
    statuses = [row["status"] for row in rows]
    table: dict[str, Any] = {"sample_count": len(rows)}
    table |= {name: proportion(statuses.count(name), len(rows)) for name in JourneyStatus}
    table["slid"] = proportion(sum(float(row["slid_length"]) > 0.0 for row in rows), len(rows))
    settled = [row for row in rows if row["status"] == JourneyStatus.SETTLED]
    for name in ("time_s", "path_length", "rebounds", "slid_length", "slid_time_s") if settled else ():
        values = np.array([float(row[name]) for row in settled])
        table[name] = {f"quantile_{level:g}": float(np.quantile(values, level)) for level in QUANTILES}
    table["ellipses"] = ellipses(study, rows, JourneyStatus.SETTLED)
    lowest = ranges.get("impact.speed", [0.0])[0]
    # Most journeys that leave the range of the runs have become too slow for it; some ended at the first impact.
    outside = [float(row["impact_speed"] or "inf") for row in rows if row["status"] == JourneyStatus.OUTSIDE]
    too_slow = sum(speed < lowest for speed in outside)
    table["outside_too_slow"] = proportion(too_slow, len(rows))
    return table


def proportion(count: int, total: int) -> dict[str, Any]:
    """A count and its share of a total; no interval, which would have to hold for other beds and places."""
    return {"count": count, "share": count / total, "lower": None, "upper": None}
