"""What the page of the experiments says around its tables: purpose and set-up of each experiment."""

TEXT = """# Held against experiment

{first}

Eight experiments and flights. Nothing is tuned but what their sources leave open. Written by
`python validation/experiments/write_page.py`; the rows stand in the CSV files beside that script.

{table}

The interval is that of the scatter of the rows alone. "Agrees" holds our value against a bar: 0.05
for exponents of depth, 25 % for the prefactor, times, depths and speeds, 0.03 for the exponents of
the sphere that settles, 0.15 to 0.25 for the speed ratio. One observation agrees where it lies
within eight tenths of ours. Who rebounds agrees where most of ours do. "Cause shown by" names the
rows, in the section of the experiment, that show why the two disagree. The sources were read as
abstracts ([what they say](experiments_sources.md), [references](../references.md)); the prefactor
0.14/mu is quoted from memory by those who set the bar and could not be read.

## A ball dropped into beads

Purpose: how deep a ball comes, against its density, its diameter and the height of its fall.
[Uehara-2003], [Ambroso-2005]: a ball dropped from rest into loose dry beads comes to a depth
d ~ density^(1/2) D^(2/3) H^(1/3), H being fall and depth together, after 3 d/v.

Set-up, as in DEM-Engine's demonstration `DEMdemo_BallDrop.cpp`: a ball of 25.4 mm, beads of eleven
sizes from 5/6 to 7/6 of 3 mm, 2500 kg/m3, restitution 0.9, friction 0.3, no rolling resistance.
Ours: a modulus of 1e7 Pa (theirs 7e7). The rows of the table at the top are the twelve drops, and
four diameters, into loose beads ("3 mm, periodic, loose, deeper"): ground that repeats after three
balls, 110 mm deep, of beads that fell at no more than 0.6 sqrt(g d). A light and a heavy ball from
0.1 m then meet other beds: between walls three balls apart, 85 mm deep, of beads that fell at up to
3 sqrt(g d) ("walls, dense"); on ground that repeats ("periodic"), four balls wide unless the name
says otherwise. Beds on periodic ground are poured on tiles and laid out. Depth is that of the
ball's lowest point, below the mean height of the topmost points of the beads or below the point of
first touch.

![drops](experiments/ball_into_beads.png)

{drops}

{verdict_beads}

{from_beads}

## A sphere that settles under other gravities

Purpose: what gravity does to a sphere that sinks under its own weight. [Altshuler-2014]: into a
light granular bed it sinks to a depth that no gravity changes, in a time that goes as g^(-1/2);
measured from 0.4 to 1.2 of Earth's gravity, by simulation far beyond.

Set-up (the source's grains and sphere could not be read): a sphere of 10.5 mm and 8000 kg/m3 on
beads of 2.1 mm and 1000 kg/m3, on ground that repeats after three spheres; modulus 5e5 Pa under
every gravity, friction 0.3, restitution 0.9. Each bed falls and settles under its own gravity.

![settling](experiments/settling_in_other_gravities.png)

{settled}

{verdict_gravity}

{from_gravity}

## A grain on a bed of its own kind

Purpose: how much a slow grain keeps, and how many others it throws. [Bogdan-2020]: basalt spheres
of 150 um hit a granular bed at 0.8 m/s. The grain keeps about 0.20 of its speed on average, fewer
than ten others are ejected, and they rise by less than a grain typically.

Set-up: spheres of three sizes from 0.95 to 1.05 of 150 um, 2900 kg/m3, modulus 1e7 Pa, restitution
0.8, friction 0.5 (neither is in what could be read), on ground that repeats after eight grains;
four beds, random points. A grain counts as ejected where, touching nothing, its flight takes it so
far above where it lay. A grain that still touches the bed after 1.5 ms, or falls back, stays. The
source says of the grain that it "still rebounds"; whether its mean counts grains that stay it does
not say, so both means stand here.

![grains](experiments/grain_on_its_own_kind.png)

{impacts}

{verdict_grains}

{from_grains}

## A spacecraft's plate on loose grains

Purpose: what stops a plate in almost no gravity. [Walsh-2022] and reports of the flight of
OSIRIS-REx: 1300 kg came down on a round plate of 32 cm at 0.1 m/s; gas was let out after 1 s, and
after 6 s the spacecraft still went down at about 0.04 m/s. The grains that fit had near-zero
cohesion and half of Bennu's bulk density. Simulations before the flight [Ballouz-2021]: from 0.6
filled on, grains resist the plate if their angle of friction is at least 28 degrees or their
cohesion at least 50 Pa; up to 0.5 filled, a drag governs that goes as the impact speed to the 4/3.

Set-up: spheres of 7 cm, 2000 kg/m3, that fill a given share of space, 1 m deep, and touch nowhere;
the ground repeats after four plates. Friction 0.6 and rolling resistance 0.1 ("rough"), or 0.2 and
none ("smooth"); modulus 1e6 Pa; cohesion is the pull of a contact over the square of the diameter.
No gravity, which in 6 s moves nothing by more than a millimetre; no gas. A bed resists where the
plate has less than a tenth of its speed after 6 s.

![plate](experiments/plate_into_loose_grains.png)

{plate}

{verdict_plate}

{from_plate}

## Packing against gravity, with and without cohesion

Purpose: whether cohesion is what makes beds looser under less gravity. [Keulen-2026]: settled in a
drop tower, glass beads of 0.75 to 1 mm take up to 4.25 % more volume than on Earth (at 0.25 m/s2),
broken basalt of 2 to 5 mm up to 12.2 % (at 0.15 m/s2).

Set-up: spheres of these sizes fall as a loose column under a drag that holds them below
3 sqrt(g d), in a box nine grains wide, as stiff as 2e4 times density, gravity and size. By
similarity only the pull of a contact over the weight of a grain tells such beds apart, so one curve
serves for every gravity.

![packing](experiments/packing_and_cohesion.png)

{packing}

{verdict_packing}

{from_packing}

## A ball on beads under several gravities

Purpose: two rules that contradict each other. [Sunday-2022]: depth and duration of a 10 cm ball on
1 cm beads follow the Froude number, at 9.81 to 0.001 m/s2. [Murdoch-2017]: on sand, at 0.2 to
1 m/s2, depth is proportional to speed and the same under every gravity.

Set-up: a ball of 10 cm and 2700 kg/m3 on beads of eleven sizes about 1 cm in a box of 26 by 26 by
14 cm, 2500 kg/m3, friction 0.4, restitution 0.8, modulus 3e6 Pa under every gravity; each bed
settled under its own. "Stiffer" beads have ten times the modulus, on ground that repeats after
26 cm; so has the ground of "pulling" beads, whose contacts pull by 300 Pa on the square of a bead's
diameter, and which settled under Earth's gravity, most of which was then taken off. Depth is
counted from the first touch; the exponents are those of one product of powers.

![balls](experiments/ball_under_gravities.png)

{ball}

{verdict_balls}

{from_balls}

## Who rebounds, slow or fast

Purpose: at which speed a ball rebounds from grains in low gravity. [Colwell-2003]: a quartz ball of
2 cm on quartz sand or JSC-1, 2 cm deep, in the Shuttle (about 1e-3 g) stays below 20 cm/s and
rebounds above 25. COLLIDE-1: Teflon on JSC-1. [Brisset-2018]: at 1e-2 g all of 4 to 230 cm/s stay;
below 1e-4 g those of lowest energy rebound. [Brisset-2020]: on irregular grains of mm and cm balls
often bounce.

Set-up: that ball (2650 kg/m3; "teflon" 2200) on spheres of 3, 4 and 6 mm, 2 cm deep, of quartz's
density, restitution 0.6, friction 0.5, rolling resistance 0.1, on ground that repeats after three
balls; or on "pebbles", hulls of 10 mm, 3.5 cm deep. "Lunar" are spheres, of 6 mm unless the name
says otherwise, that pull on each other with the surface energy of clean lunar soil, 0.0029 J/m2
[Perko-2001], of which JSC-1 is a simulant. Beds settle under Earth's gravity, which is then taken
off slowly. Drops on stiff grains that do not pull differ in the Froude number alone, so one cell
stands for every gravity with its speed. A ball rebounds if it rises by 0.5 mm from its deepest
place. The rows of the table at the top are those of 4 mm unless they say otherwise.

![who rebounds](experiments/who_rebounds.png)

{rebound}

{verdict_rebounds}

{from_rebounds}

## MASCOT on Ryugu

[Scholten-2019]: MASCOT, a box of 10 kg, fell 41 m in 350 s, met Ryugu for the first time, and came
to rest 663 s and four contacts later, some 17 m further on. Ours: landers that meet a boulder of 1
to 3 m first and are followed to rest by simulated landings. [MASCOT on Ryugu](mascot.md) has beds,
settings and the landers whose first contact is below the surface or on grains alone.

{from_mascot}
"""

WHY = {}
