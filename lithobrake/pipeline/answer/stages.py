"""The stages of estimates and of the summary."""

from lithobrake.pipeline.answer.drawn_summary import write_drawn_summary
from lithobrake.pipeline.answer.journey_summary import write_journey_summary
from lithobrake.pipeline.answer.run_estimates import FILE, estimate
from lithobrake.pipeline.answer.summary_parts import summary_dependencies
from lithobrake.pipeline.stage import Stage, same_files

PARTS = (
    *("pipeline/answer", "pipeline/site.py", "pipeline/emulated/answers.py"),
    *("analysis", "chaos", "emulator", "results", "vocabulary"),
)

ESTIMATE = Stage("estimate", "estimates", same_files(FILE), estimate, ("fly_runs",), parts=PARTS)
JOURNEY_SUMMARY = Stage(
    "summary",
    "summary",
    same_files("summary.json"),
    write_journey_summary,
    ("landing", "telling_landing", "estimate", "emulated", "aim", "sky"),
    summary_dependencies,
    PARTS,
)
SUMMARY = Stage(
    "summary",
    "summary",
    same_files("summary.json"),
    write_drawn_summary,
    ("landing", "telling_landing", "estimate", "rest", "aim"),
    summary_dependencies,
    PARTS,
)
