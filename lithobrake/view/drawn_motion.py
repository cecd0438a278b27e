"""The hulls of a motion as one mesh: drawn by PyVista, and as a VTKHDF file for ParaView."""

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from lithobrake.files.atomic import atomic_path
from lithobrake.geometry.attitude import rotation_matrices
from lithobrake.results.motions import with_images
from lithobrake.vocabulary.extra_library import extra_library

if TYPE_CHECKING:
    from lithobrake.results.motions import MovingBodies
    from lithobrake.vocabulary.array_types import Floats, Integers

# Colours of slow to fast: one that colour-blind people read, and that turns to grey in print.
COLOURS = "YlGnBu"
# What is slower than this part of the fastest is drawn as at rest: below it one colour serves.
SLOWEST = 1e-3
# Tiles of ground that repeats which are seen whole; over more of them the picture goes along with the lander.
MOST_TILES = 2.0
# Of a window [pixels].
SIZE = (1280, 800)
VERSION = (2, 1)
EMPTY = ("Vertices", "Lines", "Strips")


class DrawnMotion:
    """A window, shown or not, with the bodies of a motion; the lander is the last of them."""

    def __init__(
        self, bodies: "MovingBodies", *, size: tuple[int, int], off_screen: bool, words: str = ""
    ) -> None:  # fmt: skip
        """Set all up at the first frame; size of the picture in pixels; words: above the time."""
        if off_screen and not os.environ.get("DISPLAY"):
            # Without this VTK asks for a display first, and says so.
            os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")
        pv = extra_library("pyvista", "PyVista", "view")
        self.words, self.bodies = words, with_images(bodies)
        bodies = self.bodies
        self.speeds = body_speeds(bodies)
        faces, self.owner = triangles(bodies)
        self.mesh = pv.PolyData.from_regular_faces(placed(bodies, 0), faces)
        self.plotter = pv.Plotter(off_screen=off_screen, window_size=list(size))
        self.fastest = float(self.speeds.max()) or 1.0
        self.mesh.cell_data["speed"] = self._speeds_at(0)
        self.plotter.add_mesh(
            self.mesh, scalars="speed", cmap=COLOURS, clim=(SLOWEST * self.fastest, self.fastest), log_scale=True,
            scalar_bar_args={
                "title": "speed [m/s]", "fmt": "%.2g", "vertical": True, "position_x": 0.88, "position_y": 0.25,
                "height": 0.5, "color": "black",
            },
        )  # fmt: skip
        self.follows = self._is_far()
        self._look(0)
        self.clock = self.plotter.add_text(self._time(0), font_size=10, color="black")

    def _speeds_at(self, frame: int) -> np.ndarray:
        return np.maximum(self.speeds[frame, self.owner], SLOWEST * self.fastest)

    def _time(self, frame: int) -> str:
        clock = f"t = {self.bodies.time[frame] - self.bodies.time[0]:.3g} s"
        return f"{self.words}\n{clock}" if self.words else clock

    def _is_far(self) -> bool:
        """Whether the lander goes so far over ground that repeats that it would be a dot beside its whole way."""
        facts, ground = self.bodies.attributes, np.ptp(self.bodies.position[0, :, :2], axis=0)
        return facts.get("sides") == "periodic" and bool(ground.max() > MOST_TILES * max(facts["width"]))

    def _look(self, frame: int) -> None:
        """Look from aslant and above: at the middle of the bed and all of it, or along with a lander that goes far."""
        place = self.bodies.position
        if self.follows:
            width, middle = MOST_TILES * float(max(self.bodies.attributes["width"])), place[frame, -1]
        else:
            width = float(np.ptp(place[0, :, :2], axis=0).max())
            middle = np.append(place[0, :, :2].mean(axis=0), np.quantile(place[0, :, 2], 0.9))
        self.plotter.camera_position = [tuple(middle + width * np.array([0.8, -2.6, 1.5])), tuple(middle), (0, 0, 1)]

    def go_to(self, frame: int) -> None:
        """Move all bodies to where they were at a frame."""
        self.mesh.points = placed(self.bodies, frame)
        self.mesh.cell_data["speed"] = self._speeds_at(frame)
        self.clock.set_text("upper_left", self._time(frame))
        if self.follows:
            self._look(frame)

    def picture(self) -> np.ndarray:
        """Return what is seen now, shape [height, width, 3], 0 to 255."""
        self.plotter.render()
        return np.asarray(self.plotter.screenshot(return_img=True))


def placed(bodies: "MovingBodies", frame: int) -> "Floats":
    """Return all vertices at a frame [m], one hull after the other, shape [vertex_count, 3]."""
    turn, place = rotation_matrices(bodies.orientation[frame]), bodies.position[frame]
    return np.concatenate([hull @ turn[body].T + place[body] for body, hull in enumerate(bodies.vertices)])


def triangles(bodies: "MovingBodies") -> "tuple[Integers, Integers]":
    """Return all triangles, counted over all vertices as `placed` has them, [face_count, 3], and the body of each."""
    counts = [len(hull) for hull in bodies.vertices]
    start = np.concatenate([[0], np.cumsum(counts)[:-1]])
    faces = np.concatenate([hull + first for hull, first in zip(bodies.faces, start, strict=True)])
    return faces, np.repeat(np.arange(len(counts)), [len(hull) for hull in bodies.faces])


def body_speeds(bodies: "MovingBodies") -> "Floats":
    """Return the mean speed [m/s] of each body since the frame before, of the first frame that of the second.

    Shape [frame_count, body_count]; 0 where there is one frame.
    """
    if len(bodies.time) < 2:
        return np.zeros(bodies.position.shape[:2])
    way = np.linalg.norm(np.diff(bodies.position, axis=0), axis=2)
    passed = np.diff(bodies.time)[:, None]
    speed = np.divide(way, passed, out=np.zeros_like(way), where=passed > 0.0)
    return np.concatenate([speed[:1], speed])


def show(bodies: "MovingBodies") -> None:
    """Open a window on the motion, and return when it is closed. Raises ImportError without PyVista."""
    drawn = DrawnMotion(bodies, size=SIZE, off_screen=False)
    last = len(bodies.time) - 1
    if last > 0:
        drawn.plotter.add_slider_widget(
            lambda value: drawn.go_to(round(value)), [0, last], value=0, title="frame", fmt="%.0f", style="modern"
        )
    drawn.plotter.show(title="lithobrake")


def write_vtkhdf(bodies: "MovingBodies", path: str | Path) -> None:
    """Write bodies and their motion: points [m], and for each triangle the number and the speed [m/s] of its body.

    Where forces were kept also the size of the sum of contact forces on it [N].

    The lander of a landing is the body with the last number. On ground that repeats grains stand there with their
    images around its way.
    """
    import h5py

    bodies = with_images(bodies)
    faces, owner = triangles(bodies)
    frames, points = len(bodies.time), sum(len(hull) for hull in bodies.vertices)
    with atomic_path(path) as draft, h5py.File(draft, "w") as file:
        root = file.create_group("VTKHDF")
        root.attrs["Version"] = VERSION
        root.attrs.create("Type", b"PolyData", dtype="S8")
        root["NumberOfPoints"] = np.full(frames, points)
        _write_packed(root, "Points", np.concatenate([placed(bodies, frame) for frame in range(frames)]))
        _write_triangles(root, faces, frames)
        data = root.create_group("CellData")
        data["body"] = owner.astype(np.int32)
        _write_packed(data, "speed", body_speeds(bodies)[:, owner].ravel())
        if bodies.force is not None:
            _write_packed(data, "force", bodies.force[:, owner].ravel())
        _write_steps(root, bodies.time, points, len(faces))


def _write_packed(group: Any, name: str, values: np.ndarray) -> None:
    """Write single precision, compressed: most bodies rest, and a file is a quarter as large."""
    group.create_dataset(name, data=values.astype(np.float32), compression="gzip", shuffle=True)


def _write_triangles(root: Any, faces: np.ndarray, frames: int) -> None:
    """Write the triangles, which every instant points at, and the kinds of cells that there are none of."""
    for name in EMPTY:
        group = root.create_group(name)
        for count in ("NumberOfCells", "NumberOfConnectivityIds"):
            group[count] = np.zeros(frames, np.int64)
        group["Connectivity"], group["Offsets"] = np.zeros(0, np.int64), np.zeros(frames, np.int64)
    group = root.create_group("Polygons")
    group["NumberOfCells"] = np.full(frames, len(faces))
    group["NumberOfConnectivityIds"] = np.full(frames, faces.size)
    group["Connectivity"], group["Offsets"] = faces.ravel().astype(np.int64), np.arange(len(faces) + 1) * 3


def _write_steps(root: Any, time: np.ndarray, points: int, cells: int) -> None:
    """Write where the data of each instant begin."""
    frames = len(time)
    steps, each = root.create_group("Steps"), np.arange(frames)
    steps.attrs["NSteps"] = frames
    steps["Values"] = time
    steps["PartOffsets"], steps["NumberOfParts"] = each, np.ones(frames, np.int64)
    steps["PointOffsets"] = each * points
    steps["CellOffsets"] = np.zeros((frames, 4), np.int64)
    steps["ConnectivityIdOffsets"] = np.zeros((frames, 4), np.int64)
    offsets = steps.create_group("CellDataOffsets")
    for name in root["CellData"]:
        offsets[name] = np.zeros(frames, np.int64) if name == "body" else each * cells
