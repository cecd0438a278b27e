"""A lander of several parts in a study: what it is in the engine, and how everything else is refused."""

from copy import deepcopy
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lithobrake.pipeline.design.dependencies import touchdown_dependencies
from lithobrake.study import Study, StudyError, check_tables
from lithobrake.study.fixed import fixed_study
from lithobrake.study.lander_solids import lander_radius
from lithobrake.study.touchdown_model import lander, medians

from ..paper_tables import paper_tables

BOOM = {"shape": "box", "edges": [1.5, 0.01, 0.02], "centre": [0.93, 0.0, 0.01], "mass": 0.05}
# A quarter turn about z.
ASIDE = {**BOOM, "centre": [0.0, 0.86, 0.0], "orientation": [1.0, 0.0, 0.0, 1.0]}
FOOT = {"shape": "sphere", "diameter": 0.06, "centre": [-0.15, 0.1, -0.1], "density": 1000.0, "restitution": 0.1}


def tables(**changes: Any) -> dict[str, Any]:
    found = deepcopy(paper_tables())
    found["bed"]["width"] = [6.0, 6.0]
    box = {"shape": "box", "edges": [0.366, 0.226, 0.1], "mass": 12.0, "part": {"boom": BOOM, "aside": ASIDE}}
    found["lander"] = {**box, **changes}
    return found


def study(**changes: Any) -> Study:
    return check_tables(tables(**changes), Path())


def test_reach_and_masses_are_those_of_the_engine() -> None:
    one = study(part={"boom": BOOM, "aside": ASIDE, "foot": FOOT})
    body = lander(one, medians(one))
    # Edges and corners of hulls are rounded, by a fiftieth of their least width at most.
    assert lander_radius(one.lander) == pytest.approx(body.reach, rel=1e-3)
    assert body.own_mass == pytest.approx(12.0 - 0.1 - 1000.0 * np.pi / 6.0 * 0.06**3)
    assert [part.shape.volume for part in body.parts[:2]] == pytest.approx([3e-4, 3e-4])
    np.testing.assert_allclose(np.ptp(body.parts[1].shape.vertices, axis=0), [0.01, 1.5, 0.02], atol=1e-12)
    assert body.parts[2].material.restitution == 0.1
    assert body.parts[0].material.restitution == body.material.restitution


def test_centre_of_mass_and_inertia_are_the_sums_over_point_like_parts() -> None:
    """Two heavy balls far out: m d^2 about each axis across, by hand."""
    ball = {"shape": "sphere", "diameter": 0.01, "mass": 1.0}
    ends = {"one": {**ball, "centre": [1.0, 0.0, 0.0]}, "two": {**ball, "centre": [0.0, 1.0, 0.0]}}
    one = study(part=ends, mass=2.0 + 1e-6)
    body = lander(one, medians(one)).body
    np.testing.assert_allclose(body.centre_of_mass, [0.5, 0.5, 0.0], atol=1e-6)
    np.testing.assert_allclose(body.inertia, [[0.5, 0.5, 0], [0.5, 0.5, 0], [0, 0, 1.0]], atol=1e-4)


def test_what_is_given_stands_in_the_axes_of_the_lander() -> None:
    one = study(centre_of_mass={"x": 0.01, "z": -0.02}, inertia=[0.2, 0.3, 0.4, 0.05, 0.0, -0.02])
    body = lander(one, medians(one)).body
    np.testing.assert_allclose(body.centre_of_mass, [0.01, 0.0, -0.02])
    np.testing.assert_allclose(body.inertia, [[0.2, 0.05, 0.0], [0.05, 0.3, -0.02], [0.0, -0.02, 0.4]])


def test_uncertain_properties_of_parts_are_inputs_by_their_keys() -> None:
    law = {"distribution": "uniform", "lower": 0.1, "upper": 0.3}
    one = study(part={"foot": {**FOOT, "restitution": law}}, centre_of_mass={"y": {**law, "lower": -0.1}})
    values = medians(one)
    assert values["lander.part.foot.restitution"] == pytest.approx(0.2)
    values |= {"lander.part.foot.restitution": 0.15, "lander.centre_of_mass.y": 0.05}
    made = lander(one, values)
    assert made.parts[0].material.restitution == 0.15
    assert made.body.centre_of_mass[1] == 0.05


def test_numbers_of_a_run_stand_in_the_tables_of_parts() -> None:
    one = study(part={"foot": FOOT}, centre_of_mass={"y": 0.0})
    given = {"lander.part.foot.restitution": 0.4, "lander.centre_of_mass.y": 0.03}
    orientation = {f"impact.orientation.{part}": float(part == "w") for part in "wxyz"}
    fixed = fixed_study(one, {**medians(one), **orientation, **given})
    assert fixed.lander.part["foot"].restitution == 0.4
    assert fixed.lander.centre_of_mass.y == 0.03
    for key in ("lander.part.foot", "lander.part.hand.restitution", "lander.part.foot.speed"):
        with pytest.raises(StudyError, match=key):
            fixed_study(one, {**medians(one), **orientation, key: 0.4})


def test_a_landing_depends_on_the_parts_and_on_nothing_more_without_any() -> None:
    assert "parts" not in touchdown_dependencies(study(part={}))
    one, other = (touchdown_dependencies(study(part={"boom": {**BOOM, "mass": mass}})) for mass in (0.05, 0.06))
    assert one != other


@pytest.mark.parametrize(("changes", "words"), [
    ({"part": {"a b": BOOM}}, ["lander.part.a b is no name"]),
    ({"part": {"a": {**BOOM, "diameter": 0.1}}}, ["lander.part.a.diameter does not go with this shape"]),
    ({"part": {"a": {**BOOM, "mass": None}}}, ["lander.part.a takes mass or density", "neither"]),
    ({"part": {"a": {**BOOM, "density": 2.0}}}, ["lander.part.a takes mass or density", "both"]),
    ({"part": {"a": {**BOOM, "mass": 12.5}}}, ["lander.part has 12.5 kg", "raise it"]),
    ({"part": {"a": {**BOOM, "edges": [1.5, 1e-3, 0.1]}}}, ["lander.part.a.edges", "thicken the box"]),
    ({"part": {"a": {**BOOM, "orientation": [0, 0, 0, 0]}}}, ["lander.part.a.orientation", "[1, 0, 0, 0]"]),
    ({"part": {"a": {**BOOM, "resitution": 0.2}}}, ["lander.part.a.resitution", "did you mean restitution?"]),
    ({"part": {"a": {**BOOM, "shape": "hull"}}}, ["lander.part.a.file is missing"]),
    ({"part": {"a": {**BOOM, "unit": "mm"}}}, ["lander.part.a.unit"]),
    ({"part": {"a": {**BOOM, "centre": [9.0, 0.0, 0.0]}}}, ["bed.width", "with its parts, reaches"]),
    ({"inertia": [0.1, 0.1, 0.3]}, ["lander.inertia", "as every body has it"]),
    ({"inertia": [1.0, 1.0, 1.0, 0.9, 0.9, -0.9]}, ["lander.inertia", "as every body has it"]),
    ({"inertia": [0.5, 0.5, 1.0, 0.5, 0.0, 0.0]}, ["lander.inertia", "as every body has it"]),
    ({"inertia": [1.0, 1.0, -1.0]}, ["lander.inertia", "moments above 0"]),
    ({"inertia": [1.0, 1.0, 1.0, 0.0]}, ["lander.inertia", "3 or 6 numbers"]),
])  # fmt: skip
def test_parts_that_make_no_lander_are_refused(changes: dict[str, Any], words: list[str]) -> None:
    found = tables(**changes)
    for part in found["lander"].get("part", {}).values():
        for key in [key for key, value in part.items() if value is None]:
            del part[key]
    with pytest.raises(StudyError) as refusal:
        check_tables(found, Path())
    assert len(refusal.value.problems) <= 2
    assert all(word in str(refusal.value) for word in words)


def test_an_uncertain_diameter_does_not_go_with_parts() -> None:
    ball = {"shape": "sphere", "diameter": {"distribution": "uniform", "lower": 0.1, "upper": 0.2}, "mass": 1.0}
    found = tables()
    found["lander"] = {**ball, "part": {"boom": BOOM}}
    with pytest.raises(StudyError, match=r"lander\.diameter is uncertain"):
        check_tables(found, Path())
