"""Over what the answer of a study holds: which bed, which place, which attitude."""

from dataclasses import dataclass

from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.study import Study

# What a study on one bed, at one impact point or in one attitude leaves open.
OTHERS = "Another bed, impact point or attitude would change this number; this study cannot show by how much"


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
            "Another contact model would change this number; this study cannot show by how much.",
            "of the study's own program",
        )
    count = study.bed_count
    fixed = ["on this bed"] if count == 1 else []
    fixed += ["at this impact point"] if DrawnDesign(study).one_place else []
    beds = "on 1 bed" if count == 1 else f"on {count} beds"
    if fixed or study.impact.orientation != "random":
        where = ", ".join(fixed or ["in this attitude"]).capitalize()
        return Scope(where, f"{OTHERS}.", beds)
    return Scope(
        f"On these {count} beds, at random impact points and attitudes",
        "This number has no interval: the effect of other beds, impact points and attitudes and the error of the "
        "expansion are not quantified.",
        beds,
    )


def why_no_interval(study: Study) -> str | None:
    """Why drawn runs say nothing of other beds and places; None where they do."""
    one_place = DrawnDesign(study).one_place
    if study.bed_count > 1 and not one_place:
        return None
    where, remedies = [], []
    if study.bed_count == 1:
        where, remedies = ["on one bed"], ["bed.bed_count to 12 or more"]
    if one_place:
        where, remedies = [*where, "at one impact point"], [*remedies, "impact.region to the area where it may land"]
    return f"All runs landed {' and '.join(where)}. {OTHERS}. To get an interval, set {' and '.join(remedies)}."
