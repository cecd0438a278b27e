"""What every key of the summary of a study means; docs/summary.md is made of it.

`*` stands for any one name: of an output, an input by its dotted key, a design, an outcome. Lists have no place of
their own: `results.beds.solid_fraction` is that of each bed. SI, where no unit is named; null: there is no such number.
"""

from dataclasses import dataclass

from lithobrake.vocabulary.quantities import BEDS

SUMMARY = "summary.json"


@dataclass(frozen=True)
class KeyTable:
    """A table of a file that stands at these places, in words, and its keys; the keys of inner tables have points."""

    file: str
    places: tuple[str, ...]
    words: str
    keys: dict[str, str]


COUNTED = {
    "*.count": "samples of which this is so",
    "*.share": "the same as a share of sample_count",
    "*.lower": "lower bound, over refits of the emulator to other beds, or of rest.hard by the number of samples; null "
    "where why says that there is none",
    "*.upper": "upper bound likewise",
}
QUANTILES = "quantile of this level"
SUMMARY_TABLES = (
    KeyTable(
        SUMMARY,
        ("",),
        "The file",
        {
            "format_version": "of the file; another number, another set of keys",
            "study.**": "the study as it was understood, with all defaults, in the units of the study file (every key "
            "with its unit, range and meaning: lithobrake new)",
        },
    ),
    KeyTable(
        SUMMARY,
        ("results",),
        "What came out; two executions of one study have the same",
        {
            "units.*": "unit of each output of the expansions",
            "kept_inputs": "inputs that the refined design varies, by dotted key",
            "kept_share.*": "share of the variance of the screening expansion that the kept inputs explain together",
            "answer": "what becomes of the landers, over what that holds, and what is missing, in sentences",
            "headline": "the answer, then the numbers that tell most, in sentences",
            "limit_states": "of a drawn study that asks for none: empty",
            "aim": "null in a drawn study that has no aims to choose from",
            "without_scatter": "null where the samples have no scatter from run to run, or are of an emulator",
        },
    ),
    KeyTable(
        SUMMARY,
        ("results.beds",),
        "Each bed, in the order of the files; none where a program or function of the user's own makes the touchdowns",
        {name: one.long_name + (f" [{one.units}]" if one.units else "") for name, one in BEDS.items()},
    ),
    KeyTable(
        SUMMARY,
        ("results.node_counts",),
        "Nodes of grids, whatever design the study has",
        {
            "input_counts": "numbers of inputs, the rows of the two tables",
            "levels": "levels, their columns",
            "tensor": "nodes of the full tensor grid",
            "smolyak": "nodes of the sparse grid",
        },
    ),
    KeyTable(
        SUMMARY,
        ("results.designs.*",),
        "The runs of each design: screening, refined, test_kept, test_all",
        {
            "point_count": "points, each run replicate_count times",
            "replicate_count": "runs at every point",
            "run_count": "runs, of which several may be one in the ledger",
            "with_outputs": "runs after which the lander left, with all outputs",
            "outcomes.*": "runs that ended so; failed: runs without an outcome",
        },
    ),
    KeyTable(
        SUMMARY,
        ("results.outputs_of_runs.*",),
        "What else the touchdowns gave, over distinct runs that have it",
        {
            "median": "in the unit beside it",
            "smallest": "likewise",
            "largest": "likewise",
            "unit": "of the three numbers",
            "of": "which landings have it, in words",
        },
    ),
    KeyTable(
        SUMMARY,
        ("results.screening", "results.refined"),
        "Each expansion: in all inputs, then in the kept ones",
        {
            "inputs": "inputs by dotted key, in the order of the study file",
            "term_count": "terms that any output uses",
            "degree": "highest total degree of a term",
            "mean.*": "mean of the output over the distributions of the inputs",
            "std.*": "standard deviation likewise, without scatter from run to run",
            "sobol_first.*.*": "share of the variance of the expansion that the input explains alone, freed of scatter",
            "sobol_total.*.*": "the same with all its interactions",
            "sobol_first_interval.*.*": "its 95 % interval, by drawing the residuals of the runs anew: lower, upper",
            "sobol_total_interval.*.*": "likewise",
            "fits.*.method": "how the output was fitted: ols, omp, lars, gaussian_process",
            "fits.*.term_count": "terms of this output",
            "fits.*.condition_number": "of the least squares; null for a Gaussian process",
            "fits.*.rmse_estimate": "root-mean-square error expected at a new run with scatter, in the output's unit",
            "fits.*.rrmse_estimate": "the same over the standard deviation of the runs; null where they do not vary",
            "fits.*.noise_std": "standard deviation between equal runs, in the output's unit; null where not known",
            "fits.*.noise_from": "what tells it: repeated points, the nugget of a Gaussian process, or a smaller error",
            "fits.*.noise_share": "share of the variance of the runs that is scatter; null where not known",
        },
    ),
    KeyTable(
        SUMMARY,
        ("results.scores.*.*",),
        "Errors of the expansions, by set of runs and output: screening and refined on their own runs, test_screening, "
        "test_kept and test_all on runs that they have not seen; scores.json has those of single runs beside them",
        {},
    ),
    KeyTable(
        SUMMARY,
        ("results.monte_carlo",),
        "The samples of the refined expansion, or of the emulator",
        {
            "sample_count": "samples",
            "leaving_count": "samples that leave the surface",
            "outputs.*.mean": "over the samples of the refined expansion that leave, in the unit of the output; a "
            "drawn study has results.outputs",
            "outputs.*.std": "likewise",
            "outputs.*.quantile_*": QUANTILES,
        },
    ),
    KeyTable(
        SUMMARY,
        ("results.site",),
        "The body, and a point at rest on the ground of the site; what is uncertain at its median",
        {
            "body": "name of the built-in body, or mesh",
            "product_id": "product of an archive that the mesh is, and its version, by its label; null without one",
            "mass_kg": "mass of the body",
            "bulk_density_kg_m3": "mass over the volume of the shape",
            "spin_period_s": "time of a turn",
            "kernels": "what was read from kernels of SPICE; null without any",
            "kernels.spin_period_s": "time of a turn, from the constants (PCK), as are the next three",
            "kernels.pole_right_ascension_deg": "of the axis about which it turns counter-clockwise (J2000)",
            "kernels.pole_declination_deg": "likewise",
            "kernels.prime_meridian_deg": "where longitude 0 is at the epoch J2000, as the constants count it",
            "kernels.partner_longitude_deg": "east longitude over which the partner stands at site.epoch, from the "
            "ephemeris (SPK), as are the next three; none without site.epoch",
            "kernels.partner_latitude_deg": "latitude over which it stands; flights have it in the equator",
            "kernels.partner_distance_m": "between the centres; flights have partner_distance_m above",
            "kernels.partner_period_s": "of a circle at its angular speed then",
            "extents_m": "along x, y and z",
            "facet_count": "facets of the shape",
            "centroid_m": "of the shape, from the origin of its file",
            "partner": "name of the other body of a binary, or null",
            "partner_distance_m": "between the two centres, or null",
            "latitude_deg": "planetocentric latitude of the aim",
            "longitude_deg": "east longitude of the aim",
            "heading_deg": "of the incoming horizontal velocity, from north toward east; null where it has no median",
            "place_m": "of the aim on the shape, body-fixed",
            "effective_acceleration_outward": "gravity and rotation along the outward normal [m/s2]; above 0: lifts",
            "effective_acceleration_along_heading": "the same along the heading [m/s2]; null without heading",
            "escape_speed_m_s": "from the site, in axes that do not turn, from this body alone",
            "warning": "what the site does to landers that lie there, in a sentence; null where it holds them",
            "gravity_warning": "how touchdowns and site differ in acceleration, in a sentence; null where alike",
        },
    ),
    KeyTable(
        SUMMARY,
        ("results.returns",),
        "The return fraction: landings that impact the surface again within flight.duration, or are captured where the "
        "site holds them, of all landings",
        {
            "share": "over the input distributions of the study file: of the landings of a drawn study, those without "
            "an outcome as like those that left in flight across the edge of the bed, or of samples of the expansion",
            "lower": "lower bound, over beds and impact points not in the study, whatever became of the landings "
            "without an outcome; null where why says that there is none",
            "upper": "upper bound likewise",
            "level": "probability that bounds of this table stand for",
            "from": "of how many landings and beds, or samples",
            "next_bed": "prediction interval for a new bed of the size of the study's: lower, upper; null where that "
            "is not known",
            "if_missing": "the share if none, and if all, of the landings without an outcome return, without sampling "
            "error",
            "missing": "share of the landings, or samples, without an outcome",
            "emulator": "the share by the emulator or the expansion, of the samples whose end is known",
            "why": "why there is no interval, in a sentence; null where there is one",
        },
    ),
    KeyTable(
        SUMMARY,
        ("results.shares", "results.without_scatter.shares"),
        "What became of the landings: impact, flying (at the end of the time), escaped, partner and captured, which "
        "add up to 1 in a drawn study; returns (impact, and captured where the site holds), settled and lofted "
        "(captured where the ground holds, or lifts off), missing (left_sideways, time_limit, failed). A drawn study "
        "takes them from flights of its runs, by the estimator of results.returns; design.method = paper from samples "
        "up to the last that flew, of which outside (with an elevation or speed that cannot be) are missing too",
        {
            "sample_count": "flights of all landings, 64 each, whether they could be made or not; or samples",
            "flight_count": "of those, flights that were made",
            "*.count": "of sample_count, those of which this is so",
            "*.share": "of all landings; in a drawn study those without an outcome count as like those that left in "
            "flight across the edge of the bed, and are missing themselves",
            "*.lower": "lower bound, over beds and impact points not in the study, whatever became of the landings "
            "without an outcome; null where why says that there is none",
            "*.upper": "upper bound likewise",
            "*.upper_limit": "95 % limit of the share of an outcome that no run had, with design.method = paper",
            "why": "why the shares have no interval, in a sentence; null where they have one",
            "level": "probability that the bounds stand for, in a drawn study",
        },
    ),
    KeyTable(
        SUMMARY,
        ("results.flights", "results.without_scatter.flights"),
        "The flights that end on the body, of the runs of a drawn study or of samples, and how exact all flights are "
        "(flights.json)",
        {
            "*.of": "of a drawn study: which landings it describes, in words",
            "*.intervals.quantile_*": "of a drawn study: lower and upper bound (90 %) of the quantile over beds not in "
            "the study; null where there is none",
            "time_s.quantile_*": f"time of flight [s], {QUANTILES}",
            "impact_speed.quantile_*": f"speed of the impact against the ground [m/s], {QUANTILES}",
            "impact_incidence_deg.quantile_*": f"angle of that velocity from the inward normal [deg], {QUANTILES}",
            "gravity": "table or exact",
            "gravity_table_error": "null where the gravity is exact",
            "gravity_table_error.median": "error of the table over the mean gravity on the surface",
            "gravity_table_error.p95": "the same, 95th percentile",
            "gravity_table_error.largest": "the same, largest",
            "gravity_table_error.point_count": "points looked at",
            "jacobi_flight_count": "flights whose Jacobi constant was looked at, without the partner",
            "jacobi_drift_median_m2_s2": "how far it drifts, in the median; null without flights",
            "jacobi_drift_largest_m2_s2": "the same, largest",
        },
    ),
    KeyTable(
        SUMMARY,
        tuple(
            f"results.{place}ellipses"
            for place in ("", "without_scatter.", "rest.soil.", "rest.hard.", "rest.equivalent.")
        ),
        "Ellipses that hold the places of the impacts, or of the landers that settled; null where there are too few",
        {
            "latitude_deg": "of the middle",
            "longitude_deg": "of the middle",
            "heading_deg": "of the longer axis, from north toward east",
            "shares.share": "share of the places inside",
            "shares.semi_axes_deg": "longer and shorter half axis, as angles from the centre of the body",
            "shares.semi_axes_m": "the same angles times the radius at the middle",
        },
    ),
    KeyTable(
        SUMMARY,
        ("results.rest",),
        "From bounce to bounce until the landers rest",
        {
            "why_no_soil": "why the soil could not be asked beyond the first impact, in a sentence, or null",
            "trained_ranges.*": "smallest and largest value of the input in runs in which all vary, in its unit",
        },
    ),
    KeyTable(
        SUMMARY,
        ("results.rest.soil", "results.rest.hard", "results.rest.equivalent"),
        "Where the followed samples end on each ground (docs/flights.md; equivalent: hard ground with the restitution "
        "that the soil implies, in a drawn study); slid: moved along the ground at all, however they ended; null where "
        "none were followed",
        {
            "sample_count": "samples followed",
            "of": "which journeys the table describes and what they depend on, in words: hard ground takes no soil, "
            "bed or emulator of the study",
            **COUNTED,
            "why": "why the shares have no interval, in a sentence; null where they have one; in a drawn study",
            "level": "probability that the bounds stand for, in a drawn study",
            "time_s.quantile_*": f"time until rest [s] of those that settled, {QUANTILES}",
            "path_length.quantile_*": f"sum of the straight lines between impacts [m] likewise, {QUANTILES}",
            "rebounds.quantile_*": f"impacts after which the lander went on likewise, {QUANTILES}",
            "slid_length.quantile_*": f"way along the ground, in contact with it [m] likewise, {QUANTILES}",
            "slid_time_s.quantile_*": f"time of that [s], part of time_s, likewise, {QUANTILES}",
        },
    ),
    KeyTable(
        SUMMARY,
        ("provenance",),
        "Where it comes from; all that may differ between two executions of one study",
        {
            "date": "when the summary was made, UTC",
            "folder": "folder of the study, as it was given",
            "host": "name of the machine",
            "system": "its operating system",
            "cores": "its cores",
            "python": "version of Python",
            "packages.*": "version of each package that numbers depend on",
            "wall_s.*": "wall time of each stage when its files were made",
            "runs.asked": "runs of all designs",
            "runs.distinct": "those that differ, as the ledger has them",
            "runs.wall_s": "wall time of all of them together",
            "runs.cpu_s": "CPU time likewise",
            "runs.longest_wall_s": "wall time of the longest",
        },
    ),
)
