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
# It is the law of what comes out, at inputs that nobody has run: here at two frictions, all else in the middle.

# %%
emulator = results.emulator
names = list(emulator.runs.inputs)
middle = np.median(emulator.runs.x, axis=0)
points = np.tile(middle, (2, 1))
points[:, names.index("lander.friction")] = [0.1, 0.35]
draws = emulator.sample(points, 500, seed=1)
speed = draws[:, :, emulator.output_names.index("speed_out")]
for point, values in zip(points, speed, strict=True):
    low, high = np.nanquantile(values, [0.05, 0.95])
    print(f"friction {point[names.index('lander.friction')]:.2f}: speed out {low:.3f} to {high:.3f} m/s")

# %%
emulator
