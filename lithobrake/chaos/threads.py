"""Linear algebra on one thread while an expansion is made or evaluated, so that its bits do not depend on the cores."""

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from typing import Any


@cache
def _libraries() -> Any:
    """The linear algebra libraries of this process; to find them takes milliseconds, so they are found once."""
    # SciPy brings a library of its own, which must be loaded to be found.
    import scipy.linalg  # noqa: F401
    from threadpoolctl import ThreadpoolController  # type: ignore[import-untyped]

    return ThreadpoolController()


@contextmanager
def one_thread() -> Iterator[None]:
    """Hold the linear algebra libraries to one thread; what was set before comes back at the end.

    Several threads split a matrix product by their number, and so add its terms in another order.
    """
    with _libraries().limit(limits=1):
        yield
