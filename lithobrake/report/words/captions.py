"""The sentences of the page, built from the numbers of the files. They are plain text."""

import math
import re
from collections.abc import Mapping, Sequence

from lithobrake.report.page_data import PageData, PaperPage, SampledPage
from lithobrake.report.words.labels import PAPER_OUTPUTS, PART_KEY, output
from lithobrake.report.words.numbers import area, number, q2_words
from lithobrake.results.journey_results import JourneyRest
from lithobrake.results.model_results import DesignCounts, ExpansionResults, OutputErrors
from lithobrake.vocabulary.durations import hours
from lithobrake.vocabulary.known_bodies import BUILT_IN_BODIES
from lithobrake.vocabulary.material import PROPERTIES
from lithobrake.vocabulary.outcomes import FlightStatus, JourneyStatus, TouchdownOutcome
from lithobrake.vocabulary.percentages import LEVEL, percent, with_interval

FIELD_WORDS = {name: known.words for name, known in PROPERTIES.items()}
WHOLE_WORDS = {"impact.speed": "impact speed"}
POINT_WORDS = {
    "smolyak": "on the Smolyak grid",
    "sobol_sequence": "of a Sobol sequence",
    "latin_hypercube": "of a Latin hypercube",
    "fekete": "at approximate Fekete points",
}


def input_words(name: str) -> str:
    """An input in words, without unit: "restitution of the grains"."""
    if name in WHOLE_WORDS:
        return WHOLE_WORDS[name]
    section, _, field = name.partition(".")
    if part := re.fullmatch(PART_KEY, name):
        return f"{FIELD_WORDS.get(part['key'], part['key'].replace('_', ' '))} of {part['part']}"
    words = FIELD_WORDS.get(
        field, field.removeprefix("inputs.").removesuffix("_deg").replace("_", " ").replace(".", " ")
    )
    return words + {"grain": " of the grains", "lander": " of the lander", "impact": " at impact"}.get(section, "")


def listing(words: list[str]) -> str:
    """Words joined as a person would: a, b and c."""
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"


def answer(data: SampledPage) -> str:
    """How many landers return, in one line."""
    returns = data.results.returns
    if isinstance(data, PaperPage):
        where, _, _ = data.results.answer[0].partition(":")
        return f"{where}: {percent(returns.share.value, data.digits)} of the landers {action(data)}."
    level = None if returns.share.lower is None else data.level
    return f"{with_interval(returns.share, level=level)} of the landings {action(data)}."


def action(data: PageData) -> str:
    """What the return fraction is of: landers that do this."""
    again = f"impact the surface again within {hours(data.study['flight']['duration'])}"
    return f"{again} or are captured where the ground holds them" if data.results.site.holds else again


def details(data: PageData) -> list[str]:
    """Where the study lands, and the whole answer."""
    return [" ".join([*place_words(data), *data.results.answer])]


def place_words(data: PageData) -> list[str]:
    """Where the study lands, in a sentence."""
    site = data.results.site
    place = f"latitude {site.latitude_deg:g} deg, longitude {site.longitude_deg:g} deg on {body_name(data)}"
    # A product of an archive tells which shape "the body" is.
    product = f" ({site.product_id})" if site.product_id else ""
    return [f"Landing at {place}{product}."]


def body_name(data: PageData) -> str:
    """The body in words."""
    site = data.study["site"]
    known = BUILT_IN_BODIES.get(site["body"])
    return site.get("name") or (known.name if known else "the body")


def facts(data: PageData) -> str:
    """When the study was made, and what the body's gravity is known by."""
    known, date = gravity_words(data), data.provenance.date[:16].replace("T", ", ")
    return f"Study of {date} UTC. {known[0].upper()}{known[1:]}."


def gravity_words(data: PageData) -> str:
    """Escape speed at the site and bulk density of the body."""
    site = data.results.site
    return (
        f"escape speed at the site {number(site.escape_speed_m_s)} m/s, bulk density of the body "
        f"{number(site.bulk_density_kg_m3)} kg/m3"
    )


def bed(data: PageData) -> str:
    """How the ground was made."""
    if data.bed is None:
        program = data.study["solver"]["command"]
        return "The touchdowns were made by a " + (
            f"program of the study's author: {program}" if program else "function."
        )
    study, (first, *others) = data.study["bed"], data.results.beds
    which = f"the first of {len(others) + 1} beds," if others else "a bed"
    width = " x ".join(f"{length:g}" for length in study["width"])
    walls = study.get("sides", "walls") == "walls"
    ground = (
        f"in an open box of {width} m"
        if walls
        else f"on ground that repeats after {width} m, of which one tile is drawn,"
    )
    echo = "boundary reflections" if walls else "reflections and waves of the lander's own images"
    return (
        f"{study['grain_count']} grains, convex hulls with a mean diameter of {number(first.mean_diameter_m)} m, "
        f"fall as a random cloud and settle {ground} into {which} "
        f"{number(first.surface_height_m)} m deep with a solid fraction of {first.solid_fraction:.2f} and "
        f"{first.coordination_number:.1f} contacts per grain. Grains are poured with the medians of their ranges "
        "and take the soil of each landing at its touchdown. "
        f"The bed must be at least {number(first.smallest_width_m)} m wide and "
        f"{number(first.smallest_depth_m)} m deep to avoid {echo} during the first impact; this bed "
        f"{'meets' if first.large_enough else 'does not meet'} that limit."
    )


def landing(data: PageData) -> str:
    """A landing."""
    if data.landing is None:
        return ""
    attributes, time = data.landing.attributes, data.landing.time
    ended = TouchdownOutcome(str(attributes["status"])).sentence.rstrip(".")
    images = (
        " Grains and their periodic images are drawn around its path." if attributes.get("sides") == "periodic" else ""
    )
    return (
        f"{data.shown_landing}, the lander arrives at "
        f"{number(_float(attributes['speed']))} m/s and "
        f"{math.degrees(_float(attributes['incidence'])):.3g} deg from the normal. "
        f"{ended} after {number(float(time[-1] - time[0]))} s of simulated time; "
        f"the line is the path of its centre.{images}"
    )


def counts(data: PaperPage) -> str:
    """What the designs cost."""
    table, design, designs = data.results.node_counts, data.study["design"], data.results.designs
    level, inputs = design["screening_level"], len(data.results.screening.inputs)
    grid = design["points"] == "smolyak"
    place = f"at level {level}" if grid else f"of degree {design['screening_degree']}"
    words = (
        f"The screening of {inputs} inputs {place} takes {_runs(designs['screening'])} {POINT_WORDS[design['points']]}"
    )
    if grid and inputs in table.input_counts and level in table.levels:
        full = table.tensor[table.input_counts.index(inputs)][table.levels.index(level)]
        words += f", against {thousands(full)} on the full tensor grid"
    place = f"at level {design['refined_level']}" if grid else f"of degree {design['refined_degree']}"
    kept = len(data.results.kept_inputs)
    refined = "the kept input" if kept == 1 else f"the {kept} kept inputs"
    return f"{words}; the refined design in {refined} {place} takes {_runs(designs['refined'])}."


def _runs(design: DesignCounts) -> str:
    """How many runs a design takes, and how they come about."""
    count, points = design.replicate_count, design.point_count
    return f"{design.run_count} runs" + (f" ({points} points, {count} times each)" if count > 1 else "")


def sobol(data: PaperPage) -> str:
    """Which inputs matter."""
    screening = data.results.screening
    leaders = [_leader(name, screening) for name in PAPER_OUTPUTS]
    shares = {name: screening.fits[name].noise_share for name in PAPER_OUTPUTS}
    scatter = [f"{percent(share)} for the {output(name).words}" for name, share in shares.items() if share is not None]
    rest = f"; scatter that no input explains is {listing(scatter)} of the variance of the runs" if scatter else ""
    kept = listing([input_words(name) for name in data.results.kept_inputs])
    share = min(data.results.kept_share[name] for name in data.study["design"]["kept_outputs"])
    varied = listing(leaders)
    return (
        f"{varied[:1].upper()}{varied[1:]}{rest}; the second step keeps {kept}, which together account for at least "
        f"{percent(share)} of the explained variance of each output that the selection uses."
    )


def _leader(name: str, screening: ExpansionResults) -> str:
    """The input that an output varies with most, if any was found, with its 95 % interval."""
    first = screening.sobol_first[name]
    main = max(first, key=lambda key: first[key])
    if first[main] <= 0.0:
        return f"no input explains the {output(name).words} significantly"
    low, high = (percent(end) for end in screening.sobol_first_interval[name][main])
    return (
        f"the {output(name).words} depends most on the {input_words(main)} ({percent(first[main])}, {low} to {high}, "
        "of its explained variance)"
    )


def errors(data: PaperPage) -> str:
    """How good the expansion is."""
    kept, every = (_explained(data.scores[stage]) for stage in ("test_kept", "test_all"))
    return (
        f"On new runs in which the kept inputs vary the expansion reaches {kept}; when all inputs vary, {every} "
        "(in brackets 95 % intervals; at a Q2 of 0 or less it explains nothing). Dashed lines: mean errors. A small "
        "error with a small Q2 only means that the output hardly varies."
    )


def _explained(table: Mapping[str, OutputErrors]) -> str:
    """Explained share of the variance and mean error of the outputs of [Landings-PCE] on one set of runs."""
    parts = []
    for name in PAPER_OUTPUTS:
        q2, mape = table[name].q2, table[name].mape
        words = "an undefined Q2" if q2 is None else f"Q2 = {q2_words(table[name])}"
        parts.append(f"{words} for the {output(name).words} (MAPE {'undefined' if mape is None else f'{mape:.2g} %'})")
    return listing(parts)


def scatter(data: PaperPage) -> str:
    """What may come out."""
    table = data.results.monte_carlo
    total, leaving = table.sample_count, table.leaving_count
    if not leaving:
        return f"None of the {thousands(total)} samples leaves the surface, so there is nothing to draw."
    speed, angle = table.outputs["speed_out"].quantiles, table.outputs["elevation_out"].quantiles
    degrees = output("elevation_out").factor
    return (
        f"Of {thousands(total)} samples of the refined expansion {thousands(leaving)} leave the surface, 90 % of them "
        f"at {number(speed['quantile_0.05'])} to {number(speed['quantile_0.95'])} m/s and "
        f"{degrees * angle['quantile_0.05']:.3g} to {degrees * angle['quantile_0.95']:.3g} deg above the surface; "
        "dots are the runs of all designs."
    )


def impact_map(data: SampledPage) -> str:
    """The map about the aim point; empty without impacts."""
    if not len(data.facet):
        return ""
    shared = f"{thousands(len(data.facet))} impacts of {thousands(data.flights.row_count)} flown samples"
    found = [one for one in data.results.regions if one.share > 0.9]
    if not found:
        return f"{shared} of the {data.model}: too few for a region that holds 95 % of them."
    size = f"{area(found[0].area_m2)} and is {number(found[0].largest_extent_m, 2)} m across"
    return (
        f"{shared} of the {data.model}; the smallest region that holds {percent(found[0].share)} of them covers {size}."
    )


def outcomes(data: SampledPage) -> str:
    """What becomes of the landings after the first bounce, on which body."""
    shares, site = data.results.shares, data.results.site
    extents = " x ".join(f"{length:.0f}" for length in site.extents_m)
    outward = site.effective_acceleration_outward
    direction = "outward" if outward > 0 else "inward"
    down = with_interval(shares.outcomes[FlightStatus.IMPACT].share, data.digits)
    return (
        f"{down} of the landings impact the surface again within {hours(data.study['flight']['duration'])} (body: "
        f"{number(site.mass_kg)} kg, {extents} m, one turn in {site.spin_period_s / 3600:.4g} h; at the site gravity "
        f"and rotation together amount to {number(abs(outward), 2)} m/s2 {direction}; {gravity_words(data)})."
    )


def body(data: SampledPage) -> str:
    """The body with its impacts."""
    return f"{thousands(len(data.facet))} impacts on the shape that the flights used." if len(data.facet) else ""


def rest(data: SampledPage) -> str:
    """Where landers rest after all bounces."""
    table = data.results.rest
    if isinstance(table, JourneyRest) or table.hard is None:
        return ""
    soil, hard = table.soil, table.hard
    limit = hours(data.study["rest"]["duration"])
    settled = with_interval(hard.outcomes[JourneyStatus.SETTLED].share, data.digits)
    words = f"Followed from bounce to bounce for up to {limit}, {settled} come to rest on hard ground"
    if soil is None:
        return f"{words}; unknown on the soil: {table.why_no_soil}."
    settled_on_soil, outside = (
        with_interval(soil.outcomes[status].share, data.digits)
        for status in (JourneyStatus.SETTLED, JourneyStatus.OUTSIDE)
    )
    return (
        f"{words}, {settled_on_soil} on the soil. On the soil {outside} have an unknown outcome "
        f"because an impact was outside the training range of the {data.model} or the sampled rebound was unphysical."
    )


def thousands(count: int) -> str:
    return f"{count:,}".replace(",", " ")


def _float(value: object) -> float:
    """An attribute that has to be a number."""
    if not isinstance(value, int | float):
        raise ValueError(f"landing.h5 has {value!r} where a number is needed; make the landing again")
    return float(value)


# Half of the middle nine tenths of a normal distribution, in standard deviations.
NINE_TENTHS = 1.645
# What the bands of the emulator should hold of the runs (band_90 of its scores).
BAND = LEVEL


def luck(counts: Sequence[int]) -> tuple[float, float]:
    """Between which counts nine of ten bins lie where all is right, if runs are independent."""
    total, bins = sum(counts), len(counts)
    half = NINE_TENTHS * math.sqrt(total / bins * (1.0 - 1.0 / bins))
    return total / bins - half, total / bins + half


def unlucky(counts: Sequence[int]) -> list[bool]:
    """Which bins lie outside of that."""
    low, high = luck(counts)
    return [not low <= count <= high for count in counts]


def band_luck(run_count: int) -> tuple[float, float]:
    """Between which shares nine of ten right bands hold as many independent runs."""
    half = NINE_TENTHS * math.sqrt(BAND * (1.0 - BAND) / run_count)
    return BAND - half, BAND + half
