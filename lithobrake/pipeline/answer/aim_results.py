"""What becomes of the landers at every aim, which aim is best and how sure that is, with a sentence."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from lithobrake.analysis import LEVEL, best_choice, quantile_within, refit_interval, wilson_interval
from lithobrake.files.reading import read_rows
from lithobrake.pipeline.answer.dispersion_statistics import NORMAL_QUANTILE_90
from lithobrake.pipeline.answer.shares_over_refits import Refits
from lithobrake.pipeline.emulate.fitted_emulator import REFIT_COUNT
from lithobrake.pipeline.folder.study_folder import AGAIN, StudyFolder
from lithobrake.pipeline.rest.aiming import COLUMNS, FILE
from lithobrake.study import Study
from lithobrake.study.question_sections import AimLimit
from lithobrake.study.units import input_units
from lithobrake.vocabulary.outcomes import JourneyStatus
from lithobrake.vocabulary.quantities import PURE

SETTLED = JourneyStatus.SETTLED.value
FAR = 0.95
# The outcome of these landers is unknown.
UNKNOWN = (JourneyStatus.OUTSIDE, JourneyStatus.BOUNCING)
HOUR = 3600.0
# More aims than these make no sentence.
NAMED = 3


@dataclass(frozen=True)
class Landers:
    """Landers on one ground, [aim_count, lander_count]: how each ended, time [s] and way [m] to rest, its refit."""

    status: np.ndarray
    time: np.ndarray
    distance: np.ndarray
    refit: np.ndarray

    @property
    def settled(self) -> np.ndarray:
        """Which have come to rest where the ground holds them."""
        rests: np.ndarray = self.status == JourneyStatus.SETTLED
        return rests


def aim_results(study: Study, folder: StudyFolder, fitted: Refits) -> dict[str, Any] | None:
    """The results of every aim of a study on both grounds, and the best; None where it has no aims."""
    if not study.aim.grid:
        return None
    aims, units = study.aim.aims(), input_units()
    found = {ground: _landers(folder, ground, len(aims)) for ground in ("soil", "hard")}
    parts = {ground: [_of_aim(one, row, ground, fitted) for row in range(len(aims))] for ground, one in found.items()}
    limits = [limit for limit in map(AimLimit.of, study.aim.within) if limit]
    table: dict[str, Any] = {
        "names": list(study.aim.grid),
        "units": [units[name].removeprefix(PURE) for name in study.aim.grid],
        "within": study.aim.within,
        "lander_count": found["soil"].status.shape[1],
        "refit_count": REFIT_COUNT,
        "level": LEVEL,
        "why": fitted.why,
        "aims": [
            {"values": list(aim.values()), **{ground: parts[ground][row] for ground in found}}
            for row, aim in enumerate(aims)
        ],
    }
    for ground, landers in found.items():
        allowed = [_keeps(limits, aim, part) for aim, part in zip(aims, parts[ground], strict=True)]
        for part, is_allowed in zip(parts[ground], allowed, strict=True):
            part["allowed"] = is_allowed
        bed_count = fitted.bed_count if ground == "soil" and fitted.why is None else None
        table[f"best_on_{ground}"] = _best(landers, allowed, parts[ground], bed_count)
    return table | {"statement": _statement(table)}


def _landers(folder: StudyFolder, ground: str, aim_count: int) -> Landers:
    """The landers on one ground."""
    rows = [row for row in read_rows(folder / FILE, COLUMNS, AGAIN) if row["ground"] == ground]
    shape = (aim_count, len(rows) // aim_count)
    numbers = ([float(row[name] or "nan") for row in rows] for name in ("time_s", "distance"))
    time, distance = (np.reshape(one, shape) for one in numbers)
    status = np.reshape(np.array([row["status"] for row in rows], dtype=object), shape)
    return Landers(status, time, distance, np.reshape([int(row["refit"]) for row in rows], shape))


def _of_aim(landers: Landers, row: int, ground: str, fitted: Refits) -> dict[str, Any]:
    """Shares and 95 % quantiles of one aim, with their intervals where there are any."""
    settled, unknown = landers.settled[row], np.isin(landers.status[row], UNKNOWN)
    refit, every = landers.refit[row], np.ones(len(settled), dtype=bool)
    share, lower, upper = _share(settled, every, refit, ground, fitted)
    table: dict[str, Any] = {
        SETTLED: {"share": share, "lower": lower, "upper": upper},
        "missing": float(unknown.mean()),
    }
    for name, values in (("distance_p95", landers.distance[row]), ("time_p95", landers.time[row])):
        table[name] = None
        if settled.any():
            far = float(quantile_within(values[settled], FAR, (FAR, FAR))[0])
            _, low, high = _share(settled & (values <= far), settled, refit, ground, fitted)
            ends = (0.0, 1.0) if low is None or high is None else (low, high)
            value, *bounds = quantile_within(values[settled], FAR, ends)
            table[name] = {"value": value} | {
                end: bound if math.isfinite(bound) and low is not None else None
                for end, bound in zip(("lower", "upper"), bounds, strict=True)
            }
    return table


def _share(
    met: np.ndarray, of: np.ndarray, refit: np.ndarray, ground: str, fitted: Refits
) -> tuple[float, float | None, float | None]:
    """Share of some landers that have met an event, with its bounds: over refits on soil, by their number on hard."""
    share = float(met.sum() / of.sum())
    if ground == "hard":
        return share, *wilson_interval(int(met.sum()), int(of.sum()), NORMAL_QUANTILE_90)
    counts, totals = (np.bincount(refit[one], minlength=REFIT_COUNT) for one in (met, of))
    # Of one lander of a refit no scatter within it can be told; of few refits none between them.
    told = totals >= 2
    if fitted.why is not None or told.sum() < REFIT_COUNT // 2:
        return share, None, None
    found = refit_interval(counts[told], totals[told], fitted.bed_count)
    return share, found.lower, found.upper


def _keeps(limits: list[AimLimit], aim: dict[str, float], part: dict[str, Any]) -> bool:
    """Whether an aim and what comes of it keep all limits."""
    known: dict[str, float | None] = {name.partition(".")[2]: value for name, value in aim.items()}
    known |= {SETTLED: part[SETTLED]["share"], "missing": part["missing"]}
    known |= {name: part[name] and part[name]["value"] for name in ("distance_p95", "time_p95")}
    return all(limit.keeps(known[limit.name]) for limit in limits)


def _best(
    landers: Landers, allowed: list[bool], parts: list[dict[str, Any]], bed_count: int | None
) -> dict[str, Any] | None:
    """The aim at which most landers settle, of those allowed; None where none is, or nobody settles.

    bed_count: None where refits tell nothing, as on hard ground; then there is no share of refits and no interval.
    """
    shares = np.where(allowed, [part[SETTLED]["share"] for part in parts], -1.0)
    if shares.max() <= 0.0:
        return None
    unknown = dict.fromkeys(("share_of_refits", "own", "not_worse", "next", "difference"))
    table: dict[str, Any] = {"aim": int(shares.argmax()), **unknown}
    if bed_count is None:
        return table
    order = np.argsort(landers.refit[0], kind="stable")
    found = best_choice(landers.settled[:, order].reshape(len(parts), REFIT_COUNT, -1), bed_count, allowed)
    for part, share in zip(parts, found.shares.tolist(), strict=True):
        part["share_of_refits"] = share
    table |= {"aim": found.best, "share_of_refits": float(found.shares[found.best]), "next": found.runner_up}
    own = found.own
    table["own"] = {"share": own.value, "lower": own.lower, "upper": own.upper}
    table["not_worse"] = [aim for aim in found.not_worse if aim != found.best]
    if found.difference is not None:
        one = found.difference
        table["difference"] = {"value": one.value, "lower": one.lower, "upper": one.upper}
    return table


def _statement(table: dict[str, Any]) -> str:
    """The best aim in a sentence, how sure it is, and what hard ground would say."""
    aims, within = table["aims"], f" within {', '.join(table['within'])}" if table["within"] else ""
    count = sum(aim["soil"]["allowed"] for aim in aims)
    best, hard = table["best_on_soil"], table["best_on_hard"]
    if best is None:
        return f"Of {len(aims)} aims {count} are allowed{within}, and at none of these a lander settles."
    part = aims[best["aim"]]["soil"]
    # The largest of many shares is too high by its selection, so the sentence has the share without it.
    share = best["own"] or part[SETTLED]
    said = [
        f"Of {count} aims{within} landers settle most often at {_words(table, best['aim'])}: {_span(share, level=True)}"
    ]
    if part["distance_p95"] is not None:
        far, late = part["distance_p95"]["value"], part["time_p95"]["value"] / HOUR
        said[0] += f", 95 % of these within {far:.3g} m and {late:.3g} h"
    if part["missing"] >= 0.005:
        said[0] += f"; {100 * part['missing']:.0f} % have an unknown outcome{_rivals(table, best['aim'])}"
    if best["not_worse"] is not None:
        said.append(_alike(table, best["not_worse"], count - 1))
    if hard is not None:
        share = _span(aims[hard["aim"]]["hard"][SETTLED])
        where = "this one, too" if best["aim"] == hard["aim"] else _words(table, hard["aim"])
        said.append(f"Hard ground is best at {where}: {share}")
    return ". ".join(said) + "."


def _alike(table: dict[str, Any], places: list[int], others: int) -> str:
    """Which of the other allowed aims cannot be told from the best, all of them together."""
    if not others:
        return "No other aim is allowed"
    surely = f"with {100 * LEVEL:.0f} % confidence"
    if not places:
        return f"It is better than every other, {surely}"
    named = f": {'; '.join(_words(table, place) for place in places)}" if len(places) <= NAMED else ""
    return f"{len(places)} of the other {others} cannot be distinguished from it {surely}{named}"


def _rivals(table: dict[str, Any], best: int) -> str:
    """How many other aims would be better if all landers of unknown outcome settled there."""
    least = table["aims"][best]["soil"][SETTLED]["share"]
    most = [one["soil"][SETTLED]["share"] + one["soil"]["missing"] for one in table["aims"] if one["soil"]["allowed"]]
    count = sum(share > least for share in most) - 1
    return f", and if all of these settled, as many as {count} other aims could be better" if count > 0 else ""


def _words(table: dict[str, Any], place: int) -> str:
    """An aim in words."""
    values = table["aims"][place]["values"]
    return ", ".join(f"{name} = {value:g}" for name, value in zip(table["names"], values, strict=True))


def _span(share: dict[str, Any], *, level: bool = False) -> str:
    """A share with its interval in words, and that of the interval where it is to be named."""
    if share["lower"] is None:
        return f"{100 * share['share']:.0f} %"
    named = f"{100 * LEVEL:.0f} % interval " if level else ""
    return f"{100 * share['share']:.0f} % ({named}{100 * share['lower']:.0f}-{100 * share['upper']:.0f} %)"
