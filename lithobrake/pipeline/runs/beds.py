"""The beds of a study: what they follow from, and how they are poured."""

from typing import TYPE_CHECKING

from lithobrake.pipeline.design.dependencies import bed_files, pour_seed
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.pouring import pour_at_once
from lithobrake.study import Study
from lithobrake.study.touchdown_model import (
    acceleration,
    boulders,
    contact,
    grain,
    grain_sizes,
    in_words_of_the_study,
    medians,
)

if TYPE_CHECKING:
    from lithobrake.touchdown import BedRecipe


def pour_beds(job: Job) -> None:
    """Put every bed into the folder that is not there yet, or no longer good: from the library, or poured.

    Raises ValueError that names the beds which cannot be poured, when all others are there.
    """
    from lithobrake.touchdown import take_stored

    (job.folder / "beds").mkdir(exist_ok=True)
    names = {index: name for index, name in enumerate(bed_files(job.study)) if name in job.wanted}
    with in_words_of_the_study():
        recipes = {index: bed_recipe(job.study, index) for index in names}
        new = {index: recipe for index, recipe in recipes.items() if not take_stored(recipe, job.folder / names[index])}
    found = len(names) - len(new)
    if found:
        job.say(f"bed: {found} of {len(names)} {'was' if found == 1 else 'were'} in the library of beds")
    if new:
        pour_at_once(job, {index: (recipe, job.folder.path.absolute() / names[index]) for index, recipe in new.items()})


def bed_recipe(study: Study, index: int) -> "BedRecipe":
    """What the bed of a number follows from, uncertain quantities at their median."""
    from lithobrake.touchdown import BedRecipe

    values = medians(study)
    return BedRecipe(
        grain_count=study.bed.grain_count,
        sizes=grain_sizes(study),
        cloud_point_count=study.bed.cloud_point_count,
        width=study.bed.width,
        material=grain(values),
        gravity=acceleration(values, study.bed.settle_gravity or values["surface.gravity"]),
        pour_gravity=study.bed.pour_gravity,
        seed=pour_seed(study, index),
        contact=contact(study),
        sides=study.bed.sides,
        boulders=boulders(study),
    )
