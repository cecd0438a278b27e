"""What is wrong between [delivery], [journey] and the rest of a study."""

from collections.abc import Iterator

from lithobrake.study.delivery_checks import delivery_problems
from lithobrake.study.sky_checks import sky_problems
from lithobrake.study.study import Study
from lithobrake.vocabulary.plain_text import show


def journey_problems(study: Study) -> Iterator[str]:
    """One sentence for each thing that is wrong."""
    yield from delivery_problems(study)
    yield from sky_problems(study)
    if study.journey is None:
        if study.site.roughness_deg and not study.rest.count:
            yield (
                f"site.roughness_deg is {study.site.roughness_deg:g}, and no impact of the study reads it: there is no "
                "[journey] and rest.count is 0; leave it out, or tilt the landings by surface.slope_deg"
            )
        return
    design = study.design
    if design.method != "drawn":
        yield f'[journey] follows drawn landings, and design.method is "{design.method}"; leave one of the two out'
    if study.journey.count is not None and study.journey.count != design.run_count:
        yield (
            f"journey.count is {study.journey.count} and design.run_count {design.run_count}; both are the number of "
            "journeys: keep one"
        )
    if study.surface.gravity != "site":
        yield (
            f'surface.gravity is {show(study.surface.gravity)}; allowed with [journey]: "site", as every touchdown '
            "takes the acceleration of where it is; leave it out"
        )
    if study.surface.model_fields_set & {"slope_deg", "slope_azimuth_deg"}:
        yield "surface.slope_deg is given; with [journey] every touchdown has the slope of where it is; leave it out"
    if study.has_soil and study.bed.sides != "periodic":
        yield 'bed.sides is "walls"; allowed with [journey]: "periodic", as journeys have no edge; change it'
    of_emulator = {
        "rest": study.rest.model_fields_set,
        "limit_states": study.limit_states.conditions(),
        "monte_carlo": study.monte_carlo.model_fields_set,
    }
    for name, given in of_emulator.items():
        if given:
            yield f"[{name}] asks the emulator of single landings, and [journey] has none; leave one of the two out"
