"""Landings and flights of `lithobrake doctor` on the reference machine: what its two figures were taken from.

    python benchmarks/doctor_speed.py 7

measures as the command does, seven times, takes each speed times the pace of this machine, and keeps the medians in
doctor_speed.json beside this file. The constants of lithobrake/doctor/speed.py were taken from there.
"""

import statistics
import sys
from pathlib import Path

from harness import origin, write_document

from lithobrake.doctor.speed import measured_speeds

RESULTS = Path(__file__).with_suffix(".json")


def main(repeats: int) -> None:
    first = origin(f"benchmarks/doctor_speed.py {repeats}")
    rounds = [list(measured_speeds()) for _ in range(repeats)]
    # The first speed is that of the work by which the pace of a machine is told.
    paces = [steps.reference / steps.here for steps, *_ in rounds]
    speeds = {
        rounds[0][number].what: [pace * one[number].here for pace, one in zip(paces, rounds, strict=True)]
        for number in (1, 2)
    }
    content = {**first, "paces": paces, "per_cpu_s": {what: statistics.median(all_) for what, all_ in speeds.items()},
               "all": speeds}  # fmt: skip
    write_document(RESULTS, content)


if __name__ == "__main__":
    main(int(sys.argv[1]))
