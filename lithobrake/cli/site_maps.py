"""The command that maps what becomes of one delivery over a body."""

from typing import Annotated

import typer

from lithobrake.cli.arguments import (
    ExecutorName,
    Force,
    Json,
    OutPath,
    Scheduler,
    StudyPath,
    Workers,
    app,
    given_folder,
    refuse_written,
    scheduler_of,
    study_folder,
)
from lithobrake.cli.terminal import one_sentence, tell, tell_json


@app.command(epilog="Example: lithobrake sites study.toml --cells 200")
def sites(
    study: StudyPath,
    cells: Annotated[int, typer.Option("--cells", metavar="N", help="Sites: cells of equal area.")] = 120,
    landers: Annotated[int, typer.Option("--landers", metavar="N", help="Landers of each site.")] = 200,
    out: OutPath = None,
    to: Annotated[
        str | None, typer.Option("--map", metavar="FOLDER", help="Folder of the map; the default is DIR/sites.")
    ] = None,
    workers: Workers = None,
    executor: ExecutorName = "local",
    scheduler: Scheduler = None,
    force: Force = False,
    json: Json = False,
) -> None:
    """Map what becomes of one delivery at every site of a body: at rest, when, how far, slope and light."""
    folder, address = study_folder(study, out), scheduler_of(executor, scheduler)
    place = folder / "sites" if to is None else given_folder(to)
    with one_sentence():
        from lithobrake.study import StudySource

        source = StudySource.read(study)
        from lithobrake.export.site_cells import site_cells_file, write_site_cells
        from lithobrake.pipeline import map_sites, site_lines, site_map_files, write_site_map
        from lithobrake.progress import study_progress
        from lithobrake.results.json_values import to_json

        for path in (*site_map_files(place), site_cells_file(place)):
            refuse_written(path, force)
        with study_progress() as shown:
            found = map_sites(
                source, folder, cell_count=cells, lander_count=landers, worker_count=workers, scheduler=address,
                shown=shown,
            )  # fmt: skip
        written = [*write_site_map(found, source.content.decode(), place), write_site_cells(found, place)]
    if json:
        tell_json(to_json(found))
    else:
        tell(
            [
                *site_lines(found),
                f"Page: {written[0].resolve()}",
                f"Cells: {', '.join(str(one) for one in written[1:])}",
            ]
        )
