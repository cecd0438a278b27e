"""How much room the files of a study will take on the disk; sizes measured on studies of the first bounce."""

from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.planning.expected_steps import ExpectedSoil
from lithobrake.pipeline.planning.planned_runs import PlannedRuns
from lithobrake.pipeline.runs.shown_landing import landing_files, telling_files
from lithobrake.pipeline.site import Site
from lithobrake.study import Study
from lithobrake.vocabulary.quantities import OUTPUTS

NUMBER = 8
# A bed: hulls, poses and frames of a grain, and the history, a row in every eight steps.
BED_GRAIN, BED_STEP = 1400, 4
LANDING_BODY = 11_800  # poses of a body and forces on it in all frames of a landing
LEDGER_RUN = 5_000
FLIGHT_ROW, JOURNEY_ROW = 270, 120
SHAPE_FACET = 45
TOUCHDOWNS = 4  # of a journey
REPORT = 7_500_000  # page and figures, with expansions, scores and summary


def expected_bytes(design: DrawnDesign, site: Site, runs: PlannedRuns, soil: ExpectedSoil | None) -> dict[str, int]:
    """Bytes at most of the files of a finished study, by what they hold; what a program of one's own leaves apart."""
    study = design.study
    samples, flights, journeys = study.monte_carlo, flight_count(study), journey_count(study)
    # The outcome takes one byte.
    row = NUMBER * (len(design.inputs) + len(OUTPUTS) * (1 + samples.scatter)) + 1
    found = {
        "runs": LEDGER_RUN * runs.total * (1 if study.journey is None else TOUCHDOWNS),
        "samples": 0 if study.journey is not None else samples.sample_count * row,
        "flights": FLIGHT_ROW * flights + JOURNEY_ROW * journeys + SHAPE_FACET * len(site.body.shape.faces),
        "report": REPORT,
    }
    if soil is not None:
        grains = soil.recipe.grain_count
        one = BED_GRAIN * grains + BED_STEP * round(soil.pour_steps())
        shown = len(landing_files(study) + telling_files(study))
        found["beds"] = study.bed_count * one + shown * LANDING_BODY * (grains + 1)
    return found


def flight_count(study: Study) -> int:
    """Flights at most, with those of the expansion alone beside those with scatter."""
    if study.journey is not None:
        return 0
    count = min(study.flight.flight_count or study.monte_carlo.sample_count, study.monte_carlo.sample_count)
    return count * (1 + study.monte_carlo.scatter)


def journey_count(study: Study) -> int:
    """Journeys from bounce to bounce, on hard ground and, where it can be asked, on the soil."""
    from lithobrake.pipeline.rest.bounce_inputs import why_no_soil

    if study.journey is not None:
        return 0
    count = min(study.rest.count, study.monte_carlo.sample_count)
    return count if why_no_soil(study) else 2 * count
