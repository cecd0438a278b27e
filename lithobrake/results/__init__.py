"""What came out of a study: read from its folder, nothing written; one touchdown can be made again for its frames."""

from typing import TYPE_CHECKING

from lithobrake.vocabulary.lazy_names import lazy_names

if TYPE_CHECKING:
    from lithobrake.results.explorer_tables import ExplorerTables as ExplorerTables
    from lithobrake.results.journey_track import JourneyMotion as JourneyMotion
    from lithobrake.results.journey_track import JourneyTrack as JourneyTrack
    from lithobrake.results.journey_track import StudyJourney as StudyJourney
    from lithobrake.results.journey_track import TouchdownFacts as TouchdownFacts
    from lithobrake.results.motions import MovingBodies as MovingBodies
    from lithobrake.results.named_emulator import NamedEmulator as NamedEmulator
    from lithobrake.results.study_results import StudyResults as StudyResults
    from lithobrake.results.study_results import open_study as open_study
    from lithobrake.results.table import Column as Column
    from lithobrake.results.table import Table as Table
else:
    __getattr__, __dir__ = lazy_names(__name__)
