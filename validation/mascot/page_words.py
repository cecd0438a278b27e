"""The words of docs/validation/mascot.md; what a script works out stands in braces."""

TEXT = """\
# MASCOT on Ryugu

Is the observed bouncing of MASCOT typical of simulated landers, on a soil that was not fitted to it?

{first}

## Flight and criterion

MASCOT, a box of 10 kg, fell 41 m in 350 s onto Ryugu. It bounced for 663 s and came to rest after
four intermediate contacts; its path is known to about 0.1 m [Scholten-2019]. It touched down on the
side of a boulder and came to rest another 17 m away [DLR-2019, Grott-2021].

The criterion was fixed before the runs: each of the three numbers lies between the quantiles 0.1
and 0.9 of the landers of a setting. "Time to rest" is defined as in journeys. It runs from the first
contact until no point of the lander has moved by 3 mm for 35 s. It therefore contains these 35 s,
and the minutes in which a lander creeps and rocks by centimetres. MASCOT's path is known to
0.1 m, so the time until a lander stays within 0.1 m of its place of rest is closer to what was
observed. It is listed as well.

## Result

![time, contacts and path of the landers](mascot.png)

Paths are horizontal distances, and contacts include the first. "Fraction below MASCOT" counts
landers with exactly MASCOT's value as half. The interval (90 %) counts landers as independent.

{answers}

{last}

The source states "four intermediate surface contacts" after the first. Counting the first contact,
and the one in which the lander settles, gives five or six. {readings}

## First contact

{bounces}

{thuillet}

"Hard" repeats the same landers and beds with a restitution of 0.83 +- 0.06 (standard deviation) for
grains, boulder and lander. This is the restitution of granite spheres of 1 m on each other
[Durda-2011]. A lander "stays there" if it does not hop higher than 0.45 m after its first contact.
The last column refers to the longest bouncing that was expected before the flight, 105 min.

The next table divides the landers with the boulder at the surface into halves, by one property at a
time, and lists the medians.

{halves}

## Set-up

- **Impact**: 14.3 to 14.6 cm/s (41 m in 350 s at 1.5e-4 to 1.63e-4 m/s2), within 25 degrees of the
  vertical. Any attitude. Spin 0.05 rad/s (standard deviation about each axis): a few turns during
  the fall.
- **Soil**, sampled for each lander: Young's modulus 5e5 to 5e6 Pa (log-uniform); restitution 0.3 to
  0.8 for grains and boulder, and for the lander; friction 0.5 to 0.9. A contact takes the
  smaller restitution of its two materials. Nothing is fitted to MASCOT.
- **Ground**: {grain_beds} beds of grains of {grain} m; {boulder_beds} with a boulder of 1 to 3 m
  that stands out by 0 to 0.5 m ("at the surface"); {boulder_beds} with the boulder's top 0.1 to
  0.2 m below the surface ("below"). Beds are periodic, so no lander leaves them. Grains follow a
  cumulative power law with exponent {exponent}. This is midway between {index}, measured for
  boulders above 5 m [Michikami-2021], and {flattest}, the flattest assumed here for smaller ones.
  The size of the boulder of a first contact follows this law, weighted by area.
- **First contact**: over the boulder, where it stands out of the grains or lies at most 0.2 m under
  them.
- **Later contacts**: on grains, or on such a boulder, with a probability equal to the fraction of
  the ground that boulders of 1 to 3 m cover: {fewest} to {most}. This follows from 4400 boulders
  above 5 m on 2.7 km2 [Michikami-2019] and an exponent below 5 m sampled between the two above.
- **Flights**: hops up to 0.45 m are part of the simulated landing. A higher one is a parabola under
  the local gravity to ground of the same height, with free rotation.

{beds}

## Limits

- Each setting has few beds, and landers on one bed are correlated. Intervals that count landers as
  independent are too narrow.
- The ground is level except for its rocks. A lander that leaves a boulder does not fall by the
  boulder's height.
- Grains are at least half as large as the lander; finer ones would absorb more of the impact.
- Young's modulus is far below that of rock. Contacts last longer, and the restitution is an input.
- The exponent of boulders below 5 m was not looked up in its source; the abstract does not give it.
- {stopped}

## Reproduce this page

`python validation/mascot/write_page.py` writes the page and its figure from the kept landers.

{made}
"""
