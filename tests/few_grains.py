"""Studies of real soil within seconds: a sphere on a bed of a few grains."""

UNCERTAIN = '{ distribution = "uniform", lower = 0.5, upper = 0.9 }'


# At one place and in one attitude, written behind the impact; and expansions of it, without drawn landers.
ONE_IMPACT = "azimuth_deg = 0.0\nplace = { x = 0.0, y = 0.0 }\norientation = [1.0, 0.0, 0.0, 0.0]\n"
EXPANSION = "[journey]\ntouchdowns = 1\n[design]\nrun_count = 0\n[expansion]\n"


def few_grains(
    count: int, width: float, lander_diameter: float, friction: str = UNCERTAIN, sides: str = "periodic"
) -> str:
    """Bed, grains, lander and impact as text of a study file, lengths in m; what is written behind it goes on in
    the table of the impact, and keys of no table stand before it.
    """
    return f"""
[bed]
grain_count = {count}
width = [{width}, {width}]
sides = "{sides}"
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
steps_per_contact = 20.0
[impact]
speed = 0.4
incidence_deg = 5.0
"""
