"""What the page of the experiments says around its tables."""

TEXT = """# Held against experiment: balls and grains on beds of beads

{first}

Three experiments, with nothing tuned but what their sources leave open. Written by
`python docs/validation/experiments/write_page.py`; the rows stand in the CSV files beside it.

{table}

The interval is that of the rows' scatter alone. "Agrees" holds our value against the bar: .05
for exponents of depth, 25 % for the prefactor and the stopping time, .03 for exponents of
gravity, .15 to .25 for the speed ratio. The sources were read as abstracts
([references](../references.md)); the prefactor .14/mu is quoted from memory by those who set the
bar and could not be read.

## A ball dropped into beads

[Uehara-2003], [Ambroso-2005]: a ball dropped from rest into loose dry beads comes to a depth
d ~ density^(1/2) D^(2/3) H^(1/3), H being fall and depth together, after 3 d/v, at a deceleration
that falls all the time. Twelve drops of a ball of 25.4 mm, as DEM-Engine's demonstration
`DEMdemo_BallDrop.cpp` has them: Poisson's ratio .24, restitution .9, friction .3, no rolling
resistance, beads of eleven sizes from 5/6 to 7/6 of the mean, 2500 kg/m3.

What is ours: beads of 5 mm on average (theirs 3 mm), 4233 of them; a modulus of 1e7 Pa (theirs
7e7); a box of three ball diameters, 85 mm deep (theirs 7.9 diameters); 15 steps in the shortest
contact. The bed falls from a lattice under a drag that holds the beads below 3 sqrt(g d), until
the mean resultant force is below a hundredth of the mean contact force and the kinetic energy
below 1e-5 of that which lifts all beads by a diameter, then without drag until both hold again.
Depth is that of the ball's lowest point below the mean height of the topmost points of the
beads.

![drops](experiments/ball_into_beads.png)

{drops}

{why_beads}

{similar}

{from_beads}

## A sphere that settles under other gravities

[Altshuler-2014]: a sphere released at the surface of a light granular bed sinks to a depth that
no gravity changes, in a time that goes as g^(-1/2); measured from .4 to 1.2 of Earth's gravity,
by simulation far beyond. Their grains and sphere could not be read. Ours: a sphere of 10.5 mm
and 3000 kg/m3, 542 beads of 3 mm and 1000 kg/m3, modulus 2e5 Pa at every gravity, friction .3,
restitution .9; each bed falls and settles under its own gravity.

{settled}

{why_gravity}

{from_gravity}

## A grain on a bed of its own kind

[Bogdan-2020]: basalt spheres of 150 um hit a bed of their own kind at .8 m/s. The grain keeps
about .20 of its speed on average, fewer than ten others are ejected, and they rise by less than
a grain typically. Ours: 882 spheres of three sizes from .95 to 1.05 of 150 um, 2900 kg/m3,
modulus 1e7 Pa, restitution .8, friction .5 (neither is in what could be read), random points at
least two and a half grains from the walls. A grain counts as ejected where, touching nothing,
its flight takes it so far above where it lay. A grain that still touches the bed after 1.5 ms,
or falls back, stays: whether the source's mean counts it is not in its abstract, so both means
stand here.

{impacts}

{why_grains}

{from_grains}
"""

WHY_BEADS = """The steepness in density, and the long stopping times of light balls, are not the law's. What the
rows say of the cause: beads of a fifth of the ball's diameter leave the surface itself unsure.
The ball touches 4.1 mm above the mean of the tops, .83 of a bead, while the lightest comes only
8 to 13 mm deep. Counted from the first touch, the exponent of density falls from .70 to .58,
that of the drop distance from .35 to .29, and the prefactor rises from .26 to .31. The surface
matters little to the heaviest ball, whose depths and stopping times (2.6 to 3.5 d/v) are the
experiment's. The light ball loses nine tenths of its speed within 25 ms, then sinks at .15 m/s
for 15 ms more at no deceleration at all: that makes its 6.6 to 8.4 d/v. The deceleration rises
for 4 ms, while the ball enters by about a bead, and falls from then on but for bumps. The bed is
also denser than "loose": .61 of it is filled. Which of these makes the exponent, no row tells
yet.

Not run yet, each a series of the script by name: beads of 3 mm (`--beads 3`), other
diameters, a narrower, wider, lower and higher box, a slowly poured bed, other moduli, frictions
and a lower restitution, steps of every contact's own, our own slope of repose. Until then the
prefactor is held against the middle of .39 to .45, the slopes of glass beads."""
WHY_GRAVITY = """The sphere sinks by a quarter of its diameter, less than a bead, and where it lies on the beads
decides: from 1.1 to 4.4 mm from place to place and bed to bed. The rows of one bed share it, so
the intervals are too narrow, and whether .03 is met these rows cannot tell. A trend there may
be: by similarity a bed of one modulus under less gravity is a bed as much stiffer under the same
one, and only E / (density g D) tells the rows apart, 1900 under Earth's gravity. 2e5 Pa is soft
there: beds settle denser (.63 and .62 filled; .57 under a hundredth of it). What is needed is a
bed into which the sphere sinks by its diameter: denser spheres, finer beads. Under 1e-4 of
Earth's gravity a drop costs forty times as much, and none has run yet."""
WHY_GRAINS = """\
Nearly half of the grains stay, in a pocket between others; those that leave keep a little more
than the measured fifth, all together clearly less. Nearly all that is ejected rises by less than
half a grain, so how many there are depends on how little a rise is seen. Another restitution
(.5) and friction (.2), a stiffer material and a wider, deeper bed have not run yet."""
