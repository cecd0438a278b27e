"""Editions of the forecast: measurements, weights of landers, what each changed, and that none is ever edited."""

import datetime
import hashlib
import math
import shutil
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy import stats

from lithobrake.scoring import read_observation, read_prediction, scores

ROOT = Path(__file__).parents[2]
SCRIPTS = ROOT / "validation" / "forecast_hera"
FIRST = SCRIPTS / "editions" / "2026-11-26"

pytestmark = pytest.mark.usefixtures("forecast_scripts")

MASS = """
[[measurement]]
quantity = "dimorphos_mass"
value = 2.7e9
error = 0.25e9
unit = "kg"
date = 2027-01-20
source = "invented"
"""
ROLLING = """
[[measurement]]
quantity = "rotation"
weights = { "small libration" = 0.3, "large libration" = 0.2, "rolling" = 0.5 }
date = 2027-01-21
source = "invented"
"""


def measured(quantity: str, **keys):
    from measurements import measurement_of

    return measurement_of({"quantity": quantity, "date": datetime.date(2027, 1, 20), "source": "x", **keys}, "here")


def mass(value: float, error: float):
    return measured("dimorphos_mass", value=value, error=error, unit="kg")


def landers(branch: str = "rolling, at the surface", ground: str = "soil", **columns) -> list[dict]:
    """Landers of Juventas in a branch, each on a bed of its own."""
    fixed = {"lander": "juventas", "branch": branch, "ground": ground, "end": "at_rest", "face": "+z"}
    count = len(next(iter(columns.values())))
    table = {"bed": range(count), **columns}
    return [{**fixed, **dict(zip(table, row, strict=True))} for row in zip(*table.values(), strict=True)]


def bytes_of(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in sorted(folder.iterdir())}


@pytest.fixture(scope="module")
def two_editions(forecast_scripts, tmp_path_factory) -> tuple[Path, dict[str, bytes]]:
    """A folder with the first edition, one without measurements and one of an invented mass and rotation; and the
    bytes of the first before the others were made.
    """
    import places
    from edition import make_edition

    folder = tmp_path_factory.mktemp("editions")
    shutil.copytree(FIRST, folder / FIRST.name)
    before = bytes_of(folder / FIRST.name)
    files = [folder / "none.toml", folder / "invented.toml"]
    files[0].write_text("", encoding="utf-8")
    files[1].write_text(MASS + ROLLING, encoding="utf-8")
    with pytest.MonkeyPatch.context() as patch:
        # Of the intervals of areas, which take most of the time.
        patch.setattr(places, "HALVES", 2)
        for day, file in enumerate(files, 1):
            make_edition(file, datetime.date(2027, 2, day), folder / FIRST.name, folder)
    return folder, before


def forecast(folder: Path, date: str) -> dict:
    from harness import read_document

    return read_document(folder / date / "forecast.json")


def test_an_edition_of_fresh_landers_keeps_them(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Those of the first edition stand for landers that were simulated with a mass; the answers are left out."""
    import edition
    from harness import read_document, write_document

    monkeypatch.setattr(edition, "answers", lambda rows, lander, measurements: {})
    monkeypatch.setattr(edition, "changes", lambda rows, lander, measurements: [])
    fresh, file = tmp_path / "fresh", tmp_path / "m.toml"
    fresh.mkdir()
    file.write_text(MASS, encoding="utf-8")
    for source, name in ((FIRST / "landers.csv", "landers.csv"), (file, "drawn.toml")):
        shutil.copy(source, fresh / name)
    digests = read_document(FIRST / "forecast.json")["sha256"]
    write_document(fresh / "runs.json", {"studies_sha256": digests["studies"], "code_sha256": digests["code"]})
    made = edition.make_edition(file, datetime.date(2027, 2, 1), fresh, tmp_path / "editions")
    document = read_document(made / "forecast.json")
    assert document["landers_of"] == "2027-02-01"
    # They need no weights.
    assert document["effective"]["milani"] == pytest.approx({"soil": 240.0, "hard": 400.0})
    assert {"landers.csv", "runs.json", "drawn.toml", "measurements.toml"} <= {path.name for path in made.iterdir()}
    assert "  landers.csv\n" in (made / "SHA256SUMS").read_text(encoding="utf-8")
    # They cannot come from a mass that is known to 0.1 %.
    (fresh / "drawn.toml").write_text(MASS.replace("0.25e9", "2.7e6"), encoding="utf-8")
    with pytest.raises(ValueError, match=r"a lander has dimorphos_mass .* kg, which it cannot have drawn .*; restore"):
        edition.make_edition(file, datetime.date(2027, 2, 2), fresh, tmp_path / "editions")


@pytest.mark.parametrize("edition", sorted(path.name for path in FIRST.parent.iterdir()))
def test_an_edition_is_what_its_hashes_say(edition: str) -> None:
    folder = FIRST.parent / edition
    lines = [line.split("  ") for line in (folder / "SHA256SUMS").read_text(encoding="utf-8").splitlines()]
    assert {path.name for path in folder.iterdir()} - {"SHA256SUMS"} <= {name for _, name in lines}
    for digest, name in lines:
        assert hashlib.sha256((folder / name).read_bytes()).hexdigest() == digest, name


def test_the_first_edition_is_the_one_that_was_published() -> None:
    """Hashes of the landers, as its page of 26 November 2026 states it, of its answers, and of that page."""
    known = {
        FIRST / "landers.csv": "442cb0af4d55f89591e6292fd8365c14e9468a9ab36947c97fe8250480a4d610",
        FIRST / "forecast.json": "bc39037602e3eb34f33cae56f27b488bc5d55e02ad7a0f27038972726c2c9fba",
        ROOT
        / "docs"
        / "forecast_hera_2026_11_26.md": "f0bc06c74a681ee6922518cb7160eb7ed65516ff6e6bb4173044310d0c844fbe",
    }
    assert {path: hashlib.sha256(path.read_bytes()).hexdigest() for path in known} == known
    page = (ROOT / "docs" / "forecast_hera_2026_11_26.md").read_text(encoding="utf-8")
    assert known[FIRST / "landers.csv"] in page


def test_an_edition_without_measurements_is_the_first(two_editions) -> None:
    folder, _ = two_editions
    first, none = forecast(folder, FIRST.name), forecast(folder, "2027-02-01")
    for lander, ground in (("juventas", "soil"), ("milani", "hard")):
        one, other = first["landers"][lander][ground], none["landers"][lander][ground]
        for key in ("ends", "at_rest"):
            for name in one[key]:
                assert other[key][name] == pytest.approx(one[key][name], rel=1e-9), (lander, ground, name)
        for name in one["scored"]:
            assert other["scored"][name] == pytest.approx(one["scored"][name], rel=1e-9)
        for before, after in zip(one["by_branch"], other["by_branch"], strict=True):
            assert after["at_rest"] == pytest.approx(before["at_rest"], rel=1e-9)
        # Regions across the 180th meridian are filled otherwise than on the day of the first edition: by 0.02 %.
        areas, before = ([row["area_m2"] for row in edition["regions"]] for edition in (other, one))
        assert areas == pytest.approx(before, rel=1e-3)
    assert none["effective"]["juventas"] == pytest.approx({"soil": 240.0, "hard": 400.0})
    for name in ("juventas_soil.csv", "milani_hard.csv"):
        assert (folder / "2027-02-01" / name).read_bytes() == (FIRST / name).read_bytes()


def test_a_second_edition_differs_and_leaves_the_first_untouched(two_editions) -> None:
    folder, before = two_editions
    assert bytes_of(folder / FIRST.name) == before == bytes_of(FIRST)
    first, second = forecast(folder, FIRST.name), forecast(folder, "2027-02-02")
    # A lighter body: longer journeys.
    for lander in ("juventas", "milani"):
        old, new = (one["landers"][lander]["soil"] for one in (first, second))
        assert new["at_rest"]["time_s"]["q50"] > old["at_rest"]["time_s"]["q50"]
        weights = {row["branch"]: row["weight"] for row in new["by_branch"]}
        assert weights["rolling, at the surface"] == pytest.approx(0.5)
        assert weights["small libration, ballistic, far end"] == pytest.approx(0.3 / 4.0)
        assert second["effective"][lander]["soil"] < 240.0
    assert [one["source"] for one in second["measurements"]] == ["invented", "invented"]
    assert second["landers_of"] == FIRST.name
    assert second["sha256"]["results"] == first["sha256"]["results"]
    assert "../2026-11-26/landers.csv" in (folder / "2027-02-02" / "SHA256SUMS").read_text(encoding="utf-8")
    found = [(row["lander"], row["measurement"]) for row in second["changes"]]
    assert found == [
        (lander, words)
        for lander in ("juventas", "milani")
        for words in (
            "mass of Dimorphos: 2.7e9 ± 0.25e9 kg",
            "rotation of Dimorphos: small libration 30 %, large libration 20 %, rolling 50 %",
            "all together",
        )
    ]
    for row in second["changes"]:
        for name in ("at_rest", "time_s", "broad_side", "shift_m"):
            assert row[name]["lower"] <= row[name]["value"] <= row[name]["upper"], (row["measurement"], name)


def test_an_edition_is_not_written_over(two_editions) -> None:
    from edition import make_edition

    folder, _ = two_editions
    # One that was cut short is none.
    (folder / "2027-03-01.part").mkdir()
    (folder / "2027-03-01.part" / "forecast.json").write_text("", encoding="utf-8")
    for date in (datetime.date(2027, 2, 2), datetime.date(2027, 1, 31)):
        with pytest.raises(
            ValueError, match=r"not be later than that of 2027-02-02, and editions are never edited; give"
        ):
            make_edition(folder / "none.toml", date, FIRST, folder)


def test_a_measurement_is_not_later_than_its_edition(tmp_path: Path) -> None:
    from edition import make_edition

    (tmp_path / "m.toml").write_text(MASS, encoding="utf-8")
    with pytest.raises(ValueError, match="dimorphos_mass is of 2027-01-20, after the edition of 2027-01-19; change"):
        make_edition(tmp_path / "m.toml", datetime.date(2027, 1, 19), FIRST, tmp_path / "editions")
    assert not (tmp_path / "editions").exists()


def test_the_table_of_an_edition_is_scored_by_the_package(two_editions, tmp_path: Path) -> None:
    """The logarithmic score of rest is that of the weighted fraction, with half a lander of each of four ends."""
    from lithobrake.scoring.proper_scores import effective_number

    folder, _ = two_editions
    (tmp_path / "seen.toml").write_text('end = "at_rest"\ntime_s = 1500.0\nface = "+z"\n', encoding="utf-8")
    predicted = read_prediction(folder / "2027-02-02" / "juventas_soil.csv")
    found = {one.quantity: one for one in scores(predicted, read_observation(tmp_path / "seen.toml"))}
    assert set(found) == {"end", "time_s", "face"}
    share, count = predicted.weight[predicted.end == "at_rest"].sum(), effective_number(predicted.weight)
    assert predicted.weight.sum() == pytest.approx(1.0, abs=1e-4)
    assert found["end"].score.value == pytest.approx(-math.log2((share * count + 0.5) / (count + 2.0)), rel=1e-3)
    rest = forecast(folder, "2027-02-02")["landers"]["juventas"]["soil"]["ends"]["at_rest"]
    assert rest["lower"] - 0.03 < share < rest["upper"] + 0.03


def test_the_pages_show_all_editions_side_by_side(two_editions, tmp_path: Path, monkeypatch) -> None:
    import write_editions

    folder, _ = two_editions
    monkeypatch.setattr(write_editions, "expected_changes", list)
    write_editions.write(folder, tmp_path)
    page = (tmp_path / "forecast_hera_editions.md").read_text(encoding="utf-8")
    for date in (FIRST.name, "2027-02-01", "2027-02-02"):
        for lander in ("Juventas", "Milani"):
            assert page.count(f"| {lander} | {date} | ") == 1
        digest = hashlib.sha256((folder / date / "SHA256SUMS").read_bytes()).hexdigest()
        assert f"| {date} | `{digest}` |" in page
    assert page.count("| 2027-02-02 | Milani | mass of Dimorphos: 2.7e9 ± 0.25e9 kg | ") == 1
    front = (tmp_path / "forecast_hera.md").read_text(encoding="utf-8")
    assert "**Edition of 2027-02-02, made before" in front
    assert "2 measurements replace assumptions" in " ".join(front.split())
    assert (tmp_path / "forecast_hera.png").stat().st_size > 10_000


def test_the_pages_of_the_documentation_are_those_of_the_editions() -> None:
    """Each edition has its row and its hash; the first page is of the last one."""
    pages = [(ROOT / "docs" / f"forecast_hera{name}.md").read_text(encoding="utf-8") for name in ("", "_editions")]
    dates = sorted(path.name for path in FIRST.parent.iterdir())
    sums = [hashlib.sha256((FIRST.parent / date / "SHA256SUMS").read_bytes()).hexdigest() for date in dates]
    assert f"Edition of {dates[-1]}" in pages[0]
    assert sums[-1] in pages[0]
    assert all(f"| {date} | `{digest}` |" in pages[1] for date, digest in zip(dates, sums, strict=True))


@pytest.mark.parametrize(
    ("table", "law", "at"),
    [
        ({"distribution": "uniform", "lower": 0.3, "upper": 0.7}, stats.uniform(0.3, 0.4), [0.3, 0.5, 0.7]),
        ({"distribution": "log_uniform", "lower": 3e-4, "upper": 3e-2}, stats.loguniform(3e-4, 3e-2), [4e-4, 0.029]),
        (
            {"distribution": "log_normal", "mean": 21.8, "std": 0.185},
            stats.lognorm(0.185, scale=math.exp(21.8)), [2e9, 3e9, 5e9],
        ),
        (
            {"distribution": "truncated_normal", "mean": 0.0, "std": 15.0, "lower": 0.0, "upper": 85.0},
            stats.truncnorm(0.0, 85.0 / 15.0, 0.0, 15.0), [0.0, 10.0, 40.0],
        ),
        (
            {"distribution": "beta", "alpha": 1.57, "beta": 4.79, "lower": 0.03, "upper": 0.15},
            stats.beta(1.57, 4.79, 0.03, 0.12), [0.04, 0.06, 0.1],
        ),
    ],
)  # fmt: skip
def test_densities_are_those_of_the_laws(table: dict, law, at: list[float]) -> None:
    from weights import density

    assert density(table, np.array(at)) == pytest.approx(law.pdf(at), rel=1e-3)
    outside = [one for one in (0.29, 0.71) if table["distribution"] == "uniform"]
    assert not density(table, np.array(outside)).any()


def test_weighted_landers_have_the_probability_of_the_measured_law() -> None:
    """Landers rest where Dimorphos is heavier than 2.8e9 kg: under N(m, s) with 1 - Phi((2.8e9 - m) / s)."""
    from samples import sample
    from weights import weighted

    count = 4000
    masses = stats.lognorm(0.185, scale=math.exp(21.8)).ppf((np.arange(count) + 0.5) / count)
    ends = np.where(masses > 2.8e9, "at_rest", "escaped")
    of = sample(weighted(landers(mass_kg=masses, end=ends), "juventas", [mass(2.65e9, 0.2e9)]), "juventas", "soil")
    found = of.weight[of.column("end") == "at_rest"].sum()
    assert found == pytest.approx(1.0 - stats.norm.cdf((2.8 - 2.65) / 0.2), abs=1e-3)
    assert of.weight @ of.column("mass_kg") == pytest.approx(2.65e9, rel=1e-3)


def test_the_effective_number_is_that_of_its_integral() -> None:
    """Of n even values over a width w, N(m, s) leaves n / (w times the integral of its squared density)."""
    from samples import sample
    from weights import effective_number, weighted

    count, sigma = 4000, 0.03
    friction = 0.3 + 0.4 * (np.arange(count) + 0.5) / count
    one = measured("grain_friction", value=0.5, error=sigma, unit="1")
    of = sample(weighted(landers(grain_friction=friction), "juventas", [one]), "juventas", "soil")
    assert effective_number(of) / count == pytest.approx(2.0 * math.sqrt(math.pi) * sigma / 0.4, rel=1e-3)


def test_independent_measurements_multiply_and_other_landers_stand_for_themselves() -> None:
    from weights import branch_factors, measured_branches

    both = [mass(2.9e9, 0.2e9), measured("grain_friction", value=0.5, error=0.05, unit="1")]
    columns = {"mass_kg": [2.8e9, 2.8e9], "grain_friction": [0.45, math.nan]}

    def factors(measurements: list, rows: list[dict]) -> np.ndarray:
        new, old = (measured_branches("juventas", given)[-1] for given in (measurements, []))
        return branch_factors(rows, new, old)

    rows = landers(**columns)
    assert factors(both, rows)[0] == pytest.approx(factors(both[:1], rows)[0] * factors(both[1:], rows)[0])
    # One that missed has no soil, and hard ground has none either.
    assert factors(both[1:], rows)[1] == 1.0
    assert factors(both[1:], landers(ground="hard", **columns)) == pytest.approx([1.0, 1.0])


def test_speed_of_arrival_is_not_that_of_ballistic_descents() -> None:
    from weights import weighted

    one = measured("arrival_speed", lander="juventas", value=0.06, error=0.01, unit="m/s")
    for branch, is_same in (("small libration, ballistic, near end", True), ("rolling, at the surface", False)):
        rows = weighted(landers(branch, speed=[0.05, 0.09]), "juventas", [one])
        assert all(row["factor"] == 1.0 for row in rows) == is_same
    rows = weighted(landers(speed=[0.05, 0.09]), "juventas", [measured("arrival_speed", lander="milani", value=0.06,
        error=0.01, unit="m/s")])  # fmt: skip
    assert all(row["factor"] == 1.0 for row in rows)


def test_measured_weights_keep_the_shares_within_each() -> None:
    from measured_branches import measured_branches

    given = [
        measured("rotation", weights={"small libration": 0.6, "large libration": 0.4, "rolling": 0.0}),
        measured("descent", lander="juventas", weights={"at the surface": 0.9, "ballistic": 0.1}),
        measured("aim", lander="juventas", weights={"near end": 0.75, "far end": 0.25}),
    ]
    found = {(one.rotation, one.descent, one.aim): one.weight for one in measured_branches("juventas", given)}
    assert found == pytest.approx({
        ("small libration", "at the surface", "near end"): 0.6 * 0.9 * 0.75,
        ("small libration", "ballistic", "near end"): 0.6 * 0.1 * 0.75,
        ("large libration", "at the surface", "near end"): 0.4 * 0.75,
        ("small libration", "at the surface", "far end"): 0.6 * 0.9 * 0.25,
        ("small libration", "ballistic", "far end"): 0.6 * 0.1 * 0.25,
        ("large libration", "at the surface", "far end"): 0.4 * 0.25,
        ("rolling", "at the surface", ""): 0.0,
    })  # fmt: skip
    assert sum(found.values()) == pytest.approx(1.0)


def test_a_change_of_weights_is_that_of_its_mixture() -> None:
    """Nine in ten rest in one branch, and half in another; their weights go from 0.35 and 0.1 to 0.2 and 0.2."""
    from changes import change

    place = {f"position_{axis}": np.zeros(20) for axis in "yz"}
    same = {"time_s": np.full(20, 600.0), **place}
    rolling = landers(end=["at_rest"] * 18 + ["escaped"] * 2, position_x=np.full(20, 90.0), **same)
    near = landers(
        "small libration, at the surface, near end",
        end=["at_rest", "escaped"] * 10,
        position_x=np.full(20, -90.0),
        **same,
    )
    before, after = (
        [{**row, "branch_weight": first} for row in rolling] + [{**row, "branch_weight": second} for row in near]
        for first, second in ((0.35, 0.1), (0.2, 0.2))
    )
    found = change(before, after, "juventas")
    old, new = (0.35 * 0.9 + 0.1 * 0.5) / 0.45, (0.9 + 0.5) / 2.0
    assert found["at_rest"]["value"] == pytest.approx(new - old)
    mean = [90.0 * (0.35 * 0.9 - 0.1 * 0.5) / (0.35 * 0.9 + 0.1 * 0.5), 90.0 * (0.9 - 0.5) / (0.9 + 0.5)]
    assert found["shift_m"]["value"] == pytest.approx(mean[0] - mean[1])
    # Binomial errors of both branches, whose weights changed by d: d^2 p (1 - p) / n.
    error = (0.5 - 0.1 / 0.45) * math.sqrt((0.9 * 0.1 + 0.5 * 0.5) / 20.0)
    assert found["at_rest"]["upper"] - found["at_rest"]["lower"] == pytest.approx(2.0 * 1.645 * error, rel=0.15)
    same = change(before, before, "juventas")
    assert all(one == {"value": 0.0, "lower": 0.0, "upper": 0.0} for one in same.values())


def test_what_no_input_follows_from_is_recorded_only() -> None:
    from changes import changes
    from write_editions import basis

    one = measured("thermal_inertia", value=300.0, error=50.0, unit="J m-2 K-1 s-1/2")
    (row,) = changes(landers(mass_kg=[3e9]), "juventas", [one])
    assert row["note"] == "no input of the landings follows from it"
    assert basis({"measurements": [{"used": one.is_used}]}) == "No measurement by Hera is used yet."
    assert basis({"measurements": [{"used": mass(3e9, 1e8).is_used}]}).startswith("One measurement replaces")


def test_broad_sides_are_those_across_the_shortest_edge() -> None:
    from changes import broad_sides

    assert (broad_sides("juventas"), broad_sides("milani")) == (("+z", "-z"), ("+x", "-x"))


def test_too_few_landers_are_refused_with_the_command_for_fresh_ones() -> None:
    from weights import effective_numbers, refuse_few, weighted

    masses = stats.lognorm(0.185, scale=math.exp(21.8)).ppf((np.arange(240) + 0.5) / 240)
    both = landers(mass_kg=masses) + landers(ground="hard", mass_kg=masses)
    few = effective_numbers(weighted(both, "juventas", [mass(2.8e9, 2.8e7)]), "juventas")
    assert few["soil"] < 25.0
    with pytest.raises(
        ValueError, match=r"of Juventas on soil stand for .*; allowed: at least 100; simulate fresh .*--landers"
    ):
        refuse_few(few, "juventas")
    # Landers that were simulated with a measurement need no weights for it.
    given = [mass(2.8e9, 2.8e6)]
    assert all(row["factor"] == 1.0 for row in weighted(both, "juventas", given, given))


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ({"quantity": "dimorphos_length_x", "value": 180.0, "error": 1.0, "unit": "m"},
         "dimorphos_length_x is 180 m in the measurements and 193 for all landers, more than 2 % away; simulate"),
        ({"quantity": "boulder_slope", "value": 3.4, "error": 0.2, "unit": "1"}, "3.4 1 in the measurements and 2.65"),
        ({"quantity": "cohesion", "value": 1.2, "error": 0.2, "unit": "Pa"},
         "cohesion lies outside 0.01 to 1 Pa, where the landers are, with a probability of 84.1 %"),
    ],
)  # fmt: skip
def test_what_weights_cannot_reach_is_refused(keys: dict, words: str) -> None:
    from weights import weighted

    with pytest.raises(ValueError, match=words):
        weighted(landers(mass_kg=[3e9], grain_cohesion_n=[0.01]), "juventas", [measured(**keys)])


def test_fresh_landers_are_simulated_with_what_was_measured() -> None:
    """Their studies are valid, ballistic descents are to the measured body, and branches of no weight are left out."""
    from descent import FASTER, least_speed
    from measured_branches import BALLISTIC, simulated_branches

    from lithobrake.pipeline.site import Site
    from lithobrake.smallbody import fly
    from lithobrake.study import StudySource

    given = [
        mass(2.2e9, 2.2e6), measured("dimorphos_length_x", value=180.0, error=0.5, unit="m"),
        measured("boulder_smallest", value=0.2, error=0.01, unit="m"),
        measured("aim", lander="juventas", weights={"near end": 1.0, "far end": 0.0}),
        measured("lander_mass", lander="milani", value=11.0, error=0.1, unit="kg"),
    ]  # fmt: skip
    found = simulated_branches("juventas", given)
    assert {one.aim for one in found} == {"near end", ""}
    tables = [one.tables(240) for one in found]
    studies = [StudySource.of_tables(one).study for one in tables]
    for study in studies:
        assert study.site.mass.parameters["mean"] == 2.2e9
        assert list(study.site.extents) == [180.0, 148.0, 120.0]
        assert study.lander.mass.parameters["mean"] == 11.5
    (number,) = (number for number, one in enumerate(found) if one.descent == BALLISTIC)
    del tables[number]["site"]["rotation"]
    body, release = Site(StudySource.of_tables(tables[number]).study).body, found[number].changes["delivery.release"]
    tip = body.shape.surface_point(0.0, 0.0)
    assert tip[0] == pytest.approx(90.0)
    end = fly(body, release["position"], release["velocity"], 3.0e4, gravity="table")
    assert end.position[0] == pytest.approx(tip, abs=0.2)
    assert end.impact_speed[0] == pytest.approx(FASTER * least_speed(body, tip, np.array([1.0, 0.0, 0.0])), rel=1e-3)


GOOD = {"value": 2.8e9, "error": 1e8, "unit": "kg", "quantity": "dimorphos_mass"}


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ({**GOOD, "quantity": "dimorphos_mas"}, r"quantity is \"dimorphos_mas\"; did you mean dimorphos_mass\?"),
        ({**GOOD, "sigma": 1.0}, r"\"sigma\" is no key"),
        ({**GOOD, "unit": "t"}, r"dimorphos_mass has unit \"t\"; allowed: kg; convert"),
        ({**GOOD, "value": 2.8e12}, r"dimorphos_mass.value is .*; allowed: 1e\+09 to 1e\+10 kg; change it"),
        ({**GOOD, "value": True}, "dimorphos_mass.value is true"),
        ({**GOOD, "error": 0.0}, "dimorphos_mass.error is 0.*; allowed: above 0"),
        ({**GOOD, "error": math.nan}, "dimorphos_mass.error is nan"),
        ({**GOOD, "date": "2027-01-20"}, "date is .*without quotes; write it so"),
        ({**GOOD, "source": " "}, "source is .*; say where the measurement is published"),
        ({**GOOD, "lander": "juventas"}, "dimorphos_mass has lander \"juventas\"; it is of no lander; take"),
        ({**GOOD, "weights": {}}, "dimorphos_mass has weights; allowed: value and error"),
        ({**GOOD, "quantity": "lander_mass"}, "lander_mass has lander \"\"; allowed: juventas, milani; name one"),
        ({"quantity": "rotation", "weights": {"rolling": 1.0}}, "weights of small libration, large libration, rolling"),
        ({"quantity": "aim", "lander": "milani", "weights": {"near end": 0.7, "far end": 0.2}}, "the sum 0.9; allowed"),
        ({"quantity": "aim", "lander": "milani", "weights": {"near end": 1.5, "far end": -0.5}}, "each from 0 to 1"),
    ],
)  # fmt: skip
def test_wrong_measurements_are_refused(keys: dict, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        measured(**{"source": "x", **keys}) if "date" not in keys else _with_date(keys)


def _with_date(keys: dict) -> None:
    from measurements import measurement_of

    measurement_of({"source": "x", **keys}, "here")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (MASS + MASS, "measurement 2: dimorphos_mass is there twice; keep one"),
        ("[measurement]\nvalue = 1", "allowed: tables .*measurement.* only"),
        ("[[measurements]]\nvalue = 1", "allowed: tables .*measurement.* only"),
        ("value = ", "is no TOML .*; mend that line"),
    ],
)
def test_wrong_files_are_refused(tmp_path: Path, text: str, words: str) -> None:
    from measurements import read_measurements

    (tmp_path / "m.toml").write_text(text, encoding="utf-8")
    with pytest.raises(ValueError, match=words):
        read_measurements(tmp_path / "m.toml")


def test_the_kept_measurements_are_read() -> None:
    from measurements import read_measurements

    assert isinstance(read_measurements(SCRIPTS / "measurements.toml"), tuple)


def test_landers_of_other_studies_or_bytes_are_refused(tmp_path: Path) -> None:
    from edition import landers_of

    with pytest.raises(ValueError, match=r"without landers.csv or runs.json; allowed: a folder that forecast.py wrote"):
        landers_of(tmp_path)
    shutil.copytree(FIRST, tmp_path / "copy")
    table = (tmp_path / "copy" / "landers.csv").read_text(encoding="utf-8").splitlines(keepends=True)
    (tmp_path / "copy" / "landers.csv").write_text("".join(table[:-1]), encoding="utf-8")
    with pytest.raises(ValueError, match=r"is not that of its hash 442cb0.*; restore it"):
        landers_of(tmp_path / "copy")


def test_the_promised_score_of_the_first_edition_is_printed(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The command of its page, with the bits that it gave on the day of the forecast."""
    import score

    command = [str(SCRIPTS / "score.py"), "juventas", "--end", "at_rest"]
    monkeypatch.setattr(sys, "argv", [*command, "--time-min", "25", "--contacts", "3"])
    score.main()
    found = [line.split() for line in capsys.readouterr().out.splitlines()[1:]]
    assert found == [
        ["end", "0.09", "0.45", "2.00"], ["time_min", "1.28", "2.52", "3.00"], ["contacts", "1.62", "1.76", "2.58"],
    ]  # fmt: skip
    monkeypatch.setattr(sys, "argv", [*command, "--edition", "2026-11-25"])
    with pytest.raises(SystemExit, match="--edition is 2026-11-25; allowed: 2026-11-26"):
        score.main()


def test_commands_refuse_in_one_sentence(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    import edition
    import forecast

    (tmp_path / "m.toml").write_text(MASS.replace("kg", "t"), encoding="utf-8")
    work = ["--work", str(tmp_path / "work")]
    for module, given, words in (
        (forecast, [*work, "--out", str(FIRST)], "allowed: a folder elsewhere, as editions are never edited"),
        (forecast, [*work, "--measurements", str(tmp_path / "m.toml")], 'dimorphos_mass has unit "t"; allowed: kg'),
        (edition, [str(tmp_path / "m.toml"), "--editions", str(tmp_path / "editions")], "has unit"),
    ):
        monkeypatch.setattr(sys, "argv", ["command", *given])
        with pytest.raises(SystemExit, match=words):
            module.main()
    assert not (tmp_path / "editions").exists()
