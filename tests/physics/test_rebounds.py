"""Who rebounds from coarse grains: what validation/experiments/who_rebounds.py asks for, in small."""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

EXPERIMENTS = Path(__file__).parents[2] / "validation" / "experiments"


@pytest.fixture(autouse=True)
def experiments_on_path(monkeypatch: pytest.MonkeyPatch) -> None:
    """The scripts of the experiments import each other by name."""
    monkeypatch.setattr(sys, "path", [str(EXPERIMENTS), *sys.path])


def test_a_similar_drop_has_the_numbers_of_the_drop_it_stands_for() -> None:
    """Froude number, modulus over density v^2, and pull over density v^2 d are the true drop's."""
    from who_rebounds import DIAMETER, EARTH, KINDS

    kind = KINDS["lunar, 1e-2 g"]
    speed, gravity, stuff = kind.scaled(3.0)
    assert speed / np.sqrt(gravity * DIAMETER) == pytest.approx(3.0)
    true_speed = 3.0 * np.sqrt(EARTH * kind.share * DIAMETER)
    assert stuff.surface_energy / speed**2 == pytest.approx(kind.surface_energy / true_speed**2)
    assert stuff.young_modulus / (stuff.density * speed**2) >= kind.stiff * (1.0 - 1e-12)


def test_a_fast_ball_throws_grains_and_none_leaves_faster_than_a_pair(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Ejecta begin with speed [Brisset-2018]; a bed gives back less than the restitution of its grains."""
    import who_rebounds

    kind = replace(who_rebounds.KINDS["6 mm"], grain=0.007, width=0.06)
    monkeypatch.setitem(who_rebounds.KINDS, "6 mm", kind)
    slow, fast = (who_rebounds.drop(tmp_path, "6 mm", froude, 0) for froude in (1.0, 30.0))
    assert slow["ejecta"] == 0
    assert fast["ejecta"] > 10
    assert all(0.0 <= row["upward_out"] < kind.material.restitution for row in (slow, fast))


def test_a_share_agrees_where_most_do_what_was_seen() -> None:
    from rebounds_part import RISEN, share_line

    rows = [{"rise": 2.0 * RISEN}] * 3 + [{"rise": 0.0}] * 7
    line = share_line("ball", "stays", 0.0, rows, "a row")
    assert line.agrees
    assert line.ours == "0.30 (0.11 to 0.60)"
    assert line.cells()[-1] == ""
    other = share_line("ball", "rebounds", 1.0, rows, "a row")
    assert not other.agrees
    assert other.cells()[-1] == "a row"
