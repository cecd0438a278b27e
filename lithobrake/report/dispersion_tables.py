"""Tables of where the landers end."""

from collections.abc import Mapping
from typing import Any

from lithobrake.outcomes import FlightStatus, JourneyStatus, SampleOutcome
from lithobrake.report.captions import hours, percent
from lithobrake.report.page import PageTable, fixed, flat, number
from lithobrake.report.results import PaperResults, Results

OUTCOME_WORDS: dict[str, str] = {
    FlightStatus.IMPACT: "down again within {hours}",
    FlightStatus.FLYING: "still flying after {hours}",
    FlightStatus.ESCAPED: FlightStatus.ESCAPED.label,
    FlightStatus.PARTNER: "on the partner within {hours}",
    **{outcome: outcome.label for outcome in SampleOutcome if outcome != SampleOutcome.CLEAR},
    "returns": "{returning}",
    "missing": "nobody knows where (over the rim, time limit, drawn outside)",
}
# Each holds others of the table.
SUMS = ("returns", "missing")
JOURNEY_WORDS: dict[str, str] = {
    JourneyStatus.SETTLED: "at rest",
    JourneyStatus.LOFTED: "captured where the spin lifts it off again",
    JourneyStatus.OUTSIDE: "stopped where the {model} has no answer",
    "outside_too_slow": "(of these: slower than any run)",
    JourneyStatus.SLIDING: "still sliding along the ground after {hours}",
    JourneyStatus.BOUNCING: "still bouncing after a thousand bounces",
    JourneyStatus.FLYING: "not at rest after {hours}",
    JourneyStatus.ESCAPED: JourneyStatus.ESCAPED.label,
    JourneyStatus.PARTNER: "on the partner",
    "slid": "(of all: slid along the ground for a while)",
}
GROUND_WORDS = {"soil": "soil", "hard": "hard ground", "equivalent": "hard ground like the soil"}
QUANTILES = ("quantile_0.05", "quantile_0.5", "quantile_0.95")
ACCELERATIONS = ("effective_acceleration_outward", "effective_acceleration_along_heading")


def outcome_words(data: Results) -> dict[str, str]:
    """What may become of a sample, in words; the partner is left out where there is none."""
    site, known = data.results["site"], data.results["shares"]
    holds = site["effective_acceleration_outward"] < 0.0
    returning = "down again within {hours}, or captured" if holds else "down again within {hours}"
    words = OUTCOME_WORDS | {"returns": returning}
    absent = set() if site["partner"] else {FlightStatus.PARTNER}
    return {key: text for key, text in words.items() if key in known and key not in absent}


def dispersion_tables(data: Results) -> list[PageTable]:
    """In the order of the journey, those that have a row."""
    made = (_outcomes, _flights, _statuses, _journeys, _ellipses, _site)
    return [table for table in (make(data) for make in made) if table.rows]


def _outcomes(data: Results) -> PageTable:
    shares, limit = data.results["shares"], hours(data.study["flight"]["duration"])
    alone = data.results["without_scatter"]
    columns = ["what became of the sample", "samples", "share", *(["without scatter"] if alone else [])]
    rows = []
    for key, words in outcome_words(data).items():
        row = [words.format(hours=limit), str(shares[key]["count"]), _share(shares[key])]
        rows.append(row + ([_share(alone["shares"][key])] if alone else []))
    returns, level = data.results["returns"], percent(data.level, 0)
    note = f"Shares of {shares['sample_count']} samples; {shares['flight_count']} of them were flown."
    note += f" {returns['why']}" if returns["why"] else ""
    # The runs of a sequence have flights of their own, of which its answer speaks.
    if isinstance(data, PaperResults) and returns.get("flight_sampling") is not None:
        sampling = f"{100 * returns['flight_sampling']:.1f} points ({percent(returns['level'], 0)})"
        note += f" The number of flights alone leaves +- {sampling} in the return fraction."
    if any(_is_unmet(shares[key]) for key in outcome_words(data)):
        note += f' "At most": no run ended so, which such a probability allows ({level}).'
    if any(shares[key].get("lower") is not None for key in outcome_words(data)):
        note += f" In brackets {level} intervals over refits of the {data.model} to other draws of beds."
    if alone:
        note += (
            " The first shares have the scatter from run to run; without it stand those of the expansion alone, of "
            f"{alone['shares']['sample_count']} samples."
        )
    return PageTable("After the first bounce", columns, rows, note, frozenset(columns[1:]))


def _share(entry: Mapping[str, Any]) -> str:
    """A share, with its interval if it has one, or the largest that an outcome may have which no run had."""
    if _is_unmet(entry):
        return f"at most {percent(entry['upper_limit'], 1)}"
    share = percent(entry["share"], 2)
    if entry.get("lower") is None:
        return share
    return f"{share} ({100 * entry['lower']:.1f} to {100 * entry['upper']:.1f})"


def _is_unmet(entry: Mapping[str, Any]) -> bool:
    """Whether no run had an outcome, so that only a limit of its share is known."""
    return entry.get("upper_limit") is not None


def _flights(data: Results) -> PageTable:
    """Times, speeds and incidences of the impacts, and how exact the flights are."""
    flights, words = data.results["flights"], {"time_s": "time of flight [s]", "impact_speed": "impact speed [m/s]"}
    words |= {"impact_incidence_deg": "incidence at the impact, from the normal [deg]"}
    columns = ["flights that come down again", "5 %", "median", "95 %"]
    rows = [[words[key], *(number(flights[key][level]) for level in QUANTILES)] for key in words if key in flights]
    error, drift = flights.get("gravity_table_error"), flights.get("jacobi_drift_largest_m2_s2")
    note = "Gravity is summed over the facets."
    if error:
        note = (
            f"Gravity is read from a table, {number(error['median'], 2)} of the surface gravity off the sum over the "
            f"facets in the median, {number(error['p95'], 2)} at the 95th percentile of {error['point_count']} points."
        )
    if drift is not None:
        note += (
            f" The Jacobi constant of {flights['jacobi_flight_count']} flights changes by {number(drift, 2)} m2/s2 at "
            "most, without the partner."
        )
    return PageTable("The flights to the next impact", columns, rows, note, frozenset(columns[1:]))


def followed(data: Results) -> dict[str, Mapping[str, Any]]:
    """The grounds on which samples were followed, with what became of them."""
    rest = data.results["rest"]
    return {ground: rest[ground] for ground in GROUND_WORDS if rest[ground]}


def _statuses(data: Results) -> PageTable:
    found, limit = followed(data), hours(data.study["rest"]["duration"])
    columns = ["after all bounces", *(GROUND_WORDS[ground] for ground in found)]
    rows = []
    for key, words in JOURNEY_WORDS.items():
        if any(table[key]["count"] for table in found.values()):
            rows.append(
                [words.format(hours=limit, model=data.model), *(_share(table[key]) for table in found.values())]
            )
    counts = {table["sample_count"] for table in found.values()}
    note = f"Shares of {', '.join(map(str, counts))} samples, followed from the first impact."
    why = data.results["rest"]["why_no_soil"]
    note += f" The soil could not be asked: {why}." if why else ""
    return PageTable("From bounce to bounce", columns, rows, note, frozenset(columns[1:]))


def _journeys(data: Results) -> PageTable:
    columns = ["landers that rest", "ground", "5 %", "median", "95 %"]
    words = {"time_s": "time to rest [s]", "rebounds": "rebounds", "path_length": "path [m]"}
    words |= {"slid_length": "slid along the ground [m]", "slid_time_s": "time of that [s]"}
    rows = [
        [words[key], GROUND_WORDS[ground], *(number(table[key][level]) for level in QUANTILES)]
        for key in words
        for ground, table in followed(data).items()
        if key in table
    ]
    rest = data.study["rest"]
    note = (
        f"Hard ground: restitution {rest['normal_restitution']:g} along the normal, {rest['tangential_restitution']:g} "
        f"along the ground, friction {rest['friction']:g}; at rest where a rebound rises less than "
        f"{rest['rest_height']:g} m. Hard ground like the soil draws the restitution that the soil implies by "
        "speed and incidence (restitution.csv). The path is the sum of straight lines between impacts. What is "
        f"captured {_sliding(rest)} from facet to facet until it rests or leaves the ground again; no landing has been "
        "fitted to that law, and on soil it starts from rest, as runs do not tell what speed is left."
    )
    return PageTable("Journeys to rest", columns, rows, note, frozenset(columns[2:]))


def _sliding(rest: Mapping[str, Any]) -> str:
    """The law by which a captured lander moves on, in words."""
    if rest["rolling_friction"] is not None:
        return f"rolls on like a ball against a resistance of {rest['rolling_friction']:g} of what presses it down,"
    return "slides on by Coulomb friction, on soil that of hull and grain,"


def _ellipses(data: Results) -> PageTable:
    columns = ["places", "share inside", "latitude [deg]", "longitude [deg]", "semi-axes [m]", "heading [deg]"]
    sets = {"next impact": data.results["ellipses"]}
    if data.results["without_scatter"]:
        sets["next impact, without scatter"] = data.results["without_scatter"]["ellipses"]
    sets |= {f"at rest, {GROUND_WORDS[ground]}": table["ellipses"] for ground, table in followed(data).items()}
    rows = []
    for name, found in sets.items():
        for entry in found["shares"] if found else ():
            axes = " x ".join(number(axis) for axis in entry["semi_axes_m"])
            middle = [fixed(found[key]) for key in ("latitude_deg", "longitude_deg")]
            rows.append([name, percent(entry["share"], 0), *middle, axes, f"{found['heading_deg']:.1f}"])
    note = (
        "Each holds that share of the places, which need follow no law; the heading is that of the longer axis, from "
        "north toward east. None is given of fewer than ten places, or of places all around the body."
    )
    return PageTable("Landing ellipses", columns, rows, note, frozenset(columns[1:]))


def _site(data: Results) -> PageTable:
    rows = flat(data.results["site"], alike=(("extents_m", "centroid_m", "place_m"), ACCELERATIONS))
    return PageTable("Site and body", ["name", "value"], rows, "m, kg, s, m/s2; degrees where named.")
