"""Write docs/summary.md, which says what every key of the summary, the scores and the expansions means.

The words are those beneath the fields of lithobrake/results, and of FILES here for files that other parts write.
"""

import ast
import inspect
from collections.abc import Iterator
from dataclasses import dataclass, fields, is_dataclass
from itertools import pairwise
from pathlib import Path
from textwrap import dedent, wrap
from typing import Any, get_args

from lithobrake.results.summary import Provenance, Results, Summary
from lithobrake.vocabulary.estimate import Estimate, Form, is_inline, key_of

LINE = 100  # characters, as on every page of the documentation
HEAD = """# The keys of summary.json, scores.json and the expansions

<!-- Made by docs/make_summary_page.py from the fields of lithobrake/results. -->

This page explains every key of the results that a study writes. `*` stands for any name of an
output, an input (by its dotted key), a design or an outcome. In a list of tables every table has
the keys that are listed. Numbers are in SI units unless another unit is named; `null` means that
there is no such number. In Python `lithobrake.open_study("DIR").results` has the same as
attributes, with types; a key that is a Python keyword has an underscore there (`from_`), and the
value, the bounds and the level of an interval are one `Estimate` (`.value`, `.lower`, `.upper`).

## `summary.json`
"""
# What the parts that write these files put there.
EXPANSION_KEYS = {
    "format": "identifies the file as an expansion",
    "format_version": "version of the format",
    "written_by": "version of lithobrake",
    "inputs.*": "name, kind and parameters of the distribution of each input, in the file's units",
    "output_names": "columns of coefficients and residuals",
    "one_dimensional": "whether y had one dimension",
    "multi_indices": "degrees of each term, one column per input",
    "coefficients": "coefficients of the orthonormal terms, one column per output",
    "residuals": "residual of the expansion at each run, one column per output",
    "report.method": "method of the fit, or best: chosen for each output",
    "report.rrmse_estimate": "report.outputs.*.rrmse_estimate of all outputs, in their order",
    "report.degree": "highest total degree of a term",
    "report.train_count": "runs that were fitted",
    "report.dropped_count": "runs left out because they have no outputs",
    "report.dependent_inputs": "pairs of inputs that depend on each other in the runs, with their rank correlation",
    "report.data_hash": "hash of the inputs and outputs that were fitted",
    "report.candidates.*.*": "expected error of each fit at a new run, in the unit of the output",
    "report.challenger.model": "a Gaussian process with which all other fits are compared",
    "report.challenger.rmse_estimate.*": "its expected error; null if it could not be fitted",
    "report.outputs.*.method": "how the output was fitted",
    "report.outputs.*.term_count": "number of its terms",
    "report.outputs.*.rmse_estimate": "root-mean-square error expected at a new run, with scatter, in its unit",
    "report.outputs.*.rrmse_estimate": "the same over the standard deviation of the runs; null where they do not vary",
    "report.outputs.*.error_estimate": "method of the error estimate",
    "report.outputs.*.condition_number": "condition number of the least squares",
    "report.outputs.*.candidate_degree": "total degree of the terms that omp or lars chose from",
    "report.outputs.*.candidate_q_norm": "q-norm of the same terms",
    "report.outputs.*.covariance": "covariance of the Gaussian process",
    "report.outputs.*.noise_std": "standard deviation between equal runs, in the unit of the output",
    "report.outputs.*.noise_from": "source of that, or null",
}
FILES = {
    "scores.json": "Errors by set of runs and output: the keys of `results.expansion.scores.*.*`, `ape` too.",
    "screening.json` and `refined.json": "Each expansion (`lithobrake.chaos.load` reads it).",
}


@dataclass
class Table:
    """A table of a file: the places where it stands, what it is, and the meaning of each of its keys."""

    places: list[str]
    words: str
    keys: dict[str, str]


def field_words(kind: type) -> dict[str, str]:
    """The words beneath each field of a dataclass, those that it inherits among them."""
    found: dict[str, str] = {}
    for one in reversed([one for one in kind.__mro__ if is_dataclass(one)]):
        body = ast.parse(dedent(inspect.getsource(one))).body[0].body  # type: ignore[attr-defined]
        for field, below in pairwise(body):
            if isinstance(field, ast.AnnAssign) and isinstance(below, ast.Expr):
                found[field.target.id] = " ".join(str(below.value.value).split())  # type: ignore[union-attr, attr-defined]
    return found


def form_of(kind: Any) -> Form | None:
    """The form of an estimate in a file; None for any other kind of value."""
    return next((one for one in get_args(kind) if isinstance(one, Form)), None)


def tables_within(kind: Any, place: str) -> Iterator[tuple[Any, str]]:
    """Each dataclass or estimate of a kind of value with its place, `*` for the names of a mapping."""
    if is_dataclass(kind) or form_of(kind):
        yield kind, place
        return
    star = f"{place}.*" if is_mapping(kind) else place
    for inner in get_args(kind):
        yield from tables_within(inner, star)


def describe(kind: Any, place: str, found: dict[Any, Table]) -> None:
    """Note a dataclass or an estimate and those within it, each once with all its places."""
    form = form_of(kind)
    if form is not None:
        table = found.setdefault(kind, Table([], " ".join((Estimate.__doc__ or "").split()), keys_of_form(form)))
        table.places += [place] if place not in table.places else []
        return
    if kind in found:
        found[kind].places += [place] if place not in found[kind].places else []
    else:
        found[kind] = Table([place], " ".join((kind.__doc__ or "").split()), keys_of(kind))
    for field in fields(kind):
        if is_inline(field) and form_of(field.type):
            continue
        if is_inline(field) and not is_mapping(field.type):
            _describe_inner(table_in(field.type), place, found)
        else:
            for inner, where in tables_within(field.type, place if is_inline(field) else f"{place}.{key_of(field)}"):
                describe(inner, where, found)


def _describe_inner(kind: Any, place: str, found: dict[Any, Table]) -> None:
    """Note what an inline dataclass holds; its own keys stand in the table around it."""
    for field in fields(kind):
        for inner, where in tables_within(field.type, f"{place}.{key_of(field)}"):
            describe(inner, where, found)


def table_in(kind: Any) -> Any:
    """The dataclass of a field that may hold one or None."""
    return next(one for one in (kind, *get_args(kind)) if is_dataclass(one))


def is_mapping(kind: Any) -> bool:
    """Whether a field holds values by name."""
    return len(get_args(kind)) == 2 and get_args(kind)[0] is str


def keys_of_form(form: Form, value: str = "") -> dict[str, str]:
    """The keys of an estimate with their meaning; value: words of the number, where a field has some."""
    words = field_words(Estimate)
    value = value or ("fraction of 1" if "share" in form.keys else "")
    return {key: value if value and name == "value" else words[name] for key, name in form.keys.items()}


def summary_of(kind: Any) -> str:
    """The first sentence of a dataclass, as words of a key."""
    kind = Estimate if form_of(kind) else kind
    first = " ".join((kind.__doc__ or "").split("\n\n")[0].split()).rstrip(".")
    return f"{first[:1].lower()}{first[1:]}"


def keys_of(kind: Any) -> dict[str, str]:
    """The keys of a dataclass with their meaning, those of inline fields among them."""
    words, keys = field_words(kind), {}
    for field in fields(kind):
        form = form_of(field.type)
        if is_inline(field) and form is not None:
            keys |= keys_of_form(form, words[field.name])
        elif not is_inline(field) or is_mapping(field.type):
            # A field without words of its own holds a table that has some.
            inner = next((one for one, _ in tables_within(field.type, "")), None)
            keys["*" if is_inline(field) else key_of(field)] = words.get(field.name) or summary_of(inner)
        else:
            keys |= keys_of(table_in(field.type))
    return keys


def key_table(keys: dict[str, str]) -> list[str]:
    return ["", "| key | meaning |", "|---|---|", *(f"| `{key}` | {words} |" for key, words in keys.items())]


def page() -> str:
    """docs/summary.md."""
    found: dict[Any, Table] = {}
    for kind, place in ((Results, "results"), (Provenance, "provenance")):
        describe(kind, place, found)
    lines = [HEAD.rstrip(), *key_table(field_words(Summary))]
    for table in found.values():
        first, *others = (f"`{place}`" for place in table.places)
        also = f" Also {', '.join(others)}." if others else ""
        lines += ["", f"### {first}", "", *wrap(f"{table.words}{also}", LINE, break_on_hyphens=False)]
        lines += key_table(table.keys)
    for name, words in FILES.items():
        lines += ["", f"## `{name}`", "", *wrap(words, LINE)]
    return "\n".join([*lines, *key_table(EXPANSION_KEYS), ""])


if __name__ == "__main__":
    Path(__file__).with_name("summary.md").write_text(page(), encoding="utf-8")
