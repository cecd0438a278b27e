"""What a study's folder holds in rows: runs, samples, flights, journeys, touchdowns, beds."""

from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any

from lithobrake.files.reading import reading
from lithobrake.results.study_files import JOURNEYS, NEEDED, TOUCHDOWN_RUNS, TOUCHDOWNS, StudyFiles, joined_touchdowns
from lithobrake.vocabulary import file_names
from lithobrake.vocabulary.quantities import (
    ARC,
    BEDS,
    DRAWN_DESIGNS,
    FLIGHT,
    FOLLOWED,
    JOURNEY,
    JOURNEY_DESIGN,
    JOURNEY_TOUCHDOWN,
    PAPER_DESIGNS,
    RUN,
    SOIL,
    TOUCHDOWN,
    TOUCHDOWN_COST,
)

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from lithobrake.campaign import Record
    from lithobrake.results.table import Table

# Columns that a table has even without rows.
_RUN = ("key", "outcome")
_PLACES = ("sample", "status", "latitude_deg", "longitude_deg")


class StudyTables(StudyFiles):
    """The tables of a study, each read as it is asked for."""

    @property
    def ledger(self) -> "list[Record]":
        """Every run that was ever made or asked for, those of earlier settings among them, as it stands now."""
        from lithobrake.campaign import read_records

        return read_records(self.folder / file_names.RUNS_FILE)

    @cached_property
    def runs(self) -> "Table":
        """Every touchdown of the study once: outcome, inputs in the file's units, outputs [SI]."""
        rows: dict[str, dict[str, Any]] = {}
        for design, name in self._designs().items():
            for row in self._rows(name, _RUN):
                rows.setdefault(row["key"], {"design": design, **row})
        return self._table("run", list(rows.values()), ("design", *_RUN), RUN | TOUCHDOWN)

    @cached_property
    def samples(self) -> "Table":
        """The samples of the Monte Carlo: inputs in the file's units, outcome, and outputs [SI] of those that leave."""
        import h5py
        import numpy as np

        path = self._file(file_names.SAMPLES_FILE)
        with reading(path, self.remedy), h5py.File(path, "r") as file:
            names = [str(name) for name in file.attrs["outcomes"]]
            outcome = np.array(names)[file["outcome"][:]]
            inputs, outputs = (
                dict(zip(map(str, file.attrs[f"{part}_names"]), file[f"{part}s"][:].T, strict=True))
                for part in ("input", "output")
            )
        return self._described("sample", {**inputs, "outcome": outcome, **outputs}, RUN | TOUCHDOWN)

    @cached_property
    def flights(self) -> "Table":
        """The flights of the samples that leave, to the next impact (docs/flights.md)."""
        columns = (*_PLACES, "facet")
        return self._table("flight", self._rows(file_names.SAMPLE_FLIGHTS_FILE, columns), columns, FLIGHT)

    @cached_property
    def flight_paths(self) -> "tuple[NDArray[np.float64], tuple[str, ...]]":
        """Places on the first flights' ways [m], shape [path_count, place_count, 3], body-fixed; how each ended."""
        import h5py

        path = self._file("flight_paths.h5")
        with reading(path, self.remedy), h5py.File(path, "r") as file:
            return file["position"][:], tuple(map(str, file.attrs["status"]))

    @cached_property
    def flight_path_times(self) -> "tuple[NDArray[np.float64], NDArray[np.int64]]":
        """Times since the start of each flight at the places of flight_paths [s], shape [path_count, place_count], and
        the number of the sample or journey that each is of, shape [path_count]."""
        import h5py

        path = self._file("flight_paths.h5")
        with reading(path, self.remedy), h5py.File(path, "r") as file:
            return file["time"][:], file["sample"][:]

    @cached_property
    def rest(self) -> "Table":
        """Where landers end on other ground than that of the study (docs/flights.md)."""
        columns = tuple(FOLLOWED)
        return self._table("journey", self._rows(file_names.REST_FILE, columns), columns, FOLLOWED)

    @cached_property
    def run_flights(self) -> "Table":
        """How the flights of each first touchdown ended, from many sites, and which share of them returns."""
        return self._table("run", self._rows("run_flights.csv", ("run", *_RUN)), ("run", *_RUN), RUN | FLIGHT)

    @cached_property
    def journeys(self) -> "Table":
        """Each lander from its delivery to rest: how, when and where its journey ended (docs/journeys.md)."""
        return self._table("journey", self._journey_rows(JOURNEYS, NEEDED), tuple(JOURNEY), JOURNEY)

    @cached_property
    def touchdowns(self) -> "Table":
        """Every landing of the journeys: number, state in, state out, bed, soil and cost (docs/journeys.md)."""
        columns = tuple(JOURNEY_TOUCHDOWN)
        rows = self._journey_rows(TOUCHDOWNS, columns)
        # Regions of the body have soils of their own in some studies alone.
        columns += tuple(SOIL) if rows and set(SOIL) <= set(rows[0]) else ()
        joined = joined_touchdowns(rows, self._rows(TOUCHDOWN_RUNS, _RUN), self.ledger)
        known = RUN | TOUCHDOWN | JOURNEY_TOUCHDOWN | SOIL | TOUCHDOWN_COST
        return self._table("touchdown", joined, columns, known)

    @cached_property
    def arcs(self) -> "Table":
        """Each flight between impacts: of every journey of landings, or of the first samples that were followed."""
        return self._table("arc", self._rows(file_names.ARCS_FILE, tuple(ARC)), tuple(ARC), ARC)

    @cached_property
    def beds(self) -> "Table":
        """Numbers of each bed; a study whose touchdowns are made by its own program has none."""
        with reading(self.folder / file_names.SUMMARY_FILE, self.remedy):
            beds: list[dict[str, Any]] = self._content["results"]["beds"]
            columns = {name: [bed[name] for bed in beds] for name in (beds[0] if beds else ())}
        return self._described("bed", columns, BEDS)

    def _journey_rows(self, name: str, columns: Sequence[str]) -> list[dict[str, Any]]:
        """The rows of a table of journeys. Raises ValueError for a study that has none."""
        made = self._noted_files()
        if made and JOURNEYS not in made:
            raise ValueError(f"{self.folder} has no journeys of landings: its study file lacks the table [journey]")
        return self._rows(name, columns)

    def _designs(self) -> dict[str, str]:
        """The files of the study's designs, by their names; a folder may also have those of an earlier method."""
        found = {design: f"designs/{design}.csv" for design in (*PAPER_DESIGNS, *DRAWN_DESIGNS, JOURNEY_DESIGN)}
        # An early format notes no stages, and knows of one method only.
        asked = self._noted_files()
        found = {design: name for design, name in found.items() if name in asked or not asked}
        return {design: name for design, name in found.items() if (self.folder / name).is_file()}
