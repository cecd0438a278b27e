"""The stages of flights."""

from lithobrake.pipeline.fly.flight_paths import FILE as PATHS
from lithobrake.pipeline.fly.flights import flight_dependencies, fly_samples
from lithobrake.pipeline.fly.run_flights import FILE, IMPACTS, fly_runs, run_flight_dependencies
from lithobrake.pipeline.stage import Stage, same_files

FILES = ("flights.csv", "flights.json", "body.obj", PATHS)
PARTS = (
    "pipeline/fly",
    "pipeline/site.py",
    "pipeline/emulate/outgoing.py",
    "pipeline/emulate/samples.py",
    "pipeline/runs/run_table.py",
    "smallbody",
    "geometry",
    "chaos",
    "vocabulary/quantities.py",
)

FLY_RUNS = Stage(
    "fly_runs",
    "flights of the runs",
    same_files(FILE, IMPACTS),
    fly_runs,
    ("side_runs",),
    run_flight_dependencies,
    PARTS,
)
FLY = Stage("fly", "flights", same_files(*FILES), fly_samples, ("sample",), flight_dependencies, PARTS)
