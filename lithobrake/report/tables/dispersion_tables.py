"""Tables of where the landers end."""

from collections.abc import Mapping
from typing import Any

from lithobrake.report.content import PageTable
from lithobrake.report.page_data import DrawnPage, PageData, PaperPage, SampledPage
from lithobrake.report.words.captions import thousands
from lithobrake.report.words.numbers import area, flat, number
from lithobrake.results.dispersion import GroundResults, ImpactNumber
from lithobrake.results.journey_results import JourneyRest
from lithobrake.results.result_files import json_values
from lithobrake.results.run_results import CountedShare, EmulatorShares
from lithobrake.vocabulary.durations import hours
from lithobrake.vocabulary.outcomes import FlightStatus, JourneyStatus, SampleOutcome
from lithobrake.vocabulary.percentages import QUANTILE_WORDS, percent, with_interval

OUTCOME_WORDS: dict[str, str] = {
    FlightStatus.IMPACT: "impact the surface again within {hours}",
    FlightStatus.FLYING: "still flying after {hours}",
    FlightStatus.ESCAPED: FlightStatus.ESCAPED.label,
    FlightStatus.PARTNER: "impact the partner within {hours}",
    **{outcome: outcome.label for outcome in SampleOutcome if outcome != SampleOutcome.CLEAR},
    "failed": "failed",
    "returns": "return fraction (impact again, or captured where the ground holds them)",
    "missing": "unknown outcome",
}
# Each holds others of the table.
SUMS = ("returns", "missing")
# Landings without an outcome, by reason.
LOST = (SampleOutcome.LEFT_SIDEWAYS, SampleOutcome.TIME_LIMIT, SampleOutcome.OUTSIDE, "failed")
JOURNEY_WORDS: dict[str, str] = {
    JourneyStatus.SETTLED: "at rest",
    JourneyStatus.LOFTED: "captured, then lifted off by rotation",
    JourneyStatus.OUTSIDE: "unknown outcome: impact outside the training range of the {model}, or unphysical rebound",
    "outside_too_slow": "(of these: impact slower than in any run)",
    JourneyStatus.SLIDING: "still sliding after {hours}",
    JourneyStatus.BOUNCING: "still bouncing after a thousand bounces",
    JourneyStatus.FLYING: "not at rest after {hours}",
    JourneyStatus.ESCAPED: JourneyStatus.ESCAPED.label,
    JourneyStatus.PARTNER: "on the partner",
    "slid": "(of all: slid along the ground at some time)",
}
GROUND_WORDS = {"soil": "soil", "hard": "hard ground", "equivalent": "hard ground like the soil"}
QUANTILES = tuple(f"quantile_{level}" for level in QUANTILE_WORDS)
ACCELERATIONS = ("effective_acceleration_outward", "effective_acceleration_along_heading")


def outcome_words(data: SampledPage) -> dict[str, str]:
    """What may become of a landing, in words; the partner is left out where there is none.

    So is the return fraction where the ground holds nothing: it is then the share of those that impact again.
    """
    site, known = data.results.site, data.results.shares
    absent: set[str] = set() if site.partner else {FlightStatus.PARTNER}
    if not site.holds:
        absent.add("returns")
    return {key: text for key, text in OUTCOME_WORDS.items() if key in known.outcomes and key not in absent}


def parts(data: SampledPage) -> dict[str, str]:
    """Those of the outcomes that add up to the whole, in words; `lost` landings of a drawn study are in no other."""
    absent = SUMS if isinstance(data, PaperPage) else (*SUMS, *LOST)
    return {key: words for key, words in outcome_words(data).items() if key not in absent}


def site_tables(data: PageData) -> list[PageTable]:
    """Where the study lands, and how exact its flights are."""
    return [_site(data)]


def place_tables(data: SampledPage) -> list[PageTable]:
    """What becomes of the landers, and the regions that hold them."""
    return [_outcomes(data), _statuses(data), _regions(data)]


def time_tables(data: SampledPage) -> list[PageTable]:
    """Flights to the next impact, and journeys to rest."""
    return [_flights(data), _journeys(data)]


def _outcomes(data: SampledPage) -> PageTable:
    return _outcomes_of_landings(data) if isinstance(data, DrawnPage) else _outcomes_of_samples(data)


def _outcomes_of_landings(data: DrawnPage) -> PageTable:
    """Outcomes of the runs of a drawn study, beside what the emulator gives."""
    shares, limit = data.results.shares, hours(data.study["flight"]["duration"])
    level = percent(data.level)
    columns = ["outcome", f"share of the landings ({level} interval)", f"by the {data.model}"]
    known, whole = outcome_words(data), parts(data)
    shown = whole | {key: known[key] for key in SUMS if key in known}
    shown |= {key: f"(of these: {known[key]})" for key in LOST if key in known and shares.outcomes[key].count}
    rows = [
        [words.format(hours=limit), with_interval(shares.outcomes[key].share), _by_emulator(shares.emulator, key)]
        for key, words in shown.items()
    ]
    flown = 0 if shares.emulator is None else shares.emulator.flight_count
    note = (
        f"Of all landings, from {thousands(shares.flight_count)} flights of the runs; the first {len(whole)} rows add "
        f"up to 100 %. Last column: {thousands(flown)} propagated samples of the {data.model}."
    )
    if shares.outcomes["missing"].count:
        note += (
            " Landings with unknown outcome are treated like those that left in flight across the edge of the bed; "
            "every interval covers all their possible outcomes."
        )
    note += f" {shares.why}" if shares.why else ""
    return PageTable("After the first bounce", columns, rows, note, frozenset(columns[1:]))


def _by_emulator(shares: EmulatorShares | None, key: str) -> str:
    """A share of the samples: unknown outcomes are shares of all, the others of those with an outcome, as by runs."""
    if shares is None or key not in shares.outcomes:
        return ""
    known = shares.sample_count - shares.outcomes["missing"].count
    total = shares.sample_count if key in (*LOST, "missing") else known
    return percent(shares.outcomes[key].count / total) if total else ""


def _outcomes_of_samples(data: SampledPage) -> PageTable:
    """Outcomes of the samples of an expansion, which have no interval."""
    shares, limit = data.results.shares, hours(data.study["flight"]["duration"])
    alone = data.results.without_scatter
    columns = ["outcome", "samples", "share", *(["without scatter"] if alone else [])]
    rows = []
    for key, words in outcome_words(data).items():
        row = [words.format(hours=limit), str(shares.outcomes[key].count), _share(shares.outcomes[key], data.digits)]
        rows.append(row + ([_share(alone.shares.outcomes[key], data.digits)] if alone else []))
    note = f"Shares of {shares.sample_count} samples, {shares.flight_count} of them propagated. {shares.why}"
    if any(shares.outcomes[key].upper_limit is not None for key in outcome_words(data)):
        note += f' "At most": no run had this outcome; upper limit at {percent(data.level)} confidence.'
    if alone:
        note += (
            " The first shares include the run-to-run scatter; those without scatter are of the expansion alone, from "
            f"{alone.shares.sample_count} samples."
        )
    return PageTable("After the first bounce", columns, rows, note, frozenset(columns[1:]))


def _share(entry: CountedShare, alone: int) -> str:
    """A share, with its interval if it has one, or the largest that an outcome may have which no run had."""
    limit = entry.upper_limit
    return with_interval(entry.share, alone) if limit is None else f"at most {percent(limit, 1)}"


def _flights(data: PageData) -> PageTable:
    """Times, speeds and incidences of the impacts, and how exact the flights are."""
    flights, words = data.results.flights, {"time_s": "time of flight [s]", "impact_speed": "impact speed [m/s]"}
    words |= {"impact_incidence_deg": "incidence at the impact, from the normal [deg]"}
    columns = ["flights that impact the surface again", "5 %", "median", "95 %"]
    known = flights.impacts.known
    rows = [[words[key], *(_with_ends(one, level) for level in QUANTILES)] for key, one in known.items()]
    checks = flights.checks
    error = None if checks is None else checks.gravity_table_error
    whose = next((f"Of {one.of}. " for one in known.values() if one.of), "")
    note = f"{whose}Gravity is summed over the facets."
    if error:
        note = (
            f"{whose}Gravity is interpolated in a table; relative to surface gravity its error against the sum over "
            f"the facets is {number(error.median, 2)} in the median and {number(error.p95, 2)} at the 95th percentile "
            f"of {error.point_count} points."
        )
    if checks is not None and checks.jacobi_drift_largest_m2_s2 is not None:
        note += (
            f" The Jacobi constant of {checks.jacobi_flight_count} flights changes by "
            f"{number(checks.jacobi_drift_largest_m2_s2, 2)} m2/s2 at most, without the partner."
        )
    return PageTable("Flights to the next impact", columns, rows, note, frozenset(columns[1:]))


def _with_ends(entry: ImpactNumber, level: str) -> str:
    """A quantile, with its interval where it has one."""
    ends = (entry.intervals or {}).get(level)
    shown = number(entry.quantiles[level])
    return shown if ends is None else f"{shown} ({number(ends[0])} to {number(ends[1])})"


def followed(data: PageData) -> dict[str, GroundResults]:
    """The grounds on which samples were followed, with what became of them."""
    return data.results.rest.grounds


def _statuses(data: SampledPage) -> PageTable:
    found, limit = followed(data), hours(data.study["rest"]["duration"])
    columns = ["after all bounces", *(GROUND_WORDS[ground] for ground in found)]
    rows = []
    for key, words in JOURNEY_WORDS.items():
        if any(table.counts[key].count for table in found.values()):
            rows.append(
                [
                    words.format(hours=limit, model=data.model),
                    *(_share(table.counts[key], data.digits) for table in found.values()),
                ]
            )
    of = "; ".join(f"{GROUND_WORDS[ground]}: {table.of}" for ground, table in found.items())
    note = f"From the first impact. {of[:1].upper()}{of[1:]}."
    rest = data.results.rest
    why = None if isinstance(rest, JourneyRest) else rest.why_no_soil
    note += f" No trajectories on the soil: {why}." if why else ""
    return PageTable("From bounce to bounce", columns, rows, note, frozenset(columns[1:]))


def _journeys(data: SampledPage) -> PageTable:
    columns = ["landers at rest", "ground", "5 %", "median", "95 %"]
    words = {"time_s": "time to rest [s]", "rebounds": "rebounds", "path_length": "path [m]"}
    words |= {"slid_length": "sliding distance [m]", "slid_time_s": "sliding time [s]"}
    rows = [
        [words[key], GROUND_WORDS[ground], *(number(table.quantiles[key][level]) for level in QUANTILES)]
        for key in words
        for ground, table in followed(data).items()
        if key in table.quantiles
    ]
    rest = data.study["rest"]
    note = (
        f"Hard ground: restitution {rest['normal_restitution']:g} normal, {rest['tangential_restitution']:g} "
        f"tangential, friction {rest['friction']:g}; at rest where a rebound rises less than "
        f"{rest['rest_height']:g} m. Hard ground like the soil samples the restitution that the soil implies at "
        "each speed and incidence (restitution.csv). The path is the sum of straight lines between impacts. A "
        f"captured lander {_sliding(rest)} from facet to facet until it rests or leaves the ground again; this law "
        "was not fitted to landings, and on soil the slide starts from rest, because the runs have no velocity after "
        "capture."
    )
    return PageTable("Journeys to rest", columns, rows, note, frozenset(columns[2:]))


def _sliding(rest: Mapping[str, Any]) -> str:
    """The law by which a captured lander moves on, in words."""
    if rest["rolling_friction"] is not None:
        return f"rolls on like a sphere against a resistance of {rest['rolling_friction']:g} of the normal force,"
    return "slides on by Coulomb friction, on soil that of hull and grain,"


def _regions(data: SampledPage) -> PageTable:
    sets = {"next impacts": data.results.regions}
    sets |= {f"at rest, {GROUND_WORDS[ground]}": table.regions for ground, table in followed(data).items()}
    columns = ["points", "share inside", "area", "largest extent [m]"]
    rows = [
        [name, percent(one.share), area(one.area_m2), number(one.largest_extent_m, 2)]
        for name, found in sets.items()
        for one in found
    ]
    note = "The smallest regions that hold that share, from a density fitted to the points."
    return PageTable("Landing regions", columns, rows, note if rows else "", frozenset(columns[1:]))


def _site(data: PageData) -> PageTable:
    rows = flat(json_values(data.results.site), alike=(("extents_m", "centroid_m", "place_m"), ACCELERATIONS))
    return PageTable("Site and body", ["name", "value"], rows, "m, kg, s, m/s2; degrees where named.")
