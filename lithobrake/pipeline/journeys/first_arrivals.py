"""Landers at their first touchdowns: those of the study, further ones, and those that are flown to the ground."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from lithobrake.geometry.attitude import about_z
from lithobrake.pipeline.design.arrivals import first_axes
from lithobrake.pipeline.design.descents import Descents
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.site import Site
from lithobrake.vocabulary.constants import REFIT_COUNT
from lithobrake.vocabulary.quantities import IMPACT_AZIMUTH, SPIN, Row


@dataclass(frozen=True)
class Arrivals:
    """Landers at their first touchdowns.

    number: of the journey of each; rows: inputs of its first touchdown; site: columns of SITE_KEYS [count]; origin [m],
    [count, 3], and axes, in rows, [count, 3, 3], of the frames of the touchdowns, body-fixed; clock [s]: as of the
    partner; refit: of the emulator, which a lander keeps; ground: that each is on, as of `Landers`, [count].
    """

    number: np.ndarray
    rows: list[Row]
    site: Mapping[str, np.ndarray]
    origin: np.ndarray
    axes: np.ndarray
    clock: np.ndarray
    refit: np.ndarray
    ground: np.ndarray

    @classmethod
    def of(
        cls, place: Site, number: np.ndarray, rows: list[Row], site: Mapping[str, np.ndarray], refit: np.ndarray
    ) -> "Arrivals":
        """Those of these rows at these places, by columns of SITE_KEYS [count]."""
        origin, mean_axes = place.frames(site)
        axes = first_axes(place.study, mean_axes, rows)
        clock, ground = np.broadcast_to(place.clock(site), number.shape), np.zeros(len(number), dtype=np.int64)
        return cls(number, rows, site, origin, axes, clock, refit, ground)

    @classmethod
    def of_rows(cls, site: Site, rows: list[Row], first: int) -> "Arrivals":
        """Journeys with these first touchdowns, numbered from `first` on, each with one refit after the other."""
        number = np.arange(first, first + len(rows))
        columns = {key: values[first:] for key, values in site.sampled(first + len(rows)).items()}
        return cls.of(site, number, rows, columns, number % REFIT_COUNT)

    @classmethod
    def drawn(cls, design: DrawnDesign, first: int, count: int) -> "Arrivals":
        """Journeys from the number `first` on, also behind those of the study, on the beds of the study."""
        return cls.of_rows(design.site, design.on_known_beds(first + count).rows[first:], first)

    @classmethod
    def of_descents(cls, descents: Descents, rows: list[Row], beds: list[int], first: int = 0) -> "Arrivals":
        """Journeys from the number `first` on, at the ends of their flights to the ground; rows: that touch down.

        Of the others the rows hold the bed alone, and places are where the flights ended.
        """
        touching, start = iter(rows), descents.flights.start
        all_rows = [
            next(touching) if down else {"bed": float(bed)}
            for down, bed in zip(descents.touches_down.tolist(), beds, strict=True)
        ]
        number = np.arange(first, first + len(beds))
        # The spin period and mass are those that the flights had; the aim is that of the study.
        site = {key: values[first:] for key, values in descents.site.sampled(first + len(beds)).items()}
        site |= {"mass": start.mass, "spin_period": start.spin_period}
        states = (descents.position, descents.axes, descents.clock)
        return cls(number, all_rows, site, *states, number % REFIT_COUNT, descents.ground)

    def taken(self, which: np.ndarray, refit: np.ndarray) -> "Arrivals":
        """Some of the landers, or some of them several times, with these refits."""
        site = {key: values[which] for key, values in self.site.items()}
        rows = [self.rows[one] for one in which.tolist()]
        states = (self.origin[which], self.axes[which], self.clock[which])
        return Arrivals(self.number[which], rows, site, *states, refit, self.ground[which])

    @classmethod
    def joined(cls, parts: Sequence["Arrivals"]) -> "Arrivals":
        """Landers of several sets, one set after the other."""
        site = {key: np.concatenate([one.site[key] for one in parts]) for key in parts[0].site}
        rows = [row for one in parts for row in one.rows]
        number, origin, axes, clock, refit, ground = (
            np.concatenate([getattr(one, name) for one in parts])
            for name in ("number", "origin", "axes", "clock", "refit", "ground")
        )
        return cls(number, rows, site, origin, axes, clock, refit, ground)

    def column(self, name: str) -> np.ndarray:
        """One input of the first touchdowns [count], in the file's unit; 0 of a lander that never touches down."""
        return np.array([row.get(name, 0.0) for row in self.rows])

    @property
    def spin(self) -> np.ndarray:
        """Angular velocity against the ground [rad/s], [count, 3], in the frames of the touchdowns."""
        of_bed = np.column_stack([self.column(name) for name in SPIN])
        turns = [about_z(-angle) for angle in np.radians(self.column(IMPACT_AZIMUTH)).tolist()]
        return np.array([turn.apply(one) for turn, one in zip(turns, of_bed, strict=True)]).reshape(-1, 3)
