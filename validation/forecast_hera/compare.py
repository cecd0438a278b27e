"""A forecast made again, beside the one before: whether it is the same, and else by how much it differs."""

from collections.abc import Iterator
from typing import Any, NamedTuple

Document = dict[str, Any]


class Number(NamedTuple):
    """A number of a forecast with its interval of 90 %."""

    value: float
    lower: float
    upper: float


def comparison(before: Document, after: Document) -> list[str]:
    """Lines: each hash, then each share, median and region, before and after, and whether it lies within its interval.

    Within: the number after lies in the interval that the forecast before stated. A number of the same landers is the
    same; one of as many other landers lies outside one time in four, as both forecasts scatter.
    """
    lines = [
        f"{name}: {'the same' if one == two else f'{one[:12]} before, {two[:12]} after'}"
        for (name, one), (_, two) in zip(hashes(before), hashes(after), strict=True)
    ]
    old, new = dict(numbers(before)), dict(numbers(after))
    lines += [f"{name}: in one of the forecasts only" for name in old.keys() ^ new.keys()]
    both = [name for name in old if name in new]
    differ = [name for name in both if old[name] != new[name]]
    beyond = [name for name in both if not old[name].lower <= new[name].value <= old[name].upper]
    lines += [in_words(name, old[name], new[name]) for name in both]
    lines.append(
        f"{len(both)} numbers: {len(both) - len(differ)} the same, {len(differ) - len(beyond)} others within the "
        f"interval stated before, {len(beyond)} outside{': ' + '; '.join(beyond) if beyond else ''}"
    )
    return lines


def hashes(document: Document) -> Iterator[tuple[str, str]]:
    """What a forecast was made of and gave, by name."""
    for name, one in document["sha256"].items():
        if isinstance(one, dict):
            yield from ((f"{name}, {key}", value) for key, value in one.items())
        else:
            yield name, one


def numbers(document: Document) -> Iterator[tuple[str, Number]]:
    for lander, grounds in document["landers"].items():
        for ground, of in grounds.items():
            begin = f"{lander}, {ground}"
            for end, one in of["ends"].items():
                yield f"{begin}: share {end}", Number(one["share"], one["lower"], one["upper"])
            for name, one in of["at_rest"].items():
                yield f"{begin}: median {name}", Number(one["q50"], one["median_lower"], one["median_upper"])
            for one in of["regions"]:
                name = f"{begin}: region of {100 * one['share']:.0f} %, m2"
                yield name, Number(one["area_m2"], one["lower"], one["upper"])
            for branch in of["by_branch"]:
                rest = branch["at_rest"]
                name = f"{begin}, {branch['branch']}: share at_rest"
                yield name, Number(rest["share"], rest["lower"], rest["upper"])


def in_words(name: str, old: Number, new: Number) -> str:
    """A line about a number."""
    if old == new:
        return f"{name}: {old.value:.4g}, the same"
    inside = "within" if old.lower <= new.value <= old.upper else "outside"
    return f"{name}: {old.value:.4g} ({old.lower:.4g} to {old.upper:.4g}) before, {new.value:.4g} after: {inside}"
