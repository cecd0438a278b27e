"""A public planning trajectory of Hera as the delivery of a study: where SPICE and lithobrake have it, and how it ends.

    python validation/deliveries/hera_spk.py --kernels FOLDER

FOLDER is the folder `kernels` of https://github.com/GregoireHENRY/hera-pmi at 0d0d3a8 (which states no licence). Makes
the states of docs/howto/delivery_from_spk.md with its own code, and follows the landers to rest on hard ground of
restitution 0.5. Writes hera_spk.json beside this script. Tolerances, set before the first run:
  starts   body-fixed states within 1 mm and 1e-6 m/s of SPICE's
  coast    Hera itself, flown from its state at the epoch under the gravity of Didymos and Dimorphos, for COASTS or to
           its escape: within 1 % of the way of where the trajectory has it, which has masses of its own time
"""

import contextlib
import io
import math
import os
import sys
import tempfile
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import spiceypy

import lithobrake
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.site import Site, with_site_gravity
from lithobrake.smallbody import fly, read_partner
from lithobrake.study import StudySource

sys.path.insert(0, str(Path(__file__).parents[1]))
sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from hard_ground import HardGround
from harness import ROOT, Row, command_line, origin, study_tables, write_document

PAGE = ROOT / "docs" / "howto" / "delivery_from_spk.md"
PARTNER, PARTNER_KERNEL = -658031, "spk/HERA_didymoon_DCP3VCF_v01.bsp"
RESTITUTION, JOURNEYS = 0.5, 24
COASTS = (3600.0, 6 * 3600.0)  # s
POSITION, VELOCITY, COAST = 1e-3, 1e-6, 0.01


def made(folder: Path, kernels: Path) -> tuple[dict[str, Any], dict[str, float]]:
    """Run the code of the page over the kernels; returns its names and what it prints, and leaves release.csv."""
    text = PAGE.read_text(encoding="utf-8").split("```python\n")[1].split("```")[0]
    names: dict[str, Any] = {}
    before, said = Path.cwd(), io.StringIO()
    for part in ("lsk", "pck", "spk"):
        (folder / part).symlink_to(kernels.resolve() / part)
    os.chdir(folder)
    with contextlib.redirect_stdout(said):
        exec(compile(text, str(PAGE), "exec"), names)
    spiceypy.furnsh(PARTNER_KERNEL)
    os.chdir(before)
    printed = dict(line.split(" = ") for line in said.getvalue().splitlines())
    return names, {key: float(value) for key, value in printed.items()}


def tables_of(folder: Path, names: dict[str, Any], site: dict[str, float]) -> Row:
    kernels = [folder / one for one in [*names["KERNELS"], PARTNER_KERNEL]]
    place = read_partner(kernels, names["BODY"], PARTNER, names["EPOCH"])
    delivery = {"latitude_deg": 60.0, "longitude_deg": 0.0, "states": str(folder / "release.csv"), "frame": "icrf",
                "epoch": names["EPOCH"], "release": None}  # fmt: skip
    around = {"body": "didymos", "partner_longitude_deg": (place.longitude_deg + 180.0) % 360.0 - 180.0, **site}
    changes = {"delivery": delivery, "site": around, "journey": {"count": JOURNEYS}}
    return study_tables(ROOT / "scenarios" / "release.toml", changes)


def starts(names: dict[str, Any], states: np.ndarray, flights: Any) -> dict[str, float]:
    """Largest distances of body-fixed starts from those of SPICE [m], [m/s]."""
    rate = np.array([0.0, 0.0, 2.0 * math.pi / flights.start.spin_period[0]])
    away = np.zeros(2)
    for number, (late, *state) in enumerate(states.tolist()):
        turn = np.array(spiceypy.tipbod("J2000", names["BODY"], names["epoch"] + late))
        place = turn @ state[:3]
        velocity = turn @ state[3:] - np.cross(rate, place)
        off = (flights.start.position[number] - place, flights.start.velocity[number] - velocity)
        away = np.maximum(away, [np.linalg.norm(one) for one in off])
    return {"position_m": float(away[0]), "velocity_m_s": float(away[1])}


def coasts(names: dict[str, Any], study: Any) -> list[Row]:
    """Fly Hera from its state, and compare with the trajectory."""
    body, spin = Site(study).body, np.array([0.0, 0.0, 1.0]) * Site(study).body.spin_rate

    def fixed(time: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        state = 1e3 * np.array(spiceypy.spkgeo(names["CRAFT"], time, "J2000", names["BODY"])[0])
        turn = np.array(spiceypy.tipbod("J2000", names["BODY"], time))
        return turn @ state[:3], turn @ state[3:] - np.cross(spin, turn @ state[:3]), state[:3]

    rows, (place, velocity, begin) = [], fixed(names["epoch"])
    for duration in COASTS:
        flown = fly(body, place, velocity, duration)
        # A craft that flies away is followed until it is far enough that it does not come back.
        lasted = float(flown.time[0])
        there, _, end = fixed(names["epoch"] + lasted)
        way, off = float(np.linalg.norm(end - begin)), float(np.linalg.norm(flown.position[0] - there))
        rows.append(
            {
                "duration_s": lasted,
                "status": str(flown.status[0]),
                "way_m": way,
                "off_m": off,
                "agrees": off <= COAST * way,
            }
        )
    return rows


def main() -> None:
    kernels = command_line(__doc__, kernels=Path).parse_args().kernels
    with tempfile.TemporaryDirectory() as work:
        folder = Path(work)
        names, site = made(folder, kernels)
        states = np.loadtxt(folder / "release.csv", delimiter=",", skiprows=1)
        tables = tables_of(folder, names, site)
        study = with_site_gravity(StudySource.of_tables(tables).study)
        flights = DrawnDesign(study).descents.flights
        away = starts(names, states, flights)
        distance = np.linalg.norm(states[:, 1:4], axis=1)
        found = lithobrake.run(
            tables, folder / "out", model=HardGround(RESTITUTION, RESTITUTION), workers=1, report=False
        )
        agrees = away["position_m"] <= POSITION and away["velocity_m_s"] <= VELOCITY
        document = {
            **origin("validation/deliveries/hera_spk.py --kernels FOLDER"), "commit": "0d0d3a8", "site": site,
            "partner_longitude_deg": tables["site"]["partner_longitude_deg"], "landers": len(states),
            "distance_m": [float(distance.min()), float(distance.max())], "starts": {**away, "agrees": agrees},
            "coasts": coasts(names, study), "flights": dict(Counter(flights.status.tolist())),
            "ends": dict(Counter(found.journeys["end"].tolist())),
            "touchdowns": float(np.median(found.journeys["touchdowns"])),
            "delivery": {key: [float(one) for one in getattr(found.results.delivery, key)]
                         for key in ("speed", "incidence_deg", "descent_s")},
        }  # fmt: skip
    write_document(Path(__file__).with_suffix(".json"), document)
    print(document)


if __name__ == "__main__":
    main()
