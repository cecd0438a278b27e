"""How many nodes a grid and how many terms an expansion has, counted without making them."""

from math import comb

from lithobrake.vocabulary.given_numbers import whole_number


def term_count(input_count: int, degree: int) -> int:
    """Number of terms of total degree up to `degree`, C(n + d, d). Source: [Landings-PCE], below Eq 14."""
    whole_number("degree", degree, 0)
    return comb(whole_number("input_count", input_count, 1) + int(degree), int(degree))


def tensor_count(input_count: int, level: int) -> int:
    """Number of nodes of the full tensor grid, (level + 1)**input_count. Source: [Landings-PCE], Fig 3."""
    return (whole_number("level", level, 0) + 1) ** whole_number("input_count", input_count, 1)


def smolyak_count(input_count: int, level: int) -> int:
    """Number of distinct nodes of the sparse grid, by the nodes that each level adds. Source: [Smolyak-1963]."""
    check_level(level)
    whole_number("input_count", input_count, 1)
    # The number of nodes with k inputs away from the middle, summed over ways to share the levels among them.
    total = 0
    ways = {0: 1}
    for inputs_moved in range(min(input_count, level) + 1):
        total += comb(input_count, inputs_moved) * sum(ways.values())
        following: dict[int, int] = {}
        for spent, count in ways.items():
            for extra in range(1, level - spent + 1):
                # Clenshaw-Curtis nodes that a level adds to the one below: m(0) = 1, m(l) = 2**l + 1.
                added = 2 if extra == 1 else 2 ** (extra - 1)
                following[spent + extra] = following.get(spent + extra, 0) + count * added
        ways = following
    return total


def check_level(level: int) -> None:
    """Refuse a level of a sparse grid with a ValueError when it is out of range."""
    whole_number("level", level, 0, 20)
