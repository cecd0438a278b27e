# %% [markdown]
# # One landing by hand
#
# Pour a bed of grains, let it settle, land a box on it and look at the result. No study file is needed.

# %%
from lithobrake.dem import Box, Material
from lithobrake.touchdown import BedRecipe, ContactModel, GrainSizes, Lander, Landing, land, pour_bed

rock = Material(young_modulus=1e6, poisson_ratio=0.25, restitution=0.5, friction=0.5, density=2500.0)
gravity = (0.0, 0.0, -5e-4)  # m/s2
contact = ContactModel(steps_per_contact=25.0)

# %% [markdown]
# ## The bed
#
# Forty-eight grains are enough to see each step within seconds, but too few for a reliable number
# (`docs/one_bed_is_not_enough.md`).

# %%
bed = pour_bed(
    BedRecipe(
        grain_count=48,
        sizes=GrainSizes(distribution="uniform", lower=0.09, upper=0.11),  # m
        cloud_point_count=14,
        width=(0.5, 0.5),  # m
        material=rock,
        gravity=gravity,
        pour_gravity=0.5,  # m/s2
        seed=3,
        contact=contact,
        sides="periodic",  # the bed repeats, so that the box cannot leave it sideways
    )
)
print(f"{bed.solid_fraction:.2f} of the bed is solid; each grain touches {bed.coordination_number:.1f} others")

# %% [markdown]
# ## The landing

# %%
lander = Lander(shape=Box((0.1, 0.1, 0.1)), mass=0.5, material=rock)


def landing(speed: float) -> Landing:
    """Arrive at a speed [m/s], a little aslant and turned."""
    return Landing(
        grain=rock,
        speed=speed,
        incidence=0.2,  # rad, from the inward normal
        azimuth=0.0,  # rad, of the horizontal velocity
        place=(0.0, 0.0),  # m, from the middle of the bed
        orientation=(0.9, 0.3, 0.2, 0.1),  # w, x, y, z
        spin=(0.0, 0.0, 0.0),  # rad/s
        gravity=gravity,
        time_limit=20.0,  # s
        contact=contact,
    )


outcome = land(bed, lander, landing(0.3), frame_count=50)
print(outcome.status)
for name, value in outcome.outputs.items():
    print(f"{name:<20} {value:.4g}")

# %% [markdown]
# ## Rebound speed
#
# The same box lands at other speeds on the same bed; each landing starts from the settled bed.

# %%
speeds = [0.1, 0.2, 0.3, 0.4]
kept = {speed: land(bed, lander, landing(speed)).outputs["speed_out"] / speed for speed in speeds}
for speed, share in kept.items():
    print(f"at {speed} m/s it keeps {100 * share:.0f} % of its speed")

# %% [markdown]
# ## Look at it
#
# `landing.h5` has the hulls and their motion; the picture shows twelve instants.

# %%
from lithobrake.results import MovingBodies
from lithobrake.view import contact_sheet

outcome.save_frames("landing.h5", bed, lander, landing(0.3))
contact_sheet(MovingBodies.read("landing.h5", "land again"), "landing.png")
