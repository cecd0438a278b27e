"""The paragraphs of docs/forecast_hera.md."""

ABOUT = """# Forecast: Juventas and Milani on Dimorphos

Made on {made}, before either had landed, by `python validation/forecast_hera/forecast.py`.

ESA's Hera carries two CubeSats, Juventas and Milani, which are to land on Dimorphos in 2027. Where do they come to
rest, and how certain is that? All published probabilities of coming to rest are for hard ground. This forecast follows
each lander through simulated landings on rubble. Unknown properties of Dimorphos and of the descents are sampled from
ranges that are as wide as the published facts allow. The forecast is dated and hashed, and will be scored.

**{first}**

The intervals cover the scatter between landers and between beds, for the branches, weights and ranges below. They do
not cover errors of the model. Numbers of simulated landers: {counts}.
"""

METHOD = {
    "numbers": """## When, and after how many contacts

Quantiles over the landers at rest, with 90 % intervals of the medians. Times count from the first contact and include
the last minutes, in which a lander hardly moves.
""",
    "place": """## Where

The table gives the smallest regions (of highest density, seen from the centre) that contain 50 and 95 % of the landers
at rest on soil, over all branches, with 90 % intervals of their areas. Coordinates are body-fixed: longitude 0 faces
Didymos while the rotation of Dimorphos is synchronous with its orbit.
""",
    "faces": """## On which side

The table gives the probability of each side facing the ground, for landers at rest on soil. Axes are those of the boxes
in the study files: Juventas measures 0.37 m along x, 0.23 m along y and 0.10 m along z; Milani measures 0.13, 0.246 and
0.366 m.
""",
    "decides": """## What determines the outcome

For the landers that touch down on soil, the table gives the fraction at rest in the lower and in the upper half of the
range of each uncertain input. It also gives the rank correlation of the input with the time to rest and with the ratio
of the first rebound speed to the impact speed (within branches; 90 % intervals over beds). If an interval contains 0,
no correlation is detected.
""",
    "branches": """## By branch

Three unknowns are not numbers: how Dimorphos has rotated since the impact of DART, how the lander descends, and to
which end of the long axis. Each combination is a branch. The weights of the branches are our judgement. A lander that
misses Dimorphos counts in the fractions too.

- **Small libration** starts with 7 degrees of yaw from the attitude in which the long axis points to Didymos, and stays
a libration in yaw alone.
- **Large libration** starts with 20 degrees of yaw, 1 degree of pitch and 2 degrees of roll; the pole deviates by up to
45 degrees.
- **Rolling** starts with 30 degrees of yaw and 60 degrees of roll: the pole turns over, while the long axis stays
  within 36 degrees of the direction to Didymos.
- A lander arrives at a random time within 30 days of this motion. Each branch has its own landers, soils and beds.
- **At the surface**: speed, angle and place of the first contact are sampled, as after a controlled descent.
- **Ballistic**: the lander is released 200 m from the centre toward a vertical touchdown, 1.25 times as fast as the
slowest such descent, with errors of 90 m and 2 cm/s (3 sigma) in each direction [Celik-2019].
- **Near end, far end**: the lander aims at the end of the long axis that faces Didymos, or at the opposite one.
""",
    "variants": """## The effect of two choices

The landers of one branch (small libration, at the surface, near end; soil) were simulated again with one choice
changed. These variants are not part of the forecast.
""",
    "priors": """## Assumptions

"Ours" marks a choice without a published value.
""",
    "falsified": """## What would contradict it

The table lists observations to which the forecast assigns a probability of less than {unlikely:.0f} %, and their
probability on hard ground. One such observation is a reason to doubt the model; several, from both landers, are a
reason to reject it.
""",
}

VARIANTS_SAY = """If the interval of a ratio of median times contains 1, no difference is detected. The shape is a model
from before the impact (bounding box 176 x 173 x 115 m, 4700 facets), moved to its centre of mass, turned to its
principal axes and scaled to the volume of the ellipsoid (by 0.999 in length); mass and density are unchanged. A mesh
has no partner in a study, so the shape is compared with an ellipsoid without Didymos.
`validation/forecast_hera/variants.csv` has the landers.
"""

SCORING = """## How it will be scored

The score is logarithmic: for each observed quantity, it is minus the logarithm to base 2 of the probability that the
forecast assigned to the bin of the observation. A lower score is better. `forecast.json` has the bins and probabilities
of the end, the minutes to rest, the contacts, the ratio of the first rebound speed to the impact speed, the place (24
cells of the surface) and the side facing the ground. The command also prints the scores of hard ground and of equal
probabilities, for comparison:

```sh
python validation/forecast_hera/score.py juventas --end at_rest --time-min 25 --contacts 3
```

This forecast will not be changed before the landings; a new one gets its own date and hashes. Measurements before the
landings, above all of mass, shape and rotation of Dimorphos, will narrow the branches. The command below then makes the
final forecast.
"""

LEFT_OUT = """## What is left out

- **Booms and wings**: a lander is its box, without the four booms of 1.5 m of Juventas and without the wings of both,
  although a boom may touch first. A lander [can have parts](howto/lander_parts.md), but with booms a bed must be three
  times as wide.
- **Internal mass distribution**: the mass of a lander is uniform over its box, with a shifted centre of mass.
- **Small grains and stiff rock**: grains are stones of 0.18 to 0.25 m, and soft, which allows long time steps. Finer
  grains between them would absorb more energy; a stone larger than the lander would return more.
- **Topography**: Dimorphos is an ellipsoid without craters, large boulders or local slopes.
- **Eccentricity** of the mutual orbit, and any action of the lander or its thrusters after the first contact.
- **Dates** of the landings, which are not known; no result depends on them.
"""

REPRODUCE = """## Reproduce this forecast

```sh
python validation/forecast_hera/forecast.py --work FOLDER
```

The command runs every study in a folder of its own, writes landers, results, figures and this page, and compares them
with the stored ones; `--out` writes them to another folder. You can stop and restart it: results made by the same code
are kept. {cost} `lithobrake run scenarios/juventas.toml` runs a single branch: small libration, at the surface, near
end.
"""
