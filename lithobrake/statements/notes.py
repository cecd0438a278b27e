"""The notes of the tables of the page."""

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from lithobrake.statements.expansion import LEVEL as EXPANSION_LEVEL
from lithobrake.statements.journeys import emulator, sides_down
from lithobrake.statements.labels import GROUND_WORDS, end_words, region, two_digits
from lithobrake.statements.touchdowns import left_out
from lithobrake.vocabulary.number_words import LEVEL, as_sentence, intervals, number, out_of, percent, thousands
from lithobrake.vocabulary.outcomes import JourneyEnd

if TYPE_CHECKING:
    from lithobrake.results.dispersion import FlightResults, FollowedLanders
    from lithobrake.results.journey_results import DeliveryResults, JourneyRest
    from lithobrake.results.model_results import SampleResults
    from lithobrake.results.page_data import PageData
    from lithobrake.results.questions import LimitStateResult, RareLimitState
    from lithobrake.results.run_results import RunShares, SideRuns, VarianceParts
    from lithobrake.results.summary import Results

NOT_KNOWN = "Without intervals: other beds, impact points or attitudes would change these numbers."


def in_brackets(level: float = LEVEL, more: str = "") -> str:
    """What stands in brackets behind the numbers of a table."""
    return f"In brackets {intervals(level)}{more}."


def outcomes_of_landings(shares: "RunShares", samples: "SampleResults | None", part_count: int) -> str:
    """Outcomes of the first touchdowns, and of samples of a model; part_count: rows that add up to the whole."""
    said = [
        f"Of all landings, from {thousands(shares.flight_count)} flights of the runs; the first {part_count} rows add "
        f"up to {percent(1.0)}."
    ]
    if samples is not None:
        flown = thousands(samples.shares.flight_count)
        said.append(f"Last column: {flown} propagated samples of the {samples.model}.")
    if shares.outcomes["missing"].count:
        said.append(
            "Landings with unknown outcome are treated like those that left in flight across the edge of the bed; "
            "every interval covers all their possible outcomes."
        )
    return " ".join([*said, *([shares.why] if shares.why else [])])


def outcomes_of_samples(samples: "SampleResults", *, has_limits: bool) -> str:
    """Outcomes of the samples of an expansion; has_limits: whether any has a limit."""
    shares, alone = samples.shares, samples.without_scatter
    said = [f"Shares of {shares.sample_count} samples, {shares.flight_count} of them propagated. {shares.why}"]
    if has_limits:
        said.append(f'"At most": no run had this outcome; upper limit at {percent(EXPANSION_LEVEL)} confidence.')
    if alone is not None:
        said.append(
            "The first shares include the run-to-run scatter; those without scatter are of the expansion alone, from "
            f"{alone.shares.sample_count} samples."
        )
    return " ".join(said)


def flights(found: "FlightResults") -> str:
    """Which flights the numbers of the impacts are of, and how exact they are."""
    checks = found.checks
    error = None if checks is None else checks.gravity_table_error
    said = [f"Of {one.of}." for one in found.impacts.known.values() if one.of][:1]
    if error:
        said.append(
            "Gravity is interpolated in a table; relative to surface gravity its error against the sum over the facets "
            f"is {two_digits(error.median)} in the median and {two_digits(error.p95)} at the 95th percentile of "
            f"{error.point_count} points."
        )
    else:
        said.append("Gravity is summed over the facets.")
    if checks is not None and checks.jacobi_drift_largest_m2_s2 is not None:
        said.append(
            f"The Jacobi constant of {checks.jacobi_flight_count} flights changes by "
            f"{two_digits(checks.jacobi_drift_largest_m2_s2)} m2/s2 at most, without the partner."
        )
    return " ".join(said)


def on_other_ground(found: "Mapping[str, FollowedLanders]") -> str:
    """Which journeys the columns are of."""
    of = "; ".join(f"{GROUND_WORDS[ground]}: {one.of}" for ground, one in found.items())
    why = [
        as_sentence(f"No interval on {GROUND_WORDS[ground]}: {one.why[:1].lower()}{one.why[1:]}")
        for ground, one in found.items()
        if one.why
    ]
    return " ".join(["From the first impact.", as_sentence(of), *why])


def hard_ground(section: Mapping[str, Any], grounds: Iterable[str]) -> str:
    """The laws of bounces and slides; section: [hard_ground] of the study file; grounds: on which landers were
    followed.
    """
    like_soil = (
        "Hard ground like the soil samples the restitution that the soil implies at each speed and incidence "
        "(restitution.csv). "
    )
    slides = "slides on by Coulomb friction, on soil that of hull and grain,"
    if section["rolling_friction"] is not None:
        slides = f"rolls on like a sphere against a resistance of {section['rolling_friction']:g} of the normal force,"
    return (
        f"Hard ground: restitution {section['normal_restitution']:g} normal, {section['tangential_restitution']:g} "
        f"tangential, friction {section['friction']:g}; at rest where a rebound rises less than "
        f"{section['rest_height']:g} m. {like_soil if 'equivalent' in grounds else ''}The path is the sum of straight "
        f"lines between impacts. A captured lander {slides} from facet to facet until it rests or leaves the ground "
        "again; this law was not fitted to landings."
    )


def outputs(data: "PageData") -> str:
    """Mean and quantiles of the landings that left."""
    speed = data.results.spreads.get("speed_out")
    of = "the landings that left" if speed is None else speed.of
    if not data.has_interval:
        return f"Of {of}. {NOT_KNOWN}"
    held = "over the input distributions and for beds, impact points and attitudes outside the study"
    return f"Of {of}, {held}. {in_brackets(data.level)}"


def directions(data: "PageData") -> str:
    """Mean direction and resultant length."""
    more = in_brackets(data.level, ", which may reach beyond 180 deg")
    return f"Resultant length: 0 where directions cancel, 1 where all are alike. {more}"


def variance(data: "PageData", known: "Sequence[VarianceParts]") -> str:
    """Every part of the variance of each output."""
    return (
        "Shares of the variance over the input distributions of the study file, beds, impact points and attitudes. "
        f"{in_brackets(data.level)} Soil, delivery and attitude: {known[0].terms if known else ''}, so these parts "
        "are lower bounds; other effects are in everything else. Not detected: not distinguishable from 0. The return "
        "fraction is a mean over headings, so the effect of headings is in none of its parts."
    )


def sides(level: float) -> str:
    """What becomes of the landers by the side that faces the ground."""
    return (
        "The side whose axis is nearest to the normal of the ground at the impact; an edge or a corner of it touches "
        f"first. {in_brackets(level, ', of each side by itself')}"
    )


def side_runs(side: "SideRuns", level: float) -> str:
    """What pairs of runs tell of soil and chaos."""
    return (
        f"{side.soil_pairs} runs were repeated on a second soil, {side.twins} with an impact point "
        f"{number(1e3 * side.twin_shift)} mm away. Total effect: the share of the variance due "
        f"to the soil at a fixed bed, impact point and attitude. {in_brackets(level)}"
    )


def emulator_scores(bed_count: int) -> str:
    """How the emulator does on beds left out."""
    return (
        "Skill: relative improvement of the score (CRPS; for all outputs the energy score) over resampling the runs, "
        f"on {left_out(bed_count)}; 0 is no improvement."
    )


def significant_inputs(level: float, *, has_any: bool) -> str:
    """Which of the uncertain inputs the emulator found to matter."""
    test = "(one F test for all inputs and outputs, products included)"
    if not has_any:
        return f"No significant input {test}."
    return f"Significant input {test}: it changes the mean of an output at {percent(level)} confidence."


def limit_states(states: "Mapping[str, LimitStateResult | RareLimitState]") -> str:
    return " ".join(state.statement for state in states.values())


def journeys_at_rest(rest: "JourneyRest") -> str:
    """When and how the landers rest."""
    more = f" Side down: {sides_down(rest.faces)}." if rest.faces else ""
    return f"From {rest.of}. {in_brackets()}{more}"


def sky() -> str:
    """What the landers at rest see of the Sun, of Earth and of the orbiter."""
    return (
        "Of the landers at rest, over a day of the body, the dates of the study, or the positions of the orbiter; "
        f"occultation by the ground, the rest of the shape and a partner included. {in_brackets()}"
    )


def delivery(found: "DeliveryResults") -> str:
    """How the landers come down first."""
    said = [f"{out_of(found.count, found.of, 'landers')} touch down."]
    return " ".join([*said, *(as_sentence(region(one, "the first impacts")) for one in found.regions)])


def grounds() -> str:
    """What becomes of the landers on each kind of ground."""
    return (
        "Probabilities are those of the study file. The last row is of a body with one of these grounds throughout: "
        f"{in_brackets(LEVEL, ', of one such ground; in the other rows that of the mean over its beds')}"
    )


def soils() -> str:
    """What becomes of the landers by the soil that they come down on."""
    return (
        "By the region of the study file in which a lander lands; elsewhere the soil is that of [grain]. "
        f"{in_brackets(LEVEL, ', of each region by itself')}"
    )


def ends(results: "Results") -> str:
    """How the journeys ended, by landings and by the emulator."""
    why = next((one.share.why_missing for one in results.ends.values() if one.share.why_missing), None)
    words = end_words(results.site)
    said = [f"{words[name]}: {JourneyEnd(name).sentence}" for name, one in results.ends.items() if one.count]
    more = [*([as_sentence(why)] if why else []), *emulator(results.emulated)]
    return " ".join([f"{one[:1].upper()}{one[1:]}" for one in said] + more)


def scores() -> str:
    """The errors of the expansions."""
    return (
        "Q2: explained share of the variance. A MAPE is small wherever an output hardly varies, so read it with Q2. "
        f"{in_brackets(EXPANSION_LEVEL, ', by resampling the runs')} Errors at fitted runs are optimistic."
    )


def sobol() -> str:
    """The indices of all inputs."""
    return (
        "Shares of the variance that the screening expansion explains, on the beds and at the impact points of its "
        "runs, corrected for scatter. First: the input alone. Total: with all interactions. "
        f"{in_brackets(EXPANSION_LEVEL, ', by resampling the residuals of the runs')}"
    )
