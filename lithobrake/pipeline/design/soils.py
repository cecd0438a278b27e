"""The soils of a study by region of the body."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.files.reading import hashed_seed
from lithobrake.pipeline.site import Site
from lithobrake.study import StudyError
from lithobrake.study.ground_sections import facet_numbers
from lithobrake.study.quantity import Scalar, uncertain
from lithobrake.vocabulary.quantities import ELSEWHERE, Row

if TYPE_CHECKING:
    from lithobrake.chaos import Distribution
    from lithobrake.smallbody import Shape

# Parts of a facet along each edge, and how many parts there are at most, by which the areas of regions are summed.
EDGE_PARTS, MOST_PARTS = 8, 200_000


@dataclass(frozen=True, eq=False)
class Soils:
    """The regions of a study with a soil of their own; none where its file has no [soil].

    A region is fixed to the body: its slopes are those at the medians of [site], at the start of site.rotation.
    """

    site: Site

    @property
    def names(self) -> tuple[str, ...]:
        """The regions in the order of the file, then ELSEWHERE, the ground of [grain]."""
        return (*self.site.study.soil, ELSEWHERE)

    def at(self, points: np.ndarray) -> list[str]:
        """The region of each place on the ground [m], [count, 3], body-fixed."""
        return [self.names[number] for number in self._numbers(points, self._shape.nearest(points)[1]).tolist()]

    def on_soil(self, rows: Sequence[Row], points: np.ndarray) -> list[Row]:
        """Touchdowns of journeys at places [m], [count, 3], on the soil of their regions; elsewhere as they are."""
        if not self.site.study.soil or not len(rows):
            return list(rows)
        own = {key: np.array([row[key] for row in rows]) for key in {_grain_key(one): None for one in self.values}}
        met = self.met(np.array([int(row["journey"]) for row in rows]), own, points)
        return [row | {key: float(values[number]) for key, values in met.items()} for number, row in enumerate(rows)]

    def met(self, journeys: np.ndarray, own: Mapping[str, np.ndarray], points: np.ndarray) -> dict[str, np.ndarray]:
        """The numbers of the grains that landers meet at places [m], [count, 3], by dotted key, [count] each.

        own: those of [grain] that the landers of these journeys [count] have drawn, for the ground elsewhere.
        """
        found, names = {key: values.copy() for key, values in own.items()}, np.array(self.at(points))
        for key, values in self.drawn(journeys.tolist()).items():
            there = names == _region(key)
            found[_grain_key(key)][there] = values[there]
        return found

    @cached_property
    def values(self) -> dict[str, Scalar]:
        """The numbers of all regions, fixed or uncertain, by the dotted keys of the file."""
        return {
            f"soil.{name}.grain.{key}": value
            for name, soil in self.site.study.soil.items()
            for key, value in soil.grain.values().items()
        }

    @cached_property
    def inputs(self) -> "dict[str, Distribution]":
        """The distributions of the uncertain ones."""
        return {key: value.to_chaos() for key, value in uncertain(self.values).items()}

    def drawn(self, journeys: Sequence[int]) -> dict[str, np.ndarray]:
        """The numbers of the regions for some journeys, by dotted key, [count] each, wherever these come down."""
        from lithobrake.chaos.design import sample_inputs

        count = max(journeys, default=-1) + 1
        # The random numbers of an input follow from its name, so another region or key changes none.
        table = sample_inputs(self.inputs, count, hashed_seed(self.site.study.seed, "soil"))
        columns = dict(zip(self.inputs, table[list(journeys)].T, strict=True))
        return {
            key: columns[key] if key in columns else np.full(len(journeys), value) for key, value in self.values.items()
        }

    def area_shares(self) -> dict[str, float]:
        """The share of the surface of the body that each region has, and ELSEWHERE; they add up to 1."""
        corners = self._shape.corners
        parts = _triangle_parts(min(EDGE_PARTS, max(1, int((MOST_PARTS / len(corners)) ** 0.5))))
        points = np.einsum("pc,fcx->fpx", parts, corners)
        facet = np.repeat(np.arange(len(corners)), len(parts))
        numbers = self._numbers(points.reshape(-1, 3), facet)
        area = np.repeat(0.5 * self._shape.facet_sizes**2 / len(parts), len(parts))
        found = np.bincount(numbers, area, len(self.names)) / area.sum()
        return dict(zip(self.names, found.tolist(), strict=True))

    def outlines(self, region: str) -> tuple[tuple[tuple[float, float], ...], ...]:
        """Latitude and east longitude [deg] along the edges of a region, to a degree; none of ELSEWHERE."""
        from contourpy import contour_generator

        if region == ELSEWHERE:
            return ()
        latitude, longitude, numbers = self._map
        inside = (numbers == self.names.index(region)).astype(float)
        lines = contour_generator(longitude, latitude, inside).lines(0.5)
        return tuple(tuple((north, east) for east, north in np.asarray(line).tolist()) for line in lines)

    @cached_property
    def _map(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Latitudes and longitudes [deg] of a grid, and the place among `names` of each of its points."""
        # Longitudes overlap by a column on either side, so that outlines reach the edges of a map.
        latitude, longitude = np.arange(-89.5, 90.0), np.arange(-180.5, 181.0)
        points, facets = self._shape.locate(latitude[:, None], longitude)
        numbers = self._numbers(points.reshape(-1, 3), facets.ravel())
        return latitude, longitude, numbers.reshape(facets.shape)

    def slope_deg(self, place: np.ndarray) -> float:
        """Slope of the facet of a place on the ground [m], [3], at its centre [deg]."""
        facets = self._shape.nearest(place[None])[1]
        facet = int(facets[0])
        # Thousands of touchdowns share few facets, and the gravity is worked out once for each of them.
        if facet not in self._known_slopes:
            self._known_slopes[facet] = float(self._slopes_deg(facets)[0])
        return self._known_slopes[facet]

    @cached_property
    def _known_slopes(self) -> dict[int, float]:
        return {}

    def refuse(self) -> None:
        """Raise StudyError for regions in which this body has no ground."""
        if not self.site.study.soil:
            # The body, which a study of one soil may not need, is not made for this.
            return
        wrong, facet_count = [], len(self._shape.faces)
        for region, soil in self.site.study.soil.items():
            last = max(self._facets[region]) if soil.facets is not None else -1
            if last >= facet_count:
                wrong.append(
                    f"soil.{region}.facets has {last}; allowed: 0 to {facet_count - 1}, the facets of the "
                    "body's shape; take the numbers of its faces in their order, from 0"
                )
        shares = {} if wrong else self.area_shares()
        wrong += [
            f"soil.{region} holds no ground of this body within its bounds and outside of the regions before "
            "it; widen its bounds, move it up, or leave it out"
            for region, share in shares.items()
            if share == 0.0 and region != ELSEWHERE
        ]
        if wrong:
            raise StudyError([self.site.study.said(text) for text in wrong])

    def _numbers(self, points: np.ndarray, facets: np.ndarray) -> np.ndarray:
        """The place among `names` of the region of each point [m], [count, 3], on its facet, [count]."""
        latitude, longitude = self._shape.latitude_longitude(points)
        found = np.full(len(points), len(self.site.study.soil))
        # From the last to the first, since where regions overlap the first of the file applies.
        for number, (name, soil) in reversed(list(enumerate(self.site.study.soil.items()))):
            inside = np.full(len(points), True)
            if soil.latitude_deg is not None:
                inside &= _between(latitude, soil.latitude_deg)
            if soil.longitude_deg is not None:
                west, east = soil.longitude_deg
                inside &= (longitude - west) % 360.0 <= (east - west) % 360.0
            if soil.facets is not None:
                inside &= np.isin(facets, self._facets[name])
            # Last, and only of what the other bounds leave: a slope takes the gravity of the body.
            if soil.slope_deg is not None and inside.any():
                inside[inside] = _between(self._slopes_deg(facets[inside]), soil.slope_deg)
            found[inside] = number
        return found

    @cached_property
    def _facets(self) -> dict[str, tuple[int, ...]]:
        named = {name: soil.facets for name, soil in self.site.study.soil.items() if soil.facets is not None}
        return {name: facet_numbers(Path(path)) for name, path in named.items()}

    def _slopes_deg(self, facets: np.ndarray) -> np.ndarray:
        """Slope of each of these facets at its centre [deg], [count]."""
        # Many places share a facet, and the gravity is worked out once for each.
        own, place = np.unique(facets, return_inverse=True)
        columns, centres = self.site.columns(len(own)), self._shape.corners[own].mean(axis=1)
        pull = self.site.body.felt(centres, self.site.clock(columns), columns["mass"], columns["spin_period"])
        upward = -np.einsum("nx,nx->n", pull, self._shape.normals[own]) / np.linalg.norm(pull, axis=1)
        slopes: np.ndarray = np.degrees(np.arccos(np.clip(upward, -1.0, 1.0)))[place]
        return slopes

    @property
    def _shape(self) -> "Shape":
        return self.site.body.shape


def _between(values: np.ndarray, ends: tuple[float, float]) -> np.ndarray:
    """Which values lie between two ends, these among them, [count]."""
    inside: np.ndarray = (values >= ends[0]) & (values <= ends[1])
    return inside


def _triangle_parts(count: int) -> np.ndarray:
    """Centres of count**2 equal parts of a triangle in shares of its corners, [part, 3]."""
    i, j = (one.ravel() for one in np.mgrid[:count, :count])
    upright = np.column_stack([i, j])[i + j < count] + 1.0 / 3.0
    turned = np.column_stack([i, j])[i + j < count - 1] + 2.0 / 3.0
    shares = np.concatenate([upright, turned]) / count
    return np.column_stack([shares, 1.0 - shares.sum(axis=1)])


def _region(key: str) -> str:
    return key.split(".")[1]


def _grain_key(key: str) -> str:
    """The key in [grain] of what a number of a region stands for."""
    return key.split(".", 2)[2]
