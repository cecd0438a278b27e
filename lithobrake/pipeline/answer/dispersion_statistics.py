"""What became of the landers: shares, times, speeds, ellipses, the site, and where they come down first."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from lithobrake.analysis import dispersion_ellipses, highest_density
from lithobrake.files.reading import read_rows
from lithobrake.geometry.mesh_units import labelled_mesh, product_id
from lithobrake.pipeline.answer.run_answers import SHARES, rest_regions
from lithobrake.pipeline.design.arrivals import MEAN_INCIDENCE
from lithobrake.pipeline.first_touchdown.flights import flight_numbers
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.site import Site
from lithobrake.pipeline.study_folder import AGAIN
from lithobrake.results import dispersion
from lithobrake.results.journey_results import DeliveryResults
from lithobrake.results.run_results import CountedShare
from lithobrake.results.site_results import KernelNumbers, SiteResults
from lithobrake.results.study_files import results_in
from lithobrake.study import BUILT_IN_BODIES, Study
from lithobrake.study.site_kernels import kernel_partner, kernel_spin
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.file_names import ARCS_FILE, FLIGHT_CHECKS_FILE, TOUCHDOWNS_FILE
from lithobrake.vocabulary.number_words import QUANTILES
from lithobrake.vocabulary.quantities import IMPACT_INCIDENCE, IMPACT_SPEED

NORMAL_QUANTILE_90 = 1.6448536269514722
Rows = Sequence[dict[str, str]]
POSITION = tuple(f"position_{axis}" for axis in "xyz")


def site_results(site: Site) -> SiteResults:
    """The body at the medians, and the acceleration of a point at rest on the ground at the site."""
    study, body, medians, effective = site.study, site.body, site.medians, site.acceleration
    heads, partner = site.has_heading, None if body.partner is None else body.partner.body.name
    extents, centroid, place = (
        (x, y, z)
        for x, y, z in (
            np.ptp(body.shape.vertices, axis=0).tolist(),
            body.shape.centroid.tolist(),
            body.shape.surface_point(medians["latitude_deg"], medians["longitude_deg"]).tolist(),
        )
    )
    return SiteResults(
        body=study.site.body if study.site.body in BUILT_IN_BODIES else "mesh",
        product_id=body_product(study),
        mass_kg=body.mass,
        bulk_density_kg_m3=body.density,
        spin_period_s=body.spin_period,
        kernels=kernel_numbers(study),
        extents_m=extents,
        facet_count=len(body.shape.faces),
        centroid_m=centroid,
        partner=partner,
        partner_distance_m=None if partner is None else float(body.orbit.distance),
        latitude_deg=medians["latitude_deg"],
        longitude_deg=medians["longitude_deg"],
        heading_deg=medians["heading_deg"] if heads else None,
        place_m=place,
        effective_acceleration_outward=float(effective[2]),
        effective_acceleration_along_heading=float(effective[0]) if heads else None,
        # In axes that do not turn, from the body alone.
        escape_speed_m_s=site.escape_speed,
        warning=site.warning,
        rotation=site.rotation_words,
        gravity_warning=site.gravity_warning,
        cautions=site.cautions,
    )


def body_product(study: Study) -> str | None:
    """The product of an archive that the mesh of the body is, as its label has it."""
    return None if study.site.body in BUILT_IN_BODIES else product_id(labelled_mesh(Path(study.site.body)))


def kernel_numbers(study: Study) -> KernelNumbers | None:
    """What was read from kernels; None without any."""
    spin, place = kernel_spin(study.site), kernel_partner(study.site)
    if spin is None:
        return None
    own = (spin.period, spin.pole_right_ascension_deg, spin.pole_declination_deg, spin.prime_meridian_deg)
    partner = () if place is None else (place.longitude_deg, place.latitude_deg, place.distance, place.period)
    return KernelNumbers(*own, *partner)


def impact_numbers(rows: Rows) -> dispersion.ImpactNumbers:
    """Quantiles of time, speed and incidence of the flights that end on the body."""
    return dispersion.ImpactNumbers(
        **{name: dispersion.ImpactNumber(quantiles) for name, quantiles in flight_numbers(rows).items()}
    )


def flight_checks(job: Job) -> dispersion.FlightChecks:
    """How exact the flights of a study are."""
    return results_in(dispersion.FlightChecks, job.folder.read_json(FLIGHT_CHECKS_FILE), "flights")


def ellipses(site: Site, rows: Rows) -> dispersion.LandingEllipses | None:
    """Ellipses that hold half and 95 % of the places of these rows; None where there are none."""
    latitude, longitude = (np.array([float(row[f"{name}_deg"]) for row in rows]) for name in ("latitude", "longitude"))
    return place_ellipses(site, latitude, longitude)


def place_ellipses(site: Site, latitude: np.ndarray, longitude: np.ndarray) -> dispersion.LandingEllipses | None:
    """Ellipses that hold half and 95 % of places [deg], both [count]; None where there are none.

    The axes in metres are the angles times the radius at the middle.
    """
    found = dispersion_ellipses(latitude, longitude)
    if found is None:
        return None
    centre = site.body.shape.surface_point(found.latitude_deg, found.longitude_deg)
    radius = float(np.linalg.norm(centre))
    held = []
    for share, (long, short) in found.semi_axes_deg.items():
        long_m, short_m = (np.radians((long, short)) * radius).tolist()
        held.append(dispersion.EllipseShare(share, (long, short), (long_m, short_m)))
    return dispersion.LandingEllipses(found.latitude_deg, found.longitude_deg, found.heading_deg, tuple(held))


def proportion(count: int, total: int) -> CountedShare:
    """A count and its share of a total; no interval, which would have to hold for other beds and places."""
    return CountedShare(count, Estimate(count / total, None, None))


def delivery_results(job: Job, first: DesignRuns, journey_count: int) -> DeliveryResults:
    """Those of a folder; first: its first touchdowns. Raises DamagedFileError for files that are not a study's."""
    columns = ("latitude_deg", "longitude_deg", "touchdown", "body", *POSITION)
    rows = [row for row in read_rows(job.folder / TOUCHDOWNS_FILE, columns, AGAIN) if row["touchdown"] == "0"]
    here = [row for row in rows if row["body"] == job.site.ground_names[0]]
    latitude, longitude = (np.array([float(row[name]) for row in here]) for name in columns[:2])
    places = np.array([[float(row[name]) for name in POSITION] for row in here]).reshape(-1, 3)
    density = highest_density(places, SHARES)
    flights = read_rows(job.folder / ARCS_FILE, ("begin_s",), AGAIN)
    descents = np.array([-float(row["begin_s"]) for row in flights if float(row["begin_s"]) < 0.0])
    return DeliveryResults(
        count=len(rows),
        of=journey_count,
        speed=_spread(first.inputs[IMPACT_SPEED]),
        incidence_deg=_spread(first.inputs.get(MEAN_INCIDENCE, first.inputs[IMPACT_INCIDENCE])),
        descent_s=_spread(descents) if len(descents) else None,
        ellipse=place_ellipses(job.site, latitude, longitude),
        regions=rest_regions(density),
        why_no_regions=density.why,
    )


def _spread(values: np.ndarray) -> tuple[float, float, float]:
    low, median, high = np.quantile(values, QUANTILES).tolist()
    return low, median, high
