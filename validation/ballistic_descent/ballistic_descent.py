"""Where on the moon of a binary does a ballistic descent end reliably? The case of [Celik-2019], on Dimorphos (K4).

    python validation/ballistic_descent/ballistic_descent.py --work FOLDER [--out FOLDER]

docs/validation/ballistic_descent.md has the set-up. On soil, landers repeat touchdowns of scenarios/mission.toml, which
the script runs in FOLDER where it is not there. Writes ballistic_descent.csv, a row for each distance, ground and site,
as each distance and ground ends; what stands there is not made again. Then ballistic_descent.json.
"""

import sys
from pathlib import Path

import numpy as np
from descents import Descents, Floats, back_in_time, balls, radius
from soil import RecordedSoil

import lithobrake
from lithobrake.smallbody import Body, Bounce, HardSurface, Launch, hop

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from harness import SCENARIOS, Row, add_row, command_line, origin, read_rows, timed, write_document

HERE = Path(__file__).parent
TABLE = "ballistic_descent.csv"
DISTANCES = (200.0, 300.0, 400.0, 600.0, 1000.0)  # m, of the release from the moon's centre
MAP_DISTANCE = 600.0  # m, of the map over latitudes
LONGITUDES = np.arange(0.0, 360.0, 10.0)  # deg east, 0 towards the primary
LATITUDES = (0.0, 20.0, 40.0)  # deg; the model is the same north and south
SPEEDS = np.arange(0.048, 0.1421, 0.004)  # m/s, at the touchdown
POSITION_STD, VELOCITY_STD = 30.0, 0.02 / 3.0  # m and m/s, in each direction
LANDERS = 100  # a site and speed
DURATION = 2.0 * 86_400.0  # s
# Along the ground a lander keeps TANGENTIAL of its speed, or what friction leaves; the sources name the normal part.
RESTITUTIONS, TANGENTIAL, FRICTION = (0.5, 0.7, 0.9), 0.9, 0.6
KINDS = {"ground": str}
SEED = 1


def launches(body: Body, descents: Descents) -> tuple[Floats, np.ndarray]:
    """States with errors of the release, [descents * LANDERS, 6], and which of them lie outside both bodies."""
    assert body.partner is not None
    errors = np.random.default_rng(SEED).standard_normal((LANDERS, 6))
    errors *= [POSITION_STD] * 3 + [VELOCITY_STD] * 3
    states = (descents.states[:, None, :] + errors).reshape(-1, 6)
    to_primary = states[:, :3] - [body.orbit.distance, 0.0, 0.0]
    # A little more than the radius of the ball of the volume, as the mesh has corners.
    is_outside = np.linalg.norm(states[:, :3], axis=1) > 1.01 * radius(body)
    is_outside &= np.linalg.norm(to_primary, axis=1) > 1.01 * radius(body.partner.body)
    return states, is_outside & np.isfinite(states[:, 0])


def shares(body: Body, descents: Descents, bounce: Bounce) -> tuple[Floats, Floats]:
    """Share of landers that touch down on the moon, and that rest there, of each descent, [count] each.

    A release inside a body, which an error may give near the ground, counts as neither.
    """
    states, is_outside = launches(body, descents)
    place, velocity = states[is_outside, :3], states[is_outside, 3:]
    landers = hop(body, Launch(place, velocity), bounce, DURATION, friction=FRICTION, seed=SEED)
    both = np.zeros((2, len(states)))
    # The launch counts as the first touchdown of each.
    both[:, is_outside] = landers.touchdowns > 1, landers.end == "at_rest"
    touched, rested = both.reshape(2, -1, LANDERS).mean(axis=2)
    return touched, rested


def site_rows(body: Body, distance: float, latitude: float, ground: str, bounce: Bounce) -> list[Row]:
    """The row of each longitude: speed of the highest share at rest, and the same at the least speed."""
    longitude, speed = (one.ravel() for one in np.meshgrid(LONGITUDES, SPEEDS, indexing="ij"))
    east, north = np.radians(longitude), np.full(len(longitude), np.radians(latitude))
    up = np.stack([np.cos(north) * np.cos(east), np.cos(north) * np.sin(east), np.sin(north)], axis=1)
    descents = back_in_time(body, up, speed, (distance,))[distance]
    touched, rested = (one.reshape(len(LONGITUDES), -1) for one in shares(body, descents, bounce))
    hours = descents.times.reshape(len(LONGITUDES), -1) / 3600.0
    rows = []
    for number, place in enumerate(LONGITUDES):
        reached = np.flatnonzero(np.isfinite(hours[number]))
        least, best = int(reached[0]), int(rested[number].argmax())
        rows.append({
            "distance_m": distance, "ground": ground, "latitude_deg": latitude, "longitude_deg": float(place),
            "landers": LANDERS, "best_speed_m_s": float(SPEEDS[best]), "flight_time_h": float(hours[number, best]),
            "touched": float(touched[number, best]), "at_rest": float(rested[number, best]),
            "least_speed_m_s": float(SPEEDS[least]), "at_rest_at_least_speed": float(rested[number, least]),
        })  # fmt: skip
    return rows


def hard_ground(restitution: float) -> HardSurface:
    return HardSurface(restitution, TANGENTIAL, FRICTION)


def soil(work: Path) -> RecordedSoil:
    """The touchdowns of the mission study, which is run where it is not there."""
    folder = work / "mission"
    lithobrake.run(SCENARIOS / "mission.toml", folder)
    return RecordedSoil.of_study(folder)


def main() -> None:
    given = command_line(__doc__, work=Path, out=HERE).parse_args()
    table, body = given.out / TABLE, balls()
    there = {(row["distance_m"], row["ground"], row["latitude_deg"]) for row in read_rows(table, KINDS)}
    grounds: dict[str, Bounce] = {f"e = {one:g}": hard_ground(one) for one in RESTITUTIONS}
    for ground in [*grounds, "soil"]:
        sets = [(distance, 0.0) for distance in DISTANCES] + [(MAP_DISTANCE, one) for one in LATITUDES[1:]]
        for distance, latitude in sets:
            if (distance, ground, latitude) in there:
                continue
            if ground not in grounds:
                grounds[ground] = soil(given.work)
            rows, cpu = timed(lambda: site_rows(body, distance, latitude, ground, grounds[ground]))  # noqa: B023
            print(f"{ground}, {distance:g} m, latitude {latitude:g}: {cpu:.0f} s", flush=True)
            for row in rows:
                add_row(table, {**row, "cpu_s": cpu / len(rows)}, 6)
    rows = read_rows(table, KINDS)
    document = {
        **origin("validation/ballistic_descent/ballistic_descent.py --work FOLDER"), "table": TABLE,
        "rows": len(rows), "cpu_s_of_rows": round(sum(row["cpu_s"] for row in rows)),
        "moon_radius_m": radius(body), "apart_m": body.orbit.distance,
    }  # fmt: skip
    write_document(table.with_suffix(".json"), document)


if __name__ == "__main__":
    main()
