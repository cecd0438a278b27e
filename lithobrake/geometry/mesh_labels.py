"""What a label of PDS4 says of the mesh beside it: the product that it is, and its file.

Label and mesh lie in one folder under one name, which differ in the ending, as in the archives.
"""

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
