"""The stage that looks up from where landers rest."""

from lithobrake.pipeline.fly.stages import PARTS as FLIGHT_PARTS
from lithobrake.pipeline.sky.seen_from_rest import look_up, sky_dependencies, sky_files
from lithobrake.pipeline.stage import Stage

PARTS = ("pipeline/sky", "pipeline/site.py", *FLIGHT_PARTS)

SKY = Stage("sky", "sky over the landers at rest", sky_files, look_up, ("runs",), sky_dependencies, PARTS)
