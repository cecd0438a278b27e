"""Least squares by orthogonal factorisation, refusing what does not determine every term."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lithobrake.chaos.multi_index import Indices
from lithobrake.vocabulary.arrays import Array

# Singular values below this times the largest are rank loss: far below any usable condition number,
# far above the rounding of an exactly deficient system.
RANK_TOLERANCE = 1e-10
# Lost terms that a refusal names.
LOST_LISTED = 20


@dataclass(frozen=True)
class LeastSquares:
    """coefficients [term_count, output_count]; orthogonal factor [count, term_count]; residuals; condition number;
    predicted_variance: of a prediction averaged over the inputs, for outputs that scatter with variance 1.
    """

    coefficients: Array
    orthogonal: Array
    residuals: Array
    condition: float
    predicted_variance: float

    def left_out(self, groups: Sequence[NDArray[np.int64]]) -> Array:
        """Error at each point of the fit without it (or without its group of rows), [count, output_count].

        Source: [Allen-1974] (PRESS); [Cook-1982], section 3.6 (groups).
        """
        if not groups:
            leverage = np.einsum("ij,ij->i", self.orthogonal, self.orthogonal)
            return self.residuals / np.maximum(1.0 - leverage, np.finfo(float).eps)[:, None]
        errors = np.empty_like(self.residuals)
        for rows in groups:
            part = self.orthogonal[rows]
            # A group that alone determines a direction leaves nothing to predict it by: the pseudo-inverse says 0
            # there, as far as rounding lets it.
            own = np.eye(len(rows)) - part @ part.T
            errors[rows] = np.linalg.pinv(own, rcond=1e-12, hermitian=True) @ self.residuals[rows]
        return errors


def term_name(index: Sequence[int], names: Sequence[str]) -> str:
    """A term in words, for instance "friction^2 speed"."""
    parts = [f"{name}^{power}" if power > 1 else name for name, power in zip(names, index, strict=True) if power]
    return " ".join(parts) or "constant"


def _lost_terms(triangle: Array, values: Array, indices: Indices, names: Sequence[str], count: int) -> str:
    """The sentence that refuses a rank-deficient fit; pivoting finds terms that the others determine."""
    from scipy.linalg import qr

    _, _, order = qr(triangle, mode="economic", pivoting=True)
    rank = int(np.sum(values > RANK_TOLERANCE * values[0]))
    lost = [term_name(indices[k], names) for k in sorted(order[rank:])]
    more = f" and {len(lost) - LOST_LISTED} more" if len(lost) > LOST_LISTED else ""
    return (
        f"the {count} points determine only {rank} of {len(indices)} terms "
        f"(lost: {', '.join(lost[:LOST_LISTED])}{more}, which the others cannot be told from): "
        "lower the degree, raise the level of the design or add points"
    )


def solve_least_squares(
    matrix: Array, y: Array, *, indices: Indices, names: Sequence[str], weights: Array | None = None
) -> LeastSquares:
    """Solve min sum w_k (y_k - H_k c)**2 by QR; matrix H [count, term_count], y [count, output_count].

    It takes at least as many points as terms. Raises ValueError for rank deficiency, naming terms that cannot be told
    apart.
    Source: [Landings-PCE], Eqs 15 and 16; [Golub-2013], section 5.5.
    """
    from scipy.linalg import solve_triangular

    root = None if weights is None else np.sqrt(weights)[:, None]
    orthogonal, triangle = np.linalg.qr(matrix if root is None else matrix * root)
    values = np.linalg.svd(triangle, compute_uv=False)
    if values[-1] <= RANK_TOLERANCE * values[0]:
        raise ValueError(_lost_terms(triangle, values, indices, names, len(matrix)))
    coefficients = solve_triangular(triangle, orthogonal.T @ (y if root is None else y * root), check_finite=False)
    residuals = y - matrix @ coefficients
    # In an orthonormal basis the mean of psi (H'H)**-1 psi over the inputs is the trace of the inverse.
    spread = float(np.sum(values**-2.0)) if weights is None else 0.0
    return LeastSquares(coefficients, orthogonal, residuals, float(values[0] / values[-1]), spread)
