"""A map of sites: one delivery to a grid of cells over the body, and what it says in sentences."""

import math
from pathlib import Path

import numpy as np

from lithobrake.analysis import EqualAreaCells
from lithobrake.campaign.single_run import Model
from lithobrake.files.atomic import write_json, write_rows
from lithobrake.pipeline import site_grid
from lithobrake.pipeline.answer.emulated_ends import Refits
from lithobrake.pipeline.answer.journey_ends import JourneyTable
from lithobrake.pipeline.commands.emulator_job import (
    MOST_LANDERS,
    emulator_job,
    refuse_lander_count,
    refuse_no_emulator,
)
from lithobrake.pipeline.job import Job, Silent, StudyProgress
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.results.site_results import SiteMap
from lithobrake.results.study_files import json_values
from lithobrake.statements.sites import with_words
from lithobrake.study import Study, StudySource
from lithobrake.vocabulary.constants import REFIT_COUNT
from lithobrake.vocabulary.number_words import LEVEL
from lithobrake.vocabulary.quantities import JOURNEY_DESIGN


def map_sites(
    source: StudySource,
    out: Path,
    *,
    cell_count: int = 120,
    lander_count: int = 200,
    worker_count: int | None = None,
    scheduler: str | None = None,
    model: Model | None = None,
    shown: StudyProgress | None = None,
) -> SiteMap:
    """Follow the landers of a study, by its emulator, from each of a number of sites over its body.

    cell_count: sites, cells of equal area; lander_count: landers of each, a multiple of the refits of the emulator, at
    least two of each; all else: as for `run_study`, which makes the journeys and their emulator first. Raises
    ValueError for a study without an emulator of its touchdowns, and for what `run_study` refuses.
    """
    shown = shown or Silent()
    cells = EqualAreaCells.of(cell_count)
    # Before the journeys of the study are made.
    _refuse(source.study, cell_count, lander_count)
    title = "map of sites"
    with emulator_job(
        source, out, title, worker_count=worker_count, scheduler=scheduler, model=model, shown=shown
    ) as job:  # fmt: skip
        return _mapped(job, source.stem, cells, lander_count)


def _refuse(study: Study, cell_count: int, lander_count: int) -> None:
    """Raise ValueError for a study that has no landers to deliver elsewhere, and for counts that make no map."""
    refuse_no_emulator(study, "sites")
    # Sites are compared refit by refit.
    refuse_lander_count(lander_count, 200)
    if cell_count * lander_count > MOST_LANDERS:
        raise ValueError(
            f"--cells {cell_count} with --landers {lander_count} makes {cell_count * lander_count} landers; allowed: "
            f"up to {MOST_LANDERS}; take fewer of either"
        )


def _mapped(job: Job, stem: str, cells: EqualAreaCells, lander_count: int) -> SiteMap:
    study, runs = job.study, DesignRuns.load(job.folder, JOURNEY_DESIGN)
    fitted = Refits.of_journeys(study, JourneyTable.load(job.folder))
    ground, landers = site_grid.SiteGround.of(job, cells), site_grid.follow_sites(job, cells, lander_count)
    latitude, longitude = (one[np.isfinite(one)] for one in site_grid.first_places(job))
    journeys = np.bincount(cells.cell_of(latitude, longitude), minlength=cells.total)
    shape = job.site.body.shape
    found = SiteMap(
        title=study.title or stem,
        body=study.site.name or Path(study.site.body).stem.capitalize(),
        statement="",
        of="",
        level=LEVEL,
        why=fitted.why,
        duration_s=study.journey.duration,
        landers=lander_count,
        refits=REFIT_COUNT,
        beds=len(np.unique(runs.inputs["bed"])),
        touchdowns=runs.run_count,
        # The cells are of equal area on a sphere, which here has the volume of the body.
        area_m2=4.0 * math.pi * (0.75 * shape.volume / math.pi) ** (2.0 / 3.0) / cells.total,
        at_rest=site_grid.all_at_rest(landers, fitted),
        cells=site_grid.site_cells(cells, landers, ground, fitted, journeys, site_grid.site_states(study)),
        agreement=site_grid.site_agreement(job),
    )
    return with_words(found)


def site_map_files(place: Path) -> tuple[Path, Path, Path]:
    """The files of a map of sites in a folder: its page, its numbers, and its cells as a table."""
    return place / "index.html", place / "sites.json", place / "sites.csv"


def write_site_map(site_map: SiteMap, study_text: str, place: Path) -> tuple[Path, Path, Path]:
    """Write page, figures, sites.json and sites.csv of a map into a folder, which is made; returns the files."""
    from lithobrake.report import write_sites

    page, numbers, table = site_map_files(place)
    write_sites(site_map, study_text, place)
    write_json(numbers, json_values(site_map))
    rows = [cell.row for cell in site_map.cells]
    # A site without a result has no limit states.
    names = list(dict.fromkeys(name for row in rows for name in row))
    write_rows(table, names, ([row.get(name) for name in names] for row in rows))
    return page, numbers, table


def site_lines(site_map: SiteMap) -> list[str]:
    """A map of sites for a terminal: what it says, and over which landers."""
    return [site_map.statement, site_map.of]
