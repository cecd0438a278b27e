"""The stages of journeys from bounce to bounce."""

from lithobrake.pipeline.fly.stages import PARTS as FLIGHT_PARTS
from lithobrake.pipeline.rest.aiming import aim_dependencies, aim_files, follow_aims
from lithobrake.pipeline.rest.journeys import follow_samples, rest_dependencies, rest_files
from lithobrake.pipeline.stage import Stage

PARTS = ("pipeline/rest", *FLIGHT_PARTS)

REST = Stage("rest", "bounces until rest", rest_files, follow_samples, ("fly",), rest_dependencies, PARTS)
AIM = Stage("aim", "aims", aim_files, follow_aims, ("fly",), aim_dependencies, PARTS)
