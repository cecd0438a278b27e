"""Kill -9 of the coordinator, of a worker, of both, in stages of each kind: the study ends with the same bits."""

import json
import random
import time
from pathlib import Path

import pytest

from lithobrake.compilation.compiled import lies_on_disk
from lithobrake.dem.stepping.time_loop import advance
from lithobrake.pipeline import STAGES
from lithobrake.pipeline.runs.beds import compile_kernels, fly_briefly
from lithobrake.results import open_study
from lithobrake.smallbody.integration import integrate_flights
from lithobrake.study import read_study

from ..few_grains import EXPANSION, ONE_IMPACT, few_grains
from .killed_studies import VICTIMS, end, kill, ledger, start, wait_for_stage

STUDY = f"""seed = 2
campaign = {{ retry_count = 20 }}
monte_carlo = {{ sample_count = 500 }}
flight = {{ flight_count = 10, duration = 20000.0 }}
hard_ground = {{ count = 10 }}
{few_grains(12, width=0.3, lander_diameter=0.1, sides="walls")}{ONE_IMPACT}{EXPANSION}screening_level = 2
screening_degree = 1
refined_level = 2
refined_degree = 1
kept_outputs = ["speed_out"]
test_count = 6
"""
# Stages in which to kill: one of each way in which files are made, and two of a campaign. Other stages make theirs the
# same way, or end before a kill could hit them.
MOMENTS = ("bed", "screening_runs", "test_runs", "sample", "fly", "report")
ALIKE = {"landing": "bed", "refined_runs": "test_runs", "paths": "fly", "hard_ground": "fly", "summary": "report"}
AT_ONCE = {"screen", "refine", "test"}
MAKE_RUNS = ("screening_runs", "refined_runs", "test_runs")
LEDGER = ("runs.sqlite", "runs.sqlite-wal", "runs.sqlite-shm")

pytestmark = pytest.mark.skipif(not Path("/proc").is_dir(), reason="the processes are found in /proc (Linux)")


def test_a_study_killed_at_random_moments_ends_with_the_same_bits(tmp_path: Path) -> None:
    study, calm, killed = tmp_path / "few.toml", tmp_path / "calm", tmp_path / "killed"
    study.write_text(STUDY)
    asked = read_study(study)
    # Compiled first, so that the study tells how long its stages take.
    if not (lies_on_disk(advance) and lies_on_disk(integrate_flights)):
        compile_kernels(lambda *what: None)
        fly_briefly(asked)
    end(study, calm, worker_count=2)
    durations = json.loads((calm / "keys.json").read_text())["wall_s"]
    files = {stage.name: stage.files(asked) for stage in STAGES if stage.files(asked)}
    assert {*MOMENTS, *ALIKE} == set(files) - AT_ONCE
    chance, kills, process = random.Random(6), 0, start(study, killed)
    while kills < len(MOMENTS):
        stage = MOMENTS[kills]
        # The very first moment is any at all, before there is a folder, too.
        wait_for_stage(process, killed, list(files).index(stage) + 1 if kills else 0)
        time.sleep(chance.random() * durations[stage])
        if process.exitcode is None:
            kill(process, VICTIMS[kills % len(VICTIMS)], chance)
            kills += 1
        else:
            # It came to its end before its time, as it is faster now than the calm one was: what this stage has made is
            # taken away, and has to be made again.
            durations[stage] *= 0.5
            for name in (*files[stage], *(LEDGER if stage in MAKE_RUNS else ())):
                (killed / name).unlink(missing_ok=True)
        if process.exitcode is not None:
            process = start(study, killed)
    process.kill()
    process.join()
    end(study, killed)
    assert ledger(killed) == ledger(calm)
    # Summary and report name times and folders; the summary's results are compared below.
    for stage, names in files.items():
        for name in names if stage not in ("summary", "report") else ():
            assert (killed / name).read_bytes() == (calm / name).read_bytes(), name
    summaries = [open_study(out).summary for out in (killed, calm)]
    assert (summaries[0]["results"], summaries[0]["study"]) == (summaries[1]["results"], summaries[1]["study"])
