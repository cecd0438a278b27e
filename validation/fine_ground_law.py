"""Would a law of resistance stand for ground far finer than the lander? Against landings on beds of fine grains.

    python validation/fine_ground_law.py [--tries 60]

The lander of scenarios/quick.toml comes down on half-spaces that resist by a law, in the attitudes of the landings of
validation/grain_size.csv. On a facet at a depth z that moves into the ground at u along its normal the pressure is

    drag         c rho u^2 + k z: inertia and depth [Katsuragi-2007]
    springing    K z up to the deepest so far, then K / e^2 from there back, and c rho u^2: a bed that yields

each with friction. The numbers of a law are those of the best of so many tries on beds of 5, half of them drawn and the
rest around the best; best is the least of the largest factor by which rebound speed and depth, in the median, and the
fraction that leaves differ from those of the beds. What it then says of beds it was not chosen on is written too.
Writes fine_ground_law.json.
"""

import math
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
from grain_size import EDGES, GRAVITY, MASS, WAYS, block
from scipy.spatial.transform import Rotation

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from harness import Row, command_line, origin, read_rows, write_document

TABLE = Path(__file__).parent / "grain_size.csv"
# Of a bed of grains of 2500 kg/m3.
BULK = 1500.0  # kg/m3
FACET, STEP, LONGEST = 0.0168, 1e-3, 0.9  # m, s, s
SLIDING = 2e-3  # m/s, below which friction is proportional to the speed
CHOSEN, OTHERS = ("hulls 5", "steep"), (("hulls 5", "flat"), ("hulls 10", "steep"))
INERTIA = MASS / 12.0 * np.array([sum(np.square(EDGES)) - edge**2 for edge in EDGES])
Pressure = Callable[[np.ndarray, np.ndarray, np.ndarray], np.ndarray]
# Ends of each number of a law; all but the friction are drawn on a logarithmic scale.
LAWS = {
    "drag": {"c": (0.3, 10.0), "k": (1e3, 1e6), "friction": (0.2, 1.2)},
    "springing": {"K": (3e4, 3e6), "e": (0.03, 0.5), "c": (0.03, 5.0), "friction": (0.2, 1.2)},
}


def facets() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Middles [m], outward normals and areas [m2] of small facets of the box, [count, 3] and [count]."""
    points, normals, areas = [], [], []
    for axis in range(3):
        across = [one for one in range(3) if one != axis]
        counts = [max(1, round(EDGES[one] / FACET)) for one in across]
        grid = [(np.arange(n) + 0.5) / n * EDGES[one] - 0.5 * EDGES[one] for n, one in zip(counts, across, strict=True)]
        first, second = (one.ravel() for one in np.meshgrid(*grid, indexing="ij"))
        for side in (-1.0, 1.0):
            point, normal = np.zeros((len(first), 3)), np.zeros((len(first), 3))
            point[:, across[0]], point[:, across[1]], point[:, axis] = first, second, side * 0.5 * EDGES[axis]
            normal[:, axis] = side
            points.append(point)
            normals.append(normal)
            areas.append(np.full(len(first), EDGES[across[0]] * EDGES[across[1]] / len(first)))
    return np.concatenate(points), np.concatenate(normals), np.concatenate(areas)


def pressure(law: str, values: dict[str, float]) -> Pressure:
    """Pressure [Pa] by depth [m], speed into the ground [m/s] and deepest depth so far [m]."""

    def drag(depth: np.ndarray, speed: np.ndarray, deepest: np.ndarray) -> np.ndarray:
        return (BULK * values["c"] * speed**2 + values["k"] * depth) * (speed > 0.0)

    def springing(depth: np.ndarray, speed: np.ndarray, deepest: np.ndarray) -> np.ndarray:
        back = values["K"] / values["e"] ** 2 * (depth - deepest * (1.0 - values["e"] ** 2))
        spring = np.where(depth >= deepest, values["K"] * depth, np.clip(back, 0.0, values["K"] * depth))
        return spring + BULK * values["c"] * speed**2 * (speed > 0.0)

    return {"drag": drag, "springing": springing}[law]


def landed(attitude: np.ndarray, velocity: np.ndarray, law: Pressure, friction: float) -> dict[str, np.ndarray]:
    """How landers leave, from attitudes [count, 4] (w, x, y, z) and a velocity [m/s]: whether, speed, and depth [m]."""
    middle, outward, area = facets()
    corners = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]) * EDGES
    turn = Rotation.from_quat(attitude, scalar_first=True).as_matrix()
    count = len(turn)
    height = -(turn @ corners.T)[:, 2].min(axis=1)
    speed, spin = np.tile(velocity, (count, 1)), np.zeros((count, 3))
    deepest, sunk, left = np.zeros((count, len(middle))), np.zeros(count), np.zeros(count, dtype=bool)
    for _ in range(int(LONGEST / STEP)):
        on = np.flatnonzero(~left)
        r = turn[on]
        arm, normal = (np.einsum("nij,pj->npi", r, one) for one in (middle, outward))
        depth = -(height[on, None] + arm[..., 2])
        motion = speed[on, None] + np.cross(spin[on, None], arm)
        into = np.einsum("npi,npi->np", motion, normal)
        deepest[on] = np.maximum(deepest[on], depth)
        push = law(depth, into, deepest[on]) * (depth > 0.0) * area
        sliding = motion - into[..., None] * normal
        rate = np.maximum(np.linalg.norm(sliding, axis=-1), SLIDING)
        force = -push[..., None] * (normal + friction * sliding / rate[..., None])
        speed[on] += STEP * (force.sum(axis=1) / MASS + np.array(GRAVITY))
        momentum = np.einsum("nij,nj->ni", r, INERTIA * np.einsum("nji,nj->ni", r, spin[on]))
        momentum += STEP * np.cross(arm, force).sum(axis=1)
        turn[on] = r = Rotation.from_rotvec(spin[on] * STEP).as_matrix() @ r
        spin[on] = np.einsum("nij,nj->ni", r, np.einsum("nji,nj->ni", r, momentum) / INERTIA)
        height[on] += STEP * speed[on, 2]
        lowest = height[on] + (r @ corners.T)[..., 2, :].min(axis=-1)
        sunk[on] = np.maximum(sunk[on], -lowest)
        left[on] = (lowest > 0.0) & (speed[on, 2] > 0.0)
    return {"leaves": left, "speed": np.linalg.norm(speed, axis=1), "depth": sunk}


def against(law: str, values: dict[str, float], ground: str, way: str) -> Row:
    """What a law says over what the beds of a ground say: fractions that leave, and medians of speed and depth."""
    rows = read_rows(TABLE, {"ground": str, "way": str, "status": str})
    rows = [row for row in rows if (row["ground"], row["way"], row["twin"]) == (ground, way, 0.0)]
    given = np.array([block(int(row["block"])).attitudes[int(row["attitude"])] for row in rows])
    given = np.unique((given / np.linalg.norm(given, axis=1, keepdims=True)).round(9), axis=0)
    speed, angle = WAYS[way][0], math.radians(WAYS[way][1])
    velocity = np.array([speed * math.sin(angle), 0.0, -speed * math.cos(angle)])
    found = landed(given, velocity, pressure(law, values), values["friction"])
    of_beds = {name: np.array([row[name] for row in rows]) for name in ("speed_out", "penetration")}
    leaves = found["leaves"]
    return {
        "landings": len(rows), "leave": float(leaves.mean()),
        "leave_beds": float(np.mean([row["status"] == "clear" for row in rows])),
        "speed": float(np.median(found["speed"][leaves]) / np.nanmedian(of_beds["speed_out"])) if leaves.any() else 0.0,
        "depth": float(np.median(found["depth"]) / np.median(of_beds["penetration"])),
    }  # fmt: skip


def misfit(row: Row) -> float:
    """Logarithm of the largest factor between law and beds."""
    ratios = (row["speed"], row["depth"], row["leave"] / row["leave_beds"])
    return max(abs(math.log(max(one, 1e-6))) for one in ratios)


def chosen(law: str, tries: int) -> dict[str, float]:
    """The numbers of a law that come nearest to the beds of CHOSEN."""
    chance, ends = np.random.default_rng(6), LAWS[law]
    low, high = (np.array([one[k] if name == "friction" else math.log(one[k]) for name, one in ends.items()])
                 for k in (0, 1))  # fmt: skip

    def named(point: np.ndarray) -> dict[str, float]:
        return {
            name: float(x) if name == "friction" else math.exp(x) for name, x in zip(ends, point.tolist(), strict=True)
        }

    best, least, width = 0.5 * (low + high), math.inf, 0.15
    for number in range(tries):
        point = low + (high - low) * chance.random(len(low))
        if number >= tries // 2:
            point = np.clip(best + width * (high - low) * chance.normal(size=len(low)), low, high)
        value = misfit(against(law, named(point), *CHOSEN))
        if value < least:
            best, least = point, value
    return named(best)


def main() -> None:
    tries, found = command_line(__doc__, tries=60).parse_args().tries, {}
    for law in LAWS:
        values = chosen(law, tries)
        rows = {f"{ground}, {way}": against(law, values, ground, way) for ground, way in (CHOSEN, *OTHERS)}
        found[law] = {"values": values, "factors": {name: math.exp(misfit(row)) for name, row in rows.items()}} | rows
        write_document(
            Path(__file__).with_suffix(".json"),
            {**origin("validation/fine_ground_law.py"), "tries": tries, "laws": found},
        )


if __name__ == "__main__":
    main()
