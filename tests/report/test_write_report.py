"""The report of a whole study folder: everything in it comes from the files, and a missing file is named."""

import json
import re
import shutil
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
import pytest

from lithobrake.report import captions, write_report
from lithobrake.report.results import page_results
from lithobrake.report.scene import scene
from lithobrake.report.study_files import size
from lithobrake.results import MovingBodies, open_study


@pytest.fixture(scope="module")
def report(study_folder: Path) -> str:
    """Text of the page."""
    told: list[tuple[int, int]] = []
    path = write_report(study_folder, lambda done, total: told.append((done, total)))
    assert path == study_folder / "report" / "index.html"
    assert told == [(number, 9) for number in range(9)]
    return path.read_text(encoding="utf-8")


def test_page_has_the_nine_figures_inside_and_nothing_outside(report: str) -> None:
    assert len(re.findall(r'<img alt="[^"]+" src="data:image/png;base64,', report)) == 9
    assert not re.search(r"https?://", report)


def test_figures_are_files_for_papers_with_the_same_bytes_every_time(study_folder: Path, report: str) -> None:
    drawn = {path.name: path.read_bytes() for path in (study_folder / "report").glob("figure_*.svg")}
    assert len(drawn) == 9
    assert all(content.lstrip().startswith(b"<?xml") for content in drawn.values())
    write_report(study_folder)
    assert {name: (study_folder / "report" / name).read_bytes() for name in drawn} == drawn


def test_figures_stand_beside_the_page_as_files(study_folder: Path, report: str) -> None:
    pictures = sorted(path.name for path in (study_folder / "report").glob("*.png"))
    assert [name.split("_")[1] for name in pictures] == ["1", "2", "3", "4", "5", "6", "7", "8", "9"]
    assert not list((study_folder / "report").glob("*.part"))


def test_sentences_carry_the_numbers_of_the_summary(report: str) -> None:
    for words in (
        "On this bed, at this place: 50.0 % come down again. Another bed gives another figure.",
        "+- 4.0 points (90 %) in the return fraction",
        "at most 3.0 %",
        "12 grains",
        "solid fraction of 0.58",
        "0.2 m/s and 30 deg from the normal. The lander leaves the surface after",
        "25 runs on the Smolyak grid, against 125",
        "V+ varies most with the restitution of the grains (50 %, 45 % to 55 %, of its explained variance)",
        "of the variance of the runs 6 % of V+, 6 % of theta+ and 6 % of omega+ is scatter, which no input decides",
        "Q2 = 0.80 (0.70 to 0.85) of V+ (MAPE 1.5 %)",
        "400 samples",
        "pull 1.1 × 10⁻⁵ m/s2 outward",
        "148 by 15 m (semi-axes) about latitude 1.0 deg, longitude 10.0 deg holds 95 % of them",
        "on hard ground 50.0 % come to rest; on the soil it is not known: impact.speed",
    ):
        assert words in report


def test_every_mape_stands_beside_q2_rmse_and_spread(report: str) -> None:
    table = report[report.index("Errors of the expansions") :]
    head = table[: table.index("</tr>")]
    for column in ("MAPE [%]", "Q2", "RMSE", "spread (std)"):
        assert column in head
    assert "0.800 (0.7 to 0.85)" in table


def test_every_sobol_index_has_its_interval(report: str) -> None:
    assert "0.50 (0.45 to 0.55)" in report[report.index("<h3>Sobol indices") :]


def test_provenance_stands_at_the_end(report: str) -> None:
    assert report.index("<h2>Figures") < report.index("<h2>Tables") < report.index("<h2>Provenance")
    assert "packages.numpy" in report


def test_page_says_when_the_study_was_made_and_what_its_body_is_like(report: str) -> None:
    words = "scape speed at the site 0.409 m/s, bulk density of the body 2790 kg/m3"
    assert f'<p class="facts">Study of 2026-03-01, 09:30 UTC. E{words}.</p>' in report
    caption = report[report.index("Figure 7.") : report.index("Figure 8.")]
    assert f"outward; e{words})" in caption
    assert "<td>escape_speed_m_s</td><td>0.4086</td>" in report


def test_page_links_the_files_that_are_there_and_no_others(study_folder: Path, report: str) -> None:
    links = re.findall(r'href="([^"]+)"', report)
    assert all((study_folder / "report" / link).is_file() for link in links)
    for name in ("summary.json", "samples.h5", "flights.csv", "beds/bed_0.h5", "report/figure_7_map.png"):
        assert f"../{name}" in links
    assert "../runs.sqlite" not in links
    held = size((study_folder / "samples.h5").stat().st_size)
    assert f'every sample</td><td class="number">{held}</td>' in report


def test_no_number_of_a_symmetric_study_is_rounding(report: str) -> None:
    assert "10⁻¹⁴" not in report
    assert "10⁻¹⁶" not in report
    assert "10⁻¹⁹" not in report
    assert '<td>velocity across y</td><td>m/s</td><td class="number">0</td>' in report
    assert "<td>centroid_m</td><td>0, 0, 0</td>" in report


def test_a_summary_without_date_and_escape_speed_is_read_too(study_folder: Path) -> None:
    data = page_results(open_study(study_folder))
    site = {key: value for key, value in data.results["site"].items() if key[:6] not in ("escape", "bulk_d")}
    older = replace(data, provenance={}, results=data.results | {"site": site})
    assert captions.facts(older) == ""
    assert captions.impact_map(older).endswith("outward).")


@pytest.mark.parametrize(
    ("byte_count", "words"),
    [(0, "0 B"), (999, "999 B"), (1500, "1.5 kB"), (999_600, "1 MB"), (2_041_598_000, "2042 MB")],
)
def test_sizes_of_files_in_words(byte_count: int, words: str) -> None:
    assert size(byte_count) == words


def test_same_files_give_the_same_page(study_folder: Path, report: str) -> None:
    assert write_report(study_folder).read_text(encoding="utf-8") == report


def test_missing_files_are_named_at_once(study_folder: Path, tmp_path: Path) -> None:
    folder = tmp_path / "half"
    shutil.copytree(study_folder, folder)
    (folder / "scores.json").unlink()
    (folder / "flights.csv").unlink()
    with pytest.raises(ValueError, match=r"scores\.json, flights\.csv.*run the study to its end"):
        write_report(folder)


def without(name: str) -> Callable[[Path], None]:
    def remove(path: Path) -> None:
        with h5py.File(path, "r+") as file:
            del file[name]

    return remove


DAMAGED: list[tuple[str, Callable[[Path], object]]] = [
    ("summary.json", lambda path: path.write_text("")),
    ("summary.json", lambda path: path.write_text("[]")),
    ("summary.json", lambda path: path.write_text("[" * 3000)),
    (
        "summary.json",
        lambda path: path.write_text(path.read_text().replace('"format_version": 3', '"format_version": 7')),
    ),
    ("summary.json", lambda path: path.write_text(path.read_text().replace('"returns"', '"return"'))),
    ("scores.json", lambda path: path.write_text('{"refined": 3}')),
    ("flights.csv", lambda path: path.write_text("")),
    ("flights.csv", lambda path: path.write_text(path.read_text()[:-9])),
    ("flights.csv", lambda path: path.write_text(re.sub("impact,([^,]*),[^,]*,", r"impact,\1,,", path.read_text()))),
    ("flights.csv", lambda path: path.write_text(path.read_text().replace("0.05", "fast"))),
    ("rest.csv", lambda path: path.write_text("a,b\n1,2\n")),
    ("body.obj", lambda path: path.write_text("\n")),
    ("body.obj", lambda path: path.write_text("v 0 0 0\nf 1 2 3\n")),
    ("samples.h5", lambda path: path.write_bytes(path.read_bytes()[:2000])),
    ("samples.h5", without("outcome")),
    ("landing.h5", without("frames/position")),
    ("beds/bed_0.h5", lambda path: path.write_bytes(b"")),
]


@pytest.mark.parametrize(("name", "damage"), DAMAGED)
def test_a_damaged_file_is_one_sentence(
    name: str, damage: Callable[[Path], object], study_folder: Path, tmp_path: Path
) -> None:
    folder = tmp_path / "damaged"
    shutil.copytree(study_folder, folder)
    damage(folder / name)
    with pytest.raises(ValueError, match=f"{name}.*; make it again with: lithobrake run") as refused:
        write_report(folder)
    assert "\n" not in str(refused.value)


def test_study_in_which_nothing_leaves_has_a_page_that_says_so(study_folder: Path, tmp_path: Path) -> None:
    folder = tmp_path / "captured"
    shutil.copytree(study_folder, folder)
    with h5py.File(folder / "samples.h5", "r+") as file:
        file["outcome"][:] = 1
    (folder / "flights.csv").write_text("sample,status,latitude_deg,longitude_deg,facet\n", encoding="utf-8")
    summary = json.loads((folder / "summary.json").read_text())
    summary["results"]["monte_carlo"] |= {"leaving_count": 0, "outputs": {}}
    (folder / "summary.json").write_text(json.dumps(summary))
    text = write_report(folder).read_text(encoding="utf-8")
    assert "None of the 400 samples leaves the surface" in text
    assert "No flight comes down on the body" in text


def test_both_grounds_and_flights_without_scatter_stand_side_by_side(study_folder: Path, tmp_path: Path) -> None:
    folder = tmp_path / "both"
    shutil.copytree(study_folder, folder)
    summary = json.loads((folder / "summary.json").read_text())
    results = summary["results"]
    results["rest"]["soil"] = results["rest"]["hard"] | {"outside": {"count": 3, "share": 0.06}}
    results["without_scatter"] = {"shares": results["shares"], "flights": results["flights"], "ellipses": None}
    (folder / "summary.json").write_text(json.dumps(summary))
    text = write_report(folder).read_text(encoding="utf-8")
    assert "on the soil 50.0 %; there 6.0 % stop where the expansion has no answer" in text
    assert '<th class="number">without scatter</th>' in text
    assert "stopped where the expansion has no answer" in text
    assert "next impact, without scatter" in text


def test_a_body_is_drawn_about_its_centroid(tmp_path: Path) -> None:
    """Vertices off the origin are moved so that the file's position is that of the centroid."""
    tetrahedron = np.array([(0.0, 0.0, 0.0), (4.0, 0.0, 0.0), (0.0, 4.0, 0.0), (0.0, 0.0, 4.0)])
    path = tmp_path / "bed.h5"
    with h5py.File(path, "w") as file:
        file["vertices"], file["faces"] = tetrahedron, np.array([(0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3)])
        file["vertex_start"], file["face_start"] = [0, 4], [0, 4]
        file["frames/time"], file["frames/position"] = [0.0], np.zeros((1, 1, 3))
        file["frames/orientation"] = [[[1.0, 0.0, 0.0, 0.0]]]
    body = scene(MovingBodies.read(path, "make it again"), has_lander=False).bodies[0]
    np.testing.assert_allclose(body.vertices, tetrahedron - 1.0, atol=1e-12)


def test_a_file_without_frames_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "landing.h5"
    with h5py.File(path, "w") as file:
        file["vertices"] = np.zeros((4, 3))
    with pytest.raises(ValueError, match="no group 'frames'"):
        MovingBodies.read(path, "make it again")


def test_importing_the_part_loads_no_matplotlib_and_no_engine() -> None:
    code = (
        "import sys, lithobrake.report; print(sorted({m.split('.')[0] for m in sys.modules} & {'matplotlib', 'numba'}))"
    )
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "[]"
