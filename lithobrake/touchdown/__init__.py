"""Pour and settle a bed, place a lander, run one landing, give its outcome."""

from lithobrake.touchdown.bed import Bed, ContactModel
from lithobrake.touchdown.bed_library import is_stored, stored_or_poured, take_stored
from lithobrake.touchdown.boulders import Boulders
from lithobrake.touchdown.grains import GrainSizes
from lithobrake.touchdown.lander import Lander, read_hull
from lithobrake.touchdown.landing import Landing
from lithobrake.touchdown.outcome import OUTPUTS, Outcome
from lithobrake.touchdown.pouring import BedRecipe, pour_bed
from lithobrake.touchdown.simulation import land
from lithobrake.touchdown.smallest_bed import smallest_bed, wave_speed

__all__ = [
    "OUTPUTS", "Bed", "BedRecipe", "Boulders", "ContactModel", "GrainSizes", "Lander", "Landing", "Outcome",
    "is_stored", "land", "pour_bed", "read_hull", "smallest_bed", "stored_or_poured", "take_stored", "wave_speed",
]  # fmt: skip
