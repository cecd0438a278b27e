"""The stages of journeys by the emulator of a study's touchdowns."""

from lithobrake.pipeline.emulate.stages import PARTS as EMULATOR_PARTS
from lithobrake.pipeline.emulated.delivery_options import follow_options, option_dependencies, option_files
from lithobrake.pipeline.emulated.emulated_journeys import FILES, emulated_dependencies, make_emulated
from lithobrake.pipeline.fly.stages import PARTS as FLIGHT_PARTS
from lithobrake.pipeline.stage import Stage, same_files

PARTS = ("pipeline/emulated", "pipeline/rest", "pipeline/journeys", *EMULATOR_PARTS, *FLIGHT_PARTS)

EMULATED = Stage(
    "emulated", "journeys by the emulator", same_files(*FILES), make_emulated, ("runs",), emulated_dependencies, PARTS
)
OPTIONS = Stage("aim", "delivery options", option_files, follow_options, ("emulated",), option_dependencies, PARTS)
