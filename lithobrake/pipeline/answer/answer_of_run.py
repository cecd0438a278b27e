"""What each run answers, and which bed it answers for: the two arrays that every estimate of a drawn study stands on.

The answer of a run is the share of its flights, over headings and all else that is uncertain of the site, in which it
returns; one that is captured answers without flying, and one of which nobody knows where it went, not at all. A study
that asks for the half width of a limit state has the share of flights that meet it for an answer.
"""

from collections.abc import Mapping, Sequence

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
    keys: Sequence[str], known: Mapping[str, Record], flown: Mapping[str, float]
) -> tuple[np.ndarray, np.ndarray]:
    """Answer of each run that has ended and flown, from 0 to 1, NaN where it has none, and its bed, both [run_count].

    keys: of the runs that are asked for; known: runs that have ended, by key; flown: as flown_shares gives it.
    """
    answered = [key for key in keys if key in known and key in flown]
    return np.array([flown[key] for key in answered]), np.array([known[key].inputs["bed"] for key in answered])


def answers_of_design(
    design: DrawnDesign, known: Mapping[str, Record], flown: Mapping[str, float]
) -> tuple[np.ndarray, np.ndarray]:
    """The same of the runs of a design, with 0 for each lander that is flown to the ground and never touches down."""
    values, bed = answers_of(design.keys, known, flown)
    if design.descents is None:
        return values, bed
    aloft = np.array(design.beds, dtype=float)[~design.descents.touches_down]
    return np.concatenate([values, np.zeros(len(aloft))]), np.concatenate([bed, aloft])
