"""First contacts without a study, of one motion, for a process that imports nothing else."""

from types import SimpleNamespace

import numpy as np

from lithobrake.pipeline.nowcast.contact_emulator import FirstContacts

MOTION = {"spin_out": 2.0, "elevation_out": 0.7, "speed_out": 0.3}
MOTION_ERRORS = {"spin_out": 0.1, "elevation_out": 0.01, "speed_out": 0.02}


def contacts(beyond: list[str]) -> FirstContacts:
    """Landers that all left with one motion, of an emulator that is asked for its seed and a range alone."""
    count = len(beyond)
    emulator = SimpleNamespace(
        design=SimpleNamespace(study=SimpleNamespace(seed=3)), ranges={"impact.speed": (0.01, 0.1)}
    )
    outputs = {"speed_out": 0.1, "elevation_out": 0.5, "azimuth_out": 0.0, "spin_out": 1.0}
    every = {name: np.full(count, value) for name, value in outputs.items()}
    whole, axis, ended = np.arange(count), np.tile([0.0, 1.0, 0.0], (count, 1)), np.full(count, "clear")
    return FirstContacts(emulator, None, whole, whole, ended, every, axis, {}, np.array(beyond))  # type: ignore[arg-type]
