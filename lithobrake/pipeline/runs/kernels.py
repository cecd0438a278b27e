"""The engine's kernels, compiled before anything else: the first bed would seem to stand still, and workers would wait.

What is compiled follows from what is called, so a world of two grains is stepped as any other is.
"""

from lithobrake.pipeline.job import Job


def compile_kernels(job: Job) -> None:
    """Compile what beds and landings call, unless it lies on disk; workers that start afterwards find it there."""
    from lithobrake.dem import Box, Material, World

    job.progress(0, 1, "compiling kernels")
    rock = Material(density=2000.0, young_modulus=1e6, poisson_ratio=0.25, restitution=0.5, friction=0.5)
    world = World(gravity=(0.0, 0.0, -1.0))
    world.add_plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), rock)
    for height in (1.0, 3.0):
        world.add_body(Box((1.0, 1.0, 1.0)), rock, (0.0, 0.0, height))
    world.run(steps=1)
    # Settling asks for the largest step, the watch on a lander for spins.
    world.time_step = min(world.time_step, world.largest_step)
    world.energy()
    # Grains fall, and landers land, with contacts at steps of their own; a bed tells whether it rests by its forces.
    world.run_locally(world.time_step, 25.0)
    world.contacts()
    job.progress(1, 1, "compiling kernels")
