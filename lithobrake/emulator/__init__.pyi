from .fitting import fit as fit
from .mean_law import MeanLaw as MeanLaw
from .model import Draws as Draws
from .model import Emulator as Emulator
from .model import law_tables as law_tables
from .model import load as load
from .output_law import OutputLaw as OutputLaw
from .validation import Scores as Scores
