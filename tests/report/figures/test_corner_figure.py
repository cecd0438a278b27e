"""A corner plot shows each law after over that before, on the scale of the law."""

import json
from pathlib import Path

import numpy as np
import pytest

from lithobrake.files.reading import DamagedFileError
from lithobrake.report import write_corner
from lithobrake.report.figures.model_figures import corner_figure
from lithobrake.report.figures.style import figure_style

GRID = (np.arange(200) + 0.5) / 200
INPUTS = {
    "grain.friction": {
        "unit": "-", "prior": (0.9 * GRID).tolist(), "points": (0.9 * GRID**2).tolist(), "sd_ratio": 0.7,
    },
    "grain.young_modulus": {
        "unit": "Pa", "prior": (10 ** (5 + 2 * GRID)).tolist(), "points": (10 ** (6 + GRID)).tolist(),
        "sd_ratio": 0.5,
    },
}  # fmt: skip


def test_a_law_over_decades_is_drawn_by_its_logarithm_and_one_from_nothing_is_not() -> None:
    with figure_style():
        axes = corner_figure(INPUTS).axes
    friction, _, pair, stiffness = axes
    assert (friction.get_xscale(), stiffness.get_xscale()) == ("linear", "log")
    assert (pair.get_xscale(), pair.get_yscale()) == ("linear", "log")
    assert stiffness.get_title(loc="right") == "50 % of sd left"
    heights = np.array([bar.get_height() for bar in stiffness.patches])
    # Twenty steps before, then after: even, and in the upper half alone.
    assert heights[:20] == pytest.approx(0.05, abs=0.011)
    assert heights[20:29].sum() == 0.0
    assert pair.get_xlabel() == r"friction $\mu$, grains"


def test_the_picture_is_made_of_the_file_and_another_file_is_refused(tmp_path: Path) -> None:
    content = {"statement": "", "inputs": INPUTS}
    (tmp_path / "posterior.json").write_text(json.dumps(content), encoding="utf-8")
    write_corner(tmp_path / "posterior.json", tmp_path / "picture.png")
    assert (tmp_path / "picture.png").read_bytes().startswith(b"\x89PNG")
    (tmp_path / "posterior.json").write_text('{"statement": ""}', encoding="utf-8")
    with pytest.raises(DamagedFileError, match="lacks inputs"):
        write_corner(tmp_path / "posterior.json", tmp_path / "picture.png")
