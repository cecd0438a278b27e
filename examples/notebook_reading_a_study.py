# %% [markdown]
# # Reading a study
#
# `open_study` reads the folder of a study that ran. It writes and computes nothing, so it works on an archived copy,
# and beside a study that still runs. This notebook reads what `notebook_first_study.py` has made.

# %%
import numpy as np

import lithobrake

results = lithobrake.open_study("runs/first_study")
results

# %% [markdown]
# ## Tables
#
# Each table knows of its columns what they are. With `pip install "lithobrake[data]"`, `results.runs.to_pandas()` and
# `to_xarray()` give them to other libraries.

# %%
runs, flights = results.runs, results.flights
print(runs)
column = runs.columns["speed_out"]
print(f"speed_out: {column.long_name} [{column.units}]")
flights

# %% [markdown]
# ## Numbers
#
# The median bounce keeps this part of its speed, and comes down this far away after this time:

# %%
kept = np.median(runs["speed_out"]) / results.study["impact"]["speed"]
print(f"{100 * kept:.0f} % of the speed of arrival")
print(f"{np.nanmedian(flights['time_s']) / 60:.0f} min to the next impact")

# %% [markdown]
# ## The emulator
#
# It gives samples of landings at any inputs, by their names and in the units of the study file: here at two frictions,
# all else in the middle.

# %%
emulator = results.emulator
middle = {name: np.median(results.runs[name]) for name in emulator.inputs}
for friction in (0.1, 0.35):
    table = emulator.sample(middle | {"lander.friction": friction}, 500, seed=1)
    low, high = np.nanquantile(table["speed_out"], [0.05, 0.95])
    print(f"friction {friction:.2f}: speed out {low:.3f} to {high:.3f} m/s")

# %%
emulator
