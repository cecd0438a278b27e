"""The protocol, as the public client speaks it, and the same client's server as a solver of a study."""

import json
import math
import threading
import urllib.request
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import lithobrake
from lithobrake.campaign import ModelServer
from lithobrake.chaos import sobol_sequence
from lithobrake.emulator import fit
from lithobrake.pipeline.commands.serving import FLIGHT, EvaluationProcess, ServedStudy, served_models
from lithobrake.pipeline.runs.solver import LANDING
from lithobrake.serve import ClientGoneError, ClientServer, ServedModel
from lithobrake.vocabulary.quantities import OUTPUTS

from ..pipeline.few_terms import few_terms
from ..quick_studies import quick_studies

umbridge = pytest.importorskip("umbridge")

# So often [s] a server looks whether it is to end.
LOOK = 0.02
BALL = Path(__file__).parents[2] / "examples" / "ball_on_plate.toml"


def double(point: list[float], config: Mapping[str, Any]) -> list[float]:
    if point[0] < 0.0:
        raise ValueError("x is below 0; give one above")
    if point[0] == 1.0:
        raise RuntimeError("it broke")
    return [math.inf] if point[0] == 2.0 else [point[0] * config.get("factor", 2.0) + point[1]]


@pytest.fixture(scope="module")
def address() -> Iterator[str]:
    with ClientServer([ServedModel("double", ("x", "y"), ("z",), double)], "127.0.0.1", 0) as server:
        threading.Thread(target=server.serve_forever, args=(LOOK,), daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}"
        server.shutdown()


def test_the_public_client_finds_and_evaluates_a_model(address: str) -> None:
    assert umbridge.supported_models(address) == ["double"]
    model = umbridge.HTTPModel(address, "double")
    assert model.supports_evaluate()
    assert not model.supports_gradient()
    assert (model.get_input_sizes(), model.get_output_sizes()) == ([2], [1])
    assert model([[3.0, 0.5]]) == [[6.5]]
    assert model([[3.0, 0.5]], {"factor": 10.0}) == [[30.5]]


@pytest.mark.parametrize(("point", "said"), [
    ([[-1.0, 0.0]], "InvalidInput: x is below 0"),
    ([[1.0, 0.0]], "InvalidOutput: RuntimeError: it broke"),
    ([[2.0, 0.0]], "InvalidOutput: model double gave"),
    ([[1.0]], "list of 2 numbers: x, y"),
    ([[1.0, 2.0], [3.0]], "list of 2 numbers"),
])  # fmt: skip
def test_errors_come_back_as_the_protocol_has_them(address: str, point: list[list[float]], said: str) -> None:
    with pytest.raises(Exception, match=said):
        umbridge.HTTPModel(address, "double")(point)
    with pytest.raises(RuntimeError, match=said):
        ModelServer(address, "double").evaluate(point, {})


def test_what_is_no_request_is_refused_and_the_server_goes_on(address: str) -> None:
    for path, body, kind in (
        ("/Evaluate", b"no json", "InvalidInput"),
        ("/Evaluate", b'{"name": "other"}', "ModelNotFound"),
        ("/Gradient", b'{"name": "double"}', "UnsupportedFeature"),
        ("/Evaluate", b'{"name": "double", "config": 3}', "InvalidInput"),
    ):
        request = urllib.request.Request(address + path, data=body)
        with pytest.raises(urllib.error.HTTPError) as caught:
            urllib.request.urlopen(request)
        assert json.loads(caught.value.read())["error"]["type"] == kind
    assert ModelServer(address, "double").evaluate([[1.5, 0.0]], {}) == [[3.0]]


def test_an_address_is_taken_apart_or_refused() -> None:
    assert ModelServer.of("umbridge:http://127.0.0.1:4242/landing") == ModelServer("http://127.0.0.1:4242", "landing")
    for words in ("umbridge:http://127.0.0.1/landing", "umbridge:http://h:1/", "umbridge:h:1/a", "http://h:1/a"):
        with pytest.raises(ValueError, match="umbridge:http://HOST:PORT/MODEL"):
            ModelServer.of(words)
    with pytest.raises(ConnectionError, match="start its server"):
        ModelServer("http://127.0.0.1:9", "landing").evaluate([[1.0]], {})


@pytest.mark.parametrize("value", [None, "0.1", True])
def test_what_is_no_number_of_an_answer_is_named(value: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ModelServer, "_post", lambda *_: {"output": [[0, value, 0.9]]})
    said = rf"http://h:1 answered {json.dumps(value)} for {LANDING[1]}; allowed: a number"
    with pytest.raises(ValueError, match=said):
        ModelServer("http://h:1", "landing").evaluate([[1.0]], {}, LANDING)


@pytest.fixture
def study_address(tmp_path: Path) -> Iterator[str]:
    """A server of the ball on a plate."""
    with ClientServer(served_models(BALL, tmp_path / "out"), "127.0.0.1", 0) as server:
        threading.Thread(target=server.serve_forever, args=(LOOK,), daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}"
        server.shutdown()


def test_a_flight_takes_speeds_that_the_integration_can_square(tmp_path: Path) -> None:
    flight = served_models(BALL, tmp_path / "out")[0]
    with pytest.raises(ValueError, match=r"input of model flight is \[1e\+300, 0, 1\]; allowed: below 1e\+20 m/s each"):
        flight.evaluate([1e300, 0.0, 1.0], {})


def test_a_study_serves_its_landing_and_its_flight(study_address: str) -> None:
    assert umbridge.supported_models(study_address) == ["flight", "landing"]
    landing = umbridge.HTTPModel(study_address, "landing")
    point = [[0.6, 0.2, 35.0, 0.0]]
    assert landing.get_input_sizes() == [len(point[0])]
    ((outcome, *outputs),) = landing(point, {"seed": 3})
    found = dict(zip(OUTPUTS, outputs, strict=True))
    assert outcome == 0.0
    assert math.hypot(*(found[f"velocity_out_{axis}"] for axis in "xyz")) == pytest.approx(found["speed_out"])
    assert landing(point, {"seed": 3}) == [[outcome, *outputs]]
    flight = umbridge.HTTPModel(study_address, "flight")
    # On the equator gravity and rotation nearly cancel.
    ((status, time, *_),) = flight([[0.0, 0.0, 0.02]])
    assert (status, time) == (0.0, 7200.0)
    east, west = (
        flight([[0.02, 0.0, 0.02]], {"latitude_deg": 60.0, "heading_deg": heading})[0] for heading in (90.0, -90.0)
    )
    assert (east[0], west[0], len(east)) == (1.0, 1.0, len(FLIGHT))
    assert east[3] > west[3]


@pytest.mark.parametrize(("config", "said"), [
    ({"lattitude_deg": 3.0}, "config has .lattitude_deg.; did you mean latitude_deg\\?; allowed: latitude_deg"),
    ({"north_error": 1e9}, "site.north_error reaches 1e.09 m; allowed: at most 590"),
    ({"spin_period": 1e-9}, "site.spin_period reaches down to 1e-09 s; allowed: at least 1 s"),
    ({"mass": 1e20}, "a bulk density of .* kg/m3; allowed: 300 to 8000 kg/m3"),
    ({"mass": "5e11"}, 'site.mass is "5e11"; allowed: above 0 .kg.; write a finite number without quotes'),
    ({"latitude_deg": 91}, "site.latitude_deg is 91; allowed: at least -90 and at most 90 .deg."),
    ({"rotation_time": 5.0}, "site.rotation_time is a time in .site.rotation., and there is none; add it, or leave"),
    ({"heading_deg": True}, "site.heading_deg is true; allowed"),
    ({"heading_deg": {"distribution": "uniform", "lower": 0, "upper": 9}}, "allowed: one number"),
])  # fmt: skip
def test_a_flight_takes_what_the_study_file_does(config: dict[str, Any], said: str, tmp_path: Path) -> None:
    flight = served_models(BALL, tmp_path / "out")[0]
    with pytest.raises(ValueError, match=said):
        flight.evaluate([0.0, 0.0, 0.02], config)


@pytest.mark.parametrize(("config", "said"), [
    ({"sed": 4}, "config has .sed.; did you mean seed\\?; allowed: seed, inputs, setting"),
    ({"inputs": {"lander.fricton": 0.9}}, "lander.fricton is not a known key; did you mean friction"),
    ({"inputs": {"lander.friction": -0.1}}, "lander.friction is -0.1; allowed: at least 0"),
    ({"inputs": {"lander.mass": "1"}}, 'lander.mass is "1"; allowed: above 0 .kg.'),
    ({"inputs": {"impact.incidence_deg": 100}}, "impact.incidence_deg is 100; allowed: at least 0 and below 90"),
    ({"inputs": {"impact.place.x": 5.0}}, "impact.place.x reaches from 5 to 5 m; allowed: -0.3 to 0.3 m"),
    ({"inputs": {"impact.place.x": None}}, "impact.place.x is None; allowed"),
    ({"inputs": {"solver.inputs.tilt": 1.0}}, "solver.inputs.tilt is not read here; did you mean solver.inputs.pl"),
    ({"inputs": {"contact.held_speed": 0.1}}, "contact.held_speed is not read here"),
    ({"inputs": {"site.mass": 5e11}}, "site.mass is not read here"),
    ({"inputs": {"impact.azimuth_deg": "random"}}, 'impact.azimuth_deg is "random"; allowed: one number'),
    ({"inputs": {"bed": 0.5}}, "bed is 0.5; allowed: a whole number"),
    ({"inputs": [1.0]}, r"config.inputs is \[1\]; allowed: numbers by the dotted keys"),
    ({"inputs": None}, "config.inputs is None; allowed: numbers by the dotted keys"),
])  # fmt: skip
def test_a_landing_takes_what_the_study_file_does(config: dict[str, Any], said: str, tmp_path: Path) -> None:
    landing = served_models(BALL, tmp_path / "out")[1]
    with pytest.raises(ValueError, match=said):
        landing.evaluate([0.6, 0.2, 35.0, 0.0], config)


def test_a_point_that_the_study_file_may_not_have_is_refused(tmp_path: Path) -> None:
    landing = served_models(BALL, tmp_path / "out")[1]
    with pytest.raises(ValueError, match=r"lander.restitution is 1.5; allowed: above 0 and at most 1"):
        landing.evaluate([1.5, 0.2, 35.0, 0.0], {})


def test_some_inputs_may_stand_in_place_of_the_drawn_ones(tmp_path: Path) -> None:
    landing = served_models(BALL, tmp_path / "out")[1]
    plain, other = (landing.evaluate([0.6, 0.2, 35.0, 0.0], {"inputs": given}) for given in ({}, {"impact.speed": 0.3}))
    assert other[1] > plain[1]
    assert other == landing.evaluate([0.6, 0.2, 35.0, 0.0], {"inputs": {"impact.speed": 0.3, "impact.place.x": 0.1}})


def test_an_evaluation_that_takes_too_long_is_ended_and_the_next_is_made(tmp_path: Path) -> None:
    study = ServedStudy(BALL, tmp_path / "out")
    landing = study.models()[1]
    point = [0.6, 0.2, 35.0, 0.0]
    with EvaluationProcess(study) as evaluations:
        assert evaluations.time_limit == study.study.campaign.wall_limit
        with pytest.raises(ClientGoneError):
            evaluations(landing, point, {}, lambda: True)
        evaluations.time_limit = 1e-9
        with pytest.raises(RuntimeError, match="it ran longer than its limit of 1e-09 s"):
            evaluations(landing, point, {}, lambda: False)
        evaluations.time_limit = 100.0
        assert evaluations(landing, point, {"seed": 3}, lambda: False) == landing.evaluate(point, {"seed": 3})
        with pytest.raises(ValueError, match="did you mean seed"):
            evaluations(landing, point, {"sed": 3}, lambda: False)


ENDS_ONCE = """
import os, pathlib, runpy, signal
mark = pathlib.Path({mark!r})
if not mark.exists():
    mark.touch()
    os.kill(os.getppid(), signal.SIGKILL)
runpy.run_path({ball!r}, run_name="__main__")
"""


def test_an_evaluation_whose_process_dies_is_told_and_the_next_is_made(tmp_path: Path) -> None:
    (tmp_path / "end.py").write_text(ENDS_ONCE.format(mark=str(tmp_path / "mark"), ball=str(BALL.with_suffix(".py"))))
    (tmp_path / "ball.toml").write_text(BALL.read_text().replace("python3 ball_on_plate.py", "python3 end.py"))
    study = ServedStudy(tmp_path / "ball.toml", tmp_path / "out")
    landing, point = study.models()[1], [0.6, 0.2, 35.0, 0.0]
    with EvaluationProcess(study) as evaluations:
        with pytest.raises(RuntimeError, match=r"the evaluation was lost \(its process died \(signal 9\)\)"):
            evaluations(landing, point, {}, lambda: False)
        assert evaluations(landing, point, {}, lambda: False) == landing.evaluate(point, {})


def test_a_study_solved_by_a_server_is_that_of_its_program(study_address: str, tmp_path: Path) -> None:
    from lithobrake.pipeline.design.drawn_design import DrawnDesign
    from lithobrake.pipeline.runs.landings import drawn_rows, model_of
    from lithobrake.study import StudySource

    own = StudySource.read(BALL).study
    text = BALL.read_text().replace("python3 ball_on_plate.py", f"umbridge:{study_address}/landing")
    (tmp_path / "served.toml").write_text(text)
    served = StudySource.read(tmp_path / "served.toml").study
    design = DrawnDesign(own)
    assert umbridge_names(study_address) == list(design.inputs)
    (values,) = drawn_rows(design, np.array([[0.5, 0.3, 40.0, 1.0]]), 0)
    here, there = model_of(own, tmp_path, None)(values, 5), model_of(served, tmp_path, None)(values, 5)
    assert there["outcome"] == here["outcome"] == "clear"
    assert there["outputs"] == {name: here["outputs"][name] for name in OUTPUTS}


def umbridge_names(address: str) -> list[str]:
    """The names of the inputs of a landing, which the protocol leaves out."""
    request = urllib.request.Request(f"{address}/ModelInfo", data=b'{"name": "landing"}')
    with urllib.request.urlopen(request) as response:
        names: list[str] = json.load(response)["inputs"]
    return names


def test_an_answer_that_is_no_landing_fails_the_run(address: str, tmp_path: Path) -> None:
    from lithobrake.pipeline.runs.solver import ServerModel

    model = ServerModel(ModelServer(address, "double"), ("a", "b"), {})
    with pytest.raises(ValueError, match=f"allowed: {len(LANDING)} numbers"):
        model({"a": 3.0, "b": 0.0}, 1)


def test_an_address_that_is_none_is_refused_before_anything_runs(tmp_path: Path) -> None:
    from lithobrake.study import StudyError, StudySource

    path = tmp_path / "served.toml"
    path.write_text(BALL.read_text().replace("python3 ball_on_plate.py", "umbridge:localhost"))
    with pytest.raises(StudyError, match=r"solver\.command is 'umbridge:localhost' is no model of a server"):
        StudySource.read(path)


def synthetic(point: list[float], config: Mapping[str, Any]) -> list[float]:
    """A landing of which restitution decides the speed, and the seed of the run the rest."""
    random = np.random.default_rng(config["seed"])
    speed = 0.1 * point[0] * (1.0 + 0.1 * random.standard_normal())
    elevation = random.uniform(0.3, 1.2)
    velocity = speed * np.array([math.cos(elevation), 0.0, math.sin(elevation)])
    return [0.0, speed, elevation, random.uniform(0.1, 0.2), *velocity.tolist()]


def test_a_whole_study_takes_its_landings_from_a_server_and_serves_its_emulator(tmp_path: Path) -> None:
    names = ("lander.restitution", "lander.friction", "impact.incidence_deg", "solver.inputs.plate_tilt_deg")
    with ClientServer([ServedModel("fast", names, LANDING, synthetic)], "127.0.0.1", 0) as server:
        threading.Thread(target=server.serve_forever, args=(LOOK,), daemon=True).start()
        path = tmp_path / "served.toml"
        text = BALL.read_text().replace(
            "python3 ball_on_plate.py", f"umbridge:http://127.0.0.1:{server.server_port}/fast"
        )
        head, _, tail = text.partition("[design]")
        tail = tail[tail.index("[monte_carlo]") :].replace("10_000", "200").replace("count = 50", "count = 5")
        path.write_text(f"{head}[design]\nrun_count = 60\n\n{tail.replace('count = 200 ', 'count = 0 ')}")
        with quick_studies(), few_terms():
            results = lithobrake.run(path, tmp_path / "out", workers=1, report=False)
        server.shutdown()
    assert results.runs.row_count == 60
    assert set(results.runs["outcome"].tolist()) == {"clear"}
    (emulator,) = (model for model in served_models(path, tmp_path / "out") if model.name == "emulator")
    assert emulator.inputs == names
    draws = np.array([emulator.evaluate([0.6, 0.2, 35.0, 0.0], {"seed": seed}) for seed in range(50)])
    assert (draws[:, 0] == 0.0).all()
    # The law has a mean of 0.06 m/s and scatters by 10 %; the emulator has it of 60 runs.
    assert draws[:, LANDING.index("speed_out")].mean() == pytest.approx(0.06, abs=0.01)
    assert len(np.unique(draws, axis=0)) > 25


@pytest.fixture(scope="module")
def served_emulator(tmp_path_factory: pytest.TempPathFactory) -> Any:
    """The emulator of a study, as it is served."""
    folder = tmp_path_factory.mktemp("emulator")
    served = ServedStudy(BALL, folder)
    x = sobol_sequence(served.design.inputs, 64)
    with few_terms():
        fit(served.design.inputs, x, x[:, 0], form="rows").save(folder / "emulator.json")
    return served.models()[2]


@pytest.mark.parametrize(("name", "said"), [
    ("lander.fricton", "lander.fricton is not a known key; did you mean friction"),
    ("mass", "mass is not a known key"),
])  # fmt: skip
def test_a_key_that_no_run_reads_is_refused_by_the_emulator_too(name: str, said: str, served_emulator: Any) -> None:
    with pytest.raises(ValueError, match=said):
        served_emulator.evaluate([0.6, 0.2, 35.0, 0.0], {"inputs": {name: 0.9}})
