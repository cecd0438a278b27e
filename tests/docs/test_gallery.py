"""The gallery: every picture exists, and the command below it names a file that makes it."""

import re

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
