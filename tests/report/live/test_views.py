"""What a view in three dimensions is given: poses that come back to within half a quantum, and paints of faces."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest

from lithobrake.report.figures.hulls import Scene
from lithobrake.report.live.body_view import body_views
from lithobrake.report.live.landing_view import LARGEST, landing_arrays, landing_views
from lithobrake.results import MovingBodies
from lithobrake.results.page_data import PageData
from lithobrake.vocabulary.outcomes import FATE_COLOURS

from ..finished_studies import OCTAHEDRON, OCTAHEDRON_FACES


def moving(position: np.ndarray, orientation: np.ndarray) -> Scene:
    """Octahedra that move so, at steps of a tenth of a second."""
    from lithobrake.report.figures.hulls import scene

    count = position.shape[1]
    time = 0.1 * np.arange(len(position))
    shapes = (OCTAHEDRON,) * count, (OCTAHEDRON_FACES,) * count
    return scene(MovingBodies(*shapes, time, position, orientation, {}, {}), has_lander=True)


def test_poses_come_back_from_their_steps() -> None:
    random = np.random.default_rng(4)
    position = np.cumsum(random.normal(0.0, 0.1, (40, 3, 3)), axis=0)
    # The second body never moves, and the third one jumps from end to end of its way.
    position[:, 1] = [0.3, -0.2, 0.1]
    position[:, 2, 0] = np.where(np.arange(40) % 2, 5.0, -5.0)
    orientation = random.normal(size=(40, 3, 4))
    orientation /= np.linalg.norm(orientation, axis=2, keepdims=True)
    arrays, facts = landing_arrays(moving(position, orientation))
    whole = np.cumsum(arrays["steps"], axis=0, dtype=np.int16).astype(float)
    place = arrays["middles"] + arrays["quanta"][:, None].astype(float) * whole[:, :, :3]
    assert np.abs(place - position).max() < 0.51 * arrays["quanta"].max()
    assert not arrays["steps"][1:, 1, :3].any()
    turn = whole[:, :, [6, 3, 4, 5]] / LARGEST
    # Both signs are one turn.
    assert np.abs((turn * orientation).sum(axis=2)) == pytest.approx(np.ones((40, 3)), abs=1e-4)
    assert ((turn[1:] * turn[:-1]).sum(axis=2) > -1e-4).all()
    assert [one["name"] for one in facts["shades"]] == ["speed"]
    assert float(facts["shades"][0]["high"]) == pytest.approx(100.0, rel=0.2)
    assert arrays["speed"].max() == 255
    assert not arrays["speed"][:, 1].any()


def test_forces_are_shaded_over_equal_factors_where_they_were_kept() -> None:
    force = np.array([[0.0, 1e-3], [1e-1, 10.0]])
    still = moving(np.zeros((2, 2, 3)), np.tile([1.0, 0.0, 0.0, 0.0], (2, 2, 1)))
    arrays, facts = landing_arrays(replace(still, moving=replace(still.moving, force=force)))
    # Four decades in 255 steps; what is weaker by more is as dark as nothing.
    assert arrays["force"].tolist() == [[0, 0], [round(255 * 0.5), 255]]
    assert facts["shades"][1] == {"name": "force", "unit": "N", "low": "0.001", "high": "10"}


def test_faces_count_from_the_first_vertex_of_all_and_have_the_colour_of_their_body() -> None:
    still = np.zeros((2, 2, 3))
    arrays, _ = landing_arrays(moving(still, np.tile([1.0, 0.0, 0.0, 0.0], (2, 2, 1))))
    assert arrays["faces"].shape == arrays["paint"].shape == (16, 3)
    assert (arrays["faces"][8:] - arrays["faces"][:8] == 6).all()
    assert arrays["vertexBody"].tolist() == [0.0] * 6 + [1.0] * 6
    # The lander, the last, is blue.
    assert (arrays["paint"][8:, 2] > arrays["paint"][8:, 0]).all()
    assert (arrays["paint"][:8, 2] < arrays["paint"][:8, 0]).all()


def test_the_ground_of_a_landing_has_a_floor_with_a_grid_of_round_meshes() -> None:
    arrays, facts = landing_arrays(moving(np.zeros((2, 2, 3)), np.tile([1.0, 0.0, 0.0, 0.0], (2, 2, 1))))
    floor, grid = arrays["floor_corner"], arrays["grid_corner"]
    assert facts["grid"] == pytest.approx(0.02)
    assert (floor[:, 2] == 0.0).all()
    ends = grid.reshape(-1, 2, 3)
    assert np.unique(np.diff(np.unique(ends[:, 0, 0].round(6))).round(6)).tolist() == [pytest.approx(facts["grid"])]
    assert len(arrays["grid_paint"]) == len(grid)


def test_the_page_says_how_far_places_are_rounded(paper: PageData) -> None:
    (landing,), (body,) = landing_views(paper), body_views(paper)
    assert "12 grains and the lander (blue) in 8 frames" in landing.html
    assert "Positions are rounded to" in landing.html
    assert 'id="body-3d-data"' in body.html
    assert f"the first {len(paper.paths[1])} flights, relative to the rotating body" in body.html
    keys = dict(re.findall(r'<span style="--key: ([^"]+)">([^<]+)</span>', body.html))
    assert keys == {FATE_COLOURS["impact"]: "impact", FATE_COLOURS["flying"]: "still flying"}


def test_a_marker_moves_along_each_way_from_its_beginning_to_its_end(paper: PageData) -> None:
    (body,) = body_views(paper)
    found = json.loads(body.html[body.html.index('id="body-3d-data">') + 18 : body.html.rindex("</script>")])
    place, per_flight = paper.paths[0], found["perFlight"]
    assert [way["first"] for way in found["ways"]] == [per_flight * number for number in range(len(place))]
    assert {way["flights"] for way in found["ways"]} == {1}
    assert found["arrays"]["way_place"]["shape"] == [len(place) * per_flight, 3]
    assert [one["words"] for one in found["labels"]][:2] == ["north", "aim point"]


def test_dimorphos_has_didymos_over_its_longitude_0(paper: PageData) -> None:
    site = replace(paper.results.site, body="dimorphos", partner="didymos", partner_distance_m=1190.0)
    study = paper.study | {"site": paper.study["site"] | {"body": "dimorphos", "partner_longitude_deg": None}}
    near = replace(paper, study=study, results=replace(paper.results, site=site))
    assert "to Didymos, 1.19 km" in body_views(near)[0].html
    free = replace(near, study=study | {"site": study["site"] | {"body": "didymos"}})
    assert "to Didymos" not in body_views(free)[0].html
