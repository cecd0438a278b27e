"""The bodies of a lander in a world: its main body, and those that hang on it by hinges, seen as one lander."""

import numpy as np

from lithobrake.dem import BodyMotion, World, rotation_matrices
from lithobrake.touchdown.lander import Lander, lowest_of
from lithobrake.vocabulary.array_types import Floats, Vector


def add_lander(
    world: World, lander: Lander, place: Floats, velocity: Floats, orientation: tuple[float, ...], spin: Vector
) -> int:  # fmt: skip
    """Add a lander that moves as one rigid body; return the number of its main body, which its hinged parts follow.

    place [m] and velocity [m/s] are those of its centre of mass, spin [rad/s] along the world's axes.
    """
    turn = np.array(orientation, dtype=np.float64)
    rotation = rotation_matrices((turn / np.linalg.norm(turn))[None])[0] if lander.hinged else np.eye(3)

    def motion_at(way: Floats) -> tuple[Vector, Vector]:
        arm = rotation @ way
        (x, y, z), (u, v, w) = (place + arm).tolist(), (velocity + np.cross(spin, arm)).tolist()
        return (x, y, z), (u, v, w)

    if not lander.hinged:
        return world.add_body(
            lander.shape, lander.own_material, tuple(place), tuple(velocity), orientation, spin, mass=lander.mass,
            inertia=lander.inertia, parts=lander.parts, centre_of_mass=lander.centre_of_mass,
        )  # fmt: skip
    centre, main = lander.body.centre_of_mass, lander.main_body
    number = world.add_body(
        main.shape, main.material, *motion_at(main.centre_of_mass - centre), orientation, spin, mass=main.mass,
        inertia=main.inertia, parts=main.others, centre_of_mass=main.centre_of_mass,
    )  # fmt: skip
    for part in lander.hinged:
        at, moving = motion_at(part.shape.centroid - centre)
        part_number = world.add_body(part.shape, part.material, at, moving, orientation, spin)
        hinge = part.hinge
        pin = place + rotation @ (np.array(hinge.point) - centre)
        world.join(number, part_number, pin, hinge.stiffness, damping_ratio=hinge.damping_ratio, limit=hinge.limit)
    return number


class LanderBodies:
    """The bodies that `add_lander` has put into a world."""

    def __init__(self, world: World, lander: Lander, number: int) -> None:
        self.world, self.lander, self.number = world, lander, number
        self.numbers = range(number, number + 1 + len(lander.hinged))

    def motion(self) -> BodyMotion:
        """Return how the lander moves: its common centre of mass, the attitude of its main body, and the spin with
        which it would have its angular momentum if it were rigid.
        """
        if not self.lander.hinged:
            return self.world.motion_of(self.number)
        motions = [self.world.motion_of(number) for number in self.numbers]
        mass = np.array([one.mass for one in motions])
        position, velocity = (
            mass @ np.array([getattr(one, name) for one in motions]) / mass.sum() for name in ("position", "velocity")
        )
        momentum = np.zeros(3)
        for one in motions:
            momentum += one.angular_momentum + one.mass * np.cross(one.position - position, one.velocity - velocity)
        orientation = motions[0].orientation
        rotation = rotation_matrices(orientation[None])[0]
        spin = rotation @ np.linalg.solve(self.lander.body.inertia, rotation.T @ momentum)
        return BodyMotion(position, velocity, orientation, momentum, spin, self.lander.mass)

    def part_motions(self) -> list[BodyMotion]:
        """Return how the parts on hinges move."""
        return [self.world.motion_of(number) for number in self.numbers[1:]]

    def lowest(self, motion: BodyMotion) -> float:
        """Return the height [m] of the lowest point; motion: that of the lander."""
        if not self.lander.hinged:
            return self.lander.lowest(motion.position, rotation_matrices(motion.orientation[None])[0])
        heights = []
        for number in self.numbers:
            body, one = self.world.bodies[number], self.world.motion_of(number)
            rotation = rotation_matrices(one.orientation[None])[0]
            shapes = [body.shape, *(part.shape for part in body.others)]
            low = min(lowest_of(shape, body.centre_of_mass, rotation) for shape in shapes)
            heights.append(float(one.position[2]) + low)
        return min(heights)

    def frame(self, motion: BodyMotion) -> dict[str, Floats]:
        """Return where all bodies are, and the sizes of the contact forces on them [N], the lander last and as one.

        Its hinged parts are shown as if they were not bent.
        """
        world, count = self.world, self.number
        position, orientation, force = world.position, world.orientation, world.contact_force
        if self.lander.hinged:
            position = np.concatenate([position[:count], motion.position[None]])
            orientation = orientation[: count + 1]
            force = np.concatenate([force[:count], force[count:].sum(axis=0)[None]])
        return {"position": position, "orientation": orientation, "force": np.linalg.norm(force, axis=1)}
