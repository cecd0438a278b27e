"""How many nodes a sparse grid and how many terms an expansion has, counted without making them."""

from math import comb
from numbers import Real


def whole_number(name: str, value: object, at_least: int, at_most: int | None = None) -> int:
    """Check a whole number and give it back; raises ValueError for anything else, with its name and range."""
    whole = isinstance(value, Real) and not isinstance(value, bool) and value % 1 == 0
    if not whole or value < at_least or (at_most is not None and value > at_most):  # type: ignore[operator]
        allowed = f"of at least {at_least}" if at_most is None else f"from {at_least} to {at_most}"
        raise ValueError(f"{name} is {value!r}, but must be a whole number {allowed}")
    return int(value)  # type: ignore[call-overload]


def term_count(input_count: int, degree: int) -> int:
    """Number of terms of total degree up to `degree`, C(n + d, d). Source: [Landings-PCE], below Eq 14."""
    return comb(input_count + degree, degree)


def smolyak_count(input_count: int, level: int) -> int:
    """Number of distinct nodes of the sparse grid, by the nodes that each level adds. Source: [Smolyak-1963]."""
    check_level(level)
    # The number of nodes with k inputs away from the middle, summed over ways to share the levels among them.
    total = 0
    ways = {0: 1}
    for inputs_moved in range(min(input_count, level) + 1):
        total += comb(input_count, inputs_moved) * sum(ways.values())
        following: dict[int, int] = {}
        for spent, count in ways.items():
            for extra in range(1, level - spent + 1):
                following[spent + extra] = following.get(spent + extra, 0) + count * _new_node_count(extra)
        ways = following
    return total


def _new_node_count(level: int) -> int:
    """Number of Clenshaw-Curtis nodes that a level adds to the one below: m(0) = 1, m(l) = 2**l + 1."""
    return 2 if level == 1 else int(2 ** (level - 1))


def check_level(level: int) -> None:
    """Refuse a level of a sparse grid with a ValueError when it is out of range."""
    whole_number("level", level, 0, 20)
