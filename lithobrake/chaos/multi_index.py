"""Which products of polynomials an expansion holds: sets of multi-indices."""

from collections.abc import Sequence
from numbers import Real

import numpy as np
from numpy.typing import NDArray

from lithobrake.vocabulary.given_numbers import whole_number

Indices = NDArray[np.int64]

# Terms that are looked at for one more input: with more, neither they nor any matrix of them would fit into memory.
LOOKED_AT = 20_000_000


def multi_index_set(
    input_count: int, degree: int, *, q_norm: float = 1.0, max_degrees: Sequence[int] | None = None
) -> Indices:
    """Multi-indices with `(sum i_r**q)**(1/q) <= degree`, shape [term_count, input_count], ordered by total degree.

    q_norm: 1 is the total degree; smaller drops interactions. max_degrees: highest degree of each input, [input_count].
    Raises ValueError for a negative degree or q_norm outside (0, 1], and for more terms than a fit could ever have.
    Source: [Landings-PCE], Eq 13; [Blatman-2011], Eq 22 (hyperbolic sets).
    """
    total = whole_number("degree", degree, 0, LOOKED_AT)
    if not isinstance(q_norm, Real) or not 0.0 < q_norm <= 1.0:
        raise ValueError(f"q_norm is {q_norm!r}, but must be above 0 and at most 1")
    highest = [total] * input_count
    if max_degrees is not None:
        highest = [min(whole_number("an entry of max_degrees", one, 0), total) for one in max_degrees]
    if len(highest) != input_count:
        raise ValueError(f"max_degrees has {len(highest)} entries, but must have one for each of {input_count} inputs")
    budget = float(degree) ** q_norm * (1.0 + 1e-12)
    rows = np.zeros((1, 0), dtype=np.int64)
    used = np.zeros(1)
    # Inputs are added one at a time and hopeless rows dropped at once, so the full tensor is never formed.
    for limit in highest:
        if len(rows) * (limit + 1) > LOOKED_AT:
            raise ValueError(
                f"degree is {degree}, which for {input_count} inputs gives too many terms to look at: {len(rows)} by "
                f"{limit + 1} for one input more, of which {LOOKED_AT} fit into memory; lower it or q_norm"
            )
        powers = np.arange(limit + 1)
        spent = used[:, None] + powers[None, :].astype(float) ** q_norm
        row, power = np.nonzero(spent <= budget)
        rows = np.column_stack([rows[row], powers[power]])
        used = spent[row, power]
    keys = [-rows[:, column] for column in reversed(range(input_count))]
    return np.ascontiguousarray(rows[np.lexsort([*keys, rows.sum(axis=1)])])
