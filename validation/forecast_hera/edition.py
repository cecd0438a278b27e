"""Make an edition of the forecast from measurements: one command.

    python validation/forecast_hera/edition.py MEASUREMENTS [--date DATE] [--landers FOLDER] [--editions FOLDER]

The newest landers without measurements that an edition has, or those that forecast.py simulated to a folder, are
weighted by what was measured. The edition is a folder of its date: the measurements; forecast.json, the answers, what
each measurement changed, and what landers of other assumptions (assumptions.py) did; a table of the predicted landings
of each lander and ground, for `lithobrake score`; and SHA256SUMS, the hashes of its contents and of its landers. It is
never written over. Last the pages of the forecast are written.
"""

import csv
import datetime
import os
import shutil
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[1]))
sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))

import hard_ground
import numpy as np
from answers import FIRST_EDITION, FORECAST, HERE, SCRIPTS, answer, digest
from assumptions import ASSUMPTIONS, FIRST
from branches import LANDERS, SCENARIOS
from changes import apart, changes
from harness import Row, command_line, origin, read_document, read_rows, write_document
from landers import KINDS, RUNS, TABLE
from measured_branches import measured_branches
from measurements import DRAWN, Measurement, read_measurements
from samples import GROUNDS, Sample, sample
from weights import effective_numbers, refuse_few, weighted

EDITIONS = FIRST_EDITION.parent
MEASURED, SUMS = "measurements.toml", "SHA256SUMS"
# What works out weights and answers.
WEIGHERS = (
    "measurements.py", "measured_branches.py", "weights.py", "samples.py", "answers.py", "places.py", "changes.py",
)  # fmt: skip
# Columns of a table of predicted landings, by those of the landers (docs/scoring.md).
SCORED = {
    "end": "end", "time_s": "time_s", "contacts": "contacts", "distance": "distance",
    "speed_ratio": "first_speed_ratio", "latitude_deg": "latitude_deg", "longitude_deg": "longitude_deg",
}  # fmt: skip


def editions(folder: Path = EDITIONS) -> list[Path]:
    """The folders of all editions, in the order of their dates."""
    return sorted(one.parent for one in folder.glob(f"????-??-??/{FORECAST}"))


def assumed_landers(folder: Path = EDITIONS) -> Path:
    """The folder of the newest edition that has landers of its own, simulated without measurements; else the first."""
    own = [one for one in editions(folder) if (one / TABLE).exists() and not (one / DRAWN).exists()]
    return own[-1] if own else FIRST_EDITION


def make_edition(file: Path, date: datetime.date, landers: Path | None = None, folder: Path = EDITIONS) -> Path:
    """Make the edition of a date, and return its folder. Raises ValueError in one sentence for what cannot be one."""
    target, landers = folder / date.isoformat(), landers or assumed_landers(folder)
    refuse_date(target, folder)
    measurements = read_measurements(file)
    for one in measurements:
        if one.date > date:
            raise ValueError(f"{file}: {one.quantity} is of {one.date}, after the edition of {date}; change a date")
    rows, drawn, digests = landers_of(landers)
    name = assumptions_of(landers)
    ASSUMPTIONS[name].refuse_unused(measurements)
    own = {lander: weighted(rows, lander, measurements, drawn) for lander in LANDERS}
    effective = {lander: effective_numbers(own[lander], lander) for lander in LANDERS}
    for lander in LANDERS:
        refuse_few(effective[lander], lander)
    document = {
        "made": date.isoformat(), "assumptions": name,
        "landers_of": landers.name if is_kept(landers, folder) else date.isoformat(),
        "sha256": digests | {"measurements": digest(file), "weights": digest(*(HERE / one for one in WEIGHERS))},
        "measurements": [
            {"words": one.words, "date": one.date.isoformat(), "source": one.source, "used": one.is_used}
            for one in measurements
        ],
        "effective": effective,
        "changes": measured_changes(landers, folder, measurements),
        "against": against(own, landers, folder),
        "landers": {name: answers(own[name], name, measurements) for name in LANDERS},
        **origin("validation/forecast_hera/edition.py MEASUREMENTS"),
    }  # fmt: skip
    write_edition(target, document, file, landers, own)
    return target


def assumptions_of(landers: Path) -> str:
    """The name of the assumptions of landers in a folder."""
    return str(read_document(landers / RUNS).get("assumptions", FIRST.name))


def measured_changes(landers: Path, folder: Path, measurements: tuple[Measurement, ...]) -> list[dict[str, Any]]:
    """What each measurement changed alone, in the newest landers without measurements of the same assumptions."""
    kept = assumed_landers(folder)
    base = kept if assumptions_of(kept) == assumptions_of(landers) or (landers / DRAWN).exists() else landers
    rows = read_rows(base / TABLE, KINDS)
    return [row for lander in LANDERS for row in changes(rows, lander, measurements)]


def against(own: dict[str, list[Row]], landers: Path, folder: Path) -> dict[str, Any]:
    """Differences to the landers of the edition before, where these have other assumptions; nothing elsewhere."""
    before = assumed_landers(folder)
    if is_kept(landers, folder) or assumptions_of(before) == assumptions_of(landers):
        return {}
    rows = read_rows(before / TABLE, KINDS)
    return {
        "edition": before.name,
        "landers": {name: apart(weighted(rows, name, ()), own[name], name) for name in LANDERS},
    }


def answers(rows: list[Row], lander: str, measurements: Iterable[Measurement]) -> dict[str, Any]:
    """The answers of a lander on each ground of the measured body."""
    axes = 0.5 * np.array(measured_branches(lander, measurements)[0].tables(1)["site"]["extents"])
    return {ground: answer(rows, lander, ground, axes) for ground in GROUNDS}


def refuse_date(target: Path, folder: Path) -> None:
    last = editions(folder)[-1].name if editions(folder) else ""
    if target.exists() or target.name <= last:
        raise ValueError(
            f"the edition of {target.name} would not be later than that of {last or target.name}, and editions are "
            "never edited; give a later --date"
        )


def landers_of(folder: Path) -> tuple[list[Row], tuple[Measurement, ...], dict[str, Any]]:
    """Landers of a folder, the measurements that they were simulated with, and the hashes of what they come from."""
    rows = read_rows(folder / TABLE, KINDS)
    if not rows or not (folder / RUNS).exists():
        raise ValueError(
            f"--landers is {folder}, without {TABLE} or {RUNS}; allowed: a folder that forecast.py wrote; name one"
        )
    runs = read_document(folder / RUNS)
    digests = read_document(folder / FORECAST, {}).get("sha256") or {
        "studies": runs["studies_sha256"],
        "branches": digest(*(HERE / one for one in SCRIPTS), Path(hard_ground.__file__)),
        "code": runs["code_sha256"], "results": digest(folder / TABLE),
    }  # fmt: skip
    # Laws of the inputs are read from the studies, and must be those that the landers drew.
    for name, known in digests["studies"].items():
        if digest(SCENARIOS / f"{name}.toml") != known:
            raise ValueError(f"scenarios/{name}.toml is not that of the landers in {folder}; restore it")
    if digest(folder / TABLE) != digests["results"]:
        raise ValueError(f"{folder / TABLE} is not that of its hash {digests['results']}; restore it")
    drawn = read_measurements(folder / DRAWN) if (folder / DRAWN).exists() else ()
    return rows, drawn, digests


def is_kept(landers: Path, folder: Path) -> bool:
    """Whether landers are those of an edition of this folder, and need no copy."""
    return landers.resolve().parent == folder.resolve()


def write_edition(
    target: Path, document: dict[str, Any], file: Path, landers: Path, rows: dict[str, list[Row]]
) -> None:
    """Write the folder of an edition, whole or not at all."""
    draft = target.with_name(f"{target.name}.part")
    shutil.rmtree(draft, ignore_errors=True)
    draft.mkdir(parents=True)
    shutil.copy(file, draft / MEASURED)
    write_document(draft / FORECAST, document)
    write_predicted(draft, rows)
    is_there = is_kept(landers, target.parent)
    for name in () if is_there else (TABLE, RUNS, DRAWN):
        if (landers / name).exists():
            shutil.copy(landers / name, draft / name)
    write_sums(draft, landers / TABLE if is_there else None)
    draft.replace(target)


def write_predicted(folder: Path, rows: dict[str, list[Row]]) -> None:
    """Write the predicted landings of each lander and ground as `lithobrake score` reads them."""
    for lander in rows:
        for ground in GROUNDS:
            of = sample(rows[lander], lander, ground)
            with (folder / f"{lander}_{ground}.csv").open("w", newline="", encoding="utf-8") as file:
                columns = ["weight", "bed", *SCORED, *(["face"] if ground == "soil" else [])]
                writer = csv.DictWriter(file, columns, lineterminator="\n")
                writer.writeheader()
                writer.writerows(predicted_rows(of, ground))


def predicted_rows(of: Sample, ground: str) -> list[Row]:
    """Rows of a table of predicted landings; hard ground does not turn a lander, and has no side."""
    found = []
    for row, weight, bed in zip(of.rows, of.weight, of.beds, strict=True):
        cells = {name: row[column] for name, column in SCORED.items()}
        if ground == "soil":
            cells["face"] = row["face"]
        known = {key: _cell(value) for key, value in cells.items()}
        found.append({"weight": f"{weight:.6g}", "bed": int(bed), **known})
    return found


def _cell(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.6g}" if np.isfinite(value) else ""
    return str(value)


def write_sums(folder: Path, *others: Path | None) -> None:
    """Write the hashes of all files of an edition, and of others elsewhere, as sha256sum reads them."""
    paths = {one.name: one for one in sorted(folder.iterdir()) if one.name != SUMS}
    for one in others:
        if one is not None:
            paths[Path(os.path.relpath(one, folder)).as_posix()] = one
    lines = [f"{digest(path)}  {name}\n" for name, path in paths.items()]
    (folder / SUMS).write_text("".join(lines), encoding="utf-8", newline="\n")


def main() -> None:
    parser = command_line(__doc__, "measurements", editions=EDITIONS)
    parser.add_argument("--landers", type=Path)
    parser.add_argument("--date", type=datetime.date.fromisoformat, default=datetime.date.today())
    options = parser.parse_args()
    try:
        target = make_edition(options.measurements, options.date, options.landers, options.editions)
    except ValueError as error:
        raise SystemExit(str(error)) from error
    print(f"{target}: {digest(target / SUMS)}")
    if options.editions.resolve() == EDITIONS:
        from write_editions import DOCS, write_all

        write_all(EDITIONS, DOCS)


if __name__ == "__main__":
    main()
