"""The design: every run has soil, place, azimuth, attitude and bed of its own, and no other run moves them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.chaos import Uniform
from lithobrake.files.reading import hashed_seed
from lithobrake.geometry.attitude import uniform_attitude
from lithobrake.pipeline.design.arrivals import Interval, on_local_ground, place_region
from lithobrake.pipeline.design.bed_grounds import BedGrounds
from lithobrake.pipeline.design.bed_order import beds_of_runs
from lithobrake.pipeline.design.dependencies import touchdown_keys
from lithobrake.pipeline.design.descents import RELEASE, Descents
from lithobrake.pipeline.design.random_inputs import given_attitude
from lithobrake.pipeline.design.side_designs import soil_pairs, twins
from lithobrake.pipeline.site import Site
from lithobrake.study import Study, StudyError
from lithobrake.study.delivery_checks import correlated_keys, drawn_together
from lithobrake.study.delivery_sections import PLACE_KEYS
from lithobrake.study.quantity import uncertain, usual_reach
from lithobrake.vocabulary.quantities import (
    ARRIVAL,
    IMPACT_AZIMUTH,
    IMPACT_INCIDENCE,
    ORIENTATION,
    PLACE,
    SPIN,
    TIME_LEFT,
    Row,
)

if TYPE_CHECKING:
    from lithobrake.chaos import Distribution

GRAIN = "grain."
# Coordinates of the sequence beside the uncertain inputs. All are there in every study, used or not, so that a place or
# an azimuth that is given leaves the others as they were.
DRAWN = ("place x", "place y", "azimuth", "attitude 1", "attitude 2", "attitude 3")


def arriving_together(site: Site, rows: list[Row], first: int) -> list[Row]:
    """Rows of journeys from number `first` on with what [delivery] correlates; where it lands the site draws."""
    study = site.study
    keys = {key: f"impact.{key}" for key in correlated_keys(study) if key not in PLACE_KEYS}
    if not keys:
        return rows
    place = {key: values[first:] for key, values in site.sampled_apart(first + len(rows)).items()}
    arrival = {key: np.array([row[dotted] for row in rows]) for key, dotted in keys.items()}
    found = drawn_together(study, place | arrival)
    return [
        row | {dotted: float(found[key][number]) for key, dotted in keys.items()} for number, row in enumerate(rows)
    ]


# Compared by identity: a study has dicts, which cannot be hashed, and cached properties belong to one object.
@dataclass(frozen=True, eq=False)
class DrawnDesign:
    """The runs that a study draws, made once for it; each property is worked out when it is first asked for.

    A study that draws no lander takes site, inputs, medians and region alone from it.
    known_site: of the same study with another number of runs. known_beds: that there are; None where each run has the
    bed that it has in a study of so many runs.
    """

    study: Study
    known_site: Site | None = None
    known_beds: int | None = None

    @cached_property
    def site(self) -> Site:
        """Where the study lands."""
        return self.known_site or Site(self.study)

    @cached_property
    def inputs(self) -> "dict[str, Distribution]":
        """The uncertain inputs of the touchdown with their distributions, in the order of the file's sections."""
        return {name: value.to_chaos() for name, value in uncertain(self.study.touchdown_values()).items()}

    @cached_property
    def medians(self) -> Row:
        """Every scalar that the touchdown reads, uncertain ones at their median, by dotted key, in the file's units.

        Of landers that are flown to the ground, also the medians of what their flights tell.
        """
        told = [key for key in ARRIVAL if self.is_flown]
        return self.study.touchdown_medians() | {key: float(np.median([row[key] for row in self.rows])) for key in told}

    @property
    def is_flown(self) -> bool:
        return self.study.delivery is not None and self.study.delivery.is_flown

    @cached_property
    def descents(self) -> Descents | None:
        """The flights to the first touchdowns of all journeys; None where the study says how landers arrive.

        Raises StudyError where none reaches the ground, and as Descents.flown does.
        """
        if not self.is_flown:
            return None
        found = self._descents(0, self._points(len(self.beds)))
        # A study without a touchdown has no run, and every later stage would fail for another reason.
        if not found.touches_down.any():
            raise StudyError(
                [
                    self.study.said(
                        f"[delivery]: none of {len(self.beds)} landers reaches the ground within journey.duration; "
                        "allowed: states of which at least one does; correct them, or raise the duration"
                    )
                ]
            )
        return found

    @cached_property
    def region(self) -> tuple[Interval, Interval] | None:
        return place_region(self.study)

    @cached_property
    def one_place(self) -> bool:
        if self.inputs.keys() & set(PLACE):
            return False
        return not any(low < high for low, high in self.region or ())

    @cached_property
    def beds(self) -> list[int]:
        beds = beds_of_runs(self.study, self.study.design.run_count)
        return beds if self.known_beds is None else [bed % self.known_beds for bed in beds]

    @cached_property
    def rows(self) -> list[Row]:
        """All inputs of the first touchdowns, by dotted key in the file's units, with what each drew.

        Of landers that are flown to the ground, of those that reach it.
        """
        points = self._points(len(self.beds))
        return self._first_touchdowns(self.rows_at(self.beds, points), 0, self.descents)

    @cached_property
    def delivered_rows(self) -> list[Row]:
        """The same as the study draws them: an impact against the facets of the body's shape, under no acceleration of
        the place, on [grain] in whatever region.
        """
        return self._delivered(self.rows_at(self.beds, self._points(len(self.beds))), 0)

    @cached_property
    def keys(self) -> list[str]:
        """The keys of the runs in the ledger, in their order."""
        return touchdown_keys(self.study, self.rows, 0)

    def row(self, run: int) -> Row:
        """All inputs of one run, counted from 0, of which there may be more than the study has.

        Raises ValueError for a lander that is flown to the ground and does not reach it.
        """
        row = self._row(run)
        if row is None:
            raise ValueError(f"lander {run + 1} of the study never touches down; choose another")
        return row

    def own_soils(self, runs: np.ndarray) -> dict[str, np.ndarray]:
        """The numbers of [grain] that runs draw, by dotted key, [run_count], in whatever region they come down."""
        first, last = int(runs.min()), int(runs.max())
        count = last + 1 - first
        rows = self._rows_of_points([0] * count, self._points(count, skip=first))
        names = [name for name in rows[0] if name.startswith(GRAIN)]
        return {name: np.array([row[name] for row in rows])[runs - first] for name in names}

    @property
    def shown_row(self) -> Row:
        """All inputs of the first run; of landers that are flown to the ground, of the first that reaches it.

        Raises StudyError where none does.
        """
        rows = (self._row(run) for run in range(len(self.beds)))
        return next((row for row in rows if row is not None), None) or self.rows[0]

    def _row(self, run: int) -> Row | None:
        """The same as `row`; None for a lander that never touches down."""
        # A point of the sequence follows from its number, so the runs before need not be made.
        points = self._points(1, skip=run)
        rows = self.rows_at(beds_of_runs(self.study, run + 1)[-1:], points)
        descents = self._descents(run, points) if self.is_flown else None
        return next(iter(self._first_touchdowns(rows, run, descents)), None)

    def flown_landers(self, first: int, count: int) -> tuple[Descents, list[Row], list[int]]:
        """Landers from the number `first` on that are flown to the ground, on the beds that the study has.

        Their flights, the rows of those that reach the ground, and the beds of all.
        """
        beds = [bed % self.study.bed_count for bed in beds_of_runs(self.study, first + count)[first:]]
        points = self._points(count, skip=first)
        descents = self._descents(first, points)
        return descents, self._first_touchdowns(self.rows_at(beds, points), first, descents), beds

    def rows_of(self, design: str) -> list[Row]:
        """All inputs of the runs of a design: of "drawn", or of a side design, whose row k goes with run k."""
        if design == "drawn":
            return self.rows
        return (
            twins(self.study, self.rows) if design == "twins" else soil_pairs(self.study, self.soil_inputs, self.rows)
        )

    @property
    def coordinates(self) -> "dict[str, Distribution]":
        """What a run takes from its point, but for its bed: the uncertain inputs, then what it draws."""
        release = RELEASE if self.is_flown else ()
        return self.inputs | dict.fromkeys((*DRAWN, *release), Uniform(0.0, 1.0))

    @property
    def soil_inputs(self) -> "dict[str, Distribution]":
        """The uncertain inputs without place and azimuth, which each run draws by itself."""
        return {name: law for name, law in self.inputs.items() if name not in (*PLACE, IMPACT_AZIMUTH)}

    @property
    def met_on_the_way(self) -> tuple[str, ...]:
        """Numbers of a touchdown that follow no law of the study.

        Soils of regions, the arrival after a flight, and the angle and spin that rough ground is met with.
        """
        soils = {f"{GRAIN}{key}" for soil in self.study.soil.values() for key in soil.grain.values()}
        arrival = set(ARRIVAL if self.is_flown else ())
        if self.study.site.roughness_deg:
            arrival |= {IMPACT_INCIDENCE, *(self.inputs.keys() & set(SPIN))}
        return (*sorted(soils), *(name for name in (*ARRIVAL, *SPIN) if name in arrival))

    def reaches_met(self, name: str) -> list[tuple[float, float]]:
        """From where to where a property of the grains reaches by region and elsewhere; empty for other numbers."""
        key = name.removeprefix(GRAIN)
        soils = [soil.grain.values() for soil in self.study.soil.values()]
        given = [values[key] for values in soils if name.startswith(GRAIN) and key in values]
        own = self.study.touchdown_values().get(name)
        return [usual_reach(value) for value in (*given, *([] if own is None or not given else [own]))]

    @property
    def lawful_inputs(self) -> "dict[str, Distribution]":
        """The uncertain inputs that all first touchdowns draw by the law that the study gives."""
        met = (*self.met_on_the_way, *((GRAIN,) if self.study.soil else ()))
        return {name: law for name, law in self.inputs.items() if not name.startswith(met)}

    def with_run_count(self, count: int) -> "DrawnDesign":
        """The design of the same study with so many runs, which has all runs of one with fewer."""
        return DrawnDesign(self.study.with_run_count(count), self.site)

    def on_known_beds(self, count: int) -> "DrawnDesign":
        """The design of the same study with so many runs, of which those behind the study's lie on its beds."""
        return DrawnDesign(self.study.with_run_count(count), self.site, self.study.bed_count)

    def _points(self, count: int, skip: int = 0) -> np.ndarray:
        """Points of the sequence, [count, coordinate_count]."""
        from lithobrake.chaos import sobol_sequence

        return sobol_sequence(self.coordinates, count, hashed_seed(self.study.seed, "sequence"), skip=skip)

    def rows_at(self, beds: Sequence[int], x: np.ndarray) -> list[Row]:
        """All inputs of the runs on these beds [run_count] at these points [run_count, coordinate_count]."""
        return [row | self.grounds.of(bed, row) for bed, row in zip(beds, self._rows_of_points(beds, x), strict=True)]

    @cached_property
    def grounds(self) -> BedGrounds:
        return BedGrounds(self.site, self.inputs, self.known_beds or self.study.bed_count)

    def _rows_of_points(self, beds: Sequence[int], x: np.ndarray) -> list[Row]:
        """The same on the ground of [grain]."""
        rows, known = [], self.study.touchdown_medians()
        # A point has the inputs first, then what a run draws, then what a release draws: each zip takes the part that
        # it needs.
        for bed, point in zip(beds, x.tolist(), strict=True):
            soil = dict(zip(self.inputs, point, strict=False))
            uniform = dict(zip(DRAWN, point[len(self.inputs) :], strict=False))
            row = known | soil | {"bed": float(bed)} | _arrival(self.study, uniform)
            for name, coordinate, (low, high) in zip(PLACE, DRAWN[:2], self.grounds.region(bed) or (), strict=False):
                row[name] = low + uniform[coordinate] * (high - low)
            rows.append(row)
        return rows

    def _first_touchdowns(self, rows: list[Row], first: int, descents: Descents | None) -> list[Row]:
        """Rows of landers, numbered from `first` on, as first touchdowns on the ground that they meet."""
        delivered = self._delivered(self._on_their_ground(rows, first, descents), first)
        if descents is not None:
            return descents.first_touchdowns(delivered)
        return on_local_ground(self.site, delivered, first)

    def _on_their_ground(self, rows: list[Row], first: int, descents: Descents | None) -> list[Row]:
        """The same, each on a bed that the place of its first touchdown may have."""
        if self.study.ground is None or not rows:
            return rows
        if descents is None:
            sampled = self.site.sampled(first + len(rows))
            places = self.site.frames({key: values[first:] for key, values in sampled.items()})[0]
        else:
            places = descents.position
        bodies = [0] * len(rows) if descents is None else descents.ground.tolist()
        found = []
        for number, (row, place, body) in enumerate(zip(rows, places, bodies, strict=True), start=first):
            before = int(row["bed"])
            bed = self.grounds.bed_at(number, before, place, place, (body, body))
            if bed != before:
                own = {name: float(values[0]) for name, values in self.own_soils(np.array([number])).items()}
                row = row | own | self.grounds.of(bed, own) | self.grounds.moved(row, bed)
            found.append(row)
        return found

    def _delivered(self, rows: list[Row], first: int) -> list[Row]:
        """Rows of landers before it is known which ground they meet."""
        begin = {"touchdown": 0.0, TIME_LEFT: self.study.journey.duration}
        numbered = [row | {"journey": float(first + number)} | begin for number, row in enumerate(rows)]
        return arriving_together(self.site, numbered, first)

    def _descents(self, first: int, points: np.ndarray) -> Descents:
        return Descents.flown(self.site, first, points[:, -len(RELEASE) :])


def _arrival(study: Study, uniform: Row) -> Row:
    """Azimuth and attitude of a run, as far as the study has them drawn or given, not uncertain by another law."""
    first, second, third = (uniform[name] for name in DRAWN[3:])
    drawn = study.impact.orientation == "random"
    attitude = uniform_attitude(first, second, third) if drawn else given_attitude(study, first, second)
    row = dict(zip(ORIENTATION, (attitude / np.linalg.norm(attitude)).tolist(), strict=True))
    return row | ({IMPACT_AZIMUTH: 360.0 * uniform["azimuth"]} if study.impact.azimuth_deg == "random" else {})


def inputs_of(rows: Sequence[Mapping[str, float]], names: Sequence[str]) -> np.ndarray:
    """These inputs of runs in columns, shape [run_count, len(names)]."""
    return np.array([[row[name] for name in names] for row in rows])
