"""What the landers of an edition stand on beside their branches: the ground, laws of restitution, and landers' parts.

"first": stones of about 0.2 m, restitutions that are the same at all speeds, boxes. "unknown ground": each bed is a
ground of its own, of the preset of Dimorphos (docs/howto/ground.md); a third of the landers by each law of restitution;
Milani with its wings. Hard ground is the same in both.
"""

import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

from branches import SCENARIOS, STUDY, Branch, changed
from measurements import Measurement

FIRST_NAME = "first"
# Files of landers with parts that some assumptions read.
PARTS = {"milani": "milani_with_wings"}
# Sizes of grains come from the ground, and so do width and number.
OPEN_GROUND = {"ground": "dimorphos", **dict.fromkeys(("bed.grain_count", "bed.width", "bed.diameter"))}
# A contact of soft grains yields at the speed at which rock does with its strength times (E soft / E)^0.8
# (docs/what_the_model_leaves_out.md): the weakest and the strongest ordinary chondrites, 6 MPa at 1 GPa and 260 MPa at
# 50 GPa [Space-Resources-1992], at the middle of the moduli of the studies.
SOFT = 6.3e5  # Pa
STRENGTHS = [strength * (SOFT / modulus) ** 0.8 for strength, modulus in ((6e6, 1e9), (2.6e8, 5e10))]
# Granite has the restitution of the studies at speeds up to 1.5 m/s [Durda-2011], the structure of MASCOT at 0.1 m/s.
SPEEDS = (0.1, 1.5)
LAWS: Mapping[str, STUDY] = MappingProxyType({
    "constant": {},
    "yields": {
        "grain.young_modulus": SOFT,
        "grain.yield_strength": {"distribution": "log_uniform", "lower": STRENGTHS[0], "upper": STRENGTHS[1]},
    },
    "viscoelastic": {
        "grain.restitution_speed": {"distribution": "log_uniform", "lower": SPEEDS[0], "upper": SPEEDS[1]},
    },
})  # fmt: skip
# Between seeds of the laws, more than there are branches.
SEED_STEP = 100


@dataclass(frozen=True)
class Assumptions:
    """Assumptions of that name.

    counts: landers of all branches by ground. soil: keys of a study on soil that differ from its file; laws: the same
    of each law of restitution, in equal parts of the landers, none where there is one law; parts: names of study files
    whose parts a lander has; landers_a_bed: on soil with several laws.
    """

    name: str
    counts: Mapping[str, int]
    soil: STUDY = field(default_factory=dict)
    laws: Mapping[str, STUDY] = field(default_factory=dict)
    parts: Mapping[str, str] = field(default_factory=dict)
    landers_a_bed: int = 2

    def studies(self, branch: Branch, ground: str, count: int) -> list[tuple[str, STUDY]]:
        """Each law of restitution and the tables of its study, with a branch's part of `count` landers."""
        tables = branch.tables(count)
        if ground == "hard" or not self.laws:
            return [("", tables)]
        own = {**self.soil, **self.part_changes(branch.lander)}
        number = max(self.landers_a_bed, round(branch.weight * count / len(self.laws)))
        found = []
        for place, (law, changes) in enumerate(self.laws.items(), 1):
            counts = {
                "seed": tables["seed"] + place * SEED_STEP, "journey.count": number,
                "bed.bed_count": max(2, round(number / self.landers_a_bed)),
            }  # fmt: skip
            found.append((law, changed(tables, {**own, **changes, **counts})))
        return found

    def part_changes(self, lander: str) -> STUDY:
        """The key of a lander's parts, where it has any."""
        if lander not in self.parts:
            return {}
        text = (SCENARIOS / f"{self.parts[lander]}.toml").read_text(encoding="utf-8")
        return {"lander.part": tomllib.loads(text)["lander"]["part"]}

    def refuse_unused(self, measurements: Iterable[Measurement]) -> None:
        """Raise ValueError for a measurement of a key that the studies on soil do not have."""
        for one in measurements:
            if self.soil and one.of.key.startswith("bed."):
                raise ValueError(
                    f"{one.quantity} has no part in landers of {self.name}, whose beds draw the size of their grains; "
                    "allowed: weights of the quantity ground; take them"
                )


FIRST = Assumptions(FIRST_NAME, {"soil": 240, "hard": 400})
UNKNOWN_GROUND = Assumptions("unknown ground", {"soil": 120, "hard": 400}, OPEN_GROUND, LAWS, PARTS)
ASSUMPTIONS = {one.name: one for one in (FIRST, UNKNOWN_GROUND)}
