"""What each run answers, and which bed it answers for: the two arrays that every estimate of a drawn study stands on.

The answer of a run is the share of its flights, over headings and all else that is uncertain of the site, in which it
returns; one that is captured answers without flying, and one of which nobody knows where it went, not at all. A study
that asks for the half width of a limit state has the share of flights that meet it for an answer.
"""

from collections.abc import Mapping

import numpy as np

from lithobrake.campaign import Record
from lithobrake.files.reading import read_rows
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.fly.run_flights import FILE
from lithobrake.pipeline.folder.study_folder import AGAIN, StudyFolder
from lithobrake.study import Study

# The stage after which every run has its answer.
ANSWERED_AFTER = "fly_runs"


def answer_words(study: Study) -> str:
    """What the answers of a study's runs are a share of, in words."""
    if study.journey is not None:
        return "the fraction at rest"
    asked = study.design.half_width_of
    return "the return fraction" if asked is None else f"the probability of {asked}"


def read_shares(folder: StudyFolder) -> dict[str, float]:
    """What a folder's table of the flights of runs says of them, by key."""
    rows = read_rows(folder / FILE, ("design", "key", "returns"), AGAIN)
    return {row["key"]: float(row["returns"] or "nan") for row in rows if row["design"] == "drawn"}


def answers_of(
    design: DrawnDesign, known: Mapping[str, Record], flown: Mapping[str, float]
) -> tuple[np.ndarray, np.ndarray]:
    """Answer of each run that has ended and flown, from 0 to 1, NaN where it has none, and its bed, both [run_count].

    design: with the runs that are asked for; known: runs that have ended, by key; flown: as flown_shares gives it. Of
    landers that are flown to the ground, those that never touch down have an answer too: 0, they do not rest.
    """
    answered = [key for key in design.keys if key in known and key in flown]
    values = np.array([flown[key] for key in answered])
    bed = np.array([known[key].inputs["bed"] for key in answered])
    if design.descents is None:
        return values, bed
    aloft = np.array(design.beds, dtype=float)[~design.descents.touches_down]
    return np.concatenate([values, np.zeros(len(aloft))]), np.concatenate([bed, aloft])
