"""Does the half width come true that `lithobrake plan` promises? Fresh small studies, and those that are kept here.

    python validation/planned_width.py [--work FOLDER]            makes studies that are missing, then compares
    python validation/planned_width.py --folders FOLDER [FOLDER]  first keeps the outcomes of other finished journeys
    python validation/planned_width.py --page                     the table of docs/estimates.md

Fresh studies differ in lander, soil, arrival and body; they have as many beds as a study that does not say how many.
Their outcomes and beds stand in planned_width_runs.json; a study that stands in it is not made again. planned_width.csv
has a row a study: what is promised before a run and after the first third of the runs, and what came out. Earlier
studies: those of journey_seed_pairs.csv, emulated_journeys.json and delivery_options.json, and those of showcase/.

planned_width.json has in how many it does, and the correlation of two runs on one bed over all studies whose outcomes
are known: the sum of the variances of beds over that of all variances, with its standard error by leaving out one study
after another. For it the outcomes of journey_seed_pairs.py and emulated_journeys.py are kept, too (--folders: their
working folders).
"""

import math
import sys
import tempfile
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from harness import (
    ROOT,
    SCENARIOS,
    Row,
    between,
    command_line,
    origin,
    read_document,
    read_rows,
    rounded,
    study_tables,
    write_document,
    write_rows,
)
from page import table

from lithobrake.analysis import HalfWidthRange as HalfWidths
from lithobrake.analysis import half_width_of, half_width_range
from lithobrake.analysis.confidence import answered_runs, bed_components
from lithobrake.pipeline.answer.journey_ends import JourneyTable, end_share
from lithobrake.pipeline.answer.run_estimates import return_fraction
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.first_touchdown.run_flights import RunFlights
from lithobrake.pipeline.planning.expected_steps import ExpectedSoil
from lithobrake.pipeline.planning.expected_width import expected_correlation, expected_width, law_of_runs
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.site import with_site_gravity
from lithobrake.pipeline.study_folder import StudyFolder
from lithobrake.pipeline.study_run import run_study
from lithobrake.study import Study, StudySource, check_tables, read_study

TABLE = Path(__file__).with_suffix(".csv")
RUNS, VALIDATION, SHOWCASE = TABLE.with_name("planned_width_runs.json"), TABLE.parent, ROOT / "showcase"


def soil(lower: float, upper: float, **more: Any) -> Row:
    """Grains of these Young's moduli [Pa]."""
    return {"young_modulus": {"distribution": "log_uniform", "lower": lower, "upper": upper}, **more}


BALL = {"shape": "sphere", "edges": None, "diameter": 0.15, "mass": 3.0}
# Keys that differ from scenarios/one_ground.toml or scenarios/first_bounce.toml; one that is None is left out.
JOURNEYS: dict[str, dict[str, Row]] = {
    "ball, 8 to 25 cm/s": {
        "delivery": {"speed": between(0.08, 0.25), "incidence_deg": between(0.0, 60.0)},
        "lander": BALL, "grain": soil(3e4, 3e5),
    },
    "flat heavy box, shallow": {
        "delivery": {"speed": between(0.06, 0.15), "incidence_deg": between(40.0, 80.0)},
        "lander": {"edges": [0.2, 0.15, 0.08], "mass": 6.0}, "grain": soil(5e4, 5e5),
    },
    "cube on Didymos": {
        "delivery": {"speed": between(0.05, 0.2), "latitude_deg": 60.0, "longitude_deg": 10.0},
        "lander": {"edges": [0.15, 0.15, 0.15], "mass": 2.5}, "grain": soil(5e4, 5e5), "site": {"body": "didymos"},
    },
    "elastic, slippery grains": {
        "delivery": {"speed": between(0.06, 0.18)},
        "grain": soil(3e4, 3e5, restitution=between(0.8, 0.95), friction=between(0.2, 0.4)),
    },
    "slow, at the equator": {"delivery": {"speed": between(0.03, 0.09), "latitude_deg": 0.0, "longitude_deg": 90.0}},
    "spinning, 10 to 30 cm/s": {
        "delivery": {"speed": between(0.1, 0.3), "spin_x": between(-0.3, 0.3)}, "grain": soil(3e4, 3e5),
    },
}  # fmt: skip
LANDINGS: dict[str, dict[str, Row]] = {
    "first bounce of a ball": {"lander": BALL},
    "first bounce of a heavy box, 60 deg": {"lander": {"mass": 10.0}, "impact": {"incidence_deg": 60.0}},
    "first bounce at 0.25 m/s, 30 deg north": {"impact": {"speed": 0.25}, "site": {"latitude_deg": 30.0}},
}
JOURNEY_COUNT, LANDING_COUNT, FIRST_SEED = 60, 240, 501


def tables(name: str, seed: int) -> Row:
    follows = name in JOURNEYS
    count = {"journey": {"count": JOURNEY_COUNT}} if follows else {"design": {"run_count": LANDING_COUNT}}
    # A little wider than the bed of one ground, so that no grain of so many beds is too long for it.
    bed = {"bed": {"bed_count": None, "grain_count": 120, "width": [0.62, 0.62]}}
    path = SCENARIOS / ("one_ground.toml" if follows else "first_bounce.toml")
    return study_tables(path, count, bed, (JOURNEYS | LANDINGS)[name], seed=seed)


def answer_of(study: Study, folder: StudyFolder) -> Row:
    """Outcome and bed of each run of a finished study, and the half width of its answer."""
    if study.journey.touchdowns != 1:
        table = JourneyTable.load(folder)
        found, values, bed = end_share(table.rests, table.bed), table.rests.astype(float), table.bed
    else:
        runs, flights = DesignRuns.load(folder, "drawn"), RunFlights.load(folder, "drawn")
        values, bed = flights.returns, runs.inputs["bed"].astype(int)
        found = return_fraction(study, runs, flights)
    known = [None if np.isnan(one) else round(float(one), 5) for one in values]
    return {"half_width": half(found.share.lower, found.share.upper), "values": known, "bed": bed.tolist()}


def half(lower: float | None, upper: float | None) -> float:
    """Half the width of an interval."""
    assert lower is not None
    assert upper is not None
    return (upper - lower) / 2.0


def make(work: Path) -> None:
    """Make the fresh studies that are missing."""
    for number, name in enumerate(JOURNEYS | LANDINGS):
        if name in kept_runs():
            continue
        out, source = work / str(FIRST_SEED + number), StudySource.of_tables(tables(name, FIRST_SEED + number))
        run_study(source, out, until="runs" if name in JOURNEYS else "fly_runs", worker_count=1)
        write_document(RUNS, kept_runs() | {name: answer_of(source.study, StudyFolder(out))})
        print(name, flush=True)


def kept_runs() -> dict[str, Row]:
    """Outcomes and beds of studies, fresh ones by their name, others by that of their folder."""
    kept: dict[str, Row] = read_document(RUNS, {})
    return kept


def keep(folders: Iterable[Path]) -> None:
    """Keep the outcomes of finished journeys in folders of these."""
    for path in sorted(path for folder in folders for path in folder.glob("*/journeys.csv")):
        table = JourneyTable.load(StudyFolder.only_read(path.parent))
        one = {"values": table.rests.astype(int).tolist(), "bed": table.bed.tolist()}
        write_document(RUNS, kept_runs() | {f"{path.parent.parent.name}/{path.parent.name}": one})


def kept_half_width(name: str) -> float:
    """Half the interval of a study whose outcomes and beds are kept."""
    runs = kept_runs()[name]
    found = half_width_of([np.nan if one is None else one for one in runs["values"]], runs["bed"])
    assert found is not None
    return found


def all_alike(journeys: int, beds: int) -> float:
    """Half the interval where all of so many journeys end alike."""
    found = half_width_of(np.ones(journeys), np.arange(journeys) % beds)
    assert found is not None
    return found


def before(study: Study) -> HalfWidths:
    """What the plan of a study promises before a run."""
    design = DrawnDesign(with_site_gravity(study))
    soil = ExpectedSoil.of(design, len(design.inputs))
    with tempfile.TemporaryDirectory() as folder:
        found = expected_width(design, {}, StudyFolder.only_read(Path(folder) / "none"), soil)
    assert found is not None
    return HalfWidths(found.lower, found.median, found.upper)


def after(study: Study, values: np.ndarray, bed: np.ndarray, count: int) -> HalfWidths:
    """What it promises when so many runs have ended."""
    law, _ = law_of_runs(values[:count], bed[:count])
    missing = 0.0 if study.journey.touchdowns != 1 else float(np.mean(~np.isfinite(values[:count])))
    correlation = expected_correlation(study)
    found = half_width_range(
        law, bed[count:], values=values[:count], values_bed=bed[:count], missing=missing, correlation=correlation
    )
    assert found is not None
    return found


def quick(journeys: int, beds: int) -> Study:
    changes = {"journey": {"count": journeys}, "bed": {"bed_count": beds}}
    return check_tables(study_tables(SCENARIOS / "one_ground.toml", changes), SCENARIOS)


def row_of(group: str, name: str, study: Study, share: float, half_width: float, runs: Row | None = None) -> Row:
    """A study beside what is promised of it; runs: its outcomes and beds, where they are kept."""
    promises = {"before": before(study)}
    if runs is not None:
        values = np.array([np.nan if one is None else one for one in runs["values"]])
        count = len(values) // 3
        promises["after a third"] = after(study, values, np.array(runs["bed"]), count)
    row = {"group": group, "study": name, "runs": study.design.run_count, "beds": study.bed_count}
    row |= {"share": share, "half_width": half_width}
    for when in ("before", "after a third"):
        found = promises.get(when)
        numbers = (math.nan,) * 3 if found is None else found
        row |= {f"{when} {part}": one for part, one in zip(HalfWidths._fields, numbers, strict=True)}
    return rounded(row)


def kept_studies() -> Iterator[Row]:
    for name, runs in kept_runs().items():
        if name not in JOURNEYS | LANDINGS:
            continue
        study = check_tables(tables(name, FIRST_SEED), SCENARIOS)
        known = [one for one in runs["values"] if one is not None]
        # What the inputs explain narrows the interval of landings that differ.
        came_out = runs["half_width"] if name in LANDINGS and np.ptp(known) > 0.0 else kept_half_width(name)
        yield row_of("fresh", name, study, float(np.mean(known)), came_out, runs)
    for name in ("mission", "drawn_700"):
        study, runs = read_study(SHOWCASE / name / "study.toml"), showcase_runs(SHOWCASE / name)
        yield row_of("showcase", name, study, runs["share"], runs["half_width"], runs)
    pairs = read_rows(VALIDATION / "journey_seed_pairs.csv", {"setting": str})
    for one in pairs:
        name, study = f"{one['setting']}, seed {one['seed']:.0f}", quick(int(one["journeys"]), int(one["beds"]))
        yield row_of("seed pairs", name, study, one["at_rest value"], kept_half_width(f"pairs/{one['seed']:.0f}"))
    for name, one in read_document(VALIDATION / "emulated_journeys.json")["cases"].items():
        share, lower, upper = one["by_landings"]["at_rest"]
        # Where all rest the emulator narrows nothing.
        came_out = all_alike(one["journeys"], 8) if share == 1.0 else half(lower, upper)
        yield row_of("emulated journeys", name, quick(one["journeys"], 8), share, came_out)
    for one in read_document(VALIDATION / "delivery_options.json")["options"]:
        share, lower, upper = one["by_landings"]
        name = f"{one['incidence_deg']:g} deg"
        yield row_of("delivery options", name, quick(48, 24), share, half(lower, upper))


def showcase_runs(folder: Path) -> Row:
    """Outcomes and beds of a finished study that is kept, with its answer."""
    if (folder / "journeys.csv").exists():
        table = JourneyTable.load(StudyFolder.only_read(folder))
        found = end_share(table.rests, table.bed)
        answer = {"share": found.share.value, "half_width": half(found.share.lower, found.share.upper)}
        return answer | {"values": table.rests.astype(float).tolist(), "bed": table.bed.tolist()}
    runs = read_rows(folder / "runs" / "drawn.csv", {}, str)
    beds = {row["key"]: int(float(row["input:bed"])) for row in runs}
    rows = [row for row in read_rows(folder / "run_flights.csv", {}, str) if row["key"] in beds]
    returns = read_document(folder / "estimates.json")["returns"]
    answer = {"share": returns["share"], "half_width": half(returns["lower"], returns["upper"])}
    values = [float(row["returns"] or "nan") for row in rows]
    return answer | {"values": values, "bed": [beds[row["key"]] for row in rows]}


def inside(row: Row, when: str) -> bool:
    """Whether what came out lies within what was promised."""
    return bool(row[f"{when} lower"] <= row["half_width"] <= row[f"{when} upper"])


def counted(rows: list[Row]) -> Row:
    """In how many studies it does, by group and in all."""
    found: Row = {}
    for when in ("before", "after a third"):
        of = [row for row in rows if not math.isnan(row[f"{when} lower"])]
        for group in (*dict.fromkeys(row["group"] for row in of), "all"):
            judged = [inside(row, when) for row in of if group in (row["group"], "all")]
            found[f"{when}, {group}"] = {"inside": sum(judged), "studies": len(judged)}
    return found


def pooled(studies: list[Row]) -> Row:
    """Correlation of two runs on one bed over studies in which runs differ, with its standard error."""
    parts = []
    for one in studies:
        values = np.array([np.nan if value is None else value for value in one["values"]], dtype=float)
        known, bed = answered_runs(values, np.array(one["bed"]))
        if np.ptp(known) > 0.0:
            found = bed_components(known, bed)
            parts.append((found.bed_variance, found.bed_variance + found.within))
    sums = np.array(parts)
    left = sums.sum(axis=0) - sums
    ratios = left[:, 0] / left[:, 1]
    error = math.sqrt((len(sums) - 1) * float(ratios.var()))
    return {"studies": len(sums), "correlation": float(sums[:, 0].sum() / sums[:, 1].sum()), "error": error}


def correlations() -> Row:
    kept = kept_runs()
    journeys = [one for name, one in kept.items() if name not in LANDINGS] + [showcase_runs(SHOWCASE / "mission")]
    landings = [one for name, one in kept.items() if name in LANDINGS]
    landings.append(showcase_runs(SHOWCASE / "drawn_700"))
    return {"journeys": pooled(journeys), "landings": pooled(landings)}


def promise(row: Row, when: str) -> str:
    """A range [points], in bold where what came out is not in it."""
    ends = f"{100 * row[f'{when} lower']:.1f} to {100 * row[f'{when} upper']:.1f}"
    return ends if inside(row, when) else f"**{ends}**"


def page_table(rows: list[Row]) -> str:
    """Fresh studies and those of the showcase as a table in Markdown [points]."""
    lines = [
        (row["study"], f"{row['runs']}, {row['beds']}", f"{100 * row['share']:.0f}",
         *(promise(row, when) for when in ("before", "after a third")), f"{100 * row['half_width']:.1f}")
        for row in rows if row["group"] in ("fresh", "showcase")
    ]  # fmt: skip
    return table(("study", "runs, beds", "share [%]", "promised", "after a third", "came out"), lines) + "\n"


def main() -> None:
    work = Path(tempfile.gettempdir()) / "lithobrake_planned_width"
    parser = command_line(__doc__, work=work, page=False)
    parser.add_argument("--folders", nargs="+", type=Path, default=())
    options = parser.parse_args()
    if not options.page:
        keep(options.folders)
        make(options.work)
        rows = list(kept_studies())
        write_rows(TABLE, rows[0], rows)
        found = {"inside": counted(rows), "correlation": correlations()}
        write_document(TABLE.with_suffix(".json"), {**origin("validation/planned_width.py"), **found})
    print(page_table(read_rows(TABLE, {"group": str, "study": str, "runs": int, "beds": int})))


if __name__ == "__main__":
    main()
