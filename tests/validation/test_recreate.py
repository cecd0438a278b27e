"""Studies that are made again, bands of the validation, and its descents."""

import csv
import json
import runpy
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lithobrake.smallbody import Body, fly

ROOT = Path(__file__).parents[2]
RUNNER = runpy.run_path(str(ROOT / "validation" / "recreate.py"))
with (ROOT / "validation" / "quantities.csv").open(newline="", encoding="utf-8") as file:
    QUANTITIES = list(csv.DictReader(file))
SCRIPT = """
import csv, json, sys
from pathlib import Path
table, work = Path(__file__).with_suffix(".csv"), Path(sys.argv[2])
assert sys.argv[1::2] == ["--work", "--out"]
assert Path(sys.argv[4]) == table.parent
there = {line["x"] for line in csv.DictReader(table.open())} if table.exists() else set()
for x in ("1", "2", "3"):
    if x not in there:
        fresh = not table.exists()
        with table.open("a") as file:
            file.write(("x,square,cpu_s\\n" if fresh else "") + f"{x},{float(x) ** 2},0.5\\n")
"""


@pytest.fixture
def root(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A repository with one case of three rows, the second of which is off by a tenth."""
    for name in ("validation", "benchmarks", "scenarios", "docs"):
        (tmp_path / name).mkdir()
    folder = tmp_path / "validation"
    (folder / "squares.py").write_text(SCRIPT)
    (folder / "squares.csv").write_text("x,square,cpu_s\n1,1.0,7.0\n2,4.4,7.0\n3,9.0,7.0\n")
    (folder / "squares.json").write_text(
        json.dumps({"command": "python validation/squares.py --work FOLDER --out FOLDER"})
    )
    (folder / "own.json").write_text(json.dumps({"command": "python validation/own.py STUDY_FOLDER"}))
    monkeypatch.setitem(RUNNER["recreate"].__globals__, "ROOT", tmp_path)
    return tmp_path


def test_rows_that_are_asked_for_are_made_anew_and_compared(root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    case = RUNNER["cases"](root)["squares"]
    assert case.cpu_s == 21.0
    assert RUNNER["recreate"](case, [0, 2], root / "work") == 0.0
    assert "2 rows in" in capsys.readouterr().out
    assert RUNNER["recreate"](case, None, root / "work") == pytest.approx(0.4 / 4.4)
    out = capsys.readouterr().out
    assert "3 rows in" in out
    assert "2 have the same digits" in out
    assert "square: differs by up to 9.09 %" in out
    assert "2,4.4" in (root / "validation" / "squares.csv").read_text(), "the repository keeps its table"


def test_a_number_that_is_none_any_more_counts_as_another() -> None:
    gap = RUNNER["gap"]
    assert gap("0", "0.0") == gap("nan", "NaN") == 0.0
    assert gap("1.0", "nan") == gap("inf", "1") == gap("clear", "captured") == float("inf")
    assert gap("2", "1") == 0.5


def test_a_folder_of_a_users_own_is_left_alone(root: Path) -> None:
    (root / "work" / "tree").mkdir(parents=True)
    (root / "work" / "tree" / "mine").touch()
    with pytest.raises(ValueError, match="is none of this script's"):
        RUNNER["recreate"](RUNNER["cases"](root)["squares"], None, root / "work")
    assert (root / "work" / "tree" / "mine").exists()


def test_a_whole_case_is_noted_with_its_cost(root: Path) -> None:
    RUNNER["recreate"](RUNNER["cases"](root)["squares"], None, root / "work", note=True)
    kept = json.loads((root / "validation" / "recreated.json").read_text())["squares"]
    assert (kept["rows"], kept["same_digits"]) == (3, 2)
    assert kept["cpu_s"] > 0.0
    (root / "validation" / "squares.csv").write_text("x,square\n1,1.0\n")
    assert RUNNER["cases"](root)["squares"].cpu_s == kept["cpu_s"]


def test_what_cannot_be_made_anew_is_refused_in_a_sentence(root: Path) -> None:
    known = RUNNER["cases"](root)
    with pytest.raises(ValueError, match="it takes a folder of its own"):
        RUNNER["recreate"](known["own"], None, root / "work")
    with pytest.raises(ValueError, match="rows 0 to 2"):
        RUNNER["recreate"](known["squares"], [3], root / "work")


def test_files_of_others_are_asked_for_and_handed_on(root: Path) -> None:
    folder = root / "validation"
    (folder / "lengths.py").write_text(
        "import sys\nfrom pathlib import Path\n"
        "words = (Path(sys.argv[2]) / 'words.txt').read_text().split()\n"
        "rows = ''.join(f'{word},{len(word)}\\n' for word in words)\n"
        "Path(__file__).with_suffix('.csv').write_text(f'word,length\\n{rows}')\n"
    )
    (folder / "lengths.csv").write_text("word,length\nstone,5\nrock,4\n")
    (folder / "lengths.json").write_text(json.dumps({"command": "python validation/lengths.py --meshes FOLDER"}))
    (root / "others").mkdir()
    (root / "others" / "words.txt").write_text("stone rock")
    case = RUNNER["cases"](root)["lengths"]
    with pytest.raises(ValueError, match="name their folder with --given"):
        RUNNER["recreate"](case, None, root / "work")
    assert RUNNER["recreate"](case, None, root / "work", given=root / "others") == 0.0


def test_a_study_of_the_showcase_is_run_by_its_own_command(root: Path) -> None:
    (root / "showcase" / "tiny").mkdir(parents=True)
    landings = {"command": "lithobrake run scenarios/tiny.toml", "cpu_s": 7.0}
    origin = {"command": "lithobrake run showcase/tiny/study.toml --out FOLDER", "cpu_s": 1.0, "landings": landings}
    (root / "showcase" / "tiny" / "origin.json").write_text(json.dumps(origin))
    case = RUNNER["cases"](root)["tiny"]
    assert (case.command, case.cpu_s, case.why_not) == (landings["command"], 7.0, None)
    with pytest.raises(ValueError, match="exit code"):  # lithobrake itself finds no scenarios/tiny.toml
        RUNNER["recreate"](case, None, root / "work")


def test_every_quantity_rests_on_a_case_that_one_command_makes_again() -> None:
    known = RUNNER["cases"]()
    made_by = {row["made_by"] for row in QUANTITIES}
    assert len(made_by) > 10
    assert {name: known[name].why_not for name in made_by if known[name].why_not} == {}


def test_the_table_of_quantities_is_what_the_page_counts() -> None:
    page = (ROOT / "docs" / "validation" / "index.md").read_text(encoding="utf-8")
    agree = sum(row["agrees"] == "yes" for row in QUANTITIES)
    assert f"{agree} of {len(QUANTITIES)} quantities agree" in page
    assert len(QUANTITIES) >= 50
    assert agree >= 30
    assert {row["kind"] for row in QUANTITIES} == {"experiment", "flight", "code"}
    assert [row for row in QUANTITIES if (row["agrees"] == "yes") == bool(row["cause"])] == []
    unknown = [row["quantity"] for row in QUANTITIES if row["cause"] == "not shown"]
    words = " ".join(page.partition("## Cause unknown")[2].partition("\n## ")[0].split())
    assert [one for one in unknown if one not in words] == []
    names = [(row["page"], row["quantity"]) for row in QUANTITIES]
    assert len(set(names)) == len(names), "a quantity stands there twice"


def test_every_case_of_the_repository_has_its_script() -> None:
    known = RUNNER["cases"]()
    scripts = {case.command.split()[1] for case in known.values() if case.command.startswith("python ")}
    assert scripts
    assert [script for script in sorted(scripts) if not (ROOT / script).exists()] == []


# Rows that take seconds, of pairs and of a bed; validation/recreate.py makes those of all cases. How much numbers may
# differ is what another machine makes of them, where sines round otherwise.
def test_rows_of_pairs_come_out_again(tmp_path: Path) -> None:
    command = [sys.executable, str(ROOT / "validation" / "recreate.py"), "pair_tests"]
    command += ["--within", "1e-6", "--work", str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "same digits" in done.stdout


def test_a_row_of_a_bed_comes_out_again(tmp_path: Path) -> None:
    assert RUNNER["recreate"](RUNNER["cases"]()["plate_into_loose_grains"], [16], tmp_path) <= 0.2


BANDS = runpy.run_path(str(Path(__file__).parents[2] / "validation" / "ballistic_descent" / "bands.py"))
LONGITUDES = np.arange(0.0, 360.0, 10.0)


def test_ends_are_where_a_triangle_around_the_seam_crosses_the_level() -> None:
    away = np.abs((LONGITUDES - 350.0 + 180.0) % 360.0 - 180.0)
    band = BANDS["band_of"](LONGITUDES, np.maximum(1.0 - away / 60.0, 0.0), 0.5)
    assert (band.begin, band.end) == pytest.approx((320.0, 380.0))
    assert str(band) == "320 to 20"
    assert band.agrees(BANDS["Band"](311.0, 29.0 + 360.0), 10.0)
    assert not band.agrees(BANDS["Band"](309.0, 380.0), 10.0)


def test_no_and_every_longitude_have_words_and_agree_with_nothing() -> None:
    flat = np.full(36, 0.8)
    every, none = (BANDS["band_of"](LONGITUDES, flat, level) for level in (0.7, 0.9))
    assert (str(every), str(none)) == ("all", "none")
    assert not every.agrees(BANDS["Band"](0.0, 360.0), 10.0)
    assert not none.agrees(BANDS["Band"](0.0, 360.0), 10.0)


DESCENTS = runpy.run_path(str(Path(__file__).parents[2] / "validation" / "ballistic_descent" / "descents.py"))


@pytest.fixture(scope="module")
def balls() -> Body:
    """Dimorphos and Didymos as balls, made once: their facets and grids take a second."""
    return DESCENTS["balls"]()


@pytest.fixture
def sites(monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """What validation/ballistic_descent/reliable_sites.py defines."""
    for folder in ("benchmarks", "validation/ballistic_descent"):
        monkeypatch.syspath_prepend(str(ROOT / folder))
    return runpy.run_path(str(ROOT / "validation" / "ballistic_descent" / "reliable_sites.py"))


def test_only_what_leaves_the_far_side_faster_than_the_closing_speed_passes_l2(
    sites: dict[str, Any], balls: Body
) -> None:
    """L2 is where Hill's radius has it to its first order; against the flight of the package."""
    body = balls
    l2 = sites["lagrange_point"](body, -1.0)
    share = DESCENTS["primary_share"](body)
    hill = body.orbit.distance * ((1.0 - share) / 3.0) ** (1.0 / 3.0)
    assert -l2 == pytest.approx(hill * (1.0 + hill / body.orbit.distance / 3.0), rel=0.02)
    speed, far = sites["closing_speeds"](body)[18], np.array([-1.0, 0.0, 0.0])
    farthest = []
    for factor in (0.97, 1.15):
        place, velocity = DESCENTS["radius"](body) * far[None], factor * speed * far[None]
        reach = 0.0
        for _ in range(2000):
            place, velocity = DESCENTS["step"](body, place, velocity, 1.0)
            if np.linalg.norm(place[0]) < DESCENTS["radius"](body):
                break
            reach = max(reach, float(np.linalg.norm(place[0])))
            if reach > 1.2 * -l2:
                break
        farthest.append(reach)
    assert farthest[0] < -l2 < farthest[1]


def test_the_linear_chance_is_the_share_of_flights_that_meet_the_moon(sites: dict[str, Any], balls: Body) -> None:
    body, up = balls, sites["directions"]()[18:19]
    descents = sites["back_in_time"](body, up, np.array([0.073]), (600.0,), True)[600.0]
    chance = sites["chances"](body, up, descents)[0]
    errors = np.random.default_rng(5).standard_normal((60, 6)) * ([30.0] * 3 + [0.02 / 3.0] * 3)
    states = descents.states + errors
    met = fly(body, states[:, :3], states[:, 3:], 3.0 * 3600.0 + descents.times[0]).status == "impact"
    assert 0.3 < chance < 0.95
    assert chance == pytest.approx(np.mean(met), abs=1.2 / np.sqrt(60.0))  # of 60 flights


def test_no_release_outside_is_nearer_to_the_barycentre_than_the_moon(sites: dict[str, Any], balls: Body) -> None:
    body, up = balls, sites["directions"]()
    descents = sites["back_in_time"](body, up, np.full(len(up), 0.09), (200.0,), True)[200.0]
    states = descents.states[np.isfinite(descents.times)]
    orbit = DESCENTS["primary_share"](body) * body.orbit.distance
    assert len(states) > 10
    assert (np.hypot(states[:, 0] - orbit, states[:, 1]) > orbit).all()
    assert (np.linalg.norm(states[:, :3], axis=1) > 200.0).all()


def test_a_descent_flown_forward_comes_down_vertically_at_its_site(balls: Body) -> None:
    """Against facets and exact gravity; a wrong sense of the Coriolis acceleration misses by tens of degrees."""
    longitude = 200.0
    body, east, speed = balls, np.radians(longitude), 0.09
    up = np.array([[np.cos(east), np.sin(east), 0.0]])
    state = DESCENTS["back_in_time"](body, up, np.array([speed]), (200.0,))[200.0].states[0]
    flight = fly(body, state[:3], state[3:], 86_400.0)
    assert flight.status[0] == "impact"
    assert np.linalg.norm(state[:3]) == pytest.approx(200.0, abs=2.0)
    assert abs((flight.longitude[0] - longitude + 180.0) % 360.0 - 180.0) < 1.0
    assert flight.impact_speed[0] == pytest.approx(speed, rel=0.01)
    assert np.degrees(flight.incidence[0]) < 5.0
