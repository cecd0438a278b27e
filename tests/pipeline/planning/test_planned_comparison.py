"""What a plan says of the difference to another study, before both run and after."""

import json
import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import pytest
import tomli_w
from typer.testing import CliRunner

from lithobrake.analysis.paired_widths import difference_half_width
from lithobrake.cli import app
from lithobrake.pipeline import Plan, compare_studies, plan_comparison, plan_lines, plan_study
from lithobrake.pipeline.commands.planned_comparison import EXPECTED, _difference, _measured
from lithobrake.pipeline.planning.expected_difference import EXPECTED_CORRELATION
from lithobrake.pipeline.planning.planner import PlannedStudy
from lithobrake.study import load_tables

from ...paper_tables import with_keys
from ..journeys.bouncing_lander import journey_tables, run_without_emulator

SCENARIOS = Path(__file__).parents[3] / "scenarios"
Written = Callable[..., Path]


@pytest.fixture
def written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Written:
    """Writes the study of one ground with other keys into the current folder, which is empty."""
    monkeypatch.chdir(tmp_path)

    def write(name: str, scenario: str = "one_ground.toml", **changes: dict[str, object]) -> Path:
        path = tmp_path / name
        path.write_text(tomli_w.dumps(with_keys(load_tables(SCENARIOS / scenario), changes)), encoding="utf-8")
        return path

    return write


def planned(one: Path, two: Path, half_width: float | None = None) -> list[str]:
    plan = plan_comparison(one, Path("runs/one"), two, Path("runs/two"), 1, half_width=half_width)
    return plan_lines(plan)


def test_both_half_widths_and_the_runs_that_one_asks_for(written: Written) -> None:
    one, two = written("light.toml"), written("heavy.toml", lander={"mass": 3.0})
    plan = plan_comparison(one, Path("runs/light"), two, Path("runs/heavy"), 1, half_width=0.04)
    found, alone = plan.difference, plan_study(one, Path("runs/light"), 1)
    assert found is not None
    assert alone.half_width is not None
    width = alone.half_width.median
    assert (found.pairs, found.beds, found.against) == (96, 24, str(two))
    middle, least, most = EXPECTED_CORRELATION["at_rest"]
    assert found.unpaired == pytest.approx(math.sqrt(2.0) * width)
    assert found.in_pairs == pytest.approx(difference_half_width(width, width, middle))
    assert (found.narrow, found.wide) == tuple(difference_half_width(width, width, r) for r in (most, least))
    assert found.asked is not None
    assert found.asked.in_pairs < found.asked.unpaired
    assert found.asked.in_pairs == 4 * found.asked.beds_in_pairs
    assert list(found.gains) == ["at_rest", "time_s_median", "time_s_ratio", "distance_median", "distance_ratio"]
    lines = "\n".join(plan_lines(plan))
    assert f"Difference to {two} (96 pairs on 24 beds): expected half-width of the 90 % interval" in lines
    assert f"For a half-width of 4 points: {found.asked.in_pairs} journeys on" in lines
    assert replace(plan, difference=None).half_width == alone.half_width


def test_a_study_with_fewer_landers_decides_the_pairs(written: Written) -> None:
    one, two = written("light.toml"), written("few.toml", journey={"count": 48}, lander={"mass": 3.0})
    same = plan_comparison(one, Path("a"), written("heavy.toml", lander={"mass": 3.0}), Path("b"), 1).difference
    found = plan_comparison(one, Path("a"), two, Path("b"), 1).difference
    assert found is not None
    assert same is not None
    assert found.pairs == 48
    assert found.unpaired > same.unpaired


def test_first_touchdowns_have_the_return_fraction_alone(written: Written) -> None:
    names = ("first_bounce.toml", "first_bounce.toml")
    one, two = (written(f"{k}.toml", name, lander={"mass": 2.0 + k}) for k, name in enumerate(names))
    found = plan_comparison(one, Path("a"), two, Path("b"), 1).difference
    assert found is not None
    assert list(found.gains) == ["returns"]
    assert (found.runs, found.answer) == ("landings", "the return fraction")


def test_the_command_has_it_in_words_and_as_json(written: Written) -> None:
    one, two = written("light.toml"), written("heavy.toml", lander={"mass": 3.0})
    words = ["plan", str(one), "--against", str(two), "--half-width", "0.05", "--workers", "1"]
    said = CliRunner().invoke(app, words)
    assert said.exit_code == 0, said.output
    assert "points in pairs" in said.stdout
    content = json.loads(CliRunner().invoke(app, [*words, "--json"]).stdout)["difference"]
    assert (content["pairs"], content["asked"]["half_width"]) == (96, 0.05)
    assert set(content["gains"]["at_rest"]) == {"words", "correlation", "least", "most", "ratio", "saved"}
    assert not Path("runs").exists()


@pytest.mark.parametrize(("changes", "said"), [
    ({}, "are the same study"),
    ({"bed": {"bed_count": 12}}, r"cannot be paired: run \d+ has bed .* in B \(bed\); give both the same seed"),
    ({"bed": {"width": [0.6, 0.6]}}, "cannot be paired: run 0 has impact point"),
    ({"journey": {"touchdowns": 3}}, "compare studies with the same journey.touchdowns"),
    ({"limit_states": {"near": "distance < 20"}, "design": {"half_width_of": "near", "half_width": 0.1}},
     r"asks for the fraction at rest and .* for the probability of near \(distance < 20\); give"),
])  # fmt: skip
def test_studies_that_cannot_be_compared_are_refused_before_they_run(
    changes: dict[str, dict[str, object]], said: str, written: Written
) -> None:
    with pytest.raises(ValueError, match=said):
        planned(written("one.toml"), written("two.toml", **changes))


@pytest.mark.parametrize(("more", "said"), [
    (["--half-width", "0.05"], "name the other study with --against"),
    (["--against", "two.toml", "--half-width", "0"], "--half-width is 0; allowed: above 0 to 0.5"),
    (["--against", "two.toml", "--half-width", "5"], "--half-width is 5; allowed: above 0 to 0.5"),
    (["--against", "two.toml", "--half-width", "nan"], "--half-width is nan"),
    (["--against", "two.toml", "--infer"], "two questions"),
    (["--against", "three.toml"], "three.toml"),
    (["--against", "one_bed.toml"], "cannot be paired"),
])  # fmt: skip
def test_odd_questions_are_one_sentence(more: list[str], said: str, written: Written) -> None:
    written("one.toml")
    written("two.toml", lander={"mass": 3.0})
    written("one_bed.toml", bed={"bed_count": 1})
    ended = CliRunner().invoke(app, ["plan", "one.toml", *more])
    assert ended.exit_code == 2
    assert said in " ".join(ended.stderr.split())


def test_one_bed_of_both_and_no_lander_are_refused(written: Written) -> None:
    one, two = (written(f"{k}.toml", bed={"bed_count": 1}, lander={"mass": 2.0 + k}) for k in (0, 1))
    with pytest.raises(ValueError, match="have one bed, which gives no interval"):
        planned(one, two)
    paper = written("paper.toml", "one_place.toml")
    with pytest.raises(ValueError, match="draws no lander"):
        planned(one, paper)


def test_expected_correlations_are_those_of_the_experiment() -> None:
    measured = json.loads((SCENARIOS.parent / "validation" / "pairing.json").read_text(encoding="utf-8"))["expected"]
    rounded = {name: tuple(round(one[end], 1) for end in ("mean", "least", "most")) for name, one in measured.items()}
    assert rounded == EXPECTED_CORRELATION


FASTER = {"speed": {"distribution": "uniform", "lower": 0.08, "upper": 0.16}}


@dataclass(frozen=True)
class FinishedStudy(PlannedStudy):
    """A study of which nothing is left to make."""

    @property
    def plan(self) -> Plan:
        return replace(super().plan, stages=())


def test_pairs_that_were_made_have_their_own_correlation(tmp_path: Path) -> None:
    studies: list[PlannedStudy] = []
    for name, changes in (("slow", {}), ("fast", {"delivery": FASTER})):
        tables = journey_tables(journey={"count": 8}, **changes) | {"seed": 2}
        run_without_emulator(tables, tmp_path / name)
        path = tmp_path / f"{name}.toml"
        path.write_text(tomli_w.dumps(tables), encoding="utf-8")
        fresh = PlannedStudy.of(path, tmp_path / "none", 1)
        studies.append(FinishedStudy(path, tmp_path / name, fresh.tables, fresh.design, 1))
    measured, basis = _measured(studies[0], studies[1])
    compared = compare_studies(studies[0].folder, studies[1].folder)
    assert measured["time_s_median"] == compared.answers["time_s_median"].correlation
    assert basis.startswith(f"Correlations: of the {compared.of} that were made")
    gain = _difference(studies[0], studies[1], None).gains["time_s_median"]
    assert gain.least == gain.correlation == gain.most
    undone = PlannedStudy(studies[0].path, tmp_path / "none", {}, studies[0].design, 1)
    assert _measured(undone, studies[1]) == ({}, EXPECTED)
