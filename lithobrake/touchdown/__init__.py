"""Pour and settle a bed, place a lander, run one landing, give its outcome."""

from lithobrake.touchdown.bed import Bed, ContactModel
from lithobrake.touchdown.bed_library import is_stored, stored_or_poured, take_stored
from lithobrake.touchdown.grains import Boulders, GrainSizes
from lithobrake.touchdown.lander import Lander, read_hull, smallest_bed, wave_speed
from lithobrake.touchdown.landing import OUTPUTS, Landing, Outcome
from lithobrake.touchdown.pouring import BedRecipe, pour_bed
from lithobrake.touchdown.simulation import land

__all__ = [
    "OUTPUTS", "Bed", "BedRecipe", "Boulders", "ContactModel", "GrainSizes", "Lander", "Landing", "Outcome",
    "is_stored", "land", "pour_bed", "read_hull", "smallest_bed", "stored_or_poured", "take_stored", "wave_speed",
]  # fmt: skip
