"""One journey made at once on real soil is that journey of the study, and each of its touchdowns is made again."""

import json
import re
from pathlib import Path

import h5py
import numpy as np
import pytest
from typer.testing import CliRunner

from lithobrake.campaign import read_records
from lithobrake.cli import app
from lithobrake.pipeline import OneJourney, follow_one, landing_inputs, run_study
from lithobrake.results import StudyResults, open_study
from lithobrake.study import StudySource, read_study
from lithobrake.vocabulary.outcomes import JourneyEnd

from .soil_journeys import SOIL_JOURNEYS

NUMBER = 1


@pytest.fixture(scope="module")
def study_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("soil") / "soil.toml"
    path.write_text(SOIL_JOURNEYS)
    return path


@pytest.fixture(scope="module")
def results(study_file: Path) -> StudyResults:
    """The study up to its summary."""
    run_study(StudySource.read(study_file), study_file.parent / "out", until="summary", worker_count=1)
    return open_study(study_file.parent / "out")


@pytest.fixture(scope="module")
def followed(study_file: Path) -> tuple[OneJourney, list[str]]:
    """The second journey of the study and the lines that were told of it."""
    study, told = read_study(study_file), list[str]()
    return follow_one(study, landing_inputs(study, number=NUMBER), told.append), told


def test_it_has_the_bits_of_the_journey_in_the_study(
    results: StudyResults, followed: tuple[OneJourney, list[str]]
) -> None:
    found, _ = followed
    records = {record.key: record for record in read_records(results.folder / "runs.sqlite")}
    assert len(found.landings) > 1
    for touchdown, landing in zip(found.journey.touchdowns, found.landings, strict=True):
        record = records[touchdown["key"]]
        assert landing.values == record.inputs
        outputs = {name: value for name, value in landing.outcome.outputs.items() if not np.isnan(value)}
        assert outputs == record.outputs
    row = {name: results.journeys[name][NUMBER] for name in results.journeys}
    assert {name: cell for name, cell in found.track.row.items() if cell != ""} == {
        name: cell for name, cell in row.items() if found.track.row[name] != ""
    }
    # The flights between them, too.
    of_journey = results.touchdowns["journey"] == NUMBER
    assert [one["begin_s"] for one in found.journey.touchdowns] == results.touchdowns["begin_s"][of_journey].tolist()


def test_each_touchdown_has_a_line_and_the_end_a_sentence(followed: tuple[OneJourney, list[str]]) -> None:
    found, told = followed
    track = found.track
    assert [*told, track.end_words] == track.lines()
    lines = [re.split(r"\s{2,}", line.strip()) for line in told[2:]]
    assert [int(line[0]) for line in lines] == list(range(len(found.landings)))
    for line, landing in zip(lines, found.landings, strict=True):
        assert float(line[2]) == pytest.approx(landing.values["impact.speed"], rel=5e-3)
    # Each flight of a lander that came down again has the way that it went over the ground.
    assert all(0.0 < float(line[6]) < 200.0 for line in lines[:-1])
    assert track.end == JourneyEnd.AT_REST
    assert lines[-1][4] == "at rest"
    assert f"in {len(lines)} touchdowns, at latitude {track.end_place[0]:.3f}" in track.end_words
    assert re.search(r"side [+-][xyz] is down, tilted by [\d.]+ deg\.$", track.end_words)


def test_a_journey_of_a_study_makes_each_touchdown_again(
    results: StudyResults, followed: tuple[OneJourney, list[str]]
) -> None:
    journey, (found, _) = results.journey(NUMBER), followed
    assert journey.track.lines() == found.track.lines()
    # It breaks its lines to fit a screen.
    assert " ".join(str(journey).splitlines()[1:]).split() == " ".join(journey.track.lines()).split()
    last = len(found.landings) - 1
    outcome = journey.landing(last, frame_count=5)
    assert outcome.outputs == pytest.approx(found.landings[last].outcome.outputs, rel=0.0, nan_ok=True)
    motion = journey.motion(frame_count=5)
    assert len(motion.bodies) == len(found.landings)
    place = found.motion().bodies[last].position
    assert (motion.bodies[last].position[0] == place[0]).all()
    with pytest.raises(ValueError, match=r"touchdown is 9; allowed: 0 to \d, those of journey 1"):
        journey.landing(9)
    with pytest.raises(ValueError, match=r"journey is 2; allowed: 0 to 1, the journeys of "):
        results.journey(2)


def test_the_command_follows_the_lander_and_keeps_its_motion(study_file: Path, tmp_path: Path) -> None:
    motion = tmp_path / "lander.h5"
    arguments = ["land", str(study_file), "--set", "impact.speed=0.02", "--out", str(motion)]
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
    assert told["journey"] == NUMBER
    assert told["end"] == "at_rest"
    assert [one["touchdown"] for one in told["touchdowns"]] == list(range(len(followed[0].landings)))
    assert told["touchdowns"][-1]["outputs"]["speed_out"] is None


def test_what_is_changed_is_changed_in_every_touchdown_and_the_ground_goes_with_it(study_file: Path) -> None:
    study = read_study(study_file)
    plain, other = (landing_inputs(study, changes) for changes in ((), ["impact.azimuth_deg=90", "lander.mass=2"]))
    assert other["lander.mass"] == 2.0
    # Downhill against the incoming velocity stays what it is on the body.
    turn = other["surface.slope_azimuth_deg"] - plain["surface.slope_azimuth_deg"]
    assert turn % 360.0 == pytest.approx((90.0 - plain["impact.azimuth_deg"]) % 360.0)
    assert landing_inputs(study, ["grain.friction=0.6"])["grain.friction"] == 0.6


@pytest.mark.parametrize("key", ["journey", "touchdown", "journey.time_left", "surface.slope_deg"])
def test_what_follows_from_the_journey_cannot_be_changed(key: str, study_file: Path) -> None:
    with pytest.raises(ValueError, match=f"--set names '{key}', which no landing of this study uses"):
        landing_inputs(read_study(study_file), [f"{key}=1"])


def test_a_file_of_another_kind_is_refused_before_anything_lands(study_file: Path) -> None:
    refused = CliRunner().invoke(app, ["land", str(study_file), "--out", "journey.avi"])
    assert refused.exit_code == 2
    assert "allowed: a name that ends in .html, .mp4, .webp, .png, .vtkhdf, .h5" in refused.stderr
