"""The paragraphs of docs/forecast_hera.md."""

ABOUT = """# Forecast: Juventas and Milani on Dimorphos

Made on {made}, before either had landed, by `python validation/forecast_hera/forecast.py`.

ESA's Hera carries two CubeSats, Juventas and Milani, which are to land on Dimorphos in 2027. Where do they end up, and
how sure is that? Every published chance of coming to rest is for hard ground. This forecast follows each lander through
simulated landings on rubble; what is not known of Dimorphos and of the descents is drawn from ranges as wide as
published facts leave them. It is dated and hashed, and will be scored.

**{first}**

The intervals contain the scatter of landers and beds, for the branches and ranges below with the weights given there.
They do not contain an error of the model. Landers: {counts}.
"""

METHOD = {
    "numbers": """## When, and after how many contacts

Of the landers at rest, with 90 % intervals of the medians. Times count from the first contact. They include the last
minutes, in which a lander hardly moves.
""",
    "place": """## Where

The smallest regions (of highest density, seen from the centre) that hold half and 95 % of the landers at rest on soil,
all branches together, with 90 % intervals of their areas. Body-fixed: longitude 0 faces Didymos while Dimorphos turns
with its orbit.
""",
    "faces": """## On which side

Chance of each side being down, of the landers at rest on soil. Axes of the boxes as in the study files: Juventas has x
along 0.37, y along 0.23 and z along 0.10 m; Milani has x along 0.13, y along 0.246 and z along 0.366 m.
""",
    "decides": """## What decides it

Of the landers that touch down on soil: the share at rest in the lower and the upper half of each uncertain number, and
the rank correlation of that number with the time to rest and with the first rebound speed over impact speed (within
branches; 90 % intervals over beds). An interval that holds 0 shows no connection.
""",
    "branches": """## By branch

What is not a number is a branch: how Dimorphos turns since the impact of DART, how the lander comes down, and to which
end of the long axis. Weights are judgement. A lander that misses Dimorphos counts among the ends.

- Small libration starts with 7 degrees of yaw off the attitude in which the long axis points to Didymos, and keeps to
that.
- Large libration starts with 20 degrees of yaw, 1 of pitch and 2 of roll; its pole goes up to 45 degrees away.
- Rolling starts with 30 degrees of yaw and 60 of roll: the pole turns over, while the long axis stays within 36 degrees
of Didymos.
- A lander arrives at any time of 30 days of that motion. Each branch has landers, soils and beds of its own.
- At the surface: speed, angle and place of the first contact are drawn, as after a controlled descent.
- Ballistic: released 200 m from the centre on the way to a vertical touchdown, 1.25 times as fast as the least, with
errors of 90 m and 2 cm/s (3 sigma) in each direction [Celik-2019].
""",
    "variants": """## What two choices are worth

The same landers of one branch (small libration, at the surface, near end; soil) with one choice changed. These
variants are no part of the forecast.
""",
    "priors": """## What it stands on

Ours: a choice without a published value.
""",
    "falsified": """## What would speak against it

Observations to which the forecast gives less than {unlikely:.0f} %, and what hard ground gives them. One of them is a
reason to doubt the model; several, of both landers, are reason to drop it.
""",
}

VARIANTS_SAY = """A ratio of median times whose interval holds 1 shows no difference. The shape is a model of before
the impact (bounding box 176 x 173 x 115 m, 4700 facets), moved to its centre of mass, turned to its principal axes and
scaled to the volume of the ellipsoid (by 0.999 in length); masses, and so densities, stay. A mesh has no partner in a
study, so the shape stands beside an ellipsoid without Didymos. `validation/forecast_hera/variants.csv` has the landers.
"""

SCORING = """## How it will be scored

By the logarithmic score: for each thing that is observed, minus the logarithm to base 2 of the probability that the
forecast gave to the bin in which it lies. `forecast.json` has bins and probabilities of the end, the minutes to rest,
the contacts, the first rebound speed over impact speed, the place (24 cells of the ground) and the side that is down.
The scores of hard ground and of equal probabilities stand beside it.

```sh
python validation/forecast_hera/score.py juventas --end at_rest --time-min 25 --contacts 3
```

Until the landings this forecast stays as it is; a new one has its own date and hashes. What is measured before them,
mass, shape and rotation of Dimorphos above all, narrows the branches; the same command then makes the forecast that
counts.
"""

LEFT_OUT = """## What is left out

- The booms of Juventas (four of 1.5 m) and the wings of both: the lander is its body. A boom may touch first. A lander
  [can have parts](howto/lander_parts.md), but with booms a bed must be three times as wide.
- Fuel, instruments and structure: the mass of a lander is spread evenly over its box, and its centre of mass shifted.
- Small grains and rock as stiff as rock: grains are stones of 0.18 to 0.25 m, and soft, so that steps are long. Finer
  grains between them, if there are any, take more energy from a lander; a stone larger than the lander gives more back.
- Ground that is not smooth: Dimorphos is an ellipsoid without craters, large boulders or slopes of some metres.
- The eccentricity of Didymos' orbit, and anything that the lander or its thrusters do after the first contact.
- The dates of the landings, which are not known; nothing in the forecast depends on them.
"""

REPRODUCE = """## From nothing

```sh
python validation/forecast_hera/forecast.py --work FOLDER
```

It runs every study in a folder of its own, writes landers, answers, figures and this page, and compares them with those
that stood here before; with `--out`, it writes them elsewhere. It may be stopped: what is there, by the same code, is
kept. {cost} `lithobrake run scenarios/juventas.toml` runs the branch of small libration, at the surface, near end,
alone.
"""
