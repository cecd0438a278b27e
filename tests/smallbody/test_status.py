"""The words for the ends of flights and journeys."""

import numpy as np

from lithobrake.smallbody import FlightStatus, JourneyStatus
from lithobrake.smallbody.flight_results import STATUSES
from lithobrake.smallbody.integration import ESCAPED, FLYING, IMPACT, PARTNER


def test_words_are_plain_text_and_each_has_its_sentence():
    assert FlightStatus.IMPACT == "impact"
    assert f"{JourneyStatus.SETTLED}" == "settled"
    assert [*FlightStatus] == ["flying", "impact", "escaped", "partner"]
    assert set(JourneyStatus) == {
        *("settled", "lofted", "outside", "sliding", "bouncing", "flying", "escaped", "partner"),
    }
    for status in (*FlightStatus, *JourneyStatus):
        assert status.sentence.startswith("The ")
        assert status.sentence.endswith(".")
        assert type(status.value) is str


def test_the_numbers_of_the_kernels_are_in_the_order_of_the_words():
    assert STATUSES[[FLYING, IMPACT, ESCAPED, PARTNER]].tolist() == ["flying", "impact", "escaped", "partner"]
    found = STATUSES == FlightStatus.IMPACT
    assert found.tolist() == [False, True, False, False]
    assert STATUSES.dtype == np.dtype("<U7")
