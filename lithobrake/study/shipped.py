"""Studies and examples that come with the package: found by name, and copied to a folder of the user's."""

import shutil
import tomllib
from dataclasses import dataclass
from pathlib import Path

from lithobrake.vocabulary.plain_text import closest

STUDIES, EXAMPLES = "scenarios", "examples"
# What an example needs beside itself, in the same folder.
BESIDE = {
    "ball_on_plate": ("ball_on_plate.py",),
    "ball_on_plate_campaign": ("ball_on_plate.py",),
    "notebook_first_study": ("ball_on_plate.py",),
    "notebook_own_solver": ("ball_on_plate_campaign.py", "ball_on_plate.py"),
    "notebook_reading_a_study": ("notebook_first_study.py", "ball_on_plate.py"),
    "philae": ("philae_bounce.csv",),
}


@dataclass(frozen=True)
class Shipped:
    """A study or an example: its own file, and those that it needs beside it."""

    path: Path
    beside: tuple[Path, ...]

    @property
    def name(self) -> str:
        """What it is asked for by."""
        return self.path.stem

    @property
    def is_study(self) -> bool:
        """Whether it is a study file, which runs by its name."""
        return self.path.suffix == ".toml"

    @property
    def title(self) -> str:
        """What it is, on one line: the title of a study, the first words of a program or a notebook."""
        text = self.path.read_text(encoding="utf-8")
        if self.is_study:
            return str(tomllib.loads(text)["title"])
        lines = (line.strip('#" ').partition(":")[0] for line in text.splitlines() if not line.startswith("# %%"))
        return next(line for line in lines if line)

    def write(self, folder: Path) -> list[Path]:
        """Copy its files to a folder, and give their paths. Raises ValueError where one would replace another file.

        A file that is there already with the same content stays as it is.
        """
        pairs = [(path, folder / path.name) for path in (self.path, *self.beside)]
        for source, target in pairs:
            if target.exists() and not (target.is_file() and target.read_bytes() == source.read_bytes()):
                raise ValueError(f"{target} exists, and is not replaced; rename it, or ask from another folder")
        for source, target in pairs:
            if not target.exists():
                shutil.copyfile(source, target)
        return [target for _, target in pairs]


def shipped() -> dict[str, Shipped]:
    """All studies, then all examples, by name."""
    paths = [*_folder(STUDIES).glob("*.toml"), *_folder(EXAMPLES).glob("*.toml"), *_folder(EXAMPLES).glob("*.py")]
    found: dict[str, Shipped] = {}
    for path in paths:
        # The program of a study has its name, and comes with it.
        if path.stem not in found:
            beside = tuple(path.with_name(name) for name in BESIDE.get(path.stem, ()))
            found[path.stem] = Shipped(path, beside)
    return dict(sorted(found.items(), key=lambda one: (not one[1].is_study, one[0])))


def shipped_by_name(name: str) -> Shipped:
    """The study or example of a name. Raises ValueError with the names that there are."""
    known = shipped()
    if name not in known:
        raise ValueError(f"NAME is {name!r}{closest(name, known)}; allowed: {', '.join(known)}")
    return known[name]


def shipped_studies() -> dict[str, Path]:
    """The study files by the names that run them."""
    return {name: one.path for name, one in shipped().items() if one.is_study}


def study_path(path: Path) -> Path:
    """The path of a study file as it is given; of a name that is no file, that of the shipped study of this name."""
    is_name = len(path.parts) == 1 and not path.is_file()
    return shipped_studies().get(path.name, path) if is_name else path


def _folder(name: str) -> Path:
    """Where files of a kind lie: inside the installed package, or at the top of the project that it is run from."""
    package = Path(__file__).parents[1]
    inside = package / "shipped" / name
    return inside if inside.is_dir() else package.parent / name
