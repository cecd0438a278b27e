"""The paragraphs of docs/forecast_hera.md."""

ABOUT = """# Forecast: Juventas and Milani on Dimorphos

Made on {made}, before either had landed. Written by
`python validation/forecast_hera/write_page.py`.

ESA's Hera carries two CubeSats, Juventas and Milani, which are to land on Dimorphos in 2027. Where
do they end up, and how sure is that? Every published chance of coming to rest is for hard ground;
this forecast follows each lander through simulated landings on rubble, under what is published about
Dimorphos, and as wide as that leaves it. It is dated and hashed, and will be scored.

**{first}**

The intervals hold for the branches and ranges below, with the weights given there. They contain the
scatter of landers and beds. They do not contain an error of the model. Landers: {counts}.
"""

METHOD = {
    "numbers": """## When, and after how many contacts

Of the landers at rest. Times count from the first contact; the last minutes of a time are those in which a lander
hardly moves any more.
""",
    "place": """## Where

Smallest regions of the ground (highest density) that hold half and 95 % of the landers at rest, all branches
together. Body-fixed: longitude 0 faces Didymos while Dimorphos turns with its orbit.
""",
    "faces": """## On which side

Chance of each side being down, of the landers at rest. Axes of the boxes as in the study files: of Juventas x along
0.37, y along 0.23, z along 0.10 m; of Milani x along 0.13, y along 0.246, z along 0.366 m.
""",
    "decides": """## What decides it

Of the landers that touch down: the share at rest in the lower and upper half of each uncertain number, and
its rank correlation (within branches, 90 % interval over beds) with the time to rest and with the first rebound
speed over impact speed. An interval that holds 0 shows no connection.
""",
    "branches": """## By branch

What is not a number is a branch: how Dimorphos turns since the impact of DART, how the lander comes
down, and to which end of the long axis. Weights are judgement. Small libration starts 7 degrees of
yaw off the attitude in which the long axis points to Didymos, and keeps to that; large libration
starts with 20 of yaw, 1 of pitch and 2 of roll, and its pole goes up to 45 degrees away; rolling
starts with 30 of yaw and 60 of roll: the pole turns over, while the long axis stays within 36 degrees of
Didymos. A lander arrives at any time of 30 days of that motion. At the surface:
speed, angle and place at the first contact are drawn, as after a controlled descent. Ballistic:
released 200 m from the centre on the way to a vertical touchdown, 1.25 times as fast as the least,
with errors of 90 m and 2 cm/s (3 sigma) in each direction [Celik-2019]. A lander that misses
Dimorphos counts among the ends.
""",
    "priors": """## What it stands on
""",
    "falsified": """## What would speak against it

Observations to which the forecast gives less than {unlikely:.0f} %, and what hard ground gives them. One of them is a
reason to doubt the model; several, of both landers, are reason to drop it.
""",
}

SCORING = """## How it will be scored

By the logarithmic score: for each thing that is observed, minus the logarithm to base 2 of the probability that the
forecast gave to the bin in which it lies. Bins and probabilities stand in `forecast.json`: the end, minutes to rest,
contacts, first rebound speed over impact speed, one of 24 cells of the ground, and the side that is down. Beside it
stand the scores of hard ground and of equal probabilities.

```sh
python validation/forecast_hera/score.py juventas --end at_rest --time-min 25 --contacts 3
```

Until then the forecast changes only as a new one, with its own date and hashes. What is measured before the landings,
mass, shape and rotation of Dimorphos above all, narrows the branches; then the same command gives the forecast that
counts.
"""

LEFT_OUT = """## What is left out

- The booms of Juventas (four of 1.5 m) and the wings of both: the lander is its body. A boom may touch first. A lander
  [can have parts](howto/lander_parts.md), but with booms a bed must be three times as wide.
- The mass of a lander is spread evenly over its box, but for the place of the centre of mass.
- Grains are stones of 0.18 to 0.25 m, and softer than rock, so that steps are long. Finer grains between them, if there
  are any, take more energy from a lander; a stone larger than the lander gives more back.
- Dimorphos is a smooth ellipsoid: no crater, no large boulder, no slope at the scale of metres.
- Didymos' orbit is a circle, and neither the lander nor its thrusters act after the first contact.
- The dates of the landings are not known; nothing in the forecast depends on them.
"""

REPRODUCE = """## From nothing

```sh
python validation/forecast_hera/forecast.py --work FOLDER
python validation/forecast_hera/answers.py
python validation/forecast_hera/write_page.py
```

The first runs every study in a folder of its own and notes each lander in `landers.csv`; the others take
seconds. `lithobrake run scenarios/juventas.toml` runs the branch of small libration, at the surface, near end, alone.
"""
