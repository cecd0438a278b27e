"""Which observed bounces share a bed, and how much of the scatter that is."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.vocabulary.percentages import percent

if TYPE_CHECKING:
    from collections.abc import Mapping

    from lithobrake.emulator import Emulator


@dataclass(frozen=True)
class Observation:
    """One observed bounce.

    outputs: those that were observed, by name, in their units; errors: standard deviations of those that have one;
    known: inputs that are known of this bounce, by name, as its speed; outcome: how it ended, None: with outputs; bed:
    a word for the bed it was on, which bounces with the same word share; None: one of its own.
    """

    outputs: "Mapping[str, float]"
    errors: "Mapping[str, float]" = field(default_factory=dict)
    known: "Mapping[str, float]" = field(default_factory=dict)
    outcome: str | None = None
    bed: str | None = None


def by_bed(observations: Sequence[Observation]) -> list[list[int]]:
    """Places of the observations of each bed; one without outputs shares none, as it says nothing of its bed."""
    beds: dict[tuple[bool, str | int], list[int]] = {}
    for number, one in enumerate(observations):
        shared = one.bed is not None and bool(one.outputs)
        beds.setdefault((shared, one.bed if shared and one.bed is not None else number), []).append(number)
    return list(beds.values())


def bed_shares(model: "Emulator") -> dict[str, float]:
    """Share of the scatter of each output that landings on one bed have in common, in the emulator's runs.

    Raises ValueError where no bed has two runs.
    """
    effect, root = model.bed_effect, model.kernels.root
    whole, of_beds = np.diagonal(root @ root.T), np.diagonal(root @ effect.before @ root.T)
    names = [model.output_names[column] for column in model.runs.modelled]
    shares = np.divide(of_beds, whole, out=np.zeros(len(whole)), where=whole > 0.0)
    return dict(zip(names, shares.tolist(), strict=True))


def beds_statement(model: "Emulator", observations: Sequence[Observation]) -> str | None:
    """What several bounces are taken to share, in a sentence; None for one bounce."""
    if len(observations) < 2:
        return None
    shared = [bed for bed in by_bed(observations) if len(bed) > 1]
    if not shared:
        return (
            f"The {len(observations)} bounces count as on beds of their own; name the bed of each where some share one."
        )
    said = ", ".join(f"{name} {percent(share)}" for name, share in bed_shares(model).items())
    named = "; ".join(f"{len(bed)} share bed {observations[bed[0]].bed}" for bed in shared)
    return f"Of the {len(observations)} bounces {named}; of the scatter at one soil the bed has: {said}."
