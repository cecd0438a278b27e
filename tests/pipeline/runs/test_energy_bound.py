"""The fastest that a lander can leave, against energies worked out by hand."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lithobrake.campaign import Record
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.runs.energy_bound import energy_bound, energy_warning
from lithobrake.study import Study, check_tables
from lithobrake.study.touchdown_model import medians

from ..synthetic_lander import synthetic_tables

NO_BED = 0.0


def fastest(given: Study, *others: Any) -> np.ndarray:
    """The bound of the speed."""
    return energy_bound(DrawnDesign(given), *others).speed


def study(**changes: dict[str, Any]) -> Study:
    """A study whose touchdowns a function makes, so that no bed has a height."""
    return check_tables(synthetic_tables(**changes), Path()).with_function("of a test")


def test_a_lander_keeps_at_most_speed_and_spin() -> None:
    # A homogeneous ball of 0.1 m: I / m = 0.4 r^2 = 1e-3 m2.
    assert fastest(study(), NO_BED, {}, 2) == pytest.approx([0.4, 0.4])
    spinning = {"impact.spin_x": np.array([3.0, 0.0]), "impact.spin_z": np.array([4.0, 0.0])}
    assert fastest(study(), NO_BED, spinning, 2) == pytest.approx([np.sqrt(0.16 + 25e-3), 0.4])
    known = study(lander={"inertia": [1e-3, 2e-3, 2e-3], "mass": 2.0})
    assert fastest(known, NO_BED, spinning, 2) == pytest.approx([np.sqrt(0.16 + 25e-3), 0.4])
    box = study(lander={"shape": "box", "edges": [0.1, 0.1, 0.2], "diameter": None})
    assert fastest(box, NO_BED, spinning, 2)[0] == pytest.approx(np.sqrt(0.16 + 25 * (0.1**2 + 0.2**2) / 12))


def test_the_bound_follows_an_uncertain_speed_and_the_fall_down_a_slope() -> None:
    speed = {"impact.speed": np.array([0.1, 0.2])}
    assert fastest(study(), NO_BED, speed, 2) == pytest.approx([0.1, 0.2])
    tilted = study(surface={"slope_deg": 30.0, "gravity": 1e-2}, bed={"width": [0.6, 0.8], "sides": "walls"})
    # One metre of diagonal falls by half a metre.
    assert fastest(tilted, NO_BED, speed, 2) == pytest.approx(np.sqrt([0.01 + 0.01, 0.04 + 0.01]))
    repeating = study(surface={"slope_deg": 30.0, "gravity": 1e-2}, landing={"time_limit": 2.0})
    # Within 2 s by 0.21 and 0.41 m along the slope, of which half is its fall, where no wall stops it.
    assert fastest(repeating, NO_BED, speed, 2) == pytest.approx(np.sqrt([0.01 + 0.0021, 0.04 + 0.0041]))


def test_what_the_speed_takes_is_not_left_for_the_spin() -> None:
    # A ball of 0.1 m has a radius of gyration of 0.1 sqrt(0.1) m, and a box spins fastest about its long axis.
    ball = energy_bound(DrawnDesign(study()), NO_BED, {}, 3)
    assert ball.spin() == pytest.approx(np.full(3, 0.4 / np.sqrt(1e-3)))
    assert ball.spin(np.array([0.0, 0.24, 0.4])) == pytest.approx(np.array([0.4, 0.32, 0.0]) / np.sqrt(1e-3))
    box = energy_bound(
        DrawnDesign(study(lander={"shape": "box", "edges": [0.1, 0.1, 0.2], "diameter": None})), NO_BED, {}, 1
    )
    assert box.spin()[0] == pytest.approx(0.4 / np.sqrt((0.1**2 + 0.1**2) / 12))
    known = energy_bound(DrawnDesign(study(lander={"inertia": [1e-3, 2e-3, 2e-3], "mass": 2.0})), NO_BED, {}, 1)
    assert known.spin()[0] == pytest.approx(0.4 / np.sqrt(0.5e-3))


def landed(speed_out: float, spin_out: float, speed: float = 0.2, outcome: str = "clear") -> Record:
    """A run of a ball of 0.1 m, whose radius of gyration squared is 1e-3 m2."""
    inputs = medians(study()) | {"impact.speed": speed}
    unknown = dict.fromkeys(Record.__dataclass_fields__)
    outputs = {"speed_out": speed_out, "spin_out": spin_out}
    return Record(**{**unknown, "outcome": outcome, "inputs": inputs, "outputs": outputs})


@pytest.mark.parametrize(
    ("records", "said"),
    [
        ([], None),
        ([landed(0.19, 0.0), landed(0.2, 0.0), landed(0.0, 6.3)], None),
        ([landed(50.0, 0.0, outcome="captured")], None),
        ([landed(0.19, 0.0), landed(50.0, 0.0)],
         "1 of 2 landers that left have more energy than impact and gravity provide, at most 6.25e+04 times as"),
        ([landed(0.15, 6.0)], "1 of 1 landers that left have more energy"),
    ],
)  # fmt: skip
def test_landers_that_gain_energy_are_told(records: list[Record], said: str | None) -> None:
    found = energy_warning(DrawnDesign(study(impact={"speed": 0.2})), records, NO_BED)
    assert found is None if said is None else found is not None and found.startswith(said)
