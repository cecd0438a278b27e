"""The sentences of docs/validation/nine_codes.md that hold whatever the runs give."""

HEAD = """# An impact that nine codes computed

Does this engine reproduce the impact of a ball that other discrete-element codes have computed?
"""
SOURCE = """
## Benchmark and criterion

Dosta and others [Dosta-2024] gave nine open codes the same problems, with materials, walls and
initial positions. In one of them a steel ball of 20 mm hits 25 000 spheres of 2 mm at 5 m/s; the
bed is 34 mm deep. The published curves were not accessible. MercuryDPM was therefore built and run
here with the driver of that work (repository kuwt/MercuryDPM_fork, commit fb0ebf1d,
`Drivers/Papers/OSBenchmark`). LAMMPS was run from the bed that was relaxed here.

The criterion was set before the runs: at 10, 20, 50 and 100 ms, the height z of the ball's centre
is within 1 mm (half a grain) of MercuryDPM's, and MercuryDPM's is within the range of impacts on
five beds. No other beds were poured. Instead, the range here is that of several impacts on the
published bed: in the middle, at other points, and shifted by a billionth of a metre ("nudged").

MercuryDPM's driver sets no tangential dashpot. The engine has one; the run that is compared ("no
dashpot") leaves it out (`World(tangential_dashpot="none")`). "Published" is the same impact with
the dashpot, as are the others of the range: for the compared law there is no range. In "no
dashpot later" the bed relaxes with the dashpot, and the ball falls without it; LAMMPS starts from
that bed.

## Heights

![Height of the ball](nine_codes.png)
"""
FREE_FALL = """
The number in brackets is that of the impacts in the range. "*": extrapolated in free flight from
the end of the run; grains that the ball would meet in the air are not included.

The ball meets the first grain after 20.7 ms. At 10 and 20 ms it falls freely in any code, so these
times test gravity alone. The times between 22 and 32 ms were added because the ball is in the bed
then.
"""
CONDITIONS = """
## Set-up

- **Bed.** The published positions, at rest, without the tangential springs that had held them. They
  relax under gravity until the ball arrives, in both codes. The box has the published walls: inner
  faces at x = ±49 mm, y = ±30 mm and z = -90.2431 mm. (The driver's smooth walls, which it does not
  use, would be at ±50 mm.)
- **Materials.** Spheres M1: E 1 GPa, ν 0.2, 2500 kg/m3. Steel: 210 GPa, ν 0.2, 7200 kg/m3.
  Restitution and friction: M1-M1 0.5 and 0.3, M1-steel 0.4 and 0.2, steel-steel 0.6 and 0.5. In
  this engine a pair takes a value from its two materials. With `pair_rule="mean"`, three materials
  give these pairs exactly; each set of bodies has walls of its own (`impact_bed.py`).
- **Contact laws.** All codes use the springs of Hertz and Mindlin. Without the tangential dashpot,
  two differences from MercuryDPM are left. A contact never pulls here, while MercuryDPM's damping
  can pull as the contact ends. Therefore the damping ratio for a given restitution differs too (for
  0.4, it is 0.355 here and 0.280 there).
"""
MISSING = """
## Limits

- The nine published curves were not accessible, so their range is not shown.
- The silo and the drum of the benchmark were not run:
    - **Silo** (100 000 spheres of 4 mm, outflow in 5 s): the four files of initial positions are
      absent from the snapshot of the repository. The engine cannot model a cone that ends at an
      orifice, because its walls are half-spaces and it has no triangle meshes. It cannot remove
      bodies either.
    - **Drum** (38 000 spheres of two materials, 2 rad/s, 5 s): the engine's planes are static; a
      wall that rotates or slides under its contacts is missing. The properties of pairs of
      materials cannot be given as a table either: M1-M2 has restitution 0.45 and friction 0.2, and
      no rule for two materials gives friction 0.2 from 0.3 and 0.4. The drum needs 6.25 million
      steps of 8e-7 s.

## Reproduce this page

`python validation/nine_codes/write_page.py` writes the page and its figure from the kept runs.
`python validation/recreate.py` lists the commands that compute them, with their CPU times.
"""
PAIRS = """
## Two pair tests

In the first test a sphere M1 (radius 1 mm) falls at 1 m/s from z = 1.01 mm onto steel, without
gravity. In the second a sphere of steel at rest on M1 is accelerated by (5, 0, -5) m/s2 for 5 ms.
Closed forms: the restitution as entered; Coulomb sliding from the start, with acceleration
a = g (1 - μ) and spin rate increasing by 5 μ g / 2R. Criterion: relative error below 1e-3.
"""
PAIRS_AFTER = """
Sliding agrees with the closed forms and with MercuryDPM to 1e-3. The restitution agrees to 1e-3 for
steps of a fifth of the published one or less. A contact begins and ends within a step, which is a
fortieth of its duration, so the error is proportional to the step. MercuryDPM behaves in the same
way: its 0.40108 becomes 0.39995 at a tenth of the step. Its damping force is not clipped and pulls
as the contact ends.
"""
RUNS_WORDS = """
## Simulations

In this engine, the bed relaxes with steps of 1e-6 s while the ball falls freely, until 20.5 ms. The
step is then the published 5e-7 s until 32 ms, and after that 1e-6 s or 0.9 of the largest stable
step. MercuryDPM has steps of 4e-6 s in free fall, 1e-6 s until 30 ms, 3e-6 s until 50 ms and 4e-6 s
after that; its contact search has cells that fit both sizes of spheres. At the published step it
would take some ten thousand CPU seconds. The table states the end of each run; "not run" marks runs
that were planned only. CPU
times were measured while other programs ran.
"""
