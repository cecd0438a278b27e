"""A world on disk: everything that its next step depends on, in one HDF5 file."""

import json
import os
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np

from lithobrake.atomic import atomic_path
from lithobrake.dem.body import Body, Plane
from lithobrake.dem.material import Material
from lithobrake.dem.motion import write_matrices
from lithobrake.dem.neighbours import new_pairs
from lithobrake.dem.shape import Box, ConvexHull, Shape, Sphere

if TYPE_CHECKING:
    from lithobrake.dem.world import World

FORMAT_VERSION = 4
MOVING = ("force", "torque", "half_spin", "travel", "travel_listed", "dragged")


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


def save(world: "World", path: str | os.PathLike[str]) -> None:
    """Write a world to an HDF5 file."""
    import h5py

    engine = world._assembled()
    with atomic_path(path) as draft, h5py.File(draft, "w") as file:
        file.attrs["format"], file.attrs["format_version"] = "lithobrake world", FORMAT_VERSION
        file.attrs["shapes"] = json.dumps([_shape_text(shape) for shape in engine.shapes])
        file.attrs["materials"] = json.dumps([asdict(material) for material in engine.materials])
        file.attrs["options"] = json.dumps(world.options)
        file.attrs["given_time_step"] = json.dumps(world._given_time_step)
        file.attrs["time_step"] = json.dumps(world._time_step)
        file.attrs["time"], file.attrs["drag"], file.attrs["watched"] = world.time, world.drag, world._watched
        file.attrs["skin"] = engine.skin
        for name in ("gravity", "_lost", "_watch_record"):
            file[name.removeprefix("_")] = getattr(world, name)
        file["body/shape"], file["body/material"] = engine.bodies.shape, engine.bodies.material
        file["body/mass"] = world.mass
        file["body/inertia"] = np.array([body.inertia for body in world.bodies])
        for name in (*world._state, *MOVING):
            file[f"body/{name}"] = getattr(engine.bodies, name)
        file.attrs["meets_all"] = json.dumps([plane.meets is None for plane in world.planes])
        file["plane/point"] = np.array([plane.point for plane in world.planes]).reshape(-1, 3)
        for name in ("normal", "material", "meets"):
            file[f"plane/{name}"] = getattr(engine.planes, name)
        for name in engine.pairs._fields:
            file[f"pair/{name}"] = getattr(engine.pairs, name)


def load(path: str | os.PathLike[str]) -> "World":
    """Read a world from an HDF5 file."""
    import h5py

    from lithobrake.dem.world import World

    with h5py.File(path, "r") as file:
        if file.attrs.get("format") != "lithobrake world" or file.attrs["format_version"] != FORMAT_VERSION:
            found = f"{file.attrs.get('format', 'no world')!s}, version {file.attrs.get('format_version', 'none')}"
            raise ValueError(
                f"{path} holds {found}, this version reads lithobrake world, version {FORMAT_VERSION}: make it again"
            )
        data: dict[str, Any] = {}
        file.visititems(lambda name, item: data.update({name: item[()]}) if isinstance(item, h5py.Dataset) else None)
        attributes = dict(file.attrs)
    world = World(data["gravity"], json.loads(attributes["given_time_step"]), **json.loads(attributes["options"]))
    shapes = [_shape(text) for text in json.loads(attributes["shapes"])]
    materials = [Material(**values) for values in json.loads(attributes["materials"])]
    for shape, material, mass, inertia in zip(
        data["body/shape"], data["body/material"], data["body/mass"], data["body/inertia"], strict=True
    ):
        world.bodies.append(Body(shapes[shape], materials[material], float(mass), inertia))
    for k, point in enumerate(data["plane/point"]):
        everything = json.loads(attributes["meets_all"])[k]
        meets = None if everything else frozenset(np.flatnonzero(data["plane/meets"][k]).tolist())
        world.planes.append(Plane(point, data["plane/normal"][k], materials[data["plane/material"][k]], meets))
    world.time, world.drag = float(attributes["time"]), float(attributes["drag"])
    world._time_step, world._watched = json.loads(attributes["time_step"]), int(attributes["watched"])
    world._state = {name: data[f"body/{name}"].copy() for name in world._state}
    engine = world._assembled()
    # Assembling took a step of no duration, which may have rounded the orientations anew.
    engine.bodies.quaternion[:] = data["body/quaternion"]
    write_matrices(engine.bodies)
    world._lost[:], world._watch_record[:] = data["lost"], data["watch_record"]
    engine.skin = float(attributes["skin"])
    for name in MOVING:
        getattr(engine.bodies, name)[:] = data[f"body/{name}"]
    pairs = new_pairs(data["pair/first"], data["pair/second"])
    engine.gather(pairs._replace(**{name: data[f"pair/{name}"] for name in pairs._fields}))
    return world
