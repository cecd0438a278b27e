"""Pictures and numbers on pages: the command or script beside each makes it."""

import json
import math
import re
import runpy
import sys
from importlib import import_module
from types import ModuleType

import pytest
from blocks import ROOT

PAGE = (ROOT / "docs" / "gallery.md").read_text(encoding="utf-8")
PICTURE = re.compile(r"^!\[([^\]]+)\]\(([^)]+)\)\n\n\*([^*]+)\*\n\n```sh\n(.+)\n```$", flags=re.MULTILINE)
ENTRIES = PICTURE.findall(PAGE)


def test_every_picture_has_a_caption_and_a_command() -> None:
    assert len(ENTRIES) == PAGE.count("![") > 10


@pytest.mark.parametrize(("picture", "command"), [(entry[1], entry[3]) for entry in ENTRIES])
def test_the_picture_and_what_makes_it_exist(picture: str, command: str) -> None:
    assert (ROOT / "docs" / picture).is_file()
    program, *words = command.split()
    assert program in ("lithobrake", "python")
    made_of = next(word for word in words if "/" in word)
    # A study's folder is made by the study of its name.
    path = ROOT / (made_of if "." in made_of else f"scenarios/{made_of.removeprefix('runs/')}.toml")
    assert path.is_file()


@pytest.mark.parametrize(("picture", "command"), [(one[1], one[3]) for one in ENTRIES if one[3].startswith("python")])
def test_the_script_is_of_the_part_that_draws_the_picture(picture: str, command: str) -> None:
    """Some file beside the script, or the script itself, has the name of the picture."""
    script, name = ROOT / command.split()[1], picture.rpartition("/")[2].removesuffix(".png")
    beside = [script] if script.parent.name == "validation" else script.parent.glob("*.py")
    assert any(name in path.read_text(encoding="utf-8") for path in beside)


LEFT_OUT_PAGE = (ROOT / "docs" / "what_the_model_leaves_out.md").read_text(encoding="utf-8")
SCRIPT = runpy.run_path(str(ROOT / "validation" / "experiments" / "left_out.py"))


@pytest.mark.parametrize("table", ["contact_lines", "yield_lines", "cohesion_lines", "force_lines"])
def test_the_page_has_the_tables_of_the_script(table: str) -> None:
    assert "\n".join(SCRIPT[table]()) in LEFT_OUT_PAGE


def test_a_sphere_on_a_plate_yields_where_johnson_says() -> None:
    """[Johnson-1985], Eq 11.20: density times speed squared over strength is 26 (strength / modulus)^4."""
    density, strength, modulus, radius = 2500.0, 1e6, 1e9, 0.01
    mass = density * 4.0 / 3.0 * math.pi * radius**3
    known = SCRIPT["yield_speed"].__globals__
    known["pair"], known["effective_modulus"] = (lambda: (mass, radius)), (lambda young: young)
    speed = SCRIPT["yield_speed"](strength, modulus)
    assert density * speed**2 / strength == pytest.approx(26.0 * (strength / modulus) ** 4, rel=0.02)


FOLDER = ROOT / "validation" / "experiments"


@pytest.fixture(scope="module")
def oblique_map() -> ModuleType:
    sys.path[:0] = [str(FOLDER), str(ROOT / "benchmarks")]
    try:
        return import_module("oblique_map")
    finally:
        del sys.path[:2]


@pytest.mark.parametrize(
    ("status", "way", "kind"),
    [
        ("captured", 0.02, "stop"), ("clear", 0.02, "bounce"), ("clear", 0.2, "along"),
        ("left_sideways", 0.2, "along"), ("left_sideways", 0.02, "lost"), ("left_sideways", math.nan, "lost"),
        ("time_limit", 0.2, "lost"),
    ],
)  # fmt: skip
def test_a_landing_is_told_by_outcome_and_way(oblique_map: ModuleType, status: str, way: float, kind: str) -> None:
    assert oblique_map.kind({"shape": "sphere", "status": status, "way": way}) == kind


def test_the_summary_is_that_of_the_table(oblique_map: ModuleType) -> None:
    kept = json.loads((FOLDER / "oblique_map.json").read_text(encoding="utf-8"))
    found = json.loads(json.dumps(oblique_map.cells(oblique_map.noted(FOLDER / "oblique_map.csv"))))
    assert found == kept["cells"]
    assert all(sum(share["count"] for share in entry["shares"].values()) == entry["landings"] for entry in found)
