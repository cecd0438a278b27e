"""What a file is, by its content: what stands where another format is read is named before it is refused."""

import re
import struct
from enum import StrEnum
from pathlib import Path

from lithobrake.files.reading import open_regular

# Of a file, in which its kind shows [bytes].
HEAD = 65_536
# Of a binary STL: title and count of facets, and each facet [bytes].
STL_HEAD, STL_FACET = 84, 50


class FileKind(StrEnum):
    """A kind of file, as a sentence names it."""

    OEM = "an Orbit Ephemeris Message (OEM)"
    BARE_OEM = "an Orbit Ephemeris Message (OEM) without its first line"
    OPM = "an Orbit Parameter Message (OPM)"
    OMM = "an Orbit Mean-Elements Message (OMM)"
    OCM = "an Orbit Comprehensive Message (OCM)"
    AEM = "an Attitude Ephemeris Message (AEM)"
    APM = "an Attitude Parameter Message (APM)"
    ACM = "an Attitude Comprehensive Message (ACM)"
    TDM = "a Tracking Data Message (TDM)"
    CDM = "a Conjunction Data Message (CDM)"
    MESSAGE = "a message of CCSDS"
    XML_OEM = "an Orbit Ephemeris Message (OEM) in XML"
    XML_MESSAGE = "a message of CCSDS in XML"
    XML = "XML"
    STK_EPHEMERIS = "an ephemeris of STK"
    STK_ATTITUDE = "an attitude file of STK"
    TEXT_KERNEL = "a text kernel of SPICE"
    BINARY_KERNEL = "a binary kernel of SPICE"
    SHAPE_KERNEL = "a shape kernel of SPICE (DSK)"
    OBJ = "an OBJ mesh"
    PLY = "a PLY mesh"
    STL = "an STL mesh"
    JSON = "JSON"
    HDF5 = "an HDF5 file"
    ARCHIVE = "a compressed file or a spreadsheet"
    UTF16 = "text in UTF-16"


_MAGIC = {
    b"DAS/DSK": FileKind.SHAPE_KERNEL,
    b"DAF/": FileKind.BINARY_KERNEL,
    b"NAIF/DA": FileKind.BINARY_KERNEL,
    b"DAS/": FileKind.BINARY_KERNEL,
    b"\x89HDF": FileKind.HDF5,
    b"PK\x03\x04": FileKind.ARCHIVE,
    b"\x1f\x8b": FileKind.ARCHIVE,
    b"BZh": FileKind.ARCHIVE,
    b"\xfd7zXZ\x00": FileKind.ARCHIVE,
    b"]\x00\x00\x80\x00": FileKind.ARCHIVE,
    b"\xff\xfe": FileKind.UTF16,
    b"\xfe\xff": FileKind.UTF16,
}
_MESSAGE = re.compile(r"CCSDS_([A-Z]{3})_VERS\b")
# In this order: what an earlier one finds, a later one does not.
_TEXT = (
    (re.compile(r"<(\?xml|!--|\w)(?s:.)*?<(\w+:)?oem[\s>]|<oem[\s>]"), FileKind.XML_OEM),
    (re.compile(r"<(\?xml|!--|\w)(?s:.)*?<(\w+:)?(ndm|opm|omm|ocm|aem|apm|acm|tdm|cdm)[\s>]"), FileKind.XML_MESSAGE),
    (re.compile(r"<(\?xml|!|\w)"), FileKind.XML),
    (re.compile(r"stk\.v\.(?s:.)*?\bBEGIN\s+Attitude\b", re.IGNORECASE), FileKind.STK_ATTITUDE),
    (re.compile(r"stk\.v\.", re.IGNORECASE), FileKind.STK_EPHEMERIS),
    (re.compile(r"KPL/|(?s:.)*?^\\begin(data|text)\b", re.MULTILINE), FileKind.TEXT_KERNEL),
    (re.compile(r"ply\r?\n"), FileKind.PLY),
    (re.compile(r"solid\b(?s:.)*?\bfacet\b"), FileKind.STL),
    (re.compile(r"(?s:.)*?^META_START\b(?s:.)*?^(REF_FRAME_A|ATTITUDE_TYPE)\b", re.MULTILINE), FileKind.AEM),
    (re.compile(r"(?s:.)*?^META_START\b", re.MULTILINE), FileKind.BARE_OEM),
    (re.compile(r"(?s:.)*?^X_DOT\s*=", re.MULTILINE), FileKind.OPM),
    (re.compile(r"(?s:.)*?^v[ \t]+[-+.\d]", re.MULTILINE | re.IGNORECASE), FileKind.OBJ),
    (re.compile(r"[{\[]\s*[\"{\[\d-]"), FileKind.JSON),
)


def file_kind(path: Path) -> FileKind | None:
    """The kind of a file; None for another one, as tables, plate models and lists of numbers are.

    Raises OSError as `open` does, and ValueError for a pipe or a device.
    """
    with open_regular(path) as file:
        head = file.read(HEAD)
        size = file.seek(0, 2)
    for magic, kind in _MAGIC.items():
        if head.startswith(magic):
            return kind
    if len(head) >= STL_HEAD and size == STL_HEAD + STL_FACET * struct.unpack_from("<I", head, STL_HEAD - 4)[0]:
        return FileKind.STL
    return text_kind(head.decode("utf-8-sig", errors="replace"))


def text_kind(text: str) -> FileKind | None:
    """The same of a text."""
    text = text.lstrip("\ufeff \t\r\n")
    if message := _MESSAGE.match(text):
        return FileKind.__members__.get(message[1], FileKind.MESSAGE)
    return next((kind for pattern, kind in _TEXT if pattern.match(text)), None)
