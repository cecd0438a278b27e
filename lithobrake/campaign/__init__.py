"""Many runs of any model: each is computed once, kept in a ledger the moment it ends, and never lost."""

from lithobrake.campaign.command import Command, absolute_words
from lithobrake.campaign.dask_executor import DaskExecutor
from lithobrake.campaign.ledger import Ledger
from lithobrake.campaign.limits import Limits
from lithobrake.campaign.local_executor import LocalExecutor, WorkerDiedError, available_cores
from lithobrake.campaign.missing_runs import missing
from lithobrake.campaign.model_server import ModelServer
from lithobrake.campaign.record import Record, RunStatus, campaign_began, read_records
from lithobrake.campaign.run_counts import Tally, duration, ledger_tally, per_time
from lithobrake.campaign.run_table import run_lines, write_csv
from lithobrake.campaign.runs import RunOptions, Runs, run
from lithobrake.campaign.seed_and_key import run_key, run_seed

__all__ = [
    "Command",
    "DaskExecutor",
    "Ledger",
    "Limits",
    "LocalExecutor",
    "ModelServer",
    "Record",
    "RunOptions",
    "RunStatus",
    "Runs",
    "Tally",
    "WorkerDiedError",
    "absolute_words",
    "available_cores",
    "campaign_began",
    "duration",
    "ledger_tally",
    "missing",
    "per_time",
    "read_records",
    "run",
    "run_key",
    "run_lines",
    "run_seed",
    "write_csv",
]
