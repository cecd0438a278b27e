"""Things that a user names in any case: bodies and landers."""

from collections.abc import Mapping
from typing import Protocol, TypeVar


class Named(Protocol):
    """What has a name as it is printed."""

    @property
    def name(self) -> str:
        """The name."""


Known = TypeVar("Known", bound=Named)


def by_name(what: str, known: Mapping[str, Known], name: str, remedy: str) -> Known:
    """The entry of a name; keys of known are in lower case. Raises ValueError for another name, with what to do."""
    found = known.get(name.strip().lower())
    if found is None:
        raise ValueError(f"{what} is {name!r}; known are {', '.join(one.name for one in known.values())}; {remedy}")
    return found
