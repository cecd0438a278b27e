"""Landers at their first touchdowns, as a study delivers them: more of its journeys, or the same at other options."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.design.rough_ground import first_axes
from lithobrake.pipeline.emulate.fitted_emulator import REFIT_COUNT
from lithobrake.pipeline.site import Site
from lithobrake.vocabulary.quantities import SPIN

Row = dict[str, float]


@dataclass(frozen=True)
class Arrivals:
    """Landers at their first touchdowns.

    number: of the journey of each; rows: inputs of its first touchdown; site: columns of SITE_KEYS [count]; origin [m],
    [count, 3], and axes, in rows, [count, 3, 3], of the frames of the touchdowns, body-fixed; clock [s]: as of the
    partner; refit: of the emulator, which a lander keeps.
    """

    number: np.ndarray
    rows: list[Row]
    site: Mapping[str, np.ndarray]
    origin: np.ndarray
    axes: np.ndarray
    clock: np.ndarray
    refit: np.ndarray

    @classmethod
    def of(
        cls, place: Site, number: np.ndarray, rows: list[Row], site: Mapping[str, np.ndarray], refit: np.ndarray
    ) -> "Arrivals":
        """Those of these rows at these places, by columns of SITE_KEYS [count]."""
        origin, mean_axes = place.frames(site)
        axes = first_axes(place.study, mean_axes, rows)
        return cls(number, rows, site, origin, axes, np.broadcast_to(place.clock(site), number.shape), refit)

    @classmethod
    def drawn(cls, design: DrawnDesign, place: Site, first: int, count: int) -> "Arrivals":
        """Journeys of a study from the number `first` on, each with one refit after the other."""
        number = np.arange(first, first + count)
        rows = design.with_run_count(first + count).rows[first:]
        site = {key: values[first:] for key, values in place.sampled(first + count).items()}
        return cls.of(place, number, rows, site, number % REFIT_COUNT)

    def taken(self, which: np.ndarray, refit: np.ndarray) -> "Arrivals":
        """Some of the landers, or some of them several times, with these refits."""
        site = {key: values[which] for key, values in self.site.items()}
        rows = [self.rows[one] for one in which.tolist()]
        states = (self.origin[which], self.axes[which], self.clock[which])
        return Arrivals(self.number[which], rows, site, *states, refit)

    def column(self, name: str) -> np.ndarray:
        """One input of the first touchdowns [count], in the file's unit."""
        return np.array([row[name] for row in self.rows])

    @property
    def spin(self) -> np.ndarray:
        """Angular velocity against the ground [rad/s], [count, 3], in the frames of the touchdowns."""
        from lithobrake.geometry.contact_frame import about_z

        of_bed = np.column_stack([self.column(name) for name in SPIN])
        turns = [about_z(-angle) for angle in np.radians(self.column("impact.azimuth_deg")).tolist()]
        return np.array([turn.apply(one) for turn, one in zip(turns, of_bed, strict=True)]).reshape(-1, 3)
