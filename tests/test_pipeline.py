"""The pipeline: what depends on what, how runs are drawn, which inputs are kept, and a whole tiny study."""

import math
import re
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lithobrake.chaos import Uniform, fit, smolyak
from lithobrake.pipeline import STAGES, StudyFolder, stage_keys
from lithobrake.pipeline.answer.run_answers import scope
from lithobrake.pipeline.answer.sample_results import limited_shares, return_fraction
from lithobrake.pipeline.answer.study_summary import study_tables
from lithobrake.pipeline.design.arrivals import place_region
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.design.random_inputs import draw
from lithobrake.pipeline.expansion.expansions import kept_inputs, points
from lithobrake.pipeline.first_touchdown.flights import COLUMNS, starts
from lithobrake.pipeline.first_touchdown.samples import SAMPLE_OUTCOMES, Samples
from lithobrake.pipeline.site import Site, with_site_gravity
from lithobrake.smallbody.bounce import COUNTS, EDGES
from lithobrake.study import Study, StudyError, check_tables
from lithobrake.touchdown.touchdown_model import acceleration
from lithobrake.vocabulary.quantities import FOLLOWED, ORIENTATION, OUTPUTS, PLACE

from .paper_tables import paper_tables, with_keys


def changed(**sections: dict[str, Any]) -> Study:
    return with_site_gravity(check_tables(with_keys(paper_tables(), sections), Path()))


UNIFORM = {"distribution": "uniform", "lower": 0.1, "upper": 0.3}

# The range of the friction has the median of the template to the last bit, which is what the beds have.
REMADE = [
    ({"bed": {"grain_count": 151}}, "bed"), ({"surface": {"gravity": 4e-5}}, "bed"),
    ({"impact": {"speed": 0.25}}, "landing"), ({"contact": {"pair_rule": "mean"}}, "bed"),
    ({"grain": {"friction": {"distribution": "uniform", "lower": 0.35, "upper": 0.85}}}, "screening_runs"),
    ({"expansion": {"screening_level": 3}}, "screening_runs"), ({"expansion": {"fit": "best"}}, "screen"),
    ({"expansion": {"points": "sobol_sequence", "screening_count": 40, "refined_count": 60}}, "screening_runs"),
    ({"expansion": {"kept_share": 0.8}}, "refined_runs"), ({"expansion": {"test_count": 11}}, "test_runs"),
    ({"monte_carlo": {"sample_count": 200}}, "sample"), ({"monte_carlo": {"scatter": True}}, "sample"),
    ({"site": {"heading_deg": 10.0}}, "fly"), ({"flight": {"flight_count": 7}}, "fly"),
    ({"site": {"partner": False}}, "fly"), ({"lander": {"mass": 3.0}}, "landing"),
    ({"site": {"east_error": 10.0}}, "fly"), ({"hard_ground": {"friction": 0.5}}, "hard_ground"),
]  # fmt: skip


@pytest.mark.parametrize(("change", "first"), REMADE, ids=[str(change) for change, _ in REMADE])
def test_a_change_makes_again_what_depends_on_it_and_nothing_before(change: dict[str, Any], first: str) -> None:
    before, after = stage_keys(changed()), stage_keys(changed(**change))
    names = [stage.name for stage in STAGES if stage.files(changed(**change))]
    different = [name for name in names if before[name] != after[name]]
    assert different[0] == first
    assert set(names[names.index("summary") :]) <= set(different)
    # The landing at the medians hangs on no design and hard ground on no sample, so they may be left out of the row.
    apart = {"landing", "hard_ground"} - {first}
    assert [one for one in different if one not in apart] == [
        one for one in names[names.index(first) :] if one not in apart
    ]


def test_the_title_alone_changes_only_the_summary_and_the_report() -> None:
    before, after = stage_keys(changed()), stage_keys(changed().model_copy(update={"title": "another"}))
    assert [name for name in before if before[name] != after[name]] == ["summary", "report"]


def test_a_file_is_current_until_it_or_its_key_changes(tmp_path: Path) -> None:
    folder = StudyFolder(tmp_path / "study")
    folder.write_json("scores.json", {"a": 1})
    folder.note("test", ["scores.json"], "key", 1.0)
    assert folder.is_current(["scores.json"], "key")
    assert not folder.is_current(["scores.json"], "other key")
    assert not folder.is_current(["scores.json", "refined.json"], "key")
    (folder / "scores.json").write_text('{"a": 2}')
    assert not folder.is_current(["scores.json"], "key")
    (folder / "scores.json").unlink()
    assert not folder.is_current(["scores.json"], "key")


def test_a_folder_has_one_coordinator(tmp_path: Path) -> None:
    busy = pytest.raises(ValueError, match="another lithobrake is at work")
    with StudyFolder(tmp_path).alone(), busy, StudyFolder(tmp_path).alone():
        pass
    with StudyFolder(tmp_path).alone():
        pass


def test_json_without_nan(tmp_path: Path) -> None:
    folder = StudyFolder(tmp_path)
    with pytest.raises(ValueError, match="JSON"):
        folder.write_json("scores.json", {"a": float("nan")})
    assert not (folder / "scores.json").exists()


def test_draws_are_given_by_the_seed_and_what_is_fixed_is_not_drawn() -> None:
    study = changed()
    one = draw(study, study.touchdown_medians(), 5, None)
    assert one == draw(study, study.touchdown_medians(), 5, None)
    drawn = {name: value for name, value in one.items() if study.touchdown_medians().get(name) != value}
    assert drawn == {"bed": 0.0, **dict(zip(ORIENTATION, [1.0, 0.0, 0.0, 0.0], strict=True))}


def test_nuisances_are_drawn_in_their_ranges_and_evenly() -> None:
    region = {"x": [-0.1, 0.1], "y": [0.0, 0.05]}
    study = changed(
        bed={"bed_count": 3}, impact={"place": None, "region": region, "azimuth_deg": "random", "orientation": "random"}
    )
    draws = [draw(study, study.touchdown_medians(), seed, place_region(study)) for seed in range(3000)]
    places = np.array([[one[name] for name in PLACE] for one in draws])
    assert np.bincount([round(one["bed"]) for one in draws]).tolist() == pytest.approx([1000] * 3, abs=100)
    assert places.min(axis=0) == pytest.approx([-0.1, 0.0], abs=1e-3)
    assert places.max(axis=0) == pytest.approx([0.1, 0.05], abs=1e-3)
    assert np.mean([one["impact.azimuth_deg"] for one in draws]) == pytest.approx(180, abs=8)
    # For rotations drawn evenly, each squared component of the quaternion has the mean 1/4.
    quaternions = np.array([[one[name] for name in ORIENTATION] for one in draws])
    assert np.mean(quaternions**2, axis=0) == pytest.approx([0.25] * 4, abs=0.02)


def test_one_more_bed_takes_its_share_of_runs_and_leaves_the_others_as_they_are() -> None:
    random = {"azimuth_deg": "random", "orientation": "random"}
    studies = [changed(bed={"bed_count": count}, impact=random) for count in (2, 3)]
    pairs = [tuple(draw(one, one.touchdown_medians(), seed, None) for one in studies) for seed in range(900)]
    moved = [after for before, after in pairs if before != after]
    assert {one["bed"] for one in moved} == {2.0}
    assert len(moved) == pytest.approx(300, abs=45)


def test_a_slope_tilts_the_acceleration_downhill() -> None:
    values = {"surface.slope_deg": 30.0, "surface.slope_azimuth_deg": 90.0}
    assert acceleration(values, 2.0) == pytest.approx((0.0, 1.0, -np.sqrt(3.0)))


def test_kept_is_the_smallest_set_that_explains_enough_of_every_deciding_output() -> None:
    inputs = {name: Uniform(-1, 1) for name in "abc"}
    x = smolyak(inputs, level=2)
    first, second = x[:, 0] + 0.1 * x[:, 2], x[:, 1] + 0.3 * x[:, 2]
    y = np.column_stack([first, second, x[:, 0], x[:, 0], x[:, 0], x[:, 2]])
    surrogate = fit(inputs, x, y, degree=2, output_names=OUTPUTS)

    def kept(share: float, outputs: list[str]) -> tuple[str, ...]:
        return kept_inputs(changed(expansion={"kept_share": share, "kept_outputs": outputs}), surrogate)

    assert kept(0.9, ["speed_out"]) == ("a",)
    assert kept(0.9, ["speed_out", "elevation_out"]) == ("a", "b")
    assert kept(0.95, ["speed_out", "elevation_out"]) == ("a", "b", "c")
    assert kept(0.5, ["velocity_out_z", "speed_out"]) == ("a", "c")


def test_inputs_that_are_not_kept_stand_at_their_median_and_nodes_are_shared() -> None:
    study = changed()
    inputs = DrawnDesign(study).inputs
    names, kept = list(inputs), ["grain.friction", "grain.restitution"]
    refined, screening = points(DrawnDesign(study), "refined", kept), points(DrawnDesign(study), "screening", ())
    for column, name in enumerate(names):
        assert (np.unique(refined[:, column]) == inputs[name].median).all() == (name not in kept)
    shared = {tuple(row) for row in refined.tolist()} & {tuple(row) for row in screening.tolist()}
    # Level 2 in two inputs has 13 nodes; they are nested in level 3 and in the five inputs of the screening.
    assert len(shared) == 13


def made_samples(*outcomes: str) -> Samples:
    """Samples with these outcomes, which leave at (4, 5, 6) m/s."""
    speed, elevation = math.sqrt(77.0), math.atan2(6.0, math.hypot(4.0, 5.0))
    outputs = np.tile([speed, elevation, 3.0, 4.0, 5.0, 6.0], (len(outcomes), 1))
    drawn = np.array([SAMPLE_OUTCOMES.index(outcome) for outcome in outcomes])
    return Samples.of(["a"], OUTPUTS, np.zeros((len(outcomes), 1)), outputs, drawn)


def test_the_first_samples_that_leave_fly_each_from_its_own_site() -> None:
    study = changed(flight={"flight_count": 2}, site={"latitude_deg": UNIFORM})
    one = starts(Site(study), made_samples("clear", "captured", "clear", "clear"))
    assert (one.sample.tolist(), one.velocity) == ([0, 2], pytest.approx(np.array([[4.0, 5.0, 6.0]] * 2)))
    assert ((one.site["latitude_deg"] > 0.1) & (one.site["latitude_deg"] < 0.3)).all()
    more = starts(
        Site(changed(flight={"flight_count": 3}, site={"latitude_deg": UNIFORM})), made_samples(*["clear"] * 4)
    )
    assert more.site["latitude_deg"][[0, 2]].tolist() == one.site["latitude_deg"].tolist()


def test_drawn_velocities_have_the_drawn_speed_and_elevation_and_impossible_draws_are_a_class() -> None:
    generator = np.random.default_rng(0)
    outputs = np.column_stack([generator.normal(0.1, 0.05, 500), generator.normal(0.8, 0.8, 500), np.ones(500)])
    outputs = np.hstack([outputs, generator.normal(0.0, 0.01, (500, 3))])
    samples = Samples.of([], OUTPUTS, np.empty((500, 0)), outputs, np.zeros(500, dtype=int))
    velocity = np.column_stack([samples.output(f"velocity_out_{axis}") for axis in "xyz"])
    speed, elevation = samples.output("speed_out"), samples.output("elevation_out")
    assert np.linalg.norm(velocity, axis=1) == pytest.approx(np.abs(speed), rel=1e-12)
    going = samples.leaves
    assert np.arcsin(velocity[going, 2] / speed[going]) == pytest.approx(elevation[going])
    assert (velocity[going, 2] > 0.0).all()
    # The azimuth is that of the horizontal components as they were drawn.
    assert np.arctan2(velocity[going, 1], velocity[going, 0]) == pytest.approx(
        np.arctan2(outputs[going, 4], outputs[going, 3])
    )
    impossible = (speed <= 0.0) | (elevation <= 0.0) | (elevation > math.pi / 2)
    assert 50 < impossible.sum() < 250
    assert (samples.outcome == SAMPLE_OUTCOMES.index("outside")).tolist() == impossible.tolist()


def test_shares_have_a_class_for_each_end_no_interval_and_no_sample_after_the_last_that_flew() -> None:
    outcomes = ("clear", "captured", "left_sideways", "outside", "time_limit", "clear", "captured", "clear")
    flown = [{"sample": "0", "status": "impact"}, {"sample": "5", "status": "escaped"}]
    found = limited_shares(made_samples(*outcomes), flown, Counter(clear=50, captured=1), "One bed.", holds=True)
    assert (found.sample_count, found.level, found.why) == (6, 0.95, "One bed.")
    table = found.outcomes
    ends = ("captured", "left_sideways", "time_limit", "outside", "impact", "flying", "escaped", "partner")
    assert [table[name].count for name in ends] == [1, 1, 1, 1, 1, 0, 1, 0]
    assert (table["returns"].count, table["missing"].count) == (2, 3)
    assert (table["returns"].share.lower, table["returns"].share.upper) == (None, None)
    # Of 51 runs none left sideways or ran out of time: that allows 5.7 % (rule of three).
    assert table["left_sideways"].upper_limit == pytest.approx(1.0 - 0.05 ** (1 / 51))
    assert table["captured"].upper_limit is None
    # What is captured where the site pushes outwards is lifted off again.
    away = limited_shares(made_samples(*outcomes), flown, Counter(clear=50, captured=1), "One bed.", holds=False)
    assert away.outcomes["returns"].count == 1


def test_the_answer_says_over_what_it_holds_and_flights_do_not_narrow_it() -> None:
    study = changed(site={"latitude_deg": 75.0})
    flown = [{"sample": "0", "status": "impact"}] * 3
    table = limited_shares(made_samples(*["clear"] * 3, "captured"), flown, {"clear": 40}, None, holds=True)
    found = return_fraction(study, table, 40)
    assert (found.share.lower, found.share.upper, found.next_bed, found.share.level) == (None, None, None, 0.9)
    assert found.why == scope(study).why
    assert (found.from_, found.missing) == ("4 samples of an expansion fitted to 40 landings on 1 bed", 0.0)
    assert found.if_missing == (1.0, 1.0)


@pytest.mark.parametrize(("bed", "impact", "where"), [
    ({}, {}, "On this bed, at this impact point"),
    ({"bed_count": 6}, {}, "At this impact point"),
    ({}, {"place": None, "region": {"x": [0.0, 0.1], "y": [0.0, 0.1]}}, "On this bed"),
    ({"bed_count": 6}, {"place": None, "region": {"x": [0.0, 0.1], "y": [0.0, 0.1]}}, "In this attitude"),
    ({"bed_count": 6}, {"place": None, "region": {"x": [0.0, 0.1], "y": [0.0, 0.1]}, "orientation": "random"},
     "On these 6 beds, at random impact points and attitudes"),
])  # fmt: skip
def test_the_scope_names_what_all_runs_have_in_common(bed: dict[str, Any], impact: dict[str, Any], where: str) -> None:
    found = scope(changed(bed=bed, impact=impact))
    assert found.where == where
    expected = "no interval" if "random" in where else "this study cannot show by how much"
    assert expected in found.why


def test_a_heading_over_the_circle_has_no_median() -> None:
    circle = {"distribution": "uniform", "lower": 0.0, "upper": 360.0}
    half = {"distribution": "uniform", "lower": 0.0, "upper": 180.0}
    given = [Site(changed(site={"heading_deg": heading})).has_heading for heading in (30.0, half, circle)]
    assert given == [True, True, False]


def test_the_study_in_the_summary_reads_back_as_the_same_study() -> None:
    study = changed(impact={"place": None, "region": {"x": [-0.1, 0.1], "y": [-0.1, 0.1]}})
    tables = study_tables(study)
    assert tables["grain"]["friction"] == {"distribution": "uniform", "lower": 0.3, "upper": 0.9}
    without_absent = {
        key: {name: entry for name, entry in value.items() if entry is not None} if isinstance(value, dict) else value
        for key, value in tables.items()
    }
    assert check_tables(without_absent, Path()) == study


def test_every_column_of_the_flights_is_documented() -> None:
    text = (Path(__file__).parents[1] / "docs" / "flights.md").read_text(encoding="utf-8")
    assert _names_in_table(text, "column") == [*COLUMNS]
    assert _names_in_table(text, "column of `rest.csv`") == [*FOLLOWED]
    assert _names_in_table(text, "column of `restitution.csv`") == RESTITUTION_NAMES


def _names_in_table(text: str, heading: str) -> list[str]:
    """What stands as code in the first cells of the only table whose first column has this heading."""
    (table,) = re.findall(rf"^\| {re.escape(heading)} \|.*\n((?:\|.*\n)+)", text, flags=re.MULTILINE)
    cells = [line.split("|")[1] for line in table.splitlines()]
    return [name for cell in cells for name in re.findall(r"`(\w+)[`.]", cell)]


# Of each of the four quantities that have quantiles the table names the first.
RESTITUTION_NAMES = [*(name.partition(" ")[0] for name in EDGES), *COUNTS, "normal_restitution_q0", "_q1",
    "tangential_restitution_q", "azimuth_deg_q", "friction_q"]  # fmt: skip


def test_the_partner_stands_where_the_sample_says() -> None:
    study = changed(site={"partner_longitude_deg": 77.0, "spin_period": 8000.0})
    site = starts(Site(study), made_samples("clear")).site
    body = Site(study).body
    angle = body.orbit.angle + body.orbit.rate * Site(study).clock(site)[0]
    assert math.degrees(angle) % 360.0 == pytest.approx(77.0)
    assert np.ptp(starts(Site(changed()), made_samples(*["clear"] * 40)).site["partner_longitude_deg"]) > 180.0
    assert Site(changed(site={"partner": False})).body.partner is None


def test_the_delivery_error_moves_the_start_along_the_ground() -> None:
    site = Site(changed(site={"latitude_deg": 20.0, "longitude_deg": 10.0, "north_error": 30.0, "east_error": -40.0}))
    body, (origin, _) = site.body, site.frames(site.columns(1))
    aim, axes = body.local_frame(20.0, 10.0)
    moved = axes @ (origin[0] - aim)
    # The ground is not plane: it falls off by some metres over 50 m.
    assert moved[:2] == pytest.approx([30.0, 40.0], abs=3.0)
    assert abs(body.shape.height(origin[0])) < 1e-9


def test_the_acceleration_of_the_site_is_offered_to_the_touchdown() -> None:
    """At the published site the ground pushes outwards; near a pole it holds, and there is nothing to warn of."""
    site = {"surface": {"gravity": "site"}, "bed": {"settle_gravity": 2e-5}}
    equator = changed(**site, site={"latitude_deg": 0.0, "longitude_deg": 0.0})
    assert equator.surface.gravity == pytest.approx(-Site(equator).acceleration[2])
    assert equator.surface.gravity < 0.0
    assert "push outward" in Site(equator).warning
    pole = changed(**site, site={"latitude_deg": 80.0})
    assert 1.8e-4 < pole.surface.gravity < 2.6e-4
    assert Site(pole).warning is None
    assert pole.touchdown_medians()["surface.gravity"] == pole.surface.gravity
    with pytest.raises(StudyError, match="settle_gravity"):
        changed(surface={"gravity": "site"}, site={"latitude_deg": 0.0})
    with pytest.raises(StudyError, match="no such file"):
        changed(surface={"gravity": "site"}, site={"body": "absent.obj"})
