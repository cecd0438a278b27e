"""Regions of a body with a soil of their own: where they lie, what is drawn for them, and what landers meet there."""

import math
import shutil
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future
from copy import deepcopy
from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest
import tomli_w

import lithobrake
from lithobrake.pipeline import run_study, study_status
from lithobrake.pipeline.answer.run_estimates import parts_of_variance
from lithobrake.pipeline.commands.one_lander import landing_inputs
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.design.soils import Soils
from lithobrake.pipeline.job import Job, Silent
from lithobrake.pipeline.planning.planned_ground import planned_soils
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.runs.solver import function_identity
from lithobrake.pipeline.site import Site, with_site_gravity
from lithobrake.pipeline.study_folder import StudyFolder
from lithobrake.results import StudyResults
from lithobrake.study import Study, StudyError
from lithobrake.study.source import StudySource
from lithobrake.vocabulary.quantities import ELSEWHERE

from ...paper_tables import SMALL_GROUND, with_keys
from ...smallbody.meshes import sphere_mesh
from ..few_terms import fewest_terms

RADIUS, DENSITY, FREQUENCY = 80.0, 2000.0, 8
COUNT = 16
# The least restitution with which a lander bounces off.
BOUNCES = 0.2
SINK = {"latitude_deg": [-90.0, 0.0], "grain": {"restitution": 0.1}}
STRIP = {
    "latitude_deg": [0.0, 90.0],
    "longitude_deg": [-20.0, 60.0],
    "grain": {"friction": {"distribution": "uniform", "lower": 0.2, "upper": 0.3}},
}
TABLES: dict[str, Any] = {
    "seed": 3, **SMALL_GROUND, "lander": {"shape": "sphere", "diameter": 0.1, "mass": 2.0},
    "delivery": {"latitude_deg": 0.0, "longitude_deg": 0.0, "incidence_deg": 40.0,
                 "speed": {"distribution": "uniform", "lower": 0.02, "upper": 0.06},
                 "heading_deg": {"distribution": "uniform", "lower": 0.0, "upper": 360.0},
                 "north_error": {"distribution": "uniform", "lower": -60.0, "upper": 60.0}},
    "journey": {"count": COUNT, "duration": 20000.0, "emulated_count": 200}, "flight": {"gravity": "exact"},
}  # fmt: skip


class Here(Executor):
    """Makes touchdowns at once, in this process: another would take longer to start than all of them."""

    def submit(self, function: Callable[..., Any], /, *args: Any, **kwargs: Any) -> "Future[Any]":
        future: Future[Any] = Future()
        future.set_result(function(*args, **kwargs))
        return future


@pytest.fixture(scope="module", autouse=True)
def in_this_process() -> Iterator[None]:
    """No study of this file starts another process."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("lithobrake.pipeline.study_run.LocalExecutor", lambda worker_count: Here())
        yield


@pytest.fixture(scope="module")
def body_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    vertices, faces = sphere_mesh(FREQUENCY)
    path = tmp_path_factory.mktemp("body") / "ball.obj"
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in (RADIUS * vertices).tolist()]
    path.write_text("\n".join([*lines, *(f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces.tolist())]) + "\n")
    return path


def tables(body: Path, soil: dict[str, Any], **changes: dict[str, Any]) -> dict[str, Any]:
    """The tables of a study on that ball, which turns slowly."""
    mass = DENSITY * 4.0 / 3.0 * math.pi * RADIUS**3
    found = deepcopy(TABLES) | {"site": {"body": str(body), "mass": mass, "spin_period": 1e7}}
    return with_keys(found, changes) | ({"soil": soil} if soil else {})


def read(body: Path, soil: dict[str, Any], **changes: dict[str, Any]) -> Study:
    return StudySource.of_tables(tables(body, soil, **changes)).study


def soils(body: Path, soil: dict[str, Any], **changes: dict[str, Any]) -> Soils:
    return Soils(Site(read(body, soil, **changes)))


def touchdown(inputs: dict[str, float], seed: int) -> dict[str, Any]:
    """A landing that is captured by ground of little restitution, and of a slow lander; others fly on."""
    speed, incidence = inputs["impact.speed"], math.radians(inputs["impact.incidence_deg"])
    along, up = 0.8 * speed * math.sin(incidence), inputs["grain.restitution"] * speed * math.cos(incidence)
    if inputs["grain.restitution"] < BOUNCES or up < 0.004:
        return {"outcome": "captured", "outputs": {"contacts": 1.0}}
    names = ("speed_out", "elevation_out", "spin_out", "velocity_out_x", "velocity_out_y", "velocity_out_z")
    values = (math.hypot(along, up), math.atan2(up, along), 0.1, along, 0.0, up)
    return {"outcome": "clear", "outputs": dict(zip(names, values, strict=True))}


@pytest.fixture(scope="module")
def made(body_file: Path, tmp_path_factory: pytest.TempPathFactory) -> StudyResults:
    """A study whose southern half captures every lander, and whose north has a strip with another friction."""
    folder = tmp_path_factory.mktemp("soils") / "out"
    given = tables(body_file, {"sink": SINK, "strip": STRIP})
    with fewest_terms():
        return lithobrake.run(given, folder, workers=1, model=touchdown, report=False)


def run_touchdowns(given: dict[str, Any], folder: Path) -> None:
    source = StudySource.of_tables(given, function_identity(touchdown))
    run_study(source, folder, until="runs", worker_count=1, model=touchdown)


def band(south: float, north: float) -> float:
    """The part of a sphere between two latitudes [deg]."""
    return 0.5 * (math.sin(math.radians(north)) - math.sin(math.radians(south)))


def test_bounds_have_the_areas_of_a_sphere(body_file: Path) -> None:
    wedge = {"latitude_deg": [-20.0, 35.0], "longitude_deg": [170.0, -150.0], "grain": {"friction": 0.3}}
    belt = {"latitude_deg": [-20.0, 35.0], "grain": {"friction": 0.4}}
    found = soils(body_file, {"wedge": wedge, "belt": belt}).area_shares()
    assert sum(found.values()) == pytest.approx(1.0, abs=1e-12)
    # Facets of this mesh lie up to a hundredth of the radius below the sphere.
    assert found["wedge"] == pytest.approx(band(-20.0, 35.0) * 40.0 / 360.0, abs=2e-3)
    # The first in the file counts where both hold the ground.
    assert found["belt"] == pytest.approx(band(-20.0, 35.0) * 320.0 / 360.0, abs=4e-3)
    assert found[ELSEWHERE] == pytest.approx(1.0 - band(-20.0, 35.0), abs=4e-3)


def test_places_lie_where_their_latitudes_and_longitudes_say(body_file: Path) -> None:
    found = soils(body_file, {"far": {"longitude_deg": [170.0, -170.0], "grain": {"friction": 0.3}}})
    points = found.site.body.shape.surface_point(np.zeros(6), np.array([169.0, 171.0, 180.0, -171.0, -169.0, 0.0]))
    assert found.at(points) == [ELSEWHERE, "far", "far", "far", ELSEWHERE, ELSEWHERE]


def test_slopes_are_those_of_gravity_and_rotation(body_file: Path) -> None:
    # On a ball that turns at w times the rate of a grazing orbit, squared, the ground at a latitude slopes by this.
    w = 0.6
    period = 2.0 * math.pi / math.sqrt(w * 6.6743e-11 * DENSITY * 4.0 / 3.0 * math.pi)

    def slope(latitude: np.ndarray) -> np.ndarray:
        return np.arctan2(w * np.sin(latitude) * np.cos(latitude), 1.0 - w * np.cos(latitude) ** 2)

    expected = float((slope(np.abs(np.arcsin(np.linspace(-1.0, 1.0, 100_001)))) > math.radians(20.0)).mean())
    region = {"slope_deg": [20.0, 180.0], "grain": {"friction": 0.3}}
    found = soils(body_file, {"steep": region}, site={"spin_period": period}).area_shares()["steep"]
    assert 0.2 < expected < 0.6
    assert found == pytest.approx(expected, abs=0.03)


def test_facets_are_those_of_the_file(body_file: Path, tmp_path: Path) -> None:
    (tmp_path / "ponds.csv").write_text("7\n\n12\n13\n")
    found = soils(body_file, {"ponds": {"facets": str(tmp_path / "ponds.csv"), "grain": {"friction": 0.3}}})
    shape = found.site.body.shape
    area = shape.facet_sizes**2
    assert found.area_shares()["ponds"] == pytest.approx(area[[7, 12, 13]].sum() / area.sum())
    assert found.at(shape.corners.mean(axis=1)[[7, 8, 13]]) == ["ponds", ELSEWHERE, "ponds"]


def test_a_further_region_changes_no_draw(body_file: Path) -> None:
    alone = soils(body_file, {"strip": STRIP}).drawn(range(6))["soil.strip.grain.friction"]
    grain = {**STRIP["grain"], "cohesion_force": {"distribution": "log_uniform", "lower": 1e-6, "upper": 1e-5}}
    drawn = soils(body_file, {"sink": SINK, "strip": {**STRIP, "grain": grain}}).drawn([5, 2])
    assert drawn["soil.strip.grain.friction"].tolist() == alone[[5, 2]].tolist()
    assert drawn["soil.sink.grain.restitution"].tolist() == [0.1, 0.1]
    assert len(set(alone.tolist())) == 6
    assert ((alone > 0.2) & (alone < 0.3)).all()


def test_every_touchdown_is_on_the_soil_of_its_place(made: StudyResults, body_file: Path) -> None:
    table = made.touchdowns
    north, east = table["latitude_deg"] > 0.0, table["longitude_deg"]
    strip = north & (east >= -20.0) & (east <= 60.0)
    expected = np.where(~north, "sink", np.where(strip, "strip", ELSEWHERE))
    assert table["soil"].tolist() == expected.tolist()
    assert set(expected.tolist()) == {"sink", "strip", ELSEWHERE}
    assert (table["grain.restitution"] == np.where(north, 0.5, 0.1)).all()
    study = with_site_gravity(read(body_file, {"sink": SINK, "strip": STRIP}))
    in_strip, design = Soils(Site(study)).drawn(range(COUNT))["soil.strip.grain.friction"], DrawnDesign(study)
    journey = table["journey"].astype(int)
    own = design.own_soils(np.arange(COUNT))["grain.friction"]
    # One draw of a journey for the strip, wherever it was before, and one for all other ground.
    assert table["grain.friction"].tolist() == np.where(strip, in_strip[journey], own[journey]).tolist()
    assert [n for n in range(COUNT) if len(set(table["soil"][journey == n].tolist())) > 1]


def test_landers_that_are_flown_down_meet_the_soil_of_where_they_come_down(body_file: Path) -> None:
    given = tables(body_file, {"sink": SINK, "strip": STRIP}, journey={"count": 2})
    given["bed"]["bed_count"] = 2
    given["delivery"] = {"latitude_deg": 0.0, "longitude_deg": 0.0, "frame": "body_fixed"}
    for pole, restitution in ((-1.0, 0.1), (1.0, 0.5)):
        # Straight down to a place beside the pole, 170 degrees east.
        down = {"position": [-10.0, 1.7, pole * (RADIUS + 2.0)], "velocity": [0.0, 0.0, -0.03 * pole]}
        flown = given | {"delivery": given["delivery"] | {"release": down}}
        design = DrawnDesign(with_site_gravity(StudySource.of_tables(flown).study))
        assert [row["grain.restitution"] for row in design.rows] == [restitution] * 2
        assert [row["grain.friction"] for row in design.rows] == design.own_soils(np.arange(2))[
            "grain.friction"
        ].tolist()


def test_a_soil_that_captures_holds_every_lander(made: StudyResults) -> None:
    results = made.results
    found, table = results.soils, made.touchdowns
    assert list(found) == ["sink", "strip", ELSEWHERE]
    assert sum(one.touchdowns for one in found.values()) == table.row_count
    assert sum(one.at_rest.share.value for one in found.values()) == pytest.approx(results.ends["at_rest"].share.value)
    sink, rest = found["sink"], found[ELSEWHERE]
    assert sink.rests.share.value == 1.0
    assert sink.rests.count == sink.touchdowns == (table["soil"] == "sink").sum()
    assert sink.area_share == pytest.approx(0.5, abs=2e-3)
    # Elsewhere a lander bounces at its first touchdown at least.
    assert rest.rests.share.value <= 0.5
    assert any(line.startswith("By soil: sink (50 % of the surface)") for line in results.answer)
    assert np.abs(np.array([point for line in sink.outlines for point in line])[:, 0]).max() < 1.0


def test_the_same_soil_changes_no_bit(body_file: Path, tmp_path: Path) -> None:
    few = {"journey": {"count": 4}, "bed": {"bed_count": 2}}
    everywhere = {"latitude_deg": [-90.0, 90.0], "grain": {"restitution": 0.5}}
    run_touchdowns(tables(body_file, {}, **few), tmp_path / "one")
    run_touchdowns(tables(body_file, {"all": everywhere}, **few), tmp_path / "all")
    for name in ("journeys.csv", "arcs.csv", "designs/drawn.csv", "designs/touchdowns.csv"):
        assert (tmp_path / "all" / name).read_bytes() == (tmp_path / "one" / name).read_bytes(), name
    plain, named = ((tmp_path / name / "touchdowns.csv").read_text().splitlines() for name in ("one", "all"))
    assert named == [f"{plain[0]},soil", *(f"{line},all" for line in plain[1:])]


def test_paths_in_the_copy_of_a_study_count_from_where_the_study_file_was(body_file: Path, tmp_path: Path) -> None:
    shutil.copy(body_file, tmp_path / "ball.obj")
    given = tables(body_file, {}, journey={"count": 4, "emulated_count": 0}, bed={"bed_count": 2})
    given["site"]["body"] = "ball.obj"
    (tmp_path / "study.toml").write_text(tomli_w.dumps(given))
    source = StudySource.read(tmp_path / "study.toml", function_identity(touchdown))
    run_study(source, tmp_path / "made" / "out", until="runs", worker_count=1, model=touchdown)
    found = StudyFolder.only_read(tmp_path / "made" / "out").source()
    assert found.study.site.body == str(tmp_path / "ball.obj")
    assert found.content == source.content


def test_the_plan_states_the_regions(body_file: Path, tmp_path: Path) -> None:
    found = planned_soils(Site(read(body_file, {"sink": SINK})))
    assert found.aim == "sink"
    assert found.line().startswith("Soils: sink 50.0 %, elsewhere 50.0 % of the surface; the aim point is in sink.")
    assert planned_soils(Site(read(body_file, {}))) is None


FRICTION = {"friction": 0.3}
WRONG: dict[str, tuple[dict[str, Any], str]] = {
    "no bounds": ({"a": {"grain": FRICTION}}, r"soil\.a has no bounds; allowed: one at least of latitude_deg"),
    "no soil": ({"a": {"latitude_deg": [0.0, 1.0], "grain": {}}}, r"soil\.a\.grain is empty"),
    "reversed": ({"a": {"latitude_deg": [1.0, 0.0], "grain": FRICTION}},
                 r"latitude_deg is .*write the smaller one first"),
    "no width": ({"a": {"longitude_deg": [10.0, 370.0], "grain": FRICTION}}, r"longitude_deg is \[10, 370\]; allowed"),
    "a size": ({"a": {"slope_deg": [0, 1], "grain": {"diameter": 0.1}}},
               r"soil\.a gives sizes of grains; allowed: materials"),
    "a name": ({"elsewhere": {"slope_deg": [0, 1], "grain": FRICTION}}, r"soil\.elsewhere is no name"),
    "a range": ({"a": {"slope_deg": [0, 1], "grain": {"restitution": 1.5}}},
                r"soil\.a\.grain\.restitution is 1\.5; allowed"),
    "soft": ({"a": {"slope_deg": [0, 1], "grain": {"young_modulus": 1e-3}}}, r"soil\.a: delivery\.speed reaches"),
    "no file": ({"a": {"facets": "/nowhere.csv", "grain": FRICTION}}, r"soil\.a\.facets: /nowhere\.csv: No such file"),
}  # fmt: skip


@pytest.mark.parametrize("case", WRONG)
def test_a_study_of_no_such_regions_is_refused(case: str, body_file: Path) -> None:
    soil, words = WRONG[case]
    with pytest.raises(StudyError, match=words):
        read(body_file, soil)


def test_lines_of_facets_are_numbers(body_file: Path, tmp_path: Path) -> None:
    path = tmp_path / "ponds.csv"
    path.write_text("facet\n3\n")
    with pytest.raises(StudyError, match=r'line 1 is "facet"; allowed: a whole number from 0'):
        read(body_file, {"a": {"facets": str(path), "grain": FRICTION}})
    path.write_text("3\n")
    assert read(body_file, {"a": {"facets": str(path), "grain": FRICTION}}).soil["a"].has_bounds


def test_regions_without_ground_are_refused_before_anything_runs(body_file: Path, tmp_path: Path) -> None:
    count = 8 * FREQUENCY**2
    (tmp_path / "ponds.csv").write_text(f"{count}\n")
    with pytest.raises(StudyError, match=rf"soil\.a\.facets has {count}; allowed: 0 to {count - 1}"):
        soils(body_file, {"a": {"facets": str(tmp_path / "ponds.csv"), "grain": FRICTION}}).refuse()
    hidden = {"a": SINK, "b": {"latitude_deg": [-30.0, -20.0], "grain": FRICTION}}
    with pytest.raises(StudyError, match=r"^study\.toml: soil\.b holds no ground of this body"):
        run_touchdowns(tables(body_file, hidden), tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_one_landing_names_no_grains_of_a_soil_by_region(body_file: Path) -> None:
    with pytest.raises(ValueError, match=r"--set names grain\.friction; allowed: no key of grain"):
        landing_inputs(read(body_file, {"sink": SINK}), ["grain.friction=0.4"])


def test_status_counts_touchdowns_on_every_soil(made: StudyResults, tmp_path: Path) -> None:
    folder = tmp_path / "half"
    shutil.copytree(made.folder, folder)
    # Until the tables of the journeys are there the ledger alone says which touchdowns are theirs.
    for name in ("journeys.csv", "touchdowns.csv", "arcs.csv"):
        (folder / name).unlink()
    found = study_status(folder).runs
    assert (found.others, found.journeys.touchdowns) == (0, made.touchdowns.row_count)


def test_landers_of_the_emulator_meet_the_soils_as_those_of_the_landings_do(made: StudyResults) -> None:
    emulated = made.results.emulated
    assert emulated is not None
    assert (emulated.why, emulated.count) == (None, 200)
    # All journeys of the landings end at rest.
    assert emulated.ends["at_rest"].share.value > 0.95
    assert emulated.unknown < 0.05
    assert emulated.agrees


def test_the_soil_of_every_region_is_an_input_of_the_scatter(body_file: Path) -> None:
    given = read(body_file, {"sink": SINK, "strip": STRIP}, journey={"count": 64}, bed={"bed_count": 4})
    study, nothing = with_site_gravity(given), None
    job = Job(DrawnDesign(study), {}, cast(Any, nothing), cast(Any, nothing), Silent())
    rows, words = job.design.rows, [""] * 64
    runs = DesignRuns(words, words, words, {name: np.array([row[name] for row in rows]) for name in rows[0]}, {})
    # What the strip alone decides is told of all journeys, whether they begin in there or not.
    friction, more = Soils(job.site).drawn(range(64))["soil.strip.grain.friction"], np.sin(7.0 * np.arange(64))
    decided = 10.0 * friction + 0.05 * more
    found = parts_of_variance(job, runs, decided, "all runs")
    assert set(found.soil_by_input) == {"grain.friction", "soil.strip.grain.friction"}
    assert found.soil_by_input["soil.strip.grain.friction"].value > 0.8
    assert found.soil_by_input["grain.friction"].value < 0.2
