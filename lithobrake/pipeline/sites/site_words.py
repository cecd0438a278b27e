"""What a map of sites says, and which landers it holds over, in sentences."""

from dataclasses import replace

from lithobrake.results.site_map import SiteMap
from lithobrake.vocabulary.percentages import percent, span, with_interval

HOUR = 3600.0
NOT_COMPARED = "The emulator was not compared with landings: journey.emulated_count is 0."


def with_words(site_map: SiteMap) -> SiteMap:
    """The same map with its sentences."""
    return replace(site_map, statement=_statement(site_map), of=_population(site_map))


def place_words(latitude_deg: float, longitude_deg: float) -> str:
    """A place as 12 N 30 W."""
    north, east = "N" if latitude_deg >= 0.0 else "S", "E" if longitude_deg >= 0.0 else "W"
    return f"{abs(latitude_deg):.0f} {north} {abs(longitude_deg):.0f} {east}"


def _statement(found: SiteMap) -> str:
    """How many rest, where most do, and whether landings agree."""
    total, answered = len(found.cells), [site for site in found.cells if site.ends is not None]
    if not answered or found.at_rest is None:
        return (
            f"None of {total} sites has a result: their impacts are outside the range of the touchdowns of the study "
            f"({found.cells[0].beyond}). Deliver the landers of the study all over the body."
        )
    shares = [site.ends.at_rest.share for site in answered if site.ends is not None]
    where = f"all {total} sites" if len(answered) == total else f"the {len(answered)} of {total} sites with a result"
    said = (
        f"Within {found.duration_s / HOUR:.3g} h {with_interval(found.at_rest, level=found.level)} of the landers come "
        f"to rest over {where}, by site {span(min(shares), max(shares), 0)}."
    )
    best = [site for site in answered if site.not_worse]
    if best and len(best) == len(answered) > 1:
        said += " No site can be distinguished from the best."
    elif best:
        site = max(best, key=lambda one: one.ends.at_rest.share if one.ends else 0.0)
        count = f"{len(best)} sites" if len(best) > 1 else "One site"
        cannot = "cannot be distinguished from the best" if len(best) > 1 else "is better than every other"
        said += f" {count} {cannot}, at {place_words(site.latitude_deg, site.longitude_deg)}."
    return f"{said} {_compared(found)}"


def _compared(found: SiteMap) -> str:
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
    verdict = "agree" if whole.agrees else "do not agree"
    where = f" over the body, and agree in {agree} of its {len(regions)} regions" if regions else ""
    return f"{said}: they {verdict}{where}."


def _population(found: SiteMap) -> str:
    """Which landers the numbers hold over."""
    intervals = (
        f"{percent(found.level)} intervals cover other landers and other beds, by the scatter between {found.refits} "
        f"refits of the emulator to {found.beds} beds sampled with replacement ({found.touchdowns} touchdowns), and "
        "any outcome of landers whose outcome is unknown"
        if found.why is None
        else f"There are no intervals. {found.why}"
    )
    return (
        f"{found.landers} landers per site, delivered as in the study except for their aim points, which are spread "
        f"evenly over its {found.area_m2:.3g} m2; every site has the same landers. {intervals.rstrip('.')}. They do "
        "not cover soils outside the ranges of the study, nor the model error of the emulator, which the comparison "
        "with landings tests. A site has no result where more than 10 % of its landers have an impact outside the "
        "range of the touchdowns of the study."
    )
