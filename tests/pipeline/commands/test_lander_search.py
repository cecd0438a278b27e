"""Where to look for the lander of a study: the chance of the windows, their files, and what is refused."""

import csv
import re
from pathlib import Path

import numpy as np
import pytest

from lithobrake.pipeline import search_lander, search_lines, write_search
from lithobrake.pipeline.commands.lander_search import read_images
from lithobrake.results import StudyResults
from lithobrake.smallbody import Imager

TITLES = "time,x_m,y_m,z_m,sun_x,sun_y,sun_z\n"


def images(folder: Path, text: str) -> Path:
    path = folder / "images.csv"
    path.write_text(text, encoding="utf-8")
    return path


def around(folder: Path, distance: float, count: int = 12) -> Path:
    """Images from all longitudes, with the Sun behind the camera."""
    rows = []
    for number in range(count):
        angle = 2.0 * np.pi * number / count
        x, y = np.cos(angle), np.sin(angle)
        rows.append(f"image {number},{distance * x},{distance * y},0.0,{x},{y},0.1\n")
    return images(folder, TITLES + "".join(rows))


def test_the_chance_is_that_of_landers_that_had_no_part_in_the_choice(tmp_path: Path, journeys: StudyResults) -> None:
    """A wide field finds nearly all of them with few images; its table and map are written."""
    rest = journeys.journeys["end"] == "at_rest"
    camera = Imager(np.radians(20.0), np.radians(20.0) / 4000, pixels=1.0, emission=np.radians(85.0), sun=0.0)
    found = search_lander(journeys, around(tmp_path, 3000.0), camera, count=12, size=5.0)
    values = [one.value for one in found.found]
    assert values == sorted(values)
    assert values[-1] <= found.ever
    assert (found.first >= 0).mean() >= values[-1]
    assert len(found.first) == rest.sum()
    assert len({one.image for one in found.windows}) == len(found.windows)
    table, picture = write_search(found, camera, tmp_path)
    rows = list(csv.DictReader(table.open(encoding="utf-8")))
    assert [int(row["rank"]) for row in rows] == list(range(1, len(found.windows) + 1))
    assert float(rows[0]["found"]) == values[0]
    assert 2000.0 < float(rows[0]["distance [m]"]) < 3000.0
    assert picture.stat().st_size > 10_000
    assert search_lines(found)[0].startswith(
        f"{len(found.windows)} of 12 images show the lander with a probability of "
    )


def test_a_field_that_sees_all_finds_all_in_one_image_per_side(tmp_path: Path, journeys: StudyResults) -> None:
    """With every place in sight of one image, that image finds each lander, whichever others were left out."""
    camera = Imager(np.radians(170.0), 1e-6, pixels=1.0, emission=np.radians(90.0), sun=0.0)
    found = search_lander(journeys, around(tmp_path, 3000.0), camera, size=5.0)
    seen = [one.value for one in found.found]
    assert seen[-1] == pytest.approx(found.ever, abs=0.05)


@pytest.mark.parametrize(("text", "said"), [
    (TITLES, "has no images"),
    ("time,x_m\nnow,1\n", "lacks the columns y_m, z_m"),
    (TITLES + "now,1e4,0,far,1,0,0\n", 'row 1: z_m is "far"; allowed: a finite number'),
    (TITLES + "now,1e4,0,0,0,0,0\n", "row 1: sun_x to sun_z are 0"),
], ids=str)  # fmt: skip
def test_a_table_of_images_that_is_none_is_refused(tmp_path: Path, text: str, said: str) -> None:
    with pytest.raises(ValueError, match=re.escape(said)):
        read_images(images(tmp_path, text))


def test_an_orbiter_below_the_ground_and_images_that_show_nothing_are_refused(
    tmp_path: Path, journeys: StudyResults
) -> None:
    camera = Imager(np.radians(5.5), np.radians(5.5) / 1020)
    with pytest.raises(ValueError, match=r"row 1: the orbiter is .* m below the ground; allowed: above it"):
        search_lander(journeys, images(tmp_path, TITLES + "now,0.003,0,0,1,0,0\n"), camera, size=1.0)
    with pytest.raises(ValueError, match=r"none of the 12 images of .* shows a place of rest: too dark"):
        search_lander(journeys, around(tmp_path, 1e7), camera, size=0.1)
