"""How far a piece of work is, as whoever does it tells whoever shows it."""

from collections.abc import Callable

# Called with the fraction that is done, 0 to 1, of what is being done.
Progress = Callable[[float, str], None]


def silent(fraction: float, what: str) -> None:
    """Show nothing."""
