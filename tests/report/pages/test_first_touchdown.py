"""The page of first touchdowns: its figures, sentences and tables have the numbers of the summary."""

import json
import math
import re
import shutil
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import h5py
import pytest

from lithobrake.report import write_report
from lithobrake.report.content import Content, PageTable
from lithobrake.report.pages.study_page import study_content
from lithobrake.report.tables.dispersion_tables import parts
from lithobrake.report.tables.limit_state_tables import rare_tables
from lithobrake.results import open_study
from lithobrake.results.model_results import EmulatorScores, JointScore, OutputScore
from lithobrake.results.page_data import PageData, page_results
from lithobrake.results.run_results import OutputDirection, VarianceParts
from lithobrake.statements import captions, touchdowns
from lithobrake.statements.answers import page_answer, page_details, page_tiles, page_warnings
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.number_words import with_interval

ONE_BED: dict[str, Any] = {"next_bed": None, "why": "One bed was poured."}


def changed(data: PageData, **tables: Mapping[str, Any]) -> PageData:
    """The results with other fields, or other entries, in some of their tables."""
    new = {}
    for name, entries in tables.items():
        table = getattr(data.results, name)
        new[name] = {**table, **entries} if isinstance(table, Mapping) else replace(table, **entries)
    return replace(data, results=replace(data.results, **new))


def tables_of(content: Content) -> list[PageTable]:
    """All tables of a page that have a row, which those without do not reach."""
    return [table for section in content.sections for table in section.tables if table.rows]


def table_of(data: PageData, title: str) -> PageTable:
    return next(table for table in tables_of(study_content(data)) if table.title.startswith(title))


def percents(words: str) -> list[float]:
    """The numbers before each per cent sign."""
    return [float(one) for one in re.findall(r"(-?[\d.]+) %", words)]


def test_the_product_of_an_archive_stands_beside_the_body(first: PageData) -> None:
    product = "urn:nasa:pds:rocks:data:rock::3.0"
    assert product in captions.place_words(changed(first, site={"product_id": product}))


def test_every_figure_is_there_with_its_file(first_page: str, first_folder: Path) -> None:
    names = (
        *("map", "outcomes", "body", "hard_ground", "variance", "calibration", "runs", "outputs", "landing"),
        "bed",
    )
    files = {path.name for path in (first_folder / "report").glob("*.png")}
    assert files == {f"figure_{number}_{name}.png" for number, name in enumerate(names, start=1)}
    assert len(re.findall(r'<img alt="[^"]+" src="data:image/svg\+xml;base64,', first_page)) == len(names)


def test_the_sections_stand_in_the_order_of_their_questions(first_page: str) -> None:
    contents = re.search(r"<nav.*?</nav>", first_page)
    order = ["Answer", "Where", "When", "Why", "How sure", "Method", "Appendix", "Files"]
    assert re.findall(r">([^<]+)</a>", contents[0]) == order
    assert re.findall(r"<h2>([^<]+)</h2>", first_page) == order[1:]
    assert all(f'id="{link}"' in first_page for link in re.findall(r'href="#([^"]+)"', contents[0]))


def test_the_page_opens_with_the_answer_of_the_summary(first: PageData) -> None:
    returns, words = first.results.returns, page_answer(first)
    assert words.startswith(with_interval(returns.share, level=first.level))
    assert words.count(".") == words.rstrip(".").count(".") + 1
    assert words.partition(" of the landings ")[2].rstrip(".") in first.results.answer[0]


def test_the_answer_stands_once_on_the_page(first: PageData) -> None:
    share = with_interval(first.results.returns.share).partition(" ")[2]
    content = study_content(first)
    assert share.removeprefix("% (") in content.answer
    said = [tile.words for tile in content.tiles] + [content.first.sentence if content.first else ""]
    said += [words for section in content.sections for words in section.said]
    said += [plot.sentence for section in content.sections for plot in section.plots]
    assert not [words for words in said if share.removeprefix("% (") in words]
    from_ = first.results.returns.from_
    assert f"The fractions are from {from_} and hold over the input distributions" in page_details(first)


def test_the_share_has_its_interval_in_the_sentence(first: PageData) -> None:
    words, share = page_answer(first), first.results.returns.share
    assert percents(words)[:2] == [round(100 * share.value), 90.0]
    assert f"{100 * share.lower:.0f}-{100 * share.upper:.0f} %" in words
    narrow = {"share": replace(share, lower=share.value - 0.004, upper=share.value + 0.004)}
    assert page_answer(changed(first, returns=narrow)).startswith(f"{100 * share.value:.1f} %")


def test_tiles_have_the_numbers_behind_the_sentence(first: PageData) -> None:
    rests, speed, *_ = page_tiles(first)
    median = first.results.spreads["speed_out"].quantiles["0.5"]
    assert (rests.unit, speed.unit) == ("%", "cm/s")
    assert float(speed.value) == pytest.approx(100 * median.value, rel=0.005)
    assert f"90 % interval {100 * median.lower:.3g} to {100 * median.upper:.3g}" in speed.words


def test_warnings_name_few_beds_and_what_the_summary_warns_of(first: PageData) -> None:
    gravity = first.results.site.gravity_warning
    lost, last = page_warnings(changed(first, emulator={"warning": None}))
    assert lost[:-1] == first.results.runs.warning
    assert last[1:-1] in gravity
    few = page_warnings(changed(first, emulator={"warning": "the emulator is off"}, runs={"beds": 6}))
    assert [words[:20] for words in few[1:3]] == ["The study has only 6", "The emulator is off."]
    calm = changed(first, site={"gravity_warning": None}, emulator={"warning": None}, runs={"warning": None})
    assert page_warnings(calm) == []
    assert page_warnings(changed(calm, site={"cautions": ("One path.",)})) == ["One path."]


def test_the_first_warning_of_the_page_is_that_of_missing_landings(first: PageData, first_page: str) -> None:
    warning = re.search(r'<p class="warning">(.*?)</p>', first_page)
    assert warning[1][:-1].replace("&nbsp;", " ") == first.results.runs.warning


def test_answer_tables_and_figure_have_one_value_of_the_return_fraction(first: PageData) -> None:
    returns = first.results.returns
    share, held = (
        f"{100 * returns.share.value:.0f} %",
        f"{100 * returns.share.lower:.0f}-{100 * returns.share.upper:.0f} %",
    )
    rows = table_of(first, "Return fraction").rows
    outcomes = {row[0]: row[1:] for row in table_of(first, "After the first touchdown").rows}
    assert rows[0][1] == share
    assert rows[1][1] == held
    (one,) = [cells for words, cells in outcomes.items() if words.startswith("return fraction")]
    assert one == [f"{share} ({held})", f"{100 * returns.emulator:.0f} %"]
    assert share in page_answer(first)


def test_the_outcomes_of_the_runs_add_up_and_each_stands_once(first: PageData) -> None:
    table, shares = table_of(first, "After the first touchdown"), first.results.shares.outcomes
    assert len({row[0] for row in table.rows}) == len(table.rows)
    whole = parts(first)
    assert sum(shares[key].share.value for key in whole) == pytest.approx(1.0)
    assert [row[1] for row in table.rows[: len(whole)]] == [with_interval(shares[key].share) for key in whole]
    outward = changed(first, site={"effective_acceleration_outward": 1e-5})
    assert not any(row[0].startswith("return fraction") for row in table_of(outward, "After the first touchdown").rows)


def test_a_prediction_interval_for_a_new_bed_has_the_size_of_the_bed(first: PageData) -> None:
    low, high = first.results.returns.next_bed or (0.0, 0.0)
    row = next(row for row in table_of(first, "Return fraction").rows if "new bed" in row[0])
    assert row == ["prediction interval for a new bed of 0.55 x 0.55 m", f"{100 * low:.0f}-{100 * high:.0f} %"]
    assert "new bed" not in page_answer(first)


def test_the_sentence_on_the_variance_has_every_part_with_its_interval() -> None:
    words = touchdowns.output_variance("speed_out", record())
    for shown in ("at least 6 % (1-11 %; most", "3 % (0-15 %)", "everything else 91 % (80-97 %)", "0.4 % (0.3-1.0 %)"):
        assert shown in words
    assert "friction of the grains" in words


def test_the_caption_of_the_variance_repeats_no_number_of_its_figure(first: PageData) -> None:
    words = touchdowns.variance(changed(first, variance_shares={"speed_out": record(), "spin_out": record()}).results)
    assert len(re.findall(r"\d %", words)) == 2
    assert "twice as wide (the rebound speed): at least 20 % (4-33 %)" in words


def rare(**changes: Any) -> dict[str, Any]:
    """What the command writes of a limit state, of which the page reads a part."""
    return {
        "condition": "speed_out > 0.3", "probability": 0.0015, "lower": 4e-4, "upper": 0.005, "origins": 2.4,
        "warning": "Few beds led to it: raise bed.bed_count.", "reached": True, "rarest": 0.0015,
        "thresholds": [1.7, 0.9, 0.0], "shares": [0.1, 0.1, 0.15], "landings": 1400, "beds": 12,
        "level": 0.9, "statement": "fast: probability 0.0015.",
    } | changes  # fmt: skip


def test_rare_limit_states_have_their_levels_a_figure_and_a_warning(first_folder: Path, tmp_path: Path) -> None:
    never = rare(condition="speed_out > 9", probability=0.0, lower=None, upper=None, origins=0.0, warning=None,
                 reached=False, rarest=2e-6, statement="never: no landing met it.")  # fmt: skip
    folder = tmp_path / "study"
    shutil.copytree(first_folder, folder, ignore=shutil.ignore_patterns("report"))
    for name, content in (("fast", rare()), ("never", never)):
        (folder / f"rare_{name}.json").write_text(json.dumps(content), encoding="utf-8")
    found = page_results(open_study(folder))
    content = study_content(found)
    assert "fast: Few beds led to it: raise bed.bed_count." in content.warnings
    plot = next(plot for plot in content.plots if plot.name == "rare")
    figure = plot.draw()
    assert len(figure.axes[0].lines) >= 2
    probabilities, levels = rare_tables(found.rare)
    assert probabilities.rows[0][2:4] == ["0.0015", "4 × 10⁻⁴ to 0.005"]
    assert probabilities.rows[1][2] == "below 2 × 10⁻⁶"
    assert levels.rows[0] == ["fast", "1", "1.70", "10.0 %", "0.1"]
    assert levels.rows[2] == ["", "3", "0.00", "15.0 %", "0.0015"]
    (folder / "rare_fast.json").write_text("{}", encoding="utf-8")
    with pytest.raises(ValueError, match=r"rare_fast\.json .*make it again with: lithobrake rare"):
        write_report(folder, lambda done, total: None)


def record() -> VarianceParts:
    """Parts of the variance that add up to 1."""
    alone = {"grain.friction": Estimate(0.05, 0.01, 0.09), "grain.restitution": Estimate(0.008, 0.0, 0.02)}
    return VarianceParts(
        soil=Estimate(0.06, 0.01, 0.11), soil_doubled=Estimate(0.2, 0.04, 0.33), terms="terms of first degree",
        soil_by_input=alone, arrival=None, attitude=None,
        bed=Estimate(0.03, 0.0, 0.15), place=Estimate(0.906, 0.8, 0.97),
        chaos=Estimate(0.004, 0.003, 0.01), of="the landings",
    )  # fmt: skip


def test_the_caption_of_the_calibration_counts_what_luck_does_not_explain(first: PageData) -> None:
    narrow = OutputScore(0.1, 0.6, (60, 10, 10, 10, 10, 10, 10, 10, 10, 60))
    scores = EmulatorScores(JointScore(0.1), {"speed_out": narrow})
    words = touchdowns.calibration(changed(first, emulator={"scores": scores}).results.emulator, 12)
    assert percents(words)[:2] == [90.0, 60.0]
    assert "10 of 10 bars" in words
    assert words.endswith(first.results.emulator.statement)


def test_the_caption_of_the_runs_has_their_outcomes_and_quantiles(first: PageData) -> None:
    words, runs = touchdowns.runs(first), first.results.runs
    for number in (runs.count, runs.beds, *runs.outcomes.values()):
        assert re.search(rf"\b{number}\b", words)
    median = first.results.spreads["speed_out"].quantiles["0.5"]
    for end in (median.value, *median.bounds):
        assert f"{100 * end:.3g}" in words


def test_every_output_of_the_runs_has_its_numbers_and_their_intervals(first: PageData) -> None:
    table, speed = table_of(first, "Outputs of the landings"), first.results.spreads["speed_out"]
    row = next(row for row in table.rows if row[1] == "m/s")
    assert row[2] == f"{speed.mean.value:.3g} ({speed.mean.lower:.3g} to {speed.mean.upper:.3g})"
    assert sum(" to " in cell for cell in row) == 4


def test_an_azimuth_has_a_direction_and_a_resultant_length(first: PageData) -> None:
    mean = Estimate(math.radians(5.0), math.radians(-10.0), math.radians(20.0))
    azimuth = OutputDirection(mean, Estimate(0.2, 0.1, 0.3), "the landings")
    table = table_of(changed(first, outputs={"azimuth_out": azimuth}), "Directions of the landings")
    assert table.rows == [["azimuth out", "5.00 (-10 to 20)", "0.200 (0.1 to 0.3)"]]
    assert not any(one.title.startswith("Directions") for one in tables_of(study_content(first)))


def test_touchdowns_without_a_bed_have_a_page_without_one(first: PageData) -> None:
    alone = replace(first, bed=None, landing=None, results=replace(first.results, beds=()))
    content = study_content(alone)
    assert "Beds" not in {table.title for table in tables_of(content)}
    rows = table_of(alone, "Return fraction").rows
    assert next(row for row in rows if "new bed" in row[0])[0] == "prediction interval for a new bed"
    assert "landing" not in {plot.name for plot in content.plots}


def test_side_runs_have_their_numbers(first: PageData) -> None:
    table, side = table_of(first, "Side runs"), first.results.runs.side_runs
    assert re.findall(r"\d+", table.note)[:2] == [str(side.soil_pairs), str(side.twins)]
    assert float(table.rows[0][2].split()[0]) == pytest.approx(side.chaos_deviation["speed_out"].value, rel=5e-3)
    without = changed(first, runs={"side_runs": None})
    assert not [one for one in tables_of(study_content(without)) if one.title == "Side runs"]


def test_site_and_grain_sizes_are_no_inputs_of_a_run(first: PageData) -> None:
    law = {"distribution": "uniform", "lower": 0.0, "upper": 360.0}
    study = first.study | {
        "site": first.study["site"] | {"heading_deg": law}, "bed": first.study["bed"] | {"diameter": law},
    }  # fmt: skip
    inputs = table_of(replace(first, study=study), "Sampled inputs")
    assert [row[1] for row in inputs.rows][-3:] == ["impact.region", "impact.azimuth_deg", "impact.orientation"]
    assert {row[1].partition(".")[0] for row in inputs.rows} == {"grain", "impact"}


def test_what_the_emulator_found_stands_beside_the_inputs(first: PageData) -> None:
    found = changed(first, emulator={"found_inputs": ["grain.friction"]})
    told = {row[1]: row[-1] for row in table_of(found, "Sampled inputs").rows if row[-1]}
    assert told.pop("grain.friction") == "yes"
    assert set(told.values()) == {"no"}


def test_one_bed_has_a_page_without_intervals(first: PageData) -> None:
    def bare(entry: Estimate) -> Estimate:
        return replace(entry, lower=None, upper=None)

    outputs = {
        name: replace(
            table, mean=bare(table.mean), quantiles={level: bare(one) for level, one in table.quantiles.items()}
        )
        for name, table in first.results.spreads.items()
    }
    shares = dict.fromkeys(first.results.variance_shares)
    returns = {**ONE_BED, "share": bare(first.results.returns.share)}
    alone = changed(first, returns=returns, runs={"beds": 1}, variance_shares=shares)
    content = study_content(replace(alone, results=replace(alone.results, outputs=outputs)))
    answer, outputs_table = (
        next(one for one in tables_of(content) if one.title.startswith(title))
        for title in ("Return fraction", "Outputs")
    )
    assert not any("interval" in row[0] for row in answer.rows)
    assert answer.note.startswith(ONE_BED["why"])
    assert not any(" to " in cell for row in outputs_table.rows for cell in row)
    assert next(plot for plot in content.plots if plot.name == "variance").draw() is None
    assert not any("held-out beds" in table.title for table in tables_of(content))


def test_what_a_study_has_not_is_left_out(first: PageData) -> None:
    results = replace(first.results, samples=None, emulator=None, hard_ground={}, limit_states={})
    content = study_content(replace(first, landing=None, samples=None, hard_ground={}, results=results))
    assert not {plot.name for plot in content.plots} & {
        "map",
        "landing",
        "body",
        "hard_ground",
        "outputs",
        "calibration",
    }
    titles = {table.title for table in tables_of(content)}
    assert not titles & {"Journeys on other ground", "On other ground", "Smallest regions", "Limit states"}
    (table,) = (one for one in tables_of(content) if one.title == "After the first touchdown")
    assert len(table.columns) == 2
    assert {len(row) for row in table_of(replace(first, results=results), "Sampled inputs").rows} == {4}
    assert [one.html for section in content.sections for one in section.live if 'class="explorer"' in one.html] == []


def test_the_landing_is_that_of_the_telling_run(first_folder: Path, tmp_path: Path) -> None:
    folder = Path(shutil.copytree(first_folder, tmp_path / "study"))
    shutil.copy(folder / "landing.h5", folder / "telling_landing.h5")
    with h5py.File(folder / "telling_landing.h5", "a") as file:
        file.attrs["run"] = "0123abcd4567"
    words = captions.landing(page_results(open_study(folder)))
    assert words.startswith("In run 0123abcd,")
    assert "0.2 m/s" in words
