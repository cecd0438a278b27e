# %% [markdown]
# # Reading a study
#
# `open_study` reads the folder of a study. It writes and computes nothing, so it works on an archived copy, and while
# the study still runs. This notebook reads the study of `notebook_first_study.py`.

# %%
import numpy as np

import lithobrake

results = lithobrake.open_study("runs/first_study")
results

# %% [markdown]
# ## Tables
#
# Each column of a table has its unit and meaning. With `pip install "lithobrake[data]"`, `results.runs.to_pandas()` and
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
# The fraction of its speed that the median bounce keeps, and the median time to the next impact:

# %%
kept = np.median(runs["speed_out"]) / results.study["impact"]["speed"]
print(f"{100 * kept:.0f} % of the speed of arrival")
print(f"{np.nanmedian(flights['time_s']) / 60:.0f} min to the next impact")

# %% [markdown]
# ## The emulator
#
# The emulator gives samples of landings at any inputs, by name and in the units of the study file: here at two
# frictions, with all other inputs at their median.

# %%
emulator = results.emulator
middle = {name: np.median(results.runs[name]) for name in emulator.inputs}
for friction in (0.1, 0.35):
    table = emulator.sample(middle | {"lander.friction": friction}, 500, seed=1)
    low, high = np.nanquantile(table["speed_out"], [0.05, 0.95])
    print(f"friction {friction:.2f}: speed out {low:.3f} to {high:.3f} m/s")

# %%
emulator
