"""The delivery options of a study: what becomes of the landers of each on both grounds, and the best of them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from lithobrake import analysis
from lithobrake.analysis.subset_simulation import limit_state_met
from lithobrake.files.reading import read_rows
from lithobrake.pipeline.answer.dispersion_statistics import NORMAL_QUANTILE_90
from lithobrake.pipeline.answer.emulated_ends import Refits, quantile_of_some, share_of_known
from lithobrake.pipeline.answer.journey_limit_states import UNKNOWN, rest_values
from lithobrake.pipeline.study_folder import AGAIN, StudyFolder
from lithobrake.results.questions import AimOnGround, AimResult, AimResults, BestAim
from lithobrake.statements.limits import FAR, options
from lithobrake.study import Study
from lithobrake.study.design_sections import AT_REST, SIDE, AimLimit
from lithobrake.study.lander_section import side_words
from lithobrake.study.limit_state_checks import option_states
from lithobrake.study.units import input_units
from lithobrake.vocabulary.constants import REFIT_COUNT
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.file_names import AIM_FILE
from lithobrake.vocabulary.limit_state import LimitState
from lithobrake.vocabulary.quantities import AIM_COLUMNS, PURE, REST_NUMBERS


@dataclass(frozen=True)
class OptionLanders:
    """Landers on one ground, [aim_count, lander_count]: how each ended, its refit, and REST_NUMBERS of those at rest.

    states: limit states of journeys that are asked of them; best: that by which options are compared, None for at rest.
    """

    status: np.ndarray
    refit: np.ndarray
    numbers: Mapping[str, np.ndarray]
    states: Mapping[str, LimitState]
    best: str | None

    @property
    def settled(self) -> np.ndarray:
        """Which have come to rest where the ground holds them."""
        rests: np.ndarray = self.status == AT_REST
        return rests

    def met(self, name: str) -> np.ndarray:
        """Which meet a limit state: 1, 0, or NaN where that is not known."""
        found = limit_state_met(self.states[name], rest_values(self.status.astype(str), self.numbers))
        return np.broadcast_to(found, self.status.shape)

    @property
    def unknown(self) -> np.ndarray:
        """Of which it is not known how they ended."""
        return np.isin(self.status.astype(str), UNKNOWN)

    @property
    def compared(self) -> np.ndarray:
        """Which do what most landers of the best option do: 1, 0, or NaN where that is not known."""
        return np.where(self.unknown, np.nan, self.settled) if self.best is None else self.met(self.best)


def aim_results(study: Study, folder: StudyFolder, fitted: Refits) -> AimResults | None:
    """The results of every aim of a study on both grounds, and the best; None where it has no aims."""
    if not study.aim.names:
        return None
    aims, units = study.aim.aims(), {SIDE: "", **input_units()}
    limits = [limit for limit in map(AimLimit.of, study.aim.within) if limit]
    soil = _landers(study, folder, "soil", len(aims))
    on_soil, best_on_soil = _on_ground(soil, aims, limits, fitted, "soil")
    on_hard: Sequence[AimOnGround | None] = [None] * len(aims)
    best_on_hard: BestAim | None = None
    if study.hard_ground.count:
        on_hard, best_on_hard = _on_ground(_landers(study, folder, "hard", len(aims)), aims, limits, fitted, "hard")
    results = AimResults(
        names=study.aim.names,
        units=tuple(units[name].removeprefix(PURE) for name in study.aim.names),
        within=tuple(study.aim.within),
        best=study.aim.best,
        lander_count=soil.status.shape[1],
        refit_count=REFIT_COUNT,
        level=analysis.LEVEL,
        why=fitted.why,
        aims=tuple(
            AimResult(tuple(aim.values()), *both)
            for aim, both in zip(aims, zip(on_soil, on_hard, strict=True), strict=True)
        ),
        best_on_soil=best_on_soil,
        best_on_hard=best_on_hard,
        statement="",
        sides=tuple(side_words(study.lander, side) for side in study.aim.sides),
    )
    return replace(results, statement=options(results))


def _landers(study: Study, folder: StudyFolder, ground: str, aim_count: int) -> OptionLanders:
    """The landers on one ground."""
    rows = [row for row in read_rows(folder / AIM_FILE, AIM_COLUMNS, AGAIN) if row["ground"] == ground]
    shape = (aim_count, len(rows) // aim_count)
    numbers = {name: np.reshape([float(row[name] or "nan") for row in rows], shape) for name in REST_NUMBERS}
    status = np.reshape(np.array([row["status"] for row in rows], dtype=object), shape)
    refit = np.reshape([int(row["refit"]) for row in rows], shape)
    return OptionLanders(status, refit, numbers, option_states(study), study.aim.best)


def _on_ground(
    landers: OptionLanders, aims: Sequence[dict[str, float]], limits: list[AimLimit], fitted: Refits, ground: str
) -> tuple[list[AimOnGround], BestAim | None]:
    """Every aim on one ground, and the best of those that keep all limits."""
    parts = [_of_aim(landers, row, ground, fitted) for row in range(len(aims))]
    parts = [replace(part, allowed=_keeps(limits, aim, part)) for aim, part in zip(aims, parts, strict=True)]
    return _best(landers, parts, fitted if ground == "soil" and fitted.why is None else None)


def _of_aim(landers: OptionLanders, row: int, ground: str, fitted: Refits) -> AimOnGround:
    """Shares and 95 % quantiles of one aim, with their intervals where there are any; not yet whether it is allowed."""
    settled, unknown, refit = landers.settled[row], landers.unknown[row], landers.refit[row]

    def share(met: np.ndarray, of: np.ndarray) -> Estimate:
        return _share(met, of, refit, ground, fitted)

    def far(values: np.ndarray) -> Estimate | None:
        """Where most of those that settle lie, or when."""
        return quantile_of_some(values, settled, FAR, share, unknown)

    return AimOnGround(
        settled=share_of_known(np.where(unknown, np.nan, settled), share),
        missing=float(unknown.mean()),
        distance_p95=far(landers.numbers["distance"][row]),
        time_p95=far(landers.numbers["time_s"][row]),
        allowed=False,
        limit_states={name: share_of_known(landers.met(name)[row], share) for name in landers.states},
    )


def _share(met: np.ndarray, of: np.ndarray, refit: np.ndarray, ground: str, fitted: Refits) -> Estimate:
    """Share of some landers that have met an event, with its bounds: over refits on soil, by their number on hard."""
    if ground == "hard":
        share = float(met.sum() / of.sum())
        return Estimate(share, *analysis.wilson_interval(int(met.sum()), int(of.sum()), NORMAL_QUANTILE_90))
    return fitted.share(met, of, refit)


def _keeps(limits: list[AimLimit], aim: dict[str, float], part: AimOnGround) -> bool:
    """Whether an aim and what comes of it keep all limits."""
    known: dict[str, float | None] = {name.partition(".")[2]: value for name, value in aim.items()}
    # Of at rest counts what is sure.
    certain = 0.0 if not part.settled.is_known else part.settled.value * (1.0 - part.missing)
    known |= {AT_REST: certain, "missing": part.missing}
    far = {"distance_p95": part.distance_p95, "time_p95": part.time_p95}
    known |= {name: None if one is None else one.value for name, one in far.items()}
    known |= {name: one.value if one.is_known else None for name, one in part.limit_states.items()}
    return all(limit.keeps(known[limit.name]) for limit in limits)


def _best(
    landers: OptionLanders, parts: list[AimOnGround], fitted: Refits | None
) -> tuple[list[AimOnGround], BestAim | None]:
    """The aims with their shares of refits, and that at which most landers do what is compared, of those allowed.

    None where none is allowed, or none does. fitted: None where refits tell nothing, as on hard ground; then
    there is no share of refits and no interval.
    """
    allowed = [part.allowed for part in parts]
    compared = landers.compared
    shares = np.where(allowed, (compared == 1.0).mean(axis=1), -1.0)
    if shares.max() <= 0.0:
        return parts, None
    if fitted is None:
        return parts, BestAim(int(shares.argmax()), None, None, None, None, None)
    order = np.argsort(landers.refit[0], kind="stable")
    compared = compared[:, order].reshape(len(parts), REFIT_COUNT, -1)
    found = analysis.best_choice(compared, fitted.bed_count, allowed, run_count=fitted.run_count)
    parts = [replace(part, share_of_refits=one) for part, one in zip(parts, found.shares.tolist(), strict=True)]
    others = tuple(aim for aim in found.not_worse if aim != found.best)
    share = float(found.shares[found.best])
    return parts, BestAim(found.best, share, found.own, others, found.runner_up, found.difference)
