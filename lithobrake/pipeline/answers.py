"""What each run answers, and which bed it answers for: the two arrays that every estimate of a sequence stands on.

The answer of a run is, for now, whether the lander was captured. Where flights give each run its share of headings that
stay, `answers_of` reads that in its place, and `ANSWERED_AFTER` names the stage that writes it.
"""

from collections.abc import Sequence

import numpy as np

from lithobrake.campaign import Record
from lithobrake.outcomes import TouchdownOutcome

# The stage after which every run has its answer, and what the answers are a share of, in words.
ANSWERED_AFTER, ANSWER = "runs", "the share captured"
_ANSWERS = {TouchdownOutcome.CAPTURED.value: 1.0, TouchdownOutcome.CLEAR.value: 0.0}


def answers_of(records: Sequence[Record]) -> tuple[np.ndarray, np.ndarray]:
    """Answer of each run, from 0 to 1, NaN where it has none, and its bed, both of shape [run_count]."""
    values = [_ANSWERS.get(record.outcome or "", np.nan) for record in records]
    return np.array(values, dtype=float), np.array([record.inputs["bed"] for record in records])
