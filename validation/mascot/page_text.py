"""The words of docs/validation/mascot.md; what a script works out stands in braces."""

TEXT = """\
# MASCOT on Ryugu

{first}

MASCOT, a box of 10 kg, fell 41 m in 350 s, met Ryugu, bounced for 663 s, and came to rest after
four intermediate contacts; its path is known to about 0.1 m [Scholten-2019]. It touched down on the
side of a boulder and went another 17 m [DLR-2019, Grott-2021]. Fixed before the runs: each of the
three numbers lies between the quantiles 0.1 and 0.9 of the landers of a setting. The time is the
time to rest of journeys; the one until a lander stays within 0.1 m stands beside it as the reason
where that fails.

{stopped}

![time, contacts and path of the landers](mascot.png)

{answers}

A time to rest counts from the first contact until no point of the lander has moved by 3 mm for 35
s, so it holds these 35 s and the minutes in which a lander creeps and rocks by centimetres; the
time until it stays within 0.1 m is the one that was observed. Paths are horizontal, contacts
include the first. Landers that have just as many as MASCOT count half as below it.

{last}

{readings}

## What the first contact does

{bounces}

{thuillet}

"Hard" is the same landers and beds with a restitution of 0.83 +- 0.06 for grains, boulder and
lander, which is that of granite balls of 1 m on each other [Durda-2011]. "Stays there" are those
that do not hop higher than 0.45 m after their first landing. 105 min is how long the bouncing was
expected to take at most before the flight.

Of the landers at the surface, medians by halves:

{halves}

## What is simulated

- **Arrival**: 14.3 to 14.6 cm/s, which is 41 m in 350 s under 1.5e-4 to 1.63e-4 m/s2, within 25
  degrees of the vertical; any attitude, and a spin of 0.05 rad/s (standard deviation about each
  axis), a few turns in the fall.
- **Soil**, each lander its own: Young's modulus 5e5 to 5e6 Pa (log-uniform), restitution of grains
  and boulder, and of the lander, 0.3 to 0.8, friction 0.5 to 0.9. Material pairs take the smaller
  restitution. Nothing of this is fitted to MASCOT.
- **Ground**: {grain_beds} beds of grains of {grain} m, {boulder_beds} with a boulder of 1 to 3 m
  that stands out by 0 to 0.5 m (at the surface), {boulder_beds} with its top 0.1 to 0.2 m under the
  surface (below). They repeat, so no lander is lost. Grains follow the cumulative size law with the
  exponent {exponent}, midway between the {index} of boulders above 5 m [Michikami-2021] and
  {flattest}, the flattest that is supposed here for smaller ones. Boulders at a first contact are
  as frequent as this law and their area make them.
- **First contact**: over the boulder, where it stands out of the grains, or is at most 0.2 m under
  them.
- **Later contacts**: on grains, or on such a boulder as often as boulders of 1 to 3 m cover the
  ground: {fewest} to {most}, from 4400 boulders above 5 m on 2.7 km2 [Michikami-2019] and an
  exponent below 5 m between the two, drawn by each lander.
- **Flights**: hops up to 0.45 m are part of a landing. A higher one is a parabola under the local
  gravity to ground of the same height, with free rotation.

{beds}

## What it does not say

Few beds stand for each setting, and landers on one bed are alike: the intervals of the table count
landers as independent, so they are too narrow. Ground is level but for its rocks, and a lander that
leaves a boulder does not fall the height of that. Grains are half as large as the lander or more;
finer ones take more of a blow. The modulus is far below that of rock: contacts last longer, and
restitution is what it is told to be. The exponent of boulders below 5 m was not looked up in its
source; the abstract does not give it.

{made}
"""
