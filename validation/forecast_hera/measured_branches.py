"""Branches of the forecast with measurements in place of its assumptions."""

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

from branches import AIMS, STUDY, Branch, branches, changed
from descent import release
from measurements import Measurement

from lithobrake.pipeline.site import Site
from lithobrake.study import StudySource

BALLISTIC, SMALL_LIBRATION = "ballistic", "small libration"
DELIVERY = "delivery."
GROUND = "ground"


def measured_branches(lander: str, measurements: Iterable[Measurement]) -> tuple[Branch, ...]:
    """Those of a lander, each with its weight and its changes of the study by what was measured; one may weigh 0."""
    own = [one for one in measurements if one.lander in ("", lander)]
    found = []
    for branch, weight in zip(branches(lander), measured_weights(branches(lander), own), strict=True):
        found.append(replace(branch, weight=weight, changes=measured_changes(branch, own)))
    return tuple(found)


def measured_weights(given: Iterable[Branch], measurements: Iterable[Measurement]) -> list[float]:
    """Weights of branches: each measured attribute has its new shares, the others keep theirs within it.

    A branch without the attribute keeps its weight: rolling aims at no end, and only small libration has two descents.
    """
    old = list(given)
    weights = [one.weight for one in old]
    for measurement in measurements:
        if measurement.weights is None or measurement.quantity == GROUND:
            continue
        names = [_attribute(one, measurement.quantity) for one in old]
        total = sum(weight for weight, name in zip(weights, names, strict=True) if name)
        sums = {
            key: sum(weight for weight, name in zip(weights, names, strict=True) if name == key)
            for key in measurement.weights
        }
        for row, name in enumerate(names):
            if name and sums[name] > 0.0:
                weights[row] *= measurement.weights[name] * total / sums[name]
    return weights


def _attribute(branch: Branch, quantity: str) -> str:
    """Which of the names of a quantity with weights a branch has; "" for none."""
    if quantity == "descent" and branch.rotation != SMALL_LIBRATION:
        return ""
    return str(getattr(branch, quantity))


def measured_changes(branch: Branch, measurements: Iterable[Measurement]) -> STUDY:
    """Keys of the study of a branch that differ from the study file, by dotted key."""
    changes: dict[str, Any] = dict(branch.changes)
    extents = list(branch.tables(1)["site"]["extents"])
    for one in measurements:
        key = one.of.key
        if not key or (key.startswith(DELIVERY) and branch.descent == BALLISTIC):
            continue
        if key.startswith("site.extents."):
            extents[int(key[-1])] = one.value
            changes["site.extents"] = list(extents)
        else:
            changes[key] = one.law if one.of.column else one.of.factor * one.value
    return changes


def simulated_branches(lander: str, measurements: Iterable[Measurement]) -> tuple[Branch, ...]:
    """Those of a lander that weigh something, with ballistic descents to the measured body."""
    measured = [one for one in measured_branches(lander, measurements) if one.weight > 0.0]
    if not any(one.of.key.startswith("site.") for one in measurements):
        return tuple(measured)
    return tuple(to_measured_body(one) if one.descent == BALLISTIC else one for one in measured)


def to_measured_body(branch: Branch) -> Branch:
    """A branch of ballistic descents, released toward the body of its own study as it turns with its orbit."""
    tables = changed(branch.tables(1), {"site.rotation": None})
    body = Site(StudySource.of_tables(tables).study).body
    return replace(branch, changes={**branch.changes, "delivery.release": release(body, AIMS[branch.aim])})
