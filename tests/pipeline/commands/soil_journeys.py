"""A study of journeys on real soil within seconds: small grains, one bed, a lander that bounces a few times."""

SOIL_JOURNEYS = """
seed = 5
lander = { shape = "box", edges = [0.06, 0.07, 0.08], mass = 1.0 }
journey = { count = 2, duration = 20000.0, emulated_count = 40 }
site = { body = "dimorphos" }
[bed]
grain_count = 48
width = [0.5, 0.5]
diameter = { distribution = "constant", value = 0.074 }
cloud_point_count = 10
pour_gravity = 0.5
bed_count = 1
[grain]
density = 2500.0
young_modulus = 2e5
poisson_ratio = 0.25
restitution = 0.5
friction = { distribution = "uniform", lower = 0.4, upper = 0.9 }
[delivery]
latitude_deg = 10.0
longitude_deg = -60.0
north_error = { distribution = "normal", mean = 0.0, std = 15.0 }
speed = { distribution = "uniform", lower = 0.08, upper = 0.1 }
incidence_deg = { distribution = "uniform", lower = 40.0, upper = 70.0 }
"""
