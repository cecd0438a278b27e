"""Does a lander stop, go along the ground or bounce off? Shares over speed and angle for a sphere and a box.

    python validation/experiments/oblique_map.py --work FOLDER [--placements 3] [--speeds 0.1 0.2] [--out FOLDER]

Beds are poured once into the work folder. Each landing draws its place, attitude, heading and soil, the same in all
cells; the soil out of the ranges of first_bounce.toml. Writes oblique_map.csv, a line for each landing as it ends;
landings that stand there are not run again. Then oblique_map.json and oblique_map.png; without --out the picture goes
to docs/validation/experiments.
"""

import itertools
import math
import sys
import time
from collections import Counter
from functools import cache
from pathlib import Path

import numpy as np

from lithobrake.analysis import wilson_interval
from lithobrake.dem import Box, Material, Sphere
from lithobrake.touchdown import Bed, BedRecipe, ContactModel, GrainSizes, Lander, Landing, Outcome, land, pour_bed

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from drawing import figure
from harness import PAGES, Row, add_row, command_line, origin, read_rows, write_document

GRAVITY, GRAIN_DIAMETER, WIDTH = 5e-5, 0.09, 0.7  # m/s2, m, m
SPEEDS, INCIDENCES = (0.02, 0.05, 0.1, 0.2, 0.4), (0.0, 30.0, 50.0, 65.0, 80.0)  # m/s, deg from the normal
SHAPES = {"sphere": Sphere(0.05), "box": Box((0.1, 0.1, 0.227))}
LENGTHS = {"sphere": 0.1, "box": 0.227}  # m, the longest extent
MASS, BEDS, TIME_LIMIT = 2.0, 4, 600.0
MIDDLE = 0.08  # m, landings straight down aim at places so far from the middle along x and y
# What comes slanting goes on: it aims so much before that place, times the sine of the angle [m].
RUNWAY = 0.08
# A slanting lander starts above every grain below it and meets the next that stands up: so far above, on the whole.
FALL = 0.02
CONTACT = ContactModel(steps_per_contact=25.0, stepping="local")
FRAMES = 200
# Farther off the straight line than this, a lander has touched [m].
DEFLECTED = 1e-5
HERE = Path(__file__).parent
FIGURES = PAGES / "experiments"
PANELS = {
    "stop": "stops on the bed",
    "along": "goes along the ground farther than its length",
    "bounce": "bounces off where it came down",
    "speed": "rebound / impact speed (median, quartiles)",
}
CLASSES = ("stop", "along", "bounce", "lost")
KEYS = {"shape": str, "speed": float, "incidence_deg": float, "bed": int, "placement": int, "status": str}


def soil(young_modulus: float, poisson_ratio: float, restitution: float, friction: float) -> Material:
    """Return the rock of a landing."""
    return Material(
        young_modulus=young_modulus, poisson_ratio=poisson_ratio, restitution=restitution, friction=friction,
        density=2500.0,
    )  # fmt: skip


@cache
def bed(number: int, folder: Path) -> Bed:
    """Return a bed of the soil in the middle of the ranges, poured unless it lies there."""
    path = folder / f"oblique_{number}.h5"
    if not path.exists():
        sizes = GrainSizes(distribution="constant", lower=GRAIN_DIAMETER, upper=GRAIN_DIAMETER)
        recipe = BedRecipe(
            grain_count=150, sizes=sizes, cloud_point_count=14, width=(WIDTH, WIDTH),
            material=soil(math.sqrt(5e5 * 5e6), 0.25, 0.6, 0.75), gravity=(0.0, 0.0, -GRAVITY), pour_gravity=0.5,
            seed=40 + number,
        )  # fmt: skip
        pour_bed(recipe).save(path)
    return Bed.load(path)


def prepared(shape: str, speed: float, incidence_deg: float, number: int, placement: int) -> tuple[Lander, Landing]:
    """Return the lander and the landing of a place in the plan; what is drawn is the same in all cells."""
    generator = np.random.default_rng([11, number, placement])
    aim, attitude = generator.uniform(-MIDDLE, MIDDLE, size=2), tuple(generator.normal(size=4))
    azimuth = float(generator.uniform(-math.pi, math.pi))
    young, *rest = generator.uniform([math.log(5e5), 0.15, 0.3, 0.6, 0.3], [math.log(5e6), 0.35, 0.9, 0.9, 0.9])
    grain = soil(math.exp(young), *rest[:3])
    surface = soil(math.exp(young), rest[0], rest[3], rest[2])
    incidence = math.radians(incidence_deg)
    before = FALL * math.tan(incidence) + RUNWAY * math.sin(incidence)
    place = aim - before * np.array([math.cos(azimuth), math.sin(azimuth)])
    lander = Lander(shape=SHAPES[shape], mass=MASS, inertia=None, material=surface)
    return lander, Landing(
        grain=grain, speed=speed, incidence=incidence, azimuth=azimuth, place=tuple(place), orientation=attitude,
        spin=(0.0, 0.0, 0.0), gravity=(0.0, 0.0, -GRAVITY), time_limit=TIME_LIMIT, contact=CONTACT,
    )  # fmt: skip


def way(outcome: Outcome, landing: Landing) -> float:
    """Return how far the lander went along the ground from its first to its last touch [m]; NaN for no touch."""
    assert outcome.frames is not None
    moments, places = outcome.frames["time"], outcome.frames["position"][:, -1]
    later = moments[:, None]
    straight = places[0] + landing.velocity * later + 0.5 * np.array(landing.gravity) * later**2
    off = np.flatnonzero(np.linalg.norm(places - straight, axis=1) > DEFLECTED)
    if len(off) == 0:
        return math.nan
    first = moments[off[0] - 1]
    ends = (first, first + outcome.outputs["contact_duration"])
    gone = [float(np.diff(np.interp(ends, moments, places[:, axis]))[0]) for axis in (0, 1)]
    return math.hypot(*gone)


def run(shape: str, speed: float, incidence_deg: float, number: int, placement: int, work: Path) -> Row:
    """Land once and return a line of the table."""
    lander, landing = prepared(shape, speed, incidence_deg, number, placement)
    ground = bed(number, work)
    start = time.process_time()
    outcome = land(ground, lander, landing, frame_count=FRAMES)
    outputs = outcome.outputs
    return {
        "shape": shape, "speed": speed, "incidence_deg": incidence_deg, "bed": number, "placement": placement,
        "status": outcome.status.value, "young_modulus": landing.grain.young_modulus,
        "restitution": landing.grain.restitution, "friction": landing.grain.friction,
        "lander_restitution": lander.material.restitution, "speed_ratio": outputs["speed_out"] / speed,
        "elevation_deg": math.degrees(outputs["elevation_out"]), "spin_out": outputs["spin_out"],
        "over_rim": outputs["over_rim"], "way": way(outcome, landing), "contact_duration": outputs["contact_duration"],
        "penetration": outputs["penetration"], "simulated_time": outcome.simulated_time,
        "cpu_s": time.process_time() - start,
    }  # fmt: skip


def noted(table: Path) -> list[Row]:
    return read_rows(table, KEYS)


def kind(row: Row) -> str:
    """Return what became of a lander: one of CLASSES."""
    far = row["way"] > LENGTHS[row["shape"]]
    if row["status"] == "captured":
        return "stop"
    if row["status"] == "clear":
        return "along" if far else "bounce"
    return "along" if far and row["status"] == "left_sideways" else "lost"


def cell(rows: list[Row]) -> Row:
    """Return the shares of a cell with their 95 % intervals, and how fast what left the ground was."""
    counts = Counter(kind(row) for row in rows)
    leaving = [row for row in rows if row["status"] == "clear"]
    ratios, elevations = ([row[name] for row in leaving] for name in ("speed_ratio", "elevation_deg"))
    return {
        "landings": len(rows),
        "outcomes": dict(Counter(row["status"] for row in rows)),
        "over_rim": sum(row["over_rim"] == 1.0 for row in rows),
        "shares": {
            name: {"count": counts[name], "share": counts[name] / len(rows),
                   "interval": wilson_interval(counts[name], len(rows))}
            for name in CLASSES
        },
        "speed_ratio_quartiles": np.percentile(ratios, [25, 50, 75]).tolist() if leaving else None,
        "elevation_deg_median": float(np.median(elevations)) if leaving else None,
    }  # fmt: skip


def cells(rows: list[Row]) -> list[Row]:
    found = []
    for shape, speed, angle in itertools.product(SHAPES, SPEEDS, INCIDENCES):
        of = [row for row in rows if (row["shape"], row["speed"], row["incidence_deg"]) == (shape, speed, angle)]
        if of:
            found.append({"shape": shape, "speed": speed, "incidence_deg": angle, **cell(of)})
    return found


def value_and_text(entry: Row, panel: str) -> tuple[float, str]:
    """Return what colours a cell, and what is written in it."""
    if panel == "speed" and entry["speed_ratio_quartiles"] is None:
        return float("nan"), "none\nleft"
    if panel == "speed":
        low, middle, high = entry["speed_ratio_quartiles"]
        return middle, f"{middle:.2f}\n{low:.2f}-{high:.2f}"
    share = entry["shares"][panel]
    low, high = share["interval"]
    return share["share"], f"{share['count']} of {entry['landings']}\n{low:.2f}-{high:.2f}"


def draw(found: list[Row], path: Path) -> None:
    shapes = list(dict.fromkeys(entry["shape"] for entry in found))
    speeds = sorted({entry["speed"] for entry in found})
    angles = sorted({entry["incidence_deg"] for entry in found})
    size = (4.6 * len(shapes), 9.4)
    with figure(path, len(PANELS), len(shapes), size, squeeze=False, sharex=True, sharey=True) as (drawn, axes):
        for column, shape in enumerate(shapes):
            for axis, (panel, title) in zip(axes[:, column], PANELS.items(), strict=True):
                shown = np.full((len(speeds), len(angles)), np.nan)
                for entry in (entry for entry in found if entry["shape"] == shape):
                    place = speeds.index(entry["speed"]), angles.index(entry["incidence_deg"])
                    shown[place], text = value_and_text(entry, panel)
                    colour = "white" if shown[place] > 0.55 else "black"
                    axis.text(place[1], place[0], text, ha="center", va="center", fontsize=8, color=colour)
                axis.imshow(shown, origin="lower", aspect="auto", cmap="Blues", vmin=0.0, vmax=1.0)
                axis.set_xticks(range(len(angles)), [f"{angle:g}" for angle in angles])
                axis.set_yticks(range(len(speeds)), [f"{speed:g}" for speed in speeds])
                axis.set_title(f"{shape}: {title}", fontsize=8.5)
        drawn.supxlabel("angle from the normal [deg]", fontsize=9)
        drawn.supylabel("speed [m/s]", fontsize=9)


def main() -> None:
    chosen = command_line(__doc__, work=Path, placements=3, speeds=SPEEDS, out=HERE).parse_args()
    chosen.work.mkdir(parents=True, exist_ok=True)
    table = chosen.out / "oblique_map.csv"
    done = {tuple(row[key] for key in list(KEYS)[:5]) for row in noted(table)}
    ways = list(itertools.product(SHAPES, chosen.speeds, INCIDENCES))
    # Cells fill evenly, so that a map that is stopped early is a coarser map and not a part of one.
    for placement, number, (shape, speed, angle) in itertools.product(range(chosen.placements), range(BEDS), ways):
        if (shape, speed, angle, number, placement) not in done:
            add_row(table, run(shape, speed, angle, number, placement, chosen.work), digits=6)
    rows = noted(table)
    document = {
        **origin(f"validation/experiments/oblique_map.py --work FOLDER --placements {chosen.placements}"),
        "landings": len(rows),
        "cpu_s_of_landings": round(sum(row["cpu_s"] for row in rows)), "lengths_m": LENGTHS, "mass_kg": MASS,
        "gravity": GRAVITY, "cells": cells(rows),
    }  # fmt: skip
    write_document(chosen.out / "oblique_map.json", document)
    draw(document["cells"], (FIGURES if chosen.out == HERE else chosen.out) / "oblique_map.png")


if __name__ == "__main__":
    main()
