"""Tables of where the landers end, and of limit states."""

from collections.abc import Mapping
from itertools import accumulate
from operator import mul

from lithobrake.report.content import PageTable, flat, table_cell
from lithobrake.results.dispersion import GroundResults, ImpactNumber
from lithobrake.results.journey_results import JourneyRest
from lithobrake.results.page_data import DrawnPage, PageData, PaperPage, SampledPage
from lithobrake.results.questions import LimitStateResult, RareLimitState
from lithobrake.results.run_results import CountedShare, EmulatorShares
from lithobrake.results.study_files import json_values
from lithobrake.statements import notes
from lithobrake.statements.labels import GROUND_WORDS, JOURNEY_WORDS, OUTCOME_WORDS, area, bracket, input_words
from lithobrake.vocabulary.number_words import (
    QUANTILE_WORDS,
    at_level,
    fixed,
    number,
    percent,
    time_limit,
    with_interval,
)
from lithobrake.vocabulary.outcomes import FlightStatus, SampleOutcome

# Each holds others of the table.
SUMS = ("returns", "missing")
# Landings without an outcome, by reason.
LOST = (SampleOutcome.LEFT_SIDEWAYS, SampleOutcome.TIME_LIMIT, SampleOutcome.OUTSIDE, "failed")
QUANTILES = tuple(f"quantile_{level}" for level in QUANTILE_WORDS)
ACCELERATIONS = ("effective_acceleration_outward", "effective_acceleration_along_heading")
SOURCES = {"runs": "runs", "emulator": "emulator, since too few runs meet it"}
RareResults = Mapping[str, RareLimitState]


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
    shares, limit = data.results.shares, time_limit(data.study["flight"]["duration"])
    columns = ["outcome", f"share of the landings ({at_level(data.level)})", f"by the {data.model}"]
    known, whole = outcome_words(data), parts(data)
    shown = whole | {key: known[key] for key in SUMS if key in known}
    shown |= {key: f"(of these: {known[key]})" for key in LOST if key in known and shares.outcomes[key].count}
    rows = [
        [words.format(limit=limit), with_interval(shares.outcomes[key].share), _by_emulator(shares.emulator, key)]
        for key, words in shown.items()
    ]
    note = notes.outcomes_of_landings(shares, data.model, len(whole))
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
    shares, limit = data.results.shares, time_limit(data.study["flight"]["duration"])
    alone = data.results.without_scatter
    columns = ["outcome", "samples", "share", *(["without scatter"] if alone else [])]
    rows = []
    for key, words in outcome_words(data).items():
        row = [words.format(limit=limit), str(shares.outcomes[key].count), _share(shares.outcomes[key], data.digits)]
        rows.append(row + ([_share(alone.shares.outcomes[key], data.digits)] if alone else []))
    has_limits = any(shares.outcomes[key].upper_limit is not None for key in outcome_words(data))
    note = notes.outcomes_of_samples(shares, alone.shares if alone else None, data.level, has_limits=has_limits)
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
    return PageTable("Flights to the next impact", columns, rows, notes.flights(flights), frozenset(columns[1:]))


def _with_ends(entry: ImpactNumber, level: str) -> str:
    """A quantile, with its interval where it has one."""
    ends = (entry.intervals or {}).get(level)
    return f"{number(entry.quantiles[level])}{'' if ends is None else bracket(*ends)}"


def followed(data: PageData) -> dict[str, GroundResults]:
    """The grounds on which samples were followed, with what became of them."""
    return data.results.rest.grounds


def _statuses(data: SampledPage) -> PageTable:
    found, limit = followed(data), time_limit(data.study["rest"]["duration"])
    columns = ["after all bounces", *(GROUND_WORDS[ground] for ground in found)]
    rows = []
    for key, words in JOURNEY_WORDS.items():
        if any(table.counts[key].count for table in found.values()):
            rows.append(
                [
                    words.format(limit=limit, model=data.model),
                    *(_share(table.counts[key], data.digits) for table in found.values()),
                ]
            )
    rest = data.results.rest
    note = notes.after_all_bounces(found, None if isinstance(rest, JourneyRest) else rest.why_no_soil)
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
    return PageTable("Journeys to rest", columns, rows, notes.hard_ground(data.study["rest"]), frozenset(columns[2:]))


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


def limit_state_tables(data: DrawnPage) -> list[PageTable]:
    """Probabilities, and inputs where runs tell of any; none where the study asks for no limit state."""
    states = data.results.limit_states
    return [_probabilities(states), *_inputs(states)] if states else []


def _probabilities(states: Mapping[str, LimitStateResult]) -> PageTable:
    interval = f"{at_level(next(iter(states.values())).probability.level)} [%]"
    columns = ["limit state", "condition", "probability [%]", interval, "source", "runs that meet it"]
    rows = [
        [
            name,
            state.condition,
            _percentage(state.probability.value),
            " to ".join(
                _percentage(end) for end in (state.probability.lower, state.probability.upper) if end is not None
            )
            or "none",
            SOURCES[state.source],
            number(state.failing_runs),
        ]
        for name, state in states.items()
    ]
    note = notes.limit_states(states)
    return PageTable("Limit states", columns, rows, note, frozenset((*columns[2:4], columns[5])))


def _inputs(states: Mapping[str, LimitStateResult]) -> list[PageTable]:
    """Inputs among the runs that meet a limit state, furthest from their distribution first."""
    rows = []
    for name, state in states.items():
        found = sorted(state.inputs.items(), key=lambda entry: -entry[1].distance.value)
        rows += [
            [
                name if place == 0 else "",
                input_words(key),
                f"{fixed(one.distance.value)}{bracket(one.distance.lower, one.distance.upper, fixed)}",
                fixed(one.luck),
                table_cell(one.median),
                table_cell(one.median_of_all),
                "yes" if one.found else "no",
            ]
            for place, (key, one) in enumerate(found)
        ]
    columns = [
        *("limit state", "input", "distance from its distribution", "critical distance"),
        *("median if met", "median of its distribution", "significant"),
    ]
    note = (
        "Distance: the largest difference of the distribution functions of the input among the runs that meet the "
        "limit state and over all landings (Kolmogorov's), in brackets its interval. Significant: above the critical "
        "distance, which chance alone exceeds in one of ten studies, all inputs together. Medians in the unit of the "
        "study file."
    )
    return [PageTable("Inputs of the limit states", columns, rows, note, frozenset(columns[2:6]))] if rows else []


def _percentage(share: float) -> str:
    return number(100.0 * share)


def rare_tables(rare: RareResults) -> list[PageTable]:
    """Probabilities and levels; none where there is no result."""
    return [_rare_probabilities(rare), _levels(rare)] if rare else []


def _rare_probabilities(rare: RareResults) -> PageTable:
    interval = at_level(next(iter(rare.values())).probability.level)
    columns = ["limit state", "condition", "probability", interval, "landings", "beds", "origins"]
    rows = [
        [
            name,
            found.condition,
            number(found.probability.value) if found.reached else f"below {number(found.rarest)}",
            " to ".join(number(end) for end in (found.probability.lower, found.probability.upper) if end is not None)
            or "none",
            number(found.landings),
            number(found.beds),
            fixed(found.origins, 1),
        ]
        for name, found in rare.items()
    ]
    origins = "Origins: the effective number of beds from which the landings that meet it come."
    note = f"{notes.limit_states(rare)} {origins}"
    return PageTable("Rare limit states", columns, rows, note, frozenset(columns[2:]))


def _levels(rare: RareResults) -> PageTable:
    columns = ["limit state", "level", "threshold", "fraction nearer the limit", "probability so far"]
    rows = [
        [name if level == 0 else "", str(level + 1), fixed(threshold), percent(share, 1), number(left)]
        for name, found in rare.items()
        for level, (threshold, share, left) in enumerate(
            zip(found.thresholds, found.shares, accumulate(found.shares, mul), strict=True)
        )
    ]
    note = "Thresholds: distance from the limit, in standard deviations of the outputs of the first level."
    return PageTable("Levels of the rare limit states", columns, rows, note, frozenset(columns[1:]))
