"""Shapes: reading, refusals, mass properties, places on the surface, and what is seen of the sky from there."""

import math
import struct
import warnings

import numpy as np
import pytest

from lithobrake.smallbody import Screen, Shape, circle_places, day_directions, didymos, dimorphos, seen_from
from lithobrake.smallbody.built_in_bodies import DIDYMOS_POLE, top_shape
from lithobrake.smallbody.sky import DIRECTIONS, PLACES

from .meshes import CUBE_FACES, cube_vertices, sphere_mesh


def write_obj(path, vertices, faces):
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in vertices.tolist()]
    lines += ["f " + " ".join(str(corner + 1) for corner in face) for face in faces.tolist()]
    path.write_text("# a comment\n" + "\n".join(lines) + "\n")
    return path


def test_cube_mass_properties():
    shape = Shape(cube_vertices(2.0) + np.array([5.0, -3.0, 1.0]), CUBE_FACES)
    assert shape.volume == pytest.approx(8.0, rel=1e-14)
    assert shape.centroid == pytest.approx([5.0, -3.0, 1.0], rel=1e-14)
    # Of a cube: mass edge**2 / 6.
    assert np.allclose(shape.inertia_per_density, np.eye(3) * 8.0 * 4.0 / 6.0, rtol=1e-13, atol=1e-12)


def test_obj_with_units_polygons_and_negative_indices(tmp_path):
    path = tmp_path / "box.obj"
    corners = "\n".join(f"v {x} {y} {z}" for x, y, z in cube_vertices(2.0))
    path.write_text(
        f"o box\n{corners}\nvn 0 0 1\n"
        "f 1//1 4//1 3//1 2//1\nf 5/1 6/2 7/3 8/4\nf -8 -7 -3 -4\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"
    )
    shape = Shape.read(path, unit="km")
    assert (shape.volume, len(shape.faces)) == (pytest.approx(8e9), 12)


@pytest.mark.parametrize("binary", [True, False])
def test_stl_merges_corners(tmp_path, binary):
    corners = cube_vertices(2.0)[CUBE_FACES]
    path = tmp_path / "cube.stl"
    if binary:
        facets = b"".join(struct.pack("<12fH", *np.zeros(3), *c.reshape(-1), 0) for c in corners)
        path.write_bytes(b"solid misleading".ljust(80) + struct.pack("<I", len(corners)) + facets)
    else:
        loops = ["facet normal 0 0 0 outer loop\n" + "\n".join(f"vertex {x} {y} {z}" for x, y, z in c) for c in corners]
        path.write_text("solid cube\n" + "\nendloop endfacet\n".join(loops) + "\nendsolid\n")
    shape = Shape.read(path)
    assert (len(shape.vertices), shape.volume) == (8, pytest.approx(8.0))


@pytest.mark.parametrize("numbered", [True, False])
@pytest.mark.parametrize("together", [True, False])
def test_plate_models(tmp_path, numbered, together):
    def table(rows):
        return [(f"{i} " if numbered else "") + " ".join(map(str, row)) for i, row in enumerate(rows.tolist(), 1)]

    vertices, plates = table(cube_vertices(2.0)), table(CUBE_FACES + 1)
    lines = ["8 12", *vertices, *plates] if together else ["8", *vertices, "12", *plates]
    path = tmp_path / "cube.tab"
    path.write_text("\n".join(lines) + "\n")
    assert Shape.read(path, unit="km").volume == pytest.approx(8e9)
    path.write_text("\n".join(lines[:-1]) + "\n")
    with pytest.raises(ValueError, match="lines do not fit"):
        Shape.read(path)
    for text, said in (("name of a body\n", "not a plate model"), ("8\n", "it ends after 1 lines; give the number")):
        path.write_text(text)
        with pytest.raises(ValueError, match=said):
            Shape.read(path)


@pytest.mark.parametrize(("change", "said"), [
    (lambda v, f: (v, f[:-1]), "open"),
    (lambda v, f: (v, np.concatenate([f, [[0, 1, 6]]])), "edges belong to"),
    (lambda v, f: (v, np.concatenate([f, f[:1], f[:1, ::-1]])), "non-manifold"),
    (lambda v, f: (v, np.concatenate([f, [[0, 0, 1]]])), "degenerate"),
    (lambda v, f: (np.concatenate([v, v + 5.0]), np.concatenate([f, f + 8])), "separate"),
    (lambda v, f: (v, f + 1), "names vertices"),
    (lambda v, f: (np.where(v == v[6], np.nan, v), f), "finite"),
    (lambda v, f: (v, f[:3]), "facets"),
    (lambda v, f: (v, f.astype(float)), "integers"),
])  # fmt: skip
def test_refusals_name_the_fault(change, said):
    with pytest.raises(ValueError, match=said):
        Shape(*change(cube_vertices(), CUBE_FACES))


def test_a_pinched_vertex_is_refused():
    # A sphere whose poles are one vertex: every edge has two facets, yet the surface touches itself.
    directions, faces = sphere_mesh(3)
    north, south = int(np.argmax(directions[:, 2])), int(np.argmin(directions[:, 2]))
    merged = np.where(faces == south, north, faces)
    with pytest.raises(ValueError, match="single vertex"):
        Shape(directions * [1.0, 1.0, 0.5], merged)


def test_inverted_orientation_is_mended_and_said():
    with pytest.warns(UserWarning, match="all facets faced inwards"):
        shape = Shape(cube_vertices(), CUBE_FACES[:, ::-1])
    assert shape.volume == pytest.approx(1.0)
    mixed = CUBE_FACES.copy()
    mixed[[3, 7]] = mixed[[3, 7], ::-1]
    with pytest.warns(UserWarning, match="2 of 12 facets faced inwards"):
        assert Shape(cube_vertices(), mixed).volume == pytest.approx(1.0)


def test_a_valid_mesh_is_taken_as_it_is(tmp_path):
    """A ring, whose inner facets face its centre: nothing is turned or mended, and its volume is 2 pi^2 R r^2.

    A library that mended valid meshes once doubled what it computed of them.
    """
    around, across = 96, 48
    one, other = np.meshgrid(np.arange(around), np.arange(across), indexing="ij")
    turn, tilt = 2.0 * np.pi * one / around, 2.0 * np.pi * other / across
    reach = 3.0 + np.cos(tilt)
    vertices = np.stack([reach * np.cos(turn), reach * np.sin(turn), np.sin(tilt)], axis=-1).reshape(-1, 3)
    corner = [(one + i) % around * across + (other + k) % across for i, k in ((0, 0), (1, 0), (1, 1), (0, 1))]
    halves = [np.stack([corner[k] for k in which], axis=-1) for which in ((0, 1, 2), (0, 2, 3))]
    faces = np.concatenate([half.reshape(-1, 3) for half in halves])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        shape, read = Shape(vertices, faces), Shape.read(write_obj(tmp_path / "ring.obj", vertices, faces))
    inner = (shape.normals * shape.corners.mean(axis=1)).sum(axis=1) < 0.0
    assert 0.3 < inner.mean() < 0.5
    for taken in (shape, read):
        np.testing.assert_array_equal(taken.faces, faces)
        np.testing.assert_array_equal(taken.vertices, vertices)
        assert taken.volume == pytest.approx(2.0 * math.pi**2 * 3.0, rel=0.005)


def test_reading_refuses_what_it_cannot_read(tmp_path):
    good = write_obj(tmp_path / "cube.obj", cube_vertices(), CUBE_FACES)
    with pytest.raises(ValueError, match="unit is 'mile'"):
        Shape.read(good, unit="mile")
    with pytest.raises(ValueError, match="no such file"):
        Shape.read(tmp_path / "absent.obj")
    with pytest.raises(ValueError, match=r"\.ply"):
        Shape.read(tmp_path / "shape.ply")
    bad = tmp_path / "bad.obj"
    for line in ("v 0 0 zero", f"f {10**30} 1 2"):
        bad.write_text(f"{line}\n")
        with pytest.raises(ValueError, match="line 1"):
            Shape.read(bad)
    half = tmp_path / "half.stl"
    half.write_bytes(b"solid is how binary files may begin, too".ljust(100))
    with pytest.raises(ValueError, match="has no facets: neither"):
        Shape.read(half)


def test_vertices_that_no_facet_uses_are_not_of_the_body():
    shape = Shape(np.concatenate([[[1e12] * 3], cube_vertices(2.0)]), CUBE_FACES + 1)
    same = Shape(cube_vertices(2.0), CUBE_FACES)
    assert (shape.vertices == same.vertices).all()
    assert (shape.faces == same.faces).all()
    assert (shape.volume, shape.radius) == (same.volume, same.radius)


def test_latitude_and_longitude_both_ways():
    shape = didymos().shape
    latitude, longitude = np.meshgrid(np.linspace(-89.0, 89.0, 23), np.linspace(-179.0, 180.0, 31))
    points = shape.surface_point(latitude, longitude)
    back = shape.latitude_longitude(points)
    assert np.allclose(back[0], latitude, atol=1e-12)
    assert np.allclose(back[1], longitude, atol=1e-12)
    assert np.abs(shape.height(points)).max() < 1e-11
    assert shape.latitude_longitude([-1.0, -0.0, 0.0])[1] == 180.0
    with pytest.raises(ValueError, match="latitude must lie"):
        shape.surface_point(91.0, 0.0)


def test_height_along_the_radius_both_ways(shapes):
    shape = Shape.read(shapes / "eros_7624.obj")
    latitude, longitude, height = (np.array([-70.0, 3.0, 41.0]), np.array([10.0, 180.0, -123.0]),
        np.array([0.0, 9.0, 1e5]))  # fmt: skip
    points = shape.surface_point(latitude, longitude, height)
    radius = np.linalg.norm(points, axis=-1)
    ground = np.linalg.norm(shape.surface_point(*shape.latitude_longitude(points)), axis=-1)
    back = (*shape.latitude_longitude(points), radius - ground)
    for found, given in zip(back, (latitude, longitude, height), strict=True):
        assert found == pytest.approx(given, abs=1e-7)
    assert abs(shape.height(points[0])) < 1e-6
    assert 0.0 < shape.height(points[1]) <= 9.0


def test_a_centre_of_mass_off_the_origin_is_told_and_nothing_is_moved(tmp_path):
    vertices = np.array([(0.0, 0.0, 0.0), (4.0, 0.0, 0.0), (0.0, 4.0, 0.0), (0.0, 0.0, 4.0)])
    lines = [f"v {x} {y} {z}" for x, y, z in vertices] + ["f 1 3 2", "f 1 2 4", "f 1 4 3", "f 2 3 4"]
    (tmp_path / "corner.obj").write_text("\n".join(lines))
    with pytest.warns(UserWarning, match=r"centre of mass lies at \(1, 1, 1\) m, 1.73 m off the origin"):
        shape = Shape.read(tmp_path / "corner.obj")
    assert np.array_equal(shape.vertices, vertices)


def test_height_and_inside_agree(shapes):
    shape = Shape.read(shapes / "itokawa_5430.obj")
    points = np.random.default_rng(1).normal(size=(500, 3)) * [150.0, 80.0, 70.0]
    inside = shape.contains(points)
    assert 0.3 < inside.mean() < 0.8
    assert np.array_equal(inside, shape.height(points) < 0.0)


@pytest.mark.parametrize(("file", "facets", "volume"), [
    ("didymos_radar2020_1996.obj", 1996, 2.4855e8),
    ("dimorphos_gama.obj", 4700, 1.8023e6),
    ("itokawa_5430.obj", 5430, 1.7745e7),
    ("eros_7624.obj", 7624, 2.4995e12),
    ("bennu_2692.obj", 2692, 6.2266e7),
])  # fmt: skip
def test_real_shapes(shapes, file, facets, volume):
    shape = Shape.read(shapes / file)
    assert (len(shape.faces), shape.volume) == (facets, pytest.approx(volume, rel=3e-5))


def test_built_in_bodies_have_the_published_extents():
    body = didymos()
    assert np.ptp(body.shape.vertices, axis=0) == pytest.approx([851.0, 849.0, 620.0], rel=1e-12)
    assert len(body.shape.faces) == 1920
    assert np.linalg.norm(body.shape.centroid) < 1e-9
    assert 2100.0 < body.density < 2700.0  # published: 2400 +- 300 kg/m3
    assert body.shape.surface_normal(0.0, 0.0) == pytest.approx([1.0, 0.0, 0.0], abs=1e-12)
    assert np.ptp(dimorphos().shape.vertices, axis=0) == pytest.approx([177.0, 174.0, 116.0], rel=1e-12)
    assert np.array_equal(didymos().shape.vertices, body.shape.vertices)
    after_dart = dimorphos(extents=(193.0, 148.0, 120.0)).shape
    assert np.ptp(after_dart.vertices, axis=0) == pytest.approx([193.0, 148.0, 120.0], rel=1e-12)
    # An ellipsoid, less what 1920 facets cut off.
    assert after_dart.volume == pytest.approx(np.pi / 6.0 * 193.0 * 148.0 * 120.0, rel=0.01)


def test_the_pole_is_that_of_the_frames_kernel():
    """Right ascension and declination of the Didymos system frames kernel, version 007, turned into the ecliptic."""
    right_ascension, declination, obliquity = np.radians([69.326861, -72.724550, 23.4392911])
    up = np.sin(declination) * np.cos(obliquity) - np.cos(declination) * np.sin(obliquity) * np.sin(right_ascension)
    across = np.sin(right_ascension) * np.cos(obliquity) + np.tan(declination) * np.sin(obliquity)
    longitude = np.degrees(np.arctan2(across, np.cos(right_ascension))) % 360.0
    assert (longitude, np.degrees(np.arcsin(up))) == pytest.approx(DIDYMOS_POLE, abs=0.05)


def test_local_frame_is_a_compass():
    body = didymos()
    origin, axes = body.local_frame(0.0, 0.0, 0.0)
    assert origin == pytest.approx(body.shape.surface_point(0.0, 0.0))
    assert axes == pytest.approx(np.array([[0, 0, 1], [0, -1, 0], [1, 0, 0]]), abs=1e-12)
    _, east = body.local_frame(0.0, 0.0, 90.0)
    assert east[0] == pytest.approx([0.0, 1.0, 0.0], abs=1e-12)
    for heading in (0.0, 33.0, 270.0):
        _, axes = body.local_frame(-42.0, 101.0, heading)
        assert axes @ axes.T == pytest.approx(np.eye(3), abs=1e-14)
        assert np.linalg.det(axes) == pytest.approx(1.0)
        assert axes[2] == pytest.approx(body.shape.surface_normal(-42.0, 101.0))


BALL = top_shape((200.0, 200.0, 200.0), ridge_height=0.0, name="ball")


def seen_over_a_day(shape: Shape, place: np.ndarray, up: np.ndarray, latitude: float, **others: float) -> np.ndarray:
    return seen_from(shape, place, up, day_directions([latitude]), **others)


@pytest.mark.parametrize(("latitude", "sun"), [(0.0, 0.0), (40.0, 15.0), (-40.0, 15.0), (80.0, -20.0), (75.0, 20.0)])
def test_day_on_a_ball_is_as_long_as_in_closed_form(latitude: float, sun: float) -> None:
    """The Sun is up while cos(hour angle) > -tan(latitude) tan(its latitude)."""
    angle = np.radians(latitude)
    up = np.array([[np.cos(angle), 0.0, np.sin(angle)]])
    seen = seen_over_a_day(BALL, 100.5 * up, up, sun)
    rise = -np.tan(angle) * np.tan(np.radians(sun))
    assert seen.mean() == pytest.approx(np.arccos(np.clip(rise, -1.0, 1.0)) / np.pi, abs=1.0 / DIRECTIONS)


def test_mask_takes_its_height_off_either_end_of_the_day() -> None:
    up = np.array([[1.0, 0.0, 0.0]])
    seen = seen_over_a_day(BALL, 100.5 * up, up, 0.0, mask_deg=30.0)
    assert seen.mean() == pytest.approx(120.0 / 360.0, abs=1.0 / DIRECTIONS)


def step() -> Shape:
    """A body like a step: a slab of 2 x 4 x 4 m, and on one half of its top a block 2 m high."""
    outline = np.array([[0, 0], [4, 0], [4, 2], [2, 2], [2, 4], [0, 4]], dtype=float) - [1.6, 1.6]
    count = len(outline)
    corners = np.vstack([np.column_stack([outline, np.full(count, z)]) for z in (-2.0, 2.0)])
    caps = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]]
    faces = [[a, c, b] for a, b, c in caps] + [[a + count, b + count, c + count] for a, b, c in caps]
    for k in range(count):
        n = (k + 1) % count
        faces += [[k, n, n + count], [k, n + count, k + count]]
    return Shape(corners, faces, name="step")


TREAD = np.array([[1.4, 0.4, 0.0]]), np.array([[0.0, 1.0, 0.0]])


def test_a_wall_hides_what_stands_lower_than_its_top() -> None:
    """Seen from the step's tread, 1 m off a wall 2 m high, a body low in that direction is hidden below 63 degrees."""
    directions, seen = day_directions([0.0])[0], seen_over_a_day(step(), *TREAD, 0.0)[0]
    height = np.degrees(np.arcsin(directions[:, 1]))
    toward_wall = directions[:, 0] < 0.0
    assert (seen == ((height > 0.0) & (~toward_wall | (height > np.degrees(np.arctan2(2.0, 1.0)))))).all()


def test_a_wall_hides_nothing_that_is_before_it() -> None:
    way = np.array([[[-1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]]]) / math.sqrt(2.0)
    # The wall is 1 m off, and so 1.41 m along this direction.
    assert seen_from(step(), *TREAD, way, distance=[[1.4, 1.43]]).tolist() == [[True, False]]


def test_directions_go_around_at_their_latitude() -> None:
    directions = day_directions([30.0])[0]
    assert np.allclose(directions[:, 2], 0.5)
    assert np.allclose(directions.mean(axis=0)[:2], 0.0)
    assert np.allclose(np.linalg.norm(directions, axis=1), 1.0)


@pytest.mark.parametrize(("inclination", "latitude"), [(0.0, 0.0), (180.0, 0.0), (90.0, 90.0)])
@pytest.mark.parametrize("mask", [0.0, 20.0])
def test_an_orbiter_is_seen_for_its_arc_above_the_mask(inclination: float, latitude: float, mask: float) -> None:
    """From below its orbit it is in sight over twice the angle arccos((R / r) cos(mask)) - mask about the centre."""
    height, radius = 100.0, 300.0
    angle, mask_angle = np.radians(latitude), np.radians(mask)
    up = np.array([[np.cos(angle), 0.0, np.sin(angle)]])
    ball = top_shape((2.0, 2.0, 2.0), ridge_height=0.0, name="dot")
    way = circle_places(radius, inclination)[None] - height * up[:, None]
    distance = np.linalg.norm(way, axis=-1)
    seen = seen_from(ball, height * up, up, way / distance[..., None], mask, distance=distance)
    arc = math.acos(height / radius * math.cos(mask_angle)) - mask_angle
    assert seen.mean() == pytest.approx(arc / math.pi, abs=2.0 / PLACES + 2e-3)


def test_places_of_an_orbiter_fill_its_band_evenly() -> None:
    """As much above one pole as above the other, at any longitude; sines of latitude as those of a circle."""
    places = circle_places(5.0, 60.0)
    assert np.linalg.norm(places, axis=1) == pytest.approx(np.full(PLACES, 5.0))
    assert np.abs(places.mean(axis=0)).max() < 0.01
    assert (places[:, 2] ** 2).mean() == pytest.approx(0.5 * (5.0 * math.sin(math.radians(60.0))) ** 2)
    assert (places[:, 0] ** 2).mean() == pytest.approx((places[:, 1] ** 2).mean(), rel=0.01)


DISTANCE = 1000.0


def eclipsed(screen: Screen, sun: float) -> float:
    """The fraction of a day over which the Sun, over a latitude, is behind a screen, for a place on a dot that it is
    over at noon."""
    dot = top_shape((0.02, 0.02, 0.02), ridge_height=0.0, name="dot")
    up = np.array([[1.0, 0.0, 0.0]])
    directions = day_directions([sun])
    free = seen_from(dot, 0.01 * up, up, directions).mean()
    return float(free - seen_from(dot, 0.01 * up, up, directions, screen=screen).mean())


@pytest.mark.parametrize("radius", [150.0, 400.0])
def test_an_eclipse_lasts_as_long_as_the_disc_is_wide(radius: float) -> None:
    """2 arcsin(R / d) of the turn, where the partner stands over the equator, as does the Sun."""
    screen = Screen(np.tile([DISTANCE, 0.0, 0.0], (DIRECTIONS, 1)), radius, radius)
    lasts = 2.0 * math.asin(radius / DISTANCE) / (2.0 * math.pi)
    assert eclipsed(screen, 0.0) == pytest.approx(lasts, abs=1.0 / DIRECTIONS)
    assert eclipsed(screen, math.degrees(math.asin(radius / DISTANCE)) + 1.0) == 0.0


def test_a_flat_partner_hides_a_sun_that_is_not_too_high() -> None:
    """Up to the angle of its polar semi-axis, and below it for as long as an ellipse is wide there."""
    screen = Screen(np.tile([DISTANCE, 0.0, 0.0], (DIRECTIONS, 1)), 400.0, 200.0)
    assert eclipsed(screen, 0.0) == pytest.approx(math.asin(0.4) / math.pi, abs=1.0 / DIRECTIONS)
    highest = math.degrees(math.atan(200.0 / math.sqrt(DISTANCE**2 - 400.0**2)))
    assert eclipsed(screen, highest - 0.5) > 0.0
    assert eclipsed(screen, highest + 0.5) == 0.0


def test_a_partner_on_the_other_side_or_behind_the_orbiter_hides_nothing() -> None:
    assert eclipsed(Screen(np.tile([-DISTANCE, 0.0, 0.0], (DIRECTIONS, 1)), 400.0, 400.0), 0.0) == 0.0
    up, far = np.array([[1.0, 0.0, 0.0]]), Screen(np.tile([DISTANCE, 0.0, 0.0], (2, 1)), 100.0, 100.0)
    along = np.tile([1.0, 0.0, 0.0], (1, 2, 1))
    assert seen_from(BALL, 100.5 * up, up, along, distance=[[500.0, 1500.0]], screen=far).tolist() == [[True, False]]


def test_a_place_is_the_farthest_that_its_direction_meets() -> None:
    """Against all facets: from the middle, beside a corner, from a corner itself, and near a pole."""
    whole = top_shape((2.0, 3.0, 4.0), 0.3)
    random = np.random.default_rng(5)
    for moved in (np.zeros(3), 0.98 * whole.vertices[40], whole.vertices[40], [0.0, 0.0, 1.9]):
        shape = Shape(whole.vertices - moved, whole.faces)
        ways = random.normal(size=(200, 3))
        ways /= np.linalg.norm(ways, axis=1, keepdims=True)
        corner, edges = shape.corners[:, 0], np.diff(shape.corners, axis=1)
        # Ray and facet: distance and two weights along its edges from its first corner.
        system = np.stack(np.broadcast_arrays(ways[:, None], -edges[None, :, 0], -edges[None, :, 1]), axis=-1)
        with np.errstate(all="ignore"):
            distance, first, second = np.moveaxis(np.linalg.solve(system, corner[None, ..., None])[..., 0], -1, 0)
        meets = (distance > 1e-9) & (first >= 0.0) & (second >= 0.0) & (second <= first) & (first <= 1.0)
        farthest = np.where(meets, distance, -np.inf).max(axis=1)
        latitude, longitude = np.degrees(np.arcsin(ways[:, 2])), np.degrees(np.arctan2(ways[:, 1], ways[:, 0]))
        for way, want, *place in zip(ways, farthest, latitude, longitude, strict=True):
            if want > 0.0:
                assert shape.surface_point(*place) == pytest.approx(want * way, abs=1e-8)
