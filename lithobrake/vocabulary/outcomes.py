"""How touchdowns, flights and journeys may end: words, their sentences, and one colour for each."""

from enum import StrEnum

RETURNS = "returns"


class _Ending(StrEnum):
    """A word that compares equal to plain text, and what it means; label: a few words for it beside a number."""

    sentence: str
    label: str

    def __new__(cls, word: str, sentence: str = "", label: str = "") -> "_Ending":
        """Keep sentence and label beside the word."""
        member = str.__new__(cls, word)
        member._value_, member.sentence, member.label = word, sentence, label or word
        return member

    @property
    def texts(self) -> tuple[str, str, str]:
        """Word, sentence and label, for an enumeration that has the same ending."""
        return self.value, self.sentence, self.label


class TouchdownOutcome(_Ending):
    """How a touchdown ended; one that is clear has outputs."""

    CLEAR = "clear", "The lander leaves the surface.", "left the surface"
    CAPTURED = "captured", "The lander is captured."
    LEFT_SIDEWAYS = (
        "left_sideways",
        "The lander leaves the bed laterally, and does not clearly fly.",
        "left the bed laterally",
    )
    TIME_LIMIT = "time_limit", "The lander is still in contact at the time limit.", "in contact at the time limit"


class SampleOutcome(_Ending):
    """What became of a sample at the touchdown: as of a run, or the expansion gave a way to leave that there is not."""

    CLEAR = TouchdownOutcome.CLEAR.texts
    CAPTURED = TouchdownOutcome.CAPTURED.texts
    LEFT_SIDEWAYS = TouchdownOutcome.LEFT_SIDEWAYS.texts
    TIME_LIMIT = TouchdownOutcome.TIME_LIMIT.texts
    OUTSIDE = "outside", "The sampled elevation was outside 0 to 90 deg.", "sampled outside 0 to 90 deg"


class FlightStatus(_Ending):
    """How a flight ended."""

    FLYING = "flying", "The lander was still in flight at the time limit."
    IMPACT = "impact", "The lander hit the body."
    ESCAPED = "escaped", "The lander left for good: far out, moving outwards, with positive two-body energy."
    PARTNER = "partner", "The lander hit the partner of the body."


class CapturedFate(_Ending):
    """Whether the ground holds a lander that was captured."""

    SETTLED = "settled", "The lander lies where gravity, rotation and friction together hold it."
    LOFTED = "lofted", "The lander was captured where gravity and rotation together push it outwards."


class JourneyEnd(_Ending):
    """How a journey of landings ended."""

    AT_REST = "at_rest", "The lander rests where the ground holds it.", "at rest"
    ESCAPED = "escaped", FlightStatus.ESCAPED.sentence, "escaped"
    PARTNER = (
        "partner",
        "The lander rests on the other body of the binary; on a planet it is not followed.",
        "at rest on the partner",
    )
    UNDER_WAY = "under_way", "The lander was still under way at the time limit.", "under way"
    FAILED = "failed", "A landing or flight of the journey failed.", "failed"


# How a journey ends that has come to rest: on the body of the site, and on its partner.
RESTS = (JourneyEnd.AT_REST, JourneyEnd.PARTNER)

# Of a captured lander also whether gravity and rotation together hold it where it lies, or lift it off.
CAPTURED = TouchdownOutcome.CAPTURED.value
SETTLED, LOFTED = CapturedFate.SETTLED.value, CapturedFate.LOFTED.value
# What becomes of a lander in the first flight, as a word that is true or false.
FATES = (RETURNS, CAPTURED, SETTLED, LOFTED, *(status.value for status in FlightStatus))


# One outcome, one colour, in every figure and file; a test holds that colour-blind readers tell them apart.
FATE_COLOURS: dict[str, str] = {
    FlightStatus.IMPACT: "#4a90d9",
    FlightStatus.FLYING: "#4d5560",
    FlightStatus.ESCAPED: "#e69f00",
    FlightStatus.PARTNER: "#7b4fa3",
    SampleOutcome.CAPTURED: "#b5cf6b",
    SampleOutcome.LEFT_SIDEWAYS: "#b23a2e",
    SampleOutcome.TIME_LIMIT: "#f0e442",
    SampleOutcome.OUTSIDE: "#a6845f",
    CapturedFate.SETTLED: "#2aa884",
    CapturedFate.LOFTED: "#1b2a3a",
}
# Those of the ends of journeys, each that of the fate which is like it.
END_COLOURS: dict[str, str] = {
    JourneyEnd.AT_REST: FATE_COLOURS[CapturedFate.SETTLED],
    JourneyEnd.ESCAPED: FATE_COLOURS[FlightStatus.ESCAPED],
    JourneyEnd.PARTNER: FATE_COLOURS[FlightStatus.PARTNER],
    JourneyEnd.UNDER_WAY: FATE_COLOURS[FlightStatus.FLYING],
    JourneyEnd.FAILED: FATE_COLOURS[SampleOutcome.LEFT_SIDEWAYS],
}
OUTCOME_COLOURS = FATE_COLOURS | END_COLOURS
