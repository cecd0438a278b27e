"""What a user writes: the study file, its quantities with units and ranges, and all that may be wrong with it."""

from lithobrake.study.reader import StudyError, check_tables, known_keys, load_tables, read_study
from lithobrake.study.source import StudySource, fixed_study
from lithobrake.study.study import Study
from lithobrake.vocabulary.known_bodies import BUILT_IN_BODIES

__all__ = [
    "BUILT_IN_BODIES", "Study", "StudyError", "StudySource", "check_tables", "fixed_study", "known_keys", "load_tables",
    "read_study",
]  # fmt: skip
