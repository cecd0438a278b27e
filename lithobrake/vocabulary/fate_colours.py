"""One fate, one colour, in every figure and file: how a touchdown, a flight or a journey may end."""

from lithobrake.vocabulary.outcomes import FlightStatus, JourneyEnd, JourneyStatus, SampleOutcome

FATE_COLOURS: dict[str, str] = {
    FlightStatus.IMPACT: "#2f6fb0",
    FlightStatus.FLYING: "#8b8f96",
    FlightStatus.ESCAPED: "#e69f00",
    FlightStatus.PARTNER: "#a8659a",
    SampleOutcome.CAPTURED: "#98b06f",
    SampleOutcome.LEFT_SIDEWAYS: "#c8553d",
    SampleOutcome.TIME_LIMIT: "#d9cb3f",
    SampleOutcome.OUTSIDE: "#7a5c3e",
    JourneyStatus.SETTLED: "#1f9e78",
    JourneyStatus.LOFTED: "#31465a",
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
