"""Sentences about a study file that is refused: the key, what stands there, what is allowed, what to write instead."""

import difflib
import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

LONGEST = 200  # characters of a value that a sentence shows
# What a key takes that holds no number, by the error of the schema.
TYPES = {
    "string_type": "text; write it in quotation marks",
    "bool_type": "true or false; write it without quotation marks",
    "list_type": "a list; write its entries in square brackets",
    "tuple_type": "a list; write its entries in square brackets",
}


def closest(word: object, known: Iterable[str]) -> str:
    """Ask back with the nearest known word, all of which are of small letters, or say nothing when none is near."""
    text = word if isinstance(word, str) else show(word)
    near = difflib.get_close_matches(text.lower(), list(known), n=1, cutoff=0.5)
    return f"; did you mean {near[0]}?" if near else ""


def show(value: object) -> str:
    """A value as the study file would show it; of a long one the beginning."""
    text = _text(value)
    return text if len(text) <= LONGEST else f"{text[:LONGEST]}... ({len(text)} characters)"


def _text(value: object, levels: int = 4) -> str:
    """The text of a value; what stands deeper in brackets than so many levels is left out."""
    if isinstance(value, Mapping | list | tuple) and levels == 0:
        return "..."
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{key} = {_text(entry, levels - 1)}" for key, entry in value.items()) + " }"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(_text(entry, levels - 1) for entry in value) + "]"
    if isinstance(value, str):
        return f'"{"".join(map(_visible, value))}"'
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, int) and abs(value) >= 1e21:
        # Python refuses to write out very long ones.
        return f"about {'-' * (value < 0)}1e{value.bit_length() * math.log10(2.0):.0f}"
    return f"{value:g}" if isinstance(value, float) else str(value)


def _visible(character: str) -> str:
    """A character as it is, or by its escape sequence where it is a line break or shows nothing."""
    return character if character.isprintable() else character.encode("unicode_escape").decode("ascii")


def sentences(errors: Sequence[Mapping[str, Any]], known_keys: Mapping[str, tuple[str, ...]]) -> list[str]:
    """One sentence for each error of the schema.

    errors: as pydantic lists them. known_keys: names allowed in each table, by the dotted name of the table ("" = top).
    """
    # A list that has lost a wrong entry is told again as one that is too short.
    within = {error["loc"][:length] for error in errors for length in range(len(error["loc"]))}
    return [_sentence(error, known_keys) for error in errors if error["loc"] not in within]


def _sentence(error: Mapping[str, Any], known_keys: Mapping[str, tuple[str, ...]]) -> str:
    # The schema puts the kind of a size distribution into the path; the file has no such level.
    place = [str(part) for part in error["loc"]]
    if place[:2] == ["bed", "diameter"]:
        place = place[:2] + place[3:]
    key, table = ".".join(place), ".".join(place[:-1])
    kind, found, context = error["type"], error.get("input"), error.get("ctx", {})
    known = known_keys.get(table, ())
    if kind == "quantity":
        return f"{key} {error['msg']}"
    if kind == "extra_forbidden":
        return f"{key} is not a known key{closest(place[-1], known)}" + (
            f"; allowed: {', '.join(known)}" if known else ""
        )
    if kind == "missing":
        return f"{key} is missing; add {'the table' if key in known_keys else 'the key'} (`lithobrake new` shows all)"
    if kind in {"literal_error", "union_tag_invalid"}:
        allowed = str(context.get("expected", context.get("expected_tags"))).replace("'", "")
        near = closest(context.get("tag", found), allowed.replace(" or ", ", ").split(", "))
        return f"{key} is {show(found)}; allowed: {allowed}{near}"
    if kind == "union_tag_not_found":
        return f"{key} is {show(found)}; it must name its {context['discriminator'].strip(chr(39))}"
    if kind == "too_short":
        least = context["min_length"]
        return f"{key} is {show(found)}; allowed: at least {least} entry; leave the key out for its default"
    if kind in {"model_type", "model_attributes_type", "dict_type"}:
        return f"{key} is {show(found)}; allowed: a table; write [{key}] with its keys below"
    if kind in TYPES:
        return f"{key} is {show(found)}; allowed: {TYPES[kind]}"
    return f"{key} is {show(found)}; {error['msg'].replace('Input should be', 'it must be')}"
