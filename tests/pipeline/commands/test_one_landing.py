"""One landing or journey from a study file is the run of that number; and subset simulation with landings."""

import json
import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
from scipy import stats
from typer.testing import CliRunner

from lithobrake.campaign import Record, read_records
from lithobrake.cli import app
from lithobrake.compilation.disk_cache import DiskCache
from lithobrake.pipeline import OneJourney, follow_one, land_one, landing_inputs, rare_failure, run_study
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.job import Silent
from lithobrake.pipeline.runs.solver import function_identity
from lithobrake.pipeline.site import Site, with_site_gravity
from lithobrake.results import StudyResults, open_study
from lithobrake.study import StudySource, read_study
from lithobrake.touchdown import bed_library, land
from lithobrake.touchdown.lander_model import lander
from lithobrake.touchdown.touchdown_model import landing
from lithobrake.vocabulary.outcomes import JourneyEnd

from ...few_grains import few_grains
from ..synthetic_lander import SOIL, synthetic_tables
from .soil_journeys import SOIL_JOURNEYS

REGION = "region = { x = [-0.03, 0.03], y = [-0.02, 0.02] }\n"
TEXT = f"{few_grains(30, 0.54, 0.05)}{REGION}[journey]\ntouchdowns = 1\n"


@pytest.fixture(scope="module", autouse=True)
def library(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Several of these tests land on the same beds, which are poured once."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("LITHOBRAKE_CACHE", str(tmp_path_factory.mktemp("beds")))
        beds = DiskCache("beds", "beds", 10**9)
        assert beds.folder is not None
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(bed_library, "_library", lambda size: beds)
        yield


@pytest.fixture
def study_file(tmp_path: Path) -> Path:
    path = tmp_path / "ten.toml"
    path.write_text(TEXT)
    return path


def test_the_landing_of_a_number_is_that_run_but_for_what_is_changed(study_file: Path) -> None:
    study = read_study(study_file)
    plain = land_one(study, landing_inputs(study, number=1))
    changed = land_one(study, landing_inputs(study, ["grain.friction=0.55", "impact.speed = 0.3"], 1))
    row = DrawnDesign(study).rows[1]
    assert plain.values == row
    assert changed.values == {**row, "grain.friction": 0.55, "impact.speed": 0.3}
    again = land(plain.bed, lander(study, row), landing(study, row))
    assert plain.outcome.outputs == pytest.approx(again.outputs, nan_ok=True, rel=0.0)
    assert (changed.bed.position == plain.bed.position).all()
    assert changed.outcome.outputs["peak_acceleration"] < plain.outcome.outputs["peak_acceleration"]


def test_the_command_tells_what_came_out_and_keeps_the_motion(study_file: Path, tmp_path: Path) -> None:
    motion = tmp_path / "landing.h5"
    shown = CliRunner().invoke(app, ["land", str(study_file), "--out", str(motion)])
    assert shown.exit_code == 0, shown.output
    assert "The landing ended as clear after" in shown.stdout
    assert "m/s    speed after the touchdown" in shown.stdout
    with h5py.File(motion) as file:
        assert file["frames/position"].shape[1:] == (31, 3)
    told = json.loads(CliRunner().invoke(app, ["land", str(study_file), "--set", "impact.speed=0.3", "--json"]).stdout)
    assert (told["outcome"], told["inputs"]["impact.speed"]) == ("clear", 0.3)
    assert 0.0 < told["outputs"]["speed_out"] < 0.3


@pytest.mark.parametrize(("options", "said"), [
    (["--set", "grain.colour=1"], "--set names 'grain.colour', which no landing of this study uses"),
    (["--set", "impact.speed"], "--set is 'impact.speed'; allowed: KEY=VALUE"),
    (["--set", "impact.speed=0.1", "--set", "impact.speed=0.2"], "--set has impact.speed twice"),
    (["--set", "impact.speed=fast"], "--set impact.speed is 'fast'; allowed: a number"),
    (["--set", "impact.speed=nan"], "--set impact.speed is nan; allowed: a finite number"),
    (["--set", "impact.speed=-1"], "--set: impact.speed is -1; allowed: above 0 and at most 1000 [m/s]"),
    (["--set", "lander.mass=0"], "--set: lander.mass is 0; allowed: above 0 [kg]"),
    (["--set", "impact.incidence_deg=100"], "--set: impact.incidence_deg is 100; allowed: at least 0 and below 90"),
    (["--set", "impact.place.x=3"], "--set: impact.place.x reaches from 3 to 3 m; allowed: -0.27 to 0.27 m"),
    (["--set", "grain.fricton=0.4"], "which no landing of this study uses; did you mean grain.friction?"),
    (["--set", "grain.friction=true"], "--set grain.friction is 'true'; allowed: a number"),
    (["--set", "grain.friction=0.4\ny=3"], "--set grain.friction is '0.4\\ny=3'; allowed: a number"),
    (["--set", "grain.friction=0.4 # more"], "--set grain.friction is '0.4 # more'; allowed: a number"),
    (["--set", "grain.friction=.5"], "--set grain.friction is '.5'; allowed: a number as in a study file"),
    (["--set", "grain.friction='0.4'"], "allowed: a number"),
    (["--set", f"grain.friction={'9' * 5000}"], "--set grain.friction is inf; allowed: a finite number"),
    (["--set", "bed=0.5"], "--set bed is 0.5; allowed: a whole number from 0 to 4294967295"),
    (["--set", "bed=1e300"], "--set bed is 1e+300; allowed: a whole number from 0 to 4294967295"),
    (["--number", "-1"], "the number of a run is -1; allowed: 0 to 239, the runs of the study"),
    (["--number", "1000000000"], "the number of a run is 1000000000; allowed: 0 to 239, the runs of the study"),
])  # fmt: skip
def test_what_cannot_be_landed_is_one_sentence(options: list[str], said: str, study_file: Path) -> None:
    refused = CliRunner().invoke(app, ["land", str(study_file), *options])
    assert refused.exit_code == 2
    assert said in refused.stderr
    assert len(refused.stderr.strip().splitlines()) == 1


@pytest.mark.parametrize("run", [0, 1, 119, 120, 599, 650])
def test_one_run_of_the_sequence_is_its_row(run: int, study_file: Path) -> None:
    study = read_study(study_file)
    assert DrawnDesign(study).row(run) == DrawnDesign(study).with_run_count(run + 1).rows[-1]


@pytest.mark.parametrize("changes", [[], ["grain.friction=0.55"]])
def test_a_landing_feels_the_gravity_of_its_place_and_the_bed_that_of_the_site(
    changes: list[str], tmp_path: Path
) -> None:
    path = tmp_path / "site.toml"
    path.write_text(TEXT.replace("gravity = 1e-4", 'gravity = "site"') + '[site]\nbody = "dimorphos"\n')
    study = read_study(path)
    assert study.surface.gravity == "site"
    values, of_bed = landing_inputs(study, changes), with_site_gravity(study)
    site = Site(of_bed)
    columns = site.sampled(1)
    origin, axes = site.frames(columns)
    # With the tide of the partner, which stands elsewhere at every landing.
    (felt,) = site.body.felt(origin, site.clock(columns), columns["mass"], columns["spin_period"])
    found = land_one(study, values)
    assert values["surface.gravity"] == pytest.approx(np.linalg.norm(felt), rel=1e-12)
    assert np.linalg.norm(found.landing.gravity) == pytest.approx(np.linalg.norm(felt), rel=1e-12)
    assert found.landing.gravity[2] == pytest.approx(axes[0, 2] @ felt, rel=1e-12)
    assert found.bed.gravity == pytest.approx((0.0, 0.0, -of_bed.surface.gravity))


def test_a_gravity_that_is_given_can_be_changed_for_a_landing_on_the_same_bed(study_file: Path) -> None:
    study = read_study(study_file)
    found = land_one(study, landing_inputs(study, ["surface.gravity=3e-5"]))
    assert found.landing.gravity == pytest.approx((0.0, 0.0, -3e-5))
    assert found.bed.gravity == pytest.approx((0.0, 0.0, -1e-4))


def test_a_solver_of_the_user_has_no_soil() -> None:
    with pytest.raises(ValueError, match="a solver of its own and no soil to land on"):
        landing_inputs(read_study(Path("examples/ball_on_plate.toml")))


NUMBER = 1


@pytest.fixture(scope="module")
def journeys_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("soil") / "soil.toml"
    path.write_text(SOIL_JOURNEYS.replace("emulated_count = 40", "emulated_count = 0"))
    return path


@pytest.fixture(scope="module")
def results(journeys_file: Path) -> StudyResults:
    run_study(StudySource.read(journeys_file), journeys_file.parent / "out", until="summary", worker_count=1)
    return open_study(journeys_file.parent / "out")


@pytest.fixture(scope="module")
def followed(journeys_file: Path) -> tuple[OneJourney, list[str]]:
    """The second journey of the study and the lines that were told of it."""
    study, told = read_study(journeys_file), list[str]()
    return follow_one(study, landing_inputs(study, number=NUMBER), told.append), told


def touchdowns(found: OneJourney) -> list[dict[str, Any]]:
    return found.journeys.touchdowns[found.lander]


def test_it_has_the_bits_of_that_of_the_study(results: StudyResults, followed: tuple[OneJourney, list[str]]) -> None:
    found, _ = followed
    records = {record.key: record for record in read_records(results.folder / "runs.sqlite")}
    assert len(found.landings) > 1
    for touchdown, made in zip(touchdowns(found), found.landings, strict=True):
        record = records[touchdown["key"]]
        assert made.values == record.inputs
        assert {name: value for name, value in made.outcome.outputs.items() if not np.isnan(value)} == record.outputs
    row = {name: results.journeys[name][NUMBER] for name in results.journeys}
    assert {name: cell for name, cell in found.track.row.items() if cell != ""} == {
        name: cell for name, cell in row.items() if found.track.row[name] != ""
    }
    # The flights between them, too.
    of_journey = results.touchdowns["journey"] == NUMBER
    assert [one["begin_s"] for one in touchdowns(found)] == results.touchdowns["begin_s"][of_journey].tolist()


def test_each_touchdown_has_a_line_and_the_end_a_sentence(followed: tuple[OneJourney, list[str]]) -> None:
    found, told = followed
    track = found.track
    assert [*told, track.end_words] == track.lines()
    lines = [re.split(r"\s{2,}", line.strip()) for line in told[2:]]
    assert [int(line[0]) for line in lines] == list(range(len(found.landings)))
    for line, made in zip(lines, found.landings, strict=True):
        assert float(line[2]) == pytest.approx(made.values["impact.speed"], rel=5e-3)
    # A lander that came down again has its way over the ground, as on a ball: on the bed, and in a flight that is
    # highest in between, so that it is nowhere faster than at the faster of its ends.
    shape = found.journeys.landers.body.shape
    rows = zip(pairwise(lines), pairwise(touchdowns(found)), found.landings[:-1], strict=True)
    for (line, after), (one, another), made in rows:
        here, there = (shape.surface_point(row["latitude_deg"], row["longitude_deg"]) for row in (one, another))
        angle = math.acos(here @ there / np.linalg.norm(here) / np.linalg.norm(there))
        assert float(line[6]) == pytest.approx(track.radius * angle, rel=6e-3)
        on_bed = math.hypot(made.outcome.outputs["displacement_x"], made.outcome.outputs["displacement_y"])
        fastest = max(float(line[4]), float(after[2]))
        assert 0.0 < np.linalg.norm(there - here) < on_bed + fastest * (another["begin_s"] - one["end_s"])
    assert track.end == JourneyEnd.AT_REST
    assert lines[-1][4] == "at rest"
    assert f"in {len(lines)} touchdowns, at latitude {track.end_place[1]:.3f}" in track.end_words
    assert re.search(r"side [+-][xyz] is down, tilted by [\d.]+ deg\.$", track.end_words)


def test_a_journey_makes_each_touchdown_again(results: StudyResults, followed: tuple[OneJourney, list[str]]) -> None:
    journey, (found, _) = results.journey(NUMBER), followed
    assert journey.track.lines() == found.track.lines()
    # It breaks its lines to fit a screen.
    assert " ".join(str(journey).splitlines()[1:]).split() == " ".join(journey.track.lines()).split()
    last = len(found.landings) - 1
    outcome = journey.landing(last, frame_count=5)
    assert outcome.outputs == pytest.approx(found.landings[last].outcome.outputs, rel=0.0, nan_ok=True)
    motion = journey.motion(frame_count=5)
    assert len(motion.bodies) == len(found.landings)
    assert (motion.bodies[last].position[0] == found.motion().bodies[last].position[0]).all()
    with pytest.raises(ValueError, match=r"touchdown is 9; allowed: 0 to \d, those of journey 1"):
        journey.landing(9)
    with pytest.raises(ValueError, match=r"journey is 2; allowed: 0 to 1, the journeys of "):
        results.journey(2)


def test_the_command_follows_the_lander_and_keeps_its_motion(journeys_file: Path, tmp_path: Path) -> None:
    motion = tmp_path / "lander.h5"
    arguments = ["land", str(journeys_file), "--set", "impact.speed=0.02", "--out", str(motion)]
    shown = CliRunner().invoke(app, arguments)
    assert shown.exit_code == 0, shown.output
    lines = shown.stdout.splitlines()
    assert lines[0].startswith("touch-")
    assert lines[2].split()[:2] == ["0", "0"]
    paths = sorted(tmp_path.glob("lander_*.h5"))
    assert lines[-len(paths) :] == [f"Motion: {path.resolve()}" for path in paths]
    with h5py.File(paths[0]) as file:
        assert file.attrs["speed"] == 0.02
    refused = CliRunner().invoke(app, arguments)
    assert refused.exit_code == 2
    assert "lander_0.h5 exists" in refused.stderr


def test_a_program_is_given_the_same(followed: tuple[OneJourney, list[str]]) -> None:
    told = json.loads(json.dumps(followed[0].to_json(), allow_nan=False))
    assert (told["journey"], told["end"]) == (NUMBER, "at_rest")
    assert [one["touchdown"] for one in told["touchdowns"]] == list(range(len(followed[0].landings)))
    assert told["touchdowns"][-1]["outputs"]["speed_out"] is None


def test_what_is_changed_is_changed_in_every_touchdown_and_the_ground_goes_with_it(journeys_file: Path) -> None:
    study = read_study(journeys_file)
    plain, other = (landing_inputs(study, changes) for changes in ((), ["impact.azimuth_deg=90", "lander.mass=2"]))
    assert other["lander.mass"] == 2.0
    # Downhill against the incoming velocity stays what it is on the body.
    turn = other["surface.slope_azimuth_deg"] - plain["surface.slope_azimuth_deg"]
    assert turn % 360.0 == pytest.approx((90.0 - plain["impact.azimuth_deg"]) % 360.0)
    assert landing_inputs(study, ["grain.friction=0.6"])["grain.friction"] == 0.6


@pytest.mark.parametrize("key", ["journey", "touchdown", "journey.time_left", "surface.slope_deg"])
def test_what_follows_from_the_journey_cannot_be_changed(key: str, journeys_file: Path) -> None:
    with pytest.raises(ValueError, match=f"--set names '{key}', which no landing of this study uses"):
        landing_inputs(read_study(journeys_file), [f"{key}=1"])


def test_a_file_of_another_kind_is_refused_before_anything_lands(journeys_file: Path) -> None:
    refused = CliRunner().invoke(app, ["land", str(journeys_file), "--out", "journey.avi"])
    assert refused.exit_code == 2
    assert "allowed: a name that ends in .html, .mp4, .webp, .png, .vtkhdf, .h5" in refused.stderr


# The logarithm of the speed is normal: friction and place have these parts of its standard deviation, noise the rest.
OF_FRICTION, OF_PLACE = 0.6, 0.7
SPREAD, MIDDLE = 0.3, 0.1
RARE = 1e-3
LIMIT = MIDDLE * math.exp(SPREAD * stats.norm.isf(RARE))
CONDITIONS = {"fast": f"speed_out > {LIMIT!r}", "never": "speed_out > 10", "gone": "not returns",
    "hard": "peak_acceleration > 50", "common": f"speed_out > {MIDDLE!r}"}  # fmt: skip


@dataclass(frozen=True)
class NoisyLander:
    """Leaves at a speed that friction, place and noise make; a tenth are lost where `lost` is true."""

    lost: bool = False

    def __call__(self, values: dict[str, float], seed: int) -> dict[str, Any]:
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


class Stopping(Silent):
    """Shows nothing, and stops after some looks at the landings."""

    def __init__(self, looks: int) -> None:
        self.looks, self.said = looks, []

    def progress(self, done: float, total: float, what: str, detail: str = "", /) -> None:
        self.looks -= what.startswith("fast")
        if self.looks == 0:
            raise StoppedError

    def say(self, sentence: str) -> None:
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


def test_what_is_common_is_counted_and_the_sentence_says_so(tmp_path: Path) -> None:
    found = rare(tmp_path / "out", "common", landing_count=100)
    assert (found["levels"], found["landings"]) == (1, 100)
    # Half of them, in the median of the law.
    assert found["lower"] < 0.5 < found["upper"]
    assert found["statement"].endswith("gain anything: for a narrower interval raise journey.count.")


def test_what_never_happens_is_not_looked_for_without_end(tmp_path: Path) -> None:
    found = rare(tmp_path / "out", "never", landing_count=20)
    assert (found["probability"], found["reached"], found["warning"]) == (0.0, False, None)
    assert found["levels"] <= 6
    assert found["inputs"]["grain.friction"]["median"] is None
    assert found["landings"] <= 20 + 6 * 18
    assert "no landing met it down to the last level, a probability of" in found["statement"]


@pytest.mark.parametrize(("name", "count", "words"), [
    ("slow", 200, r"NAME is 'slow'; allowed: a name of \[limit_states\] \(fast, never, gone, hard, common\)"),
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
