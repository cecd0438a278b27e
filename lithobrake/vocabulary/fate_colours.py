"""One fate, one colour, in every figure and file: how a touchdown, a flight or a journey may end."""

from lithobrake.vocabulary.outcomes import FlightStatus, JourneyEnd, JourneyStatus, SampleOutcome

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
    JourneyStatus.SETTLED: "#2aa884",
    JourneyStatus.LOFTED: "#1b2a3a",
    JourneyStatus.SLIDING: "#6fb7e0",
    JourneyStatus.BOUNCING: "#f3c9b5",
}
# Those of the ends of journeys, each that of the fate which is like it.
END_COLOURS: dict[str, str] = {
    JourneyEnd.AT_REST: FATE_COLOURS[JourneyStatus.SETTLED],
    JourneyEnd.ESCAPED: FATE_COLOURS[FlightStatus.ESCAPED],
    JourneyEnd.PARTNER: FATE_COLOURS[FlightStatus.PARTNER],
    JourneyEnd.UNDER_WAY: FATE_COLOURS[FlightStatus.FLYING],
    JourneyEnd.FAILED: FATE_COLOURS[SampleOutcome.LEFT_SIDEWAYS],
}
OUTCOME_COLOURS = FATE_COLOURS | END_COLOURS
