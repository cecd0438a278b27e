"""What is wrong with [site.rotation]: a body that it does not go with, and what cannot be had beside it."""

from collections.abc import Iterator

from lithobrake.study.flight_sections import SiteSection
from lithobrake.study.quantity import usual_reach
from lithobrake.study.study import Study
from lithobrake.vocabulary.plain_text import show

# Built-in bodies that turn once an orbit of their partner.
SYNCHRONOUS = ("dimorphos",)
DAY = 86_400.0


def rotation_problems(study: Study) -> Iterator[str]:
    """One sentence for each thing that is wrong."""
    site = study.site
    if site.rotation is None:
        if site.rotation_time is not None:
            yield "site.rotation_time is a time in [site.rotation], and there is none; add it, or leave the key out"
        return
    yield from _body_problems(site)
    yield from _time_problems(site, site.rotation.days)
    if study.sky.bodies:
        yield (
            "[sky] asks what landers at rest see over a day of the body, and with [site.rotation] no day is like "
            "another; leave one of the two out"
        )


def _body_problems(site: SiteSection) -> Iterator[str]:
    if site.body not in SYNCHRONOUS or not site.partner:
        body = f"site.body is {show(site.body)}" if site.partner else "site.partner is false"
        names = ", ".join(f'"{name}"' for name in SYNCHRONOUS)
        yield (
            f"{body}; allowed with [site.rotation]: {names} with its partner, whose torque turns it; change that, or "
            "leave the table out"
        )
        return
    for key in ("spin_period", "kernels"):
        if getattr(site, key):
            yield (
                f"site.{key} is given; with [site.rotation] the body turns once an orbit in the mean, as the built-in "
                "one does; leave one of the two out"
            )


def _time_problems(site: SiteSection, days: float) -> Iterator[str]:
    if site.rotation_time is None:
        return
    latest = usual_reach(site.rotation_time)[1]
    if latest > days * DAY:
        yield (
            f"site.rotation_time reaches {latest:.6g} s; allowed: at most {days * DAY:.6g} s, which is "
            f"site.rotation.days = {days:g}; lower it, or give more days"
        )
