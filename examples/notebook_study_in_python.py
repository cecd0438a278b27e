# %% [markdown]
# # A study without a file
#
# The tables of a study file are the arguments of `lithobrake.Study`, so a notebook can build a study from numbers that
# it has computed. Here a small box is delivered to Dimorphos and followed until it is at rest.

# %%
import lithobrake


def between(lower: float, upper: float) -> dict:
    """A number that nobody knows better."""
    return {"distribution": "uniform", "lower": lower, "upper": upper}


# %% [markdown]
# ## The study
#
# Keys, units and ranges are those of a study file (`docs/study_file.md`). Two beds of thirty soft
# grains make a study of seconds, too small for a reliable number.

# %%
tables = {
    "title": "A small box on Dimorphos",
    "lander": {"shape": "box", "edges": [0.12, 0.10, 0.08], "mass": 0.4},  # m, kg
    "bed": {
        "bed_count": 2,
        "grain_count": 30,
        "width": [0.54, 0.54],  # m
        "diameter": {"distribution": "constant", "value": 0.08},  # m
        "cloud_point_count": 10,
        "pour_gravity": 0.1,  # m/s2
    },
    "grain": {
        "density": 2500.0,  # kg/m3
        "young_modulus": 1e5,  # Pa
        "poisson_ratio": 0.25,
        "restitution": 0.4,
        "friction": between(0.5, 0.9),
    },
    "contact": {"steps_per_contact": 20.0},
    "site": {"body": "dimorphos"},
    "delivery": {
        "latitude_deg": 10.0,
        "longitude_deg": -60.0,
        "heading_deg": between(0.0, 360.0),
        "speed": between(0.03, 0.05),  # m/s
        "incidence_deg": between(0.0, 40.0),
    },
    "journey": {"count": 8, "duration": 100_000.0, "emulated_count": 0},  # s
}
study = lithobrake.Study(**tables)
study

# %% [markdown]
# What is wrong is refused before anything runs, in a sentence for each key:

# %%
try:
    lithobrake.Study(**tables | {"lander": {"shape": "box", "edges": [0.12, 0.10, 0.08], "mas": 0.4}})
except ValueError as refused:
    print(refused)

# %% [markdown]
# ## Run it
#
# Without a folder the results are in a temporary one, which goes when `results` does. `study.run("runs/box")` keeps
# them, and then continues after an interruption; `results.save("runs/box")` keeps them afterwards.

# %%
results = study.run(report=False)
for sentence in results.headline[:2]:
    print(sentence)

# %%
results.journeys

# %% [markdown]
# ## Figures by name
#
# They are those of the report. `dir` lists what this study has.

# %%
print(dir(results.plot))
results.plot.map()

# %%
results.plot.ends()

# %% [markdown]
# Any axes will do:

# %%
from matplotlib import pyplot

figure, (left, right) = pyplot.subplots(1, 2, figsize=(10, 4), layout="constrained")
results.plot.times(left)
results.plot.distances(right)
figure.savefig("box.png")

# %% [markdown]
# A figure that a study has not is refused with those that it has. This study knows its ground:

# %%
try:
    results.plot.grounds()
except ValueError as refused:
    print(refused)

# %% [markdown]
# ## Keep it
#
# The folder has the study as a file: `lithobrake run runs/box/study.toml` runs it from the command line.

# %%
results.save("runs/box")
print(results.study_text.splitlines()[0])
