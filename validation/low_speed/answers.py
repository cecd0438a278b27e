"""What the tables of the low-speed cases say to each claim: our number, its error, and the cause where it disagrees."""

import math
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np

sys.path.extend([str(Path(__file__).parents[1] / "experiments"), str(Path(__file__).parents[2] / "benchmarks")])
from claims import CLAIMS, Claim, claims_of
from fits import NOT_SHOWN, column
from footpad_on_ice import BORNE, HELD_SLIP, HELD_SPEED, LOOSE, RESTITUTION
from plate_sinkage import DRY, GRAVITY, PLATE, SHOWN, bearing_capacity
from rebounds_part import RISEN
from result_rows import Row, read_rows
from who_rebounds import DIAMETER

HERE = Path(__file__).parent


class Found(NamedTuple):
    """Our number and its standard error, NaN where it has none."""

    value: float
    error: float = math.nan


class Answer(NamedTuple):
    """A claim beside what was found."""

    claim: Claim
    found: Found
    cause: str

    @property
    def agrees(self) -> bool:
        """Whether our number lies within the tolerance."""
        return self.claim.low <= self.found.value <= self.claim.high


def rows_of(name: str) -> list[Row]:
    return read_rows(HERE / f"{name}.csv")


def those(rows: list[Row], **values: object) -> list[Row]:
    """Return the rows with these values in these columns."""
    return [row for row in rows if all(row[key] == value for key, value in values.items())]


def mean_and_error(values: np.ndarray) -> Found:
    """Return the mean and its standard error, which a single value has not."""
    if len(values) == 1:
        return Found(float(values[0]))
    return Found(float(values.mean()), float(values.std(ddof=1) / math.sqrt(len(values))))


def mascot() -> dict[str, Found]:
    rows = rows_of("lander_on_beds")
    ratio = {name: column(those(rows, setting=name), "ratio") for name in dict.fromkeys(row["setting"] for row in rows)}

    def beside(name: str, other: str) -> Found:
        """Return the mean of the differences of landings of one number: place and attitude are the same."""
        return mean_and_error(ratio[name] - ratio[other])

    noise, grains, surface = ratio["noise"], ratio["grains"], ratio["at the surface"]
    spread = float(surface.std(ddof=1) - grains.std(ddof=1))
    of_spread = math.hypot(*(one.std(ddof=1) / math.sqrt(2.0 * (len(one) - 1.0)) for one in (surface, grains)))
    return {
        "noise": Found(float(np.abs(noise - noise.mean()).max())),
        "surface_mean": beside("at the surface", "grains"), "below_mean": beside("below the surface", "grains"),
        "nearer": beside("at the surface", "below the surface"), "surface_scatter": Found(spread, of_spread),
        "slope": beside("slope 20 deg", "grains"),
    }  # fmt: skip


def shell() -> dict[str, Found]:
    rows = rows_of("filled_shell")
    lost = {name: column(those(rows, setting=name), "energy_lost") for name in {row["setting"] for row in rows}}
    out = {name: column(those(rows, setting=name), "rebound_speed") for name in ("half full", "empty")}

    def span(*names: str) -> float:
        means = [float(lost[name].mean()) for name in ("half full", *names)]
        return max(means) - min(means)

    others = max(span("0.05 m/s", "0.2 m/s"), span("friction 0.2", "friction 0.9"),
                 span("restitution 0.4", "restitution 0.9"))  # fmt: skip
    return {
        "lost": mean_and_error(lost["half full"]),
        "against_empty": Found(float(out["half full"].mean() / out["empty"].mean())),
        "filling": Found(span("filling 0.15", "filling 0.8") / others),
    }  # fmt: skip


def cohesion_of_dent(rows: list[Row], depth: float) -> float:
    """Return the cohesion [Pa] at which the dent has a depth [m], between runs; 0 where grains without it stop sooner.

    Between two runs depth is linear in cohesion. Infinite where even the strongest is pressed deeper.
    """
    ran = sorted(rows, key=lambda row: row["cohesion"])
    deepest = column(ran, "deepest")
    if deepest[0] <= depth:
        return 0.0
    for k in range(1, len(ran)):
        if deepest[k] <= depth:
            part = (deepest[k - 1] - depth) / (deepest[k - 1] - deepest[k])
            return float(ran[k - 1]["cohesion"] + part * (ran[k]["cohesion"] - ran[k - 1]["cohesion"]))
    return math.inf


def philae() -> dict[str, Found]:
    rows = [row for row in rows_of("philae_into_ice") if row["name"].endswith("Pa")]
    nearest = min(rows, key=lambda row: abs(row["deepest"] - 0.25))
    return {
        "strength": Found(cohesion_of_dent(rows, 0.25)),
        "time": Found(nearest["time_of_deepest"]),
    }  # fmt: skip


def share(rows: list[Row], true: Callable[[Row], bool]) -> Found:
    """Return the fraction of rows for which something is true, and its standard error."""
    part = sum(true(row) for row in rows) / len(rows)
    return Found(part, math.sqrt(part * (1.0 - part) / len(rows)))


def rebounds(row: Row) -> bool:
    """Whether a ball rises above its deepest place by what counts as a rebound."""
    return bool(row["rise"] >= RISEN)


def ejects(row: Row) -> bool:
    return bool(row["ejecta"] > 0)


def gravities() -> dict[str, Found]:
    rows = rows_of("same_soil_gravities")

    def at(least: float, most: float, *speeds: float) -> list[Row]:
        """Return the drops under shares of Earth's from and to, at some speeds or all."""
        return [row for row in rows if least <= row["share"] <= most and (not speeds or row["speed"] in speeds)]

    def thrown(share_of_earth: float) -> float:
        return float(column(at(share_of_earth, share_of_earth, 1.0), "ejecta_speed").mean())

    return {
        "reduced_rebounds": share(at(1e-2, 1e-2), rebounds), "reduced_ejecta": share(at(1e-2, 1e-2, 1.0), ejects),
        "micro_rebounds": share(at(1e-5, 1e-5, 0.05), rebounds), "micro_quiet": share(at(1e-5, 1e-5, 0.05), ejects),
        "micro_ejecta": share(at(1e-5, 1e-5, 0.2, 1.0), ejects), "ejecta_speed": Found(thrown(1e-5) / thrown(1e-2)),
    }  # fmt: skip


def coarse() -> dict[str, Found]:
    rows = [row for row in rows_of("ball_on_coarse_grains") if row["name"] in ("cm", "mm")]
    return {"rolls": share(rows, rolls)}


def rolls(row: Row) -> bool:
    """Whether a ball moves along the surface by more than a quarter of its diameter and does not bounce."""
    return not rebounds(row) and bool(row["way_along"] > 0.25 * DIAMETER)


def bears(row: Row) -> bool:
    return bool(row["deepest"] <= BORNE)


def lands(row: Row) -> bool:
    """Whether a pad is borne and stands at last, near to where it touched."""
    return bears(row) and bool(row["slip"] <= HELD_SLIP and row["last_speed"] <= HELD_SPEED)


def footpad() -> dict[str, Found]:
    rows = [row for row in rows_of("footpad_on_ice") if row["filled"] != LOOSE]
    level, slopes = those(rows, slope_deg=0.0), [row for row in rows if row["slope_deg"] > 0.0]
    up = {name: column(those(level, sintering=name), "rebound_speed") for name in ("some", "much")}
    slip = {pad: float(column(those(slopes, pad=pad), "slip").mean()) for pad in ("hemisphere", "cone", "disk")}
    return {
        "unsintered": share(those(level, sintering="none"), bears),
        "sintered": share(those(level, sintering="some"), bears), "bounce": mean_and_error(up["much"] - up["some"]),
        "safe": share(those(rows, slope_deg=15.0), lands), "steep": share(those(rows, slope_deg=20.0), lands),
        "hemisphere": Found(slip["hemisphere"] - min(slip["cone"], slip["disk"])),
    }  # fmt: skip


def borne_by_closed_form(angle: Callable[[float], float] = float) -> float:
    """Return the pressure [Pa] that the grains without cohesion bear at the last depth by the closed form.

    angle: of friction [rad] from that of a heap.
    """
    rows = rows_of("plate_sinkage")
    heap = math.radians(float(column([row for row in rows if row["name"].startswith("heap")], "slope_deg").mean()))
    dry = [row for row in rows if row["name"].split(",")[0] == "dry"]
    weight = float(column(dry, "solid_fraction").mean()) * DRY.density * GRAVITY
    return bearing_capacity(angle(heap), weight, SHOWN[-1], PLATE)


def plate() -> dict[str, Found]:
    rows = rows_of("plate_sinkage")

    def of(name: str, value: str) -> np.ndarray:
        """Return a column of the beds of a name, in the order of their seeds."""
        return column([row for row in rows if row["name"].split(",")[0] == name], value)

    deepest = f"pressure_{1e3 * SHOWN[-1]:g}mm"
    dry, cohesive, poured = (of(name, deepest) for name in ("dry", "cohesive", "poured cohesive"))
    return {
        "exponent": mean_and_error(of("dry", "exponent")), "closed_form": mean_and_error(dry / borne_by_closed_form()),
        "cohesion": mean_and_error(cohesive / dry),
        "looser": mean_and_error(of("poured cohesive", "solid_fraction") - of("dry", "solid_fraction")),
        "weaker": mean_and_error(poured / cohesive),
    }  # fmt: skip


CASES: dict[str, Callable[[], dict[str, Found]]] = {
    "mascot": mascot, "gravities": gravities, "coarse": coarse, "shell": shell, "philae": philae, "footpad": footpad,
    "plate": plate,
}  # fmt: skip


def causes() -> dict[tuple[str, str], str]:
    """Causes of what disagrees, by case and key: what brings it within its tolerance, and the number then."""
    rows = rows_of("filled_shell")
    floating = those(rows, setting="grains float")
    # The same attitudes without grains.
    empty = [row for row in those(rows, setting="empty") if row["drop"] in column(floating, "drop")]
    lost = float(column(floating, "energy_lost").mean())
    out = float(column(floating, "rebound_speed").mean() / column(empty, "rebound_speed").mean())
    words = "grains that float inside when the shell strikes"
    found = {("shell", "lost"): f"{words}: {lost:.3g}", ("shell", "against_empty"): f"{words}: {out:.3g}"}
    # Of the others the number with one thing changed counts where it lies within the tolerance.
    pads = rows_of("footpad_on_ice")
    loose = [row for row in pads if row["filled"] == LOOSE and row["sintering"] == "none"]
    damped = [row for row in pads if row["restitution"] != RESTITUTION]
    tried = {
        ("footpad", "unsintered"): ("ice that fills 0.5 of the space", share(loose, bears)),
        ("footpad", "safe"): ("grains that lose more, looser", share(damped, lands)),
    }  # fmt: skip
    claims = {(claim.case, claim.key): claim for claim in CLAIMS}
    return found | {
        key: f"{text}: {one.value:.3g}" for key, (text, one) in tried.items()
        if claims[key].low <= one.value <= claims[key].high
    }  # fmt: skip


def answers_of(case: str) -> list[Answer]:
    """Return the claims of a case beside what its table says, in their order."""
    found, shown, answers = CASES[case](), causes(), []
    for claim in claims_of(case):
        one = Answer(claim, found[claim.key], "")
        cause = "" if one.agrees else shown.get((case, claim.key), NOT_SHOWN)
        answers.append(one._replace(cause=cause))
    return answers
