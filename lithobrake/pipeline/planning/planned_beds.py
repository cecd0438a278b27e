"""How many beds a study lands on, and how many of them need not be poured."""

from dataclasses import dataclass

from lithobrake.pipeline.design.dependencies import bed_files
from lithobrake.pipeline.folder.study_folder import StudyFolder
from lithobrake.pipeline.runs.beds import bed_recipe
from lithobrake.pipeline.stages import stage_keys
from lithobrake.study import Study
from lithobrake.study.touchdown_model import in_words_of_the_study


@dataclass(frozen=True)
class PlannedBeds:
    """Beds of a study: all of them, those that its folder has, those that the library of beds has beside them."""

    total: int
    in_folder: int
    in_library: int

    @property
    def new(self) -> int:
        """Those that are to be poured."""
        return self.total - self.in_folder - self.in_library


def planned_beds(study: Study, folder: StudyFolder) -> PlannedBeds:
    """The beds of a study; none where a program of the user's own makes the touchdowns."""
    from lithobrake.touchdown import is_stored

    key, files = stage_keys(study)["bed"], bed_files(study)
    absent = [index for index, file in enumerate(files) if not folder.is_current([file], key)]
    with in_words_of_the_study():
        stored = sum(is_stored(bed_recipe(study, index)) for index in absent)
    return PlannedBeds(len(files), len(files) - len(absent), stored)
