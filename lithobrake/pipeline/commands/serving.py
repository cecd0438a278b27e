"""The models of a study as a server gives them, evaluated in a process that is ended where it takes too long."""

import math
import pickle
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import BrokenExecutor, wait
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Any, Self

import numpy as np
from scipy.spatial.transform import Rotation

from lithobrake.campaign import Limits, LocalExecutor, WorkerDiedError
from lithobrake.files.reading import hashed_seed
from lithobrake.pipeline.design.dependencies import bed_files
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.design.lander_attitude import PREFIX, drawn_attitudes, tells_attitude, told_attitudes
from lithobrake.pipeline.design.random_inputs import draw
from lithobrake.pipeline.first_touchdown.emulator import DrawnLandings, points_within, why_no_emulator
from lithobrake.pipeline.first_touchdown.samples import VELOCITY
from lithobrake.pipeline.journeys.touchdown_emulator import TOUCHDOWN_EMULATOR_FILE, TouchdownEmulator
from lithobrake.pipeline.runs.energy_bound import across_of, energy_bound, height_of_beds
from lithobrake.pipeline.runs.landings import model_of
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.runs.solver import LANDING
from lithobrake.pipeline.site import SITE_KEYS, with_site_gravity
from lithobrake.pipeline.study_folder import FinishedFolder
from lithobrake.serve import ClientGoneError, ServedModel
from lithobrake.study import Study, StudyError, StudySource, fixed_study
from lithobrake.study.lander_checks import quaternion_problems
from lithobrake.study.quantity import is_number
from lithobrake.vocabulary.file_names import EMULATOR_FILE
from lithobrake.vocabulary.outcomes import FlightStatus, TouchdownOutcome
from lithobrake.vocabulary.plain_text import closest, show
from lithobrake.vocabulary.quantities import GROUND_KIND, GROUND_SIZE, IMPACT_AZIMUTH, ORIENTATION, OUTPUTS

# What a campaign that is solved by a server says of each run; the setting is that of the study which is served.
RUN_KEYS = ("seed", "inputs", "setting")
FLIGHT = ("status", "time_s", "latitude_deg", "longitude_deg", "impact_speed", "impact_incidence_deg")
# Longest evaluation [s], where neither the command nor the study's campaign.wall_limit says another.
TIME_LIMIT = 600.0
# What a touchdown reads of its bed.
OF_BED = ("bed", GROUND_KIND, GROUND_SIZE)
# Whether the client is still there is looked at so often [s].
_LOOK = 0.2


def served_models(study: Path, out: Path) -> list[ServedModel]:
    """Models of a study that can be served from the files in its folder, by name.

    Raises ValueError for a study that is refused.
    """
    return ServedStudy(study, out).models()


class ServedStudy:
    """A study whose models are served; nothing is written but what a program of the study's own writes."""

    def __init__(self, study: Path, out: Path) -> None:
        """Read the study. Raises ValueError where it is refused."""
        source = StudySource.read(study)
        self.study, self.folder = with_site_gravity(source.study), FinishedFolder(out)
        self.design = DrawnDesign(self.study)
        self.inputs = tuple(self.design.inputs)

    def models(self) -> list[ServedModel]:
        """Those that there are files for."""
        found = [ServedModel("flight", VELOCITY, FLIGHT, self.flight)]
        beds = [self.folder / name for name in bed_files(self.study)] if self.study.has_soil else []
        if self.inputs and all(bed.is_file() for bed in beds):
            found.append(ServedModel("landing", self.inputs, LANDING, self.landing))
        # Of all touchdowns where there is one: it knows the first ones as well.
        if self._has(TOUCHDOWN_EMULATOR_FILE):
            found.append(ServedModel("emulator", self._touchdowns.plain_inputs, LANDING, self.emulated_touchdown))
        elif self._has(EMULATOR_FILE):
            plain = tuple(name for name in self._emulator.runs.inputs if not name.startswith(PREFIX))
            found.append(ServedModel("emulator", plain, LANDING, self.emulated))
        return found

    def _has(self, emulator: str) -> bool:
        """Whether there is a file of an emulator, and an emulator in it."""
        return (self.folder / emulator).is_file() and why_no_emulator(self.folder.read_json(emulator)) is None

    @cached_property
    def _touchdowns(self) -> TouchdownEmulator:
        return TouchdownEmulator.read(self.design, self.folder)

    def emulated_touchdown(self, point: list[float], config: Mapping[str, Any]) -> list[float]:
        """Draw a touchdown of a lander that does not spin from the emulator of all of them.

        config: seed of the draw; orientation, a quaternion w, x, y, z that turns the lander into the frame of the
        touchdown, in the place of a random attitude. Raises ValueError for an impact that the emulator has no answer
        to.
        """
        _refuse_keys(config, ("seed", "orientation"))
        emulator, seed = self._touchdowns, _seed(config)
        inputs = {name: np.array([value]) for name, value in zip(emulator.plain_inputs, point, strict=True)}
        inputs |= emulator.attitude_of(_attitude(config, seed))
        # One refit a draw, so that draws over many seeds contain the scatter between beds.
        refit = np.array([seed % len(emulator.refits)])
        answers = emulator.answers(inputs, np.zeros((1, 3)), refit, seed)
        if not answers.is_known[0]:
            ranges = ", ".join(f"{name} {low:.4g} to {high:.4g}" for name, (low, high) in emulator.ranges.items())
            raise ValueError(f"the emulator has no answer to this impact; allowed: {ranges}")
        velocity, spin = answers.velocity[0], answers.spin[0]
        speed, size = float(np.linalg.norm(velocity)), float(np.linalg.norm(spin))
        elevation = math.atan2(velocity[2], math.hypot(velocity[0], velocity[1]))
        values = (speed, elevation, size, *velocity.tolist())
        return landing_vector(str(answers.outcome[0]), dict(zip(OUTPUTS, values, strict=True)))

    @cached_property
    def _touchdown(self) -> Any:
        return model_of(self.study, self.folder.path.absolute(), None)

    def landing(self, point: list[float], config: Mapping[str, Any]) -> list[float]:
        """Land once. config: seed, of what the landing draws; inputs, numbers of the run in their place by dotted key.

        Raises ValueError for keys that a landing does not read, and numbers that the study file may not have.
        """
        seed, given = _seed(config), _inputs(config)
        # All draws are made first and then replaced, so that a number that is given changes none of the others.
        medians, drawn = self.design.medians, dict(zip(self.inputs, point, strict=True))
        values = draw(self.study, medians | drawn, seed, self.design.region) | dict(given)
        self._refuse_bed(values["bed"])
        _refuse(self.study, {name: value for name, value in values.items() if name not in OF_BED})
        values |= self.design.grounds.of(int(values["bed"]), values) | dict(given)
        answer = self._touchdown({name: float(value) for name, value in values.items()}, seed)
        return landing_vector(answer["outcome"], answer["outputs"])

    def _refuse_bed(self, number: Any) -> None:
        """Raise ValueError for the number of a bed that there is not; a program of the study's own has any."""
        last = self.study.bed_count - 1 if self.study.has_soil else 2**53
        if not is_number(number) or number != int(number) or not 0 <= number <= last:
            raise ValueError(f"config.inputs: bed is {show(number)}; allowed: a whole number from 0 to {last}")

    @cached_property
    def _emulator(self) -> Any:
        from lithobrake.emulator import load

        return load(self.folder / EMULATOR_FILE)

    def emulated(self, point: list[float], config: Mapping[str, Any]) -> list[float]:
        """Draw a landing from the emulator. config: seed of the draw; inputs must be what the emulator was made for.

        An attitude and azimuth among these take the place of those that the study draws. Raises ValueError for other
        inputs, and numbers that the study file may not have.
        """
        seed, given = _seed(config), _inputs(config)
        laws = self._emulator.runs.inputs
        inputs = [name for name in laws if not name.startswith(PREFIX)]
        values = self.design.medians | dict(zip(inputs, point, strict=True))
        _refuse(self.study, {name: value for name, value in values.items() if name not in OF_BED})
        for name in values.keys() & given.keys():
            if given[name] != values[name]:
                raise ValueError(
                    f"config.inputs: {name} is {show(given[name])}, and the emulator has it at {show(values[name])}; "
                    "leave it out, or serve the study that has it"
                )
        _refuse(self.study, {name: value for name, value in given.items() if name != "bed"})
        x = points_within(laws, self._attitude(dict(zip(inputs, np.array([point]).T, strict=True)), given, seed))
        across = across_of(self.study, self.folder)
        bound = energy_bound(self.design, self._bed_height, dict(zip(laws, x.T, strict=True)), 1, across)
        drawn = DrawnLandings.of(self._emulator, x, bound, seed)
        outcome = tuple(TouchdownOutcome)[int(drawn.outcome[0])]
        return landing_vector(outcome, {name: float(values[0]) for name, values in drawn.table().items()})

    def _attitude(self, values: dict[str, np.ndarray], given: Mapping[str, Any], seed: int) -> dict[str, np.ndarray]:
        """Inputs [1] of a touchdown with the terms of its attitude, as given, or as the study draws them."""
        if tells_attitude(given):
            told = {name: np.array([float(given[name])]) for name in (*ORIENTATION, IMPACT_AZIMUTH)}
            return values | told_attitudes(self.study, told)
        # A stream of its own, so that the attitude and the draw of the touchdown are independent.
        return values | drawn_attitudes(self.design, self._runs.inputs, values, 1, hashed_seed(seed, "attitude"))

    @cached_property
    def _runs(self) -> DesignRuns:
        return DesignRuns.load(self.folder, "drawn")

    @cached_property
    def _bed_height(self) -> float:
        return height_of_beds(self.study, self.folder)

    def flight(self, point: list[float], config: Mapping[str, Any]) -> list[float]:
        """Fly from the site to the next impact. config: numbers of the site by their keys, in place of the medians.

        Raises ValueError for other keys, and numbers that the study file may not have.
        """
        _refuse_keys(config, SITE_KEYS)
        from lithobrake.smallbody import fly
        from lithobrake.smallbody.flight import FARTHEST

        if not max(map(abs, point)) < FARTHEST:
            raise ValueError(f"input of model flight is {show(point)}; allowed: below {FARTHEST:g} m/s each")
        body, numbers = self.design.site.body, self.design.site.medians | dict(config)
        if config:
            # What neither the study nor the client gives is no number of a study file.
            given = {*self.study.site_values(), *(f"site.{key}" for key in config)}
            _refuse(self.study, {f"site.{key}": value for key, value in numbers.items() if f"site.{key}" in given})
        site = {key: np.array([float(value)]) for key, value in numbers.items()}
        origin, axes = self.design.site.frames(site)
        flown = fly(
            *(body, origin, np.einsum("nij,ni->nj", axes, [point]), self.study.flight.duration),
            gravity=self.study.flight.gravity,
            start_time=self.design.site.clock(site),
            mass=site["mass"],
            spin_period=site["spin_period"],
            threads=1,
        )
        ends = (flown.time, flown.latitude, flown.longitude, flown.impact_speed, np.degrees(flown.incidence))
        # A number that there is not, as the speed of an impact where none was, is 0: JSON has no other.
        numbers_of_end = np.nan_to_num(np.concatenate(ends)).tolist()
        return [float(tuple(FlightStatus).index(FlightStatus(str(flown.status[0])))), *numbers_of_end]


def landing_vector(outcome: str, outputs: Mapping[str, float]) -> list[float]:
    """A landing as the numbers of LANDING; those of a lander that did not leave are 0."""
    left = outcome == TouchdownOutcome.CLEAR
    place = tuple(TouchdownOutcome).index(TouchdownOutcome(outcome))
    return [float(place), *(float(outputs[name]) if left else 0.0 for name in OUTPUTS)]


def _refuse(study: Study, values: Mapping[str, Any]) -> None:
    # The study itself was checked as it was read, which takes as long as an answer of the emulator.
    if not values:
        return
    try:
        fixed_study(study, values)
    except StudyError as error:
        raise ValueError("; ".join(error.problems)) from error


def _refuse_keys(config: Mapping[str, Any], allowed: Sequence[str]) -> None:
    for key in config:
        if key not in allowed:
            raise ValueError(f"config has {show(key)}{closest(key, allowed)}; allowed: {', '.join(allowed)}")


def _inputs(config: Mapping[str, Any]) -> Mapping[str, Any]:
    _refuse_keys(config, RUN_KEYS)
    given = config.get("inputs", {})
    if not isinstance(given, Mapping):
        raise ValueError(f"config.inputs is {show(given)}; allowed: numbers by the dotted keys of the study file")
    return given


def _attitude(config: Mapping[str, Any], seed: int) -> Rotation:
    given = config.get("orientation")
    if given is None:
        # A stream of its own, so that the attitude and the draw of the touchdown are independent.
        return Rotation.random(1, rng=np.random.default_rng([seed, 1]))
    if not isinstance(given, list) or len(given) != 4 or not all(map(is_number, given)):
        raise ValueError(f"config.orientation is {show(given)}; allowed: a quaternion of four numbers w, x, y, z")
    for wrong in quaternion_problems("config.orientation", given):
        raise ValueError(wrong)
    w, x, y, z = given
    return Rotation.from_quat([[x, y, z, w]])


def _seed(config: Mapping[str, Any]) -> int:
    seed = config.get("seed", 0)
    if isinstance(seed, bool) or not isinstance(seed, int) or not 0 <= seed < 2**53:
        raise ValueError(f"config.seed is {seed!r}; allowed: a whole number from 0 to 2^53")
    return seed


class EvaluationProcess:
    """Evaluates the models of a study for `ClientServer`, one at a time, in a process that can be ended.

    time_limit: of one evaluation [s]; the first in a process waits for compiled code to be loaded, too, and on a new
    machine for its compilation.
    """

    def __init__(self, study: ServedStudy, time_limit: float | None = None) -> None:
        """Prepare it; the process starts with the first evaluation. Raises ValueError for a limit that is none."""
        if time_limit is not None and not time_limit > 0.0:
            raise ValueError(f"the time limit is {time_limit:g} s; allowed: above 0")
        self.time_limit = time_limit or study.study.campaign.wall_limit or TIME_LIMIT
        # Pickled once: the process recognises the study by these bytes, and keeps what it has read of it.
        self._content = pickle.dumps(study)
        self._executor: LocalExecutor | None = None

    def __call__(
        self, model: ServedModel, point: list[float], config: Mapping[str, Any], gone: Callable[[], bool]
    ) -> list[float]:
        """Evaluate, as lithobrake.serve.Evaluate does.

        Raises RuntimeError for one that takes too long or whose process dies, ClientGoneError for one that nobody
        waits for.
        """
        self._executor = self._executor or LocalExecutor(1)
        limits, call = Limits(wall_s=self.time_limit), (self._content, model.name, point, config)
        future = self._executor.submit_limited(limits, evaluate_served, *call)
        while not wait([future], _LOOK).done:
            if gone():
                self.end()
                raise ClientGoneError
        try:
            answer: list[float] = future.result()
        except (WorkerDiedError, BrokenExecutor) as error:
            self.end()
            raise RuntimeError(
                f"the evaluation was lost ({error}); ask for another point, or raise lithobrake serve --time-limit"
            ) from None
        return answer

    def end(self) -> None:
        """End the process; the next evaluation starts another one."""
        if self._executor is not None:
            self._executor.shutdown(cancel_futures=True)
            self._executor = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self.end()


def evaluate_served(content: bytes, name: str, point: list[float], config: Mapping[str, Any]) -> list[float]:
    """Evaluate a model of a pickled ServedStudy in this process, which keeps the study with what it has read."""
    return _served(content)[name].evaluate(point, config)


@lru_cache(maxsize=1)
def _served(content: bytes) -> dict[str, ServedModel]:
    study: ServedStudy = pickle.loads(content)
    return {model.name: model for model in study.models()}
