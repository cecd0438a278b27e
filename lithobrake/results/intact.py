"""Whether a file of a study's folder still has the bytes that it was made with, for whoever reads it."""

from pathlib import Path

from lithobrake.files.atomic import lock_holder
from lithobrake.files.hashing import content_hash
from lithobrake.files.reading import DamagedFileError, read_json, reading

# What the folder notes about its files, what is held while a study is at work there, and the copy of its file.
KEYS, LOCK, STUDY_FILE = "keys.json", ".lock", "study.toml"


def intact_file(folder: Path, name: str, remedy: str) -> Path:
    """The path of a file of a folder, there or not.

    A file of which the folder notes nothing, as in an archive, is taken as it stands, and so is any other while a study
    is at work there and may be making it. Raises DamagedFileError, with the remedy, for one that changed after it was
    made, and for a folder, a pipe or a device in its place.
    """
    path, keys = folder / name, folder / KEYS
    # Reading a pipe waits for whoever writes to it, and some devices have no end.
    if path.exists() and not path.is_file():
        raise DamagedFileError(f"{path} cannot be read (it is no regular file); {remedy}")
    if not (path.is_file() and keys.is_file()) or lock_holder(folder / LOCK):
        return path
    notes = read_json(keys, dict, remedy)
    with reading(keys, remedy):
        noted = notes.get("study", {}) if name == STUDY_FILE else notes.get("files", {}).get(name, {})
        sha256 = noted.get("sha256")
    if sha256 and content_hash(path) != sha256:
        raise DamagedFileError(f"{path} changed after it was made, as its hash in {KEYS} tells; {remedy}")
    return path
