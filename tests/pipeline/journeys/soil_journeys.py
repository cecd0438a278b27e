"""A study of journeys on real soil within seconds: a soft bed of thirty grains, and a lander that leaves it often."""

STUDY = """
seed = 4
lander = { shape = "box", edges = [0.12, 0.1, 0.08], mass = 0.4, restitution = 0.9 }
contact = { pair_rule = "mean", steps_per_contact = 20.0 }
journey = { count = 6, duration = 100_000.0, hop_height = 0.2, emulated_count = 40 }
site = { body = "dimorphos" }
campaign = { retry_count = 20 }
[bed]
grain_count = 30
width = [0.54, 0.54]
diameter = { distribution = "constant", value = 0.08 }
cloud_point_count = 10
pour_gravity = 0.1
bed_count = 2
[grain]
density = 2500.0
young_modulus = 1e5
poisson_ratio = 0.25
restitution = 0.6
friction = { distribution = "uniform", lower = 0.5, upper = 0.9 }
[delivery]
latitude_deg = 10.0
longitude_deg = -60.0
heading_deg = { distribution = "uniform", lower = 0.0, upper = 360.0 }
speed = { distribution = "uniform", lower = 0.05, upper = 0.15 }
incidence_deg = { distribution = "uniform", lower = 0.0, upper = 60.0 }
spin_x = { distribution = "uniform", lower = -0.1, upper = 0.1 }
"""
EDGES, MASS = (0.12, 0.1, 0.08), 0.4
