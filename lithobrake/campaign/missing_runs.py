"""Runs that failed: how many are missing, and whether they leave a hole in the design."""

from collections.abc import Iterator, Sequence
from itertools import combinations, product
from math import comb
from typing import TYPE_CHECKING

from lithobrake.campaign.run_counts import common_reasons

if TYPE_CHECKING:
    import numpy as np

# A chance below this, over all corners looked at, is no chance [-].
_CHANCE = 0.01


def missing(x: "np.ndarray", reasons: Sequence[str | None], names: Sequence[str], largest_share: float) -> str:
    """Say how many runs of a design have failed, and why; the empty string for none.

    x: inputs, shape [run_count, len(names)]. reasons: why each run failed, None where it has not. largest_share: of
    failed runs that is accepted [-]. Raises ValueError when more have failed, or when those that did lie together on
    one side of an input, or in a corner of two, as they would by chance in less than 1 of 100 designs: what is fitted
    without them would know nothing there.
    """
    # Who only looks at a ledger, as a second terminal does every few seconds, needs no arrays.
    import numpy as np

    failed = np.array([reason is not None for reason in reasons])
    count, total = int(failed.sum()), len(failed)
    if count == 0:
        return ""
    sentence = f"{count} of {total} runs failed ({common_reasons(reasons)})"
    corner = _corner(x, failed, names)
    if count > largest_share * total:
        place = "" if corner is None else f", {corner[0]} of them where {corner[1]}"
        raise ValueError(
            f"{sentence}{place}; allowed: at most {100 * largest_share:g} %; remove what makes them fail, try them "
            "again (campaign.retry_count), or allow more (campaign.failed_share)"
        )
    if corner:
        inside, where = corner
        raise ValueError(
            f"{sentence}; {inside} of them lie where {where}, so what is fitted without them knows nothing there; "
            "remove what makes them fail, or narrow these inputs"
        )
    return f"{sentence}; what is fitted goes without them"


def _corner(x: "np.ndarray", failed: "np.ndarray", names: Sequence[str]) -> tuple[int, str] | None:
    """The corner in which failures are least likely by chance: how many, and where; None when chance may do it.

    Among the failed and the others drawn without order, the number of failed ones in a corner has the hypergeometric
    distribution; the chance is multiplied by the number of corners looked at (Bonferroni).
    """
    corners = list(_corners(x, names))
    best: tuple[float, int, str] | None = None
    for inside, where in corners:
        hit = int((inside & failed).sum())
        chance = _at_least(hit, int(inside.sum()), int(failed.sum()), len(failed))
        if best is None or chance < best[0]:
            best = chance, hit, where
    if best is None or best[0] * len(corners) > _CHANCE:
        return None
    return best[1], best[2]


def _corners(x: "np.ndarray", names: Sequence[str]) -> "Iterator[tuple[np.ndarray, str]]":
    """Every side of every input that varies, below or above its middle value, and every corner of two such sides."""
    import numpy as np

    sides: list[list[tuple[np.ndarray, str]]] = []
    for column, name in enumerate(names):
        values = x[:, column]
        middle = float(np.median(values))
        if values.min() < values.max():
            sides.append([(values < middle, f"{name} < {middle:.4g}"), (values > middle, f"{name} > {middle:.4g}")])
    for pair in sides:
        yield from pair
    for first, second in combinations(sides, 2):
        for (one, here), (other, there) in product(first, second):
            yield one & other, f"{here} and {there}"


def _at_least(hit: int, inside: int, drawn: int, total: int) -> float:
    """Chance that of `drawn` out of `total`, at least `hit` are among the `inside` ones [-]."""
    ways = sum(comb(inside, k) * comb(total - inside, drawn - k) for k in range(hit, min(inside, drawn) + 1))
    return ways / comb(total, drawn)
