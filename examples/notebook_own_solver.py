# %% [markdown]
# # Your own solver
#
# Any model with numbers as inputs and outputs can be run many times, with stored results, and replaced by a polynomial
# chaos expansion. The model is in a file of its own, `ball_on_plate_campaign.py`, because worker processes import it.
# Here the runs are few and quick, so this process makes them itself.

# %%
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

from lithobrake import campaign, chaos

HERE = Path(__file__).parent if "__file__" in globals() else Path.cwd()
sys.path.insert(0, str(HERE))
from ball_on_plate_campaign import INPUTS, OUTPUTS, model

# %% [markdown]
# ## The design
#
# A sparse grid in three uncertain inputs: few points, and exact for polynomials of a low degree.

# %%
points = chaos.smolyak(INPUTS, level=3)
print(f"{len(points)} runs of {', '.join(INPUTS)}")

# %% [markdown]
# ## Run it
#
# The ledger stores each run as soon as it ends; the second campaign reuses all of them.

# %%
with ThreadPoolExecutor(1) as here, campaign.Ledger(Path("runs.sqlite")) as ledger:
    runs = campaign.run(
        model, points, names=list(INPUTS), ledger=ledger, executor=here, context={"model": "ball on plate, 1"}
    )
outputs = runs.outputs(OUTPUTS)
print(f"{len(points)} runs, {runs.reused_count} of them known before")

# %% [markdown]
# ## The expansion
#
# Evaluating the expansion costs almost nothing. It is tested on runs that were not used in the fit.

# %%
surrogate = chaos.fit(INPUTS, points, outputs, degree=3, method="ols", output_names=OUTPUTS)
random = np.random.default_rng(1)
fresh = np.column_stack([random.uniform(*one.support, 50) for one in INPUTS.values()])
truth = np.array([[model(dict(zip(INPUTS, row, strict=True)), 0)[name] for name in OUTPUTS] for row in fresh])
error = np.abs(surrogate(fresh) - truth).max(axis=0) / np.ptp(truth, axis=0)
for name, share in zip(OUTPUTS, error, strict=True):
    print(f"{name}: wrong by {100 * share:.1f} % of its range at most")

# %% [markdown]
# ## What matters?

# %%
print(f"{'total Sobol index of':<20} {'  '.join(OUTPUTS)}")
for name, shares in zip(INPUTS, surrogate.sobol_total, strict=True):
    print(f"{name:<20} {'  '.join(f'{share:>14.3f}' for share in shares)}")

# %% [markdown]
# A study can use the same program (`[solver] command`) and continues with flights: see `notebook_first_study.py`.
