"""The example of a ball on a plate with few runs: a whole study within seconds, and no bed."""

import sys
from pathlib import Path

EXAMPLES = Path(__file__).parents[2] / "examples"
BALL, PROGRAM = EXAMPLES / "ball_on_plate.toml", EXAMPLES / "ball_on_plate.py"
# Without looking for packages, of which the program needs none: sooner there, for each run.
PYTHON = f"{sys.executable} -S"
# Changes of its text, old by new; a later change of the same text takes the place of an earlier one.
FEW_RUNS = {"screening_level = 2": "screening_level = 1", "screening_degree = 2": "screening_degree = 1",
    "refined_level = 3": "refined_level = 1", "refined_degree = 3": "refined_degree = 1",
    "test_count = 10": "test_count = 2"}  # fmt: skip
FEW_SAMPLES = {
    "sample_count = 10_000": "sample_count = 200",
    "flight_count = 50": "flight_count = 5",
    "count = 200 ": "count = 5 ",
}
# What the example says of its expansions, of one place and of one bed, in the place of which `drawn` stands.
EXPANSIONS = """[design]
run_count = 0

[expansion]
screening_level = 2
screening_degree = 2
refined_level = 3
refined_degree = 3
kept_outputs = ["speed_out"]
test_count = 10
"""
ONE_PLACE = "azimuth_deg = 0.0\nplace = { x = 0.0, y = 0.0 }\norientation = [1.0, 0.0, 0.0, 0.0]\n"
ONE_BED = 'sides = "walls"\nbed_count = 1\n'


def write_ball(path: Path, changes: dict[str, str], program: Path = PROGRAM) -> Path:
    """Write the study file of the example, with these changes of its text and the Python of these tests."""
    path.write_text(BALL.read_text())
    return edit(path, {"python3 ball_on_plate.py": f"{PYTHON} {program}"} | changes)


def edit(path: Path, changes: dict[str, str]) -> Path:
    """Change the text of a file; each old text has to be there."""
    text = path.read_text()
    for old, new in changes.items():
        assert old in text
        text = text.replace(old, new)
    path.write_text(text)
    return path


def drawn(run_count: int, more: str = "") -> dict[str, str]:
    """Changes for a study that draws so many landers, and more lines of [design]."""
    return {EXPANSIONS: f"[design]\nrun_count = {run_count}\n{more}", ONE_PLACE: "", ONE_BED: ""}
