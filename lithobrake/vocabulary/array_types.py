"""Types of arrays and of what goes with them."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
# Of a table that is large.
ShortIntegers = NDArray[np.int32]
Flags = NDArray[np.bool_]
# The same as they are called where no other kind stands beside them.
Array = Floats
Labels = Integers
# One place, direction or velocity.
Vector = tuple[float, float, float]
