"""The words of docs/validation/paper_study.md; what a script works out stands in braces."""

HEAD = """\
# The paper's study: tables

How much does the result of the published method depend on the bed, and how accurate is its expansion?

The paper method gives return fractions from {least} to {most} % on {beds} beds. The drawn method gives {value} % (90 %
interval {low}-{high} %) over beds, impact points and attitudes. On fresh runs the expansion of order 5 has mean
absolute errors of {errors}; the paper reports {published}.

[The paper's study](../paper_study.md) explains set-up and results; this page has the tables. Brackets contain 90 %
intervals.
"""

ANSWERS = """\
![Return fraction and rebound speed, study by study](paper_study_answers.png)

"±" is the standard deviation over the samples. Elevation is the angle of the rebound velocity above the surface. The
interval of a return fraction covers beds, impact points and attitudes for the drawn studies. For the paper method it
covers the sampling of the flights only. "Paper method, seed N" repeats it at order 3 on another bed.

{answers}

The next table lists the origin of the variance of the rebound speed. For the paper method it has the three largest
total Sobol indices of the expansion of order 3; they may sum to more than 1. For the drawn studies it has fractions of
the variance. "Everything else" is impact point, attitude and the effects of the soil beyond terms of first and second
degree. Estimates below 0 are shown as 0.

{drivers}
"""

ERRORS = """\
MAPE is the mean absolute error in percent of the output, Q2 the coefficient of determination on fresh runs. "Kept
inputs" are three of the five; the others have their medians. "Due to chaos" is the error that a perfect mean would
still have. It follows from runs that repeat the same soils with the impact point moved by 0.1 mm. "From the normal"
counts the elevation from the normal of the surface, because the paper does not state its reference.

{errors}
"""

FITS = """\
"Grids" are the runs of the two expansions; "drawn" are 150 further runs with randomised inputs. Scores are on fresh
runs.

{fits}
"""

NUMERICS = """\
One numerical parameter is changed at a time, on 8 beds with 640 landings each. "/ reference" divides by the mean of the
reference above it.

{numerics}

{outcomes}
"""

GRAINS = """\
The table has the drawn study on smaller grains. The first row is the study of 700 landings; the others have 320.

{grains}
"""

COST = """\
Times are for two cores; the load is that of the machine.

{cost}
"""

END = """\
## Limits

The paper does not publish its input ranges, impact speed, grains or lander, so only its design can be reproduced,
not its numbers. [The paper's study](../paper_study.md#limits) lists the limits of the beds.

## Reproduce this page

`python validation/paper_study_figures.py` writes the page and its figures from the kept results.
`python validation/recreate.py` lists the commands that compute them, with their CPU times.
"""
