"""How the depths of balls dropped into beads are fitted: rows made by the experiment's own law give it back."""

import itertools
import sys
from pathlib import Path

import numpy as np
import pytest

EXPERIMENTS = Path(__file__).parents[2] / "validation" / "experiments"


@pytest.fixture(autouse=True)
def experiments_on_path(monkeypatch: pytest.MonkeyPatch) -> None:
    """The scripts of the experiments import each other by name."""
    monkeypatch.setattr(sys, "path", [str(EXPERIMENTS), *sys.path])


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

    bed = bed_of(0.005, width=0.06, depth=0.02, fall_speed=3.0)
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
