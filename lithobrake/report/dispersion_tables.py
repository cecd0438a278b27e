"""Tables of where the landers end."""

from collections.abc import Mapping
from typing import Any

from lithobrake.outcomes import FlightStatus, JourneyStatus, SampleOutcome
from lithobrake.report.captions import hours, percent
from lithobrake.report.page import PageTable, fixed, flat, number
from lithobrake.report.results import Results

OUTCOME_WORDS: dict[str, str] = {
    FlightStatus.IMPACT: "down again within {hours}",
    FlightStatus.FLYING: "still flying after {hours}",
    FlightStatus.ESCAPED: FlightStatus.ESCAPED.label,
    FlightStatus.PARTNER: "on the partner within {hours}",
    **{outcome: outcome.label for outcome in SampleOutcome if outcome != SampleOutcome.CLEAR},
    "remains": "{remains}",
    "missing": "nobody knows where (over the rim, time limit, drawn outside)",
}
# Each holds others of the table.
SUMS = ("remains", "missing")
JOURNEY_WORDS: dict[str, str] = {
    JourneyStatus.SETTLED: "at rest",
    JourneyStatus.LOFTED: "captured, and lifted off again by the spin",
    JourneyStatus.OUTSIDE: "stopped where the expansion has no answer",
    "outside_too_slow": "(of these: slower than any run)",
    JourneyStatus.SLIDING: "sliding along the ground",
    JourneyStatus.BOUNCING: "still bouncing after a thousand bounces",
    JourneyStatus.FLYING: "not at rest after {hours}",
    JourneyStatus.ESCAPED: JourneyStatus.ESCAPED.label,
    JourneyStatus.PARTNER: "on the partner",
}
GROUND_WORDS = {"soil": "soil", "hard": "hard ground"}
QUANTILES = ("quantile_0.05", "quantile_0.5", "quantile_0.95")
ACCELERATIONS = ("effective_acceleration_outward", "effective_acceleration_along_heading")


def outcome_words(data: Results) -> dict[str, str]:
    """What may become of a sample, in words; the partner is left out where there is none."""
    holds = data.results["site"]["effective_acceleration_outward"] < 0.0
    remains = "down again within {hours}, or captured" if holds else "down again within {hours}"
    words = OUTCOME_WORDS | {"remains": remains}
    alone = not data.results["site"].get("partner")
    return {key: text for key, text in words.items() if not (alone and key == FlightStatus.PARTNER)}


def dispersion_tables(data: Results) -> list[PageTable]:
    """All of them, in the order of the journey."""
    return [_outcomes(data), _flights(data), _statuses(data), _journeys(data), _ellipses(data), _site(data)]


def _outcomes(data: Results) -> PageTable:
    shares, limit = data.results["shares"], hours(data.study["flight"]["duration"])
    alone = data.results["without_scatter"]
    columns = ["what became of the sample", "samples", "share", *(["without scatter"] if alone else [])]
    rows = []
    for key, words in outcome_words(data).items():
        row = [words.format(hours=limit), str(shares[key]["count"]), _share(shares[key])]
        rows.append(row + ([_share(alone["shares"][key])] if alone else []))
    stays = data.results["stays"]
    note = (
        f"Shares of {shares['sample_count']} samples; {shares['flight_count']} of them were flown. "
        + (f"{stays['why']} " if stays["why"] else "")
        + f"The number of flights alone leaves +- {100 * stays['flight_sampling']:.1f} points (90 %) in what remains. "
        '"At most": no run ended so, which such a probability allows (95 %).'
    )
    if alone:
        note += (
            " The first shares have the scatter from run to run; without it stand those of the expansion alone, of "
            f"{alone['shares']['sample_count']} samples."
        )
    return PageTable("After the first bounce", columns, rows, note, frozenset(columns[1:]))


def _share(entry: Mapping[str, Any]) -> str:
    """A share, or the largest that an outcome may have which no run had."""
    limit = entry.get("upper_limit")
    return percent(entry["share"], 2) if limit is None else f"at most {percent(limit, 1)}"


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
    return {ground: data.results["rest"][ground] for ground in GROUND_WORDS if data.results["rest"][ground]}


def _statuses(data: Results) -> PageTable:
    found, limit = followed(data), hours(data.study["rest"]["duration"])
    columns = ["after all bounces"]
    for ground in found:
        columns += [GROUND_WORDS[ground]]
    rows = []
    for key, words in JOURNEY_WORDS.items():
        if any(table[key]["count"] for table in found.values()):
            shares = [percent(table[key]["share"], 2) for table in found.values()]
            rows.append([words.format(hours=limit), *shares])
    counts = {table["sample_count"] for table in found.values()}
    note = f"Shares of {counts.pop()} samples, followed from the first impact." if counts else "No sample was followed."
    why = data.results["rest"]["why_no_soil"]
    note += f" The soil could not be asked: {why}." if why and found else ""
    return PageTable("From bounce to bounce", columns, rows, note, frozenset(columns[1:]))


def _journeys(data: Results) -> PageTable:
    columns = ["landers that rest", "ground", "5 %", "median", "95 %"]
    words = {"time_s": "time to rest [s]", "rebounds": "rebounds", "path_length": "path [m]"}
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
        f"{rest['rest_height']:g} m. The path is the sum of straight lines between impacts."
    )
    return PageTable("Journeys to rest", columns, rows, note, frozenset(columns[2:]))


def _ellipses(data: Results) -> PageTable:
    columns = ["places", "share inside", "latitude [deg]", "longitude [deg]", "semi-axes [m]", "heading [deg]"]
    sets = {"next impact": data.results["ellipses"]}
    if data.results["without_scatter"]:
        sets["next impact, without scatter"] = data.results["without_scatter"]["ellipses"]
    sets |= {f"at rest, {GROUND_WORDS[ground]}": table["ellipses"] for ground, table in followed(data).items()}
    rows = []
    for name, found in sets.items():
        if not found or not found["shares"]:
            rows.append([name, "none", "", "", "", ""])
            continue
        for entry in found["shares"]:
            axes = " x ".join(number(axis) for axis in entry["semi_axes_m"])
            middle = [fixed(found[key]) for key in ("latitude_deg", "longitude_deg")]
            rows.append([name, percent(entry["share"], 0), *middle, axes, f"{found['heading_deg']:.1f}"])
    note = (
        "Each holds that share of the places, which need follow no law; the heading is that of the longer axis, from "
        "north toward east. None: fewer than ten places, or places too far around the body to have a middle."
    )
    return PageTable("Landing ellipses", columns, rows, note, frozenset(columns[1:]))


def _site(data: Results) -> PageTable:
    rows = flat(data.results["site"], alike=(("extents_m", "centroid_m", "place_m"), ACCELERATIONS))
    return PageTable("Site and body", ["name", "value"], rows, "m, kg, s, m/s2; degrees where named.")
