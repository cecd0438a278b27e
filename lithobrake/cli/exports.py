"""Commands that write results as files of other programs, as the next study, or as a map of sites."""

from pathlib import Path
from typing import Annotated

import typer

from lithobrake.cli import arguments

Kinds = Annotated[
    list[str],
    typer.Option(
        "--to",
        metavar="KIND",
        help="oem, aem, spk, czml, plates, facets, geotiff, geojson, bounce-law, vtkhdf or sheet; may be repeated.",
    ),
]
Samples = Annotated[
    list[int] | None,
    typer.Option("--flight", metavar="SAMPLE", help="oem, aem, spk, czml: a sample to follow; may be repeated."),
]
Frame = Annotated[
    str,
    typer.Option("--frame", metavar="inertial|fixed|icrf", help="oem, aem: axes; icrf needs the pole of the study."),
]
Epoch = Annotated[
    str | None,
    typer.Option("--epoch", metavar="UTC", help="Date of all first touchdowns; default: the date of each, if known."),
]
Step = Annotated[
    float | None,
    typer.Option(
        "--step", metavar="SECONDS", help="Time between states; default: 1 % of the longest flight; aem: 10 degrees."
    ),
]
BodyNumber = Annotated[
    int | None, typer.Option("--body-number", metavar="N", help="spk: number of the body in SPICE, for a mesh.")
]
Resolution = Annotated[float, typer.Option("--resolution", metavar="DEGREES", help="geotiff: edge of a cell.")]
Again = Annotated[
    str | None,
    typer.Option("--run", metavar="ID", help="vtkhdf, sheet: the run to simulate again; default: the preview landing."),
]
Parameters = Annotated[
    list[str],
    typer.Option(
        "--over",
        metavar="KEY=FROM:TO",
        help="Delivery option and its range, KEY=FROM:TO or KEY=FROM:TO:COUNT; up to three (delivery.errors: factor).",
        show_default=False,
    ),
]


@arguments.command(arguments.EXPORT, "export runs/study --to oem --flight 12 --epoch 2026-11-22T12:00:00")
def export(
    folder: arguments.StudyDirectory,
    to: Kinds,
    flight: Samples = None,
    frame: Frame = "inertial",
    epoch: Epoch = None,
    step: Step = None,
    resolution: Resolution = 1.0,
    body_number: BodyNumber = None,
    run: Again = None,
    force: arguments.Force = False,
    out: Annotated[
        str | None, typer.Option("--out", metavar="FOLDER", help="Folder; the default is DIR/export.")
    ] = None,
    json: arguments.Json = False,
) -> None:
    """Write results of a study in the formats of other programs: flights, attitudes, shape, map, motions."""
    place = folder / "export" if out is None else arguments.given_folder(out, f"{folder}/export")
    from lithobrake.results import open_study

    # A folder that is no study is refused before numbers are loaded.
    results = open_study(folder)
    from lithobrake.export import ExportOptions, export_study

    with arguments.shown_progress("export") as progress:
        again = None if run is None else arguments.run_of(run)
        choices = ExportOptions(flight or (), frame, epoch, step, resolution, again, force, progress, body_number)
        written = export_study(results, place, to, choices)
    arguments.tell_result(
        json, {"files": [str(path.resolve()) for path in written]}, (f"Wrote {path}" for path in written)
    )


@arguments.command(arguments.EXPORT, "push runs/quick --speed 0.04 --elevation 45 --heading 90 --out push.csv")
def push(
    folder: arguments.StudyDirectory,
    speed: Annotated[float, typer.Option(help="Change of velocity, m/s.", show_default=False)],
    elevation: Annotated[float, typer.Option(help="Its angle above the plane of the ground, degrees.")] = 45.0,
    heading: Annotated[float, typer.Option(help="Its direction, from north toward east, degrees.")] = 0.0,
    speed_std: Annotated[float, typer.Option(help="Standard deviation of the speed, m/s.")] = 0.0,
    direction_std: Annotated[float, typer.Option(help="Standard deviation of the direction, degrees.")] = 0.0,
    spin: Annotated[float, typer.Option(help="Angular velocity after the push, rad/s.")] = 0.0,
    seed: Annotated[int, typer.Option(help="Seed of the errors.")] = 1,
    out: Annotated[
        Path, typer.Option("--out", metavar="FILE", help="Table for delivery.states of the next study.")
    ] = Path("push.csv"),
    force: arguments.Force = False,
) -> None:
    """Write the states of the landers at rest after a push, as the delivery of the next study."""
    from lithobrake.results import open_study

    results = open_study(folder)
    arguments.refuse_written(out, force)
    from lithobrake.export import Push, write_push

    count = write_push(results, out, Push(speed, elevation, heading, speed_std, direction_std, spin, seed))
    arguments.tell([f"Wrote {count} states to {out}: delivery.states of the next study, with journey.count = {count}."])


@arguments.command(arguments.LOOK, "sites study.toml --cells 200")
def sites(
    study: arguments.StudyPath,
    cells: Annotated[int, typer.Option("--cells", metavar="N", help="Number of sites (cells of equal area).")] = 120,
    landers: Annotated[int, typer.Option("--landers", metavar="N", help="Landers per site.")] = 200,
    out: arguments.OutPath = None,
    workers: arguments.Workers = None,
    scheduler: arguments.Scheduler = None,
    force: arguments.Force = False,
    json: arguments.Json = False,
) -> None:
    """Map one delivery over a body: fraction at rest, time, distance, slope and light by site. Writes DIR/sites."""
    folder = arguments.study_folder(study, out)
    from lithobrake.study import StudySource

    source = StudySource.read(study)
    from lithobrake.export.maps import site_cells_file, write_site_cells
    from lithobrake.files.atomic import refuse_existing
    from lithobrake.pipeline import map_sites, site_lines, site_map_files, write_site_map
    from lithobrake.progress import study_progress
    from lithobrake.results.study_files import json_values

    place = folder / "sites"
    written = () if force else (*site_map_files(place), site_cells_file(place))
    # Before the landers are followed, which takes minutes.
    refuse_existing(written, "move it away, or replace it with --force")
    with study_progress() as shown:
        found = map_sites(
            source, folder, cell_count=cells, lander_count=landers, worker_count=workers, scheduler=scheduler,
            shown=shown,
        )  # fmt: skip
    paths = [*write_site_map(found, source.content.decode(), place), write_site_cells(found, place)]
    beside = ", ".join(one.name for one in paths[1:])
    lines = [*site_lines(found), f"Page: {paths[0].resolve()}", f"In the same folder: {beside}"]
    arguments.tell_result(json, json_values(found), lines)


@arguments.command(arguments.LOOK, "search runs/study --images images.csv --field-deg 5.5 --image-pixels 1020")
def search(
    folder: arguments.StudyDirectory,
    images: Annotated[
        Path,
        typer.Option(
            "--images",
            metavar="FILE.csv",
            help="Images that could be taken: time, x_m, y_m, z_m of the orbiter, sun_x, sun_y, sun_z; body-fixed.",
            show_default=False,
        ),
    ],
    field_deg: Annotated[float, typer.Option(help="Full field of view of the camera, degrees.", show_default=False)],
    image_pixels: Annotated[int, typer.Option(help="Pixels across it.", min=1, show_default=False)],
    lander_pixels: Annotated[float, typer.Option(help="Pixels along the lander by which it is recognised.")] = 3.0,
    emission_deg: Annotated[float, typer.Option(help="Largest angle of the camera to the ground normal, deg.")] = 75.0,
    sun_deg: Annotated[float, typer.Option(help="Least elevation of the Sun above the ground, degrees.")] = 5.0,
    size: Annotated[
        float | None, typer.Option(help="Longest extent of the lander, m; default: by the study file.")
    ] = None,
    count: Annotated[int, typer.Option("--count", metavar="N", help="Most images.", min=1)] = 20,
    out: Annotated[Path | None, typer.Option("--out", metavar="DIR", help="Folder of the files.")] = None,
    force: arguments.Force = False,
) -> None:
    """Order images of an orbiter by the chance that they show a lost lander. Writes search.csv and search.png."""
    from lithobrake.pipeline import imager_of, search_files, search_lander, search_lines, write_search
    from lithobrake.results import open_study

    results, place = open_study(folder), out or folder
    for path in search_files(place):
        arguments.refuse_written(path, force)
    imager = imager_of(field_deg, image_pixels, lander_pixels, emission_deg, sun_deg)
    found = search_lander(results, images, imager, count=count, size=size)
    paths = write_search(found, imager, place)
    arguments.tell([*search_lines(found), *(f"Wrote {path}" for path in paths)])


@arguments.command(arguments.LOOK, "requirement study.toml near --over delivery.errors=0.5:3 --check 48")
def requirement(
    study: arguments.StudyPath,
    name: Annotated[str, typer.Argument(metavar="NAME", help="Limit state of journeys.", show_default=False)],
    over: Parameters,
    probability: Annotated[float, typer.Option("--probability", metavar="P", help="Least probability.")] = 0.9,
    confidence: Annotated[float, typer.Option("--confidence", metavar="P", help="Level of the intervals.")] = 0.9,
    landers: Annotated[int, typer.Option("--landers", metavar="N", help="Landers per delivery.")] = 1000,
    check: Annotated[int, typer.Option("--check", metavar="N", help="Simulated journeys per corner.", min=0)] = 0,
    out: arguments.OutPath = None,
    workers: arguments.Workers = None,
    scheduler: arguments.Scheduler = None,
    force: arguments.Force = False,
) -> None:
    """Find the deliveries that still meet a limit state with a probability. Writes DIR/requirement.csv and .png."""
    folder = arguments.study_folder(study, out)
    from lithobrake.study import StudySource

    source = StudySource.read(study)
    from lithobrake import pipeline
    from lithobrake.files.atomic import refuse_existing
    from lithobrake.progress import study_progress

    grid = pipeline.grid_of_ranges(over)
    # With corners also where none are asked for: those of another requirement are removed.
    written = () if force else pipeline.requirement_files(folder, simulated=True)
    # Before the landers are followed, which takes minutes.
    refuse_existing(written, "move it away, or replace it with --force")
    with study_progress() as shown:
        found = pipeline.find_requirement(
            source, folder, name, grid, probability=probability, confidence=confidence, lander_count=landers,
            simulated_count=check, worker_count=workers, scheduler=scheduler, shown=shown,
        )  # fmt: skip
    paths = pipeline.write_requirement(found, folder)
    arguments.tell([*pipeline.requirement_lines(found), *(f"Wrote {path}" for path in paths)])
