"""What the landers of an edition stand on beside their branches: the ground, and laws of restitution.

"first": stones of about 0.2 m, restitutions that are the same at all speeds, boxes. "unknown ground": each bed is a
ground of its own, of the preset of Dimorphos (docs/howto/ground.md), a third of them by each law of restitution. Hard
ground is the same in both.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

from branches import STUDY, Branch, changed
from measured_branches import GROUND
from measurements import Measurement

from lithobrake.study.ground_presets import GROUND_PRESETS

# Sizes of grains come from the ground, and so do width and number.
PRESET = GROUND_PRESETS["dimorphos"]
OPEN_GROUND = dict.fromkeys(("bed.grain_count", "bed.width", "bed.diameter"))
# A contact of soft grains yields at the speed at which rock does with its strength times (E soft / E)^0.8
# (docs/what_the_model_leaves_out.md): the weakest and the strongest ordinary chondrites, 6 MPa at 1 GPa and 260 MPa at
# 50 GPa [Space-Resources-1992], at the middle of the moduli of the studies.
SOFT = 6.3e5  # Pa
STRENGTHS = [strength * (SOFT / modulus) ** 0.8 for strength, modulus in ((6e6, 1e9), (2.6e8, 5e10))]
# Granite has the restitution of the studies at speeds up to 1.5 m/s [Durda-2011], the structure of MASCOT at 0.1 m/s.
SPEEDS = (0.1, 1.5)
RANGES: STUDY = {
    "yield_strength": {"distribution": "log_uniform", "lower": STRENGTHS[0], "upper": STRENGTHS[1]},
    "restitution_speed": {"distribution": "log_uniform", "lower": SPEEDS[0], "upper": SPEEDS[1]},
}
OFF = dict.fromkeys(RANGES, 0.0)
# Materials of the grains by each law of restitution, where they differ from those that all beds draw.
LAWS: Mapping[str, STUDY] = MappingProxyType(
    {
        "constant": OFF,
        "yields": {"young_modulus": SOFT, "restitution_speed": 0.0},
        "viscoelastic": {"yield_strength": 0.0},
    }
)
# Grains draw a strength and a speed, which their kind of ground may put to 0; the hull has none, and theirs count.
BOTH_LAWS = {
    **{f"grain.{key}": law for key, law in RANGES.items()}, **{f"lander.{key}": value for key, value in OFF.items()},
}  # fmt: skip
# Between kind and law in the name of a kind of a study.
BETWEEN = "_"
LANDERS_A_BED = 2
# From the seeds of the first landers to these: of thirty steps that with which the beds are nearest to the weights.
SEED_STEP = 2200


@dataclass(frozen=True)
class Assumptions:
    """Assumptions of that name.

    counts: landers of all branches by ground. is_ground_unknown: whether each bed on soil is a ground of its own, with
    a law of restitution.
    """

    name: str
    counts: Mapping[str, int]
    is_ground_unknown: bool = False

    def study(self, branch: Branch, ground: str, count: int, measurements: Iterable[Measurement] = ()) -> STUDY:
        """The tables of a study with a branch's part of `count` landers.

        measurements: of which the weights of the kinds of ground count; the branch has the others.
        """
        tables = branch.tables(count)
        if ground == "hard" or not self.is_ground_unknown:
            return tables
        changes = {
            **OPEN_GROUND, **BOTH_LAWS, "ground": unknown_ground(kind_weights(measurements)),
            "seed": tables["seed"] + SEED_STEP, "bed.bed_count": round(tables["journey"]["count"] / LANDERS_A_BED),
        }  # fmt: skip
        return changed(tables, changes)

    def refuse_unused(self, measurements: Iterable[Measurement]) -> None:
        """Raise ValueError for a measurement of what the studies on soil do not have."""
        for one in measurements:
            if not self.is_ground_unknown and one.quantity == GROUND:
                raise ValueError(
                    f"{one.quantity} has no part in landers of the {self.name} assumptions, which have one ground; "
                    f"allowed: landers of {UNKNOWN_GROUND.name}; take those"
                )
            if self.is_ground_unknown and one.of.key.startswith("bed."):
                raise ValueError(
                    f"{one.quantity} has no part in landers of {self.name}, whose beds draw the size of their grains; "
                    f"allowed: weights of the quantity {GROUND}; take them"
                )


def kind_weights(measurements: Iterable[Measurement]) -> dict[str, float]:
    """Probabilities of the kinds of ground of Dimorphos, measured or those of its preset."""
    for one in measurements:
        if one.quantity == GROUND and one.weights is not None:
            return dict(one.weights)
    return {name: float(one["weight"]) for name, one in PRESET["kind"].items()}


def unknown_ground(weights: Mapping[str, float]) -> STUDY:
    """The table of the ground: each kind of the preset with each law of restitution, in equal parts."""
    kinds = {
        f"{name}{BETWEEN}{law}": {**PRESET["kind"][name], "weight": weight / len(LAWS), "grain": of}
        for name, weight in weights.items()
        for law, of in LAWS.items()
        if weight > 0.0
    }
    return {**PRESET, "kind": kinds}


FIRST = Assumptions("first", {"soil": 240, "hard": 400})
UNKNOWN_GROUND = Assumptions("unknown ground", {"soil": 100, "hard": 400}, True)
ASSUMPTIONS = {one.name: one for one in (FIRST, UNKNOWN_GROUND)}
