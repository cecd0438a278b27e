"""What becomes of an odd input: the classes, and how one is told from another."""

import json
import math
import os
import signal
import traceback
import warnings
from collections.abc import Callable, Iterator
from contextlib import chdir, contextmanager, redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from typing import Any

# What a user may meet; those of FAULTS should never be.
RIGHT, REFUSED = "right", "refused"
SILENT, LATE, TRACEBACK, ENDLESS = FAULTS = ("silent", "late", "traceback", "endless")
# Longest refusal, plan, or run of a few landers, on a machine that has other work [s].
LONGEST = 180


class TooLong(BaseException):
    """Passes every handler of an input that takes too long."""


class Silent(Exception):
    """What is wrong with something that was taken without a word."""


class Late(Exception):
    """A refusal that comes after work."""


@dataclass(frozen=True)
class Case:
    """An odd input.

    kind: the oddity. words: what the input is. never: whether it can never be valid. plan: looks at the input in an
    empty folder, before anything is made. run: makes what was planned; None where a plan is all.
    """

    kind: str
    words: str
    never: bool
    plan: Callable[[Path], object]
    run: Callable[[Path], object] | None = None


@dataclass(frozen=True)
class Verdict:
    """The class of a case, and its last words."""

    name: str
    words: str = ""


def judged(case: Case, folder: Path, longest: float = LONGEST) -> Verdict:
    """The class of a case, which may leave files in an empty folder."""
    stage = "plan"
    try:
        # Where a command writes that names no folder.
        with chdir(folder), _within(longest), _no_warnings():
            case.plan(folder)
            stage = "run"
            if case.never:
                return Verdict(SILENT, "it is taken")
            if case.run is not None:
                case.run(folder)
        return Verdict(RIGHT)
    except TooLong:
        return Verdict(ENDLESS, f"the {stage} takes longer than {longest:g} s")
    except RuntimeWarning as error:
        return Verdict(SILENT, f"a warning reaches the user in the {stage}: {error}{_where(error)}")
    except Silent as error:
        return Verdict(SILENT, str(error))
    except Late as error:
        return Verdict(LATE, str(error))
    except (ValueError, ImportError, OSError, FloatingPointError) as error:
        if stage == "run":
            return Verdict(LATE, f"{type(error).__name__}: {error}{_where(error)}")
        return Verdict(REFUSED, str(error)) if is_told(error) else Verdict(TRACEBACK, traceback.format_exc(limit=-3))
    # Whatever else comes is what is looked for.
    except Exception:
        return Verdict(TRACEBACK, traceback.format_exc(limit=-4))


def is_told(error: Exception) -> bool:
    """Whether an error is one of the package's own sentences, which name what to do, or one of the system's."""
    return isinstance(error, OSError) or any(sign in str(error) for sign in (";", "allowed", ":", ", "))


def refuse_nonfinite(found: Any) -> None:
    """Raise Silent where JSON values hold a number that is not finite."""
    try:
        json.dumps(found, allow_nan=False, default=str)
    except ValueError as error:
        raise Silent(f"the result has numbers that are not finite: {', '.join(_nonfinite(found, ''))[:200]}") from error


def _nonfinite(found: Any, path: str) -> Iterator[str]:
    if isinstance(found, dict):
        for key, value in found.items():
            yield from _nonfinite(value, f"{path}.{key}")
    elif isinstance(found, list | tuple):
        for place, value in enumerate(found):
            yield from _nonfinite(value, f"{path}.{place}")
    elif isinstance(found, float) and not math.isfinite(found):
        yield path.lstrip(".")


def _where(error: BaseException) -> str:
    last = traceback.extract_tb(error.__traceback__)[-1]
    return f" ({Path(last.filename).name}:{last.lineno})"


@contextmanager
def _no_warnings() -> Iterator[None]:
    """A RuntimeWarning is raised; what is said meanwhile goes nowhere."""
    with warnings.catch_warnings(), open(os.devnull, "w", encoding="utf-8") as nowhere:
        warnings.simplefilter("ignore")
        warnings.simplefilter("error", RuntimeWarning)
        with redirect_stdout(nowhere), redirect_stderr(nowhere):
            yield


@contextmanager
def _within(seconds: float) -> Iterator[None]:
    """Raise TooLong in what takes longer; again each second, as a callback of C may swallow the first."""

    def stop(*_: object) -> None:
        raise TooLong

    before = signal.signal(signal.SIGALRM, stop)
    signal.setitimer(signal.ITIMER_REAL, seconds, 1.0)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
