"""What is wrong with the soils of regions, found before anything runs and without the shape of the body."""

import re
from collections.abc import Iterator
from pathlib import Path

from lithobrake.study.contact_checks import contact_problems
from lithobrake.study.lander_checks import NAME
from lithobrake.study.soil_section import SoilSection, facet_numbers
from lithobrake.study.study import Study
from lithobrake.vocabulary.quantities import ELSEWHERE


def soil_problems(study: Study) -> Iterator[str]:
    """One sentence for each thing that is wrong; none where the study has no [soil]."""
    if not study.soil:
        return
    if study.journey is None:
        yield (
            f"soil.{next(iter(study.soil))} is the soil of a region for the touchdowns of journeys, and the study has "
            "no [journey]: all its landings are on [grain]; add [journey], or leave [soil] out"
        )
        return
    if study.design.side_runs:
        yield (
            "design.side_runs is true and makes first touchdowns again on a second soil, and [soil] gives regions "
            "their own; leave one of the two out"
        )
    yield from _emulator_problems(study)
    for name, soil in study.soil.items():
        yield from _region_problems(name, soil)
        if study.has_soil:
            known = list(contact_problems(study))
            yield from (f"soil.{name}: {text}" for text in contact_problems(study.on_soil(name)) if text not in known)


def _emulator_problems(study: Study) -> Iterator[str]:
    """Questions to the emulator of all touchdowns, which knows one soil for the whole body."""
    asked = ["aim.grid"] if study.aim.names else []
    journey = study.journey
    if journey is not None and "emulated_count" in journey.model_fields_set and journey.emulated_count:
        asked.append(f"journey.emulated_count = {journey.emulated_count}")
    for key in asked:
        yield (
            f"{key} asks the emulator of the touchdowns, which has one soil for all of the body, and [soil] gives "
            "regions their own; leave one of the two out"
        )


def _region_problems(name: str, soil: SoilSection) -> Iterator[str]:
    """A region without a name, bounds or a soil of its own, or that no ground can lie in."""
    key = f"soil.{name}"
    if not re.fullmatch(NAME, name, re.ASCII) or name == ELSEWHERE:
        yield (
            f'{key} is no name; allowed: letters, digits, _ and -, and not "{ELSEWHERE}", the ground of [grain]; '
            "rename it"
        )
    if not soil.has_bounds:
        yield f"{key} has no bounds; allowed: one at least of latitude_deg, longitude_deg, slope_deg, facets; add it"
    if not soil.grain.values():
        yield f"{key}.grain is empty, so its soil is that of [grain]; write what differs there, or leave {key} out"
    if soil.longitude_deg is not None:
        west, east = soil.longitude_deg
        if east - west > 360.0 or (east - west) % 360.0 == 0.0:
            yield (
                f"{key}.longitude_deg is [{west:g}, {east:g}]; allowed: from one longitude eastward to another, less "
                "than once round; write [170, -170] for 20 degrees across 180, and leave it out for all longitudes"
            )
    if soil.facets is not None:
        try:
            facet_numbers(Path(soil.facets))
        except (ValueError, OSError) as error:
            said = (error.strerror or str(error)) if isinstance(error, OSError) else str(error)
            yield f"{key}.facets: {soil.facets}: {said}"
