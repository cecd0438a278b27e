"""What each run answers, and which bed it answers for: the two arrays that every estimate of a sequence stands on.

The answer of a run is the share of its flights, over headings and all else that is uncertain of the site, in which it
returns; one that is captured answers without flying, and one of which nobody knows where it went, not at all. A study
that asks for the half width of a limit state has the share of flights that meet it for an answer.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from lithobrake.campaign import Record
from lithobrake.files.reading import read_rows
from lithobrake.pipeline.answer.failing_runs import failing_runs
from lithobrake.pipeline.fly.run_flights import FILE, RunFlights
from lithobrake.pipeline.folder.study_folder import AGAIN, StudyFolder
from lithobrake.pipeline.runs.run_table import DesignRuns, file_of
from lithobrake.study import Study
from lithobrake.vocabulary.limit_state import LimitState

# The stage after which every run has its answer.
ANSWERED_AFTER = "fly_runs"


def answer_words(study: Study) -> str:
    """What the answers of a study's runs are a share of, in words."""
    asked = study.design.half_width_of
    return "the return fraction" if asked is None else f"the probability of {asked}"


def flown_shares(study: Study, folder: StudyFolder) -> dict[str, float]:
    """Share of its flights with which each run of a study's sequence answers, by key, NaN where it has no answer.

    Of a study with more or fewer runs too: a run flies from the same sites in all of them. None at all where the file
    is not there or not whole, or was made otherwise than the study says.
    """
    from lithobrake.pipeline.stages import stage_keys

    key = folder.key_of(FILE)
    if key is None:
        return {}
    shares = read_shares(folder)
    made_for = study.with_run_count(max(len(shares), 2))
    if stage_keys(made_for)[ANSWERED_AFTER] != key:
        return {}
    return shares if study.design.half_width_of is None else _failing_shares(study, folder)


def _failing_shares(study: Study, folder: StudyFolder) -> dict[str, float]:
    """Share of its flights in which each run meets the limit state that the half width is asked of, by key."""
    if folder.key_of(file_of("sequence")) is None:
        return {}
    runs, fates = DesignRuns.load(folder, "sequence"), RunFlights.load(folder, "sequence").fates
    if runs.run_count != len(fates):
        # More runs have been made since, which have not flown.
        return {}
    state = LimitState.of(study.limit_states.conditions()[str(study.design.half_width_of)])
    return dict(zip(runs.keys, failing_runs(state, runs, fates).tolist(), strict=True))


def read_shares(folder: StudyFolder) -> dict[str, float]:
    """What a folder's table of the flights of runs says of them, by key."""
    rows = read_rows(folder / FILE, ("design", "key", "returns"), AGAIN)
    return {row["key"]: float(row["returns"] or "nan") for row in rows if row["design"] == "sequence"}


def answers_of(
    keys: Sequence[str], known: Mapping[str, Record], flown: Mapping[str, float]
) -> tuple[np.ndarray, np.ndarray]:
    """Answer of each run that has ended and flown, from 0 to 1, NaN where it has none, and its bed, both [run_count].

    keys: of the runs that are asked for; known: runs that have ended, by key; flown: as flown_shares gives it.
    """
    answered = [key for key in keys if key in known and key in flown]
    return np.array([flown[key] for key in answered]), np.array([known[key].inputs["bed"] for key in answered])
