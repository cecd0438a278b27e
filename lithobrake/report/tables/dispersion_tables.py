"""Tables of where landers are after their first touchdown and on other ground, of the site, and of the execution."""

from collections.abc import Mapping

from lithobrake.report.content import PageTable, flat, show, table_cell
from lithobrake.results.dispersion import ImpactNumber
from lithobrake.results.model_results import SampleResults
from lithobrake.results.page_data import PageData
from lithobrake.results.run_results import CountedShare
from lithobrake.results.study_files import json_values
from lithobrake.statements import notes
from lithobrake.statements.ends import MISSING_SAMPLES
from lithobrake.statements.labels import (
    FAILED,
    GROUND_WORDS,
    OUTCOME_WORDS,
    area,
    bracket,
    end_words,
    two_digits,
)
from lithobrake.vocabulary.number_words import QUANTILE_WORDS, at_level, number, percent, time_limit, with_interval
from lithobrake.vocabulary.outcomes import RETURNS, FlightStatus

# Each holds others of the table.
SUMS = (RETURNS, "missing")
# Landings without an outcome, by reason.
LOST = (*MISSING_SAMPLES, FAILED)
QUANTILES = tuple(f"quantile_{level}" for level in QUANTILE_WORDS)
ACCELERATIONS = ("effective_acceleration_outward", "effective_acceleration_along_heading")
# What a lander at rest on other ground has behind it.
FOLLOWED = {
    "time_s": "time to rest [s]",
    "distance_m": "distance from the aim point [m]",
    "touchdowns": "impacts",
    "path_length": "path [m]",
    "slid_length": "sliding distance [m]",
    "slid_time_s": "sliding time [s]",
}


def outcomes_known(data: PageData) -> Mapping[str, CountedShare]:
    """Outcomes of the first touchdowns of the landers, or of the samples where none was drawn."""
    samples = data.results.samples
    return data.results.shares.outcomes if data.journeys or samples is None else samples.shares.outcomes


def outcome_words(data: PageData) -> dict[str, str]:
    """What may become of a landing, in words; the partner is left out where there is none.

    So is the return fraction where the ground holds nothing: it is then the share of those that impact again.
    """
    site, known = data.results.site, outcomes_known(data)
    absent: set[str] = set() if site.partner else {FlightStatus.PARTNER}
    if not site.holds:
        absent.add(RETURNS)
    return {key: text for key, text in OUTCOME_WORDS.items() if key in known and key not in absent}


def parts(data: PageData) -> dict[str, str]:
    """Those of the outcomes that add up to the whole, in words; lost landings of drawn landers are in no other."""
    absent = SUMS if data.journeys is None else (*SUMS, *LOST)
    return {key: words for key, words in outcome_words(data).items() if key not in absent}


def outcome_tables(data: PageData) -> list[PageTable]:
    """What becomes of the landers after their first touchdown."""
    samples = data.results.samples
    if data.journeys is not None:
        return [_outcomes_of_landings(data)]
    return [] if samples is None else [_outcomes_of_samples(data, samples)]


def _outcomes_of_landings(data: PageData) -> PageTable:
    """Outcomes of the first touchdowns, beside what the samples of a model give."""
    shares, limit, samples = data.results.shares, time_limit(data.study["flight"]["duration"]), data.results.samples
    columns = ["outcome", f"share of the landings ({at_level(data.level)})"]
    columns += [] if samples is None else [f"by the {samples.model}"]
    known, whole = outcome_words(data), parts(data)
    shown = whole | {key: known[key] for key in SUMS if key in known}
    shown |= {key: f"(of these: {known[key]})" for key in LOST if key in known and shares.outcomes[key].count}
    rows = [
        [
            words.format(limit=limit),
            with_interval(shares.outcomes[key].share),
            *([] if samples is None else [_by_model(samples, key)]),
        ]
        for key, words in shown.items()
    ]
    note = notes.outcomes_of_landings(shares, samples, len(whole))
    return PageTable("After the first touchdown", columns, rows, note, frozenset(columns[1:]))


def _by_model(samples: SampleResults, key: str) -> str:
    """A share of the samples: unknown outcomes are shares of all, the others of those with an outcome, as by runs."""
    shares = samples.shares
    if key not in shares.outcomes:
        return ""
    known = shares.sample_count - shares.outcomes["missing"].count
    total = shares.sample_count if key in (*LOST, "missing") else known
    return percent(shares.outcomes[key].count / total) if total else ""


def _outcomes_of_samples(data: PageData, samples: SampleResults) -> PageTable:
    """Outcomes of the samples of an expansion, which have no interval."""
    shares, limit = samples.shares, time_limit(data.study["flight"]["duration"])
    alone = samples.without_scatter
    columns = ["outcome", "samples", "share", *(["without scatter"] if alone else [])]
    rows = []
    for key, words in outcome_words(data).items():
        row = [words.format(limit=limit), str(shares.outcomes[key].count), _share(shares.outcomes[key], data.digits)]
        rows.append(row + ([_share(alone.shares.outcomes[key], data.digits)] if alone else []))
    has_limits = any(shares.outcomes[key].upper_limit is not None for key in outcome_words(data))
    note = notes.outcomes_of_samples(samples, has_limits=has_limits)
    return PageTable("After the first touchdown", columns, rows, note, frozenset(columns[1:]))


def _share(entry: CountedShare, alone: int) -> str:
    """A share, with its interval if it has one, or the largest that an outcome may have which no run had."""
    limit = entry.upper_limit
    return with_interval(entry.share, alone) if limit is None else f"at most {percent(limit, 1)}"


def flight_table(data: PageData) -> PageTable:
    """Times, speeds and incidences of the next impacts, and how exact the flights are."""
    flights, words = data.results.flights, {"time_s": "time of flight [s]", "impact_speed": "impact speed [m/s]"}
    words |= {"impact_incidence_deg": "incidence at the impact, from the normal [deg]"}
    columns = ["flights that impact the surface again", "5 %", "median", "95 %"]
    samples = data.results.samples if data.journeys is None else None
    known = flights.impacts.known if samples is None else samples.flights.known
    rows = [[words[key], *(_with_ends(one, level) for level in QUANTILES)] for key, one in known.items()]
    return PageTable("Flights to the next impact", columns, rows, notes.flights(flights), frozenset(columns[1:]))


def _with_ends(entry: ImpactNumber, level: str) -> str:
    """A quantile, with its interval where it has one."""
    ends = (entry.intervals or {}).get(level)
    return f"{number(entry.quantiles[level])}{'' if ends is None else bracket(*ends)}"


def ground_ends(data: PageData) -> PageTable:
    """How landers end on other ground."""
    found = data.results.hard_ground
    columns = ["after all touchdowns", *(GROUND_WORDS[ground] for ground in found)]
    rows = [
        [words, *(_share(table.ends[key], data.digits) for table in found.values())]
        for key, words in end_words(data.results.site).items()
        if any(key in table.ends and table.ends[key].count for table in found.values())
    ]
    if any(table.unknown for table in found.values()):
        rows.append(["(of all: unknown outcome)", *(percent(table.unknown, data.digits) for table in found.values())])
    if any(table.slid.count for table in found.values()):
        slid = (_share(table.slid, data.digits) for table in found.values())
        rows.append(["(of all: slid along the ground at some time)", *slid])
    note = notes.on_other_ground(found) if found else ""
    return PageTable("On other ground", columns, rows, note, frozenset(columns[1:]))


def ground_times(data: PageData) -> PageTable:
    """Times and ways of the landers at rest on other ground."""
    columns = ["landers at rest", "ground", "5 %", "median", "95 %"]
    grounds, rows = data.results.hard_ground, []
    for key, words in FOLLOWED.items():
        found = {ground: getattr(table, key) for ground, table in grounds.items() if getattr(table, key)}
        scale = max((value for one in found.values() for value in one.values()), default=0.0)
        for ground, one in found.items():
            rows.append([words, GROUND_WORDS[ground], *(number(one[level], scale=scale) for level in QUANTILES)])
    note = notes.hard_ground(data.study["hard_ground"], grounds)
    return PageTable("Journeys on other ground", columns, rows, note, frozenset(columns[2:]))


def region_table(data: PageData, *, of_impacts: bool, of_rest: bool) -> PageTable:
    """The smallest regions that hold shares of the next impacts, and of the landers at rest on each ground."""
    journeys, samples, sets = data.journeys, data.results.samples, {}
    if of_rest and data.to_rest and journeys is not None:
        sets["at rest"] = journeys.rest.regions
    if of_impacts and samples is not None:
        sets["next impacts"] = samples.regions
    if of_rest:
        sets |= {f"at rest, {GROUND_WORDS[key]}": one.regions for key, one in data.results.hard_ground.items()}
    columns = ["points", "share inside", "area", "largest extent [m]", "separate parts", "of the largest [m]"]
    rows = [
        [
            *(name, percent(one.share), area(one.area_m2), two_digits(one.largest_extent_m)),
            *(str(len(one.island_extents_m)), next(map(two_digits, one.island_extents_m), "")),
        ]
        for name, found in sets.items()
        for one in found
    ]
    note = "From a density fitted to the points."
    return PageTable("Smallest regions", columns, rows, note if rows else "", frozenset(columns[1:]))


def site_table(data: PageData) -> PageTable:
    """Where the study lands, and on which body."""
    rows = flat(json_values(data.results.site), alike=(("extents_m", "centroid_m", "place_m"), ACCELERATIONS))
    return PageTable("Site and body", ["name", "value"], rows, "m, kg, s, m/s2; degrees where named.")


def beds_table(data: PageData) -> PageTable:
    """The beds that were landed on."""
    columns = ["bed", "solid fraction", "contacts a grain", "surface height [m]", "mean diameter [m]"]
    rows = [
        [str(index), *map(table_cell, numbers)]
        for index, one in enumerate(data.results.beds)
        for numbers in [(one.solid_fraction, one.coordination_number, one.surface_height_m, one.mean_diameter_m)]
    ]
    return PageTable("Beds", columns, rows, numbers=frozenset(columns[1:]))


def provenance_table(data: PageData) -> PageTable:
    """Where the numbers come from: seed, times, versions."""
    rows = [("seed", show(data.study["seed"])), *flat(json_values(data.provenance))]
    note = "wall_s and cpu_s in seconds; a stage that was reused keeps its time."
    return PageTable("Execution", ["name", "value"], rows, note)
