"""The view of the body in three dimensions: where landers rest, or where they impact after the first touchdown."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.colors import LogNorm, to_hex, to_rgb

from lithobrake.report.content import LiveSection
from lithobrake.report.figures.body_figures import BARE, COLOURS, colour_ends, facet_density
from lithobrake.report.figures.style import INK, LANDER, QUIET
from lithobrake.report.live.landing_view import geometry, orbit, section, still
from lithobrake.results.page_data import PageData, PageJourneys, PageSamples
from lithobrake.statements.labels import end_words
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.known_bodies import BUILT_IN_BODIES
from lithobrake.vocabulary.number_words import number
from lithobrake.vocabulary.outcomes import OUTCOME_COLOURS, FlightStatus

# Over the radius of the body: a pin, the marker of a lander, the ends of the axis and of the line to the partner.
PIN, MARKER, AXIS, FAR = 0.04, 0.03, 1.3, 1.55
MARK = np.array([(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)], dtype=float)
MARK_FACES = np.array([
    (0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5),
])  # fmt: skip


def body_views(data: PageData) -> list[LiveSection]:
    """The body with the places where landers rest, or where they impact after the first touchdown, and their paths."""
    samples, journeys = data.samples, data.journeys
    if samples is not None and not data.to_rest:
        return _impact_view(data, samples)
    return [] if journeys is None else _end_view(data, journeys)


def _impact_view(data: PageData, samples: PageSamples) -> list[LiveSection]:
    """The facets coloured by the impacts as in the figure of the body, if there is any."""
    if not len(samples.facet):
        return []
    density = facet_density(data.body_vertices[data.body_faces], samples.facet)
    low, high = colour_ends(density)
    scale = COLOURS(LogNorm(low, high)(density))[:, :3]
    arrays, facts = _body(data, np.where(density[:, None] > 0.0, scale, BARE))
    facts["bar"] = {"low": number(low, 2), "high": number(high, 2), "unit": "impacts per hectare"}
    facts["bar"]["scale"] = ", ".join(to_hex(COLOURS(part)) for part in (0.0, 0.5, 1.0))
    words = "Facets: impacts per hectare as in the figure of the body."
    if len(data.paths[0]):
        arrays |= _lines(*data.paths)
        words += f" Lines: the paths of the first {len(data.paths[1])} flights, relative to the rotating body."
    title = "Where the lander comes down, in three dimensions"
    return [section("body-3d", title, _with_marker(words, facts), arrays, facts, _legend(data, data.paths[1]))]


def _end_view(data: PageData, journeys: PageJourneys) -> list[LiveSection]:
    """A pin at the place of each lander on the ground, and the flights of the first journeys."""
    table, (ways, ended) = journeys.table, data.paths
    place = np.column_stack([table[f"position_{axis}"] for axis in "xyz"])
    on_ground = np.isfinite(place).all(axis=1) & ~journeys.is_on_partner
    if not (on_ground.any() or len(ways)):
        return []
    arrays, facts = _body(data, np.broadcast_to(np.array(BARE), (len(data.body_faces), 3)))
    foot, end = place[on_ground], table["end"][on_ground]
    head = foot + PIN * _radius(data) * foot / np.linalg.norm(foot, axis=1)[:, None]
    words, pins = (
        f"Pins: where {on_ground.sum()} landers ended on the ground.",
        _lines(np.stack([foot, head], axis=1), end),
    )
    arrays |= pins
    if len(ways):
        lines = _lines(ways, ended)
        arrays |= {name: np.concatenate([pins[name], lines[name]]) for name in pins}
        words += " Lines: the paths of the first journeys, relative to the rotating body."
    title, legend = "Where the landers rest, in three dimensions", _legend(data, [*end.tolist(), *ended])
    return [section("body-3d", title, _with_marker(words, facts), arrays, facts, legend)]


def _legend(data: PageData, ended: Iterable[str]) -> dict[str, str]:
    """The colour of each way for a flight or journey to end, by its words."""
    return {_said(data, one): OUTCOME_COLOURS[one] for one in dict.fromkeys(ended)}


def _said(data: PageData, end: str) -> str:
    """How a flight or journey ended, in words."""
    return {FlightStatus.FLYING.value: "still flying", **end_words(data.results.site)}.get(end, end.replace("_", " "))


def _with_marker(words: str, facts: Mapping[str, Any]) -> str:
    """The words of a view, and what moves in it."""
    return f"{words} The marker on the path of a lander is not to scale." if facts["ways"] else words


def _radius(data: PageData) -> float:
    return float(np.linalg.norm(data.body_vertices, axis=1).max())


def _body(data: PageData, colours: Array) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
    """Arrays and numbers of the body and a marker, looked at from above the site; colours: of facets [facet, 3]."""
    radius, site = _radius(data), np.array(data.results.site.place_m)
    longitude, latitude = np.arctan2(site[1], site[0]), np.arctan2(site[2], np.hypot(site[0], site[1]))
    ways, of_ways = _ways(data)
    hulls = [(data.body_vertices, data.body_faces), *([(MARKER * radius * MARK, MARK_FACES)] if ways else [])]
    paint = np.rint(255.0 * colours)
    if ways:
        paint = np.concatenate([paint, np.tile(255.0 * np.array(to_rgb(LANDER)), (len(MARK_FACES), 1))])
    arrays = {**geometry(hulls), "paint": paint.astype(np.uint8), **of_ways}
    around, labels = _around(data, radius)
    facts = {"bodyCount": len(hulls), "frameCount": 1, "shades": [], "ways": ways, "labels": labels}
    if ways:
        facts["perFlight"] = data.paths[0].shape[1]
    # What lies around the body reaches farther out.
    seen = orbit(np.zeros(3), 1.25 * radius, float(longitude) - 0.4, float(latitude) + 0.3)
    return arrays | around, {**facts, "orbit": seen}


def _around(data: PageData, radius: float) -> tuple[dict[str, np.ndarray], list[dict[str, Any]]]:
    """The axis of the spin and the direction of the partner as lines, and the words at their ends and at the site."""
    place = np.array(data.results.site.place_m)
    top = max(float(np.abs(data.body_vertices[:, 2]).max()), 0.5 * radius)
    lines, labels = [(0.0, 0.0, -AXIS * top), (0.0, 0.0, AXIS * top)], [_label("north", [0.0, 0.0, 1.08 * AXIS * top])]
    labels.append({**_label("aim point", (1.03 * place).tolist()), "canHide": True})
    longitude = _partner_longitude(data)
    if longitude is not None:
        ray = np.array([np.cos(np.radians(longitude)), np.sin(np.radians(longitude)), 0.0])
        lines += [tuple(radius * ray), tuple(FAR * radius * ray)]
        site = data.results.site
        known = BUILT_IN_BODIES.get(str(site.partner))
        name = known.name if known else str(site.partner)
        words = f"{name}, {number((site.partner_distance_m or 0.0) / 1e3)} km"
        labels.append(_label(f"to {words}", (1.03 * FAR * radius * ray).tolist()))
    return still("grid", lines, 0.0, QUIET) | _ring(place), labels


def _ring(place: Array) -> dict[str, np.ndarray]:
    """A ring around the aim point, a little above the ground."""
    up = place / np.linalg.norm(place)
    east = np.cross(np.eye(3)[np.argmin(np.abs(up))], up)
    east /= np.linalg.norm(east)
    turn = np.linspace(0.0, 2.0 * np.pi, 41)[:, None]
    size = 0.05 * float(np.linalg.norm(place))
    ring = 1.02 * place + size * (np.cos(turn) * east + np.sin(turn) * np.cross(up, east))
    return still("mark", [tuple(one) for one in np.stack([ring[:-1], ring[1:]], axis=1).reshape(-1, 3)], 0.0, INK)


def _label(words: str, place: Sequence[float]) -> dict[str, Any]:
    return {"words": words, "place": list(place)}


def _partner_longitude(data: PageData) -> float | None:
    """The east longitude over which the partner stands when the lander arrives [deg]; None where it is not known."""
    site, given = data.results.site, data.study["site"].get("partner_longitude_deg")
    if site.partner is None:
        return None
    if site.kernels is not None and site.kernels.partner_longitude_deg is not None:
        return site.kernels.partner_longitude_deg
    if isinstance(given, int | float):
        return float(given)
    # A body that turns once an orbit, as Dimorphos does, has its partner over its longitude 0.
    known, partner = BUILT_IN_BODIES.get(data.study["site"]["body"]), data.study["site"].get("partner_body")
    is_synchronous = known is not None and known.is_synchronous
    if partner is not None:
        is_synchronous = partner["period"] in (None, site.spin_period_s) and partner["distance"] is None
    return 0.0 if is_synchronous and given is None else None


def _ways(data: PageData) -> tuple[list[dict[str, Any]], dict[str, np.ndarray]]:
    """The ways that a marker moves along, one for each lander, and the places of all of them."""
    place, status = data.paths
    if not len(place):
        return [], {}
    times, sample = data.path_times
    starts = np.flatnonzero(np.append(True, np.diff(sample) != 0))
    counts = np.diff(np.append(starts, len(sample)))
    ways = [
        {"words": f"lander {sample[start]}: {_said(data, str(status[start]))}", "first": int(start) * place.shape[1],
         "flights": int(count)}
        for start, count in zip(starts, counts, strict=True)
    ]  # fmt: skip
    return ways, {
        "way_place": place.reshape(-1, 3).astype(np.float32), "way_time": times.ravel().astype(np.float32)
    }  # fmt: skip


def _lines(position: Array, status: Sequence[str]) -> dict[str, np.ndarray]:
    """Ends of the pieces of all ways [2 piece_count, 3], and the colour of each."""
    ends = np.stack([position[:, :-1], position[:, 1:]], axis=2).reshape(-1, 3)
    paint = np.array([to_rgb(OUTCOME_COLOURS[word]) for word in status]).reshape(-1, 3)
    # Two ends of each piece.
    of_ends = np.repeat(np.rint(255.0 * paint), 2 * (position.shape[1] - 1), axis=0)
    return {"path_corner": ends.astype(np.float32), "path_paint": of_ends.astype(np.uint8)}
