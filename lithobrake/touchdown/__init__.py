"""Pour and settle a bed, place a lander, run one landing, give its outcome."""

from lithobrake.touchdown.bed import Bed, ContactModel
from lithobrake.touchdown.grains import GrainSizes
from lithobrake.touchdown.pouring import BedRecipe, pour_bed

__all__ = ["Bed", "BedRecipe", "ContactModel", "GrainSizes", "pour_bed"]
