"""The answer on each kind of ground, one below the other, as the first screen of a page has it."""

import math
from collections.abc import Sequence

from lithobrake.report.content import Strip, StripColumn
from lithobrake.results.page_data import PageData
from lithobrake.statements.grounds import finest_words, kind_words, strip_note
from lithobrake.statements.journeys import time_unit
from lithobrake.statements.labels import quantile
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.number_words import with_interval


def ground_strip(data: PageData) -> Strip | None:
    """What the landers do on each kind of ground, on the finest, and on one of them.

    None for a study of one ground, and of first touchdowns, whose page begins with another answer. The fraction at rest
    over all grounds has no words here: the page begins with it.
    """
    results, journeys = data.results, data.journeys
    if not results.grounds or journeys is None or not data.to_rest:
        return None
    names = [(name, kind_words(one.weight, one.grain_size_m)) for name, one in results.grounds.items()]
    rows = [(one.at_rest.share, one.time_s, one.distance_m) for one in results.grounds.values()]
    finer, over = results.finer_ground, results.over_grounds
    if finer is not None and finer.at_rest and finer.time_s and finer.distance_m:
        names.append(("finest", finest_words(finer)))
        rows.append((finer.at_rest.share, finer.time_s, finer.distance_m))
    if over is not None:
        names.append(("one of these", "unknown which"))
        rows.append((over.at_rest, over.time_s, over.distance_m))
    has_finest = len(rows) > len(results.grounds) + (over is not None)
    size, unit = time_unit(journeys.rest)
    rests, times, distances = (list(one) for one in zip(*rows, strict=True))
    shares = [with_interval(one).replace(" %", "") for one in rests]
    if over is not None:
        shares[-1] = ""
    columns = [
        StripColumn("at rest [%]", _scaled(rests, 0.01), shares, 100.0),
        _quantiles(f"median time [{unit}]", times, size),
        _quantiles("median distance [m]", distances, 1.0),
    ]
    return Strip("By kind of ground", names, columns, strip_note(has_finest=has_finest, has_one=over is not None))


def _quantiles(words: str, found: Sequence[Estimate], unit: float) -> StripColumn:
    """Medians in units of a size, on a scale that holds all of their intervals."""
    scaled = _scaled(found, unit)
    ends = [end for one in scaled for end in (one.value, one.upper) if end is not None and math.isfinite(end)]
    return StripColumn(words, scaled, [quantile(one) for one in scaled], scale_end(max(ends, default=0.0)))


def _scaled(found: Sequence[Estimate], unit: float) -> list[Estimate]:
    return [one.on_scale(lambda value: value / unit) for one in found]


def scale_end(most: float) -> float:
    """The end of a scale from 0 that holds a number: one digit and zeros; 1 for nothing."""
    if most <= 0.0:
        return 1.0
    step = 10.0 ** math.floor(math.log10(most))
    return math.ceil(most / step) * step
