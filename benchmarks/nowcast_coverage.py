"""How often intervals of a nowcast hold the ground and the place of rest of grounds that its emulator has not seen.

    python benchmarks/nowcast_coverage.py [--folder runs/quick] [--followed 60] [--most 48]

"held-out beds": of a finished study of journeys to rest, each first contact of its landers is observed, by the refits
of the emulator that have not seen its bed, and on the grounds of the other beds. "synthetic": touchdowns by a function
whose bed has an effect of its own, a study of 24 grounds with four journeys on each; observed are the landers of
another study, with another seed, so on other grounds. Quantities are held where they lie within their 90 % interval;
the rest of one in two landers is looked at, of so many at most. Grounds are scored by the logarithm of the probability
of the true kind, before and after. With --folder: held-out beds of that study; without: synthetic. Rows of the other
stay as they are.
Writes results/nowcast_coverage.csv and .json.
"""

import math
import tempfile
from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from harness import RESULTS, SCENARIOS, Row, command_line, study_tables, write_made, write_rows

import lithobrake
from lithobrake.analysis import LEVEL, Observation
from lithobrake.analysis.observed_draws import observed_draws, weighted_quantiles
from lithobrake.files.reading import read_table
from lithobrake.pipeline.answer.emulated_ends import Refits
from lithobrake.pipeline.answer.journey_ends import JourneyTable
from lithobrake.pipeline.nowcast.contact_emulator import FirstContacts, contact_emulator
from lithobrake.pipeline.nowcast.contact_landers import ENDS, ContactLanders
from lithobrake.pipeline.nowcast.contact_nowcast import COPIES, NowcastStudy
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.study_folder import FinishedFolder
from lithobrake.vocabulary.quantities import GROUND_KIND, GROUND_SIZE, JOURNEY_DESIGN

TABLE = RESULTS / "nowcast_coverage.csv"
SEEN = {"motion": ("speed_out", "elevation_out", "spin_out"), "record": ("contact_duration", "peak_acceleration")}
# Of the standard deviation of an output over the runs.
ERROR = 0.05
COLUMNS = ("study", "seen", "quantity", "cases", "held", "error", "before", "after", "unreliable")


def touchdown(inputs: dict[str, float], seed: int) -> dict[str, Any]:
    """A rebound that grows with the grains, short and hard on stiff soil, with an effect of each bed on all three."""
    random = np.random.default_rng(seed)
    size, speed = inputs[GROUND_SIZE], inputs["impact.speed"]
    bed = np.random.default_rng(round(1e9 * size)).standard_normal(2)
    incidence = math.radians(inputs["impact.incidence_deg"])
    rebound = 0.25 + 0.2 * math.log(size / 0.08) * math.exp(0.1 * bed[0])
    up = rebound * speed * math.cos(incidence) * math.exp(0.2 * random.standard_normal())
    contact = (
        0.5 * (1e6 / inputs["grain.young_modulus"]) ** 0.4 * math.exp(0.15 * bed[1] + 0.15 * random.standard_normal())
    )
    outputs = {"duration": 60.0 * math.exp(0.3 * random.standard_normal()), "contacts": 1.0, "displacement_x": 0.1,
        "displacement_y": 0.0, "contact_duration": contact, "penetration": 0.01, "energy_lost": 1e-3,
        "peak_acceleration": 2.0 * (speed + up) / contact * math.exp(0.1 * random.standard_normal())}  # fmt: skip
    if up < 0.008:
        return {"outcome": "captured", "outputs": outputs}
    along, aside = 0.5 * speed * math.sin(incidence), 0.1 * speed * random.standard_normal()
    return {"outcome": "clear", "outputs": outputs | {"velocity_out_x": along, "velocity_out_y": aside,
        "velocity_out_z": up, "spin_out_x": 0.0, "spin_out_y": 5.0 * speed * random.uniform(0.5, 1.0),
        "spin_out_z": 0.0}}  # fmt: skip


def synthetic_tables(seed: int) -> Row:
    size = {"distribution": "log_uniform", "lower": 0.08, "upper": 0.4}
    kinds = {"gravel": {"weight": 0.7, "grain_size": size}, "rock": {"weight": 0.3, "rock": True}}
    kinds["rock"]["grain_size"] = {"distribution": "log_uniform", "lower": 0.5, "upper": 1.0}
    few = {"journey": {"emulated_count": 50, "duration": 172_800.0}, "hard_ground": {"count": 0}}
    return study_tables(SCENARIOS / "quick.toml", few, ground={"kind": kinds}, seed=seed)


@dataclass(frozen=True)
class Truths:
    """Landers whose first contacts are observed: runs of these contacts, ends of the landers, their first places."""

    first: DesignRuns
    rows: np.ndarray
    numbers: Mapping[str, np.ndarray]
    bed: np.ndarray

    @classmethod
    def of(cls, folder: FinishedFolder) -> "Truths":
        runs, table = DesignRuns.load(folder, JOURNEY_DESIGN), JourneyTable.load(folder)
        rows = np.flatnonzero(runs.inputs["touchdown"] == 0.0)
        rows = rows[np.argsort(runs.inputs["journey"][rows])]
        return cls(runs, rows, {name: table.of_rest(name) for name in ("time_s", "distance")}, table.bed)

    def contact(self, place: int, names: tuple[str, ...]) -> Observation:
        """The observed first contact of one lander, with errors."""
        row = self.rows[place]
        if self.first.outcomes[row] != "clear":
            return Observation({}, outcome=self.first.outcomes[row])
        random = np.random.default_rng([5, place])
        errors = {name: ERROR * float(np.nanstd(self.first.output(name))) for name in names}
        outputs = {
            name: max(float(self.first.output(name)[row]) + error * random.standard_normal(), 1e-9)
            for name, error in errors.items()
        }
        return Observation(outputs, errors, outcome="clear")


def cases(study: NowcastStudy, truths: Truths, seen: str, given: Any, *, is_own: bool) -> Iterator[tuple[str, Row]]:
    """What was held of each lander, by quantity; is_own: of the study's own landers, whose beds are held out."""
    emulator = contact_emulator(study.design, study.folder, SEEN[seen])
    contacts = FirstContacts.drawn(emulator, study.arrivals(), COPIES)
    own_bed = contacts.begin.column("bed")[contacts.lander]
    values = {name: contacts.x[name][contacts.lander] for name in contacts.x if name.startswith(("ground.", "grain."))}
    fitted, looked = Refits.of_journeys(study.design.study, study.journeys), 0
    for place, bed in enumerate(truths.bed.tolist()):
        allowed = np.ones(len(own_bed), dtype=bool)
        if is_own:
            allowed = np.isin(contacts.refit, emulator.unseen(bed)) & (own_bed != bed)
        contact = truths.contact(place, SEEN[seen])
        possible = contacts.ended_as(contact.outcome) & allowed
        draws = observed_draws(contacts.outputs, contact.outputs, contact.errors, possible, contacts.lander)
        if not draws.is_reliable:
            yield "all", {"unreliable": 1.0}
            continue
        for name, column in values.items():
            truth = float(truths.first.inputs[name][truths.rows[place]])
            if name == GROUND_KIND:
                before, after = (float(one[column == truth].sum() / one.sum()) for one in (allowed, draws.weights))
                yield name, {"before": math.log(max(before, 1e-3)), "after": math.log(max(after, 1e-3))}
                continue
            yield name, judged(draws.quantiles(column, ENDS), weighted_quantiles(column, allowed, ENDS), truth)
        if place % 2 or looked >= given.most:
            continue
        looked += 1
        landers = ContactLanders.of(contacts, draws.taken(given.followed, 1), contact, f"{seen} {place}")
        for name, column in truths.numbers.items():
            if np.isfinite(column[place]):
                found = landers.quantiles(name)
                if None in found:
                    yield f"{name}, refused", {"unreliable": 1.0}
                    continue
                yield name, judged(found, weighted_quantiles(column, np.ones(len(column)), ENDS), column[place])
        yield "at_rest", brier(landers.at_rest(fitted).value, np.isfinite(truths.numbers["time_s"]), place)


def judged(after: list[Any], before: list[float], truth: float) -> Row:
    """Whether an interval held the truth, and its width before and after."""
    held = after[0] is not None and after[0] * (1.0 - 1e-9) <= truth <= after[2] * (1.0 + 1e-9)
    return {"held": float(held), "before": before[2] - before[0], "after": after[2] - after[0]}


def brier(share: float, rests: np.ndarray, place: int) -> Row:
    """Squared errors of the probability of rest: by the share of all landers, and by that of the nowcast."""
    return {"before": (rests.mean() - rests[place]) ** 2, "after": (share - rests[place]) ** 2}


def rows_of(name: str, seen: str, found: Iterator[tuple[str, Row]]) -> Iterator[Row]:
    by_name = defaultdict[str, list[Row]](list)
    for quantity, row in found:
        by_name[quantity].append(row)
    for quantity, rows in by_name.items():
        mean = {
            key: round(float(np.mean([row[key] for row in rows])), 4) if key in rows[0] else ""
            for key in ("held", "before", "after")
        }
        error = "" if mean["held"] == "" else round(math.sqrt(mean["held"] * (1.0 - mean["held"]) / len(rows)), 3)
        unreliable = len(rows) if "unreliable" in rows[0] else ""
        yield {"study": name, "seen": seen, "quantity": quantity, "cases": len(rows), **mean, "error": error,
            "unreliable": unreliable}  # fmt: skip


def synthetic(folder: Path) -> tuple[NowcastStudy, Truths]:
    """A study of synthetic touchdowns and the landers of another one."""
    for name, seed in (("study", 2), ("truth", 3)):
        lithobrake.run(synthetic_tables(seed), folder / name, workers=1, model=touchdown, report=False)
    return NowcastStudy.open(folder / "study"), Truths.of(FinishedFolder(folder / "truth"))


def main() -> None:
    given = command_line(__doc__, folder=Path(), followed=60, most=48).parse_args()
    name = "held-out beds" if given.folder.name else "synthetic"
    # The rows of the other studies stay.
    rows = [row for row in read_table(TABLE, (), "").rows if row["study"] != name] if TABLE.is_file() else []
    if given.folder.name:
        study = NowcastStudy.open(given.folder)
        truths = Truths.of(study.folder)
    else:
        study, truths = synthetic(Path(tempfile.mkdtemp()))
    for seen in SEEN:
        rows += rows_of(name, seen, cases(study, truths, seen, given, is_own=name != "synthetic"))
        write_rows(TABLE, COLUMNS, rows)
    command = f"benchmarks/nowcast_coverage.py{' --folder runs/quick' * (name != 'synthetic')} --most {given.most}"
    write_made(TABLE, command, level=LEVEL, copies=COPIES, error=ERROR, followed=given.followed)


if __name__ == "__main__":
    main()
