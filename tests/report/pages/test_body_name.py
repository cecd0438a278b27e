"""The body of a study by its name, on the page and for other programs."""

from types import SimpleNamespace
from typing import Any

import pytest

from lithobrake.export.flown import body_name
from lithobrake.statements import captions


@pytest.mark.parametrize(("site", "on_page", "exported"), [
    ({"body": "didymos"}, "Didymos", "DIDYMOS"),
    ({"body": "dimorphos", "name": None}, "Dimorphos", "DIMORPHOS"),
    ({"body": "shapes/rock-v2.obj"}, "the body", "ROCK_V2"),
    ({"body": "shapes/rock-v2.obj", "name": "2001 SN263"}, "2001 SN263", "2001_SN263"),
])  # fmt: skip
def test_a_mesh_has_the_name_that_the_study_gives_it(site: dict[str, Any], on_page: str, exported: str) -> None:
    study: Any = SimpleNamespace(study={"site": site})
    assert (captions.body_name(study.study), body_name(study)) == (on_page, exported)
