"""Write docs/validation/index.md, the table of all quantities, from quantities.csv.

python validation/write_index.py
"""

import sys
from collections.abc import Iterable
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from page import table, write_page, yes
from quantities import CODE, EXPERIMENT, FLIGHT, NOT_SHOWN, Quantity, counts, kept_quantities

KINDS = (EXPERIMENT, FLIGHT, CODE)
COUNTS = ("quantities", "agree", "disagree, cause shown", "disagree, cause unknown")
# Where the tolerances of a page stand.
TOLERANCES = {
    "ballistic_descent": "10 degrees for either end of a band",
    "deliveries": "its page, set before the first run; messages: the verdict of their authors",
    "experiments": "its page, one for each kind of quantity",
    "low_speed": "its page, set before the first run",
    "nine_codes": "its page, set before the runs",
    "paper_study": "the published error itself",
    "shapes": "its page, set before the first run",
}
GIVEN = ("hera_spk", "oem_samples", "slopes", "slopes_facets")


def numbers(quantities: Iterable[Quantity]) -> tuple[str, ...]:
    return tuple(map(str, counts(quantities)))


def linked(page: str, words: str) -> str:
    return f"[{words}]({page}.md)"


def main() -> None:
    kept = kept_quantities()
    every = [one for own in kept.values() for one in own]
    count, agree, shown, unknown = counts(every)
    kinds = [(kind, *numbers(one for one in every if one.kind == kind)) for kind in KINDS]
    cases = [
        (linked(page, case), ", ".join(dict.fromkeys(one.kind for one in own)), *numbers(own), TOLERANCES[page])
        for (page, case), own in kept.items()
    ]
    cases.append(("**all**", "", *map(str, (count, agree, shown, unknown)), ""))
    unknowns = [
        f"- {linked(page, case)}: {one.quantity}: {one.other} there, {one.here} here."
        for (page, case), own in kept.items() for one in own if not one.agrees and one.cause == NOT_SHOWN
    ]  # fmt: skip
    heads = ("case", "quantity", "there", "here", "error", "tolerance", "agrees", "cause shown by", "made by")
    rows = [
        (linked(page, case), one.quantity, one.other, one.here, one.error, one.tolerance, yes(one.agrees), one.shown,
         f"`{one.made_by}`") for (page, case), own in kept.items() for one in own
    ]  # fmt: skip
    write_page(
        "index", count=count, agree=agree, shown=shown, unknown=unknown,
        kinds=table(("kind", *COUNTS), [*kinds, ("**all**", *map(str, (count, agree, shown, unknown)))]),
        cases=table(("case", "kind", *COUNTS, "tolerance from"), cases), unknowns="\n".join(unknowns),
        quantities=table(heads, rows),
        others="Of these, " + ", ".join(f"`{name}`" for name in GIVEN) + " read files of others (`--given`).",
    )  # fmt: skip


if __name__ == "__main__":
    main()
