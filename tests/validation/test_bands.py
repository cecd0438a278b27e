"""Bands of longitude of the ballistic descents, against triangles whose crossings are known."""

import runpy
from pathlib import Path

import numpy as np
import pytest

BANDS = runpy.run_path(str(Path(__file__).parents[2] / "validation" / "ballistic_descent" / "bands.py"))
LONGITUDES = np.arange(0.0, 360.0, 10.0)


def test_ends_are_where_a_triangle_around_the_seam_crosses_the_level() -> None:
    away = np.abs((LONGITUDES - 350.0 + 180.0) % 360.0 - 180.0)
    band = BANDS["band_of"](LONGITUDES, np.maximum(1.0 - away / 60.0, 0.0), 0.5)
    assert (band.begin, band.end) == pytest.approx((320.0, 380.0))
    assert str(band) == "320 to 20"
    assert band.agrees(BANDS["Band"](311.0, 29.0 + 360.0), 10.0)
    assert not band.agrees(BANDS["Band"](309.0, 380.0), 10.0)


def test_no_and_every_longitude_have_words_and_agree_with_nothing() -> None:
    flat = np.full(36, 0.8)
    every, none = (BANDS["band_of"](LONGITUDES, flat, level) for level in (0.7, 0.9))
    assert (str(every), str(none)) == ("all", "none")
    assert not every.agrees(BANDS["Band"](0.0, 360.0), 10.0)
    assert not none.agrees(BANDS["Band"](0.0, 360.0), 10.0)
