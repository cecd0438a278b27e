"""What each trick of the soft-surface engine gains, and what it changes: the engine with all but one, beside all.

    python benchmarks/engine_switches.py BED_FOLDER [SWITCH ...] [--out FILE]

A switch turns one trick off in a copy of the package, which is compiled anew (a minute of CPU time) and timed in a
process of its own on hull1000 and sph4000 at rest and on a CubeSat's touchdown. Medians of CPU times; beside them, how
far from where they end with every trick on the bodies end. Rows of FILE whose switches are not asked for stay.
"""

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from grains_beds import bed, relaxed, touch_down
from harness import ROOT, Row, command_line, cpu_seconds, origin, read_document, write_document

# Name, file, what stands there, what stands there without the trick.
SWITCHES = {
    "sleeping pairs": ("narrow_phase/feature_list.py", "        if travel < pairs.wake[pair]:", "        if False:"),
    "gaps as margins": ("narrow_phase/feature_list.py", "        return bound - reach\n", "        return margin\n"),
    "names of faces": ("narrow_phase/contact_patch.py", "    if face >= 0:", "    if False:"),
    "one point pushes once": ("law/hertz_spring.py", "    if contact.points == 1 and patch.family[0] != DEEP_EDGES:",
                              "    if bodies.turning_radius[first] == 0.0:"),
    "one pair of edges alone": ("narrow_phase/patch_energy.py", "(patch.family[0] == EDGES_APART and deep == 0.0)",
                                "False"),
    "spheres met by their mass": ("law/contact_law.py", "contact.through_centroids or step.paper_mass",
                                  "step.paper_mass"),
    "limits by squares": ("law/tangential_spring.py", "    return vector if square <= limit * limit else",
                          "    return vector if square**0.5 <= limit else"),
    "neighbours by their gap": ("stepping/neighbours.py", "    return found != APART", "    return True"),
    "edges by their part in the band": ("narrow_phase/feature_list.py", "    return low[0] - high[0] >= farthest or",
                                        "    if farthest > 0.0:\n        return False\n    return"),
    "skin of the list": ("stepping/engine.py", "SKIN = 0.25", "SKIN = 0.025"),
    "one moment of inertia": ("stepping/engine.py", "(inertia == inertia[:, :1, :1] * np.eye(3)).all(axis=(1, 2))",
                              "np.zeros(len(inertia), dtype=bool)"),
    "look every 16 steps": ("stepping/time_step_stability.py", "LOOK_STEPS, LOOK_PHASE = 16",
                            "LOOK_STEPS, LOOK_PHASE = 1"),
    "kernels in their callers": ("../compilation/compiled.py", '"forceinline": True', '"forceinline": False'),
}  # fmt: skip
CASES = ("hull1000", "sph4000", "touchdown")
RELAX_STEPS, STEPS, REPEATS = 4000, 500, 9


def measure(folder: Path, result: Path) -> None:
    """Time the engine at hand, and keep where the bodies end."""
    times, places = {}, {}
    for case in CASES:
        world = relaxed(bed(folder, case.replace("touchdown", "hull1000")), RELAX_STEPS)
        if case == "touchdown":
            touch_down(world, 0.3)
        times[case] = 1e3 * cpu_seconds(lambda world=world: world.run(steps=STEPS), REPEATS) / STEPS
        places[case] = world.position
    np.savez(result, **places, **{f"{case}_ms": value for case, value in times.items()})


def engine_without(switch: str | None, place: Path) -> None:
    """Put a copy of the package at a place, with one trick turned off."""
    shutil.copytree(ROOT / "lithobrake", place / "lithobrake")
    if switch is not None:
        name, there, without = SWITCHES[switch]
        path = place / "lithobrake" / "dem" / name
        text = path.read_text()
        if text.count(there) != 1:
            raise ValueError(f"{path.name} holds {there!r} {text.count(there)} times; once is needed: mend SWITCHES")
        path.write_text(text.replace(there, without))


def run(place: Path, folder: Path) -> Row:
    """Measure the copy of the package at a place, in a process of its own and with a cache of its own."""
    found = place / "found.npz"
    paths = os.pathsep.join([str(place), str(Path(__file__).parent)])
    subprocess.run(
        [sys.executable, __file__, str(folder.resolve()), "--measure", str(found)], check=True, cwd=place,
        env={**os.environ, "PYTHONPATH": paths, "LITHOBRAKE_CACHE": str(place / "cache")},
    )  # fmt: skip
    return dict(np.load(found))


def compare(switch: str, whole: Path, folder: Path) -> Row:
    """Measure without a trick and, right after it, with all."""
    with tempfile.TemporaryDirectory() as scratch:
        engine_without(switch, Path(scratch))
        without = run(Path(scratch), folder)
    everything, row = run(whole, folder), {"without": switch}
    for case in CASES:
        with_ms, without_ms = float(everything[f"{case}_ms"]), float(without[f"{case}_ms"])
        moved = np.abs(everything[case] - without[case]).max()
        row[case] = {"with_ms": with_ms, "without_ms": without_ms, "gain": without_ms / with_ms,
                     "largest_change_m": float(moved)}  # fmt: skip
    return row


def main() -> None:
    parser = command_line(__doc__, "folder", out=Path(__file__).with_suffix(".json"))
    parser.add_argument("switch", nargs="*", default=[*SWITCHES])
    parser.add_argument("--measure", type=Path, help=argparse.SUPPRESS)
    chosen = parser.parse_args()
    if chosen.measure:
        measure(chosen.folder, chosen.measure)
        return
    known = read_document(chosen.out, {"rows": []})["rows"]
    rows: list[Row] = [row for row in known if row["without"] not in chosen.switch]
    with tempfile.TemporaryDirectory() as scratch:
        whole = Path(scratch)
        engine_without(None, whole)
        for switch in chosen.switch:
            rows.append(compare(switch, whole, chosen.folder))
            keep(rows, chosen.out)


def keep(rows: list[Row], path: Path) -> None:
    """Write the rows, and tell the last."""
    write_document(path, {**origin("benchmarks/engine_switches.py BED_FOLDER"), "rows": rows})
    row = rows[-1]
    gains = ", ".join(f"{case} {row[case]['gain']:.2f} ({row[case]['largest_change_m']:.2g} m)" for case in CASES)
    print(f"{row['without']}: {gains}", flush=True)


if __name__ == "__main__":
    main()
