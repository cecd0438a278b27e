"""Built-in bodies of fewer facets, for studies whose tests do not look at the shape of the ground."""

from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from lithobrake.smallbody import built_in_bodies


@contextmanager
def coarse_bodies() -> Iterator[None]:
    """240 facets in the place of 1920: what is sought among facets is found sooner."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(built_in_bodies, "RINGS", 5)
        built_in_bodies._alone.cache_clear()
        yield
    built_in_bodies._alone.cache_clear()
