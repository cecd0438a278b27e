"""Hinges of parts in the study file."""

import math
from copy import deepcopy
from pathlib import Path
from typing import Any

import pytest

from lithobrake.study import Study, StudyError, check_tables
from lithobrake.study.quantity import median
from lithobrake.touchdown import HingedPart
from lithobrake.touchdown.lander_model import lander

from ..paper_tables import paper_tables

HINGE = {"point": [0.05, 0.0, 0.0], "frequency": 5.0, "damping_ratio": 0.02, "limit_deg": 30.0}
PANEL = {"shape": "box", "edges": [0.06, 0.05, 0.005], "centre": [0.08, 0.0, 0.0], "mass": 0.05}


def study(hinge: dict[str, Any], **tables: Any) -> Study:
    """The template with a panel on a hinge; None takes a key of the hinge away."""
    found = deepcopy(paper_tables())
    found["contact"] = {**found.get("contact", {}), "stepping": "local"}
    for name, values in tables.items():
        found[name] = {**found.get(name, {}), **values}
    given = {key: value for key, value in {**HINGE, **hinge}.items() if value is not None}
    found["lander"]["part"] = {"panel": {**PANEL, "hinge": given}}
    return check_tables(found, Path())


def test_a_hinge_of_a_frequency_has_the_stiffness_that_swings_the_part() -> None:
    made = study({})
    values = {name: median(value) for name, value in made.touchdown_values().items()}
    panel = lander(made, values).parts[0]
    assert isinstance(panel, HingedPart)
    assert panel.hinge.damping_ratio == 0.02
    # Largest moment of the plate, about the axis across it at its edge.
    inertia = 0.05 * (0.06**2 + 0.05**2) / 12.0 + 0.05 * 0.03**2
    assert panel.hinge.stiffness == pytest.approx((2.0 * math.pi * 5.0) ** 2 * inertia, rel=1e-6)
    assert panel.hinge.limit == pytest.approx(math.radians(30.0))


@pytest.mark.parametrize(("hinge", "tables", "said"), [
    ({"frequency": None}, {}, "lander.part.panel.hinge takes frequency or stiffness, and neither is given"),
    ({"stiffness": 1.0}, {}, "lander.part.panel.hinge takes frequency or stiffness, and both are given"),
    ({"frequency": 0.0}, {}, "lander.part.panel.hinge.frequency is 0; allowed: above 0 [Hz]"),
    ({"damping_ratio": None}, {}, "lander.part.panel.hinge.damping_ratio is missing"),
    ({"damping_ratio": 2.0}, {}, "lander.part.panel.hinge.damping_ratio is 2; allowed: at least 0 and at most 1"),
    ({"limit_deg": 120.0}, {}, "lander.part.panel.hinge.limit_deg is 120; allowed: above 0 and at most 90 [deg]"),
    ({"point": [0.05, 0.0]}, {}, "lander.part.panel.hinge.point is [0.05, 0]"),
    ({"point": [50.0, 0.0, 0.0]}, {}, "m from the origin of the lander; allowed: at most"),
    ({}, {"contact": {"stepping": "global"}}, 'contact.stepping is "global" with lander.part.panel.hinge; allowed'),
    ({}, {"lander": {"inertia": [0.0001, 0.0001, 0.0001]}}, "lander.inertia is [0.0001, 0.0001, 0.0001] kg m2 with"),
])  # fmt: skip
def test_what_is_no_hinge_is_refused_in_one_sentence(hinge: dict[str, Any], tables: dict[str, Any], said: str) -> None:
    with pytest.raises(StudyError) as refused:
        study(hinge, **tables)
    assert any(said in one for one in refused.value.problems), refused.value.problems
