"""The slide of examples/slide.py, drawn from a study that the repository keeps."""

import runpy
import shutil
from pathlib import Path

import matplotlib.pyplot as plt

ROOT = Path(__file__).parents[2]


def test_a_slide_is_drawn_beside_the_folder_of_a_study(tmp_path: Path) -> None:
    folder = tmp_path / "mission"
    shutil.copytree(ROOT / "showcase" / "mission", folder)
    path = runpy.run_path(str(ROOT / "examples" / "slide.py"))["main"](folder)
    assert path == tmp_path / "mission_slide.png"
    picture = plt.imread(path)
    assert picture.shape[:2] == (1080, 1920)
    # Words stand on the left, the map on the right: neither half is empty.
    assert all((half[..., :3] < 0.5).any() for half in (picture[:, :800], picture[:, 800:]))
