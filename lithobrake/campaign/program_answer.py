"""What a program wrote of one run: outcome and outputs, from JSON, CSV, YAML or HDF5."""

import csv
import json
import reprlib
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from lithobrake.files.reading import unique
from lithobrake.vocabulary.extra_library import extra_library


def read_answer(path: Path) -> dict[str, Any]:
    """What a program wrote into a file whose ending DECODERS has.

    Raises ValueError when there is none, it is not of its format, or a value is not finite.
    """
    if not path.is_file():
        raise ValueError(f"the program wrote no {path.name}; it has to write one into the folder that it is started in")
    content = DECODERS[path.suffix.lower()](path)
    if not isinstance(content, dict) or not isinstance(content.get("outputs", {}), dict):
        raise ValueError(f"{path.name} is no JSON object of numbers by name; mend what the program writes")
    answer = content if "outputs" in content or "outcome" in content else {"outputs": content}
    beside = [name for name in answer if name not in ("outcome", "outputs", "draws")]
    if beside and "outputs" not in answer:
        raise ValueError(
            f"{path.name} has {', '.join(map(str, beside))} beside the outcome; allowed: "
            '{"outcome": a word, "outputs": numbers by name}; put the numbers into outputs'
        )
    outputs = answer.setdefault("outputs", {})
    for name, value in outputs.items():
        if not _is_number(value):
            raise ValueError(
                f"{path.name} has {reprlib.repr(value)} for {name}; allowed: a finite number; leave out what has none"
            )
    for name, kind, words in (("outcome", str, "a word"), ("draws", dict, "a JSON object")):
        if not isinstance(answer.get(name, kind()), kind):
            raise ValueError(
                f"{path.name} has {reprlib.repr(answer[name])} for {name}; allowed: {words}; mend it or leave it out"
            )
    return answer


def _json(path: Path) -> Any:
    try:
        # Some editors and languages begin a text with a mark of its encoding.
        return json.loads(path.read_text(encoding="utf-8-sig"), object_pairs_hook=unique)
    except (ValueError, RecursionError) as error:
        raise ValueError(f"{path.name} is not JSON ({error}); the program has to write one JSON object") from error


def _csv(path: Path) -> dict[str, Any]:
    """The last row under the names of the first; an empty cell has no value, and outcome is a column like others."""
    try:
        with open(path, newline="", encoding="utf-8-sig") as file:
            names, *rows = [row for row in csv.reader(file, skipinitialspace=True) if row]
        last = unique((name.strip(), cell.strip()) for name, cell in zip(names, rows[-1], strict=True))
        outcome = {"outcome": last.pop("outcome")} if "outcome" in last else {}
        outputs = {name: float(cell) for name, cell in last.items() if cell}
    except (ValueError, IndexError, csv.Error) as error:
        raise ValueError(
            f"{path.name} is no CSV of numbers ({error}); the program has to write names, and below them numbers"
        ) from error
    return {**outcome, "outputs": outputs}


def _yaml(path: Path) -> Any:
    yaml = extra_library("yaml", f"PyYAML, which reads {path.name},", "yaml")
    try:
        text = path.read_text(encoding="utf-8-sig")
        top = yaml.compose(text, yaml.SafeLoader)
        # Of a name that stands twice PyYAML keeps the last. What lies deeper is no answer.
        tables = [node for node in (top, *_values(top)) if isinstance(node, yaml.MappingNode)]
        for table in tables:
            unique((key.value, None) for key, _ in table.value)
        return yaml.safe_load(text)
    except (ValueError, yaml.YAMLError) as error:
        words = " ".join(str(error).split())
        raise ValueError(f"{path.name} is not YAML ({words}); the program has to write names with numbers") from error


def _values(node: Any) -> list[Any]:
    """The values of a table of YAML; none of another node."""
    return [pair[1] for pair in getattr(node, "value", ()) if isinstance(pair, tuple)]


def _hdf5(path: Path) -> dict[str, Any]:
    """Data sets of one number at the top or in the group `outputs`; the outcome is an attribute of the file."""
    import h5py

    try:
        with h5py.File(path, "r") as file:
            group = file["outputs"] if isinstance(file.get("outputs"), h5py.Group) else file
            sets = {str(name): entry for name, entry in group.items() if isinstance(entry, h5py.Dataset)}
            outputs = {name: entry[()].item() for name, entry in sets.items() if entry.size == 1}
            outcome = {"outcome": str(file.attrs["outcome"])} if "outcome" in file.attrs else {}
    except (OSError, AttributeError) as error:
        raise ValueError(f"{path.name} is not HDF5 ({error}); the program has to write data sets by name") from error
    return {**outcome, "outputs": outputs}


DECODERS: dict[str, Callable[[Path], Any]] = {
    ".json": _json,
    ".csv": _csv,
    **dict.fromkeys((".yaml", ".yml"), _yaml),
    **dict.fromkeys((".h5", ".hdf5"), _hdf5),
}


def _is_number(value: Any) -> bool:
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    return abs(value) <= sys.float_info.max
