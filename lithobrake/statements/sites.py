"""A map of sites in sentences: how many landers rest, where most do, and over which landers that holds."""

from dataclasses import replace

from lithobrake.results.site_results import MOST_UNKNOWN, SiteMap
from lithobrake.statements.ends import at_rest
from lithobrake.statements.journeys import agreement
from lithobrake.statements.labels import area
from lithobrake.vocabulary.number_words import counted, intervals, out_of, percent, span, with_interval

NOT_COMPARED = (
    "The emulator was not compared with landings, as journey.emulated_count is 0 or landers are flown to the ground."
)


def with_words(site_map: SiteMap) -> SiteMap:
    """The same map with its sentences."""
    return replace(site_map, statement=statement(site_map), of=population(site_map))


def place_words(latitude_deg: float, longitude_deg: float) -> str:
    """A place as 12 N 30 W."""
    north, east = "N" if latitude_deg >= 0.0 else "S", "E" if longitude_deg >= 0.0 else "W"
    return f"{abs(latitude_deg):.0f} {north} {abs(longitude_deg):.0f} {east}"


def statement(found: SiteMap) -> str:
    """How many rest, where most do, and whether landings agree."""
    return page_answer(found) if found.at_rest is None else f"{page_answer(found)} {compared(found)}"


def page_answer(found: SiteMap) -> str:
    """How many rest, and where most do, as a page begins."""
    total, answered = len(found.cells), [site for site in found.cells if site.ends is not None]
    if not answered or found.at_rest is None:
        return (
            f"None of {total} sites has a result: their impacts are outside the range of the touchdowns of the study "
            f"({found.cells[0].beyond}). Deliver the landers of the study all over the body."
        )
    shares = [site.ends.at_rest.value for site in answered if site.ends is not None]
    where = (
        f"all {total} sites" if len(answered) == total else f"the {out_of(len(answered), total, 'sites')} with a result"
    )
    return (
        f"{at_rest(found.at_rest, found.duration_s, level=found.level)} over {where}, by site "
        f"{span(min(shares), max(shares), 0)}.{_best(found)}"
    )


def _best(found: SiteMap) -> str:
    """Which sites cannot be distinguished from the best."""
    best, answered = [site for site in found.cells if site.not_worse and site.ends is not None], found.answered
    if not best:
        return ""
    if len(best) == answered > 1:
        return " No site can be distinguished from the best."
    site = max(best, key=lambda one: one.ends.at_rest.value if one.ends else 0.0)
    cannot = "cannot be distinguished from the best" if len(best) > 1 else "is better than every other"
    count = counted(len(best), "site") if len(best) > 1 else "One site"
    return f" {count} {cannot}, at {place_words(site.latitude_deg, site.longitude_deg)}."


def compared(found: SiteMap) -> str:
    """Whether emulator and landings agree."""
    if not found.agreement:
        return NOT_COMPARED
    whole, *regions = found.agreement
    agree = sum(one.agrees is True for one in regions)
    said = (
        f"Of the {whole.journeys} journeys of the study {with_interval(whole.landings)} come to rest by landings and "
        f"{with_interval(whole.emulator)} by the emulator"
    )
    if whole.agrees is None:
        return f"{said}."
    where = f" over the body, and agree in {agree} of its {len(regions)} regions" if regions else ""
    return f"{said}: they {agreement(whole.agrees)}{where}."


def population(found: SiteMap) -> str:
    """Which landers the numbers hold over."""
    covered = (
        f"{intervals(found.level)} cover other landers and other beds, by the scatter between {found.refits} "
        f"refits of the emulator to {found.beds} beds sampled with replacement ({found.touchdowns} touchdowns), and "
        "any outcome of landers whose outcome is unknown"
        if found.why is None
        else f"There are no intervals. {found.why}"
    )
    return (
        f"{found.landers} landers per site, delivered as in the study except for their aim points, which are spread "
        f"evenly over its {area(found.area_m2)}; every site has the same landers. {covered.rstrip('.')}. They do "
        "not cover soils outside the ranges of the study, nor the model error of the emulator, which the comparison "
        f"with landings tests. A site has no result where {_beyond()}."
    )


def _beyond() -> str:
    return (
        f"more than {percent(MOST_UNKNOWN)} of its landers have an impact outside the range of the study's touchdowns"
    )


def warnings(found: SiteMap) -> list[str]:
    """What to beware of."""
    said, lacking = [found.why] if found.why else [], len(found.cells) - found.answered
    if lacking:
        said.append(
            f"{out_of(lacking, len(found.cells), 'sites')} have no result: {_beyond().replace('its', 'their')}. A "
            "study delivered all over the body covers them."
        )
    if found.agreement and found.agreement[0].agrees is False:
        said.append("Emulator and landings do not agree on the landers at rest: follow more journeys (journey.count).")
    return said


def rest_caption(found: SiteMap) -> str:
    """The map beside the answer."""
    return f"Fraction of the landers that comes to rest, by site of {found.body}."


def caption(found: SiteMap) -> str:
    """The figure of all numbers of the sites."""
    light = "; light is the mean over a day and the seasons of the study" if found.cells[0].light else ""
    return (
        f"The same delivery to each of {len(found.cells)} sites of {found.body}, in Hammer's equal-area projection "
        f"about longitude 0. Slopes are those of the facets{light}. Intervals are in the table of all sites."
    )


def everywhere(flat: list[tuple[str, float]]) -> str:
    """The numbers that are the same at every site, as sentences behind a caption; titles end with their unit."""
    sentences = []
    for title, value in flat:
        name, _, unit = title.rstrip("]").partition(" [")
        sentences.append(f" {name[0].upper()}{name[1:]}: {value:.3g} {unit} at every site.")
    return "".join(sentences)


def agreement_caption(found: SiteMap) -> str:
    """The figure of emulator and landings."""
    return (
        "The journeys of the study, by simulated landings and by refits of the emulator to other beds: "
        "all of them (filled), and those with their first touchdown in each region of an "
        f"eighth of the body, with {intervals(found.level)}."
    )


def table_note(found: SiteMap) -> str:
    return (
        f"Middle of each site [deg]. Fractions and medians with {intervals(found.level)}; slope and light "
        f"as the mean over the site, and the span of {percent(0.9)} of its area. Journeys: of the study, with their "
        "first touchdown there."
    )
