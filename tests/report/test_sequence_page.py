"""The page of a sequence: its sentences, figures and tables come from the summary, and say what this study's mean."""

import json
import re
import shutil
from collections.abc import Callable
from copy import deepcopy
from dataclasses import replace
from pathlib import Path
from typing import Any

import h5py
import pytest

from lithobrake.report import captions, sequence_captions, sequence_tables, write_report
from lithobrake.report.captions import place_words
from lithobrake.report.rare_tables import rare_tables
from lithobrake.report.results import SequenceResults, page_results
from lithobrake.report.sequence_answer import answer, warnings
from lithobrake.report.sequence_page import sequence_content
from lithobrake.results import open_study

RETURNS = {
    "share": 0.71, "lower": 0.68, "upper": 0.73, "level": 0.9, "from": "244 landings on 6 beds",
    "next_bed": [0.64, 0.77], "if_missing": [0.685, 0.718], "flight_sampling": 0.003, "emulator": 0.71, "why": None,
}  # fmt: skip
RUNS = {"count": 252, "beds": 6, "outcomes": {"captured": 4, "clear": 240, "left_sideways": 8}, "over_rim": 0}
ONE_BED = {"lower": None, "upper": None, "next_bed": None, "if_missing": [0.71, 0.71], "why": "one bed was poured"}


@pytest.fixture(scope="module")
def page(sequence_folder: Path) -> str:
    """Text of the page."""
    told: list[tuple[int, int]] = []
    path = write_report(sequence_folder, lambda done, total: told.append((done, total)))
    assert told == [(number, 9) for number in range(9)]
    return path.read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def data(sequence_folder: Path) -> SequenceResults:
    found = page_results(open_study(sequence_folder))
    assert isinstance(found, SequenceResults)
    return found


def told(data: SequenceResults, **tables: Any) -> SequenceResults:
    """The results with other tables; None takes one away."""
    kept = {key: value for key, value in (data.results | tables).items() if value is not None}
    return replace(data, results=kept)


def holding(data: SequenceResults) -> SequenceResults:
    """The study of section 3.4 of the audit, at a site that holds what lies there."""
    site = data.results["site"] | {"effective_acceleration_outward": -1e-5}
    return told(data, site=site, returns=RETURNS, runs=RUNS)


def test_the_product_of_an_archive_stands_beside_the_body(data: SequenceResults) -> None:
    site = data.results["site"] | {"product_id": "urn:nasa:pds:rocks:data:rock::3.0"}
    assert place_words(told(data, site=site)) == [
        "Landing at latitude 0 deg, longitude 0 deg on Didymos (urn:nasa:pds:rocks:data:rock::3.0)."
    ]


def test_every_figure_is_there_with_its_caption_and_its_file(page: str, sequence_folder: Path) -> None:
    assert len(re.findall(r'<img alt="[^"]+" src="data:image/png;base64,', page)) == 9
    files = sorted(path.name for path in (sequence_folder / "report").glob("*.png"))
    names = ("bed", "landing", "runs", "variance", "calibration", "outputs", "map", "body", "rest")
    assert files == [f"figure_{number}_{name}.png" for number, name in enumerate(names, start=1)]
    for title in ("What the landings gave", "What decides", "Whether to believe the emulator"):
        assert f"{title}.</b>" in page


def test_the_answer_says_over_what_it_holds(data: SequenceResults) -> None:
    assert answer(holding(data)) == (
        "Landing at latitude 0 deg, longitude 0 deg on Didymos. 71 % of landers stay or come down again within 12 h "
        "(90 % interval 68 to 73 %), over the soils of the study file, on beds, places and attitudes that were not in "
        "the study; from 244 landings on 6 beds. On one next bed the share lies between 64 and 77 %. 8 of 252 landings "
        "(3 %), left the bed laterally, have no answer: between 68.5 and 71.8 % of all stay or come down again "
        "within 12 h, if none or all of these do."
    )


def test_bounds_that_are_narrow_beside_the_interval_are_not_in_the_answer(data: SequenceResults) -> None:
    assert "have no answer" not in answer(told(holding(data), returns=RETURNS | {"if_missing": [0.705, 0.712]}))


def test_where_the_site_pushes_outward_landers_come_down_again_and_none_stay(data: SequenceResults) -> None:
    assert "71 % of landers come down again within 12 h" in answer(told(data, returns=RETURNS, runs=RUNS))


def test_one_bed_gives_a_share_and_says_why_it_has_no_interval(data: SequenceResults) -> None:
    words = answer(told(holding(data), returns=RETURNS | ONE_BED, runs=RUNS | {"beds": 1}))
    assert "On this bed: 71 % of landers stay or come down again within 12 h; from" in words
    assert words.endswith("One bed was poured.")
    assert "interval" not in words


def test_sentences_of_the_summary_go_before_those_of_the_page(data: SequenceResults) -> None:
    assert answer(told(data, headline=["All of them stay.", "On 24 beds."])).endswith(
        "on Didymos. All of them stay. On 24 beds."
    )


def test_warnings_name_few_beds_and_an_emulator_that_contradicts_the_runs(data: SequenceResults) -> None:
    few, off = warnings(told(holding(data), returns=RETURNS | {"emulator": 0.8}))
    assert "6 beds" in few
    assert "bed.bed_count to 12 or more" in few
    assert "by it 80 % stay or come down again within 12 h, outside the interval of the runs (90 %: 68 to 73 %)" in off
    said = {"warning": "the emulator gives 80 %, outside of the interval"}
    assert warnings(told(data, emulator=said)) == ["The emulator gives 80 %, outside of the interval."]
    assert warnings(told(holding(data), runs=RUNS | {"beds": 24})) == []


def test_first_screen_has_warnings_and_the_share_with_its_interval(sequence_folder: Path, tmp_path: Path) -> None:
    text = write_changed(sequence_folder, tmp_path, lambda results: results["returns"].update(emulator=0.99))
    head = text[: text.index("<h2>Figures")]
    assert '<p class="warning">The emulator is off: by it 99' in head
    assert re.search(r"<b>\d\d(\.\d)? <small>%</small></b><span>come down again within 12 h \(90 %: \d", head)


def test_caption_of_what_decides_has_the_parts_of_the_speed_with_intervals(data: SequenceResults) -> None:
    words = sequence_captions.variance(told(data, variance_shares={"speed_out": record(), "spin_out": record()}))
    assert words.startswith(
        "Of the scatter of V+, soil accounts for 6 % (1 to 11; most of it friction of the grains), the bed for 3 % "
        "(0 to 15), place and attitude for 91 % (80 to 97) and chaos for 0.4 % (0 to 1) (in brackets 90 % intervals). "
        "Soil accounts for 6 % of omega+."
    )
    assert "below 0" not in words
    assert "twins" not in words


def test_caption_of_what_decides_explains_parts_below_0_and_chaos_without_twins(data: SequenceResults) -> None:
    below = record() | {"bed": {"share": -0.02, "lower": 0.0, "upper": 0.04}, "chaos": None}
    words = sequence_captions.variance(told(data, variance_shares={"speed_out": below}))
    assert "(1 here, as bed of V+)" in words
    assert "each bar adds up to 100 %" in words
    assert "Without twins chaos is not known apart: it is within place and attitude." in words


def rare(**changes: Any) -> dict[str, Any]:
    """What the command writes of a limit state, of which the page reads a part."""
    return {
        "condition": "speed_out > 0.3", "probability": 0.0015, "lower": 4e-4, "upper": 0.005, "origins": 2.4,
        "warning": "Few beds led to it: raise bed.bed_count.", "reached": True, "rarest": 0.0015,
        "thresholds": [1.7, 0.9, 0.0], "shares": [0.1, 0.1, 0.15], "landings": 1400, "beds": 12,
        "statement": "fast: probability .0015.",
    } | changes  # fmt: skip


def test_rare_limit_states_have_their_levels_a_figure_and_a_warning(sequence_folder: Path, tmp_path: Path) -> None:
    never = rare(condition="speed_out > 9", probability=0.0, lower=None, upper=None, origins=0.0, warning=None,
                 reached=False, rarest=2e-6, statement="never: no landing met it.")  # fmt: skip
    folder = tmp_path / "study"
    shutil.copytree(sequence_folder, folder, ignore=shutil.ignore_patterns("report"))
    for name, content in (("fast", rare()), ("never", never)):
        (folder / f"rare_{name}.json").write_text(json.dumps(content), encoding="utf-8")
    text = write_report(folder, lambda done, total: None).read_text(encoding="utf-8")
    assert (folder / "report" / "figure_10_rare.png").stat().st_size > 10_000
    assert '<p class="warning">fast: Few beds led to it: raise bed.bed_count.</p>' in text
    for words in ("0.0015", "4 × 10⁻⁴ to 0.005", "below 2 × 10⁻⁶", "fast: probability .0015."):
        assert words in text
    assert "rare_fast.json" in text
    found = page_results(open_study(folder))
    assert isinstance(found, SequenceResults)
    levels = rare_tables(found.rare)[1].rows
    assert levels[0] == ["fast", "1", "1.70", "10.0 %", "0.1"]
    assert levels[2] == ["", "3", "0.00", "15.0 %", "0.0015"]
    (folder / "rare_fast.json").write_text("{}", encoding="utf-8")
    with pytest.raises(ValueError, match=r"rare_fast\.json .*make it again with: lithobrake rare"):
        write_report(folder, lambda done, total: None)


def test_without_rare_results_the_page_has_nothing_of_them(page: str) -> None:
    assert "are limit state" not in page


def record() -> dict[str, Any]:
    """Parts of the variance that add up to 1."""

    def part(share: float, lower: float, upper: float) -> dict[str, float]:
        return {"share": share, "lower": lower, "upper": upper}

    alone = {"grain.friction": part(0.05, 0.01, 0.09), "grain.restitution": part(0.008, 0.0, 0.02)}
    return {
        "soil": part(0.06, 0.01, 0.11), "soil_by_input": alone, "arrival": None, "bed": part(0.03, 0.0, 0.15),
        "place_and_attitude": part(0.906, 0.8, 0.97), "chaos": part(0.004, 0.003, 0.01),
    }  # fmt: skip


def test_caption_of_the_calibration_counts_what_luck_does_not_explain(data: SequenceResults) -> None:
    narrow = {"pit": [60, 10, 10, 10, 10, 10, 10, 10, 10, 60], "band_90": 0.6}
    emulator = {"statement": "The inputs matter.", "scores": {"speed_out": narrow, "joint": {"energy_skill": 0.1}}}
    words = sequence_captions.calibration(told(data, emulator=emulator))
    assert "held 60 % of V+" in words
    assert "10 of 10 bars lie outside of the grey (orange); luck alone would have it of 1." in words
    assert "The bands of V+ are too narrow for luck alone." in words
    assert words.endswith("The inputs matter.")


def test_caption_of_the_runs_says_what_they_draw_and_how_they_ended(data: SequenceResults) -> None:
    words = sequence_captions.runs(data)
    counts = data.results["runs"]["outcomes"]
    assert words.startswith(
        "Every dot is a landing with soil, place, azimuth and attitude of its own, on one of 12 beds"
    )
    assert f"of 120 landers {counts['clear']} left the surface and {counts['captured']} were captured." in words
    assert "The median of V+ is" in words
    assert f"{counts['left_sideways']} of 120 landings" in words
    assert re.search(r"differ by bed in -?\d+(\.\d)? % \(\d+ to \d+\) of their variance", words)


def test_a_colour_that_says_nothing_is_called_so(data: SequenceResults) -> None:
    alone = told(data, emulator={"follows_inputs": False})
    colour = sequence_tables.colour_input(alone)
    assert "the emulator draws runs whatever the inputs" in sequence_captions.samples(alone, colour)
    assert "whatever the inputs" not in sequence_captions.samples(told(data, emulator={"follows_inputs": True}), colour)


def test_tables_have_every_number_with_its_interval(page: str) -> None:
    for words in (
        "<h3>The answer</h3>", "<h3>Outputs of the landings</h3>", "<h3>Parts of the variance</h3>",
        "<h3>Outcomes of the runs</h3>", "<h3>The emulator on beds left out</h3>", "<h3>After the first bounce</h3>",
        "<td>on one next bed</td>", "<td>of it friction of the grains alone</td>",
        '<td>outgoing speed V+</td><td class="number">9.0 (5.0 to 15.0)</td><td class="number"></td><td>m/s</td>',
        '<td>elevation theta+</td><td class="number"></td><td class="number">0.573 (0.458 to 0.802)</td><td>deg</td>',
        "12 at a place 0.1 mm beside",
        "<td>attitude at impact</td><td>impact.orientation</td>", "50.00 % (47.0 to 53.0)",
    ):  # fmt: skip
        assert words in page
    row = re.search(r"<td>outgoing speed V\+</td><td>m/s</td>(.*?)</tr>", page)
    assert row is not None
    assert len(re.findall(r"\d \([\d.]+ to [\d.]+\)", row[1])) == 4


def test_site_and_grain_sizes_are_no_inputs_of_a_run(data: SequenceResults) -> None:
    law = {"distribution": "uniform", "lower": 0.0, "upper": 360.0}
    study = data.study | {"site": {"heading_deg": law}, "bed": data.study["bed"] | {"diameter": law}}
    inputs = next(one for one in sequence_tables.tables(replace(data, study=study)) if one.columns[-1] == "found")
    assert [row[1] for row in inputs.rows][-3:] == ["impact.region", "impact.azimuth_deg", "impact.orientation"]
    assert {row[1].partition(".")[0] for row in inputs.rows} == {"grain", "impact"}


def test_what_the_emulator_found_stands_beside_the_inputs(data: SequenceResults) -> None:
    found = told(data, emulator={"found_inputs": ["grain.friction"]})
    inputs = next(table for table in sequence_tables.tables(found) if table.title == "Inputs that the runs draw")
    assert {row[1]: row[-1] for row in inputs.rows if row[-1]} == dict.fromkeys(
        ("grain.young_modulus", "grain.restitution", "grain.rolling_friction", "grain.density"), "no"
    ) | {"grain.friction": "yes"}


KEYS = (
    "beds", "ellipses", "emulator", "flights", "outputs", "outputs_of_runs", "rest", "runs", "shares", "site",
    "returns", "variance_shares",
)  # fmt: skip


@pytest.mark.parametrize("absent", [*((key,) for key in KEYS), KEYS], ids=lambda keys: ", ".join(keys))
def test_a_summary_that_lacks_a_table_has_a_page_too(absent: tuple[str, ...], data: SequenceResults) -> None:
    without = told(data, **dict.fromkeys(absent))
    content = sequence_content(replace(without, bed=None, landing=None) if "beds" in absent else without)
    assert len(content.plots) >= 7
    assert all(plot.sentence for plot in content.plots)
    assert content.answer


def test_a_study_without_samples_and_flights_says_what_is_not_drawn(sequence_folder: Path, tmp_path: Path) -> None:
    folder = tmp_path / "runs"
    shutil.copytree(sequence_folder, folder)
    for name in ("samples.h5", "flights.csv", "rest.csv", "body.obj"):
        (folder / name).unlink()
    absent = ("shares", "rest", "ellipses", "flights")
    text = write_changed(folder, tmp_path, lambda results: [results.pop(key) for key in absent])
    assert "The emulator was not sampled" in text
    assert "The folder has no flights of samples" in text
    assert text.count("<img ") == 5


def test_one_bed_has_a_page_without_intervals(sequence_folder: Path, tmp_path: Path) -> None:
    def one_bed(results: dict[str, Any]) -> None:
        results["returns"] |= ONE_BED
        results["runs"]["beds"] = 1
        results["variance_shares"] = dict.fromkeys(results["variance_shares"])
        for table in results["outputs"].values():
            for entry in (table["mean"], *table["quantiles"].values()):
                entry |= {"lower": None, "upper": None}

    text = write_changed(sequence_folder, tmp_path, one_bed)
    assert "The runs cannot tell where the scatter comes from" in text
    assert ", all on one bed" in text
    assert "beds left out" not in text
    assert "of V+ on runs left out lay within" in text
    assert "without intervals: they say nothing of other beds" in text
    assert "without an interval" in text


def write_changed(folder: Path, room: Path, change: Callable[[dict[str, Any]], object]) -> str:
    """The page of a copy of a study whose results are changed."""
    copy = room / "changed"
    shutil.copytree(folder, copy)
    summary = deepcopy(json.loads((copy / "summary.json").read_text(encoding="utf-8")))
    change(summary["results"])
    (copy / "summary.json").write_text(json.dumps(summary), encoding="utf-8")
    return write_report(copy).read_text(encoding="utf-8")


def test_the_landing_is_that_of_the_telling_run(sequence_folder: Path, tmp_path: Path) -> None:
    folder = Path(shutil.copytree(sequence_folder, tmp_path / "study"))
    assert page_results(open_study(folder)).shown_landing == "In the first run"
    shutil.copy(folder / "landing.h5", folder / "telling_landing.h5")
    with h5py.File(folder / "telling_landing.h5", "a") as file:
        file.attrs["run"] = "0123abcd4567"
    found = page_results(open_study(folder))
    begin = "In run 0123abcd, of the median speed of those that leave, the lander arrives at 0.2 m/s"
    assert captions.landing(found).startswith(begin)
