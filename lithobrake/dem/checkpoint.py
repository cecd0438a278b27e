"""A world on disk: everything that its next step depends on, in one HDF5 file."""

import json
import os
from dataclasses import asdict
from itertools import pairwise
from typing import Any

import numpy as np

from lithobrake.dem.bodies.arrays import Period, Step
from lithobrake.dem.bodies.material import Material
from lithobrake.dem.bodies.rigid_body import Part, Plane, RigidBody
from lithobrake.dem.bodies.shape import Box, ConvexHull, Shape, Sphere
from lithobrake.dem.law.material_pair import contact_options
from lithobrake.dem.stepping.assembly import material_numbers, materials_of, part_starts, parts_of
from lithobrake.dem.stepping.engine import MOVING, Engine
from lithobrake.dem.world_state import WorldState
from lithobrake.files.atomic import atomic_path

FORMAT_VERSION = 7


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


def write_checkpoint(path: str | os.PathLike[str], state: WorldState, step: Step, clock: dict[str, Any]) -> None:
    """Write a state, the gravity and drag of its steps, and a clock of plain numbers to an HDF5 file."""
    import h5py

    engine = state.stepping_together(step)
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
        file["gravity"], file["lost"], file["watch_record"] = step.gravity, state.lost, state.watch_record
        file["part/shape"] = np.array([number[id(part.shape)] for part in parts], dtype=np.int64)
        file["part/material"] = material_numbers(parts, materials)
        file["body/part_start"] = part_starts(state.bodies)
        file["body/is_plain"] = np.array([body.is_plain for body in state.bodies])
        file["body/centre"] = np.array([body.centre_of_mass for body in state.bodies])
        file["body/mass"] = np.array([body.mass for body in state.bodies])
        file["body/inertia"] = np.array([body.inertia for body in state.bodies])
        for name in MOVING:
            file[f"body/{name}"] = getattr(engine.bodies, name)
        file.attrs["meets_all"] = json.dumps([plane.meets is None for plane in state.planes])
        file["plane/point"] = np.array([plane.point for plane in state.planes]).reshape(-1, 3)
        for name in ("normal", "material", "meets"):
            file[f"plane/{name}"] = getattr(engine.planes, name)
        for name in engine.pairs._fields:
            file[f"pair/{name}"] = getattr(engine.pairs, name)


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
    step = Step(0.0, float(attributes["drag"]), tuple(data["gravity"].tolist()), damping_with_reduced_mass)
    _restore(state.stepping_together(step), data, float(attributes["skin"]))
    state.lost[:] = data["lost"]
    return state, step, json.loads(attributes["clock"])


def _add_members(state: WorldState, data: dict[str, Any], attributes: dict[str, Any]) -> None:
    """Add the bodies and planes to an empty state."""
    shapes = [_shape(text) for text in json.loads(attributes["shapes"])]
    materials = [Material(**values) for values in json.loads(attributes["materials"])]
    parts = [
        Part(shapes[shape], materials[material])
        for shape, material in zip(data["part/shape"], data["part/material"], strict=True)
    ]
    for k, (begin, end) in enumerate(pairwise(data["body/part_start"].tolist())):
        (own, *others), mass, inertia = parts[begin:end], float(data["body/mass"][k]), data["body/inertia"][k]
        is_plain = bool(data["body/is_plain"][k])
        uniform = is_plain and np.array_equal(inertia, own.shape.inertia_per_density * (mass / own.shape.volume))
        centre = None if is_plain else data["body/centre"][k]
        state.bodies.append(RigidBody(own.shape, own.material, mass, inertia, uniform, tuple(others), centre))
    for k, everything in enumerate(json.loads(attributes["meets_all"])):
        meets = None if everything else frozenset(np.flatnonzero(data["plane/meets"][k]).tolist())
        material = materials[data["plane/material"][k]]
        state.planes.append(Plane(data["plane/point"][k], data["plane/normal"][k], material, meets))


def _restore(engine: Engine, data: dict[str, Any], skin: float) -> None:
    """Give an engine back what it held: assembling took a step of no duration, which may have changed a last bit."""
    pairs = engine.pairs._replace(**{name: data[f"pair/{name}"] for name in engine.pairs._fields})
    engine.restore({name: data[f"body/{name}"] for name in MOVING}, pairs, skin)
