"""Sentences about a study file that is refused, and things that a user names in any case."""

from collections.abc import Mapping, Sequence
from typing import Any, Protocol, TypeVar

from lithobrake.vocabulary.plain_text import closest, show

# What a key takes that holds no number, by the error of the schema.
TYPES = {
    "string_type": "text; write it in quotation marks",
    "bool_type": "true or false; write it without quotation marks",
    "list_type": "a list; write its entries in square brackets",
    "tuple_type": "a list; write its entries in square brackets",
}

# Keys of older study files, and what to write in their place.
TO_REST = "write touchdowns = 1 in it to simulate the first touchdown alone, or nothing to follow every lander to rest"
OF_EXPANSION = "write it in [expansion], the analysis of the first touchdown by polynomial chaos"
REPLACED = {
    "design.method": "leave it out: journey.touchdowns = 1 simulates the first touchdown alone, and [expansion] with "
    "design.run_count = 0 is the method of the paper",
    "rest": "write [hard_ground] for landers on hard ground; journey.duration is the longest journey, and "
    "journey.emulated_count the number of landers that the emulator follows",
    **{
        f"design.{key}": OF_EXPANSION
        for key in (
            *("points", "screening_level", "screening_count", "screening_degree", "refined_level", "refined_count"),
            *("refined_degree", "replicate_count", "fit", "kept_share", "kept_outputs", "test_count"),
        )
    },
}


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
    sizes = (
        place.pop(place.index("diameter") + 1)
        if place[:1] in (["bed"], ["ground"]) and "diameter" in place[:-1]
        else ""
    )
    key, table = ".".join(place), ".".join(place[:-1])
    kind, found, context = error["type"], error.get("input"), error.get("ctx", {})
    # A table with a name of the user's own has the keys of all such, and so have the tables in it.
    named = (".".join(place[:-2]), ".".join([*place[:1], *place[2:-1]])) if len(place) > 2 else ()
    known = next((known_keys[one] for one in (f"{table}.{sizes}", table, *named) if one in known_keys), ())
    if kind == "quantity":
        return f"{key} {error['msg']}".lstrip()
    if kind == "extra_forbidden" and key in REPLACED:
        return f"{key} is a key of an older version; {REPLACED[key]}"
    if kind == "extra_forbidden":
        return f"{key} is not a known key{closest(place[-1], known)}" + (
            f"; allowed: {', '.join(known)}" if known else ""
        )
    if kind == "missing" and key == "journey":
        return f"[journey] is missing, which says how far landers are followed; add it: {TO_REST}"
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
    return f"{key} is {show(found)}; {error['msg']}"


class Named(Protocol):
    @property
    def name(self) -> str: ...


Known = TypeVar("Known", bound=Named)


def by_name(what: str, known: Mapping[str, Known], name: str, remedy: str) -> Known:
    """The entry of a name; keys of known are in lower case. Raises ValueError for another name, with what to do."""
    found = known.get(name.strip().lower())
    if found is None:
        raise ValueError(f"{what} is {name!r}; known are {', '.join(one.name for one in known.values())}; {remedy}")
    return found
