"""Gravity of polyhedra against closed forms and its own derivatives; tables on disk, and shapes with fewer facets."""

import io
import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from lithobrake.compilation.disk_cache import DiskCache
from lithobrake.smallbody import Body, Shape, didymos, fly, gravity_table_build
from lithobrake.smallbody.body import GRAVITATIONAL_CONSTANT
from lithobrake.smallbody.gravity_table_build import gravity_table_of
from lithobrake.smallbody.simd import angle, log_ratio

from .meshes import CUBE_FACES, cube_vertices, sphere_mesh


@pytest.fixture(scope="module")
def block(cube) -> Body:
    """A cube of 1 m with density 1 / G, so that sums come out bare."""
    return Body(cube, mass=1.0 / GRAVITATIONAL_CONSTANT, spin_period=math.inf)


def cube_potential(point: np.ndarray) -> float:
    """Potential of a unit cube with G density = 1.

    Source: MacMillan (1930), The Theory of the Potential, section 43: the triple integral of 1/r in closed form.
    """
    total = 0.0
    for i in (0, 1):
        for j in (0, 1):
            for k in (0, 1):
                x, y, z = (e - 0.5 - p for e, p in zip((i, j, k), point, strict=True))
                r = math.sqrt(x * x + y * y + z * z)
                term = x * y * math.log(z + r) + y * z * math.log(x + r) + z * x * math.log(y + r)
                for a, b, c in ((x, y, z), (y, z, x), (z, x, y)):
                    term -= 0.5 * a * a * math.atan(b * c / (a * r))
                total += (-1) ** (i + j + k + 1) * term
    return total


def test_logarithm_and_angle_have_all_digits():
    random = np.random.default_rng(0)
    parts = np.concatenate([random.uniform(0.0, 1.0, 2000) ** 0.2, 10.0 ** np.arange(-15.0, 0.0)])
    for part in parts.tolist():
        assert log_ratio(1.0, part) == pytest.approx(float(2 * np.arctanh(np.longdouble(part))), rel=1e-15)
    for y, x in random.normal(size=(2000, 2)).tolist():
        assert angle(y, x) == pytest.approx(math.atan2(y, x), rel=1e-15)
    assert (angle(0.0, 0.0), angle(0.0, 1.0), angle(0.0, -1.0)) == (0.0, 0.0, math.pi)


@pytest.mark.parametrize("point", [(0.7, 0.9, 1.3), (3.0, -2.0, 1.0), (0.1, 0.2, -0.3), (0.51, 0.1, 0.2)])
def test_cube_against_the_triple_integral(block, point):
    # The closed form loses digits in its logarithms, hence 1e-12.
    assert block.potential(point) == pytest.approx(cube_potential(np.array(point)), rel=1e-12)


def test_centre_of_a_cube(block):
    # Known: 3 ln((sqrt 3 + 1) / (sqrt 3 - 1)) - pi / 2 for edge 1, times G density.
    expected = 3.0 * math.log((math.sqrt(3.0) + 1.0) / (math.sqrt(3.0) - 1.0)) - 0.5 * math.pi
    assert block.potential([0.0, 0.0, 0.0]) == pytest.approx(expected, rel=1e-14)
    assert np.abs(block.acceleration([0.0, 0.0, 0.0])).max() < 1e-14


def test_special_points_are_finite_and_continuous(block):
    """On faces, edges, corners and diagonals: the value is the limit from any side."""
    special = np.array([[0.5, 0.1, 0.2], [0.5, 0.5, 0.2], [0.5, 0.5, 0.5], [0.5, 0, 0], [0.5, 0.5, 3], [0, 0.5, 9]])
    near = special + 1e-9 * np.random.default_rng(2).normal(size=special.shape)
    assert np.allclose(block.acceleration(special), block.acceleration(near), rtol=0, atol=1e-7)
    assert np.allclose(block.potential(special), block.potential(near), rtol=0, atol=1e-8)


def test_laplacian_tells_inside_from_outside(block):
    points = [[0.1, -0.2, 0.3], [0.49, 0.0, 0.0], [0.51, 0.0, 0.0], [3.0, 4.0, 5.0], [0.5, 0.1, 0.2]]
    expected = np.array([-4.0, -4.0, 0.0, 0.0, -2.0]) * math.pi
    assert block.laplacian(points) == pytest.approx(expected, abs=1e-12)


def test_a_slanted_facet_has_half_the_laplacian_and_holds_no_point():
    """As the facets of a cube have it: of these planes rounding leaves every point a height, above or below."""
    tetrahedron = Shape(
        np.array([(0, 0, 0), (2, 0, 0), (0, 2, 0), (0, 0, 2)]) + 0.3, [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    )
    for shape in (tetrahedron, didymos(partner=False).shape):
        body, which = Body(shape, mass=1.0, spin_period=math.inf), slice(None, None, 3 if len(shape.faces) > 100 else 1)
        corners = shape.vertices[shape.faces[which]]
        points = np.einsum("fkc,fci->fki", np.random.default_rng(1).dirichlet([1, 1, 1], (len(corners), 3)), corners)
        inside = -4.0 * math.pi * GRAVITATIONAL_CONSTANT * body.density
        assert body.laplacian(points) / inside == pytest.approx(np.full(points.shape[:2], 0.5), abs=1e-9)
        assert not shape.contains(points).any()
        away = 1e-9 * shape.radius * shape.normals[which, None]
        assert shape.contains(points - away).all()


def test_near_points_need_no_moments_and_get_the_same_bits():
    body = Body(Shape(*sphere_mesh(3)), mass=1.0 / GRAVITATIONAL_CONSTANT, spin_period=math.inf)
    directions, _ = sphere_mesh(2)
    near, far = (body.shape.centroid + radii * body.shape.radius * directions for radii in (1.1, 3.0))
    without_moments = body.potential(near)
    assert "multipole" not in vars(body.shape)
    both = body.potential(np.concatenate([near, far]))
    assert "multipole" in vars(body.shape)
    assert np.array_equal(both[: len(near)], without_moments)
    assert np.array_equal(body.potential(near), without_moments)


def test_acceleration_is_the_gradient_of_the_potential(shapes):
    body = Body(Shape.read(shapes / "didymos_radar2020_1996.obj"), mass=5.32e11, spin_period=8136.0)
    points = np.random.default_rng(3).normal(size=(50, 3)) * 400.0
    step = 0.5
    shift = step * np.eye(3)
    # Sixth order differences; points near an edge, where the second derivative is large, would need smaller steps.
    gradient = np.stack(
        [
            sum(
                w * (body.potential(points + k * shift[i]) - body.potential(points - k * shift[i]))
                for k, w in ((1, 45), (2, -9), (3, 1))
            )
            / (60 * step)
            for i in range(3)
        ],
        axis=1,
    )
    error = np.linalg.norm(gradient - body.acceleration(points), axis=1)
    assert np.median(error) < 1e-11
    assert np.sort(error)[-5] < 1e-8


def asked(body: Body, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Potential and acceleration of the polyhedral-gravity library of ESA (GPL-3), never imported by the package."""
    oracle = pytest.importorskip("polyhedral_gravity", reason="polyhedral-gravity is not installed (extra: oracle)")
    polyhedron = oracle.Polyhedron(polyhedral_source=(body.shape.vertices, body.shape.faces), density=body.density,
        normal_orientation=oracle.NormalOrientation.OUTWARDS,
        integrity_check=oracle.PolyhedronIntegrity.DISABLE)  # fmt: skip
    answers = oracle.evaluate(polyhedron, points, parallel=False)
    potential, acceleration = (np.array([answer[i] for answer in answers]) for i in range(2))
    return potential, acceleration


@pytest.mark.parametrize("name", ["cube", "didymos", "didymos_radar2020_1996.obj"])
def test_gravity_is_that_of_another_library_near_and_inside(name: str, request: pytest.FixtureRequest) -> None:
    if name == "cube":
        body = Body(Shape(cube_vertices(100.0) + 20.0, CUBE_FACES), mass=2e9, spin_period=1e4)
    elif name == "didymos":
        body = didymos(partner=False)
    else:
        shapes = request.getfixturevalue("shapes")
        body = Body(Shape.read(shapes / name), mass=5.32e11, spin_period=8136.0)
    random = np.random.default_rng(0)
    points = random.normal(size=(150, 3))
    points *= (body.shape.radius * random.uniform(0.3, 3.0, 150) / np.linalg.norm(points, axis=1))[:, None]
    potential, acceleration = asked(body, points)
    assert body.potential(points) == pytest.approx(potential, rel=1e-10)
    off = np.linalg.norm(body.acceleration(points) - acceleration, axis=1)
    assert (off < 1e-10 * np.linalg.norm(acceleration, axis=1)).all()


def test_everything_is_finite_on_faces_edges_and_corners(cube, shapes):
    for shape in (cube, Shape.read(shapes / "didymos_radar2020_1996.obj")):
        body = Body(shape, mass=1e11, spin_period=math.inf)
        corners = shape.vertices[shape.faces]
        points = np.concatenate([shape.vertices, corners.mean(axis=1), 0.5 * (corners[:, 0] + corners[:, 1])])
        for values in (body.potential(points), body.acceleration(points), body.laplacian(points)):
            assert np.isfinite(values).all()
        # The value is the limit: a nanometre aside changes nothing but the last digits.
        aside = points + 1e-9 * np.random.default_rng(0).normal(size=points.shape)
        change = np.linalg.norm(body.acceleration(points) - body.acceleration(aside), axis=1)
        assert change.max() < 1e-7 * np.linalg.norm(body.acceleration(points), axis=1).max()


@pytest.mark.parametrize("radii", [3.0, 10.0, 1e2, 1e4, 1e6])
def test_far_field_keeps_its_digits(cube, radii):
    """Against the cube's own expansion: monopole and the moments of degree 4, as 2 and 3 vanish; the next is 6."""
    body = Body(cube, mass=1.0 / GRAVITATIONAL_CONSTANT, spin_period=math.inf)
    directions, _ = sphere_mesh(3)
    distance = radii * math.sqrt(0.75)
    # x**4 + y**4 + z**4 - 3/5 over a cube of unit edge and mass: -7/480 of it, from the moments of x**4 and x**2 y**2.
    shape = (directions**4).sum(axis=1) - 0.6
    expected = 1.0 / distance - 7.0 / 192.0 * shape / distance**5
    error = np.abs(body.potential(distance * directions) * distance - expected * distance)
    assert error.max() < max(1e-8, 0.05 / distance**6)


def test_far_field_is_a_point_mass(block):
    point = np.array([30.0, 40.0, 50.0])
    r = np.linalg.norm(point)
    assert block.potential(point) == pytest.approx(1.0 / r, rel=1e-7)
    assert block.acceleration(point) == pytest.approx(-point / r**3, rel=1e-6)


@pytest.mark.parametrize("file", ["didymos_radar2020_1996.obj", "eros_7624.obj"])
def test_series_takes_over_without_a_step_and_holds_far_out(shapes, file):
    """Where the series begins it agrees with the facets to 5e-11; far out it keeps the digits that their sum loses."""
    shape = Shape.read(shapes / file)
    body = Body(shape, mass=1.0 / GRAVITATIONAL_CONSTANT, spin_period=math.inf)
    series = shape.multipole
    assert series.error < 2e-11
    directions, _ = sphere_mesh(4)
    inside = body.acceleration(shape.centroid + series.nearest * (1.0 - 1e-12) * directions)
    outside = body.acceleration(shape.centroid + series.nearest * (1.0 + 1e-12) * directions)
    assert np.linalg.norm(inside - outside, axis=1).max() < 5e-11 * np.linalg.norm(inside, axis=1).max()
    for radii in (1e3, 1e6):
        distance = radii * series.radius
        assert np.abs(body.potential(shape.centroid + distance * directions) * distance - 1.0).max() < 1.0 / radii**2
    # The moment of degree 0 is the volume, those of degree 1 vanish about the centroid.
    assert series.real[0, 0] * series.radius**3 == pytest.approx(shape.volume, rel=1e-13)
    assert np.abs(series.real[1]).max() < 1e-14


def test_sphere_limit():
    """Facets to infinity: G M / r outside, linear inside; the error falls with the square of the facet size."""
    errors = []
    for frequency in (8, 16):
        directions, faces = sphere_mesh(frequency)
        body = Body(Shape(directions, faces), mass=1.0 / GRAVITATIONAL_CONSTANT, spin_period=math.inf)
        outside = body.acceleration([1.2, 0.9, -0.4])
        inside = body.acceleration([0.3, 0.1, -0.2])
        exact = -np.array([1.2, 0.9, -0.4]) / np.linalg.norm([1.2, 0.9, -0.4]) ** 3
        errors.append((np.linalg.norm(outside - exact), np.linalg.norm(inside + np.array([0.3, 0.1, -0.2]))))
    assert errors[1][0] < errors[0][0] < 5e-3
    assert errors[1][1] < 0.3 * errors[0][1] < 1e-2


def test_lanes_and_blocks_do_not_change_a_bit(block):
    points = np.random.default_rng(4).normal(size=(77, 3)) * 2.0
    assert np.array_equal(block.acceleration(points), np.array([block.acceleration(point) for point in points]))


def test_orientation_of_a_shape_does_not_matter(block):
    with pytest.warns(UserWarning, match="faced inwards"):
        turned = Body(Shape(cube_vertices(), CUBE_FACES[:, ::-1]), block.mass, math.inf)
    assert turned.potential([1.0, 2.0, 3.0]) == pytest.approx(block.potential([1.0, 2.0, 3.0]), rel=1e-14)


def test_effective_acceleration_by_latitude(shapes):
    """Normal component on the radar shape of Didymos: the published site lies at the centrifugal limit."""
    body = Body(Shape.read(shapes / "didymos_radar2020_1996.obj"), mass=5.32e11, spin_period=2.26 * 3600)
    at_site = body.effective_acceleration(body.shape.surface_point(0.0, 0.0)) @ body.shape.surface_normal(0.0, 0.0)
    assert at_site == pytest.approx(10e-6, abs=2e-6)
    pole = body.effective_acceleration(body.shape.surface_point(85.0, 0.0)) @ body.shape.surface_normal(85.0, 0.0)
    assert pole == pytest.approx(-223e-6, abs=15e-6)


def test_effective_acceleration_with_a_mass_and_a_spin_for_each_point(block):
    points, mass, period = (np.array([[3.0, 1.0, 0.0], [0.0, 2.0, 2.0]]), np.array([1e6, 3e6]),
        np.array([40.0, math.inf]))  # fmt: skip
    together = block.effective_acceleration(points, mass=mass, spin_period=period)
    for i in range(2):
        alone = replace(block, mass=mass[i], spin_period=period[i]).effective_acceleration(points[i])
        assert together[i] == pytest.approx(alone, rel=1e-14)


def test_slope(cube, shapes):
    still = Body(cube, mass=1e6, spin_period=math.inf)
    assert still.slope(90.0, 0.0) == pytest.approx(0.0, abs=1e-7)
    # Just beside a cube's edge the plumb line points between its two faces.
    assert still.slope(0.0, 44.999) == pytest.approx(math.radians(45.0), abs=1e-3)
    body = Body(Shape.read(shapes / "didymos_radar2020_1996.obj"), mass=5.32e11, spin_period=2.26 * 3600)
    assert body.slope(0.0, 0.0) > 0.5 * math.pi  # lifted off by the rotation
    # At the pole of the built-in shape the plumb line is the axis: the slope is the facet's own tilt.
    tilt = math.acos(didymos().shape.surface_normal(90.0, 0.0)[2])
    assert didymos().slope(90.0, 0.0) == pytest.approx(tilt, abs=1e-3)


def test_bad_bodies_are_refused(cube):
    with pytest.raises(ValueError, match="mass is -1"):
        Body(cube, mass=-1.0, spin_period=1.0)
    with pytest.raises(ValueError, match="spin_period is 0"):
        Body(cube, mass=1.0, spin_period=0.0)
    with pytest.raises(ValueError, match="last axis"):
        Body(cube, mass=1.0, spin_period=1.0).acceleration([1.0, 2.0])


def test_numbers_that_no_body_has_are_refused(cube):
    body, far = Body(cube, mass=1e10, spin_period=1e4), [1e4, 0.0, 0.0]
    for call, said in [
        (lambda: Body(body.shape, "heavy", 1e4), "mass is 'heavy'"),
        (lambda: body.effective_acceleration(far, mass=-1.0), "mass is -1.0 kg"),
        (lambda: body.effective_acceleration(far, spin_period=0.0), "spin_period 0.0 s"),
        (lambda: body.local_frame(0.0, 0.0, np.nan), "heading_deg is nan"),
        (lambda: body.shape.surface_point(0.0, 0.0, np.nan), "height is nan"),
        (lambda: body.shape.contains([1.0, 2.0]), "the last axis must hold x, y, z"),
        (lambda: body.shape.latitude_longitude(np.ma.masked_array([far], mask=[[True, False, False]])), "1 masked"),
    ]:
        with pytest.raises(ValueError, match=said):
            call()


# Coarse, for a table of some kilobytes.
LEVELS = ((0.25, 0.0), (1.0, 6.0))


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty cache in the place of the user's, for tables alone."""
    monkeypatch.setenv("LITHOBRAKE_CACHE", str(tmp_path))
    monkeypatch.setattr(gravity_table_build, "disk_cache", DiskCache)
    return tmp_path


def built(cube: Shape) -> tuple[np.ndarray, tuple[float, ...]]:
    table, error = gravity_table_of(cube.polyhedron, cube.multipole, cube.volume, LEVELS)
    return table.values, tuple(error)


def with_objects() -> bytes:
    """Arrays that run code when they are read."""
    file = io.BytesIO()
    np.savez(file, values=np.array([print], dtype=object))
    return file.getvalue()


@pytest.mark.parametrize("spoil", [
    lambda whole: whole[:-500], lambda whole: b"", lambda whole: whole[:300] + b"?" + whole[301:],
    lambda whole: with_objects(),
], ids=["truncated", "empty", "one byte", "objects"])  # fmt: skip
def test_damaged_table_is_made_again(cube, folder, caplog, spoil: Callable[[bytes], bytes]):
    values, error = built(cube)
    (file,) = folder.rglob("gravity-*")
    whole = file.read_bytes()
    file.write_bytes(spoil(whole))
    caplog.clear()
    again, error_again = built(cube)
    assert caplog.messages == [f"{file} is damaged, or was not written with this user's key: it is made again."]
    assert again.tobytes() == values.tobytes()
    assert error_again == error
    assert file.read_bytes() == whole
    read, error_read = built(cube)
    assert len(caplog.messages) == 1
    assert read.tobytes() == values.tobytes()
    assert error_read == error


def test_table_that_cannot_be_kept_is_made_in_memory(cube, folder, caplog):
    values, _ = built(cube)
    for path in folder.rglob("gravity-*"):
        path.unlink()
    (folder / "lithobrake" / "smallbody").rmdir()
    (folder / "lithobrake" / "smallbody").write_text("a file in the way")
    caplog.clear()
    again, _ = built(cube)
    (told,) = caplog.messages
    assert "gravity tables are made anew each time; set LITHOBRAKE_CACHE to a folder that is yours alone." in told
    assert again.tobytes() == values.tobytes()


@cache
def bumpy(gravity_facets: int | None = None) -> Shape:
    """A body of 4608 facets with hills of 3 %, some 800 m across."""
    pytest.importorskip("fast_simplification")
    directions, faces = sphere_mesh(24)
    hills = 1.0 + 0.03 * np.sin(9.0 * directions[:, :1]) * np.cos(7.0 * directions[:, 1:2])
    return Shape(directions * [400.0, 380.0, 300.0] * hills, faces, gravity_facets=gravity_facets)


def test_the_ground_stays_and_mass_and_centre_do_too() -> None:
    whole, shape = bumpy(), bumpy(1000)
    few = shape.attracting
    assert 1000 <= len(few.faces) < 1100
    assert np.array_equal(shape.vertices, whole.vertices)
    assert few.volume == pytest.approx(whole.volume, rel=1e-12)
    assert few.centroid == pytest.approx(whole.centroid, abs=1e-9)
    assert whole.attracting is whole
    assert bumpy(10_000).attracting.faces.shape == whole.faces.shape


def test_gravity_is_that_of_the_whole_within_what_the_surface_moves() -> None:
    """A surface that moves by a part of the radius changes gravity by about that part; far away by its square."""
    whole, thin = (Body(bumpy(facets), mass=3e11, spin_period=1e4) for facets in (None, 1000))
    ground = whole.shape.vertices[::97]
    moved = np.abs(thin.shape.attracting.height(ground)).max() / 300.0
    assert 0.0 < moved < 0.01
    for points, error in ((ground, 3.0 * moved), (3.0 * ground, moved)):
        exact, found = whole.acceleration(points), thin.acceleration(points)
        off = np.linalg.norm(found - exact, axis=1) / np.linalg.norm(exact, axis=1)
        assert 0.0 < off.max() < error


def test_flights_meet_the_ground_of_the_whole() -> None:
    body = Body(bumpy(1000), mass=3e11, spin_period=1e5)
    flights = fly(body, body.shape.surface_point(20.0, 40.0, 5.0), [0.0, 0.0, 0.0], 3600.0)
    assert flights.status[0] == "impact"
    assert body.shape.height(flights.position)[0] == pytest.approx(0.0, abs=1e-6)
    assert abs(body.shape.attracting.height(flights.position)[0]) > 1e-3


def test_too_few_facets_are_refused() -> None:
    with pytest.raises(ValueError, match="gravity_facets is 99; it must be 100 or more"):
        bumpy(99)
