"""What the reader of states says of the sample messages of another reader, beside the verdict of their authors.

    python validation/deliveries/oem_samples.py --samples FOLDER

FOLDER is the folder tests/samples of https://github.com/bradsease/oem at 126d02a (MIT licence); its folders name the
verdicts: valid, invalid, and real for messages that flight software wrote. Writes oem_samples.csv beside this script:
one line a file, the verdict, what became of it, and of a refusal the sentence. A message is read for its own centre.
"""

import re
import sys
from pathlib import Path

from lithobrake.study.delivered_states import ICRF_NAMES, read_states

sys.path.insert(0, str(Path(__file__).parents[1]))
sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from harness import Row, command_line, write_made, write_rows

TABLE = Path(__file__).with_suffix(".csv")
COLUMNS = ("file", "verdict", "form", "states", "refusal", "about")
# Of a message its authors call invalid: what it is about, by its first comment.
COMMENT = re.compile(r"^(?:COMMENT|<COMMENT>)\s+(.+?)(?:</COMMENT>)?$", re.MULTILINE)


def form_of(path: Path, text: str) -> str:
    """Text of keywords, XML, or compressed."""
    if path.suffix not in (".oem", ".skip"):
        return "compressed"
    return "XML" if text.lstrip().startswith("<") else "text"


def row_of(path: Path, samples: Path) -> Row:
    """Read one file as the states of a study about the centre that it names, along the axes that it names."""
    try:
        text = path.read_text(encoding="utf-8")
    except UnicodeDecodeError:
        text = ""
    said = {key: re.findall(rf"^{key}\s*=\s*(.*?)\s*$", text, re.MULTILINE) for key in ("CENTER_NAME", "REF_FRAME")}
    centres = [re.sub(r"\W+", "_", name).upper() for name in said["CENTER_NAME"]] or ["EARTH"]
    frame = "icrf" if set(said["REF_FRAME"]) <= set(ICRF_NAMES) else "body_fixed"
    count, refusal = 0, ""
    try:
        count = len(read_states(path, frame, None, centres).time)
    except ValueError as error:
        refusal = " ".join(str(error).split())
    verdict = path.parent.name
    about = (COMMENT.findall(text) or [""])[0] if verdict == "invalid" else ""
    return {
        "file": path.relative_to(samples).as_posix(), "verdict": verdict, "form": form_of(path, text),
        "states": count, "refusal": refusal, "about": about,
    }  # fmt: skip


def main() -> None:
    samples = command_line(__doc__, samples=Path).parse_args().samples
    rows = [row_of(path, samples) for path in sorted(samples.rglob("*")) if path.is_file()]
    write_rows(TABLE, COLUMNS, rows)
    write_made(TABLE, "validation/deliveries/oem_samples.py --samples FOLDER", commit="126d02a", rows=len(rows))
    for verdict in ("real", "valid", "invalid"):
        own = [row for row in rows if row["verdict"] == verdict]
        for form in dict.fromkeys(row["form"] for row in own):
            these = [row for row in own if row["form"] == form]
            print(f"{verdict}, {form}: {sum(row['states'] > 0 for row in these)} of {len(these)} read")


if __name__ == "__main__":
    main()
