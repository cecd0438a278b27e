"""Journeys where the ground is unknown: which bed a lander meets, and what the answer says of it."""

import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import lithobrake
from lithobrake.pipeline.commands.one_lander import landing_inputs
from lithobrake.pipeline.design import bed_grounds
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.inferred_study import InferredStudy
from lithobrake.report.plotted_study import PlottedStudy
from lithobrake.results import StudyResults
from lithobrake.study import check_tables, load_tables
from lithobrake.vocabulary.number_words import with_interval
from lithobrake.vocabulary.quantities import GROUND_KIND, GROUND_SIZE

from ..few_terms import fewest_terms
from .bouncing_lander import run_without_emulator

QUICK = Path(__file__).parents[3] / "scenarios" / "quick.toml"
KINDS: dict[str, Any] = {
    "gravel": {"weight": 0.75, "grain_size": {"distribution": "log_uniform", "lower": 0.08, "upper": 0.4}},
    "rock": {"weight": 0.25, "rock": True, "grain": {"friction": 0.6}},
}
MINUTE = 60.0


def tables(**ground: Any) -> dict[str, Any]:
    found = load_tables(QUICK)
    found["journey"] |= {"count": 72, "emulated_count": 0, "duration": 40_000.0}
    return found | {"bed": {"bed_count": 12}, "ground": {"kind": KINDS} | ground, "hard_ground": {"count": 0}}


def touchdown(inputs: dict[str, float], seed: int) -> dict[str, Any]:
    """A lander hops on rock and on coarse gravel, and stays elsewhere for a time that goes with the size of grains."""
    speed, size = inputs["impact.speed"], inputs[GROUND_SIZE]
    if size < 0.2 or speed < 0.03:
        duration = 100.0 * MINUTE * size * math.exp(0.2 * math.sin(seed))
        return {"outcome": "captured", "outputs": {"duration": duration, "contacts": 2.0}}
    along = {"velocity_out_x": 0.3 * speed, "velocity_out_y": 0.1 * speed, "velocity_out_z": 0.5 * speed}
    return {"outputs": along | {"spin_out": 0.01, "duration": 60.0}}


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> PlottedStudy:
    with fewest_terms():
        return lithobrake.run(tables(), tmp_path_factory.mktemp("ground") / "out", workers=1, model=touchdown)


def test_every_touchdown_reads_the_ground_of_its_bed(found: StudyResults) -> None:
    grounds = DrawnDesign(check_tables(tables(), QUICK.parent)).grounds.each
    assert len(found.ledger) > 72
    for record in found.ledger:
        own = grounds[int(record.inputs["bed"])]
        assert (record.inputs[GROUND_KIND], record.inputs[GROUND_SIZE]) == (own.number, own.size)
        assert own.kind == "gravel" or record.inputs["grain.friction"] == 0.6
    # One ground everywhere: whatever a lander does, it stays on its bed.
    beds = {int(record.inputs["journey"]): set[float]() for record in found.ledger}
    for record in found.ledger:
        beds[int(record.inputs["journey"])].add(record.inputs["bed"])
    assert {len(one) for one in beds.values()} == {1}


def test_the_answer_holds_over_grounds_and_on_each_kind(found: StudyResults) -> None:
    results = found.results
    over, kinds, curve = results.over_grounds, results.grounds, results.ground_curve
    assert over is not None
    assert curve is not None
    assert list(kinds) == ["gravel", "rock"]
    assert sum(kind.journeys for kind in kinds.values()) == 72
    assert sum(bed.journeys for bed in curve.beds) == 72
    # On gravel of 8 to 20 cm landers rest after 8 to 20 min, on coarser ground after hops: no interval of one ground
    # can be as narrow as that of the mean over grounds.
    rest = results.rest
    assert rest is not None
    median = rest.time_s.median
    assert over.time_s.value == median.value
    assert over.time_s.lower is not None
    assert median.lower is not None
    assert over.time_s.lower < median.lower
    times = [bed.time_s for bed in curve.beds if bed.time_s is not None]
    assert np.mean([(over.time_s.lower <= one <= (over.time_s.upper or 0.0)) for one in times]) > 0.75
    first, last = curve.time_s[0].value, curve.time_s[-1].value
    assert first < last
    assert "over the grounds that the study allows" in results.answer[0]
    said = " ".join(results.answer)
    assert "One ground of these gives, with 90 % probability" in said
    assert "By kind of ground: gravel (75 %" in said
    # What tells grounds apart comes first among the inputs.
    parts = results.end_variance_shares["time_s"]
    assert parts is not None
    assert list(parts.soil_by_input)[:2] == [GROUND_KIND, GROUND_SIZE]
    # Of two kinds of different sizes either may be found at the other.
    assert max(parts.soil_by_input[name].value for name in (GROUND_KIND, GROUND_SIZE)) > 0.1


def test_the_page_shows_the_answer_against_the_size_of_the_grains(found: StudyResults) -> None:
    page = (found.folder / "report" / "index.html").read_text(encoding="utf-8")
    assert "The answer against the size of the grains" in page
    assert "By kind of ground" in page
    assert "one of these, unknown which" in page
    # Side by side at the top, the finest beds among them, and in no boxes there.
    header, finer = page[: page.index("</header>")], found.results.finer_ground
    assert re.findall(r'<th scope="row">([\w ]+) <small>', header) == ["gravel", "rock", "finest", "one of these"]
    assert 'class="tiles"' not in header
    assert finer is not None
    curve = found.results.ground_curve
    assert curve is not None
    assert finer.journeys == sum(bed.journeys for bed in curve.beds if bed.grain_size_m == finer.finest_m) > 0
    assert finer.at_rest is not None
    assert f"<b>{with_interval(finer.at_rest.share).split(' %')[0]}</b>" in header


def test_the_figure_of_the_grounds_is_drawn_by_its_name(found: PlottedStudy) -> None:
    assert "grounds" in dir(found.plot)
    curve = found.results.ground_curve
    assert curve is not None
    drawn = found.plot.grounds().axes[0].lines[0]
    assert drawn.get_xdata() == pytest.approx(curve.grain_size_m)
    assert drawn.get_ydata() == pytest.approx([100.0 * one.value for one in curve.at_rest])


def test_on_patchy_ground_a_lander_that_hops_meets_other_beds(tmp_path: Path) -> None:
    patchy = tables(unknown="patchy", patch=0.05)
    patchy["journey"]["count"] = 36
    found = run_without_emulator(patchy, tmp_path / "out", touchdown)
    later = [record for record in found.ledger if record.inputs["touchdown"] > 0.0]
    first = {int(one.inputs["journey"]): one.inputs["bed"] for one in found.ledger if one.inputs["touchdown"] == 0.0}
    others = [record.inputs["bed"] != first[int(record.inputs["journey"])] for record in later]
    # Of twelve beds one is the same by chance.
    assert np.mean(others) > 0.8
    assert found.results.over_grounds is None
    assert list(found.results.grounds) == ["gravel", "rock"]
    assert "over the grounds" not in found.results.answer[0]


def test_regions_and_steep_ground_have_their_kinds(monkeypatch: pytest.MonkeyPatch) -> None:
    everywhere = {"everywhere": {"latitude_deg": [-90.0, 90.0], "ground": "rock"}}
    design = DrawnDesign(check_tables(tables() | {"soil": everywhere}, QUICK.parent))
    assert {row[GROUND_KIND] for row in design.rows} == {1.0}
    # Impact points lie within the bed that a lander has got.
    for row in design.rows:
        (west, east), _ = design.grounds.region(int(row["bed"])) or ((0.0, 0.0), (0.0, 0.0))
        assert west <= row["impact.place.x"] <= east
    plain = DrawnDesign(check_tables(tables(), QUICK.parent)).grounds
    shape = plain.site.body.shape
    slopes = plain._soils._slopes_deg(np.arange(len(shape.faces)))
    centres = shape.corners.mean(axis=1)
    steep, flat = centres[slopes.argmax()], centres[slopes.argmin()]
    # Dimorphos as an ellipsoid is nowhere steeper than soil holds.
    assert 5.0 < slopes.max() < bed_grounds.STEEPEST_DEG
    monkeypatch.setattr(bed_grounds, "STEEPEST_DEG", 5.0)
    gravel = next(number for number, one in enumerate(plain.each) if one.kind == "gravel")
    assert plain.each[plain.bed_at(0, gravel, steep, steep)].kind == "rock"
    assert plain.bed_at(0, gravel, flat, flat) == gravel


def test_a_landing_on_another_bed_has_the_ground_of_that_bed() -> None:
    study = check_tables(tables(), QUICK.parent)
    grounds = DrawnDesign(study).grounds.each
    other = next(number for number, one in enumerate(grounds) if one.kind == "rock")
    values = landing_inputs(study, [f"bed={other}", "grain.restitution=0.5"])
    assert (values[GROUND_SIZE], values["grain.friction"], values["grain.restitution"]) == (
        grounds[other].size,
        0.6,
        0.5,
    )
    with pytest.raises(ValueError, match=r"--set bed is 12; allowed with \[ground\]: 0 to 11"):
        landing_inputs(study, ["bed=12"])
    with pytest.raises(ValueError, match=r"which no landing of this study uses"):
        landing_inputs(study, [f"{GROUND_SIZE}=0.3"])


def test_what_holds_for_one_ground_alone_is_refused_over_several(found: StudyResults) -> None:
    with pytest.raises(ValueError, match=r"has \[ground\], and bounces tell the soil of one ground"):
        InferredStudy.open(found.folder)


def test_landers_of_the_emulator_have_the_grounds_of_the_beds_that_there_are() -> None:
    """A study of more landers would have more beds where its file does not count them; these were never poured."""
    found = tables()
    del found["bed"]["bed_count"]
    design = DrawnDesign(check_tables(found, QUICK.parent))
    count = design.study.bed_count
    more = design.on_known_beds(400)
    assert design.with_run_count(400).study.bed_count > count
    assert {int(row["bed"]) for row in more.rows} == set(range(count))
    assert more.rows[:72] == design.rows
    assert all(row[GROUND_SIZE] == design.grounds.each[int(row["bed"])].size for row in more.rows)
    # A study that goes on until its interval is met has all beds of its landers.
    longer = design.with_run_count(400)
    assert {int(row["bed"]) for row in longer.rows} == set(range(longer.study.bed_count))
