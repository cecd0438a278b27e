"""Correlations of pairs, contact by contact and over journeys, from the tables of pairing.py and grain_size.py."""

import itertools
import math
import sys
from collections import defaultdict
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from lithobrake.analysis import quantile_difference, ratio_difference, share_difference
from lithobrake.analysis.confidence import normal_quantile
from lithobrake.vocabulary.quantities import ORIENTATION, VELOCITY_OUT

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from harness import Row, read_rows

HERE = Path(__file__).parent
TOUCHDOWNS, JOURNEYS = HERE / "pairing_touchdowns.csv", HERE / "pairing_journeys.csv"
# First touchdowns that share some numbers only: kind of ground and approach of grain_size.py.
GRAINS = (("hulls 2", "steep"), ("hulls 2", "flat"), ("hulls 5", "steep"), ("hulls 10", "steep"))
FACTORS = ("soil", "point", "attitude")
OF_GRAINS = ("speed_out", "elevation_out", "spin_out", "returns")
OF_IMPACT = ("impact.speed", "impact.incidence_deg")
OF_REBOUND = (*VELOCITY_OUT, "speed_out", "spin_out", "contact_duration")
OF_JOURNEY = ("time_s", "distance", "way", "contacts", "path_length")
CEILING = "speed +0.0001 %"
LATEST = 3  # touchdowns, the last of which are the third and all later ones
FEWEST = 8  # pairs of a correlation
# Of these the logarithm: they vary over decades.
BY_DECADES = ("time_s", "distance", "way", "path_length")
Pair = tuple[float, float]


def correlation(pairs: Iterable[Pair], *, either_way: bool = False, units: int | None = None) -> Row | None:
    """Correlation of pairs with its interval by Fisher's z.

    either_way: no member of a pair is the first. units: how many of the pairs are independent, None: all of them. None
    for fewer than FEWEST pairs of numbers, and where one does not vary.
    """
    values = np.array([pair for pair in pairs if np.isfinite(pair).all()])
    count = len(values)
    if count < FEWEST or (values.std(axis=0) == 0.0).any():
        return None
    if either_way:
        values = np.concatenate([values, values[:, ::-1]])
    r = float(np.corrcoef(values.T)[0, 1])
    z, half = math.atanh(max(min(r, 1.0 - 1e-12), -1.0 + 1e-12)), normal_quantile() / math.sqrt((units or count) - 3)
    return {"r": r, "lower": math.tanh(z - half), "upper": math.tanh(z + half), "pairs": count}


def by_median(pairs: Iterable[Pair]) -> Row | None:
    """Correlation of whether each lies above the median of its own study: of this kind is that of a comparison."""
    values = np.array([pair for pair in pairs if np.isfinite(pair).all()])
    return correlation((values > np.median(values, axis=0)).astype(float)) if len(values) else None


def shared_numbers(rows: Sequence[Row]) -> dict[str, Row]:
    """First touchdowns of a ground, pairs that share these of FACTORS; "all": shifted by 0.1 mm."""
    by_block: dict[int, dict[tuple[int, ...], Row]] = defaultdict(dict)
    for row in rows:
        by_block[row["block"]][(*(row[name] for name in FACTORS), row["twin"])] = row
    found: dict[str, list[tuple[Row, Row]]] = defaultdict(list)
    for block in by_block.values():
        if (0, 0, 0, 1) in block:
            found["all"].append((block[0, 0, 0, 0], block[0, 0, 0, 1]))
        for one, two in itertools.combinations([key for key in block if not key[-1]], 2):
            same = [name for name, a, b in zip(FACTORS, one, two, strict=False) if a == b]
            found[" and ".join(same) or "none"].append((block[one], block[two]))
    return {
        same: {
            name: correlation([(a[name], b[name]) for a, b in pairs], either_way=True, units=len(by_block))
            for name in OF_GRAINS
        }
        for same, pairs in found.items()
    }


def turned(one: Row, two: Row) -> float:
    """Angle between the attitudes of two impacts [deg]."""
    product = abs(sum(one[name] * two[name] for name in ORIENTATION))
    return math.degrees(2.0 * math.acos(min(product, 1.0)))


def by_contact(first: dict[tuple[int, int], Row], second: dict[tuple[int, int], Row]) -> list[Row]:
    """Correlations at each touchdown of the pairs that both have it; attitude_deg: median angle between them."""
    found = []
    for number in range(LATEST):
        # The last ones together.
        both = [(first[key], second[key]) for key in first if min(key[1], LATEST - 1) == number and key in second]
        if len(both) < FEWEST:
            break
        of = {name: correlation((a[name], b[name]) for a, b in both) for name in (*OF_IMPACT, *OF_REBOUND)}
        same = sum(a["outcome"] == b["outcome"] for a, b in both)
        attitude = float(np.median([turned(a, b) for a, b in both]))
        found.append({"pairs": len(both), "same_outcome": same, "attitude_deg": attitude, **of})
    return found


def of_journeys(pairs: Sequence[tuple[Row, Row]]) -> Row:
    """Correlations of how the journeys of pairs end, and of their medians."""
    rest = [[float(one["end"] == "at_rest") for one in pair] for pair in pairs]
    down = [pair for pair, ends in zip(pairs, rest, strict=True) if all(ends)]
    numbers = {name: [(a[name], b[name]) for a, b in down] for name in OF_JOURNEY}
    return {
        "at_rest": correlation([(a, b) for a, b in rest]),
        "at_rest_of_each": [sum(ends) for ends in zip(*rest, strict=True)],
        **{name: correlation(values) for name, values in numbers.items()},
        **{f"{name}_median": by_median(values) for name, values in numbers.items()},
        "compared": compared(pairs),
        "same_face": sum(a["face"] == b["face"] for a, b in down),
        "same_face_by_chance": sum(a["face"] == b["face"] for a, _ in down for _, b in down) / max(len(down), 1),
        "both_at_rest": len(down),
    }


def compared(pairs: Sequence[tuple[Row, Row]]) -> Row:
    """What `lithobrake compare` makes of the pairs: correlation, and landings saved."""
    bed = np.array([a["bed"] for a, _ in pairs])
    rest = np.array([[one["end"] == "at_rest" for one in pair] for pair in pairs])
    found = {"at_rest": share_difference(*rest.T.astype(float), bed)}
    for name in ("time_s", "distance"):
        values = np.where(rest, np.exp([[one[name] for one in pair] for pair in pairs]), np.nan)
        found[f"{name}_median"] = quantile_difference(*values.T, bed, 0.5)
        found[f"{name}_ratio"] = ratio_difference(*values.T, bed)
    return {name: {"r": one.correlation, "saved": one.landings_saved} for name, one in found.items()}


def expected(options: Row, grounds: Row) -> Row:
    """Mean and ends of the correlations of a comparison over options, but for the one that changes almost nothing.

    Of the return fraction over first touchdowns that share impact point and attitude on another soil.
    """
    made = [option["journeys"]["compared"] for name, option in options.items() if name != CEILING]
    of = {name: [one[name]["r"] for one in made] for name in (made[0] if made else ())}
    of["returns"] = [ground["point and attitude"]["returns"]["r"] for ground in grounds.values()]
    return {name: {"mean": sum(r) / len(r), "least": min(r), "most": max(r)} for name, r in of.items()}


def on_one_bed(journeys: Sequence[Row]) -> Row:
    """Pairs of different journeys of one study on one bed."""
    pairs = [(a, b) for a, b in itertools.combinations(journeys, 2) if a["bed"] == b["bed"]]
    beds = len({row["bed"] for row in journeys})
    found: Row = {
        "at_rest": correlation([tuple(float(x["end"] == "at_rest") for x in p) for p in pairs], either_way=True)
    }
    down = [pair for pair in pairs if all(one["end"] == "at_rest" for one in pair)]
    return found | {
        name: correlation([(a[name], b[name]) for a, b in down], either_way=True, units=beds) for name in OF_JOURNEY
    }


def judged() -> Row:
    """All correlations."""
    whole = dict.fromkeys(("journey", "touchdown", "bed"), int)
    landings = read_rows(TOUCHDOWNS, {"option": str, "outcome": str, **whole})
    journeys = read_rows(JOURNEYS, {"option": str, "end": str, "face": str, **whole})
    for row in journeys:
        row["way"] = math.hypot(row["way_x"], row["way_y"], row["way_z"])
        row |= {name: math.log(row[name]) for name in BY_DECADES if row[name] > 0.0}
    options = list(dict.fromkeys(row["option"] for row in journeys))
    at = {name: {(row["journey"], row["touchdown"]): row for row in landings if row["option"] == name}
          for name in options}  # fmt: skip
    ends = {name: {row["journey"]: row for row in journeys if row["option"] == name} for name in options}
    base = ends["none"]
    grains = read_rows(HERE / "grain_size.csv", dict.fromkeys(("ground", "way", "status"), str)
                       | dict.fromkeys(("block", *FACTORS, "twin", "bed"), int), _number)  # fmt: skip
    grounds = {
        f"{ground}, {way}": shared_numbers([row for row in grains if (row["ground"], row["way"]) == (ground, way)])
        for ground, way in GRAINS
    }
    made = {
        name: {
            "contacts": by_contact(at["none"], at[name]),
            "journeys": of_journeys([(base[number], row) for number, row in ends[name].items()]),
        }
        for name in options[1:]
    }
    return {
        "shared_at_first_touchdown": grounds,
        "bed_only": on_one_bed(list(base.values())),
        "options": made,
        "expected": expected(made, grounds),
    }


def _number(text: str) -> float:
    return float(text) if text else math.nan
