"""The explorer evaluates the emulator that Python evaluates, and its shares are those of the study."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from lithobrake import emulator
from lithobrake.analysis import refit_interval
from lithobrake.analysis.confidence import t_quantile
from lithobrake.analysis.unseen_event import even_limit
from lithobrake.chaos import (
    Beta,
    Empirical,
    Exponential,
    Gamma,
    LogNormal,
    LogUniform,
    Normal,
    TruncatedNormal,
    Uniform,
)  # fmt: skip
from lithobrake.emulator import Emulator, law_tables
from lithobrake.geometry.attitude import AttitudeTerms
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.runs.energy_bound import bound_numbers, energy_bound
from lithobrake.report.figures.ground_map import GroundMap
from lithobrake.report.live.explorer import packed, script_data
from lithobrake.results.named_emulator import allowed_motion
from lithobrake.results.page_data import PageData
from lithobrake.study import check_tables

from ...pipeline.few_terms import few_terms
from ...pipeline.synthetic_lander import synthetic_tables
from ...quick_studies import quick_studies
from ...synthetic_landings import ELEVATION_LIMIT, INPUTS, OUTPUT_NAMES, SPEED_LIMIT, STRONG
from ..page_scripts import answer_of, explorer_data, needs_node

EXACT = 1e-12
LAW = ("live/law.js",)
ALL = ("live/law.js", "live/flown.js", "live/explore.js")
# What follows the arrays of a law: names, no energy bound, and no number of it.
FACTS = {"inputNames": [], "bound": {}, "speed": 0, "elevation": 1, "spin": 2, "outputOutcome": "clear"}
PRISM, BOX, CUBE = (AttitudeTerms.of_box(np.array(edges)) for edges in ([0.1, 0.1, 0.2], [0.3, 0.2, 0.1], [0.1] * 3))
MESH = AttitudeTerms.of_body(np.array([[2.0, 0.1, 0.0], [0.1, 3.0, 0.2], [0.0, 0.2, 4.0]]))
BEGIN = "const law = new Law(unpack(given.law), given.facts);"


@pytest.fixture(scope="module")
def model() -> Emulator:
    """An emulator of landings whose law is known."""
    x, y, outcome, bed = STRONG.study(200, 20, 5)
    upper = [SPEED_LIMIT, ELEVATION_LIMIT, np.inf, np.inf]
    with quick_studies(), few_terms():
        return emulator.fit(
            dict(INPUTS), x, y, groups=bed, outcome=outcome, lower=[0.0, 0.0, -np.inf, 0.0], upper=upper,
            riders=["azimuth_out"], output_names=list(OUTPUT_NAMES),
        )  # fmt: skip


def given_of(models: list[Emulator], **facts: Any) -> dict[str, Any]:
    """What the page has of emulators. A speed without a bound of its own has that of the runs."""
    tables = {name: np.asarray(table, dtype=float) for name, table in law_tables(models).items()}
    names = list(models[0].outcome_names)
    return {"law": packed(tables), "facts": FACTS | {"outcomeNames": names} | facts}


@needs_node
def test_terms_of_every_kind_of_input_are_those_of_python() -> None:
    random = np.random.default_rng(1)
    inputs = {
        "a": Uniform(2.0, 5.0), "b": LogUniform(1e5, 1e8), "c": Normal(3.0, 0.2), "d": LogNormal(1.0, 0.3),
        "e": TruncatedNormal(0.0, 1.0, -0.5, np.inf), "f": Beta(2.0, 3.0, 1.0, 4.0), "g": Gamma(2.0, 0.5),
        "h": Exponential(3.0), "i": Empirical(random.normal(size=60)),
    }  # fmt: skip
    x = np.column_stack([law.ppf(random.random(150)) for law in inputs.values()])
    y = x[:, :1] + np.log(x[:, 1:2]) * x[:, 2:3] + 0.1 * random.standard_normal((150, 1))
    model = emulator.fit(inputs, x, y, form="rows")
    found = answer_of(LAW, BEGIN + """
      law.used = Array.from({ length: law.terms }, (_, term) => term);
      return given.x.map((x) => Array.from(
        law.termsAt(x.map((one, input) => law.germOf(input, one)), new Float64Array(law.terms))));
      """, given_of([model]) | {"x": x.tolist()})  # fmt: skip
    matrix = model.terms.matrix(x)
    assert np.abs(np.array(found) - matrix).max() < EXACT


@needs_node
def test_quantiles_of_inputs_are_those_of_their_laws(model: Emulator) -> None:
    shares = [0.0, 0.1, 0.5, 0.83, 1.0]
    program = (
        BEGIN
        + """return given.shares.map((share) => Array.from({ length: law.inputs },
      (_, input) => law.valueOf(input, law.germAt(input, share))));"""
    )
    found = answer_of(LAW, program, given_of([model]) | {"shares": shares})
    expected = np.column_stack([law.ppf(shares) for law in INPUTS.values()])
    assert np.array(found) == pytest.approx(expected, rel=1e-12, abs=1e-12)


@needs_node
@pytest.mark.parametrize(("changes", "fixed"), [
    ({}, {}),
    ({"lander": {"inertia": [1e-3, 2e-3, 2e-3], "mass": 2.0}}, {"lander.mass": 3.0}),
    ({"lander": {"shape": "sphere", "diameter": 0.2, "mass": 2.0}}, {"lander.diameter": 0.15}),
    ({"surface": {"slope_deg": 30.0, "gravity": 1e-2}}, {"impact.speed": 0.2, "impact.spin_y": 3.0}),
    ({"surface": {"slope_deg": 30.0, "gravity": 1e-2}, "bed": {"sides": "walls"}}, {"impact.speed": 0.2}),
])  # fmt: skip
def test_the_energy_bound_is_that_of_python(model: Emulator, changes: dict[str, Any], fixed: dict[str, float]) -> None:
    study = check_tables(synthetic_tables(**changes), Path()).with_function("of a test")
    bound = energy_bound(DrawnDesign(study), 0.3, {name: np.array([value]) for name, value in fixed.items()}, 1)
    given = given_of([model], bound=bound_numbers(DrawnDesign(study), 0.3), inputNames=list(fixed))
    found = answer_of(LAW, f"{BEGIN} return law.energyBoundAt(given.values);", given | {"values": [*fixed.values()]})
    assert found == pytest.approx([bound.speed[0], bound.gyration[0]], rel=EXACT)
    values = {name: np.array([value]) for name, value in fixed.items()}
    assert allowed_motion(given["facts"]["bound"], values, 1) == pytest.approx(
        np.column_stack([bound.speed, bound.spin()]), rel=EXACT)  # fmt: skip


@needs_node
@pytest.mark.parametrize(("share", "run_count"), [(0.5, 40), (0.96, 40), (0.03, 40), (0.03, 9), (0.96, 9)])
def test_an_interval_is_that_of_python(share: float, run_count: int) -> None:
    random = np.random.default_rng(6)
    known = random.integers(400, 500, 50)
    for spread in (0.0, 0.02):
        returns = random.binomial(known, np.clip(share + spread * random.standard_normal(50), 0.0, 1.0))
        found = answer_of(
            ALL,
            """const [returns, known] = [given.returns, given.known].map((list) => Float64Array.from(list));
            return refitInterval(returns, known, 12, given.reach, given.runs, given.limit);""",
            {
                "returns": returns.tolist(),
                "known": known.tolist(),
                "reach": t_quantile(11),
                "runs": run_count,
                "limit": even_limit(run_count, 12),
            },
        )
        known_to_python = refit_interval(returns, known, 12, run_count)
        bounds = [known_to_python.value, known_to_python.lower, known_to_python.upper]
        assert found == pytest.approx(bounds, rel=EXACT)


@needs_node
def test_bands_are_freed_of_what_few_draws_add() -> None:
    random = np.random.default_rng(7)
    truth = 0.3 + 0.03 * random.standard_normal(2000)
    few = random.binomial(300, truth) / 300
    chance = float(np.mean(few * (1.0 - few) / 299))
    low, high = answer_of(ALL, "return middle(given.few, given.chance);", {"few": few.tolist(), "chance": chance})
    # The standard error of the end of nine tenths, of 2000 draws of a normal law of this spread.
    error = 0.03 * np.sqrt(0.05 * 0.95 / 2000) / 0.1031
    assert [low, high] == pytest.approx([0.3 - 1.645 * 0.03, 0.3 + 1.645 * 0.03], abs=3.0 * error)


@needs_node
def test_every_flown_start_is_met_and_the_nearest_speeds_are_near() -> None:
    random = np.random.default_rng(0)
    starts = np.column_stack([random.random(3000), random.random(3000), random.uniform(-3.0, 3.0, 3000)])
    given = {"starts": packed({"starts": starts.astype(np.float32)}), "at": random.random((4000, 4)).tolist()}
    found = answer_of(ALL, """const { starts } = unpack(given.starts);
      const flown = new Flown(starts, new Uint8Array(3000));
      return given.at.map(([a, b, c, u]) => flown.near(a, b, 6 * c - 3, u));""", given)  # fmt: skip
    at = np.array(given["at"])
    assert np.abs(starts[found, 0] - at[:, 0]).mean() < 0.05
    assert len(set(found)) > 1500


def test_the_page_has_the_explorer_with_all_its_numbers(first_page: str, first: PageData) -> None:
    data = explorer_data(first_page)
    assert data["law"]["location"]["shape"] == list(first.samples.explorer.tables["location"].shape)
    assert data["flown"]["starts"]["shape"] == [first.samples.flights.row_count, 3]
    assert data["facts"]["inputNames"] == list(first.samples.explorer.input_names)
    assert f"one of {first.samples.flights.row_count} flights" in first_page
    assert "startExplorer(holder)" in first_page


def test_words_in_numbers_end_no_script() -> None:
    assert "</script>" not in script_data("x", {"words": "</script><b>"})[:-10]


def test_an_array_that_a_browser_has_not_is_refused() -> None:
    with pytest.raises(ValueError, match="bed has type int64, but must have one of float64"):
        packed({"bed": np.arange(3)})


@needs_node
def test_the_map_is_that_of_the_figures() -> None:
    random = np.random.default_rng(3)
    latitude, longitude = np.degrees(np.arcsin(random.uniform(-1.0, 1.0, 300))), random.uniform(-180.0, 180.0, 300)
    ground = GroundMap(-35.0, 160.0, 1.0)
    program = """const at = (call) => given.places.map((place) => call(given.aim, ...place));
return [at(onHalf), at(mapCell)];"""
    given = {"aim": [ground.latitude, ground.longitude], "places": np.column_stack([latitude, longitude]).tolist()}
    places, cells = map(np.array, answer_of((*ALL, "live/halves.js"), program, given))
    east_north = np.column_stack(ground.places(latitude, longitude))
    assert places[:, :2] == pytest.approx(east_north, abs=EXACT)
    half, row, column = np.unravel_index(cells, (2, 60, 60))
    assert (half == (ground.facing(latitude, longitude) < 0.0)).all()
    shown = np.where(half[:, None] == 0, east_north, np.column_stack(ground.opposite.places(latitude, longitude)))
    middles = (np.column_stack([column, row]) + 0.5) / 30.0 - 1.0
    assert np.abs(shown / ground.edge - middles).max() <= 1.0 / 60.0 + EXACT


@needs_node
@pytest.mark.parametrize("terms", [PRISM, BOX, CUBE, MESH])
def test_terms_of_attitudes_are_those_of_python(terms: AttitudeTerms) -> None:
    turned = Rotation.random(6, rng=0).as_matrix()
    ways = [turned[:, 2].tolist(), turned[:, 0].tolist()]
    facts = {"inputs": [0], "axes": terms.axes.tolist(), "hasSides": terms.has_sides, "isCube": terms.is_cube}
    program = """const attitude = new Attitude(given.facts);
return given.ways[0].map((normal, place) => attitude.terms(normal, given.ways[1][place]));"""
    found = answer_of(("live/attitude.js",), program, {"facts": facts, "ways": ways})
    assert np.array(found) == pytest.approx(terms.at(turned[:, 2], turned[:, 0]), abs=EXACT)


@needs_node
def test_attitudes_of_the_browser_are_uniform_or_have_a_side_down() -> None:
    facts = {"inputs": [0, 1, 2], "axes": PRISM.axes.tolist(), "hasSides": False, "isCube": False}
    uniforms = np.random.default_rng(0).random((4000, 3)).tolist()
    program = """const attitude = new Attitude(given.facts);
const all = (downs) => { attitude.downs = downs; return given.uniforms.map((one) => attitude.ways(...one)); };
return [all([]), all([[0, 0, 1], [0, 0, -1]])];"""
    free, pointed = map(np.array, answer_of(("live/attitude.js",), program, {"facts": facts, "uniforms": uniforms}))
    for ways in (free, pointed):
        assert np.einsum("nk,nk->n", ways[:, 0], ways[:, 1]) == pytest.approx(np.zeros(4000), abs=EXACT)
        assert np.linalg.norm(ways, axis=2) == pytest.approx(np.ones((4000, 2)))
    mean, covariance = PRISM.uniform_law
    terms = PRISM.at(free[:, 0], free[:, 1])
    assert terms.mean(axis=0) == pytest.approx(mean, abs=0.03)
    assert np.cov(terms.T) == pytest.approx(covariance, abs=0.03)
    assert np.abs(pointed[:, 0]) == pytest.approx(np.tile([0.0, 0.0, 1.0], (4000, 1)), abs=EXACT)
    assert pointed[:, 0, 2].mean() == pytest.approx(0.0, abs=0.06)


@needs_node
def test_attitudes_of_a_pointed_lander_are_those_that_are_given() -> None:
    facts = {"inputs": [2, 0], "axes": PRISM.axes.tolist(), "hasSides": False, "isCube": False}
    drawn = [[0.9, 0.1], [0.8, -0.2], [0.7, 0.3]]
    program = """const attitude = new Attitude(given.facts), law = { germOf: (input, value) => 10 * input + value };
return given.uniforms.map((one) => { const germs = [0, 5, 0]; attitude.into(germs, law, one); return germs; });"""
    given = {"facts": facts | {"drawn": drawn}, "uniforms": [[0.1, 0.9], [0.5, 0.0], [0.999, 0.5]]}
    found = answer_of(("live/attitude.js",), program, given)
    assert found == [pytest.approx([along, 5, 20.0 + upright]) for upright, along in drawn]
