"""The page of what the model leaves out has the numbers that its script works out."""

import math
import runpy

import pytest
from blocks import ROOT

PAGE = (ROOT / "docs" / "what_the_model_leaves_out.md").read_text(encoding="utf-8")
SCRIPT = runpy.run_path(str(ROOT / "validation" / "experiments" / "left_out.py"))


@pytest.mark.parametrize("table", ["contact_lines", "yield_lines", "cohesion_lines", "force_lines"])
def test_the_page_has_the_tables_of_the_script(table: str) -> None:
    assert "\n".join(SCRIPT[table]()) in PAGE


def test_a_sphere_on_a_plate_yields_where_johnson_says() -> None:
    """[Johnson-1985], Eq 11.20: density times speed squared over strength is 26 (strength / modulus)^4."""
    density, strength, modulus, radius = 2500.0, 1e6, 1e9, 0.01
    mass = density * 4.0 / 3.0 * math.pi * radius**3
    known = SCRIPT["yield_speed"].__globals__
    known["pair"], known["effective_modulus"] = (lambda: (mass, radius)), (lambda young: young)
    speed = SCRIPT["yield_speed"](strength, modulus)
    assert density * speed**2 / strength == pytest.approx(26.0 * (strength / modulus) ** 4, rel=0.02)
