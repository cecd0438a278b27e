"""Studies of real soil within seconds: a sphere on a bed of a few grains."""

# Behind the table of the impact: what all runs of expansions have alike where no lander is drawn.
AT_ONE_PLACE = """azimuth_deg = 0.0
place = { x = 0.0, y = 0.0 }
orientation = [1.0, 0.0, 0.0, 0.0]
[design]
run_count = 0
"""
UNCERTAIN = '{ distribution = "uniform", lower = 0.5, upper = 0.9 }'


def few_grains(
    count: int, width: float, lander_diameter: float, friction: str = UNCERTAIN, *, sides: str = "periodic"
) -> str:
    """A study of first touchdowns: bed, grains, lander and impact as text of its file, lengths in m.

    What is written behind it goes on in the table of the impact, and keys of no table stand before it.
    """
    return f"""
[journey]
touchdowns = 1
[bed]
sides = "{sides}"
grain_count = {count}
width = [{width}, {width}]
diameter = {{ distribution = "constant", value = 0.08 }}
cloud_point_count = 10
pour_gravity = 0.1
[grain]
density = 2500.0
young_modulus = 1e6
poisson_ratio = 0.25
restitution = {{ distribution = "uniform", lower = 0.5, upper = 0.8 }}
friction = {friction}
[lander]
shape = "sphere"
diameter = {lander_diameter}
mass = 0.1
restitution = 0.95
[surface]
gravity = 1e-4
[contact]
pair_rule = "mean"
held_speed = 0.0
steps_per_contact = 20.0
[impact]
speed = 0.4
incidence_deg = 5.0
"""
