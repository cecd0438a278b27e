"""Subset simulation with landings of a study: a probability in closed form under noise, and one that was stopped."""

import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy import stats
from typer.testing import CliRunner

from lithobrake.campaign import Record
from lithobrake.cli import app
from lithobrake.pipeline import rare_failure
from lithobrake.pipeline.runs.solver import function_identity
from lithobrake.results import open_study
from lithobrake.study import StudySource

from ..synthetic_lander import SOIL, synthetic_tables

# The logarithm of the speed is normal: friction and place have these parts of its standard deviation, noise the rest.
OF_FRICTION, OF_PLACE = 0.6, 0.7
SPREAD, MIDDLE = 0.3, 0.1
RARE = 1e-3
LIMIT = MIDDLE * math.exp(SPREAD * stats.norm.isf(RARE))
CONDITIONS = {
    "fast": f"speed_out > {LIMIT!r}", "never": "speed_out > 10", "gone": "not returns",
    "hard": "peak_acceleration > 50",
}  # fmt: skip


@dataclass(frozen=True)
class NoisyLander:
    """Leaves at a speed that friction, place and noise make; a tenth are lost where `lost` is true."""

    lost: bool = False

    def __call__(self, values: dict[str, float], seed: int) -> dict[str, Any]:
        """Land once."""
        law, random = SOIL["grain.friction"], np.random.default_rng(seed)
        rough = (values["grain.friction"] - law["lower"]) / (law["upper"] - law["lower"])
        # The synthetic study draws places within 0.1 m of the middle.
        beside = (values["impact.place.x"] + 0.1) / 0.2
        score = OF_FRICTION * stats.norm.ppf(rough) + OF_PLACE * stats.norm.ppf(beside)
        noise = math.sqrt(1.0 - OF_FRICTION**2 - OF_PLACE**2) * random.standard_normal()
        speed = MIDDLE * math.exp(SPREAD * float(score + noise))
        if self.lost and random.random() < 0.1:
            return {"outcome": "left_sideways"}
        spin = {f"spin_out_{axis}": 0.0 for axis in "xyz"}
        velocity = {"velocity_out_x": 0.0, "velocity_out_y": 0.0, "velocity_out_z": speed}
        return {"outcome": "clear", "outputs": {**velocity, **spin, "contact_duration": 0.1}}


class StoppedError(Exception):
    """Raised in the middle of the landings."""


class Stopping:
    """Shows nothing, and stops after some looks at the landings."""

    def __init__(self, looks: int) -> None:
        self.looks, self.said = looks, []

    def begin(self, title: str, number: int, count: int) -> None:
        """Show nothing."""

    def progress(self, done: float, total: float, what: str, detail: str = "", /) -> None:
        """Count a look at the landings."""
        self.looks -= what.startswith("fast")
        if self.looks == 0:
            raise StoppedError

    def say(self, sentence: str) -> None:
        """Keep a sentence."""
        self.said.append(sentence)


def rare(out: Path, name: str = "fast", model: NoisyLander | None = None, **options: Any) -> dict[str, Any]:
    model = model or NoisyLander()
    tables = synthetic_tables(limit_states=CONDITIONS)
    tables["bed"]["bed_count"] = 15
    source = StudySource.of_tables(tables, function_identity(model))
    return rare_failure(source, out, name, **{"landing_count": 200, "worker_count": 1, "model": model, **options})


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("rare") / "out"
    rare(out)
    return out


def test_the_interval_holds_a_probability_that_is_known_under_noise(folder: Path) -> None:
    found = json.loads((folder / "rare_fast.json").read_text(encoding="utf-8"))
    assert found["lower"] < RARE < found["upper"]
    assert 0.0 < found["coefficient_of_variation"] < 1.0
    assert found["landings"] == 200 + (found["levels"] - 1) * 180
    assert found["levels"] in (3, 4)
    assert found["thresholds"] == sorted(found["thresholds"], reverse=True)
    assert math.prod(found["shares"]) == pytest.approx(found["probability"])
    # Fast landers stand on rough soils.
    assert found["inputs"]["grain.friction"]["median"] > 0.8
    assert found["statement"].startswith("fast (speed_out > ")
    assert f"by {found['landings']} landings in {found['levels']} levels" in found["statement"]


def test_few_beds_that_led_to_all_of_it_are_warned_of(folder: Path) -> None:
    found = json.loads((folder / "rare_fast.json").read_text(encoding="utf-8"))
    assert 1.0 <= found["origins"] < 3.0
    assert f"descend from few beds (effective number {found['origins']:.1f})" in found["warning"]
    assert found["statement"].endswith("raise bed.bed_count.")


def test_one_that_is_stopped_ends_with_the_same_bits_and_makes_no_landing_twice(folder: Path, tmp_path: Path) -> None:
    def ended() -> dict[str, Record]:
        return {one.key: one for one in open_study(tmp_path / "out").ledger if one.ended}

    with pytest.raises(StoppedError):
        rare(tmp_path / "out", shown=Stopping(300))
    before, shown = ended(), Stopping(-1)
    found = rare(tmp_path / "out", shown=shown)
    assert 200 < len(before) < found["landings"]
    after = ended()
    assert {key: after[key] for key in before} == before
    assert (tmp_path / "out" / "rare_fast.json").read_bytes() == (folder / "rare_fast.json").read_bytes()
    assert f"{len(before)} of {found['landings']} landings are known and reused" in shown.said
    assert any("random beyond its inputs" in sentence for sentence in shown.said)


def test_its_landings_are_counted_as_what_they_are(folder: Path) -> None:
    landings = json.loads((folder / "rare_fast.json").read_text(encoding="utf-8"))["landings"]
    said = CliRunner().invoke(app, ["status", str(folder)]).stdout
    assert f"{landings} more runs in the ledger are landings of lithobrake rare: fast" in said
    assert "earlier settings" not in said
    runs = json.loads(CliRunner().invoke(app, ["status", str(folder), "--json"]).stdout)["runs"]
    assert (runs["of_rare"], runs["of_earlier_settings"], runs["total"]) == ({"fast": landings}, 0, 0)


def test_landings_without_a_known_end_are_counted_and_said(tmp_path: Path) -> None:
    found = rare(tmp_path / "out", model=NoisyLander(lost=True), landing_count=50)
    assert 0.05 < found["without_known_end"] / found["landings"] < 0.2
    assert "with unknown outcome count as not meeting it" in found["statement"]


def test_what_never_happens_is_not_looked_for_without_end(tmp_path: Path) -> None:
    found = rare(tmp_path / "out", "never", landing_count=20)
    assert (found["probability"], found["reached"], found["warning"]) == (0.0, False, None)
    assert found["levels"] <= 6
    assert found["inputs"]["grain.friction"]["median"] is None
    assert found["landings"] <= 20 + 6 * 18
    assert "no landing met it down to the last level, a probability of" in found["statement"]


@pytest.mark.parametrize(("name", "count", "words"), [
    ("slow", 200, r"NAME is 'slow'; allowed: a name of \[limit_states\] \(fast, never, gone, hard\)"),
    ("gone", 200, r"limit_states\.gone uses returns, which is true or false"),
    ("hard", 20, r"limit_states\.hard uses peak_acceleration, which no landing has"),
    ("fast", 25, r"--landings is 25; allowed: multiples of 10 from 20"),
])  # fmt: skip
def test_what_has_no_levels_is_refused(name: str, count: int, words: str, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=words):
        rare(tmp_path / "out", name, landing_count=count)


def test_the_command_refuses_before_beds_are_poured(tmp_path: Path) -> None:
    study = tmp_path / "study.toml"
    CliRunner().invoke(app, ["new", str(study)])
    said = CliRunner().invoke(app, ["rare", str(study), "fast", "--out", str(tmp_path / "out")])
    assert (said.exit_code, (tmp_path / "out").exists()) == (2, False)
