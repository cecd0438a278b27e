"""What a study tells of its long pieces of work while it runs."""

import pytest

from lithobrake.pipeline import run_study
from lithobrake.study import StudySource

from .ball_studies import FEW_RUNS, FEW_SAMPLES, PROGRAM, PYTHON, write_ball

FEW = FEW_RUNS | FEW_SAMPLES
FEW |= {
    "screening_degree = 2": "screening_degree = 1\nfit = 'omp'",
    "refined_level = 3": "refined_level = 2",
    "test_count = 10": "test_count = 6",
    "sample_count = 10_000": "sample_count = 200\nscatter = true",
    "duration = 7200.0": "duration = 600.0",
}
# What was done of how much, by stage and piece of work.
Told = dict[str, dict[str, list[tuple[float, float]]]]
# Which pieces of work each stage tells of, in their order.
WORKS = {
    "screening runs": ["screening runs"],
    "screening": ["screening fit, outputs"],
    "refined runs": ["refined runs"],
    "refinement": ["refined fit, outputs"],
    "test runs": ["test kept runs", "test all runs"],
    "scores": ["scores with their intervals"],
    "flights": ["gravity table", "checks of flights", "flights", "ways of flights", "flights without scatter"],
    "bounces until rest": ["bounces, hard ground"],
}


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> tuple[Told, list[str]]:
    """What a study has told of its work, and what it has said before the first stage."""
    folder = tmp_path_factory.mktemp("told")
    path = write_ball(folder / "study.toml", FEW)
    stages: Told = {}
    said_first: list[str] = []

    class Shown:
        """Keeps what is told."""

        def say(self, sentence: str) -> None:
            if not stages:
                said_first.append(sentence)

        def begin(self, title: str, number: int, count: int) -> None:
            stages[title] = {}

        def progress(self, done: float, total: float, what: str, detail: str = "", /) -> None:
            stages[list(stages)[-1]].setdefault(what, []).append((done, total))

    run_study(StudySource.read(path), folder / "out", worker_count=1, until="rest", shown=Shown())
    return stages, said_first


@pytest.fixture
def told(study: tuple[Told, list[str]]) -> Told:
    return study[0]


def test_the_program_of_a_study_is_named_before_anything_starts_it(study: tuple[Told, list[str]]) -> None:
    (said,) = study[1]
    assert said.endswith(f"every remaining run starts: {PYTHON} {PROGRAM}")


@pytest.mark.parametrize("stage", list(WORKS))
def test_every_long_piece_of_work_is_told_of(stage: str, told: Told) -> None:
    assert list(told[stage]) == WORKS[stage]


def test_a_fit_is_counted_from_none_to_all(told: Told) -> None:
    assert [done for done, _ in told["screening"]["screening fit, outputs"]] == [0, *range(7)]
