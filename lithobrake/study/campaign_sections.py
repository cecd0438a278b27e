"""The tables of the study file that say how runs are made, and by which program."""

from typing import Annotated

from pydantic import Field

from lithobrake.study.quantity import MaybeUncertain, Number, Scalar, Whole
from lithobrake.study.section import Section


class CampaignSection(Section):
    """How runs are made, and how many may fail; nothing here changes what a run gives."""

    wall_limit: Annotated[float, Number("s", above=0)] | None = None
    """Longest time that one run may take on the clock; it is then ended and counts as failed. Absent: any time."""
    memory_limit: Annotated[float, Number("bytes", above=0)] | None = None
    """Most memory that one run may hold, with all that it starts; above that it is ended. Absent: any (Linux only)."""
    retry_count: Annotated[int, Whole("", at_least=0, at_most=100)] = 1
    """How often a run that failed is tried again."""
    failed_share: Annotated[float, Number("", at_least=0, below=1)] = 0.05
    """Largest share of failed runs of a design with which an expansion is still fitted."""


class SolverSection(Section):
    """A program of your own that makes the touchdowns in place of this one (docs/own_solver.md)."""

    command: str | None = None
    """Its command line, started in a folder for each run, where it reads inputs.json and writes outputs.json; words
    that name files count from the study file. Or "umbridge:http://HOST:PORT/MODEL", the model of a server in its place.
    Absent: this program's own soil."""
    templates: list[str] = Field(default=[])
    """Files, counted from the study file, in which {{ grain.friction }} becomes that number of a run and {{ seed }} its
    seed; each is put into the run's folder under its own name."""
    answer: str = "outputs.json"
    """Name of the file that the program writes, with the ending .json, .csv, .yaml, .yml, .h5 or .hdf5."""
    inputs: dict[str, Annotated[Scalar, MaybeUncertain("")]] = Field(default={})
    """Numbers that only your program knows, by names of your own."""
