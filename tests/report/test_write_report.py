"""The report of a whole study folder: everything in it comes from the files, and a missing file is named."""

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

from lithobrake.pipeline.answer.run_answers import scope
from lithobrake.report import reports, write_report
from lithobrake.report.content import PageTable
from lithobrake.report.figures.hulls import scene
from lithobrake.report.figures.style import figure_style
from lithobrake.report.pages.html import size
from lithobrake.report.pages.study_page import study_content
from lithobrake.results import MovingBodies
from lithobrake.results.model_results import SampledOutput
from lithobrake.results.page_data import PageData
from lithobrake.statements import captions, expansion, touchdowns
from lithobrake.statements.answers import page_details, study_answer
from lithobrake.statements.labels import area
from lithobrake.study import read_study
from lithobrake.vocabulary.number_words import number, thousands

from ..quick_studies import blank_pictures, quick_studies


def test_progress_counts_the_figures_and_the_same_files_give_the_same_page(
    paper_folder: Path, paper_page: str, tmp_path: Path
) -> None:
    folder = Path(shutil.copytree(paper_folder, tmp_path / "again"))
    told: list[tuple[int, int]] = []
    with quick_studies(), blank_pictures("png"):
        path = write_report(folder, lambda done, total: told.append((done, total)))
    assert path == folder / "report" / "index.html"
    assert told == [(number, 10) for number in range(10)]
    assert path.read_text(encoding="utf-8") == paper_page
    drawn = sorted((paper_folder / "report").glob("figure_*.svg"))
    assert len(drawn) == 10
    assert not list((folder / "report").glob("*.part"))
    for svg in drawn:
        assert svg.read_bytes().lstrip().startswith(b"<?xml")
        assert (folder / "report" / svg.name).read_bytes() == svg.read_bytes()


@pytest.mark.parametrize(("kind", "begin"), [("png", b"\x89PNG"), ("svg", b"<?xml")])
def test_a_figure_is_the_same_picture_every_time(paper: PageData, kind: str, begin: bytes) -> None:
    plot = study_content(paper).plots[-1]
    with figure_style():
        first, again = (reports._saved(plot.draw(), kind) for _ in range(2))
    assert first == again
    assert first.startswith(begin)


def test_page_has_the_ten_figures_inside_and_nothing_outside(paper_page: str, paper_folder: Path) -> None:
    assert len(re.findall(r'<img alt="[^"]+" src="data:image/svg\+xml;base64,', paper_page)) == 10
    assert not re.search(r"https?://", paper_page)
    pictures = {path.name.split("_")[1] for path in (paper_folder / "report").glob("*.png")}
    assert pictures == {str(number) for number in range(1, 11)}


def test_the_answer_of_a_paper_study_says_how_its_body_turns(paper: PageData, paper_folder: Path) -> None:
    site = replace(paper.results.site, rotation="Dimorphos librates by 8 deg.")
    assert site.warning
    over = scope(read_study(paper_folder / "study.toml"))
    said = study_answer(over, replace(paper.results, site=site))
    assert said == [*paper.results.answer[:-1], "Dimorphos librates by 8 deg.", site.warning]
    assert paper.results.answer[-1] == site.warning


def test_captions_carry_the_numbers_of_the_summary(paper: PageData) -> None:
    results = paper.results
    first, *others = results.answer
    assert all(sentence in page_details(paper) for sentence in others)
    assert first not in page_details(paper)
    assert f"{100 * results.returns.share.value:.1f} % of the landings" in study_content(paper).answer == first
    bed, found = results.beds[0], paper.expansion
    design = results.expansion.designs["screening"]
    for name in ("surface_height_m", "mean_diameter_m", "smallest_width_m", "smallest_depth_m"):
        assert f"{getattr(bed, name):.3g} m" in captions.bed(paper)
    assert "0.2 m/s and 30 deg from the normal" in captions.landing(paper)
    assert f"takes {design.run_count} runs on the Smolyak grid" in expansion.counts(found, paper.study)
    first = results.expansion.screening.sobol_first["speed_out"]
    assert f"({100 * max(first.values()):.0f} %, " in expansion.sobol(found, paper.study)
    assert f"Q2 = {found.scores['test_all']['speed_out'].q2:.2f}" in expansion.errors(found)
    assert "amount to 1.4 × 10⁻⁵ m/s2 outward" in captions.outcomes(paper)
    large = results.samples.regions[-1]
    assert large.share == 0.95
    assert f"95 % of them covers {area(large.area_m2)} and is {number(large.largest_extent_m, 2)} m across" in (
        captions.impact_map(paper.samples)
    )


def test_landers_of_unknown_outcome_are_named(paper: PageData) -> None:
    hard = paper.results.hard_ground["hard"]
    lost = replace(paper.results, hard_ground={"hard": replace(hard, unknown=0.15)})
    assert "unknown" not in captions.hard_ground(paper)
    assert captions.hard_ground(replace(paper, results=lost)).endswith("; 15.0 % have an unknown outcome.")


def test_every_score_and_every_sobol_index_has_its_interval(paper: PageData) -> None:
    scores, indices = (table_of(paper, title) for title in ("Errors of the expansions", "Sobol indices"))
    assert {"MAPE [%]", "Q2", "RMSE", "spread (std)"} <= set(scores.columns)
    assert all(cell.endswith(")") for row in scores.rows for cell in row[3:5])
    assert all(cell.endswith(")") for row in indices.rows for cell in row[1:])


def test_flights_without_scatter_stand_beside_those_with_it(paper: PageData) -> None:
    table, alone = table_of(paper, "After the first touchdown"), paper.results.samples.without_scatter
    assert table.columns[-1] == "without scatter"
    assert table.rows[0][-1] == f"{100 * alone.shares.outcomes['impact'].share.value:.1f} %"


def test_an_outcome_that_no_run_had_has_its_upper_limit(paper: PageData) -> None:
    limit = paper.results.samples.shares.outcomes["time_limit"].upper_limit
    assert f"at most {100 * limit:.1f} %" in [row[2] for row in table_of(paper, "After the first touchdown").rows]


def table_of(data: PageData, title: str) -> PageTable:
    tables = [table for section in study_content(data).sections for table in section.tables]
    return next(table for table in tables if table.title == title)


def test_provenance_stands_at_the_end(paper_page: str) -> None:
    order = ("Where", "When", "Why", "How sure", "Method", "Appendix", "Files")
    assert tuple(re.findall(r"<h2>([^<]+)</h2>", paper_page)) == order
    assert paper_page.index("packages.numpy") > paper_page.index("<h2>Files")


def test_page_says_when_the_study_was_made_and_what_its_body_is_like(paper: PageData) -> None:
    words, site = captions.facts(paper), paper.results.site
    assert re.match(r"Study of \d{4}-\d\d-\d\d, \d\d:\d\d UTC\. ", words)
    for value in (site.escape_speed_m_s, site.bulk_density_kg_m3):
        assert number(value) in words


def test_page_links_the_files_that_are_there_and_no_others(paper_folder: Path, paper_page: str) -> None:
    links = re.findall(r'href="([^"#]+)"', paper_page)
    assert all((paper_folder / "report" / link).is_file() for link in links)
    for name in ("summary.json", "samples.h5", "flights.csv", "beds/bed_0.h5", "report/figure_1_map.png"):
        assert f"../{name}" in links
    assert "../designs/drawn.csv" not in links
    held = size((paper_folder / "samples.h5").stat().st_size)
    assert f'every sample</td><td class="number">{held}</td>' in paper_page


def test_no_number_of_a_symmetric_study_is_rounding(paper: PageData, paper_page: str) -> None:
    assert "<td>centroid_m</td><td>0, 0, 0</td>" in paper_page
    samples = paper.samples.results
    speed = samples.outputs["speed_out"]
    quantiles = {level: -2.2e-14 * value for level, value in speed.quantiles.items()}
    across = SampledOutput(-2.2e-14 * speed.mean, -2.2e-14 * speed.std, quantiles)
    symmetric = replace(samples, outputs={**samples.outputs, "velocity_out_y": across})
    found = replace(paper, samples=replace(paper.samples, results=symmetric))
    table = table_of(found, "Outputs of the samples that leave")
    assert next(row for row in table.rows if row[0] == "rebound velocity along y")[2:] == ["0"] * 5


@pytest.mark.parametrize(
    ("byte_count", "words"),
    [(0, "0 B"), (999, "999 B"), (1500, "1.5 kB"), (999_600, "1 MB"), (2_041_598_000, "2042 MB")],
)
def test_sizes_of_files_in_words(byte_count: int, words: str) -> None:
    assert size(byte_count) == words


def test_missing_files_are_named_at_once(paper_folder: Path, tmp_path: Path) -> None:
    folder = tmp_path / "half"
    shutil.copytree(paper_folder, folder)
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
    ("summary.json", lambda path: path.write_text("")), ("summary.json", lambda path: path.write_text("[]")),
    ("summary.json", lambda path: path.write_text("[" * 3000)),
    ("summary.json",
     lambda path: path.write_text(re.sub(r'"format_version": \d+', '"format_version": 7', path.read_text()))),
    ("summary.json", lambda path: path.write_text(path.read_text().replace('"returns"', '"return"'))),
    ("scores.json", lambda path: path.write_text('{"refined": 3}')), ("flights.csv", lambda path: path.write_text("")),
    ("flights.csv", lambda path: path.write_text(path.read_text()[:-9])),
    ("flights.csv", lambda path: path.write_text(re.sub("impact,([^,]*),[^,]*,", r"impact,\1,,", path.read_text()))),
    ("flights.csv", lambda path: path.write_text(path.read_text().replace("0.0", "fast"))),
    ("rest.csv", lambda path: path.write_text("a,b\n1,2\n")), ("body.obj", lambda path: path.write_text("\n")),
    ("body.obj", lambda path: path.write_text("v 0 0 0\nf 1 2 3\n")),
    ("samples.h5", lambda path: path.write_bytes(path.read_bytes()[:2000])), ("samples.h5", without("outcome")),
    ("landing.h5", without("frames/position")), ("beds/bed_0.h5", lambda path: path.write_bytes(b"")),
]  # fmt: skip


@pytest.mark.parametrize(("name", "damage"), DAMAGED)
def test_a_damaged_file_is_one_sentence(
    name: str, damage: Callable[[Path], object], paper_folder: Path, tmp_path: Path
) -> None:
    folder = tmp_path / "damaged"
    shutil.copytree(paper_folder, folder)
    damage(folder / name)
    with pytest.raises(ValueError, match=f"{name}.*; make it again with: lithobrake run") as refused:
        write_report(folder)
    assert "\n" not in str(refused.value)


def test_a_study_in_which_nothing_leaves_says_so(paper: PageData) -> None:
    table = replace(paper.samples.results, leaving_count=0, outputs={})
    count = thousands(table.sample_count)
    assert f"None of the {count} samples leaves the surface" in touchdowns.samples(table)
    assert captions.body(replace(paper.samples, facet=paper.samples.facet[:0])) == ""


def test_a_body_is_drawn_about_the_point_that_its_position_is_of(tmp_path: Path) -> None:
    """Of a lander with its centre of mass off the centroid that is the centre of mass; nothing is moved."""
    tetrahedron = np.array([(0.0, 0.0, 0.0), (4.0, 0.0, 0.0), (0.0, 4.0, 0.0), (0.0, 0.0, 4.0)])
    path = tmp_path / "bed.h5"
    with h5py.File(path, "w") as file:
        file["vertices"], file["faces"] = tetrahedron, np.array([(0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3)])
        file["vertex_start"], file["face_start"] = [0, 4], [0, 4]
        file["frames/time"], file["frames/position"] = [0.0], np.zeros((1, 1, 3))
        file["frames/orientation"] = [[[1.0, 0.0, 0.0, 0.0]]]
    body = scene(MovingBodies.read(path, "make it again"), has_lander=False).bodies[0]
    np.testing.assert_array_equal(body.vertices, tetrahedron)


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
