"""Friction of a lander that slides on a bed of hulls about as large as itself, as landers pushed along beds show it.

It lies among stones and has to come over them, which friction of its contacts adds to: an edge that catches holds it
even where contacts are smooth. Measured by validation/sliding_law.py; docs/validation/sliding_law.md has the
pushes, and sliding_law.json there the numbers.
"""

import numpy as np

from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.study.touchdown_model import grain_sizes, lander

# Effective friction over friction of the contacts: a line through pushes as slow as captured landers.
INTERCEPT, SLOPE = 0.49, 0.32
# Frictions, and smallest edges of the lander in grains, between which it was measured.
FRICTIONS, EDGES = (0.2, 0.8), (0.55, 1.7)
# Grains whose mean size stands for all.
GRAINS = 1000


def has_measured_size(design: DrawnDesign) -> bool:
    """Whether the study's lander is one that the law was measured for: one hull, no ball, about as large as a grain."""
    study = design.study
    if not study.has_soil or study.lander.shape == "sphere" or study.lander.part:
        return False
    sizes = grain_sizes(study).draw((np.arange(GRAINS) + 0.5) / GRAINS)
    least, largest = EDGES
    return bool(least <= lander(study, design.medians).smallest_edge / sizes.mean() <= largest)


def effective_friction(friction: np.ndarray) -> np.ndarray:
    """Friction that stops a lander on hulls, by that of its contacts; beyond the measured ones that of the end."""
    return INTERCEPT + SLOPE * np.clip(friction, *FRICTIONS)
