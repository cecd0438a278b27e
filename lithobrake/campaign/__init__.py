"""Many runs of any model: each is computed once, kept in a ledger the moment it ends, and never lost."""

from typing import TYPE_CHECKING

from lithobrake.vocabulary.lazy_names import lazy_names

if TYPE_CHECKING:
    from lithobrake.campaign.command import Command as Command
    from lithobrake.campaign.command import absolute_words as absolute_words
    from lithobrake.campaign.executors import DaskExecutor as DaskExecutor
    from lithobrake.campaign.executors import LocalExecutor as LocalExecutor
    from lithobrake.campaign.executors import WorkerDiedError as WorkerDiedError
    from lithobrake.campaign.executors import available_cores as available_cores
    from lithobrake.campaign.ledger import Ledger as Ledger
    from lithobrake.campaign.listing import missing as missing
    from lithobrake.campaign.listing import run_lines as run_lines
    from lithobrake.campaign.listing import write_csv as write_csv
    from lithobrake.campaign.model_server import ModelServer as ModelServer
    from lithobrake.campaign.record import Record as Record
    from lithobrake.campaign.record import RunStatus as RunStatus
    from lithobrake.campaign.record import Tally as Tally
    from lithobrake.campaign.record import campaign_began as campaign_began
    from lithobrake.campaign.record import duration as duration
    from lithobrake.campaign.record import ledger_tally as ledger_tally
    from lithobrake.campaign.record import per_time as per_time
    from lithobrake.campaign.record import read_records as read_records
    from lithobrake.campaign.runs import RunOptions as RunOptions
    from lithobrake.campaign.runs import Runs as Runs
    from lithobrake.campaign.runs import run as run
    from lithobrake.campaign.runs import run_chains as run_chains
    from lithobrake.campaign.single_run import Limits as Limits
    from lithobrake.campaign.single_run import run_key as run_key
    from lithobrake.campaign.single_run import run_seed as run_seed
else:
    __getattr__, __dir__ = lazy_names(__name__)
