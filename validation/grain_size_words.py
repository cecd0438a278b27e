"""The words of docs/validation/grain_size.md; what a script works out stands in braces."""

HEAD = """# Soil against impact point, by grain size

Which has the larger effect on the rebound, the soil parameters or the impact point, as grains become small compared
with the lander?

For the rebound speed, by the ratio of the lander's longest edge ({edge:g} m) to the grain diameter:

{verdict}

![Total effects by ratio](grain_size.png)

## Set-up

Lander ({edges} m, {mass:g} kg), input distributions and site are those of `scenarios/first_bounce.toml`. Impacts are at
{speed:g} m/s, {steep:g} or {flat:g} degrees from the normal, along one direction of the bed.

- **Blocks.** A block has two soils (five parameters of grains and lander, sampled together), two impact points on two
  beds, and two attitudes. It has eight landings, one for each combination, and a ninth with the impact point moved by
  0.1 mm. The same samples are used for all kinds of grains and ratios.
- **Total effect** of a factor: half the mean squared difference of landings that differ in it alone, divided by the
  variance, which comes from landings that differ in all three [Jansen-1999]. Total effects include interactions, so
  they may sum to more than 1. "Soil alone" is the main effect of the soil, without interactions. "Chaos" is the part
  due to the 0.1 mm.
- **Intervals** ({level:.0f} %) come from {resamples} resamples of the blocks. With fewer than {few} blocks there is no
  interval.
- **No rebound.** A lander that is captured, or still in contact at its time limit, has no rebound. Its pairs are left
  out.
- **Beds** are periodic. Their width is two grains more than the rule of the smallest bed requires. "Larger" beds are
  1.5 times as wide and deep. Grains are convex hulls, or spheres with a rolling resistance of {rolling:g} in place of
  corners. Spheres show whether the trend continues to numbers of grains that are too large for hulls.

## Parts of the variance

{tables}

## Landings

"±" is the standard deviation of the rebound speed. Penetration is measured below the mean surface.

"""
LIMITS = """

## Limits

- The impact point includes its bed: the two impact points of a block lie on two beds where there is more than one.
  {fewest} to {most} beds per ratio serve all blocks. Intervals therefore hold over soils, impact points and attitudes
  on these beds, and not fully over beds.
- All grains of a bed have one size. Boulders among fine grains are impact points of their own.
- Attitudes are sampled over all rotations. A lander with a controlled attitude does not have that part of the variance.
- Return fractions come from {flights} flights per landing over {hours:g} h. Their sampling error adds to their "chaos".
- Intervals from few blocks are too narrow.
- Where landers are captured, the numbers hold for those that rebound.
- {missing}

## Reproduce this page

`python validation/grain_size_figures.py` writes the page and its figure.
"""
