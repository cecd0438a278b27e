"""Walkers over laws of which importance sampling finds too few points, beside laws in closed form."""

import importlib.util
from collections.abc import Iterator

import numpy as np
import pytest

from lithobrake import emulator
from lithobrake.analysis import Observation, infer, posterior
from lithobrake.chaos import Normal, sobol_sequence
from lithobrake.emulator import Emulator

from ..pipeline.few_terms import few_terms
from ..quick_studies import quick_studies

INPUTS = {name: Normal(0.0, 1.0) for name in ("friction", "density", "strength")}
# So far out that few points of the prior come near.
SEEN = [Observation({"speed": 2.2})]
needs_emcee = pytest.mark.skipif(
    importlib.util.find_spec("emcee") is None, reason='emcee is not installed: pip install "lithobrake[infer]"'
)


@pytest.fixture(scope="module", autouse=True)
def quick() -> Iterator[None]:
    """Emulators of these straight laws choose among less."""
    with quick_studies(), few_terms():
        yield


@pytest.fixture(scope="module")
def model() -> Emulator:
    """An emulator of a response that friction alone moves, with scatter 0.7."""
    random, x = np.random.default_rng(1), sobol_sequence(INPUTS, 100, seed=2)
    speed = x[:, 0] + 0.7 * random.standard_normal(100)
    return emulator.fit(INPUTS, x, speed, groups=np.arange(100) % 20, output_names=["speed"])


@needs_emcee
def test_walkers_meet_two_peaks_and_their_own_count() -> None:
    def two_peaks(points: np.ndarray) -> np.ndarray:
        # Peaks of standard deviation 0.5 at -1.5 and 1.5 of the first, the second standard normal.
        parts = [-0.5 * ((points[:, 0] - middle) / 0.5) ** 2 for middle in (-1.5, 1.5)]
        return np.logaddexp(*parts) - 0.5 * points[:, 1] ** 2

    random = np.random.default_rng(3)
    start = np.column_stack([random.choice([-1.5, 1.5], 64), random.standard_normal(64)])
    start += 0.1 * random.standard_normal(start.shape)
    points, effective = posterior.walk(two_peaks, start, seed=4)
    assert effective > 400.0
    # Five standard errors of means over so many points.
    error = 5.0 / np.sqrt(effective)
    assert points.mean(axis=0) == pytest.approx(np.zeros(2), abs=1.6 * error)
    assert points.std(axis=0) == pytest.approx([np.sqrt(1.5**2 + 0.5**2), 1.0], abs=1.6 * error)
    assert np.mean(points[:, 0] > 0.0) == pytest.approx(0.5, abs=error)
    again, _ = posterior.walk(two_peaks, start, seed=4)
    assert np.array_equal(points, again)


@needs_emcee
@pytest.mark.parametrize("own", [[], ["density"]])
def test_too_few_points_are_followed_by_walkers_that_find_the_same(
    model: Emulator, own: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    # So many autocorrelation times of 64 walkers are nearly a thousand points.
    monkeypatch.setattr(posterior, "LENGTH", 15.0)
    few = infer(model, SEEN, own=own, refit_count=0, point_count=64)
    many = infer(model, SEEN, own=own, refit_count=0)
    assert many.is_reliable
    assert few.is_reliable
    assert "too few" not in few.statement()
    for name, one in many.learnt().items():
        walked = few.learnt()[name]
        # What 400 points leave of luck, three times over.
        assert walked.after.value == pytest.approx(one.after.value, abs=0.15)
        assert walked.sd_ratio == pytest.approx(one.sd_ratio, abs=0.11)


def test_without_emcee_the_sentence_says_what_to_install(model: Emulator, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(posterior, "can_walk", lambda: False)
    few = infer(model, SEEN, refit_count=0, point_count=64)
    assert not few.is_reliable
    assert few.statement().endswith(
        "points carry weight, too few to trust any of this: install emcee, whose walkers reach what points do not: "
        'pip install "lithobrake[infer]".'
    )


@needs_emcee
def test_walkers_that_do_not_end_leave_the_points_and_say_so(model: Emulator, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(posterior, "MOST_STEPS", 20)
    monkeypatch.setattr(posterior, "BLOCK", 20)
    few = infer(model, SEEN, refit_count=0, point_count=64)
    assert not few.is_reliable
    assert "emcee's walkers did not come to an end either" in few.statement()
