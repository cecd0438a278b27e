"""The unit of the lengths in a mesh, as its header or the label of an archive states it."""

import codecs
import re
from pathlib import Path

LABEL = ".xml"
# The version of the product follows its identifier; later ones are of its history.
_PRODUCT = re.compile(
    r"<logical_identifier>\s*([^<\s]+)\s*</logical_identifier>\s*<version_id>\s*([^<\s]+)\s*</version_id>"
)
_FILE = re.compile(r"<file_name>\s*([^<]*?)\s*</file_name>")


def product_id(mesh: Path) -> str | None:
    """Identifier and version of a product, as "urn:nasa:pds:bundle:collection:product::1.0"; None without a label."""
    label = mesh.with_suffix(LABEL)
    found = _PRODUCT.search(_text(label)) if label.is_file() else None
    return None if found is None else "::".join(found.groups())


def labelled_mesh(path: Path) -> Path:
    """The mesh that a label is of; any other path as it is. Raises ValueError for a label without such a file."""
    if path.suffix.lower() != LABEL or not path.is_file():
        return path
    named = [name for name in _FILE.findall(_text(path)) if Path(name).stem == path.stem and Path(name).name == name]
    if len(named) != 1 or not path.with_name(named[0]).is_file():
        raise ValueError(
            f"{path}: this label names {', '.join(_FILE.findall(_text(path))) or 'no file'}; allowed: one file beside "
            f"it that is named {path.stem}, with another ending; give the path of the mesh itself."
        )
    return path.with_name(named[0])


def _text(label: Path) -> str:
    return label.read_text(encoding="utf-8", errors="replace")


UNITS = {"m": 1.0, "km": 1e3, "cm": 1e-2, "mm": 1e-3}
# Formats that fix their unit.
FIXED = {".bds": "km", ".dsk": "km"}
# Lengths by the words that name them, in small letters; those that UNITS lacks are recognised to be refused.
_WORDS = {
    **dict.fromkeys(("km", "kilometer", "kilometers", "kilometre", "kilometres"), "km"),
    **dict.fromkeys(("m", "meter", "meters", "metre", "metres"), "m"),
    **dict.fromkeys(("cm", "centimeter", "centimeters", "centimetre", "centimetres"), "cm"),
    **dict.fromkeys(("mm", "millimeter", "millimeters", "millimetre", "millimetres"), "mm"),
    **dict.fromkeys(("feet", "foot", "ft"), "feet"),
    **dict.fromkeys(("inches", "inch"), "inches"),
    **dict.fromkeys(("yards", "yard", "yd"), "yards"),
    **dict.fromkeys(("miles", "mile", "mi"), "miles"),
    **dict.fromkeys(("furlongs", "furlong"), "furlongs"),
    **dict.fromkeys(("au", "astronomical unit", "astronomical units"), "au"),
    **dict.fromkeys(("parsecs", "parsec", "pc"), "parsecs"),
    **dict.fromkeys(("dm", "decimeter", "decimeters", "decimetre", "decimetres"), "dm"),
    **dict.fromkeys(
        ("um", "\u00b5m", "\u03bcm", "micrometer", "micrometers", "micrometre", "micrometres", "microns"), "um"
    ),
    **dict.fromkeys(("nm", "nanometer", "nanometers", "nanometre", "nanometres"), "nm"),
    **dict.fromkeys(("megameter", "megameters", "megametre", "megametres"), "Mm"),
}
_NAMED = "|".join(sorted(_WORDS, key=len, reverse=True))
_LENGTHS = r"(?:vertices|vertex coordinates|coordinates|positions|lengths|distances|dimensions)"
# "units", "length_unit", "LengthUnits", "unit_length".
_UNIT = r"(?:\b|_|length)units?(?:_of)?(?:_lengths?)?\b"
# "units: km", "UNIT = KILOMETER", "the units are kilometers", "vertices in km", "all lengths are in km", "x [km]".
_STATED = re.compile(
    rf"(?:{_UNIT}\W*(?:1(?:\.0*)?\s+)?(?:(?:are|is|in|of|length|vertices|coordinates)\W+){{0,3}}"
    rf"|\b{_LENGTHS}\s+(?:(?:are|given)\s+)*in\s+|\b[xyz]\s*[\[(]\s*)"
    rf"({_NAMED})(?![\w/^*])",
    flags=re.IGNORECASE,
)
# Whatever a header names as the unit: "units: parasangs", "the unit is 0.3 m".
_ANY_STATED = re.compile(
    rf"{_UNIT}[ \t]*(?:[:=]|(?:are|is|in)\b)[ \t]*(?:(?:are|is|in|of|length)[ \t]+)*([^\s,;]+)", flags=re.IGNORECASE
)
# Labels of PDS4 name the unit of each field; those of PDS3 are found by the pattern above.
_FIELD = re.compile(rf"<unit>\s*({_NAMED})\s*</unit>", flags=re.IGNORECASE)
# Archives describe what they keep by keywords: "# GSD = 0.25", "# PRODUCT_VERSION: 3".
_KEYWORD = re.compile(r"^#\s*[A-Z][A-Z0-9_]+\s*[:=]", flags=re.MULTILINE)
# A line of a vertex, or of how many there are.
_VERTEX = re.compile(rb"\s*(?:[vV]\s|[-+.\d])")
TITLE_LENGTH = 80  # of a binary STL file


def mesh_unit(path: Path, unit: str | None) -> str:
    """The unit of a mesh: the one that is given, else what its header or label states, else metres.

    Raises ValueError for an unknown unit, given or stated, for one that the file contradicts, and where none is given
    and the file comes from an archive, by its label or by the keywords of its header, that does not state one: nothing
    is guessed then.
    """
    if unit is not None and unit not in UNITS:
        raise ValueError(f"unit is {unit!r}; allowed are {', '.join(UNITS)}.")
    stated, archived = _stated(path)
    strange = sorted(stated - set(UNITS))
    if strange and unit not in stated:
        raise ValueError(
            f"{path}: its header or label gives lengths in {' and '.join(strange)}; allowed are {', '.join(UNITS)}: "
            "convert the mesh, or correct what is said of it."
        )
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
    """What header and label state as the unit, and whether there is a label, or a header with keywords.

    Where neither names a length, what else the header calls its unit.
    """
    if path.suffix.lower() in FIXED:
        return {FIXED[path.suffix.lower()]}, True
    # A label of PDS4 or PDS3 lies beside the mesh, under its name.
    labels = [place for ending in (".xml", ".lbl", ".LBL") if (place := path.with_suffix(ending)).is_file()]
    header = _header(path)
    texts = [header, *(label.read_text(encoding="utf-8", errors="replace") for label in labels)]
    found = {_length(word) for text in texts for word in (*_STATED.findall(text), *_FIELD.findall(text))}
    others = {word.strip("'\"()[]<>.") or "nothing" for word in _ANY_STATED.findall(header)}
    return found or others, bool(labels) or _KEYWORD.search(header) is not None


def _length(word: str) -> str:
    """The unit that a word names. Capitals make no difference but to Mm, which is no millimetre."""
    return word if word == "Mm" else _WORDS[word.lower()]


def _header(path: Path) -> str:
    """The lines that begin with # before the first vertex; of an STL file, which has none, its title."""
    with path.open("rb") as file:
        if path.suffix.lower() == ".stl":
            return file.read(TITLE_LENGTH).partition(b"\n")[0].decode("utf-8", errors="replace")
        lines = []
        for line in file:
            if _VERTEX.match(line):
                break
            text = line.removeprefix(codecs.BOM_UTF8).decode("utf-8", errors="replace")
            if text.lstrip().startswith("#"):
                lines.append(text)
    return "".join(lines)
