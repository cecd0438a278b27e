"""Studies in the process of these tests are quick."""

from collections.abc import Iterator

import pytest

from ..quick_studies import quick_studies


@pytest.fixture(scope="module", autouse=True)
def quick() -> Iterator[None]:
    """See quick_studies; fixtures of a session are made before, and ask for it themselves."""
    with quick_studies():
        yield
