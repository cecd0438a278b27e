"""The command that maps what becomes of one delivery over a body."""

from typing import Annotated

import typer

from lithobrake.cli.arguments import (
    LOOK,
    ExecutorName,
    Force,
    Json,
    OutPath,
    Scheduler,
    StudyPath,
    Workers,
    app,
    scheduler_of,
    study_folder,
)
from lithobrake.cli.terminal import one_sentence, tell, tell_json


@app.command(rich_help_panel=LOOK, epilog="Example: lithobrake sites study.toml --cells 200")
def sites(
    study: StudyPath,
    cells: Annotated[int, typer.Option("--cells", metavar="N", help="Number of sites (cells of equal area).")] = 120,
    landers: Annotated[int, typer.Option("--landers", metavar="N", help="Landers per site.")] = 200,
    out: OutPath = None,
    workers: Workers = None,
    executor: ExecutorName = "local",
    scheduler: Scheduler = None,
    force: Force = False,
    json: Json = False,
) -> None:
    """Map one delivery over a body: fraction at rest, time, distance, slope and light by site. Writes DIR/sites."""
    folder, address = study_folder(study, out), scheduler_of(executor, scheduler)
    with one_sentence():
        from lithobrake.study import StudySource

        source = StudySource.read(study)
        from lithobrake.export.site_cells import site_cells_file, write_site_cells
        from lithobrake.files.atomic import refuse_existing
        from lithobrake.pipeline import map_sites, site_lines, site_map_files, write_site_map
        from lithobrake.progress import study_progress
        from lithobrake.results.json_values import to_json

        place = folder / "sites"
        written = () if force else (*site_map_files(place), site_cells_file(place))
        refuse_existing(written, "move it away, or replace it with --force")
        with study_progress() as shown:
            found = map_sites(
                source, folder, cell_count=cells, lander_count=landers, worker_count=workers, scheduler=address,
                shown=shown,
            )  # fmt: skip
        paths = [*write_site_map(found, source.content.decode(), place), write_site_cells(found, place)]
    if json:
        tell_json(to_json(found))
        return
    tell([*site_lines(found), f"Page: {paths[0].resolve()}", f"Beside it: {', '.join(one.name for one in paths[1:])}"])
