"""The study file that `lithobrake new` writes: a short study of journeys that runs, and all keys below it."""

from lithobrake.study.template import DISTRIBUTION_WORDS, commented, sections

_STUDY = """\
# Where does a lander end up? Landers are followed from delivery to rest, with a simulated landing at every impact.
# Change what is yours: lander, body, delivery, and what is known of the ground. A number that is not known is a table
# with a distribution; each lander draws its own. The ranges here are examples. Below stand all keys of a study file.
title = "CubeSat on Dimorphos"
seed = 1

# The ground: boxes of settled grains that repeat in both directions, one for every four journeys, at least twelve.
[bed]
grain_count = 96
width = [0.56, 0.56]                                       # m; `lithobrake plan` says the smallest
diameter = { distribution = "constant", value = 0.09 }     # m, of the sphere of equal volume
pour_gravity = 0.5                                         # m/s2; they then settle under the local gravity

[grain]
density = 2500.0                                                              # kg/m3
young_modulus = { distribution = "log_uniform", lower = 2e5, upper = 2e6 }    # Pa; rock takes shorter steps
poisson_ratio = 0.25
restitution = { distribution = "uniform", lower = 0.3, upper = 0.9 }
friction = { distribution = "uniform", lower = 0.4, upper = 0.9 }

[lander]
shape = "box"                                              # or "sphere" with diameter, or "hull" with file
edges = [0.1, 0.1, 0.227]                                  # m
mass = 2.0                                                 # kg

# How it arrives at the ground, in any attitude.
[delivery]
latitude_deg = 10.0
longitude_deg = -60.0
north_error = { distribution = "normal", mean = 0.0, std = 15.0 }             # m
east_error = { distribution = "normal", mean = 0.0, std = 15.0 }              # m
heading_deg = { distribution = "uniform", lower = 0.0, upper = 360.0 }        # from north toward east
speed = { distribution = "uniform", lower = 0.04, upper = 0.07 }              # m/s
incidence_deg = { distribution = "uniform", lower = 0.0, upper = 40.0 }       # 0 is straight down
spin_x = { distribution = "normal", mean = 0.0, std = 0.02 }                  # rad/s

[journey]
count = 48
duration = 172_800.0                                       # s, two days

[site]
body = "dimorphos"                                         # or "didymos", or a mesh with mass and spin_period
"""

_ALL_KEYS = """\
# All keys of a study file by their tables, with meaning, unit, range and default; write those that you need into the
# tables above. A key marked "number or table" takes a number, or one of these distributions:
"""


def journey_template() -> str:
    """The text of a study of journeys that runs, and of all keys with their meanings behind comment signs."""
    return "\n".join([_STUDY, _ALL_KEYS + DISTRIBUTION_WORDS, *map(commented, sections())])
