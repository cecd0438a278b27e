"""keys.json: what the folder of a study knows about itself, for the next execution and for whoever looks at it.

study     file: the study file, its path counted from the folder; sha256: of its bytes when it last ran
stages    of the study when it last ran, in order: title, key of all that the stage depends on, files that it writes
files     as they were made: key of the stage that made them, sha256 of their bytes
designs   which runs each design of the study asks for, by their keys in the ledger
rare      which landings `lithobrake rare` asked for when it last ran, by the name of the limit state
wall_s    wall time of each stage when its files were made [s]
"""

import json
import os
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

from lithobrake.files.atomic import atomic_path
from lithobrake.files.reading import NUMBER, check, read_json, reading
from lithobrake.results.intact import KEYS

NAME = KEYS
FORMAT_VERSION = 2
REMEDY = "make the files of this folder again with: lithobrake run STUDY.toml --out DIR"
_FORM = {
    "study": {"file": str, "sha256": str},
    "stages": {str: {"title": str, "key": str, "files": [str]}},
    "files": {str: {"key": str, "sha256": str}},
    "designs": {str: [str]},
    "rare": {str: [str]},
    "wall_s": {str: NUMBER},
}
# Format 1 had files and wall_s alone.
_ABSENT: dict[str, Any] = {name: {} for name in _FORM} | {"study": {"file": "", "sha256": ""}}
# The stage whose key says whether a design is still what the study asks for.
_STAGE_OF_DESIGN = {
    "screening": "screening_runs", "refined": "refined_runs", "test_kept": "test_runs", "test_all": "test_runs",
    "drawn": "runs", "soil_pairs": "side_runs", "twins": "side_runs",
}  # fmt: skip


@dataclass(frozen=True)
class Notes:
    """The tables of keys.json, empty where it has none."""

    study: dict[str, str] = field(default_factory=lambda: dict(_ABSENT["study"]))
    stages: dict[str, dict[str, Any]] = field(default_factory=dict)
    files: dict[str, dict[str, str]] = field(default_factory=dict)
    designs: dict[str, list[str]] = field(default_factory=dict)
    rare: dict[str, list[str]] = field(default_factory=dict)
    wall_s: dict[str, float] = field(default_factory=dict)

    @classmethod
    def read(cls, folder: Path, remedy: str = REMEDY) -> "Notes":
        """Read those of a folder, or none where there is no file.

        Raises DamagedFileError, with the remedy, for a damaged file, ValueError for one of another format.
        """
        path = folder / NAME
        if not path.exists():
            return cls()
        content = read_json(path, {"format_version": int}, remedy)
        version = content["format_version"]
        if not 1 <= version <= FORMAT_VERSION:
            raise ValueError(
                f"{path} has format {version}; this version reads 1 to {FORMAT_VERSION}: use the version of lithobrake "
                "that made this folder, or another folder"
            )
        with reading(path, remedy):
            tables = {name: content.get(name, absent) for name, absent in _ABSENT.items()}
            check(tables, _FORM)
            if tables["stages"]:
                check(tables["stages"], {"bed": dict}, "stages")
        return cls(**tables)

    def write(self, folder: Path) -> None:
        """Write them to a folder, whole or not at all."""
        content = {"format_version": FORMAT_VERSION, **asdict(self)}
        with atomic_path(folder / NAME) as draft:
            draft.write_text(json.dumps(content, indent=2, allow_nan=False) + "\n", encoding="utf-8")

    def of_setting(self, study: dict[str, str], stages: dict[str, dict[str, Any]]) -> "Notes":
        """The same for a study that is to run now: designs that it no longer asks for like that are left out."""
        same = {name for name, stage in stages.items() if self.stages.get(name) == stage}
        kept = [design for design, stage in _STAGE_OF_DESIGN.items() if stage in same]
        designs = {design: self.designs[design] for design in kept if design in self.designs}
        return replace(self, study=study, stages=stages, designs=designs)

    def study_path(self, folder: Path) -> Path | None:
        """Where the study file of a folder was when it last ran; None where that is not noted."""
        # A folder and its study file that move together, or to another machine, stay together.
        return Path(os.path.normpath(folder.resolve() / self.study["file"])) if self.study["file"] else None
