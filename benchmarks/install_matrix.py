"""The wheel with the lowest and the newest versions of what it needs, on each Python given: does it work, how large?

    python benchmarks/install_matrix.py dist/lithobrake-0.1.0-py3-none-any.whl python3.11 python3.12

Each pair gets an empty environment. "lowest" are the lower bounds in pyproject.toml, or the first versions after them
that have a wheel for this Python; what these need in turn is new. A study is planned by its name, then the tests named
by --tests run against what was installed. Rows of other interpreters that stand in results/install_matrix.json stay.
Needs uv on the path. Sizes: sums of the sizes of files in 1e6 bytes, without bytecode and without pip.
"""

import os
import re
import subprocess
import tempfile
import time
from importlib import metadata
from pathlib import Path

from harness import RESULTS, ROOT, Row, command_line, origin, read_document, write_document

OUT = RESULTS / "install_matrix.json"
RESOLUTIONS = {"lowest": "lowest-direct", "newest": "highest"}
# Quick ones that reach compiler, files, command line, and statistics.
TESTS = ("tests/compilation", "tests/cli/test_commands.py", "tests/chaos/test_distributions.py")
# A safe path keeps the clone that the tests lie in from being imported in place of what was installed.
SAFE = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"} | {"PYTHONSAFEPATH": "1"}


def ended(*words: str | Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(words, cwd=ROOT, env=SAFE, capture_output=True, text=True, check=False)


def done(*words: str | Path) -> str:
    """What a command prints; raises RuntimeError with its last words where it fails."""
    one = ended(*words)
    if one.returncode:
        raise RuntimeError(f"{' '.join(map(str, words))}: {one.stderr[-2000:]}")
    return one.stdout


def install(wheel: Path, python: str, resolution: str, place: Path) -> float:
    """Make an environment in a folder that is not there yet; return the seconds that it took."""
    start, pins, inside = time.monotonic(), place.with_suffix(".txt"), place / "bin" / "python"
    done("uv", "venv", "--python", python, place)
    done("uv", "pip", "compile", "--python", inside, "--resolution", RESOLUTIONS[resolution], "--only-binary", ":all:",
         "--output-file", pins, "pyproject.toml")  # fmt: skip
    done("uv", "pip", "install", "--python", inside, "--requirements", pins)
    done("uv", "pip", "install", "--python", inside, "--no-deps", wheel)
    return time.monotonic() - start


def weights(place: Path) -> dict[str, tuple[str, float]]:
    """Version and size [1e6 bytes] of each package in an environment, the largest first."""
    (packages,) = (place / "lib").glob("python*/site-packages")
    found = {}
    for one in metadata.distributions(path=[str(packages)]):
        files = [Path(str(one.locate_file(file))) for file in one.files or () if file.suffix != ".pyc"]
        found[one.metadata["Name"]] = (one.version, sum(file.stat().st_size for file in files if file.exists()) / 1e6)
    return dict(sorted(found.items(), key=lambda item: -item[1][1]))


def tried(place: Path, tests: tuple[str, ...]) -> Row:
    """Plan the quick study by its name, and run tests; the counts of these by their ends."""
    planned = ended(place / "bin" / "lithobrake", "plan", "quick")
    done("uv", "pip", "install", "--python", place / "bin" / "python", "pytest>=8")
    said = ended(place / "bin" / "python", "-m", "pytest", "-q", "-p", "no:cacheprovider", *tests).stdout
    last = said.strip().splitlines()[-1] if said.strip() else ""
    counts = {end: int(count) for count, end in re.findall(r"(\d+) (passed|failed|skipped|error)", last)}
    failed = re.findall(r"^(?:FAILED|ERROR) (\S+)", said, flags=re.MULTILINE)
    return {"plans_quick": planned.returncode == 0, "passed": counts.pop("passed", 0), **counts, "failed_tests": failed}


def row(wheel: Path, python: str, resolution: str, tests: tuple[str, ...]) -> Row:
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder) / "environment"
        seconds = install(wheel, python, resolution, place)
        packages = weights(place)
        version = done(place / "bin" / "python", "-c", "import platform; print(platform.python_version())").strip()
        size = sum(megabytes for _, megabytes in packages.values())
        return {
            "python": version, "resolution": resolution, "install_s": round(seconds, 1), "megabytes": round(size, 1),
            **tried(place, tests), "tests": list(tests),
            "packages": {name: [one, round(megabytes, 2)] for name, (one, megabytes) in packages.items()},
        }  # fmt: skip


def main() -> None:
    options = command_line(__doc__, "wheel", "pythons...", tests=TESTS, resolutions=tuple(RESOLUTIONS)).parse_args()
    rows = read_document(OUT, {"rows": []})["rows"]
    for python in map(str, options.pythons):
        for resolution in options.resolutions:
            here = origin(f"benchmarks/install_matrix.py {options.wheel.name} {Path(python).name}")
            new = row(options.wheel.resolve(), python, resolution, tuple(options.tests)) | here
            print({key: value for key, value in new.items() if key != "packages"}, flush=True)
            rows = [one for one in rows if (one["python"], one["resolution"]) != (new["python"], resolution)] + [new]
            write_document(OUT, {"rows": sorted(rows, key=lambda one: (one["python"], one["resolution"]))})


if __name__ == "__main__":
    main()
