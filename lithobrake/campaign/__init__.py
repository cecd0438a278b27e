"""Many runs of any model: each is computed once, kept in a ledger the moment it ends, and never lost."""

from lithobrake.campaign.identity import run_key, run_seed
from lithobrake.campaign.ledger import Ledger
from lithobrake.campaign.local import LocalExecutor
from lithobrake.campaign.runs import Runs, run

__all__ = ["Ledger", "LocalExecutor", "Runs", "run", "run_key", "run_seed"]
