"""The ground of each bed of a study whose ground is unknown: its kind, its grains, and the bed that these ask for."""

import math
from bisect import bisect_right
from collections.abc import Iterator, Mapping, Sequence
from itertools import accumulate
from typing import Any, NamedTuple

from lithobrake.files.reading import hashed_seed
from lithobrake.study import lander_checks
from lithobrake.study.checks import narrowest_period
from lithobrake.study.ground_checks import material_problems
from lithobrake.study.ground_kinds import GroundKind, GroundSection
from lithobrake.study.ground_sections import BedSection, Between, Constant
from lithobrake.study.quantity import Scalar, Uncertain, median, usual_reach
from lithobrake.study.study import Study

# What follows from the grains, and no file of a study with [ground] gives.
FOLLOWING = ("grain_count", "width", "diameter", "boulders")
# Depth of a bed, over the mean diameter of its grains and over the largest diameter of the lander, at least: grains
# some three deep, and as far to the floor as in the beds of docs/validation/bed_size.md.
DEPTH_IN_GRAINS, DEPTH_IN_LANDERS = 2.2, 0.6
SOLID_FRACTION = 0.6
# Blocks of rock over the largest diameter of the lander, where a study gives no size.
ROCK_IN_LANDERS = 3.0
# Finest grains that are simulated, over the largest diameter of the lander, where a study does not say.
FINEST_IN_LANDERS = 1.0 / 3.0
# Grains of a bed at most: more take hours a touchdown.
MOST_GRAINS = 5000
# Weights that add up to 1 do so but for the rounding of what a person writes.
ROUNDING = 1e-6
# What is drawn of a bed, by names that no kind has.
DRAWN = KIND, SIZE, RATIO = ("[kind]", "[size]", "[ratio]")
PACKING = "[packing]"
# Bodies over which uncertain weights of kinds are averaged.
BODIES = 4096


class BedGround(NamedTuple):
    """The ground of a bed. number: of the kind, from 0, in the order of the file; size, mean diameter of its grains
    [m]; ratio: of the largest to the smallest; pour_friction: with which it was poured, None for that of the grains;
    weights: of the kinds on its body, in this order."""

    kind: str
    number: int
    size: float
    ratio: float
    pour_friction: float | None = None
    weights: tuple[float, ...] = ()


def grounds(study: Study, count: int | None = None) -> list[BedGround]:
    """The ground of each of so many beds, of those of the study without a count, by its number; another number of beds
    changes none. Empty without [ground].
    """
    return [] if study.ground is None else _draw(study, 0, study.bed_count if count is None else count)


def _draw(study: Study, first: int, count: int) -> list[BedGround]:
    """The ground of so many beds from the number `first` on: a point of the sequence follows from its number."""
    from lithobrake.chaos import Uniform, sobol_sequence

    assert study.ground is not None
    uncertain = _uncertain_weights(study.ground)
    # Beds of a study without packings of its own stay what they were.
    packed = [PACKING] * any(isinstance(kind.pour_friction, Uncertain) for kind in study.ground.kind.values())
    names = [*DRAWN, *packed, *uncertain]
    points = sobol_sequence(
        dict.fromkeys(names, Uniform(0.0, 1.0)), count, hashed_seed(study.seed, "ground"), skip=first
    )
    return [_drawn(study, dict(zip(names, point, strict=True)), uncertain) for point in points.tolist()]


def _drawn(study: Study, part: Mapping[str, float], uncertain: Sequence[str]) -> BedGround:
    """The ground that numbers between 0 and 1 draw; uncertain: the kinds whose weight is."""
    assert study.ground is not None
    names = list(study.ground.kind)
    own = _weights(study.ground.kind, {name: part[name] for name in uncertain})
    number = min(bisect_right(list(accumulate(own)), part[KIND]), len(names) - 1)
    one = study.ground.kind[names[number]]
    size = max(_at(grain_size(study, one), part[SIZE]), finest(study))
    friction = None if one.pour_friction is None else _at(one.pour_friction, part.get(PACKING, 0.5))
    return BedGround(names[number], number, size, _at(one.size_ratio, part[RATIO]), friction, own)


def _uncertain_weights(ground: GroundSection) -> list[str]:
    """Kinds whose weight is uncertain."""
    return [name for name, kind in ground.kind.items() if isinstance(kind.weight, Uncertain)]


def _weights(kinds: Mapping[str, GroundKind], drawn: Mapping[str, float]) -> tuple[float, ...]:
    """The weights of the kinds on one body, in the order of the file; drawn: between 0 and 1, of uncertain ones."""
    given = [_at(kind.weight, drawn.get(name, 0.5)) for name, kind in kinds.items()]
    # Of numbers alone no bit changes.
    total = math.fsum(given) if drawn else 1.0
    return tuple(one / total for one in given)


def mean_weights(study: Study) -> dict[str, float]:
    """The weight of each kind in the mean of bodies: the probability that a bed is of this kind."""
    from lithobrake.chaos import Uniform, sobol_sequence

    assert study.ground is not None
    kinds, uncertain = study.ground.kind, _uncertain_weights(study.ground)
    if not uncertain:
        return dict(zip(kinds, _weights(kinds, {}), strict=True))
    uniform = dict.fromkeys(uncertain, Uniform(0.0, 1.0))
    points = sobol_sequence(uniform, BODIES, hashed_seed(study.seed, "weights")).tolist()
    bodies = [_weights(kinds, dict(zip(uncertain, point, strict=True))) for point in points]
    return {name: math.fsum(one) / BODIES for name, one in zip(kinds, zip(*bodies, strict=True), strict=True)}


def _at(value: Scalar, part: float) -> float:
    return float(value.to_chaos().ppf(part)) if isinstance(value, Uncertain) else value


def finest(study: Study) -> float:
    """Smallest mean diameter of grains that are simulated [m]."""
    assert study.ground is not None
    if study.ground.finest is not None:
        return study.ground.finest
    return FINEST_IN_LANDERS * 2.0 * lander_checks.main_radius(study.lander)


def finer_share(study: Study) -> float:
    """The share of the ground whose grains are finer than any that are simulated."""
    assert study.ground is not None
    import numpy as np

    least, found, weights = finest(study), 0.0, mean_weights(study)
    for name, kind in study.ground.kind.items():
        size = grain_size(study, kind)
        below = float(size.to_chaos().cdf(np.array(least))) if isinstance(size, Uncertain) else float(size < least)
        # Laws with ends go on in a straight line beyond them.
        below = min(max(below, 0.0), 1.0)
        found += weights[name] * below
    return found


def grain_size(study: Study, kind: GroundKind) -> Scalar:
    """Mean diameter of the grains of a kind [m]."""
    if kind.grain_size is not None:
        return kind.grain_size
    return ROCK_IN_LANDERS * 2.0 * lander_checks.main_radius(study.lander)


def on_ground(study: Study, bed: int) -> Study:
    """The study with the bed and the grains of the ground of one of its beds; as it is without [ground]."""
    return study if study.ground is None else of_ground(study, *_draw(study, bed, 1))


def of_ground(study: Study, ground: BedGround) -> Study:
    assert study.ground is not None
    kind = study.ground.kind[ground.kind]
    own = {} if kind.grain is None else kind.grain.values()
    study = study.model_copy(update={"grain": study.grain.model_copy(update=own)})
    return study.model_copy(update={"bed": _bed(study, kind, ground)})


def typical(study: Study) -> Study:
    """The study with the bed of its likeliest kind of ground, at the median of its sizes."""
    assert study.ground is not None
    kinds, weights = study.ground.kind, mean_weights(study)
    name = max(kinds, key=weights.__getitem__)
    number, kind = list(kinds).index(name), kinds[name]
    size = max(median(grain_size(study, kind)), finest(study))
    friction = None if kind.pour_friction is None else median(kind.pour_friction)
    of_kind = of_ground(study, BedGround(name, number, size, median(kind.size_ratio), friction))
    # Its grains stay those of all kinds: a kind that says nothing of a material has that of [grain].
    return study.model_copy(update={"bed": of_kind.bed})


def _bed(study: Study, kind: GroundKind, ground: BedGround) -> BedSection:
    """The bed that grains ask for: as wide as lander and grains need before the ground repeats, and as deep."""
    smallest = 2.0 * ground.size / (1.0 + ground.ratio)
    sizes: Constant | Between = Constant(distribution="constant", value=ground.size)
    if ground.ratio > 1.0:
        sizes = Between(distribution="uniform", lower=smallest, upper=ground.ratio * smallest)
    update: dict[str, Any] = {"diameter": sizes, "boulders": kind.boulders}
    if ground.pour_friction is not None:
        update["pour_friction"] = ground.pour_friction
    bed = study.bed.model_copy(update=update)
    # The number of boulders, on which the width depends, follows from the width.
    for _ in range(2):
        width = math.ceil(1e3 * narrowest_period(study.model_copy(update={"bed": bed}))) / 1e3
        bed = bed.model_copy(update={"width": (width, width)})
    depth = max(DEPTH_IN_GRAINS * ground.size, DEPTH_IN_LANDERS * 2.0 * lander_checks.main_radius(study.lander))
    # Of sizes that are uniform between two ends.
    mean_cube = ground.size * (smallest**2 + (ground.ratio * smallest) ** 2) / 2.0
    count = math.ceil(SOLID_FRACTION * depth * width**2 / (math.pi / 6.0 * mean_cube))
    return bed.model_copy(update={"grain_count": max(count, 10)})


def laid_out(study: Study, given: Mapping[str, Any]) -> tuple[Study, list[str]]:
    """The study with the bed of its typical ground, and what is wrong with its grounds; given: the table [bed]."""
    if study.ground is None:
        return study, []
    wrong = [*lander_checks.shape_problems("lander", study.lander), *lander_checks.part_problems(study.lander)]
    try:
        wrong = wrong or list(_ground_problems(study, given))
    except (ValueError, OSError) as error:
        # Of a mesh, whose size the beds depend on.
        wrong = [f"lander.file, or that of a part: {error}"]
    return (study, wrong) if wrong else (typical(study), [])


def _ground_problems(study: Study, given: Mapping[str, Any]) -> Iterator[str]:
    """One sentence for each thing that is wrong with [ground]; given: the table [bed] of the file."""
    assert study.ground is not None
    for key in FOLLOWING:
        if key in given:
            yield f"bed.{key} stands beside [ground], whose kinds have grains and beds of their own; leave it out"
    if not study.ground.kind:
        yield "[ground] has no kind; allowed: at least one table [ground.kind.NAME] with its weight and grain_size"
        return
    if study.bed.sides == "walls":
        yield 'bed.sides is "walls"; allowed with [ground] is "periodic", as its beds have no walls; leave it out'
    # Inputs of an expansion and of samples are drawn one by one, and kind and size of a ground belong together.
    if study.expansion is not None:
        yield "[expansion] stands beside [ground]; allowed: one ground, by the sizes of [bed]; leave one of the two out"
    if study.sample_count:
        yield (
            f"monte_carlo.sample_count is {study.sample_count} beside [ground]; allowed: 0, as samples are of one "
            "ground; leave it out"
        )
    yield from _weight_problems(study.ground)
    for name, kind in study.ground.kind.items():
        yield from _kind_problems(study, name, kind)


def _weight_problems(ground: GroundSection) -> Iterator[str]:
    weights = {name: kind.weight for name, kind in ground.kind.items() if not isinstance(kind.weight, Uncertain)}
    if uncertain := _uncertain_weights(ground):
        if len(ground.kind) == 1:
            yield f"ground.kind.{uncertain[0]}.weight is uncertain, and there is no other kind; write 1"
        return
    if ground.unknown == "both":
        yield (
            'ground.unknown is "both" and no ground.kind.NAME.weight is uncertain, so bodies do not differ; give a '
            'weight a distribution, or write ground.unknown = "patchy"'
        )
    total = math.fsum(weights.values())
    if abs(total - 1.0) > ROUNDING:
        told = ", ".join(f"{name} {weight:g}" for name, weight in weights.items())
        yield f"the weights of the kinds of ground add up to {total:.6g} ({told}); allowed: 1; change them"


def _kind_problems(study: Study, name: str, kind: GroundKind) -> Iterator[str]:
    key = f"ground.kind.{name}"
    largest = 2.0 * lander_checks.main_radius(study.lander)
    if kind.grain_size is None and not kind.rock:
        yield f"{key}.grain_size is missing; write the mean diameter of its grains in m, or rock = true"
        return
    if kind.rock and kind.boulders is not None:
        yield f"{key} is rock and has boulders; allowed: one of the two; leave the other out"
    smallest, most = (max(end, finest(study)) for end in usual_reach(grain_size(study, kind)))
    if kind.rock and smallest < largest:
        yield (
            f"{key}.grain_size reaches down to {smallest:g} m and is rock; allowed: blocks of at least {largest:.3g} "
            "m, the largest diameter of the lander; raise it, or write rock = false"
        )
    for size in sorted({smallest, most}):
        ground = BedGround(name, 0, size, usual_reach(kind.size_ratio)[1])
        found = of_ground(study, ground)
        if found.bed.grain_count > MOST_GRAINS:
            yield (
                f"{key}.grain_size reaches to {size:g} m, and a bed of such grains has {found.bed.grain_count}; "
                f"allowed: at most {MOST_GRAINS} grains; raise it, or ground.finest"
            )
            return
        problems = list(material_problems(found)) if study.has_soil else []
        if problems:
            yield from (f"{key}: {text}" for text in problems)
            return
    yield from _material_problems(study, key, kind)


def _material_problems(study: Study, key: str, kind: GroundKind) -> Iterator[str]:
    """A material that is uncertain where that of [grain], whose draws it follows, is one number."""
    for name, value in ({} if kind.grain is None else kind.grain.values()).items():
        if isinstance(value, Uncertain) and not isinstance(getattr(study.grain, name), Uncertain):
            yield (
                f"{key}.grain.{name} is uncertain and grain.{name} is not; allowed: both, as a lander draws one "
                f"quantile for both, or a number in {key}.grain; make grain.{name} uncertain"
            )
