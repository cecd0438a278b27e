"""A world on disk: everything that its next step depends on, in one HDF5 file."""

import json
import os
from dataclasses import asdict
from typing import Any

import numpy as np

from lithobrake.dem.bodies.arrays import Period, Step
from lithobrake.dem.bodies.material import Material
from lithobrake.dem.bodies.rigid_body import Plane, RigidBody
from lithobrake.dem.bodies.shape import Box, ConvexHull, Shape, Sphere
from lithobrake.dem.stepping.assembly import material_numbers, materials_of, shape_numbers, shapes_of
from lithobrake.dem.stepping.engine import MOVING, Engine
from lithobrake.dem.world_state import WorldState
from lithobrake.files.atomic import atomic_path

FORMAT_VERSION = 6


def _shape_text(shape: Shape) -> str:
    """Describe a shape by what it was made from; floats written by repr come back bit for bit."""
    if isinstance(shape, Sphere):
        return json.dumps({"sphere": shape.radius})
    if isinstance(shape, Box):
        return json.dumps({"box": shape.lengths})
    assert isinstance(shape, ConvexHull)
    return json.dumps({"hull": shape.given.tolist()})


def _shape(text: str) -> Shape:
    kind, value = next(iter(json.loads(text).items()))
    return {"sphere": Sphere, "box": Box, "hull": ConvexHull}[kind](value)


def write_checkpoint(path: str | os.PathLike[str], state: WorldState, step: Step, clock: dict[str, Any]) -> None:
    """Write a state, the gravity and drag of its steps, and a clock of plain numbers to an HDF5 file."""
    import h5py

    engine = state.stepping_together(step)
    shapes, materials = shapes_of(state.bodies), materials_of(state.bodies, state.planes)
    with atomic_path(path) as draft, h5py.File(draft, "w") as file:
        file.attrs["format"], file.attrs["format_version"] = "lithobrake world", FORMAT_VERSION
        file.attrs["shapes"] = json.dumps([_shape_text(shape) for shape in shapes])
        file.attrs["materials"] = json.dumps([asdict(material) for material in materials])
        file.attrs["options"], file.attrs["clock"] = json.dumps(state.options), json.dumps(clock)
        file.attrs["drag"], file.attrs["watched"], file.attrs["skin"] = step.drag, state.watched, engine.skin
        file.attrs["period"] = state.period
        file["gravity"], file["lost"], file["watch_record"] = step.gravity, state.lost, state.watch_record
        file["body/shape"] = shape_numbers(state.bodies, shapes)
        file["body/material"] = material_numbers(state.bodies, materials)
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
    state = WorldState(json.loads(attributes["options"]), Period(*attributes["period"].tolist()))
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
    for shape, material, mass, inertia in zip(
        data["body/shape"], data["body/material"], data["body/mass"], data["body/inertia"], strict=True
    ):
        uniform = np.array_equal(inertia, shapes[shape].inertia_per_density * (float(mass) / shapes[shape].volume))
        state.bodies.append(RigidBody(shapes[shape], materials[material], float(mass), inertia, uniform))
    for k, everything in enumerate(json.loads(attributes["meets_all"])):
        meets = None if everything else frozenset(np.flatnonzero(data["plane/meets"][k]).tolist())
        material = materials[data["plane/material"][k]]
        state.planes.append(Plane(data["plane/point"][k], data["plane/normal"][k], material, meets))


def _restore(engine: Engine, data: dict[str, Any], skin: float) -> None:
    """Give an engine back what it held: assembling took a step of no duration, which may have changed a last bit."""
    pairs = engine.pairs._replace(**{name: data[f"pair/{name}"] for name in engine.pairs._fields})
    engine.restore({name: data[f"body/{name}"] for name in MOVING}, pairs, skin)
