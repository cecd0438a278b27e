"""What is in a world and how it moves, with the engine for it, and a world on disk."""

import json
import os
from dataclasses import asdict
from itertools import pairwise
from typing import Any

import numpy as np

from lithobrake.dem.bodies.arrays import LOSSES, Pairs, Period, Step
from lithobrake.dem.bodies.joint import Joint, leaders_of
from lithobrake.dem.bodies.orientation import write_spins
from lithobrake.dem.bodies.rigid_body import Part, Plane, RigidBody
from lithobrake.dem.bodies.shape import Box, ConvexHull, Shape, Sphere
from lithobrake.dem.law.restitution import contact_options
from lithobrake.dem.local_stepping.joints import energy_of_joints, joints_of
from lithobrake.dem.local_stepping.local_engine import LocalEngine, Setting
from lithobrake.dem.stepping.engine import (
    MOVING,
    Engine,
    inertias,
    inverses,
    material_numbers,
    materials_of,
    part_starts,
    parts_of,
    rotation_matrices,
)
from lithobrake.dem.stepping.neighbours import no_pairs
from lithobrake.dem.stepping.time_loop import new_record
from lithobrake.files.atomic import atomic_path
from lithobrake.vocabulary.array_types import Floats
from lithobrake.vocabulary.material_properties import Material

NOTHING_WATCHED = -1
FORMAT_VERSION = 9


class WorldState:
    """Everything that the next step of a world depends on, but gravity, rotation, drag and time step."""

    def __init__(self, options: dict[str, str], period: Period) -> None:
        self.options, self.period = options, period
        self.bodies: list[RigidBody] = []
        self.planes: list[Plane] = []
        self.joints: list[Joint] = []
        # Position [m], velocity [m/s], quaternion (body to world) and angular momentum [kg m2/s], [body_count, 3 or 4].
        self.motion: dict[str, Floats] = {
            "position": np.zeros((0, 3)), "velocity": np.zeros((0, 3)), "quaternion": np.zeros((0, 4)),
            "angular_momentum": np.zeros((0, 3)),
        }  # fmt: skip
        self.pairs: Pairs = no_pairs()
        self.lost = np.zeros(LOSSES)  # J, see Pairs
        self.watched, self.watch_record = NOTHING_WATCHED, new_record()  # of the steps that all contacts share
        self.thread_count = 1
        self.engine: Engine | None = None
        self.reader: Engine | None = None  # in place of an engine, as long as there is none
        self.local: LocalEngine | None = None
        self._mass: Floats = np.zeros(0)
        self._inverse_inertia: Floats = np.zeros((0, 3, 3))

    def add_bodies(self, bodies: list[RigidBody], motion: dict[str, Floats]) -> int:
        """Add bodies in their motion, by the names above, [count, 3 or 4]; return the number of the last."""
        self.disassemble()
        self.motion = {name: np.concatenate([array, motion[name]]) for name, array in self.motion.items()}
        self.bodies += bodies
        return len(self.bodies) - 1

    @property
    def mass(self) -> Floats:
        """Masses [kg], shape [body_count]."""
        # Bodies are added and never changed or removed, so their number tells whether the masses are those at hand.
        if len(self._mass) != len(self.bodies):
            self._mass = np.array([body.mass for body in self.bodies])
        return self._mass

    @property
    def inverse_inertia(self) -> Floats:
        """Inverses of the inertias [1/(kg m2)], shape [body_count, 3, 3], body frame."""
        if len(self._inverse_inertia) != len(self.bodies):
            self._inverse_inertia = inverses(inertias(self.bodies))
        return self._inverse_inertia

    def read(self, step: Step) -> Engine:
        """Return an engine with the forces of the motion at hand, to be read: nothing that comes later depends on it.

        Where nothing has been stepped yet, one on copies takes a step of no duration, with the accelerations of `step`.
        """
        if self.engine is not None:
            return self.engine
        if self.reader is None:
            motion = {name: array.copy() for name, array in self.motion.items()}
            pairs = self.pairs._replace(**{name: array.copy() for name, array in self.pairs._asdict().items()})
            self.reader = self._ready(motion, pairs, self.lost.copy(), step)
        return self.reader

    def stepping_together(self, step: Step) -> Engine:
        """Return the engine, all contacts at the same steps again; a new one has taken a step of no duration."""
        self._step_together()
        if self.engine is None:
            self.engine = self._ready(self.motion, self.pairs, self.lost, step)
        return self.engine

    def _ready(self, motion: dict[str, Floats], pairs: Pairs, lost: Floats, step: Step) -> Engine:
        engine = self.new_engine(motion, pairs, lost)
        engine.list_neighbours()
        engine.advance(1, step._replace(time_step=0.0), NOTHING_WATCHED)
        return engine

    def new_engine(self, motion: dict[str, Floats], pairs: Pairs, lost: Floats) -> Engine:
        """Return an engine on these arrays that has taken no step."""
        return Engine(
            self.bodies, self.planes, self.options, motion, pairs, lost, self.watch_record, self.thread_count,
            self.period, leaders_of(len(self.bodies), self.joints),
        )  # fmt: skip

    def stepping_locally(self, setting: Setting, time: float) -> LocalEngine:
        """Return the engine that moves each contact at its own steps, from an instant [s] on."""
        if self.local is None or self.local.setting != setting or self.local.time != time:
            self._step_together()
            self.engine = self.engine or self.new_engine(self.motion, self.pairs, self.lost)
            self.local = LocalEngine(self.engine, self.bodies, self.joints, setting, time)
            # It finds neighbours and contacts by itself, at its own reach, before anybody is held.
            self.local.run(0.0)
        return self.local

    def _step_together(self) -> None:
        self.reader = None
        if self.local is not None:
            self.local.give_back()
            self.local = None

    def disassemble(self) -> None:
        """Make ready for a change of what is in the world; contacts keep their history."""
        self._step_together()
        if self.engine is not None:
            self.engine.book()
            self.pairs = self.engine.pairs
        self.motion = {name: array.copy() for name, array in self.motion.items()}
        self.engine = None

    def joint_energy(self, engine: Engine) -> float:
        """Return the energy [J] in the springs of all joints, with the bodies as an engine has them."""
        if not self.joints:
            return 0.0
        joints = joints_of(self.joints, self.bodies, 1.0, 0.0) if self.local is None else self.local.joints
        return float(energy_of_joints(engine.bodies, joints))

    def use_threads(self, thread_count: int) -> None:
        self.thread_count = thread_count
        self._step_together()
        if self.engine is not None:
            self.engine.use_threads(thread_count)

    def spin(self, some: slice) -> Floats:
        """Return the angular velocities of some bodies [rad/s], shape [count, 3], world frame."""
        momentum, rotation = self.motion["angular_momentum"][some], rotation_matrices(self.motion["quaternion"][some])
        spin = np.zeros_like(momentum)
        write_spins(rotation, momentum, self.inverse_inertia[some], spin)
        return spin


def _shape_text(shape: Shape) -> str:
    """Describe a shape by what it was made from; floats written by repr come back bit for bit."""
    if isinstance(shape, Sphere):
        return json.dumps({"sphere": [shape.radius, shape.centroid.tolist()]})
    if isinstance(shape, Box):
        return json.dumps({"box": shape.lengths})
    assert isinstance(shape, ConvexHull)
    return json.dumps({"hull": shape.given.tolist()})


def _shape(text: str) -> Shape:
    kind, value = next(iter(json.loads(text).items()))
    return Sphere(*value) if kind == "sphere" else {"box": Box, "hull": ConvexHull}[kind](value)


def _joint_values(joint: Joint) -> dict[str, Any]:
    """Return what a joint is made of; floats written by repr come back bit for bit."""
    values = {name: getattr(joint, name) for name in Joint.__dataclass_fields__}
    return {name: value.tolist() if isinstance(value, np.ndarray) else value for name, value in values.items()}


def write_checkpoint(path: str | os.PathLike[str], state: WorldState, step: Step, clock: dict[str, Any]) -> None:
    """Write a state, gravity, rotation and drag of its steps, and a clock of plain numbers to an HDF5 file."""
    import h5py

    local = state.local
    engine = state.stepping_together(step) if local is None else local.engine
    parts = parts_of(state.bodies)
    shapes, materials = list({id(part.shape): part.shape for part in parts}.values()), materials_of(parts, state.planes)
    number = {id(shape): k for k, shape in enumerate(shapes)}
    with atomic_path(path) as draft, h5py.File(draft, "w") as file:
        file.attrs["format"], file.attrs["format_version"] = "lithobrake world", FORMAT_VERSION
        file.attrs["shapes"] = json.dumps([_shape_text(shape) for shape in shapes])
        file.attrs["materials"] = json.dumps([asdict(material) for material in materials])
        file.attrs["options"], file.attrs["clock"] = json.dumps(state.options), json.dumps(clock)
        file.attrs["drag"], file.attrs["watched"], file.attrs["skin"] = step.drag, state.watched, engine.skin
        file.attrs["period"] = state.period
        file["gravity"], file["rotation"] = step.gravity, step.rotation
        file["lost"], file["watch_record"] = state.lost, state.watch_record
        file["part/shape"] = np.array([number[id(part.shape)] for part in parts], dtype=np.int64)
        file["part/material"] = material_numbers(parts, materials)
        file["body/part_start"] = part_starts(state.bodies)
        file["body/is_plain"] = np.array([body.is_plain for body in state.bodies])
        file["body/centre"] = np.array([body.centre_of_mass for body in state.bodies])
        file["body/mass"] = np.array([body.mass for body in state.bodies])
        file["body/inertia"] = np.array([body.inertia for body in state.bodies])
        for name in MOVING:
            file[f"body/{name}"] = getattr(engine.bodies, name)
        file.attrs["joints"] = json.dumps([_joint_values(joint) for joint in state.joints])
        file.attrs["meets_all"] = json.dumps([plane.meets is None for plane in state.planes])
        file["plane/point"] = np.array([plane.point for plane in state.planes]).reshape(-1, 3)
        for name in ("normal", "material", "meets"):
            file[f"plane/{name}"] = getattr(engine.planes, name)
        for name in engine.pairs._fields:
            file[f"pair/{name}"] = getattr(engine.pairs, name)
        if local is not None:
            file.attrs["steps_per_contact"], file.attrs["time"] = local.setting.steps_per_contact, local.time
            for name, array in local.state.items():
                file[f"local/{name}"] = array


def read_checkpoint(path: str | os.PathLike[str]) -> tuple[WorldState, Step, dict[str, Any]]:
    """Read what `write_checkpoint` wrote. Raises ValueError where the file is not of this format."""
    import h5py

    with h5py.File(path, "r") as file:
        if file.attrs.get("format") != "lithobrake world" or file.attrs["format_version"] != FORMAT_VERSION:
            found = f"{file.attrs.get('format', 'no world')!s}, version {file.attrs.get('format_version', 'none')}"
            raise ValueError(
                f"{path} holds {found}, this version reads lithobrake world, version {FORMAT_VERSION}: make it again"
            )
        data: dict[str, Any] = {}
        file.visititems(lambda name, item: data.update({name: item[()]}) if isinstance(item, h5py.Dataset) else None)
        attributes = dict(file.attrs)
    state = WorldState(contact_options(**json.loads(attributes["options"])), Period(*attributes["period"].tolist()))
    _add_members(state, data, attributes)
    state.watched, state.watch_record = int(attributes["watched"]), data["watch_record"]
    state.motion = {name: data[f"body/{name}"].copy() for name in state.motion}
    damping_with_reduced_mass = state.options["damping_mass"] == "paper"
    gravity, rotation = tuple(data["gravity"].tolist()), tuple(data["rotation"].tolist())
    step = Step(0.0, float(attributes["drag"]), gravity, rotation, damping_with_reduced_mass)
    if "steps_per_contact" in attributes:
        _resume(state, step, data, attributes)
    else:
        _restore(state.stepping_together(step), data, float(attributes["skin"]))
    state.lost[:] = data["lost"]
    return state, step, json.loads(attributes["clock"])


def _add_members(state: WorldState, data: dict[str, Any], attributes: dict[str, Any]) -> None:
    shapes = [_shape(text) for text in json.loads(attributes["shapes"])]
    materials = [Material(**values) for values in json.loads(attributes["materials"])]
    parts = [
        Part(shapes[shape], materials[material])
        for shape, material in zip(data["part/shape"], data["part/material"], strict=True)
    ]
    for k, (begin, end) in enumerate(pairwise(data["body/part_start"].tolist())):
        (own, *others), mass, inertia = parts[begin:end], float(data["body/mass"][k]), data["body/inertia"][k]
        is_plain = bool(data["body/is_plain"][k])
        # Not stored: the inertia of a uniform body is, to the last bit, the one that `new_body` computes.
        uniform = is_plain and np.array_equal(inertia, own.shape.inertia_per_density * (mass / own.shape.volume))
        centre = None if is_plain else data["body/centre"][k]
        state.bodies.append(RigidBody(own.shape, own.material, mass, inertia, uniform, tuple(others), centre))
    for values in json.loads(attributes["joints"]):
        arrays = {name: np.array(value) for name, value in values.items() if isinstance(value, list)}
        state.joints.append(Joint(**{**values, **arrays}))
    for k, everything in enumerate(json.loads(attributes["meets_all"])):
        meets = None if everything else frozenset(np.flatnonzero(data["plane/meets"][k]).tolist())
        material = materials[data["plane/material"][k]]
        state.planes.append(Plane(data["plane/point"][k], data["plane/normal"][k], material, meets))


def _resume(state: WorldState, step: Step, data: dict[str, Any], attributes: dict[str, Any]) -> None:
    """Go on with contacts at steps of their own, as they were planned."""
    engine = state.engine = state.new_engine(state.motion, no_pairs(), state.lost)
    engine.restore({name: data[f"body/{name}"] for name in MOVING}, no_pairs(), float(attributes["skin"]))
    pairs = no_pairs()._replace(**{name: data[f"pair/{name}"] for name in engine.pairs._fields})
    setting = Setting(step, float(attributes["steps_per_contact"]), state.watched)
    kept = {name.removeprefix("local/"): array for name, array in data.items() if name.startswith("local/")}
    state.local = LocalEngine.resumed(engine, setting, float(attributes["time"]), pairs, kept)


def _restore(engine: Engine, data: dict[str, Any], skin: float) -> None:
    """Give an engine back what it held: assembling took a step of no duration, which may have changed a last bit."""
    pairs = engine.pairs._replace(**{name: data[f"pair/{name}"] for name in engine.pairs._fields})
    engine.restore({name: data[f"body/{name}"] for name in MOVING}, pairs, skin)
