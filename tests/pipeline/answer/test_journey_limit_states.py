"""Limit states of whole journeys, and the mean miss, against laws in closed form."""

import math
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from lithobrake.analysis.ground_spread import share_over_grounds
from lithobrake.analysis.mean_over_grounds import mean_over_grounds
from lithobrake.analysis.output_estimates import quantile_estimate
from lithobrake.analysis.subset_simulation import limit_state_met
from lithobrake.pipeline.answer import journey_ends, journey_limit_states, question_answers
from lithobrake.pipeline.answer.emulated_ends import EmulatedTable
from lithobrake.pipeline.answer.journey_ends import JourneyTable, end_share
from lithobrake.pipeline.answer.journey_limit_states import journey_limit_state, rest_values
from lithobrake.pipeline.answer.mean_miss import mean_miss, offsets
from lithobrake.pipeline.answer.question_answers import limit_state_results
from lithobrake.statements.journeys import mean_miss as miss_words
from lithobrake.statements.limits import limit_state, met_words
from lithobrake.vocabulary.limit_state import LimitState

from ..few_terms import REFITS

# A ball so large that its ground is flat where landers rest [m].
RADIUS, AIM = 1e6, (30.0, 40.0)
SIGMA, BEDS, EACH = 15.0, 24, 8
COUNT = BEDS * EACH
BED = np.arange(COUNT) % BEDS
SITE: Any = SimpleNamespace(aim=AIM, aim_radius=RADIUS)
NAN = math.nan


def within(radius: float) -> float:
    """Probability of a distance below it, of independent normal errors of SIGMA east and north (Rayleigh)."""
    return 1.0 - math.exp(-0.5 * (radius / SIGMA) ** 2)


def rested(east: np.ndarray, north: np.ndarray, end: np.ndarray | None = None) -> JourneyTable:
    """Landers at rest so far east and north of the aim point [m]."""
    latitude = AIM[0] + np.degrees(north / RADIUS)
    longitude = AIM[1] + np.degrees(east / (RADIUS * np.cos(np.radians(latitude))))
    ends = np.full(len(east), "at_rest") if end is None else end
    numbers = {"distance": np.hypot(east, north), "latitude_deg": latitude, "longitude_deg": longitude}
    numbers |= {"time_s": np.full(len(east), 600.0), "touchdowns": np.ones(len(east))}
    bed = BED if len(east) == COUNT else np.arange(len(east)) % BEDS
    return JourneyTable(ends, bed, numbers, np.zeros((len(east), 3)), np.full(len(east), "+z"))


@pytest.fixture
def job(monkeypatch: pytest.MonkeyPatch) -> Any:
    """What the answers read of a study of one ground without an emulator and without inputs."""
    study = SimpleNamespace(
        ground=None,
        lander=SimpleNamespace(is_ball=False),
        journey=SimpleNamespace(emulated_count=0, touchdowns=None),
        seed=1,
    )
    monkeypatch.setattr(journey_limit_states, "why_no_interval", lambda study: None)
    monkeypatch.setattr("lithobrake.pipeline.answer.mean_miss.why_no_interval", lambda study: None)
    monkeypatch.setattr(journey_limit_states, "_inputs", lambda job, met, table: {})
    return SimpleNamespace(study=study, site=SITE, folder=None, design=None)


def test_normal_scatter_rests_within_a_distance_as_rayleigh_has_it(job: Any) -> None:
    """Of 200 studies of 192 journeys on 24 beds nine in ten intervals hold 1 - exp(-R2 / 2 sigma2)."""
    random, held, values = np.random.default_rng(3), [], []
    for _ in range(200):
        table = rested(*random.normal(0.0, SIGMA, (2, COUNT)))
        found = journey_limit_state(job, "near", LimitState.of("distance < 20"), table).probability
        assert found.bounds is not None
        held.append(found.bounds[0] <= within(20.0) <= found.bounds[1])
        values.append(found.value)
    assert np.mean(values) == pytest.approx(within(20.0), abs=0.008)
    assert 0.85 <= np.mean(held) <= 0.96


def test_journeys_of_unknown_end_bound_the_first_page(monkeypatch: pytest.MonkeyPatch) -> None:
    """Three in ten of those that would not rest have failed: value without them, bounds whatever they came to."""
    monkeypatch.setattr(journey_ends, "why_no_interval", lambda study: None)
    end = np.repeat(["at_rest", "under_way", "failed"], [144, 34, 14])[np.random.default_rng(8).permutation(COUNT)]
    table = rested(*np.random.default_rng(9).normal(0.0, SIGMA, (2, COUNT)), end)
    found = journey_ends.end_shares(Any, table)
    rests, failed = found["at_rest"], found["failed"]
    assert (rests.count, failed.count) == (144, 14)
    assert rests.share.value == pytest.approx(144 / 178)
    assert rests.share.lower < 144 / COUNT < 158 / COUNT < rests.share.upper
    assert sum(one.share.value for name, one in found.items() if name != "failed") == pytest.approx(1.0)
    distance = np.where(end == "at_rest", table.numbers["distance"], np.nan)
    plain = quantile_estimate(distance, BED, 0.5)
    median = quantile_estimate(distance, BED, 0.5, missing=table.unknown)
    assert median.lower < plain.lower
    assert median.upper > plain.upper


def test_regions_and_their_parts_are_told_by_latitude_and_longitude(job: Any) -> None:
    """The quarter north and east of the aim has a quarter of the landers, and half of those lie within the median."""
    table, median = rested(*np.random.default_rng(4).normal(0.0, SIGMA, (2, 20_000))), SIGMA * math.sqrt(math.log(4.0))
    quarter = LimitState.of(f"latitude_deg > {AIM[0]} and longitude_deg > {AIM[1]}")
    part = LimitState.of(f"latitude_deg > {AIM[0]} and longitude_deg > {AIM[1]} and distance < {median}")
    shares = [journey_limit_state(job, "part", state, table).probability.value for state in (quarter, part)]
    assert shares == pytest.approx([0.25, 0.125], abs=0.01)


def test_who_does_not_rest_is_not_within_and_who_failed_makes_bounds(job: Any) -> None:
    end = np.full(COUNT, "at_rest")
    end[:40], end[40:60], end[60:70] = "escaped", "under_way", "failed"
    table = rested(np.full(COUNT, 3.0), np.zeros(COUNT), end)
    found = journey_limit_state(job, "near", LimitState.of("distance < 20"), table)
    known = COUNT - 10
    assert found.probability.value == pytest.approx((known - 60) / known)
    assert found.runs.if_missing == pytest.approx(((known - 60) / COUNT, (COUNT - 60) / COUNT))
    assert found.probability.lower < found.runs.if_missing[0] < found.runs.if_missing[1] < found.probability.upper
    assert found.failing_runs == known - 60
    assert found.runs.from_ == f"{known} of {COUNT} journeys on {BEDS} beds"
    missed = journey_limit_state(job, "missed", LimitState.of("not distance < 20"), table)
    assert missed.probability.value == pytest.approx(60 / known)


@pytest.mark.parametrize(("condition", "share"), [("at_rest", (30, 30, 40)), ("not at_rest", (20, 20, 30))])
def test_a_failed_journey_is_neither_at_rest_nor_not(
    job: Any, monkeypatch: pytest.MonkeyPatch, condition: str, share: tuple[int, int, int]
) -> None:
    """Of 60 landers 30 rest, 20 escape and 10 fail: 30 of 50, and at least 30 and at most 40 of 60."""
    end = np.repeat(["at_rest", "escaped", "failed"], [30, 20, 10])
    table = replace(rested(np.zeros(60), np.zeros(60), end), bed=np.arange(60) % 12)
    job.study.limit_states = SimpleNamespace(conditions=lambda: {"down": condition})
    for name in ("DesignRuns", "RunFlights", "JourneyTable"):
        loaded = table if name == "JourneyTable" else SimpleNamespace(fates=None)
        monkeypatch.setattr(question_answers, name, SimpleNamespace(load=lambda *of, found=loaded: found))
    monkeypatch.setattr(question_answers, "_values_of_samples", lambda job: {})
    found = limit_state_results(job, {}, {"at_rest": end_share(table.rests, table.bed)})["down"]
    met, least, most = share
    assert found.probability.value == pytest.approx(met / 50)
    assert found.runs.if_missing == pytest.approx((least / 60, most / 60))
    assert found.probability.lower < least / 60 < most / 60 < found.probability.upper


def test_a_condition_is_decided_by_what_is_known_of_a_journey() -> None:
    end = np.array(["at_rest", "at_rest", "partner", "under_way", "failed", "unknown"])
    numbers = {name: np.array([5.0, 50.0, 5.0, 5.0, NAN, NAN]) for name in ("distance", "time_s")}
    values = rest_values(end, numbers, np.array(["+z", "-x", "+z", "", "", ""]))
    expected: list[tuple[str, list[float]]] = [
        ("distance < 20", [1, 0, 0, 0, NAN, NAN]), ("not distance < 20", [0, 1, 1, 1, NAN, NAN]),
        ("face == +z or face == -z", [1, 0, 0, 0, NAN, NAN]), ("face != +z", [0, 1, 1, 1, NAN, NAN]),
        ("at_rest", [1, 1, 0, 0, NAN, NAN]), ("partner or at_rest", [1, 1, 1, 0, NAN, NAN]),
        ("under_way and distance > 0", [0, 0, 0, 0, NAN, NAN]),
        ("partner and not at_rest", [0, 0, 1, 0, NAN, NAN]),
        ("distance < 20 and face == +z", [1, 0, 0, 0, NAN, NAN]),
        # Nothing is known of the tilt of any: only the distance decides.
        ("tilt_deg < 5 and distance < 20", [NAN, 0, 0, 0, NAN, NAN]),
    ]  # fmt: skip
    for text, met in expected:
        assert limit_state_met(LimitState.of(text), values).tolist() == pytest.approx(met, nan_ok=True), text


@pytest.mark.parametrize(("of_touchdown", "of_journey"), [
    ("escaped", "escaped and not at_rest"), ("partner", "partner and not at_rest"),
    ("contacts < 3", "contacts < 3 and at_rest"),
])  # fmt: skip
def test_words_of_both_are_of_the_first_touchdown_unless_another_is_of_the_journey(
    of_touchdown: str, of_journey: str
) -> None:
    assert not LimitState.of(of_touchdown).journey
    assert {*LimitState.of(of_journey).journey} == {of_touchdown.split()[0], "at_rest"}


def test_the_emulator_answers_by_the_same_code(job: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    random, count = np.random.default_rng(5), 20_000
    drawn = rested(*random.normal(0.0, SIGMA, (2, count)))
    end = drawn.end.astype(object)
    end[:1000] = "unknown"
    fresh = EmulatedTable(
        np.arange(count), np.arange(count) % REFITS, end, np.zeros(count, bool), np.zeros(count), drawn.numbers
    )
    monkeypatch.setattr(journey_limit_states.EmulatedTable, "load", lambda folder, landers: fresh)
    monkeypatch.setattr(journey_limit_states, "why_no_emulator", lambda content: None)
    job.study.journey.emulated_count, job.folder = count, SimpleNamespace(read_json=lambda name: {})
    table = rested(*random.normal(0.0, SIGMA, (2, COUNT)))
    found = journey_limit_state(job, "near", LimitState.of("distance < 20"), table)
    assert found.emulator is not None
    assert found.emulator.value == pytest.approx(within(20.0), abs=0.012)
    # A twentieth has an unknown outcome: the bounds hold whatever became of these.
    assert found.emulator.upper - found.emulator.lower > 0.05
    assert found.agrees
    assert "the emulator gives" in limit_state("near", found)
    # Landings that are followed for one touchdown only are no journeys to rest, as those of the emulator are.
    job.study.journey.touchdowns = 1
    assert journey_limit_state(job, "near", LimitState.of("distance < 20"), table).agrees is None
    # A tenth of a per cent of the landers lies so far out: the journeys have none, and the emulator tells.
    far = journey_limit_state(job, "far", LimitState.of("distance > 55.8"), table)
    assert (far.source, far.probability.value) == ("runs", 0.0)
    assert far.emulator is not None
    assert far.emulator.value == pytest.approx(1.0 - within(55.8), abs=0.0007)
    # What the emulator does not know of its landers it does not answer.
    assert journey_limit_state(job, "up", LimitState.of("face == +z"), table).emulator is None


def test_on_unknown_ground_the_answer_has_the_interval_of_one_ground(job: Any) -> None:
    """On every second bed no lander rests near: one ground gives nothing or all, which the mean over grounds hides."""
    east = np.where(BED % 2 == 0, 5.0, 50.0)
    table = rested(east, np.zeros(COUNT))
    kinds = [SimpleNamespace(kind="fine" if bed % 2 == 0 else "coarse") for bed in range(BEDS)]
    job.study.ground = SimpleNamespace(unknown="everywhere", kind={"fine": None, "coarse": None})
    job.design = SimpleNamespace(grounds=SimpleNamespace(each=kinds))
    found = journey_limit_state(job, "near", LimitState.of("distance < 20"), table)
    assert found.over_grounds == share_over_grounds((east < 20.0).astype(float), BED)
    assert (found.grounds["fine"].value, found.grounds["coarse"].value) == (1.0, 0.0)
    said = limit_state("near", found)
    assert "over the grounds that the study allows" in said
    assert "By kind of ground: fine 100 %" in said
    # On patches landers of a bed of one kind meet the others.
    for unknown in ("patchy", "both"):
        job.study.ground.unknown = unknown
        assert journey_limit_state(job, "near", LimitState.of("distance < 20"), table).grounds == {}


def test_words_are_those_of_the_question(job: Any) -> None:
    table = rested(*np.random.default_rng(6).normal(0.0, SIGMA, (2, COUNT)))
    found = journey_limit_state(job, "near", LimitState.of("20 >= distance"), table)
    assert met_words("near", found) == "come to rest within 20 m of the aim point"
    other = journey_limit_state(job, "late", LimitState.of("time_s > 500"), table)
    assert met_words("late", other) == "meet late (time_s > 500)"
    assert (found.radius_m, other.radius_m) == (20.0, None)


@pytest.mark.parametrize(("east", "north"), [(12.0, -5.0), (-20.0, 8.0)])
def test_the_mean_miss_is_that_of_the_scatter_and_says_where_to_aim(job: Any, east: float, north: float) -> None:
    random = np.random.default_rng(7)
    table = rested(random.normal(east, SIGMA, COUNT), random.normal(north, SIGMA, COUNT))
    found = mean_miss(job, table)
    assert found is not None
    error = 1.645 * SIGMA / math.sqrt(COUNT)
    for one, truth in ((found.east_m, east), (found.north_m, north)):
        assert one.value == pytest.approx(truth, abs=2.5 * error)
        assert 0.5 * (one.upper - one.lower) == pytest.approx(error, rel=0.4)
    assert found.is_distinct
    # The aim is as far from the aim point as the mean, the other way.
    latitude, longitude = np.array([found.aim_latitude_deg]), np.array([found.aim_longitude_deg])
    assert offsets(SITE, latitude, longitude)[0] == pytest.approx([-found.east_m.value, -found.north_m.value], abs=1e-6)
    way = "west" if east > 0.0 else "east"
    assert f" m {way} and " in miss_words(found)
    # With the mean on the aim point the probability is that of unbiased scatter.
    near = journey_limit_state(job, "near", LimitState.of("distance < 20"), table)
    assert near.if_aimed is not None
    assert near.if_aimed.value == pytest.approx(within(20.0), abs=0.1)
    assert near.probability.value < near.if_aimed.value


def test_a_miss_that_cannot_be_told_from_none_moves_no_aim(job: Any) -> None:
    random = np.random.default_rng(8)
    table = rested(*(values - values.mean() for values in random.normal(0.0, SIGMA, (2, COUNT))))
    found = mean_miss(job, table)
    assert found is not None
    assert not found.is_distinct
    assert miss_words(found).endswith("No shift of the aim can be distinguished from none.")
    assert journey_limit_state(job, "near", LimitState.of("distance < 20"), table).if_aimed is None


def test_of_studies_without_a_miss_at_most_one_in_ten_names_another_aim(job: Any) -> None:
    """Two tests at 90 % each would do so in 19 of 100: 1 - 0.9 squared."""
    random = np.random.default_rng(12)
    tables = (rested(*random.normal(0.0, SIGMA, (2, COUNT))) for _ in range(500))
    alarms = [miss.is_distinct for table in tables if (miss := mean_miss(job, table)) is not None]
    assert len(alarms) == 500
    # 1 - 0.95 squared is 0.0975, with a standard error of 0.013.
    assert 0.06 < np.mean(alarms) < 0.13


def test_on_unknown_ground_the_aim_follows_the_mean_of_one_ground(job: Any) -> None:
    """Grounds on which landers come down 16 m east or 4 m west: the mean of 6 m is known, and that of one is not."""
    random = np.random.default_rng(13)
    east = np.where(BED % 2 == 0, 16.0, -4.0) + random.normal(0.0, 1.0, COUNT)
    table = rested(east, random.normal(0.0, 1.0, COUNT))
    for unknown, is_distinct in ((None, True), ("patchy", True), ("everywhere", False), ("both", False)):
        job.study.ground = None if unknown is None else SimpleNamespace(unknown=unknown)
        found = mean_miss(job, table)
        assert found is not None
        assert found.is_distinct == is_distinct, unknown


def test_with_the_mean_on_the_aim_the_interval_is_still_that_of_one_ground(job: Any) -> None:
    """On every second ground all rest at the mean, and on the others none: one ground gives all or nothing."""
    away = np.where(np.arange(COUNT) // BEDS % 2 == 0, 40.0, -40.0)
    table = rested(np.full(COUNT, 100.0), np.where(BED % 2 == 0, 0.0, away))
    near = LimitState.of("distance < 20")
    over_beds = journey_limit_state(job, "near", near, table).if_aimed
    job.study.ground = SimpleNamespace(unknown="everywhere", kind={"sand": None})
    job.design = SimpleNamespace(grounds=SimpleNamespace(each=[SimpleNamespace(kind="sand")] * BEDS))
    over_grounds = journey_limit_state(job, "near", near, table).if_aimed
    assert over_beds is not None
    assert over_grounds is not None
    assert over_beds.value == over_grounds.value == 0.5
    assert (over_beds.lower > 0.25, over_beds.upper < 0.75) == (True, True)
    assert (over_grounds.lower < 0.05, over_grounds.upper > 0.95) == (True, True)


def test_places_are_turned_onto_the_aim_without_stretching_them(job: Any) -> None:
    """A miss of 1 rad on a ball of 100 m, about whose place arcs are Rayleigh of 24.4 m: 53 % within 30 m of it."""
    radius, sigma, count = 100.0, 24.4, 4800
    job.site = SimpleNamespace(aim=(0.0, 0.0), aim_radius=radius)
    arc = sigma / radius * np.sqrt(-2.0 * np.log1p(-(np.arange(count) + 0.5) / count))
    way = 2.399963 * np.arange(count)
    # From the place 1 rad east of the aim: on, east and north.
    on, east, north = np.cos(arc), np.sin(arc) * np.cos(way), np.sin(arc) * np.sin(way)
    x, y = (on * math.cos(1.0) - east * math.sin(1.0)), (on * math.sin(1.0) + east * math.cos(1.0))
    latitude, longitude = np.degrees(np.arcsin(north)), np.degrees(np.arctan2(y, x))
    table = rested(np.zeros(count), np.zeros(count))
    table.numbers.update(latitude_deg=latitude, longitude_deg=longitude, distance=radius * np.arccos(x))
    found = journey_limit_state(job, "near", LimitState.of("distance < 30"), table)
    assert found.if_aimed is not None
    assert found.if_aimed.value == pytest.approx(1.0 - math.exp(-0.5 * (30.0 / sigma) ** 2), abs=0.01)


def test_landers_all_around_the_body_have_no_mean(job: Any) -> None:
    random = np.random.default_rng(9)
    table = rested(np.zeros(COUNT), np.zeros(COUNT))
    table.numbers["distance"][:] = random.uniform(0.0, math.pi * RADIUS, COUNT)
    assert mean_miss(job, table) is None
    assert miss_words(None) == ""


def test_the_mean_of_one_ground_has_the_scatter_of_grounds() -> None:
    """Of 300 studies nine in ten intervals, at least, hold the mean of a ground that the study has not seen."""
    random, held = np.random.default_rng(10), []
    for _ in range(300):
        effect = random.normal(0.0, 8.0, BEDS + 1)
        y = 3.0 + effect[BED] + random.normal(0.0, 10.0, COUNT)
        found = mean_over_grounds(y, BED)
        assert found.bounds is not None
        held.append(found.bounds[0] <= 3.0 + effect[-1] <= found.bounds[1])
    assert 0.87 <= np.mean(held) <= 0.98


def test_offsets_are_arcs_in_the_direction_of_their_beginning() -> None:
    quarter = offsets(SimpleNamespace(aim=(0.0, 0.0), aim_radius=2.0), np.array([0.0, 90.0]), np.array([90.0, 0.0]))  # type: ignore[arg-type]
    assert quarter == pytest.approx(math.pi * np.eye(2))
