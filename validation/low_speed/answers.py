"""What the tables of the low-speed cases say to each claim: our number, its error, and the cause where it disagrees."""

import math
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np

sys.path.extend([str(Path(__file__).parents[1] / "experiments"), str(Path(__file__).parents[2] / "benchmarks")])
from claims import Claim, claims_of
from fits import NOT_SHOWN, column
from result_rows import Row, read_rows

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
    """Return the mean and its standard error."""
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


CASES: dict[str, Callable[[], dict[str, Found]]] = {"mascot": mascot, "shell": shell, "philae": philae}


def causes() -> dict[tuple[str, str], str]:
    """Causes of what disagrees, by case and key: what brings it within its tolerance, and the number then."""
    rows = rows_of("filled_shell")
    floating = those(rows, setting="grains float")
    # The same attitudes without grains.
    empty = [row for row in those(rows, setting="empty") if row["drop"] in column(floating, "drop")]
    lost = float(column(floating, "energy_lost").mean())
    out = float(column(floating, "rebound_speed").mean() / column(empty, "rebound_speed").mean())
    words = "grains that float inside when the shell strikes"
    return {("shell", "lost"): f"{words}: {lost:.3g}", ("shell", "against_empty"): f"{words}: {out:.3g}"}


def answers_of(case: str) -> list[Answer]:
    """Return the claims of a case beside what its table says, in their order."""
    found, shown, answers = CASES[case](), causes(), []
    for claim in claims_of(case):
        one = Answer(claim, found[claim.key], "")
        cause = "" if one.agrees else shown.get((case, claim.key), NOT_SHOWN)
        answers.append(one._replace(cause=cause))
    return answers
