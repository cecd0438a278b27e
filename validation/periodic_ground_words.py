"""The words of docs/validation/periodic_ground.md; what a script works out stands in braces."""

TEXT = """\
# Periodic beds: effects of walls and images

What do the walls of a bed change, and do the periodic images of a narrow bed change anything?

- **Walls select landers.** At {way}, the landings lost at the edge are {lost}. The landers with an outcome rebound
  faster and shallower between walls of 0.7 m ({narrow}) than on the widest periodic bed ({wide}). The wider the bed,
  the fewer are lost and the smaller is this difference.
- **Walls make beds less dense.** The solid fraction is {walls} between walls, from narrow to wide, and {tiles} on
  periodic beds.
- **Images have no clear effect.** Rebound speed, elevation and spin rate were fitted against the logarithm of the
  period. Of the {count} slopes, the largest in magnitude is {most} standard errors ({output}, {at}); the next is
  {next}. An effect
  on that one quantity is not excluded. On the narrowest bed some landers travel farther than its period.
- **Cost.** A periodic bed costs about as much to pour as one between walls with as many grains. A landing costs
  somewhat
  more, because the bed is denser, and more again at 75 degrees, because a lost lander ends early. On the narrowest
  periodic bed, which loses none, a landing at 15 degrees costs less than between walls.

![Rebound by bed](periodic_ground.png)

## Set-up

Soil and lander are those of `scenarios/first_bounce.toml`, at the medians of their distributions. Beds lie between
walls 0.7 m apart, or at twice or four times that width (4 and 16 times the area), or are periodic with a period of 0.56
to 1.4 m. All have equally many grains per area.

On a periodic bed the impact points cover the whole bed. Between walls they lie in the middle half of it, so in a wider
bed the walls are farther from the lander. Grains that are far from the lander and slower than 0.03 of its speed are
frozen (`contact.held_speed = 0.03`).

A lander is lost if it crosses the edge of its bed without clearly flying. It has no outcome and is left out of all
means. Brackets hold standard errors, with beds as clusters.

## Beds

Means over beds, with the standard deviation in brackets.

{beds}

## Landings

"Displacement > period" counts landers that travel farther than the period of their bed.

{landings}

## Slopes

The soil is the same, with a friction of 0.3, less than the tangent of either slope. Impacts are at 0.4 m/s, 30 degrees
from the normal and downhill. A periodic bed is 0.7 m wide and held by its rough floor. A bed between walls is 1.4 m
wide and held by its lower wall. There are three beds per slope between walls, too few for reliable standard errors.

{slopes}

## The studies of the scenarios

Each study was run with the beds of its file and with the other kind of sides (`scenarios/first_bounce.toml` with
periodic beds of two widths). Means are over all landings that left the bed. Fractions have 90 % intervals.

{studies}

## Limits

One lander and one soil were tested, on {count} combinations of output and impact. Standard errors come from three to
eight beds each.

## Reproduce this page

`python validation/periodic_ground_figures.py` writes the page and its figure. The landings: {made};
`python validation/periodic_slopes.py` and `python validation/periodic_studies.py` make the last two tables.
"""
