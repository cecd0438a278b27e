"""Over what the answer of a study holds: which bed, which place, which attitude."""

from dataclasses import dataclass

from lithobrake.pipeline.runs.place_region import place_region
from lithobrake.study import Study
from lithobrake.study.quantity import Uncertain


@dataclass(frozen=True)
class Scope:
    """where: words that the answer begins with. why: why its share has no interval. landings: "on 1 bed"."""

    where: str
    why: str
    landings: str


def scope(study: Study) -> Scope:
    """What the runs of a study have in common, and what that leaves unsaid."""
    if not study.has_soil:
        return Scope(
            "With the touchdowns of this study's own program",
            "Other touchdowns give another figure; this study cannot say how different.",
            "of the study's own program",
        )
    count = study.bed_count
    fixed = ["on this bed"] if count == 1 else []
    fixed += ["at this place"] if one_place(study) else []
    beds = "on 1 bed" if count == 1 else f"on {count} beds"
    if fixed or study.impact.orientation != "random":
        where = ", ".join(fixed or ["in this attitude"]).capitalize()
        return Scope(
            where, "Another bed, place or attitude gives another figure; this study cannot say how different.", beds
        )
    return Scope(
        f"On these {count} beds, at places and in attitudes drawn anew",
        "The figure has no interval: how far other beds, places and attitudes and the error of the expansion would "
        "move it is not worked out.",
        beds,
    )


def why_no_interval(study: Study) -> str | None:
    """Why the runs of a sequence say nothing of other beds and places; None where they do."""
    if study.bed_count > 1 and not one_place(study):
        return None
    where, remedies = [], []
    if study.bed_count == 1:
        where, remedies = ["on one bed"], ["bed.bed_count to 12 or more"]
    if one_place(study):
        where, remedies = [*where, "at one place"], [*remedies, "impact.region to where it may come down"]
    return (
        f"All runs came down {' and '.join(where)}. Another bed, place or attitude gives another figure; this study "
        f"cannot say how different: set {' and '.join(remedies)}."
    )


def one_place(study: Study) -> bool:
    """Whether all runs come down at the same place of their bed."""
    place = study.impact.place
    if place is not None and (isinstance(place.x, Uncertain) or isinstance(place.y, Uncertain)):
        return False
    return not any(low < high for low, high in place_region(study) or ())
