"""What is wrong with the design of a study: too few landers, more terms than runs, runs made to no end."""

import math
from collections.abc import Iterator

from lithobrake.chaos import smolyak_count, term_count
from lithobrake.study.design_sections import ExpansionSection
from lithobrake.study.quantity import Uncertain, reach, uncertain
from lithobrake.study.study import Study
from lithobrake.vocabulary.constants import FEWEST_RUNS_OF_EMULATOR
from lithobrake.vocabulary.plain_text import show

# Fewer tell no share.
FEWEST_SAMPLES = 100


def design_problems(study: Study) -> Iterator[str]:
    """One sentence for each thing that is wrong with the design of a study, or between it and what varies."""
    input_count = len(uncertain(study.touchdown_values()))
    if input_count == 0:
        yield (
            "nothing in grain, lander, impact or surface is uncertain; give at least one key a distribution, "
            'such as young_modulus = { distribution = "log_uniform", lower = 1e6, upper = 1e8 }'
        )
        return
    yield from _count_problems(study)
    yield from _half_width_problems(study)
    if study.expansion is None:
        if study.monte_carlo.scatter:
            yield (
                "monte_carlo.scatter is true, and there is no [expansion]: samples of an emulator always have the "
                "scatter; leave it out"
            )
        return
    kept = study.expansion.kept_outputs
    if len(set(kept)) < len(kept):
        yield f"expansion.kept_outputs is {show(list(kept))}; allowed: outputs, each once; leave out what stands twice"
    yield from _unbounded_problems(study, study.expansion)
    yield from _replicate_problems(study, study.expansion)
    yield from _stage_problems(study.expansion, input_count)


def _count_problems(study: Study) -> Iterator[str]:
    """Too few landers or samples, and questions to landers that are not drawn."""
    runs, samples = study.design.run_count, study.sample_count
    if 0 < samples < FEWEST_SAMPLES:
        yield f"monte_carlo.sample_count is {samples}; allowed: 0, or at least {FEWEST_SAMPLES}; raise it"
    if runs == 1 or (runs == 0 and study.expansion is None):
        yield (
            f"design.run_count is {runs}; allowed: at least 2, or 0 with [expansion], which is then all of the study; "
            "raise it"
        )
    if 1 < runs < FEWEST_RUNS_OF_EMULATOR and samples and study.expansion is None:
        yield (
            f"design.run_count is {runs}, and monte_carlo.sample_count {samples}; allowed with samples of the "
            f"emulator: at least {FEWEST_RUNS_OF_EMULATOR}, by which it is fitted; raise it, or set "
            "monte_carlo.sample_count = 0"
        )
    if runs == 0:
        yield from _undrawn_problems(study)
    elif study.bed_count > runs:
        yield (
            f"bed.bed_count is {study.bed_count}, and design.run_count {runs}; allowed: as many beds as runs at most; "
            "raise the runs, or lower the beds"
        )


def _undrawn_problems(study: Study) -> Iterator[str]:
    """What asks landers that are drawn, of which there are none."""
    asked = {
        "[limit_states]": study.limit_states.conditions(),
        "[aim]": study.aim.names,
        "[sky]": study.sky.bodies,
        "[soil]": study.soil,
        "design.half_width": study.design.half_width,
        "design.side_runs": study.design.side_runs,
    }
    for name, given in asked.items():
        if given:
            yield (
                f"{name} asks landers drawn from the laws of the inputs, and design.run_count is 0; raise it, or leave "
                f"{name} out"
            )


def _half_width_problems(study: Study) -> Iterator[str]:
    """Runs that no interval could end."""
    design, asked = study.design, study.design.half_width_of
    names = study.limit_states.conditions()
    if asked is not None and asked not in names:
        known = ", ".join(names) or "none: the study has no [limit_states]"
        yield f'design.half_width_of is "{asked}"; allowed: a name of [limit_states] ({known}); add it there'
    if design.half_width is None and asked is not None:
        yield f'design.half_width_of is "{asked}", and there is no design.half_width; give one, or leave it out'
    if design.half_width is None:
        if design.largest_run_count is not None:
            yield (
                f"design.largest_run_count is {design.largest_run_count}, and nothing asks for more than "
                "design.run_count; leave it out, or give design.half_width"
            )
        return
    if design.most_runs < design.run_count:
        yield (
            f"design.largest_run_count is {design.most_runs}; allowed: at least design.run_count, "
            f"{design.run_count}; raise it, or leave it out for ten times as many"
        )
    if study.bed_count == 1:
        yield (
            f"design.half_width is {design.half_width:g}, and runs on one bed have no interval, however many they are; "
            "set bed.bed_count to 12 or more, or leave it out"
        )
    place = study.impact.place
    if place is not None and not isinstance(place.x, Uncertain) and not isinstance(place.y, Uncertain):
        yield (
            f"design.half_width is {design.half_width:g}, and runs at one place have no interval, however many they "
            "are; leave impact.place out, or design.half_width"
        )


def _stage_problems(design: ExpansionSection, input_count: int) -> Iterator[str]:
    """Runs of the two designs that do not fit what is fitted to them."""
    # How many inputs the screening will keep is not known yet, so the refined fit must be possible for any number of
    # them.
    for stage, counts in (("screening", [input_count]), ("refined", range(1, input_count + 1))):
        level, degree = getattr(design, f"{stage}_level"), getattr(design, f"{stage}_degree")
        point_count, smolyak = getattr(design, f"{stage}_count"), design.points == "smolyak"
        key = f"expansion.{stage}_{'level' if smolyak else 'count'}"
        if smolyak == (point_count is not None):
            yield (
                f"expansion.{stage}_count {'does not go with' if smolyak else 'is missing; it is needed by'} "
                f'expansion.points = "{design.points}"; allowed: "smolyak" takes levels, all others take counts'
            )
            continue
        for count in counts:
            found = smolyak_count(count, level) if smolyak else int(point_count or 0)
            terms = term_count(count, degree)
            # Sparse fits choose fewer terms than there are runs. Fekete points are chosen from the terms themselves, so
            # they need as many whatever is fitted.
            if found < terms and (design.fit == "ols" or design.points == "fekete"):
                where = f"{found} nodes of level {level}" if smolyak else f"{found} points of {key}"
                yield (
                    f"expansion.{stage}_degree is {degree}; with {count} inputs it has {terms} terms, more than the "
                    f"{where}; lower the degree or raise {key}"
                )
                break


def _unbounded_problems(study: Study, design: ExpansionSection) -> Iterator[str]:
    """Inputs that have no end, on a grid that puts nodes at the ends."""
    if design.points != "smolyak":
        return
    for name, value in uncertain(study.touchdown_values()).items():
        if not all(map(math.isfinite, reach(value))):
            yield (
                f'{name} is {value.distribution}, which has no end, and expansion.points = "smolyak" puts runs at the '
                "ends; give it two limits (truncated_normal, log_uniform, uniform, beta), or take other points"
            )


def _replicate_problems(study: Study, design: ExpansionSection) -> Iterator[str]:
    """Runs that would be made several times to the same end."""
    impact, count = study.impact, design.replicate_count
    drawn = study.bed_count > 1 or impact.place is None or impact.pointing_error_deg
    drawn = drawn or "random" in (impact.azimuth_deg, impact.orientation)
    if count > 1 and not drawn and study.has_soil:
        yield (
            f"expansion.replicate_count is {count}, but runs draw nothing by chance, so all {count} would be equal; "
            'give them something to draw (bed.bed_count, impact.region, azimuth_deg or orientation "random", an error '
            "of pointing) or write 1"
        )
