"""The words of docs/validation/expansion_accuracy.md; what a script works out stands in braces."""

TEXT = """\
# Where the published expansion is accurate

Over which input ranges, and on which grains, does an expansion reach the published errors?

**{verdict}**

The published method fits an expansion of order {degree} to landings on one bed, at one impact point, in one attitude.
On fresh runs it reports mean absolute errors of {speed:g} % for the rebound speed, {elevation:g} % for the direction
and {spin:g} % for the spin rate ([Landings-PCE], Figure 5). Its input ranges and grains are not published.

![Sweeps and errors](expansion_accuracy.png)

Above, each marker is a bed ({markers}). Below are the errors on fresh points.

## Set-up

- **Lander and impact**: lander, medians, full ranges, impact angle (15 degrees) and attitude are those of
  `scenarios/one_place.toml`. The impact point is the middle of a periodic bed, as in [soil against impact
  point](grain_size.md).
- **Ratio**: the lander's longest edge over the diameter of the grains.
- **Inputs**: three inputs vary, by a percentage of their medians to both sides or over their full ranges. "Study" is
  {ours}, which [the study at full size](paper_study.md) keeps. "Paper" is {papers}, which the paper keeps. "First two"
  is the first two of the study's, where landings cost most. The screening that chooses the inputs is not repeated.
- **Fit**: {terms} terms, {few} for two inputs, by least squares on a Smolyak grid. The grid has level 5 (441 points, as
  the order of the paper requires) or level 4 (177 points, 65 for two inputs). Errors are on 30 to 50 fresh points.
- **Lost** landings did not leave the bed.
- **Chaos** is the error that a perfect mean would still have, from landings moved by 0.1 mm.
- **Direction**: the paper does not state from where it counts the direction of the velocity. Both the elevation above
  the surface and the angle from its normal are listed; either counts as reached.

## Errors on fresh points

{errors}

A mean absolute error is also small where an output hardly varies over the range. Q2 is the fraction of the variance on
fresh points that the expansion explains. {skill}.

{fits}

## Why the error is larger on some beds

One parameter alone, friction or the restitution of the grains, was swept over its full range in equal steps. A step of
more than {jump:g} median steps is a jump. No polynomial of order {degree} follows a jump. If every step is large, chaos
is as large as the steps and jumps do not stand out; then the median step measures the roughness.

{kinks}

The table takes all sweeps of a bed together and counts ranges of the inputs "study" and "first two". The next table has
each sweep.

{sweeps}

## Limits

- Each bed has one impact point and one attitude. Errors differ from bed to bed.
- {missing}

## Reproduce this page

`python validation/expansion_accuracy_figures.py` writes the page and its figure. The landings: {made}.
"""
