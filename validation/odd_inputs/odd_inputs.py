"""Odd inputs, each made by chance from a seed: studies, files and options; what becomes of them is counted by class.

right: it is done. refused: a sentence says what to do. silent: what can never be valid is taken, a number of the result
is not finite, or a warning of NumPy reaches the user. late: `plan` accepts it, and the study ends because of it.
traceback: an error without a sentence. endless: no end within three minutes. The last four should be none: each such
case is printed, and makes the exit code 1. The counts go to odd_inputs.json beside this script.

    python validation/odd_inputs/odd_inputs.py --studies 700 --files 200 --options 200 --seed 1
"""

import random
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from harness import Row, command_line, origin, revision, write_document
from judge import FAULTS, LONGEST, REFUSED, RIGHT, Case, judged
from odd_files import file_cases
from odd_options import option_cases
from odd_studies import study_cases

RESULTS = Path(__file__).with_suffix(".json")
# Cases after which the counts are written.
OFTEN = 20


def cases(counts: dict[str, int], seed: int, folder: Path) -> Iterator[tuple[str, Case]]:
    """The cases of a seed by what they are of; folder: for finished studies, whose files and folders are made odd."""
    makers = {
        "studies": study_cases,
        "options": lambda chance, count: option_cases(chance, count, folder),
        "files": lambda chance, count: file_cases(chance, count, folder),
    }
    for name, make in makers.items():
        if counts[name]:
            yield from ((name, case) for case in make(random.Random(f"{seed} {name}"), counts[name]))


def counted(counts: dict[str, int], seed: int, longest: float = LONGEST) -> Iterator[Row]:
    """Judge the cases of a seed, and give after each how many are in each class, by what they are of and by kind;
    prints the faults.
    """
    by_source: dict[str, Counter[str]] = {}
    by_kind: dict[str, Counter[str]] = {}
    with tempfile.TemporaryDirectory() as studies:
        for number, (source, case) in enumerate(cases(counts, seed, Path(studies)), start=1):
            with tempfile.TemporaryDirectory() as folder:
                found = judged(case, Path(folder), longest)
            by_source.setdefault(source, Counter())[found.name] += 1
            by_kind.setdefault(f"{source}, {case.kind}", Counter())[found.name] += 1
            if found.name in FAULTS:
                print(f"{found.name}: {source} {number}, {case.kind}: {case.words}\n  {found.words}", flush=True)
            whole = sum(by_source.values(), Counter[str]())
            classes = {name: whole[name] for name in (RIGHT, REFUSED, *FAULTS)}
            kinds = dict(sorted(by_kind.items()))
            yield {"cases": number, "classes": classes, "sources": by_source, "kinds": kinds}


def main() -> int:
    asked = command_line(__doc__, studies=700, files=200, options=200, seed=1, longest=float(LONGEST))
    given = asked.parse_args()
    counts = {name: getattr(given, name) for name in ("studies", "options", "files")}
    how = origin(" ".join(["validation/odd_inputs/odd_inputs.py", *sys.argv[1:]]))
    how |= {"seed": given.seed, "commit": revision()}
    found: Row = {"cases": 0, "classes": {}}
    for found in counted(counts, given.seed, given.longest):
        # As they come: a run that is stopped keeps what it has counted.
        if found["cases"] % OFTEN == 0:
            write_document(RESULTS, how | {"cpu_s": round(time.process_time())} | found)
    write_document(RESULTS, how | {"cpu_s": round(time.process_time())} | found)
    print(", ".join(f"{count} {name}" for name, count in found["classes"].items()))
    return int(any(found["classes"].get(name) for name in FAULTS))


if __name__ == "__main__":
    sys.exit(main())
