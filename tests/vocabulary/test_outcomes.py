"""The words for the ends of touchdowns, flights and journeys, which stand in one file."""

import ast
from pathlib import Path

import numpy as np

from lithobrake.smallbody.flight_results import STATUSES
from lithobrake.smallbody.integration import ESCAPED, FLYING, IMPACT, PARTNER
from lithobrake.vocabulary import outcomes
from lithobrake.vocabulary.outcomes import FlightStatus, JourneyStatus, SampleOutcome, TouchdownOutcome


def test_words_are_plain_text_and_each_has_its_sentence():
    assert FlightStatus.IMPACT == "impact"
    assert f"{JourneyStatus.SETTLED}" == "settled"
    assert [*TouchdownOutcome] == ["clear", "captured", "left_sideways", "time_limit"]
    assert [*SampleOutcome] == [*TouchdownOutcome, "outside"]
    assert [*FlightStatus] == ["flying", "impact", "escaped", "partner"]
    assert set(JourneyStatus) == {
        *("settled", "lofted", "outside", "sliding", "bouncing", "flying", "escaped", "partner")
    }
    for status in (*TouchdownOutcome, *SampleOutcome, *FlightStatus, *JourneyStatus):
        assert status.sentence.startswith("The ")
        assert status.sentence.endswith(".")
        assert type(status.value) is str


def test_the_numbers_of_the_kernels_are_in_the_order_of_the_words():
    assert STATUSES[[FLYING, IMPACT, ESCAPED, PARTNER]].tolist() == ["flying", "impact", "escaped", "partner"]
    found = STATUSES == FlightStatus.IMPACT
    assert found.tolist() == [False, True, False, False]
    assert STATUSES.dtype == np.dtype("<U7")


def test_no_other_file_types_such_a_word():
    words = {str(word) for word in (*TouchdownOutcome, *FlightStatus, *JourneyStatus)}
    # These also name a table of the study file, a table of the site, and a setting of a landing.
    words -= {"impact", "partner", "time_limit"}
    for path in (Path(__file__).parents[2] / "lithobrake").rglob("*.py"):
        texts = {node.value for node in ast.walk(ast.parse(path.read_text("utf-8"))) if isinstance(node, ast.Constant)}
        assert path == Path(outcomes.__file__) or not words & texts, path
