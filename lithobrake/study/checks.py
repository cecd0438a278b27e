"""What is wrong between the keys of a study that are each right in themselves: looked at before anything runs."""

import os
import re
import shlex
import shutil
from collections.abc import Iterator
from importlib.util import find_spec

from lithobrake.study import ground_checks, lander_checks
from lithobrake.study.body_checks import body_problems, rotation_problems
from lithobrake.study.delivery_checks import journey_problems
from lithobrake.study.design_checks import design_problems
from lithobrake.study.ground_sections import Bell, Between, Constant, PowerLaw
from lithobrake.study.limit_state_checks import limit_state_problems
from lithobrake.study.quantity import reach
from lithobrake.study.question_checks import aim_problems
from lithobrake.study.study import Study

# A bed narrower than this many lander diameters would hold the lander between its walls.
BED_WIDTH_PER_LANDER = 2.0
# Fewer grains across are no bed.
BED_WIDTH_PER_GRAIN = 3.0
# The largest grain of a bed over its smallest.
WIDEST_SIZES = 1000.0


def problems(study: Study) -> Iterator[str]:
    """One sentence for each thing that is wrong between keys that are each right in themselves."""
    yield from _arrival_problems(study)
    yield from design_problems(study)
    yield from _solver_problems(study)
    yield from limit_state_problems(study)
    yield from aim_problems(study)
    yield from journey_problems(study)
    yield from ground_checks.soil_problems(study)
    yield from _touchdown_problems(study)
    yield from rotation_problems(study)
    yield from body_problems(study)


def landing_problems(study: Study) -> Iterator[str]:
    """The same for a single landing: lander, bed, place, contact and gravity."""
    yield from _arrival_problems(study)
    yield from _touchdown_problems(study)


def _arrival_problems(study: Study) -> Iterator[str]:
    yield from _shape_problems(study)
    yield from lander_checks.inertia_problems(study.lander)
    yield from _grain_problems(study)
    yield from _place_problems(study)


def _touchdown_problems(study: Study) -> Iterator[str]:
    if study.has_soil:
        yield from ground_checks.material_problems(study)
        yield from ground_checks.slope_problems(study)
        yield from ground_checks.cover_problems(study)
        yield from ground_checks.twin_problems(study)
    gravity = study.surface.gravity
    # "site" is checked where the acceleration is worked out, which needs the shape of the body (pipeline/site.py).
    if not isinstance(gravity, str) and study.bed.settle_gravity is None and reach(gravity)[0] <= 0.0:
        yield (
            "surface.gravity reaches zero or points outward, and no bed settles under that; "
            "give bed.settle_gravity an inward value, say 2e-5 m/s2 (the touchdown keeps surface.gravity)"
        )


def _grain_problems(study: Study) -> Iterator[str]:
    yield from _size_problems("bed.diameter", study.bed.diameter)
    if study.bed.boulders is not None:
        yield from _size_problems("bed.boulders.diameter", study.bed.boulders.diameter)
    largest = largest_diameter(study)
    repeats = study.bed.sides == "periodic"
    least = ground_checks.widths_in_grains(study)[0] if repeats else BED_WIDTH_PER_GRAIN
    limit = min(study.bed.width) / least
    # A grain of exactly a third may not fail by the rounding of the division.
    if largest > limit * (1 + 1e-12):
        shape = f'with bed.sides = "periodic" and bed.cloud_point_count = {study.bed.cloud_point_count}'
        part = f"bed.width over {least:.3g} {shape}" if repeats else "a third of bed.width"
        yield (
            f"bed.diameter reaches to {largest:g} m; allowed: at most {limit:.3g} m, {part}; "
            "widen the bed or take smaller grains"
        )


def _size_problems(key: str, diameter: Constant | Between | Bell | PowerLaw) -> Iterator[str]:
    """A distribution of sizes with its limits the wrong way round, too far apart, or of none."""
    if not isinstance(diameter, Constant):
        lower, upper = diameter.lower, diameter.upper
        if lower >= upper:
            yield f"{key} reaches from {lower:g} to {upper:g} m; allowed: lower below upper; swap them"
        elif lower < upper / WIDEST_SIZES:
            yield (
                f"{key} reaches from {lower:g} to {upper:g} m; allowed: lower at least "
                f"{1 / WIDEST_SIZES:g} of upper, as no bed of so unlike grains is settled; raise lower"
            )
    yield from _distribution_problems(key, diameter)


def largest_diameter(study: Study) -> float:
    """Largest diameter that a grain can have [m], of the sphere of equal volume."""
    sizes = study.bed.diameter
    return sizes.value if isinstance(sizes, Constant) else sizes.upper


def _distribution_problems(name: str, sizes: Constant | Between | Bell | PowerLaw) -> Iterator[str]:
    """Exponents of a power law that are none, or turn it over, and a bell without grains between its limits."""
    if isinstance(sizes, PowerLaw):
        given = {key: getattr(sizes, key) for key in ("exponent", "cumulative_exponent")}
        given = {key: value for key, value in given.items() if value is not None}
        if len(given) != 1:
            yield (
                f"{name} takes exponent or cumulative_exponent, and "
                f"{'both are' if given else 'neither is'} given; keep one: the number of grains per diameter D falls "
                "with D**-exponent, that of grains larger than D with D**-cumulative_exponent"
            )
        for key, value in given.items():
            if value < 0.0:
                yield (
                    f"{name}.{key} is {value:g}; allowed: at least 0, as the number of grains falls with "
                    f"D**-{key}; write the size of the slope, without its sign"
                )
    elif isinstance(sizes, Bell) and sizes.lower < sizes.upper:
        from lithobrake.chaos import TruncatedNormal

        try:
            TruncatedNormal(sizes.mean, sizes.std, sizes.lower, sizes.upper)
        except ValueError as error:
            yield f"{name} is refused: {error}"


def _shape_problems(study: Study) -> Iterator[str]:
    """A lander without a shape or with parts that are none, too large for the bed, or that no body can be."""
    # Sizes and masses below are those of whole shapes: what is missing here would fail there in other words.
    found = [*lander_checks.shape_problems("lander", study.lander), *lander_checks.part_problems(study.lander)]
    yield from found
    if found:
        return
    try:
        radius, found = lander_checks.lander_radius(study.lander), list(lander_checks.mass_problems(study.lander))
    except (ValueError, OSError) as error:
        meshes = [name for name, part in study.lander.part.items() if part.file is not None]
        yield f"lander.file{f', or that of lander.part.{meshes[0]}' if meshes else ''}: {error}"
        return
    yield from found
    if found:
        return
    yield from lander_checks.hinge_problems(study.lander, radius, study.contact.stepping)
    yield from ground_checks.size_problems(study, radius)
    yield from ground_checks.spin_problems(study, radius)
    yield from ground_checks.boulder_problems(study, largest_diameter(study), radius)
    yield from _width_problems(study, radius)


def _width_problems(study: Study, radius: float) -> Iterator[str]:
    """A bed too narrow for a lander that reaches a radius [m] from its centre of mass."""
    lander, width = study.lander, min(study.bed.width)
    mesh = f', or name the unit of lander.file (lander.unit is "{lander.unit}")'
    unit = mesh if lander.file else ", or mend the lengths of the lander, which are in m"
    main = 2 * lander_checks.main_radius(lander)
    least, why = BED_WIDTH_PER_LANDER * main, f"twice the largest diameter of the lander ({main:.3g} m)"
    beside = ground_checks.widths_in_grains(study)[1] if study.bed.sides == "periodic" else 0.0
    images = 2 * radius + beside * largest_diameter(study)
    if images > least:
        parts = ", with its parts," if lander.part else ""
        reach = f"twice the {radius:.3g} m that the lander{parts} reaches from its centre of mass"
        grains = (
            f", and {beside:.3g} of the grains' largest diameters, {ground_checks.TWO_IMAGES}" if beside > 0.0 else ""
        )
        least, why = images, f"{reach}{grains}"
    if width < least:
        yield (
            f"bed.width is {width:g} m at its narrowest; allowed: at least {least:.3g} m, {why}; widen the bed and add "
            f"grains{unit}"
        )


def narrowest_period(study: Study) -> float:
    """Least width [m] of ground that repeats, for the lander, the grains and the boulders of a study."""
    radius, (per_grain, beside_lander) = (
        lander_checks.lander_radius(study.lander),
        ground_checks.widths_in_grains(study),
    )
    largest = largest_diameter(study)
    boulders = ground_checks.boulder_width(study, largest, radius)
    main = BED_WIDTH_PER_LANDER * 2.0 * lander_checks.main_radius(study.lander)
    return max(main, 2.0 * radius + beside_lander * largest, per_grain * largest, boulders)


def _place_problems(study: Study) -> Iterator[str]:
    impact, half = study.impact, [width / 2 for width in study.bed.width]
    if impact.place is not None and impact.region is not None:
        yield "impact.place and impact.region are both given; keep one: a place for all runs, or a region to draw from"
    if impact.pointing_error_deg is not None and impact.orientation == "random":
        yield (
            f"impact.pointing_error_deg is {impact.pointing_error_deg:g}, and impact.orientation is "
            '"random", which points anywhere already; allowed: a quaternion that the error is about; give one, or '
            "leave the error out"
        )
    if isinstance(impact.orientation, tuple):
        yield from lander_checks.quaternion_problems("impact.orientation", impact.orientation)
    for key, spot in (("place", impact.place), ("region", impact.region)):
        if spot is None:
            continue
        for axis, limit in zip("xy", half, strict=True):
            value = getattr(spot, axis)
            lower, upper = value if isinstance(value, tuple) else reach(value)
            if lower < -limit or upper > limit:
                yield (
                    f"impact.{key}.{axis} reaches from {lower:g} to {upper:g} m; allowed: -{limit:g} to {limit:g} m, "
                    "counted from the middle of the bed; move it inside or widen the bed"
                )


def _solver_problems(study: Study) -> Iterator[str]:
    solver = study.solver
    if solver.command is not None and study.function is not None:
        yield "solver.command names a program, and a Python model is given too; keep one of the two"
        return
    for name in solver.inputs:
        # Names stand in figures and tables, where other characters have a meaning of their own.
        if not re.fullmatch(lander_checks.NAME, name):
            yield f"solver.inputs.{name} is no name; allowed: letters, digits, _ and -; rename it"
    yield from _solver_file_problems(study)
    if solver.command is None:
        if solver.inputs and study.has_soil:
            yield "solver.inputs has numbers, and solver.command is missing; give the command that reads them"
        return
    from lithobrake.campaign.model_server import PREFIX, ModelServer

    try:
        words = shlex.split(solver.command)
    except ValueError as error:
        yield f"solver.command is {solver.command!r}; {str(error).lower()}: close every quotation mark"
        return
    # The command is printed as the study begins, where escape sequences would act on the terminal.
    if not solver.command.isprintable():
        yield f"solver.command is {solver.command!r}; allowed: what can be shown on one line; write plain words"
        return
    if solver.command.startswith(PREFIX):
        try:
            ModelServer.of(solver.command)
        except ValueError as error:
            yield f"solver.command is {error}"
        return
    # Looked for on this machine alone; on a worker of a cluster that lacks it the runs fail.
    if not words or shutil.which(words[0]) is None:
        yield f'solver.command begins with "{" ".join(words[:1])}", which is no program here; give its path'


def _solver_file_problems(study: Study) -> Iterator[str]:
    solver = study.solver
    if not solver.templates and solver.answer == "outputs.json":
        return
    is_program = solver.command is not None and not solver.command.startswith("umbridge:")
    if not is_program:
        yield "solver.templates and solver.answer are files of a program, and solver.command names none; leave them out"
        return
    from lithobrake.campaign.program_answer import DECODERS

    for name in solver.templates:
        if not os.path.isfile(name):
            yield f"solver.templates has {name!r}; no such file; give its path from the study file"
    # All of them are written to one folder for each run, where the second of one name would replace the first.
    stems = [os.path.basename(name) for name in (*solver.templates, "inputs.json", "log.txt", solver.answer)]
    for name in sorted({stem for stem in stems if stems.count(stem) > 1}):
        yield f"solver.templates and solver.answer: {name} would stand twice in the folder of a run; rename one"
    plain = os.path.basename(solver.answer) == solver.answer and solver.answer.isprintable()
    if not plain or os.path.splitext(solver.answer)[1].lower() not in DECODERS:
        endings = ", ".join(DECODERS)
        yield f"solver.answer is {solver.answer!r}; allowed: a file name without folders, ending in {endings}"
    elif solver.answer.lower().endswith((".yaml", ".yml")) and find_spec("yaml") is None:
        yield f'solver.answer is {solver.answer!r}, and PyYAML is not installed: pip install "lithobrake[yaml]"'
