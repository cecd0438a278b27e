"""How often the intervals of a study of journeys hold the truth, on synthetic journeys whose laws are known.

    python validation/journey_coverage.py [--studies 1000]
    python validation/journey_coverage.py --page    the table of interval_coverage.md, from what was made

A journey has one soil, which acts on all of its touchdowns, and one bed, which it shares with every B-th journey and
which acts on all of their touchdowns; each touchdown has a place of its own. A touchdown turns the speed by a factor,
whose logit is the sum of these. A journey ends at rest where the speed falls below one limit, escaped where it exceeds
another, and under way when its time is up. rho: part of the bed in the variance of that logit; correlation: of the
logarithm of the time to rest of two journeys on one bed, which is larger, since places differ between touchdowns and
the bed does not.
A row a setting and quantity: truth, how often a nominal 90 % interval held it, and missed it below and above, mean
error, mean half width of the intervals with two ends, and how many studies gave one. An end that the journeys cannot
give counts as infinite. Writes journey_coverage.csv and .json beside this file.
"""

import math
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from itertools import product
from pathlib import Path

import numpy as np
from scipy import special

from lithobrake.analysis import quantile_estimate, share_estimate

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from harness import Row, command_line, read_rows, rounded, write_made, write_rows
from page import table

TABLE = Path(__file__).with_suffix(".csv")
COLUMNS = (
    *("quantity", "journeys", "beds", "duration_s", "rho", "correlation", "studies", "truth"),
    *("held", "truth_below", "truth_above", "bias", "half_width", "two_ends"),
)
DESIGNS = ((96, 12), (240, 24))
RHOS = (0.0, 0.05, 0.2)
# Some journeys are still under way after the first; hardly one after the second.
DURATIONS = (1800.0, 3600.0)
ENDS = ("at_rest", "escaped", "under_way")
AT_REST, ESCAPED, UNDER_WAY = range(3)
CONTACTS = "contacts"
WORDS = {
    "at_rest": "fraction at rest", "escaped": "fraction escaped", "under_way": "fraction under way",
    "time_s median": "time to rest, median [s]", "time_s q95": "time to rest, 95 % [s]",
    "contacts median": "contacts, median", "contacts q95": "contacts, 95 %",
}  # fmt: skip
PROBABILITIES = {"median": 0.5, "q95": 0.95}
TRUTH_COUNT = 1_000_000


@dataclass(frozen=True)
class Truth:
    """The law of the journeys.

    speed [m/s] of the delivery, median, and spread of its logarithm; factor: median of the speed after a touchdown over
    that before, and spread: standard deviation of its logit; soil and rho: parts of its variance that soil and bed
    have; rest and escape: speeds [m/s] after a touchdown below and above which the journey ends; gravity [m/s2] and
    elevation: sine of that of each flight; contact: time of a touchdown [s]; duration: most time of a journey [s]
    """

    rho: float = 0.05
    soil: float = 0.1
    spread: float = 0.8
    factor: float = 0.45
    speed: tuple[float, float] = (0.06, 0.15)
    rest: float = 0.004
    escape: float = 0.055
    gravity: float = 5e-5
    elevation: float = 0.5
    contact: float = 60.0
    duration: float = 1800.0

    def journeys(self, bed: np.ndarray, random: np.random.Generator) -> dict[str, np.ndarray]:
        """End (place in ENDS), time to rest [s] and contacts (NaN without rest) for bed effects [count]."""
        count, place = len(bed), math.sqrt(1.0 - self.soil - self.rho)
        fixed = math.sqrt(self.soil) * random.standard_normal(count) + math.sqrt(self.rho) * bed
        speed = self.speed[0] * np.exp(self.speed[1] * random.standard_normal(count))
        time, contacts, end = np.zeros(count), np.zeros(count), np.full(count, UNDER_WAY)
        going = np.arange(count)
        while len(going):
            effect = fixed[going] + place * random.standard_normal(len(going))
            speed[going] *= special.expit(special.logit(self.factor) + self.spread * effect)
            time[going] += self.contact
            contacts[going] += 1.0
            going = going[time[going] <= self.duration]
            rests, escapes = speed[going] < self.rest, speed[going] > self.escape
            end[going[rests]], end[going[escapes]] = AT_REST, ESCAPED
            going = going[~(rests | escapes)]
            time[going] += 2.0 * self.elevation * speed[going] / self.gravity
        unknown = end != AT_REST
        return {"end": end, "time_s": np.where(unknown, np.nan, time), CONTACTS: np.where(unknown, np.nan, contacts)}

    def study(self, journey_count: int, bed_count: int, seed: int) -> dict[str, np.ndarray]:
        """Journeys of one study, and their beds, dealt in turn."""
        random, bed = np.random.default_rng([seed, journey_count]), np.arange(journey_count) % bed_count
        return self.journeys(random.standard_normal(bed_count)[bed], random) | {"bed": bed}


@lru_cache
def exact(truth: Truth) -> dict[str, float]:
    """The truth of each quantity, from so many journeys on as many beds."""
    random = np.random.default_rng(1)
    found = truth.journeys(random.standard_normal(TRUTH_COUNT), random)
    shares = {name: float(np.mean(found["end"] == end)) for end, name in enumerate(ENDS)}
    return shares | {
        f"{name} {level}": float(np.nanquantile(found[name], probability))
        for name in ("time_s", CONTACTS)
        for level, probability in PROBABILITIES.items()
    }


@lru_cache
def correlation(truth: Truth) -> float:
    """Of the logarithm of the time to rest of two journeys on one bed, where both rest."""
    random = np.random.default_rng(2)
    bed = random.standard_normal(TRUTH_COUNT)
    first, second = (np.log(truth.journeys(bed, random)["time_s"]) for _ in range(2))
    both = np.isfinite(first) & np.isfinite(second)
    return float(np.corrcoef(first[both], second[both])[0, 1])


def estimates(found: dict[str, np.ndarray]) -> Iterator[tuple[str, float, float | None, float | None]]:
    """Each quantity of a study with its value and the ends of its interval."""
    for end, name in enumerate(ENDS):
        share = share_estimate((found["end"] == end).astype(float), found["bed"]).share
        yield name, share.value, share.lower, share.upper
    for name in ("time_s", CONTACTS):
        for level, probability in PROBABILITIES.items():
            one = quantile_estimate(found[name], found["bed"], probability, counts=name == CONTACTS)
            yield f"{name} {level}", one.value, one.lower, one.upper


def setting(truth: Truth, journey_count: int, bed_count: int, study_count: int) -> Iterator[Row]:
    held: dict[str, list[tuple[float, ...]]] = {}
    for seed in range(study_count):
        for name, value, lower, upper in estimates(truth.study(journey_count, bed_count, seed)):
            low, high = -math.inf if lower is None else lower, math.inf if upper is None else upper
            true, half = exact(truth)[name], 0.5 * (high - low)
            held.setdefault(name, []).append((true < low, true > high, value - true, half, math.isfinite(half)))
    for name, studies in held.items():
        below, above, bias, half, both = np.array(studies, dtype=float).T
        yield {
            "quantity": name, "journeys": journey_count, "beds": bed_count, "duration_s": truth.duration,
            "rho": truth.rho, "correlation": correlation(truth), "studies": study_count, "truth": exact(truth)[name],
            "held": 1.0 - below.mean() - above.mean(), "truth_below": below.mean(), "truth_above": above.mean(),
            "bias": bias.mean(), "half_width": float(half[both > 0.0].mean()) if both.any() else math.nan,
            "two_ends": both.mean(),
        }  # fmt: skip


def kept_rows() -> list[Row]:
    return read_rows(TABLE, {"quantity": str, "journeys": int, "beds": int})


def page_table(rows: list[Row]) -> str:
    """How often each interval held, as a table in Markdown."""
    settings, lines = list(product(DESIGNS, RHOS)), []
    for duration, (name, words) in product(DURATIONS, WORDS.items()):
        found = [row for row in rows if row["duration_s"] == duration and row["quantity"] == name]
        held = {((row["journeys"], row["beds"]), row["rho"]): row["held"] for row in found}
        true = sorted({row["truth"] for row in found})
        span = " to ".join(dict.fromkeys(f"{one:.2g}" if one < 1.0 else f"{one:.0f}" for one in (true[0], true[-1])))
        # Of an event that hardly a study meets, the interval of none decides; escapes do not depend on the time.
        if true[-1] > 0.005 and (name != "escaped" or duration == DURATIONS[0]):
            lines.append((words, span, *(f"{held[one]:.2f}" for one in settings)))
    heads = ("journeys, beds; rho", "truth", *(f"{n}, {b}; {rho:g}" for (n, b), rho in settings))
    return table(heads, lines) + "\n"


def main() -> None:
    options = command_line(__doc__, studies=1000, page=False).parse_args()
    if options.page:
        print(page_table(kept_rows()))
        return

    def rows() -> Iterator[Row]:
        for duration, rho, (journey_count, bed_count) in product(DURATIONS, RHOS, DESIGNS):
            truth = Truth(duration=duration, rho=rho)
            for row in map(rounded, setting(truth, journey_count, bed_count, options.studies)):
                print(*(row[key] for key in COLUMNS), sep="\t", flush=True)
                yield row

    write_rows(TABLE, COLUMNS, rows())
    write_made(TABLE, f"validation/journey_coverage.py --studies {options.studies}")


if __name__ == "__main__":
    main()
