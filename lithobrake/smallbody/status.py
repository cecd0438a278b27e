"""How flights and journeys may end: words as they stand in files, each with its sentence."""

from enum import StrEnum


class _Status(StrEnum):
    """A word that compares equal to plain text, and what it means."""

    sentence: str

    def __new__(cls, word: str, sentence: str) -> "_Status":
        """Keep the sentence beside the word."""
        member = str.__new__(cls, word)
        member._value_, member.sentence = word, sentence
        return member


class FlightStatus(_Status):
    """How a flight ended."""

    FLYING = "flying", "The lander still flew when the time was over."
    IMPACT = "impact", "The lander came down on the body."
    ESCAPED = "escaped", "The lander left for good: far out, moving outwards, with positive two-body energy."
    PARTNER = "partner", "The lander came down on the partner of the body."


class JourneyStatus(_Status):
    """How a journey from bounce to bounce ended."""

    SETTLED = "settled", "The lander was captured where gravity and rotation together hold it."
    LOFTED = "lofted", "The lander was captured where gravity and rotation together push it outwards."
    OUTSIDE = "outside", "The model of the bounce does not know the impact, and the journey stops there."
    SLIDING = "sliding", "The lander moves along the ground, which is not followed."
    BOUNCING = "bouncing", "The largest number of bounces did not bring the lander to rest."
    FLYING = FlightStatus.FLYING.value, FlightStatus.FLYING.sentence
    ESCAPED = FlightStatus.ESCAPED.value, FlightStatus.ESCAPED.sentence
    PARTNER = (
        FlightStatus.PARTNER.value,
        "The lander came down on the partner, where no bounce is followed.",
    )
