"""The branches of the forecast: what is not known of Dimorphos and of the descent, and not a number of a study file.

Each branch is the lander's study file (scenarios/juventas.toml, milani.toml) with some keys changed. Weights of a
lander's branches add up to 1; they are judgement, not measurement, so every answer is also given by branch.
"""

import tomllib
from collections.abc import Mapping
from copy import deepcopy
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

from descent import release

from lithobrake.pipeline.site import Site
from lithobrake.study import read_study

SCENARIOS = Path(__file__).parents[2] / "scenarios"
LANDERS = ("juventas", "milani")
# Towards Didymos, and away from it: the ends of the long axis.
AIMS = {"near end": 0.0, "far end": 180.0}
# [Richardson-2024] and others: likely excited, perhaps tumbling; how likely is judgement.
SMALL, LARGE, ROLLING = 0.40, 0.25, 0.35
# Angles from the synchronous attitude at the beginning of 30 days [deg]; a lander arrives at any time of them. A yaw
# alone would stay one for so long as rounding lets it.
ROTATIONS = {
    "small libration": {"yaw_deg": 7.0},
    "large libration": {"yaw_deg": 20.0, "pitch_deg": 1.0, "roll_deg": 2.0},
    "rolling": {"yaw_deg": 30.0, "roll_deg": 60.0},
}
# Of a branch; a lander at least on each bed.
FEWEST_BEDS, LANDERS_A_BED = 12, 3
STUDY = dict[str, Any]


@dataclass(frozen=True)
class Branch:
    """A lander on one Dimorphos by one descent.

    weight: of the lander's branches. changes: by dotted key; None takes a key away. number: among the branches, which
    have soils, beds and arrivals of their own; the first has those of the study file.
    """

    lander: str
    rotation: str
    descent: str
    aim: str
    weight: float
    changes: Mapping[str, Any]
    number: int = 0

    @property
    def name(self) -> str:
        """As it stands in tables."""
        return ", ".join(one for one in (self.rotation, self.descent, self.aim) if one)

    @property
    def folder(self) -> str:
        """As a name of a folder."""
        return f"{self.lander}_{self.name}".replace(", ", "_").replace(" ", "-")

    def tables(self, landers: int) -> STUDY:
        """The tables of its study, with its part of so many landers of all branches, three on each bed."""
        tables = tomllib.loads((SCENARIOS / f"{self.lander}.toml").read_text(encoding="utf-8"))
        count = max(FEWEST_BEDS, round(self.weight * landers))
        changes = {
            **self.changes, "title": f"{tables['title']}: {self.name}", "seed": tables["seed"] + self.number,
            # Every answer is of simulated landings.
            "journey.emulated_count": 0, "journey.count": count,
            "bed.bed_count": max(FEWEST_BEDS, round(count / LANDERS_A_BED)),
        }  # fmt: skip
        return changed(tables, changes)


def changed(tables: STUDY, changes: Mapping[str, Any]) -> STUDY:
    """Tables of a study with keys changed, or taken away."""
    tables = deepcopy(tables)
    for key, value in changes.items():
        *path, name = key.split(".")
        section = tables
        for one in path:
            section = section.setdefault(one, {})
        if value is None:
            section.pop(name, None)
        else:
            section[name] = value
    return tables


def ballistic(lander: str, longitude_deg: float) -> STUDY:
    """Keys of a ballistic descent to an aim, in place of those of an arrival at the surface."""
    body = Site(read_study(SCENARIOS / f"{lander}.toml")).body
    arrival = ("speed", "incidence_deg", "heading_deg", "north_error", "east_error")
    return {
        **{f"delivery.{key}": None for key in arrival},
        "delivery.frame": "body_fixed",
        "delivery.release": release(body, longitude_deg),
    }


@cache
def branches(lander: str) -> tuple[Branch, ...]:
    """Those of a lander."""
    found = []
    for aim, longitude in AIMS.items():
        to_aim = {"delivery.longitude_deg": longitude}
        small, large = (to_aim | turning(f"{size} libration") for size in ("small", "large"))
        found.append(Branch(lander, "small libration", "at the surface", aim, SMALL / 4.0, small))
        found.append(
            Branch(lander, "small libration", "ballistic", aim, SMALL / 4.0, small | ballistic(lander, longitude))
        )
        found.append(Branch(lander, "large libration", "at the surface", aim, LARGE / 2.0, large))
    anywhere = {"delivery.longitude_deg": {"distribution": "uniform", "lower": -180.0, "upper": 180.0}}
    found.append(Branch(lander, "rolling", "at the surface", "", ROLLING, anywhere | turning("rolling")))
    return tuple(replace(one, number=number) for number, one in enumerate(found))


def turning(rotation: str) -> STUDY:
    """Keys of how Dimorphos turns."""
    return {f"site.rotation.{key}": value for key, value in ROTATIONS[rotation].items()}
