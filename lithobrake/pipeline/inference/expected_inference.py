"""What bounces that nobody has observed yet would say of the inputs of a study."""

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True)
class ExpectedInput:
    """What is left of an input's standard deviation by number of bounces, and how many halve it; None: none does."""

    left_of_sd: Mapping[str, float]
    halved_by: float | None

    def words(self) -> str:
        """Both in words."""
        after, count = self.left_of_sd.get("1"), self.halved_by
        first = "" if after is None else f"one bounce leaves {100 * after:.0f} % of its standard deviation; "
        return first + ("no number that was tried halves it" if count is None else f"{count:.0f} halve it")


@dataclass(frozen=True)
class ExpectedInference:
    """outputs: seen of each bounce; inputs: by dotted key. Without either, `why` says what is to be done first."""

    outputs: tuple[str, ...]
    inputs: Mapping[str, ExpectedInput]
    why: str | None = None

    def lines(self) -> list[str]:
        """All of it in words, which a person should read before any bounce is looked at."""
        if self.why is not None:
            return [f"Bounces: {self.why}."]
        first = f"Bounces with observed {', '.join(self.outputs)}, for an exact emulator:"
        return [first, *(f"  {name}: {one.words()}" for name, one in self.inputs.items())]
