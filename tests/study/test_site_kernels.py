"""Spin and place of the partner from the kernels that a study file names."""

import sys
import tomllib
from pathlib import Path
from typing import Any

import pytest

from lithobrake.pipeline.answer.dispersion_statistics import site_results
from lithobrake.pipeline.answer.study_summary import study_tables, summary_dependencies
from lithobrake.pipeline.first_touchdown.flights import flight_dependencies
from lithobrake.pipeline.site import Site
from lithobrake.pipeline.sky_at_rest import sky_dependencies
from lithobrake.results.study_files import json_values
from lithobrake.smallbody import read_partner
from lithobrake.study import Study, check_tables
from lithobrake.study.design_sections import SkySection
from lithobrake.study.template import template

from ..smallbody.kernels import PCK, write_kernels
from ..smallbody.meshes import CUBE_FACES, cube_vertices

pytest.importorskip("spiceypy")
EPOCH = "2026-11-22T12:00:00"
NAMES = ["didymos.tpc", "leap.tls", "didymos.bsp"]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder of a study file with kernels, and a cube of 100 m."""
    write_kernels(tmp_path)
    lines = [f"v {x} {y} {z}" for x, y, z in cube_vertices(100.0)] + [
        f"f {a + 1} {b + 1} {c + 1}" for a, b, c in CUBE_FACES
    ]
    (tmp_path / "cube.obj").write_text("\n".join(lines) + "\n")
    return tmp_path


def study(folder: Path, **site: Any) -> Study:
    return check_tables(tomllib.loads(template()) | {"site": site}, folder)


def test_the_numbers_of_kernels_are_those_of_the_study_and_of_its_summary(folder: Path) -> None:
    found = study(folder, kernels=NAMES, epoch=EPOCH)
    place = read_partner([folder / name for name in NAMES], "didymos", "dimorphos", EPOCH)
    period = 360.0 / 3823.0 * 86_400.0
    assert Site(found).medians["spin_period"] == period
    assert Site(found).medians["partner_longitude_deg"] == place.longitude_deg
    assert Site(found).body.spin_period == period
    told = site_results(Site(found))
    assert json_values(told.kernels) == {"spin_period_s": period, "pole_right_ascension_deg": 69.327,
        "pole_declination_deg": -72.725, "prime_meridian_deg": 120.0, "partner_longitude_deg": place.longitude_deg,
        "partner_latitude_deg": place.latitude_deg, "partner_distance_m": place.distance,
        "partner_period_s": place.period}  # fmt: skip
    assert told.spin_period_s == period
    # Paths stand in the summary as they were written.
    assert study_tables(found, {"site": {"kernels": NAMES}})["site"]["kernels"] == NAMES
    assert site_results(Site(study(folder))).kernels is None


def test_a_mesh_turns_as_the_kernels_say(folder: Path) -> None:
    found = study(folder, body="cube.obj", mass=2e9, kernels=NAMES[:1], kernel_body="920065803")
    assert Site(found).medians["spin_period"] == pytest.approx(8136.0, rel=1e-3)


def test_another_spin_in_the_kernel_makes_the_flights_anew_and_another_comment_does_not(folder: Path) -> None:
    found, kernel = study(folder, kernels=NAMES[:1]), folder / NAMES[0]
    before = flight_dependencies(found)
    kernel.write_text("KPL/PCK\nA comment.\n" + PCK.removeprefix("KPL/PCK\n"))
    assert flight_dependencies(found) == before
    kernel.write_text(PCK.replace("3823.0", "3824.0"))
    assert flight_dependencies(found) != before
    # A text of a kernel has eighty characters at most, which folders of tests are longer than.
    path = [f"'{str(kernel)[at : at + 60]}+'" for at in range(0, len(str(kernel)), 60)]
    path[-1] = path[-1].replace("+'", "'")
    names = " ".join(path)
    (folder / "all.tm").write_text(f"KPL/MK\n\\begindata\nKERNELS_TO_LOAD = ( {names} )\n\\begintext\n")
    by_meta = study(folder, kernels=["all.tm"])
    with_sky = by_meta.model_copy(update={"sky": SkySection(date=EPOCH)})
    before, summary, sky = flight_dependencies(by_meta), summary_dependencies(by_meta), sky_dependencies(with_sky)
    kernel.write_text(PCK.replace("3823.0", "3825.0").replace("69.327", "69.5"))
    assert flight_dependencies(by_meta) != before
    assert sky_dependencies(with_sky) != sky
    # The summary has the pole, too.
    assert summary_dependencies(by_meta)["kernels"][1] - summary["kernels"][1] == pytest.approx(0.173)
    assert flight_dependencies(study(folder)) == flight_dependencies(study(folder, kernels=[]))


@pytest.mark.parametrize(("site", "words"), [
    ({"kernels": ["absent.tpc"]}, 'absent.tpc"; no such file'),
    ({"kernels": NAMES[1:2]}, "site.kernels: the kernels have no BODY920065803_POLE_RA; add the constants"),
    ({"kernels": NAMES[:1], "kernel_body": "Utopia"}, "add the kernel that has it"),
    ({"kernels": NAMES[:2], "epoch": EPOCH}, "add the kernel that has it"),
    ({"kernels": NAMES[:1], "spin_period": 8136.0}, "site.spin_period is given, and site.kernels has it read"),
    ({"kernels": NAMES, "epoch": EPOCH, "partner_longitude_deg": 0.0},
     "site.partner_longitude_deg is given, and site.epoch has it read"),
    ({"kernels": NAMES, "epoch": EPOCH, "partner": False}, "the body has none; leave it out"),
    ({"epoch": EPOCH}, "site.epoch goes with site.kernels"),
    ({"kernels": NAMES, "epoch": "2026-366T00:00:00"}, "site.epoch is \"2026-366T00:00:00\", and 2026 has the days"),
    ({"body": "cube.obj", "mass": 2e9, "kernels": NAMES[:1]}, "site.kernel_body is missing"),
    ({"kernels": NAMES[0]}, "allowed: a list; write its entries in square brackets"),
])  # fmt: skip
def test_what_kernels_do_not_tell_is_refused_in_one_sentence(folder: Path, site: dict[str, Any], words: str) -> None:
    with pytest.raises(ValueError, match=r"study\.toml: site") as refused:
        study(folder, **site)
    assert words in str(refused.value)
    assert len(str(refused.value).splitlines()) == 1


def test_a_kernel_of_zeros_is_refused_and_ends_no_process(folder: Path) -> None:
    """SPICE aborts the process that loads it."""
    (folder / "zeros.ek").write_bytes(b"DAS/EK  " + bytes(4000))
    with pytest.raises(ValueError, match=r"site.kernels: .*zeros.ek: not a kernel that SPICE can read"):
        study(folder, kernels=["zeros.ek"])


def test_without_the_library_it_says_how_to_install_it(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "spiceypy", None)
    with pytest.raises(
        ValueError, match=r'site.kernels: spiceypy.* is not installed: pip install "lithobrake\[spice\]"'
    ):
        study(folder, kernels=NAMES[:1])
