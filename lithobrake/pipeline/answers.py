"""What each run answers, and which bed it answers for: the two arrays that every estimate of a sequence stands on.

The answer of a run is the share of its flights, over headings and all else that is uncertain of the site, in which it
stays; one that is captured answers without flying, and one of which nobody knows where it went, not at all.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from lithobrake.campaign import Record
from lithobrake.pipeline.folder import AGAIN, StudyFolder
from lithobrake.pipeline.run_flights import FILE
from lithobrake.reading import read_rows
from lithobrake.study import Study

# The stage after which every run has its answer, and what the answers are a share of, in words.
ANSWERED_AFTER, ANSWER = "fly_runs", "the share that stays"


def flown_shares(study: Study, folder: StudyFolder) -> dict[str, float]:
    """Share of its flights in which each run of a study's sequence stays, by key, NaN where it has no answer.

    Of a study with more or fewer runs too: a run flies from the same sites in all of them. None at all where the file
    is not there or not whole, or was made otherwise than the study says.
    """
    from lithobrake.pipeline.stages import stage_keys

    key = folder.key_of(FILE)
    if key is None:
        return {}
    shares = read_shares(folder)
    made_for = study.with_run_count(max(len(shares), 2))
    return shares if stage_keys(made_for)[ANSWERED_AFTER] == key else {}


def read_shares(folder: StudyFolder) -> dict[str, float]:
    """What a folder's table of the flights of runs says of them, by key."""
    rows = read_rows(folder / FILE, ("design", "key", "stays"), AGAIN)
    return {row["key"]: float(row["stays"] or "nan") for row in rows if row["design"] == "sequence"}


def answers_of(
    keys: Sequence[str], known: Mapping[str, Record], flown: Mapping[str, float]
) -> tuple[np.ndarray, np.ndarray]:
    """Answer of each run that has ended and flown, from 0 to 1, NaN where it has none, and its bed, both [run_count].

    keys: of the runs that are asked for; known: runs that have ended, by key; flown: as flown_shares gives it.
    """
    answered = [key for key in keys if key in known and key in flown]
    return np.array([flown[key] for key in answered]), np.array([known[key].inputs["bed"] for key in answered])
