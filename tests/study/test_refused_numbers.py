"""Numbers that are finite and absurd, and files without end: refused when the study is read, by what they would do."""

import os
from pathlib import Path
from typing import Any

import pytest

from lithobrake.study import checks

from .test_study import problems, table

REGION = {"latitude_deg": [0.0, 90.0], "grain": {"friction": 0.4}}
PART = {"shape": "box", "edges": [0.1, 0.1, 0.1], "mass": 0.1, "centre": [0.0, 0.0, 0.1]}
ORBIT = {"eccentricity": 0.0, "inclination_deg": 0.0, "node_deg": 0.0, "perihelion_deg": 0.0, "mean_anomaly_deg": 0.0,
         "epoch": "2026-06-09T00:00:00"}  # fmt: skip
MANY = [1.0 + 1e-3 * number for number in range(1500)]


@pytest.mark.parametrize(("changes", "words"), [
    ({"impact.spin_x": 1e9}, ["rad/s, at which the tip of the lander moves at", "allowed: at most 1000 m/s"]),
    # Each of them may pass by itself.
    ({"impact.spin_z": table("normal", mean=0.0, std=1e6)}, ["impact.spin_x, impact.spin_y and impact.spin_z reach"]),
    ({"impact.spin_y": 500.0}, ["grain.young_modulus down to", "m deep", "lower the spin"]),
    ({"impact.spin_y": 500.0, "soil.soft": {**REGION, "grain": {"young_modulus": 10.0}}}, ["lower the spin"]),
    ({"grain.surface_energy": 1e6}, ["two grains pull each other", "surface_energy is in J/m2"]),
    ({"soil.a": {**REGION, "grain": {"surface_energy": 1e6}}}, ["soil.a: grain.surface_energy reaches 1e+06 J/m2"]),
    ({"soil.a": {**REGION, "grain": {"young_modulus": 1e15}}}, ["soil.a: grain.young_modulus reaches 1e+15 Pa"]),
    ({"grain.young_modulus": table("log_uniform", lower=2e5, upper=1e40)}, ["grain.young_modulus reaches 1e+40 Pa"]),
    ({"grain.young_modulus": 1e14}, ["grain.young_modulus reaches 1e+14 Pa; allowed: at most 1e+13 Pa"]),
    ({"bed.width": [20.0, 20.0]}, ["20 x 20 m, of which 150 grains cover 0.19 %; allowed: at most 75.4 m2"]),
    ({"campaign": {"wall_limit": 1e-9}}, ["campaign.wall_limit is 1e-09; allowed: at least 0.1 [s]"]),
    ({"campaign": {"memory_limit": 4.0}}, ["campaign.memory_limit is 4; allowed: at least 1e+06 [bytes]"]),
    ({"journey.duration": 1e12}, ["journey.duration is 1e+12; allowed: above 0 and at most 1e+11 [s]"]),
    ({"flight": {"duration": 1e12}}, ["flight.duration is 1e+12; allowed: above 0 and at most 1e+11 [s]"]),
    ({"landing.time_limit": 1e12}, ["landing.time_limit is 1e+12; allowed: above 0 and at most 1e+11 [s]"]),
    ({"sky": {"orbit": {**ORBIT, "semi_major_axis_au": 2.4e11}}}, ["allowed: at least 0.01 and at most 100000"]),
    ({"bed.pour_gravity": 1e45}, ["bed.pour_gravity is 1e+45; allowed: above 0 and at most 1000 [m/s2]"]),
    ({"journey": {"hop_height": 1e9}}, ["journey.hop_height is 1e+09; allowed: at least 0 and at most 1000 [m]"]),
    ({"expansion": None, "design": {"run_count": 40, "side_runs": True, "twin_shift": 3.0}},
     ["design.twin_shift is 3 m; allowed: at most 0.08 m, the smallest grain"]),
    ({"expansion": {"kept_outputs": ["speed_out", "speed_out"]}}, ["kept_outputs", "each once"]),
    ({"aim.within": ["distance_p95 < 1e999"], "aim.grid": {"delivery.speed": [0.1, 0.2]}}, ["with a finite number"]),
    ({"soil": {"a\nb": {"latitude_deg": [0.0, 1.0], "grain": {"friction": 0.4}}}}, ["soil.a\\nb is no name"]),
    ({"bed": {"wi\x1bdth": 1.0}}, ["bed.wi\\x1bdth is not a known key"]),
    ({"grain.density": 2e306}, ["2e+306", "1e-50 to 1e+50 in size"]),
    ({"bed.width": [1e-323, 1e-323]}, ["bed.width is [", "1e-50 to 1e+50 in size"]),
    ({"bed.diameter": table("constant", value=5e-324)}, ["bed.diameter.value is", "1e-50 to 1e+50 in size"]),
    ({"grain.restitution": table("beta", alpha=1e-200, beta=1.0, lower=0.3, upper=0.9)}, ["1e-50 to 1e+50 in size"]),
    ({"site.extents": [1e99, 1e99, 1e99]}, ["site.extents is [1e+99", "1e-50 to 1e+50 in size"]),
    ({"lander.inertia": [1e-200, 1e-200, 1e-200]}, ["lander.inertia is", "1e-50 to 1e+50 in size"]),
    ({"lander.part": {"boom": {**PART, "orientation": [1e-40, 0, 0, 0]}}}, ["length 1e-40", "0.001 to 1000"]),
    ({"aim.grid": {f"delivery.{key}": MANY for key in ("speed", "incidence_deg", "spin_x")}}, ["3375000000 aims"]),
    ({"site.body": "dimorphos", "site.rotation": {"days": 1000.0, "spin": [2e-3, 2e-3, 2e-3]}},
     ["2.99e+05 rad", "site.rotation.days = 66.8", "lower the days or the spin"]),
])  # fmt: skip
def test_absurd_numbers_are_refused_by_what_they_do(changes: dict[str, Any], words: list[str]) -> None:
    said = " ".join(problems(changes))
    assert [word for word in words if word not in said] == []


def test_a_key_of_the_delivery_is_refused_once() -> None:
    delivery = {"speed": -1.0, "east_error": {"distribution": "normal", "mean": 0.0, "std": -1.0}}
    said = problems({"delivery": delivery, "impact.speed": None, "impact.incidence_deg": 95.0})
    keys = [one.partition(" is ")[0].split()[-1] for one in said]
    assert keys == ["delivery.east_error", "delivery.speed", "impact.incidence_deg"]


@pytest.mark.parametrize(("sizes", "said"), [
    (table("power_law", exponent=2.0, lower=0.05, upper=0.1, value=0.1),
     "value is not a known key; allowed: distribution, exponent, cumulative_exponent, lower, upper"),
    (table("constant", value=-1.0), "value is -1; allowed: above 0 [m]"),
    (table("constant"), "value is missing"),
])  # fmt: skip
def test_keys_of_sizes_are_those_of_their_distribution(sizes: dict[str, Any], said: str) -> None:
    boulders = {"diameter": sizes, "coverage": 0.1}
    assert f"study.toml: bed.diameter.{said}" in problems({"bed.diameter": sizes})[0]
    assert f"study.toml: bed.boulders.diameter.{said}" in problems({"bed.boulders": boulders})[0]


def test_a_spin_that_the_contact_carries_is_no_problem() -> None:
    assert problems({"impact.spin_x": table("uniform", lower=-0.1, upper=0.1)}) == []


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no pipes")
@pytest.mark.parametrize("changes", [
    {"soil.ponds": {"facets": "pipe", "grain": {"friction": 0.4}}},
    {"delivery": {"states": "pipe", "frame": "body_fixed", "latitude_deg": 0.0, "longitude_deg": 0.0}, "impact": {}},
])  # fmt: skip
def test_a_pipe_is_not_waited_for(changes: dict[str, Any], tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    assert "it is no regular file" in " ".join(problems(changes, tmp_path))


def test_what_samples_and_answers_need_is_missed_before_a_run(monkeypatch: pytest.MonkeyPatch) -> None:
    assert "at least 8" in " ".join(
        problems({"expansion": None, "design.run_count": 4, "monte_carlo.sample_count": 100})
    )
    assert problems({"expansion": None, "design.run_count": 8, "monte_carlo.sample_count": 100}) == []
    monkeypatch.setattr(checks, "find_spec", lambda name: None)
    said = problems({"solver": {"command": "python3 x.py", "answer": "a.yaml"}})
    assert any('PyYAML is not installed: pip install "lithobrake[yaml]"' in one for one in said)


def test_keys_are_named_as_the_file_has_them() -> None:
    keys = {"impact.speed": None, "design.run_count": None, "delivery.speed": 900.0, "journey.count": 3}
    said = problems({**keys, "journey.touchdowns": 1, "bed.bed_count": 12})
    assert any(one.startswith("study.toml: delivery.speed reaches 900 m/s") for one in said)
    assert any("bed.bed_count is 12, and journey.count 3" in one for one in said)
