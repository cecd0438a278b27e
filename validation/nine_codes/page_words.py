"""The sentences of docs/validation/nine_codes.md that hold whatever the runs give."""

HEAD = """# An impact that nine codes computed

Written by `python validation/nine_codes/write_page.py`.

Dosta and others [Dosta-2024] gave nine open codes the same problems, with materials, walls and
initial positions. In one of them a ball of steel, 20 mm wide, comes down at 5 m/s on 25 000 spheres
of 2 mm, 34 mm deep. MercuryDPM was built and run here with the driver of that work (repository
kuwt/MercuryDPM_fork, commit fb0ebf1d, `Drivers/Papers/OSBenchmark`). The published curves were not
accessible, so that no band of the nine codes is drawn.

Criterion, set before the runs: the height z of the ball's centre within 1 mm, half a grain, of that
of MercuryDPM at 10, 20, 50 and 100 ms, and within the range of five beds. No other beds were
poured: the range is that of the impacts below on the published bed, in the middle, elsewhere or
nudged, as many as the number in brackets.
"""
FREE_FALL = """
\\* carried on in free flight from where the run ends; grains that the ball meets in the air are not
in it. The ball meets the first grain after 20.7 ms: at 10 and 20 ms it falls freely in any code,
and these two times test gravity alone. The times between 22 and 32 ms are added, because the ball
is in the bed then.
"""
CONDITIONS = """
## Conditions

- **Bed.** The published positions, at rest, without the springs of friction that had held them.
  They relax under gravity until the ball comes, in both codes. The box is that of the published
  walls, whose inner faces are at x = ±49 mm, y = ±30 mm and z = -90.2431 mm (the driver's smooth
  walls, which it does not use, would be at ±50 mm).
- **Materials.** Spheres M1: E 1 GPa, ν 0.2, 2500 kg/m3. Steel: 210 GPa, ν 0.2, 7200 kg/m3.
  Restitution and friction: M1-M1 0.5 and 0.3, M1-steel 0.4 and 0.2, steel-steel 0.6 and 0.5. In
  this engine a pair has a value of its two materials: with `pair_rule="mean"` three materials give
  these pairs exactly, each set of bodies with walls of its own (`impact_bed.py`).
- **Laws.** Both have Hertz' spring and Mindlin's. Differences: here a dashpot acts across the
  normal too, in MercuryDPM none does; here a contact never pulls, there its damping may pull when
  the contact ends, and the damping ratio for a restitution follows from that (0.355 here, 0.280
  there for 0.4).
"""
MISSING = """
## Silo and drum

Neither was run.

- **Silo** (100 000 spheres of 4 mm, outflow in 5 s). The four files of initial positions are absent
  from the snapshot of the repository. The engine lacks a cone that ends at an orifice: its walls
  are half-spaces, and a mesh of triangles is not among them. It cannot remove bodies either.
- **Drum** (38 000 spheres of two materials, 2 rad/s, 5 s). Positions are there. The engine's planes
  stand still: a wall that turns or slides under its contacts is missing. So is a table of pairs:
  M1-M2 has restitution 0.45 and friction 0.2, and no rule for two materials gives friction 0.2 from
  0.3 and 0.4. It has 6.25 million steps of 8e-7 s.
"""
