"""Reliable sites as [Celik-2019] has them: restitution sets the speed, a covariance says what is reliable.

    python validation/ballistic_descent/reliable_sites.py --work FOLDER [--out FOLDER]

docs/validation/ballistic_descent.md has the set-up. Kinds of ground repeat touchdowns of scenarios/quick.toml, which
the script runs in FOLDER where it is not there. Writes reliable_sites.csv, a row for each place of release, ground,
distance and longitude, as each ground ends; what stands there is not made again. Then reliable_sites.json.
"""

from pathlib import Path

import numpy as np
from ballistic_descent import (
    DISTANCES,
    HERE,
    LANDERS,
    LONGITUDES,
    POSITION_STD,
    SPEEDS,
    VELOCITY_STD,
    hard_ground,
    shares,
)
from descents import STEP, Descents, Floats, acceleration, back_in_time, balls, primary_share, radius, step
from harness import SCENARIOS, Row, add_row, command_line, origin, read_rows, timed, write_document
from scipy.optimize import brentq
from soil import RecordedSoil

import lithobrake
from lithobrake.smallbody import Body
from lithobrake.study import StudySource

TABLE = "reliable_sites.csv"
RESTITUTIONS = (0.5, 0.6, 0.7, 0.8, 0.9)
PLACES = ("anywhere", "outside")  # of the release: nearer to the barycentre than the moon, too, or not
FOLLOWED = ("outside", 0.7)  # of which landers are followed to rest
KINDS = {"release": str, "ground": str}
UNKNOWN = "unknown ground"
FASTEST = 0.073  # m/s; no touchdown of scenarios/quick.toml is faster than 7 cm/s
SOIL_DISTANCES = (300.0, 600.0, 1000.0)  # m, of kinds of ground
NEAR = 8  # touchdowns of one kind of ground among which one is drawn
DRAWS, SEED = 20_000, 1  # of the chance to meet the moon
SHIFTS = np.array([1e-2] * 3 + [1e-6] * 3)  # m and m/s, of the differences


def directions() -> Floats:
    """Upward directions at the longitudes on the equator, [longitudes, 3]."""
    east = np.radians(LONGITUDES)
    return np.stack([np.cos(east), np.sin(east), np.zeros(len(east))], axis=1)


def potential(body: Body, place: Floats) -> Floats:
    """Potential in the turning frame [m2/s2], [count], whose gradient is minus the acceleration at rest."""
    assert body.partner is not None
    apart, primary = body.orbit.distance, body.partner.body
    from_axis = place - [primary_share(body) * apart, 0.0, 0.0]
    pull = body.gravitational_parameter / np.linalg.norm(place, axis=1)
    pull += primary.gravitational_parameter / np.linalg.norm(place - [apart, 0.0, 0.0], axis=1)
    return np.asarray(-pull - 0.5 * body.spin_rate**2 * (from_axis[:, 0] ** 2 + from_axis[:, 1] ** 2))


def lagrange_point(body: Body, side: float) -> float:
    """Place on the x axis [m] of the point beside the moon: L1 for side 1, towards the primary, and L2 for -1."""

    def along(x: float) -> float:
        return float(acceleration(body, np.array([[x, 0.0, 0.0]]), np.zeros((1, 3)), 1.0)[0, 0])

    return float(brentq(along, side * 1.01 * radius(body), side * 0.5 * body.orbit.distance))


def closing_speeds(body: Body, side: float = -1.0) -> Floats:
    """Speed at each longitude [m/s] with which what leaves the ground cannot pass the Lagrange point of a side."""
    neck = potential(body, np.array([[lagrange_point(body, side), 0.0, 0.0]]))
    return np.sqrt(2.0 * (neck - potential(body, radius(body) * directions())))


def ends(body: Body, states: Floats, steps: np.ndarray) -> Floats:
    """Places [m] after so many steps forward in time, [count, 3], of states [count, 6], through the ground as well."""
    place, velocity = states[:, :3].copy(), states[:, 3:].copy()
    for number in range(int(steps.max(initial=0))):
        flies = steps > number
        place[flies], velocity[flies] = step(body, place[flies], velocity[flies], 1.0)
    return place


def chances(body: Body, up: Floats, descents: Descents) -> Floats:
    """Chance to meet the moon of each descent, [count], 0 where there is none.

    The covariance of the release, carried linearly to the touchdown and projected along the vertical there, as a
    Gaussian in the disc of the moon.
    """
    exists = np.isfinite(descents.times)
    states, up = descents.states[exists], up[exists]
    shifted = states[:, None, :] + np.concatenate([np.diag(SHIFTS), -np.diag(SHIFTS)])
    steps = np.repeat(np.rint(descents.times[exists] / STEP).astype(int), 2 * len(SHIFTS))
    places = ends(body, shifted.reshape(-1, 6), steps).reshape(-1, 2, len(SHIFTS), 3)
    slope = (places[:, 0] - places[:, 1]) / (2.0 * SHIFTS[:, None])  # [count, 6, 3]
    east = np.stack([-up[:, 1], up[:, 0], np.zeros(len(up))], axis=1)
    across = np.stack([east, np.cross(up, east)], axis=1)  # [count, 2, 3]
    std = np.array([POSITION_STD] * 3 + [VELOCITY_STD] * 3)
    errors = np.random.default_rng(SEED).standard_normal((DRAWS, 6)) * std
    found = np.zeros(len(descents.times))
    found[exists] = [
        np.mean(np.linalg.norm(errors @ one @ plane.T, axis=1) < radius(body))
        for one, plane in zip(slope, across, strict=True)
    ]
    return found


def hard_rows(body: Body, release: str, restitution: float, distances: tuple[float, ...]) -> list[Row]:
    """Rows of hard ground: lands as fast as the first bounce allows, if that must not lead past L2.

    Landers are followed to rest, with their errors, for FOLLOWED alone.
    """
    speed, rows = closing_speeds(body) / restitution, []
    every = back_in_time(body, directions(), speed, distances, release == "outside")
    for distance, descents in every.items():
        chance, rested = chances(body, directions(), descents), np.full(len(speed), np.nan)
        if (release, restitution) == FOLLOWED:
            rested = shares(body, descents, hard_ground(restitution))[1]
        for number, place in enumerate(LONGITUDES):
            rows.append({
                "release": release, "ground": f"e = {restitution:g}", "distance_m": distance,
                "longitude_deg": float(place), "landers": LANDERS, "speed_m_s": float(speed[number]),
                "flight_time_h": float(descents.times[number] / 3600.0), "reaches": float(chance[number]),
                "at_rest": float(rested[number]),
            })  # fmt: skip
    return rows


def soil_rows(body: Body, folder: Path, distances: tuple[float, ...]) -> list[Row]:
    """Rows of each kind of ground of a finished study, and over all by their weights, at the speed of most at rest."""
    study = lithobrake.open_study(folder)
    kinds, known = study.results.grounds, list(StudySource.read(folder / "study.toml").study.ground.kind)
    soils = {name: RecordedSoil.of_study(folder, known.index(name), NEAR) for name in kinds}
    slow = SPEEDS[SPEEDS < FASTEST]
    up, speed = np.repeat(directions(), len(slow), axis=0), np.tile(slow, len(LONGITUDES))
    rows = []
    for distance, descents in back_in_time(body, up, speed, distances, True).items():
        chance = chances(body, up, descents)
        rested = {name: shares(body, descents, soil)[1] for name, soil in soils.items()}
        rested[UNKNOWN] = np.sum([kinds[name].weight * rested[name] for name in kinds], axis=0)
        for ground, values in rested.items():
            best = values.reshape(len(LONGITUDES), -1).argmax(axis=1) + np.arange(len(LONGITUDES)) * len(slow)
            for place, number in zip(LONGITUDES, best, strict=True):
                rows.append({
                    "release": "outside", "ground": ground, "distance_m": distance, "longitude_deg": float(place),
                    "landers": LANDERS, "speed_m_s": float(speed[number]),
                    "flight_time_h": float(descents.times[number] / 3600.0), "reaches": float(chance[number]),
                    "at_rest": float(values[number]),
                })  # fmt: skip
    return rows


def study(work: Path) -> Path:
    """The folder of the quick study, which is run where it is not there."""
    folder = work / "quick"
    lithobrake.run(SCENARIOS / "quick.toml", folder)
    return folder


def main() -> None:
    given = command_line(__doc__, work=Path, out=HERE).parse_args()
    table, body = given.out / TABLE, balls()
    kept = read_rows(table, KINDS)
    for release in PLACES:
        for restitution in RESTITUTIONS:
            lacking = lacking_of(kept, release, f"e = {restitution:g}", DISTANCES)
            if lacking:
                rows, cpu = timed(lambda: hard_rows(body, release, restitution, lacking))  # noqa: B023
                add(table, kept, rows, cpu)
    lacking = lacking_of(kept, "outside", UNKNOWN, SOIL_DISTANCES)
    if lacking:
        folder = study(given.work)
        rows, cpu = timed(lambda: soil_rows(body, folder, lacking))
        add(table, kept, rows, cpu)
    rows = read_rows(table, KINDS)
    document = {
        **origin("validation/ballistic_descent/reliable_sites.py --work FOLDER"), "table": TABLE, "rows": len(rows),
        "cpu_s_of_rows": round(sum(row["cpu_s"] for row in rows)),
        "closing_m_s": [[float(one.min()), float(one.max())] for one in map(closing_speeds, [body] * 2, (-1.0, 1.0))],
    }  # fmt: skip
    write_document(table.with_suffix(".json"), document)


def lacking_of(kept: list[Row], release: str, ground: str, distances: tuple[float, ...]) -> tuple[float, ...]:
    """Those of distances [m] of which a table has not each longitude of a ground."""
    there = [row["distance_m"] for row in kept if (row["release"], row["ground"]) == (release, ground)]
    return tuple(one for one in distances if there.count(one) < len(LONGITUDES))


def add(table: Path, kept: list[Row], rows: list[Row], cpu: float) -> None:
    """Add rows to a table that it has not, with their CPU time [s]."""
    names = ("release", "ground", "distance_m", "longitude_deg")
    there = {tuple(row[name] for name in names) for row in kept}
    for row in rows:
        if tuple(row[name] for name in names) not in there:
            add_row(table, {**row, "cpu_s": cpu / len(rows)}, 6)
    print(f"{rows[0]['release']}, {rows[0]['ground']}: {cpu:.0f} s", flush=True)


if __name__ == "__main__":
    main()
