"""Types of the arrays that kernels take. Every length is in metres, every frame the body's own."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Indices = NDArray[np.int32]
