"""Laws that are fitted to paths and depths of balls in beads: rows made by a law give it back."""

import itertools
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

EXPERIMENTS = Path(__file__).parents[2] / "validation" / "experiments"
BENCHMARKS = Path(__file__).parents[2] / "benchmarks"
GRAVITY = 9.81


@pytest.fixture(autouse=True)
def experiments_on_path(monkeypatch: pytest.MonkeyPatch) -> None:
    """The scripts of the experiments import each other by name, and those of the benchmarks."""
    monkeypatch.setattr(sys, "path", [str(EXPERIMENTS), str(BENCHMARKS), *sys.path])


def path_of(fall: float, length: float, friction: float) -> np.ndarray:
    """Return time, depth and speed until a ball stops, integrated numerically; shape [looks, 3]."""

    def change(_: float, state: np.ndarray) -> list[float]:
        return [state[1], GRAVITY - state[1] ** 2 / length - friction * state[0]]

    def stopped(_: float, state: np.ndarray) -> float:
        return float(state[1])

    stopped.terminal, stopped.direction = True, -1.0  # type: ignore[attr-defined]
    start = [0.0, max((2.0 * GRAVITY * fall) ** 0.5, 1e-9)]
    done = solve_ivp(change, (0.0, 1.0), start, events=stopped, rtol=1e-10, atol=1e-12, max_step=1e-3)
    return np.stack([done.t, *done.y], axis=1)


def rows_of(fall: float, length: float, friction: float) -> list[dict[str, float]]:
    return [
        {"density": 8070.0, "fall": fall, "time": time, "depth": depth, "speed": speed,
         "deceleration": speed**2 / length + friction * depth - GRAVITY}
        for time, depth, speed in path_of(fall, length, friction).tolist()
    ]  # fmt: skip


def test_paths_made_by_a_law_give_it_back() -> None:
    from stopping_law import along_paths, with_intervals

    looks = [row for fall in (0.05, 0.1, 0.2) for row in rows_of(fall, 0.087, 1040.0)]
    assert along_paths(looks) == pytest.approx((0.087, 1040.0))
    length, friction = with_intervals(looks, along_paths)
    assert (length.rows, length.half, friction.half) == (3, pytest.approx(0.0, abs=1e-9), pytest.approx(0.0, abs=1e-6))


def test_equal_depths_give_the_drag_whatever_the_friction_is() -> None:
    """Friction that does not grow with depth, and drops of which the slow ones stop early."""
    from stopping_law import GRAVITY, at_depths

    looks = [row for fall in (0.02, 0.05, 0.1, 0.2) for row in rows_of(fall, 0.087, 1040.0)]
    law, friction = at_depths(looks, first=0.01, step=0.003)
    assert law == pytest.approx((0.087, 1040.0), rel=0.02)
    np.testing.assert_allclose(friction[:, 1], 1040.0 * friction[:, 0], rtol=0.02)
    assert 0.01 < friction[0, 0] < 0.013
    assert friction[-1, 0] < 0.05, "at least three drops move"
    even = [row | {"deceleration": row["speed"] ** 2 / 0.05 + 20.0 - GRAVITY} for row in looks]
    law, friction = at_depths(even, first=0.01, step=0.003)
    assert law.length == pytest.approx(0.05)
    np.testing.assert_allclose(friction[:, 1], 20.0)


def test_the_interval_is_that_of_the_jackknife_over_drops() -> None:
    """Without one of three drops a mean is that of the other two: the jackknife gives the standard error of a mean."""
    from scipy.stats import t as student
    from stopping_law import Law, with_intervals

    values = {0.05: 0.08, 0.1: 0.087, 0.2: 0.103}
    looks = [{"fall": fall} for fall in values]
    length, friction = with_intervals(looks, lambda rows: Law(np.mean([values[row["fall"]] for row in rows]), 1.0))
    error = np.std(list(values.values()), ddof=1) / 3**0.5
    assert length.value == pytest.approx(0.09)
    assert length.half == pytest.approx(student.ppf(0.975, 2) * error)
    assert friction.half == 0.0


def test_the_coefficients_of_equal_depths_have_intervals() -> None:
    from functools import partial

    from stopping_law import at_depths, with_intervals

    looks = [row for fall in (0.02, 0.05, 0.1, 0.2) for row in rows_of(fall, 0.087, 1040.0)]
    length, friction = with_intervals(looks, lambda rows: partial(at_depths, first=0.01, step=0.003)(rows)[0])
    assert length.value == pytest.approx(0.087, rel=0.02)
    assert friction.value == pytest.approx(1040.0, rel=0.02)
    assert length.half < 0.1 * length.value
    assert friction.half < 0.1 * friction.value


@pytest.mark.parametrize("fall", [0.02, 0.2])
def test_the_time_of_a_law_is_when_its_integration_is_slow(fall: float) -> None:
    from stopping_law import Law, law_time

    path = path_of(fall, 0.087, 1040.0)
    still = 0.02 * (2.0 * GRAVITY * fall) ** 0.5
    slow = np.argmax(path[:, 2] < still)
    at = np.interp(-still, -path[slow - 1 : slow + 1, 2], path[slow - 1 : slow + 1, 0])
    assert law_time(fall, Law(0.087, 1040.0), 0.02) == pytest.approx(at, rel=1e-3)


@pytest.mark.parametrize("fall", [0.0, 0.02, 0.2, 0.8])
def test_the_depth_of_a_law_is_where_its_integration_stops(fall: float) -> None:
    from stopping_law import Law, law_depth, squared_speed

    law = Law(0.087, 1040.0)
    path = path_of(fall, *law)
    assert law_depth(fall, law) == pytest.approx(path[-1, 1], rel=1e-6)
    np.testing.assert_allclose(squared_speed(path[:, 1], fall, law), path[:, 2] ** 2, atol=1e-6)


def test_the_prefactor_of_a_law_counts_the_drop_distance_down_to_its_depth() -> None:
    """By hand: steel in beads of 1520 kg/m3, 4 cm deep from 10 cm."""
    from stopping_part import law_prefactor

    row = {"density": 8070.0, "diameter": 0.0254, "fall": 0.1, "deepest": 1.0, "bulk_density": 1.0}
    by_hand = 0.04 / ((8070.0 / 1520.0) ** 0.5 * 0.0254 ** (2 / 3) * 0.14 ** (1 / 3))
    assert law_prefactor(row, 0.04) == pytest.approx(by_hand)


def test_a_ball_has_stopped_when_it_is_slower_than_a_part_of_its_impact_speed(monkeypatch: pytest.MonkeyPatch) -> None:
    import stopping_part

    rows = [{"fall": fall, "impact_speed": (2.0 * GRAVITY * fall) ** 0.5} for fall in (0.02, 0.2)]
    monkeypatch.setattr(stopping_part, "steel", lambda bed: rows)
    looks = [row for fall in (0.02, 0.2) for row in rows_of(fall, 0.087, 1040.0)]
    monkeypatch.setattr(stopping_part, "looks", lambda density, bed: looks)
    slow, fast = stopping_part.stopping_times("3 mm")
    assert fast < slow, "as by the measured law"
    for time, fall in ((slow, 0.02), (fast, 0.2)):
        path = path_of(fall, 0.087, 1040.0)
        limit = 0.02 * (2.0 * GRAVITY * fall) ** 0.5
        assert np.interp(time, path[:, 0], path[:, 2]) < limit
        assert path[path[:, 0] < time - 1e-12, 2].min() >= limit


def lawful(density: float, fall: float, diameter: float = 0.0254, bead: float = 0.0) -> dict[str, float]:
    """A drop that obeys d = 0.3 (density / bulk)^(1/2) D^(2/3) H^(1/3), H = fall + d, less half a bead."""
    depth = 0.0
    for _ in range(100):
        depth = 0.3 * (density / 1500.0) ** 0.5 * diameter ** (2 / 3) * (fall + depth) ** (1 / 3)
    return {"density": density, "fall": fall, "diameter": diameter, "bulk_density": 1500.0, "bead_size": bead,
        "deepest": depth - 0.5 * bead, "touch_height": 0.8 * bead}  # fmt: skip


def twelve(bead: float) -> list[dict[str, float]]:
    return [
        lawful(density, fall, bead=bead) for density in (2200.0, 3800.0, 7800.0, 15000.0) for fall in (0.05, 0.1, 0.2)
    ]


def test_the_fit_counts_the_drop_distance_down_to_the_lowest_point() -> None:
    from fits import below_mean_surface, density_exponent, diameter_exponent, drop_exponents, scale

    rows = twelve(0.0)
    density, total = drop_exponents(rows, below_mean_surface(rows))
    assert density.value == pytest.approx(0.5, abs=1e-9)
    assert total.value == pytest.approx(1 / 3, abs=1e-9)
    np.testing.assert_allclose(below_mean_surface(rows) / scale(rows), 0.3)
    assert density_exponent(lawful(2200.0, 0.1), lawful(15000.0, 0.1), below_mean_surface) == pytest.approx(0.5)
    sized = [lawful(2200.0, 0.1, diameter) for diameter in (0.0127, 0.018, 0.0254, 0.036)]
    assert diameter_exponent(sized, below_mean_surface(sized)).value == pytest.approx(2 / 3, abs=1e-9)


def test_the_beds_of_the_causes_lead_from_walls_to_ours_one_step_at_a_time() -> None:
    from ball_into_beads import bed_of, causes

    beds = list(causes().values())
    for before, after in itertools.pairwise(beds):
        changed = {key for key in vars(before) if vars(before)[key] != vars(after)[key]} - {"tiles"}
        assert len(changed) == 1 or before.width > after.width, changed
    # The last but for its beads.
    assert vars(beds[-1]) | {"diameters": (), "width": 0.0} == vars(bed_of(0.003)) | {"diameters": (), "width": 0.0}


def test_a_bed_laid_out_from_tiles_repeats_and_lies_as_high_as_its_tile() -> None:
    from dataclasses import replace

    import numpy as np
    from ball_into_beads import bed_of
    from sphere_bed import places_of, poured

    bed = bed_of(0.005, width=0.06, depth=0.01, fall_speed=3.0)
    tile, whole = poured(replace(bed, width=0.03, tiles=1)), poured(bed)
    assert len(whole.bodies) == 4 * len(tile.bodies) == bed.count
    assert whole.period == (0.06, 0.06)
    np.testing.assert_allclose(np.abs(places_of(whole)[:, :2]).max(), 0.03, atol=0.005)
    assert whole.position[:, 2].mean() == pytest.approx(tile.position[:, 2].mean(), abs=2e-4)


def test_a_low_restitution_gets_more_steps() -> None:
    """Its damping asks for up to 25 in a contact at 0.5; beds that have rows keep their steps."""
    from dataclasses import replace

    from ball_into_beads import GLASS
    from sphere_bed import POUR_STEPS, steps_for

    assert steps_for(GLASS, POUR_STEPS) == POUR_STEPS
    assert steps_for(replace(GLASS, restitution=0.6), POUR_STEPS) == POUR_STEPS
    assert steps_for(replace(GLASS, restitution=0.5), POUR_STEPS) > 25.0
