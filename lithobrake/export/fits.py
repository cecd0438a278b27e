"""A table in the Flexible Image Transport System: a header without data, then a binary table.

Source: [FITS-2016], sections 4 and 7.3
"""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from lithobrake.files.atomic import atomic_path
from lithobrake.results import Column

# Files come in blocks of this many bytes; headers in cards of so many characters.
BLOCK, CARD = 2880, 80
# Format of the standard and of the file, by kind of number.
FORMATS = {"i": ("K", ">i8"), "f": ("D", ">f8")}


def write_fits_table(path: Path, name: str, columns: Mapping[str, Column]) -> None:
    """Write columns of whole numbers and floats as a table of this name, with their units and what they are."""
    kinds = {title: FORMATS[column.values.dtype.kind] for title, column in columns.items()}
    record = np.dtype([(title, kind[1]) for title, kind in kinds.items()])
    rows = np.empty(len(next(iter(columns.values())).values), dtype=record)
    for title, column in columns.items():
        rows[title] = column.values
    primary = [("SIMPLE", True, "FITS"), ("BITPIX", 8, ""), ("NAXIS", 0, ""), ("EXTEND", True, "")]
    table = [
        ("XTENSION", "BINTABLE", "binary table"), ("BITPIX", 8, ""), ("NAXIS", 2, ""),
        ("NAXIS1", record.itemsize, "bytes of a row"), ("NAXIS2", len(rows), "rows"),
        ("PCOUNT", 0, ""), ("GCOUNT", 1, ""), ("TFIELDS", len(columns), "columns"), ("EXTNAME", name, ""),
    ]  # fmt: skip
    for number, (title, column) in enumerate(columns.items(), 1):
        table += [(f"TTYPE{number}", title, column.long_name), (f"TFORM{number}", kinds[title][0], "")]
        table += [(f"TUNIT{number}", _unit(column.units), "")] if column.units else []
    data = rows.tobytes()
    with atomic_path(path) as draft:
        draft.write_bytes(_header(primary) + _header(table) + data.ljust(-(-len(data) // BLOCK) * BLOCK, b"\0"))


def _unit(unit: str) -> str:
    """A unit as the standard writes it: powers with two stars."""
    return unit.replace("m2", "m**2")


def _header(cards: list[tuple[str, Any, str]]) -> bytes:
    text = "".join([*_cards(cards), "END".ljust(CARD)])
    return text.ljust(-(-len(text) // BLOCK) * BLOCK).encode("ascii")


def _cards(cards: list[tuple[str, Any, str]]) -> Iterator[str]:
    for key, value, comment in cards:
        written = f"'{value:<8}'".ljust(20) if isinstance(value, str) else f"{'T' if value is True else value:>20}"
        # A comment that is too long for its card is cut, as the standard says.
        yield f"{key:<8}= {written}{f' / {comment}' if comment else ''}"[:CARD].ljust(CARD)
