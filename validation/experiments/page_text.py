"""What the page of the experiments says around its tables: question, source and set-up of each experiment."""

TEXT = """# Comparison with experiments

How well does the model reproduce published experiments and spacecraft contacts?

**{first}**

Nine experiments are compared. Every parameter that a source gives is used as given. Parameters that
a source leaves open are chosen and named below; none is fitted to the result. Young's modulus is
smaller than that of glass or rock, to save time. Where softer and stiffer grains were compared and
differ, the stiffer count, and both are shown. The table counts the quantities of each experiment
that agree. For those that do not, it counts how many have a cause that further simulations on this
page show.

{summary}

## How the comparison works

The sources were read as abstracts, two numbers as others quote them. [Experiments: what their
sources say](experiments_sources.md) lists what was read and what was not;
[references](../references.md) has the full citations.

- **Interval.** "+-" in the first table of each section is the half-width of the 95 % confidence
  interval; brackets behind a fraction hold the interval itself. It covers only the scatter between
  the simulations, not the error of the measurement.
- **Agreement.** A quantity agrees if the simulated value lies within a fixed tolerance of the
  measured one. The tolerance is 0.05 for exponents of depth, duration, size and force, 0.03 for the
  exponents of the settling sphere, and 0.05 for the speed ratio of a single grain. It is 25 % for
  the prefactor, the coefficients of a force, times, depths, speeds and densities, and 50 % for the
  speed ratio of COLLIDE-1.
- **Single observations.** MASCOT was observed once. The observation agrees if it lies within the
  central 80 % of the simulated landers.
- **Outcomes.** "Rebounds" or "stays" agrees if more than half of the simulated drops do so.
  "Typical" agrees if more than half of the impacts do so.
- **Cause shown by.** For a quantity that disagrees, this column names the simulations on this page
  that show why. "Not shown" means that no simulation here explains it.

## Ball dropped into beads

Question: how does the depth of a dropped ball depend on its density, its diameter and the height
of its fall?

{lines_beads}

Experiment [Uehara-2003], [Ambroso-2005]: a ball is dropped from rest into loose dry beads. Its
depth $d$ is proportional to $\\rho^{{1/2}} D^{{2/3}} H^{{1/3}}$, with its density $\\rho$, diameter $D$ and
total drop distance $H$ (fall plus depth). It stops after $3 d/v$, $v$ being the impact speed. The
prefactor $0.14/\\mu$ is quoted from a secondary source; the original value could not be read
("unverified").

Set-up, after DEM-Engine's demonstration `DEMdemo_BallDrop.cpp`: a ball of 25.4 mm; beads of eleven
sizes from 5/6 to 7/6 of 3 mm, density 2500 kg/m3, restitution 0.9, friction 0.3, no rolling
resistance. Young's modulus is 1e7 Pa here and 7e7 Pa there. The bed is 110 mm deep and periodic
with a period of three ball diameters. It is loose: beads fell at no more than $0.6\\sqrt{{gd}}$. The
table above uses the twelve drops and the four diameters into this bed ("3 mm, periodic, loose,
deeper").

Depth is that of the ball's lowest point. It is measured from two surfaces: the mean height of the
topmost points of the beads ("mean surface"), and the point of first touch.

![Depths, stopping times and exponents of density](experiments/ball_into_beads.png)

In the right panel, beds named by the size of the beads and a change are loose, deep and periodic.

{drops}

{verdict_beads}

{from_beads}

## Force that stops a ball in beads

Question: which force acts on a ball on its way into beads?

{lines_stopping}

Experiment [Katsuragi-2007]: a steel ball of 25.4 mm and 8070 kg/m3 falls with 0 to 4 m/s into glass
beads of 0.25 to 0.35 mm, with a solid fraction of 0.59 and a slope of a heap of 24 degrees. Its
deceleration is $v^2 / d_1 + (k / m) z - g$, with its speed $v$ and depth $z$: an inertial drag and
a friction that grows with depth. The faster the ball, the sooner it stops. Numbers and method are
those that the documentation of another code quotes.

Set-up: the loose bed of 3 mm beads of the section before, with the source's solid fraction and
slope of a heap, but beads ten times as large. Nothing was chosen anew. Steel balls fall from 0.02
to 0.4 m (0.6 to 2.8 m/s), a lighter and a heavier ball from 0.05 to 0.2 m. The two coefficients
come from the deceleration of balls of different speed at equal depths, in intervals of a bead from
the depth of a radius on; friction is a straight line through 0. Intervals leave out one drop at a
time. A ball has stopped when it is slower than 2 % of its impact speed. Depth is measured from the
mean surface.

![Speed and friction over depth](experiments/stopping_force.png)

{stopping}

{verdict_stopping}

{from_stopping}

## Sphere settling under other gravities

Question: how does gravity change the depth to which a sphere sinks under its own weight, and the
time it takes?

{lines_gravity}

Experiment [Altshuler-2014]: a sphere sinks into a light granular bed. The depth does not depend on
gravity, and the time is proportional to $g^{{-1/2}}$. This was measured from 0.4 to 1.2 of Earth's
gravity and simulated far beyond.

Set-up (the source's grains and sphere could not be read): a sphere of 10.5 mm and 8000 kg/m3 on
beads of 2.1 mm and 1000 kg/m3, periodic with a period of three sphere diameters. Young's modulus is
5e6 Pa under every gravity, friction 0.3, restitution 0.9. Each bed is poured and settles under its
own gravity.

![Depth and time of settling by gravity](experiments/settling_in_other_gravities.png)

{settled}

{verdict_gravity}

{from_gravity}

## Grain impact on a bed of its own kind

Question: how much of its speed does a slow grain keep, and how many other grains does it eject?

{lines_grains}

Experiment [Bogdan-2020]: basalt spheres of 150 um hit a granular bed at 0.8 m/s. On average the
grain keeps about 0.20 of its speed. Typically fewer than ten other grains are ejected, and they
rise by less than a grain.

Set-up: spheres of three sizes from 0.95 to 1.05 of 150 um, density 2900 kg/m3, Young's modulus
1e7 Pa. Restitution 0.8 and friction 0.5 are assumed; the part of the source that could be read
gives neither. The bed is periodic with a period of eight grains; there are four beds with random
impact points.

A grain counts as ejected when it touches nothing and its trajectory rises by the stated height
above its place in the bed. The impacting grain "stays" if it still touches the bed after 1.5 ms or
falls back. The source states that the grain "still rebounds". It does not state whether its mean
includes grains that stay, so both means are compared.

![Speed ratios and grains ejected](experiments/grain_on_its_own_kind.png)

{impacts}

{verdict_grains}

{from_grains}

## Spacecraft plate on loose grains

Question: what stops a plate that meets loose grains in almost no gravity?

{lines_plate}

Flight [Walsh-2022] and reports on OSIRIS-REx: a spacecraft of 1300 kg touched Bennu with a round
plate of 32 cm at 0.1 m/s. Gas was released after 1 s. After 6 s the spacecraft still moved down at
about 0.04 m/s. The depth of 0.39 m follows from these two speeds, with a drag force between them;
it was not measured. Grains that reproduce the flight have near-zero cohesion and half of Bennu's
bulk density.

Simulations before the flight [Ballouz-2021]: at a packing fraction of 0.6 and above, grains stop
the plate if their friction angle is at least 28 degrees or their cohesion at least 50 Pa. Up to
0.5, the force is a drag proportional to the impact speed to the power 4/3.

Set-up: spheres of 7 cm and 2000 kg/m3 at a given packing fraction, 1 m deep, placed so that none
touch; periodic with a period of four plates. "Rough" grains have friction 0.6 and rolling
resistance 0.1; "smooth" grains have 0.2 and none. Young's modulus is 1e6 Pa. Cohesion is the
pull-off force of a contact divided by the square of the grain diameter. There is no gravity, which
in 6 s would move nothing by more than a millimetre, and no gas. A bed "stops" the plate if less
than a tenth of its speed is left after 6 s.

![Speed of the plate and force on it](experiments/plate_into_loose_grains.png)

{plate}

{verdict_plate}

{from_plate}

## Packing under low gravity, with and without cohesion

Question: is cohesion the reason why beds are looser under less gravity?

{lines_packing}

Experiment [Keulen-2026]: grains settled in a drop tower. Glass beads of 0.75 to 1 mm take up to
4.25 % more volume than on Earth (at 0.25 m/s2), broken basalt of 2 to 5 mm up to 12.2 % (at
0.15 m/s2).

Set-up: grains of these sizes, spheres for glass and convex hulls for basalt, fall as a loose
column in a box nine grains wide. A drag limits their speed to $3\\sqrt{{gd}}$. Young's modulus is
2e4 times density, gravity and size. By similarity, such beds differ only in the ratio of the
pull-off force to the weight of a grain, so one curve holds for every gravity.

![Solid fraction by pull-off force](experiments/packing_and_cohesion.png)

{packing}

{verdict_packing}

{from_packing}

## Ball on beads under several gravities

Question: does the depth of a ball follow the Froude number or the speed? Two sources contradict
each other.

{lines_balls}

Experiments: [Sunday-2022] finds that depth and duration of a 10 cm ball on 1 cm beads follow the
Froude number, from 9.81 to 0.001 m/s2. [Murdoch-2017] finds on sand, at 0.2 to 1 m/s2, that depth
is proportional to speed and independent of gravity.

Set-up: a ball of 10 cm and 2700 kg/m3 on beads of eleven sizes around 1 cm, in a box of 26 by 26 by
14 cm. Beads have density 2500 kg/m3, friction 0.4, restitution 0.8 and Young's modulus 3e6 Pa
("plain"), under Earth's gravity 3e7 Pa ("stiffer"): it is at least 1e5 times density, gravity and
diameter of a bead. Each bed settles under its own gravity. The table of drops also holds those
under Earth's gravity on plain beads, and two beds with a period of 26 cm instead of walls. One has
3e7 Pa. In the "cohesive" one, as stiff as the plain, the pull-off force of a contact is 300 Pa
times the square of a bead's diameter; it settled under Earth's gravity, which was then reduced.
Depth is measured from the first touch. Exponents come from a fit of a product of powers.

![Depth and duration by Froude number and by speed](experiments/ball_under_gravities.png)

{ball}

{verdict_balls}

{from_balls}

## Rebound or embedding of a ball at low speed

Question: at which speed does a ball rebound from grains in low gravity?

{lines_rebounds}

Experiments: in the Shuttle (about 1e-3 g), a quartz ball of 2 cm on quartz sand or JSC-1, 2 cm
deep, stays below 20 cm/s and rebounds above 25 (COLLIDE-2, [Colwell-2003]). COLLIDE-1 dropped
Teflon balls on JSC-1. At 1e-2 g all balls of 4 to 230 cm/s stay; below 1e-4 g those of the lowest
energy rebound [Brisset-2018]. On irregular grains of millimetres and centimetres balls often bounce
[Brisset-2020].

Set-up: the same ball (2650 kg/m3; "teflon" 2200) on spheres of 3, 4 and 6 mm, 2 cm deep, with the
density of quartz, restitution 0.6, friction 0.5 and rolling resistance 0.1. The bed is periodic
with a period of three balls. "Pebbles" are convex hulls of 10 mm, 3.5 cm deep. "Lunar" grains are
spheres, of 6 mm unless the name gives another size, with the surface energy of clean lunar soil,
0.0029 J/m2 [Perko-2001]; JSC-1 is a simulant of that soil.

Beds settle under Earth's gravity, which is then removed slowly. Drops on stiff grains without
cohesion differ only in the Froude number, so one row of the table holds for every gravity at the
speed listed. A ball rebounds if it rises by 0.5 mm above its deepest point. Quantities in the table
above use the 4 mm grains without cohesion unless they name others.

![Fraction that rebounds and speed ratio by Froude number](experiments/who_rebounds.png)

{rebound}

{verdict_rebounds}

{from_rebounds}

## MASCOT on Ryugu

Question: are the number of contacts, the time to rest and the path of MASCOT typical of simulated
landers?

{lines_mascot}

Flight [Scholten-2019]: MASCOT, a box of 10 kg, fell 41 m in 350 s and touched Ryugu. It came to
rest 663 s and four contacts later, some 17 m away. The simulated landers hit a boulder of 1 to 3 m
first and are followed to rest. [MASCOT on Ryugu](mascot.md) describes the beds and settings, and
the landers whose first contact is over a buried boulder or on grains alone.

{from_mascot}

## Limits

- Each source was read as an abstract. Contact parameters, grain shapes and single measured values
  are mostly unknown, and the measurement error is not part of the comparison.
- Most beds are of spheres. The sand, basalt and rock of several sources are not.
- Intervals cover the scatter between simulations only. Several rows rest on fewer than eight drops.
- The effect of OSIRIS-REx's gas is not simulated.

## Reproduce this page

`python validation/experiments/write_page.py` writes this page and its figures from the CSV files in
`validation/experiments/`. The command at the end of each section computes the simulations again.
"""
