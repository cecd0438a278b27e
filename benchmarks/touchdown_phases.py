"""Where the time of touchdowns that go on to rest is spent: in low hops, in contact, in waiting for rest.

    lithobrake run scenarios/one_ground.toml --out FOLDER
    python benchmarks/touchdown_phases.py FOLDER --every 5 --out FILE.json

Lands again every so many of a study's journeys, with the code that made them. The CPU time between two looks at the
lander goes to one phase: "approach", before the first touch; "hop", where nothing touched the lander since the last
look; "contact"; "rest", from where it then rested on, which the watch on rest waits for. Beside them: the part of the
time in which the kinetic energy left would have lifted the lander by less than the way of the watch on rest for good,
which no earlier end on grounds of energy could save more than; looks, and the CPU time of a simulated second.
"""

import json
import sqlite3
import time
from collections import Counter
from pathlib import Path

import numpy as np
from harness import Row, command_line, origin, write_document

from lithobrake.study import Study, check_tables, load_tables
from lithobrake.touchdown import simulation
from lithobrake.touchdown.lander_model import lander
from lithobrake.touchdown.outcome_judge import REST_WAY, OutcomeJudge
from lithobrake.touchdown.touchdown_model import landing, stored_bed

PHASES = ("approach", "hop", "contact", "rest")


class TimedJudge(OutcomeJudge):
    """Notes at each look the simulated time, the CPU time, the last contact and how high the energy would lift it."""

    last: "TimedJudge"

    def look(self) -> None:
        super().look()
        TimedJudge.last = self
        notes = self.__dict__.setdefault("notes", [])
        lift = self.motion.kinetic_energy / (self.lander.mass * float(np.linalg.norm(self.world.gravity)))
        touched = self.world.watched["last_contact"]
        notes.append((self.world.time, time.process_time(), -np.inf if np.isnan(touched) else touched, lift))


def phases(judge: TimedJudge) -> dict[str, tuple[float, float]]:
    """CPU time and simulated time [s] of each phase, "low" energy and "all", from the first look on."""
    now, cpu, touched, lift = np.array(judge.__dict__["notes"]).T
    spent, passed = np.diff(cpu), np.diff(now)
    kind = np.where(touched[1:] > now[:-1], PHASES.index("contact"), PHASES.index("hop"))
    kind[np.isinf(touched[1:])] = PHASES.index("approach")
    assert judge.rest is not None
    if judge.ended == "captured":
        kind[now[1:] > judge.rest.since] = PHASES.index("rest")
    low = np.arange(len(spent)) >= np.flatnonzero(lift > REST_WAY * judge.lander.smallest_edge)[-1]
    chosen = {name: kind == k for k, name in enumerate(PHASES)} | {"low": low, "all": np.full(len(spent), True)}
    return {name: (float(spent[some].sum()), float(passed[some].sum())) for name, some in chosen.items()}


def touchdowns(folder: Path, every: int) -> list[Row]:
    with sqlite3.connect(f"file:{folder / 'runs.sqlite'}?mode=ro", uri=True) as ledger:
        rows = [json.loads(inputs) for (inputs,) in ledger.execute("SELECT inputs FROM runs WHERE status = 'done'")]
    return [row for row in rows if "journey" in row and row["journey"] % every == 0]


def study_of(folder: Path) -> Study:
    """The study of a folder, as far as a landing reads it."""
    tables = {key: table for key, table in load_tables(folder / "study.toml").items() if key != "site"}
    return check_tables(tables, folder)


def main() -> None:
    given = command_line(__doc__, "folder", every=5, out=Path).parse_args()
    study, rows = study_of(given.folder), touchdowns(given.folder, given.every)
    simulation.OutcomeJudge = TimedJudge  # type: ignore[misc]
    cpu, simulated = (dict.fromkeys((*PHASES, "low", "all"), 0.0) for _ in range(2))
    ended: Counter[str] = Counter()
    looks = 0
    for number, row in enumerate([rows[0], *rows]):
        bed = stored_bed(given.folder / f"beds/bed_{round(row['bed'])}.h5")
        outcome = simulation.land(bed, lander(study, row), landing(study, row))
        if number == 0:
            continue  # it reads the kernels
        ended[str(outcome.status)] += 1
        looks += TimedJudge.last.looks
        for name, (spent, passed) in phases(TimedJudge.last).items():
            cpu[name] += spent
            simulated[name] += passed
    total = cpu["all"]
    write_document(
        given.out,
        origin(f"benchmarks/touchdown_phases.py FOLDER --every {given.every}")
        | {"touchdowns": dict(ended), "cpu_s": total, "simulated_s": simulated["all"], "looks": looks}
        | {name: {"cpu_share": cpu[name] / total, "simulated_s": simulated[name]} for name in (*PHASES, "low")},
    )


if __name__ == "__main__":
    main()
