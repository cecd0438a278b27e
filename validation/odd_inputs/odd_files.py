"""Odd files: what a study reads, and what its folder holds, cut short, damaged, swapped, or encoded otherwise."""

import contextlib
import random
import re
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import base_studies
import tomli_w
from finished import FIRST, JOURNEYS, Finished, command, quick
from judge import Case, Silent, refuse_nonfinite

import lithobrake
from lithobrake.pipeline import plan_lines, plan_study

# The studies of base_studies that read each file.
READ = {
    "states.csv": "states", "states.oem": "message", "body.obj": "mesh", "lander.stl": "hull", "facets.txt": "soils",
    "body.tpc": "kernels", "orbiter.csv": "dated", "program.py": "programmed", "study.toml": "one_ground",
}  # fmt: skip
# Of these what is left of a file that was cut within its last lines is whole again, and says nothing of it.
OPEN_ENDED = ("states.csv", "states.oem", "facets.txt", "orbiter.csv", "program.py", "study.toml", "body.tpc")
STATES = ("states.csv", "states.oem", "orbiter.csv")
WAYS = ("cut", "damaged", "swapped", "empty", "folder", "mark", "utf-16", "crlf", "twice", "zeros")
# Pages, and what programs were given and wrote: nothing is read from them again.
UNREAD = ("report", "solver")
NEVER = ("swapped", "empty", "folder", "utf-16", "zeros")


def file_cases(chance: random.Random, count: int, folder: Path) -> Iterator[Case]:
    """So many odd files: half of those that studies read, half of those of finished studies."""
    folder = folder / "files"
    folder.mkdir()
    finished = Finished.made(folder)
    own = [
        (study, path.relative_to(folder / study))
        for study in (FIRST, JOURNEYS)
        for path in sorted((folder / study).rglob("*"))
        if path.is_file() and path.suffix != ".lock" and path.relative_to(folder / study).parts[0] not in UNREAD
    ]
    said = {study: _said(folder, study) for study in (FIRST, JOURNEYS)}
    yield from input_cases(chance, count // 2)
    for _ in range(count - count // 2):
        study, path = chance.choice(own)
        yield _of_folder(chance, chance.choice(WAYS), finished, study, path, said[study])


def input_cases(chance: random.Random, count: int) -> Iterator[Case]:
    """So many studies of which one of the files that they read is odd."""
    for _ in range(count):
        yield _of_study(chance, chance.choice(WAYS), chance.choice(list(READ)))


def _of_study(chance: random.Random, way: str, name: str) -> Case:
    seed = chance.getrandbits(32)
    # States are read from either of their formats.
    taken = {Path(name).suffix, ".py", *((".csv", ".oem") if name in STATES else ())}
    others = [other for other in READ if Path(other).suffix not in taken]
    other = chance.choice(others)

    def plan(folder: Path) -> None:
        base_studies.write_files(folder)
        study = folder / "study.toml"
        study.write_bytes(tomli_w.dumps(base_studies.base(READ[name])).encode())
        spoil(folder / name, way, random.Random(seed), folder / other)
        found = plan_study(study, folder / "out", 1)
        refuse_nonfinite(found.to_json())
        plan_lines(found)

    # A template is text of any kind.
    never = name != "program.py" and (way in NEVER or (way == "cut" and name not in OPEN_ENDED))
    # Nothing is wrong with numbers of facets in TOML's comment or in a table of numbers.
    return Case(f"{way} input", f"{name}{f' for {other}' * (way == 'swapped')}, seed {seed}", never, plan)


def _of_folder(
    chance: random.Random, way: str, finished: Finished, study: str, path: Path, said: dict[str, str]
) -> Case:
    seed, reader = chance.getrandbits(32), chance.choice(list(READERS))

    def plan(folder: Path) -> None:
        finished.copied(folder)
        spoil(folder / study / path, way, random.Random(seed), folder / "body.obj")
        with quick():
            # A refusal is right, and so is what was said before.
            with contextlib.suppress(ValueError):
                found = _plain(command(folder, *READERS[reader](study)))
                if found != said[reader] and reader not in TIMED:
                    raise Silent(f"{reader} says {_difference(said[reader], found)}")
            # A file that is made again is that of before.
            lithobrake.run(folder / f"{study}.toml", folder / study, workers=1, report=False)
            found = _plain(command(folder, *READERS["runs"](study)))
            if found != said["runs"]:
                raise Silent(f"after another run the runs are {_difference(said['runs'], found)}")

    return Case(f"{way} result", f"{study}/{path}, {reader}, seed {seed}", False, plan)


# These say when something was made, or how long more would take.
TIMED = ("status", "plan")
READERS: dict[str, Callable[[str], tuple[str, ...]]] = {
    "status": lambda study: ("status", study),
    "runs": lambda study: ("runs", study, "--csv"),
    "report": lambda study: ("report", study),
    "compare": lambda study: ("compare", study, study, "--out", "compared", "--force"),
    "plan": lambda study: ("plan", f"{study}.toml", "--out", study),
}


def _said(folder: Path, study: str) -> dict[str, str]:
    """What commands say of a finished study."""
    copy = folder.parent / "said"
    shutil.copytree(folder, copy)
    try:
        with quick():
            return {name: _plain(command(copy, *words(study))) for name, words in READERS.items()}
    finally:
        shutil.rmtree(copy)


def _plain(text: str) -> str:
    """What is said without places, sizes and times of the machine."""
    lines = [line for line in text.splitlines() if not re.match(r"(Report|Page|Numbers|Disk):", line)]
    return re.sub(r"/\S+", "PATH", "\n".join(lines))


def _difference(before: str, now: str) -> str:
    pairs = zip(before.splitlines(), now.splitlines(), strict=False)
    return next((f"{new[:150]!r} in place of {old[:150]!r}" for old, new in pairs if old != new), "more or fewer lines")


def spoil(path: Path, way: str, chance: random.Random, other: Path) -> None:
    """Change a file in one of WAYS; other: the file of another kind that is put in its place."""
    content = path.read_bytes()
    if way == "folder":
        path.unlink()
        path.mkdir()
        return
    place = chance.randrange(max(1, len(content)))
    byte = bytes([content[place] ^ chance.randrange(1, 256)]) if content else b"x"
    made = {
        "cut": content[:place],
        "damaged": content[:place] + byte + content[place + 1 :],
        "swapped": other.read_bytes(),
        "empty": b"",
        "mark": b"\xef\xbb\xbf" + content,
        "utf-16": content.decode("latin-1").encode("utf-16"),
        "crlf": content.replace(b"\n", b"\r\n"),
        "twice": content + content,
        "zeros": content[:place] + bytes(len(content) - place) if place < len(content) - 1 else bytes(len(content) + 1),
    }  # fmt: skip
    path.write_bytes(made[way])
