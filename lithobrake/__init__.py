"""Where does a lander end up on a small body whose soil nobody knows, and how sure are we?"""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from lithobrake.pipeline.study_run import run
    from lithobrake.results import StudyResults, open_study

__version__ = "0.1.0"
__all__ = ["StudyResults", "__version__", "open_study", "run"]


def __getattr__(name: str) -> Any:
    """Import a public name when it is asked for: whoever needs one part does not wait for all."""
    if name == "run":
        from lithobrake.pipeline.study_run import run

        return run
    if name in ("open_study", "StudyResults"):
        from lithobrake import results

        return getattr(results, name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
