"""The unit of the lengths in a mesh, as its header or the label of an archive beside it states it."""

import re
from pathlib import Path

UNITS = {"m": 1.0, "km": 1e3, "cm": 1e-2, "mm": 1e-3}
# Formats that fix their unit.
FIXED = {".bds": "km", ".dsk": "km"}
_WORDS = {
    **dict.fromkeys(("km", "kilometer", "kilometers", "kilometre", "kilometres"), "km"),
    **dict.fromkeys(("m", "meter", "meters", "metre", "metres"), "m"),
    **dict.fromkeys(("cm", "centimeter", "centimeters", "centimetre", "centimetres"), "cm"),
    **dict.fromkeys(("mm", "millimeter", "millimeters", "millimetre", "millimetres"), "mm"),
}
_NAMED = "|".join(sorted(_WORDS, key=len, reverse=True))
# "units: km", "UNIT = KILOMETER", "the units are kilometers", "vertices in km".
_STATED = re.compile(
    rf"(?:\bunits?\b\W*(?:(?:are|is|in|of|length|vertices|coordinates)\W+){{0,3}}|\b(?:vertices|coordinates) in )"
    rf"({_NAMED})(?![\w/^*])",
    flags=re.IGNORECASE,
)
# Labels of PDS4 name the unit of each field; those of PDS3 are found by the pattern above.
_FIELD = re.compile(rf"<unit>\s*({_NAMED})\s*</unit>", flags=re.IGNORECASE)
# Archives describe what they keep by keywords: "# GSD = 0.25", "# PRODUCT_VERSION: 3".
_KEYWORD = re.compile(r"^#\s*[A-Z][A-Z0-9_]+\s*[:=]", flags=re.MULTILINE)


def mesh_unit(path: Path, unit: str | None) -> str:
    """The unit of a mesh: the one that is given, else what its header or label states, else metres.

    Raises ValueError for an unknown unit, for one that the file contradicts, and where none is given and the file comes
    from an archive, by its label or by the keywords of its header, that does not state one: nothing is guessed then.
    """
    if unit is not None and unit not in UNITS:
        raise ValueError(f"unit is {unit!r}; allowed are {', '.join(UNITS)}.")
    stated, archived = _stated(path)
    if unit is not None and stated and unit not in stated:
        words = " and ".join(sorted(stated))
        raise ValueError(f"{path}: its header or label says {words}, and unit is {unit!r}; give what it says, or none.")
    if unit is None and (len(stated) > 1 or (archived and not stated)):
        words = f"name {', '.join(sorted(stated))}" if stated else "do not state the unit of its lengths"
        raise ValueError(
            f"{path}: header and label {words}; look it up in the archive's document and give it as unit: "
            f"{', '.join(UNITS)}."
        )
    return unit or (stated.pop() if stated else "m")


def _stated(path: Path) -> tuple[set[str], bool]:
    """The units that header and label state, and whether there is a label, or a header with keywords."""
    if path.suffix.lower() in FIXED:
        return {FIXED[path.suffix.lower()]}, True
    labels = [place for place in _labels(path) if place.is_file()]
    header = _header(path)
    texts = [header, *(label.read_text(encoding="utf-8", errors="replace") for label in labels)]
    found = {_WORDS[word.lower()] for text in texts for word in (*_STATED.findall(text), *_FIELD.findall(text))}
    return found, bool(labels) or _KEYWORD.search(header) is not None


def _labels(path: Path) -> list[Path]:
    """Where a label of PDS4 or PDS3 may lie: beside the mesh, under its name."""
    return [path.with_suffix(ending) for ending in (".xml", ".lbl", ".LBL")]


def _header(path: Path) -> str:
    """The lines that begin with # before the first that does not; "" for a file that is no text."""
    lines = []
    with path.open("rb") as file:
        for line in file:
            if not line.lstrip().startswith(b"#") and line.strip():
                break
            lines.append(line.decode("utf-8", errors="replace"))
    return "".join(lines)
