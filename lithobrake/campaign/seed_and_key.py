"""The seed of a run, and the key in the ledger: what makes two runs the same run.

Neither depends on the design that asks for the run or on its place in the queue, so a node that two designs share is
computed once, and the number of workers changes nothing.
"""

import hashlib
import json
from collections.abc import Mapping
from typing import Any


def run_key(inputs: Mapping[str, float], seed: int, replicate: int, context: Mapping[str, Any]) -> str:
    """Name of a run: the hash of all that determines it.

    inputs: every number that the model is given. seed: seed of the study. replicate: which repetition.
    context: whatever else the result depends on (options, versions), as JSON values.
    """
    return _hash({"inputs": dict(inputs), "seed": seed, "replicate": replicate, "context": dict(context)}).hex()


def run_seed(inputs: Mapping[str, float], seed: int, replicate: int) -> int:
    """Seed of the random draws of one run; below 2**53, so that it is the same number in JSON and SQLite."""
    digest = _hash({"inputs": dict(inputs), "seed": seed, "replicate": replicate})
    return int.from_bytes(digest[:8], "big") >> 11


def _hash(value: Mapping[str, Any]) -> bytes:
    # Python writes the shortest text that reads back as the same float, so equal texts are equal bits.
    text = json.dumps(value, sort_keys=True, separators=(",", ":"), allow_nan=False)
    return hashlib.sha256(text.encode()).digest()
