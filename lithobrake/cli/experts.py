"""Commands for experts: soil from bounces, probabilities of rare outcomes, and single stages of a study."""

from pathlib import Path
from typing import Annotated

import typer

from lithobrake.cli.arguments import (
    EXPERT,
    ExecutorName,
    OutPath,
    Scheduler,
    StudyDirectory,
    StudyPath,
    Workers,
    app,
    one_sentence,
    scheduler_of,
    shown_progress,
    study_folder,
    tell,
)
from lithobrake.cli.studies import study_command


@app.command(rich_help_panel=EXPERT, epilog="Example: lithobrake rare study.toml fast --landings 500")
def rare(
    study: StudyPath,
    name: Annotated[
        str, typer.Argument(metavar="NAME", help="Name of a limit state of the study.", show_default=False)
    ],
    landings: Annotated[int, typer.Option("--landings", metavar="N", help="Landings per level.")] = 500,
    out: OutPath = None,
    workers: Workers = None,
    executor: ExecutorName = "local",
    scheduler: Scheduler = None,
) -> None:
    """Estimate the probability of a rare limit state by subset simulation with landings; writes rare_NAME.json."""
    folder, address = study_folder(study, out), scheduler_of(executor, scheduler)
    with one_sentence():
        from lithobrake.study import StudySource

        source = StudySource.read(study)
        from lithobrake.pipeline import rare_failure
        from lithobrake.progress import study_progress

        with study_progress() as shown:
            found = rare_failure(
                source, folder, name, landing_count=landings, worker_count=workers, scheduler=address, shown=shown
            )
    tell([found["statement"], f"Written: {folder / f'rare_{name}.json'}"])


@app.command(rich_help_panel=EXPERT, epilog="Example: lithobrake infer runs/study --bounce bounces.csv")
def infer(
    folder: StudyDirectory,
    bounce: Annotated[
        Path | None,
        typer.Option(
            "--bounce", metavar="FILE", help="Observed bounces, a CSV file. If omitted, report identifiability only."
        ),
    ] = None,
) -> None:
    """Infer the soil from observed bounces with the emulator of a study; writes posterior.json and posterior.png."""
    with one_sentence():
        from lithobrake.pipeline import InferredStudy, infer_study

        study = InferredStudy.open(folder)
        with shown_progress("inference") as progress:
            progress(0.0, "identifiability")
            plan = study.plan().lines()
            if bounce is not None:
                progress(0.5, "posterior")
            found = None if bounce is None else infer_study(folder, bounce)
    tell(plan)
    if found is not None:
        written = f"Posterior: {folder / 'posterior.json'}, {folder / 'posterior.png'}"
        tell([line for line in (found["statement"], found["beds"], written) if line])


study_command("bed", "Pour and settle the beds, and simulate a preview landing.", EXPERT, until="landing")
study_command("screen", "Paper method: run the screening design and fit an expansion in all inputs.", EXPERT)
study_command("refine", "Paper method: run the refined design and fit an expansion in the kept inputs.", EXPERT)
study_command("test", "Paper method: run the test points and score the expansions on them.", EXPERT)
study_command("sample", "Take Monte Carlo samples of the emulator (paper method: of the refined expansion).", EXPERT)
study_command("fly", "Fly the samples that leave the surface to their next impact.", EXPERT)
study_command("rest", "Follow samples from bounce to bounce until they come to rest.", EXPERT)
