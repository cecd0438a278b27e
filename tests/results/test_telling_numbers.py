"""The numbers that tell most: picked once, and the same in the sentences of a study and on its page."""

from types import SimpleNamespace
from typing import Any

from lithobrake.statements.expansion import TellingNumbers


def results(friction: tuple[float, float] = (0.2, 0.4)) -> Any:
    """What of the results of a study they are picked from; friction: interval of its index."""
    outcomes = ({"clear": 9, "captured": 2, "failed": 1}, {"clear": 4, "left_sideways": 1})
    designs = zip(("screening", "test_all"), outcomes, strict=True)
    return SimpleNamespace(
        designs={name: SimpleNamespace(outcomes=one) for name, one in designs},
        scores={"test_all": {"speed_out": SimpleNamespace(q2=0.8)}},
        refined=SimpleNamespace(
            degree=5,
            sobol_total={"speed_out": {"grain.friction": 0.3, "grain.restitution": 0.6}},
            sobol_total_interval={"speed_out": {"grain.friction": friction, "grain.restitution": (0.5, 0.7)}},
            fits={"speed_out": SimpleNamespace(noise_share=None)},
        ),
    )


SAMPLES: Any = SimpleNamespace(
    model="expansion", outputs={"speed_out": SimpleNamespace(quantiles={"quantile_0.5": 0.1})}
)


def test_touchdowns_are_counted_over_all_designs_and_failed_runs_apart() -> None:
    telling = TellingNumbers.of(results(), SAMPLES)
    assert (telling.left_count, telling.ended.total(), telling.failed) == (13, 16, 1)
    assert telling.ended["time_limit"] == 0


def test_the_main_input_has_the_largest_total_index() -> None:
    telling = TellingNumbers.of(results(), SAMPLES)
    assert telling.main_input.name == "grain.restitution"
    assert (telling.main_input.interval, telling.main_input.degree) == ((0.5, 0.7), 5)
    assert telling.main_input.equals == ()
    assert telling.speed == {"quantile_0.5": 0.1}
    assert telling.score.q2 == 0.8


def test_inputs_whose_intervals_overlap_that_of_the_main_input_are_named() -> None:
    assert TellingNumbers.of(results(friction=(0.2, 0.55)), None).main_input.equals == ("grain.friction",)
