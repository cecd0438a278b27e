# %% [markdown]
# # A first study
#
# A lander bounces off ground whose friction and restitution are unknown. Where does it end up? A study file states what
# is known, what is unknown, and how many landings to make. In this study an external program computes the landings (a
# ball on a hard plate, which takes milliseconds); without `[solver]` they are simulated on beds of grains.
#
# Each cell also runs in a script: `python examples/notebook_first_study.py`.

# %%
import subprocess
import sys
from pathlib import Path

import lithobrake

HERE = Path(__file__).parent if "__file__" in globals() else Path.cwd()
PROGRAM = HERE / "ball_on_plate.py"

# %% [markdown]
# ## The study file
#
# An unknown number is a distribution. `lithobrake new NAME --full` writes a file with every key and its meaning.

# %%
study = f"""
title = "Ball on a hard plate, from little knowledge"

[solver]
command = '"{sys.executable}" "{PROGRAM}"'

[solver.inputs]
plate_tilt_deg = {{ distribution = "uniform", lower = -4.0, upper = 4.0 }}

[lander]
shape = "sphere"
diameter = 0.1             # m
mass = 1.0                 # kg
restitution = {{ distribution = "uniform", lower = 0.4, upper = 0.8 }}
friction = {{ distribution = "uniform", lower = 0.05, upper = 0.4 }}

[impact]
speed = 0.08               # m/s
incidence_deg = {{ distribution = "uniform", lower = 20.0, upper = 50.0 }}

[surface]
gravity = 3e-5             # m/s2

# Every solver receives these tables too; this one ignores them.
[bed]
grain_count = 100
width = [0.6, 0.6]
diameter = {{ distribution = "constant", value = 0.08 }}

[grain]
density = 2500.0
young_modulus = 1e7
poisson_ratio = 0.25
restitution = 0.5
friction = 0.5

[journey]
touchdowns = 1

[design]
run_count = 24

[site]
body = "dimorphos"
latitude_deg = 20.0
longitude_deg = 60.0
heading_deg = {{ distribution = "uniform", lower = 0.0, upper = 360.0 }}

[monte_carlo]
sample_count = 1000

[flight]
flight_count = 50
duration = 14_400.0        # s
gravity = "exact"
"""
Path("first_study.toml").write_text(study)

# %% [markdown]
# ## Time and runs
#
# In a notebook, `!lithobrake plan first_study.toml` does the same.

# %%
command = [sys.executable, "-m", "lithobrake"]
plan = subprocess.run([*command, "plan", "first_study.toml"], capture_output=True, text=True, check=True).stdout
print(plan)

# %% [markdown]
# ## Run it
#
# You can stop it at any time: the same command continues after the last finished run.

# %%
subprocess.run([*command, "run", "first_study.toml", "--out", "runs/first_study"], check=True)

# %% [markdown]
# ## The answer

# %%
results = lithobrake.open_study("runs/first_study")
for sentence in results.headline:
    print(sentence)

# %% [markdown]
# In a notebook, a value on the last line of a cell is displayed. The report `runs/first_study/report/index.html` has
# figures, tables and the source of each number.

# %%
results
