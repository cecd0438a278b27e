"""The captions of figures that the page of any study has: its site, its ground, a landing, impacts and rest."""

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from lithobrake.statements.ends import hard_ground_ends
from lithobrake.statements.labels import BODIES, region
from lithobrake.vocabulary.number_words import HOUR, counted, intervals, number, percent, thousands
from lithobrake.vocabulary.outcomes import TouchdownOutcome

if TYPE_CHECKING:
    from lithobrake.results.page_data import PageData, PageSamples
    from lithobrake.results.site_results import BedNumbers


def place_words(data: "PageData") -> str:
    """Where the study lands, in a sentence."""
    site = data.results.site
    place = f"latitude {site.latitude_deg:g} deg, longitude {site.longitude_deg:g} deg on {body_name(data.study)}"
    # A product of an archive tells which shape "the body" is.
    product = f" ({site.product_id})" if site.product_id else ""
    return f"Landing at {place}{product}."


def body_name(study: Mapping[str, Any]) -> str:
    """The body in words; study: the tables of its file."""
    site = study["site"]
    name: str = site.get("name") or BODIES.get(site["body"], "the body")
    return name


def facts(data: "PageData") -> str:
    """When the study was made, and what the body's gravity is known by."""
    date, site = data.provenance.date[:16].replace("T", ", "), data.results.site
    return (
        f"Study of {date} UTC. Escape speed at the site {number(site.escape_speed_m_s)} m/s, bulk density of the body "
        f"{number(site.bulk_density_kg_m3)} kg/m3."
    )


def bed(data: "PageData") -> str:
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
    return (
        f"{study['grain_count']} grains, convex hulls with a mean diameter of {number(first.mean_diameter_m)} m, "
        f"fall as a random cloud and settle {ground} into {which} "
        f"{number(first.surface_height_m)} m deep with a solid fraction of {first.solid_fraction:.2f} and "
        f"{first.coordination_number:.1f} contacts per grain. Grains are poured with the medians of their ranges "
        f"and take the soil of each landing at its touchdown. {_smallest_bed(first, walls=walls)}"
    )


def _smallest_bed(one: "BedNumbers", *, walls: bool) -> str:
    """Whether the bed is as large as the first impact asks."""
    echo = "boundary reflections" if walls else "reflections and waves of the lander's own images"
    return (
        f"The bed must be at least {number(one.smallest_width_m)} m wide and {number(one.smallest_depth_m)} m deep to "
        f"avoid {echo} during the first impact; this bed {'meets' if one.large_enough else 'does not meet'} that limit."
    )


def landing(data: "PageData") -> str:
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


def _float(value: object) -> float:
    """An attribute that has to be a number."""
    if not isinstance(value, int | float):
        raise ValueError(f"landing.h5 has {value!r} where a number is needed; make the landing again")
    return float(value)


def impact_map(samples: "PageSamples") -> str:
    """The map of the next impacts about the aim point; empty without impacts."""
    if not len(samples.facet):
        return ""
    flown = f"{thousands(samples.flights.row_count)} flown samples of the {samples.results.model}"
    shared = f"{thousands(len(samples.facet))} impacts of {flown}"
    found = [one for one in samples.results.regions if one.share > 0.9]
    if not found:
        return f"{shared}: too few for a region that holds {percent(0.95)} of them."
    return f"{shared}; {region(found[0], 'them')}."


def outcomes(data: "PageData") -> str:
    """What becomes of the landings after the first touchdown, on which body."""
    site = data.results.site
    extents = " x ".join(f"{length:.0f}" for length in site.extents_m)
    outward = site.effective_acceleration_outward
    direction = "outward" if outward > 0 else "inward"
    bars = f"Bars: fractions of the landings with their {intervals(data.level)}. " if data.has_interval else ""
    return (
        f"{bars}The body: {number(site.mass_kg)} kg, {extents} m, one turn in {site.spin_period_s / HOUR:.4g} h; at "
        f"the site gravity and rotation together amount to {number(abs(outward), 2)} m/s2 {direction}."
    )


def body(samples: "PageSamples") -> str:
    """The body with the next impacts."""
    return f"{counted(len(samples.facet), 'impact')} on the shape that the flights used." if len(samples.facet) else ""


def hard_ground(data: "PageData") -> str:
    """Where landers rest on other ground; empty where none was followed there."""
    return " ".join(hard_ground_ends(data.results.hard_ground, data.study["journey"]["duration"], data.digits))


def whole(looked_at: int, sample_count: int) -> str:
    """What the shares of the flights of samples are shares of; looked_at: samples up to the last that was flown."""
    words = f"{thousands(looked_at)} samples"
    return f"all {words}" if looked_at == sample_count else f"the {words} up to the last that was flown"
