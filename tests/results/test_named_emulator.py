"""The emulator of a study by the names of its inputs: a table with units, and refusals that name names."""

import inspect
from functools import cache

import numpy as np
import pytest

from lithobrake import emulator
from lithobrake.chaos import LogUniform, Uniform
from lithobrake.results import NamedEmulator
from lithobrake.results.table import ExplorerAttitude

from ..pipeline.few_terms import few_terms
from ..quick_studies import quick_studies

UNITS = {"grain.friction": "-", "grain.young_modulus": "Pa", "impact.speed": "m/s"}
BOUND = {
    "height": 0.5, "across": 1.0, "time_limit": 0.0, "smallest": 0.001, "largest": 0.001, "mass_power": 0.0,
    "diameter_power": 2.0,
    "impact.speed": 0.2, "impact.spin_x": 0.0, "impact.spin_y": 0.0, "impact.spin_z": 0.1, "surface.slope_deg": 10.0,
    "surface.gravity": 1e-4, "lander.mass": 1.0, "lander.diameter": 0.1,
}  # fmt: skip
NAMES = (
    "speed_out", "elevation_out", "spin_out", "azimuth_out", "spin_out_x", "spin_out_y", "spin_out_z", "penetration",
)  # fmt: skip


def allowed(speed: np.ndarray) -> np.ndarray:
    """What energy allows a lander that comes with a speed: speed out [m/s], and its spin over that."""
    gained = 2.0 * 1e-4 * (0.5 + np.sin(np.radians(10.0)))
    return np.sqrt(speed**2 + 0.001 * 0.01 + gained)


@cache
def named() -> NamedEmulator:
    """The emulator of 96 landings whose speed follows that of arrival, one in eight captured."""
    rng, count = np.random.default_rng(0), 96
    x = np.column_stack([rng.uniform(0.2, 0.9, count), 10.0 ** rng.uniform(6, 8, count), rng.uniform(0.1, 0.3, count)])
    speed = x[:, 2] * (0.2 + 0.5 * x[:, 0] + 0.2 * rng.random(count))
    angle, spin = rng.uniform(0.3, 1.2, count), rng.uniform(0.1, 1.0, count)
    axis = rng.standard_normal((count, 3))
    y = np.column_stack([speed, angle, spin, rng.uniform(-3, 3, count), axis, rng.random(count)])
    y[::8] = np.nan
    upper = np.full(y.shape, np.inf)
    upper[:, 0], upper[:, 1] = allowed(x[:, 2]), 0.5 * np.pi
    upper[:, 2] = upper[:, 0] / np.sqrt(0.001)
    inputs = {"grain.friction": Uniform(0.2, 0.9), "grain.young_modulus": LogUniform(1e6, 1e8)}
    with quick_studies(), few_terms():
        model = emulator.fit(
            inputs | {"impact.speed": Uniform(0.1, 0.3)}, x, y, groups=np.arange(count) // 8,
            outcome=np.where(np.isnan(y[:, 0]), "captured", "clear"), lower=[0.0, 0.0, 0.0, *[-np.inf] * 5],
            upper=upper, riders=NAMES[3:], output_names=NAMES,
        )  # fmt: skip
    return NamedEmulator(model, UNITS, lambda: BOUND)


SOIL = {"grain.friction": 0.5, "grain.young_modulus": 1e7, "impact.speed": 0.2}


def test_samples_are_a_table_with_units() -> None:
    table = named().sample(SOIL, 40, seed=3)
    assert (table.row, table.row_count) == ("sample", 40)
    units = {name: column.units for name, column in table.columns.items()}
    assert (units["grain.young_modulus"], units["grain.friction"]) == ("Pa", "")
    assert (units["speed_out"], units["spin_out"]) == ("m/s", "rad/s")
    assert set(table["outcome"]) == {"clear", "captured"}
    assert np.isnan(table["speed_out"]).tolist() == (table["outcome"] == "captured").tolist()
    np.testing.assert_array_equal(named()(SOIL, 40, seed=3)["speed_out"], table["speed_out"])
    assert table.to_pandas().attrs["speed_out"]["units"] == "m/s"


def test_velocity_and_spin_follow_from_what_was_drawn() -> None:
    table = named().sample(SOIL, 300)
    left = table["outcome"] == "clear"
    velocity = np.column_stack([table[f"velocity_out_{axis}"] for axis in "xyz"])[left]
    assert np.linalg.norm(velocity, axis=1) == pytest.approx(table["speed_out"][left], rel=1e-12)
    assert np.arctan2(velocity[:, 1], velocity[:, 0]) == pytest.approx(table["azimuth_out"][left], rel=1e-12)
    spin = np.column_stack([table[f"spin_out_{axis}"] for axis in "xyz"])[left]
    assert np.linalg.norm(spin, axis=1) == pytest.approx(table["spin_out"][left], rel=1e-12)


def test_no_sample_leaves_with_more_than_energy_allows_at_its_inputs() -> None:
    speeds = np.array([0.1, 0.2, 0.3])
    table = named().sample(SOIL | {"impact.speed": speeds}, 400)
    assert table["impact.speed"].tolist() == np.repeat(speeds, 400).tolist()
    energy = table["speed_out"] ** 2 + 0.001 * table["spin_out"] ** 2
    assert np.nanmax(energy / allowed(table["impact.speed"]) ** 2) <= 1.0 + 1e-12
    drawn = named().model.sample(
        [[0.5, 1e7, one] for one in speeds], 400, lower=named().model.runs.lower[0],
        upper=[[s, np.pi / 2, s / np.sqrt(0.001), *[np.inf] * 5] for s in allowed(speeds)],
    )  # fmt: skip
    np.testing.assert_allclose(table["speed_out"], drawn[:, :, 0].ravel(), rtol=1e-12)


@pytest.mark.parametrize(("inputs", "words"), [
    ({"grain.friction": 0.5}, r"inputs lack grain.young_modulus \[Pa\], impact.speed \[m/s\]; give all of: grain.f"),
    (SOIL | {"grain.fricton": 0.5}, r"'grain.fricton' is no input .*; did you mean grain.friction\?"),
    (SOIL | {"grain.friction": 2.0}, r"grain.friction is 2, but its support is \[0.2, 0.9\]"),
    (SOIL | {"grain.friction": "much"}, "grain.friction must be an array of real numbers"),
    (SOIL | {"grain.friction": float("nan")}, "grain.friction is nan"),
    (SOIL | {"grain.friction": [0.3, 0.4], "impact.speed": [0.1, 0.2, 0.3]}, "arrays of one length"),
    (SOIL | {"grain.friction": []}, "inputs have no point: an array is empty; give all of: grain.friction"),
    ([[0.5, 1e7, 0.2]], "must be a dict by name; give all of: grain.friction, grain.young_modulus"),
])  # fmt: skip
def test_inputs_that_do_not_fit_are_refused_by_name(inputs: object, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        named().sample(inputs, 5)  # type: ignore[arg-type]


def test_terms_of_the_attitude_that_are_left_out_are_those_of_random_attitudes() -> None:
    rng, names = np.random.default_rng(1), ("attitude.upright_z", "attitude.lean_z", "attitude.along_z")
    x = np.column_stack([rng.uniform(0.2, 0.9, 60), rng.random(60), *rng.uniform(-1.0, 1.0, (2, 60))])
    terms = {name: Uniform(0.0 if "upright" in name else -1.0, 1.0) for name in names}
    y = x[:, :1] + rng.random((60, 1))
    model = emulator.fit(
        {"grain.friction": Uniform(0.2, 0.9), **terms}, x, y, groups=np.arange(60) // 6, output_names=["penetration"]
    )
    law = ExplorerAttitude(names, [[0.0, 0.0, 1.0]], has_sides=False, is_cube=False, sides={})
    known = NamedEmulator(model, UNITS, attitude=law)
    table = known.sample({"grain.friction": [0.3, 0.5]}, 4000, seed=2)
    assert table["grain.friction"].tolist() == [0.3] * 4000 + [0.5] * 4000
    # Over all rotations: an axis is upright by a third in the mean, and leans neither way.
    upright, lean, along = (table[name] for name in names)
    assert np.mean(upright) == pytest.approx(1.0 / 3.0, abs=0.01)
    assert np.mean(upright**2) == pytest.approx(1.0 / 5.0, abs=0.01)
    assert (np.mean(lean), np.mean(along)) == pytest.approx((0.0, 0.0), abs=0.02)
    given = {"grain.friction": 0.3, **dict.fromkeys(names, 0.0)}
    assert known.sample(given, 3)[names[0]].tolist() == [0.0] * 3
    with pytest.raises(ValueError, match=r"inputs lack attitude\.along_z; give all of"):
        known.sample({name: value for name, value in given.items() if name != names[2]}, 3)
    with pytest.raises(ValueError, match="seed is 'x'"):
        known.sample({"grain.friction": 0.3}, 3, seed="x")  # type: ignore[arg-type]


def test_counts_and_seeds_are_checked() -> None:
    for change, words in (({"count": 0}, "count is 0"), ({"count": 5, "seed": "x"}, "seed is 'x'")):
        with pytest.raises(ValueError, match=words):
            named().sample(SOIL, **change)  # type: ignore[arg-type]


def test_it_shows_itself_on_one_screen() -> None:
    assert named().inputs == {"grain.friction": "", "grain.young_modulus": "Pa", "impact.speed": "m/s"}
    said = " ".join(repr(named()).split())
    assert "grain.young_modulus [Pa]" in said
    assert named().model.statement_on("beds") in said
    assert max(map(len, repr(named()).split("\n"))) < 80
    assert max(len(repr(one)) for one in (named(), named().model)) < 800
    assert "array(" not in repr(named().model)
    shown = named()._repr_html_()
    assert "<td>grain.young_modulus</td><td>Pa</td>" in shown
    assert len(str(inspect.signature(NamedEmulator.sample))) < 120
