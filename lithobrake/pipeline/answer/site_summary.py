"""What the summary says of the body and of a point at rest on the ground at the site."""

from pathlib import Path

import numpy as np

from lithobrake.geometry.mesh_labels import labelled_mesh, product_id
from lithobrake.pipeline.site import Site
from lithobrake.results.site_results import KernelNumbers, SiteResults
from lithobrake.study import BUILT_IN_BODIES, Study
from lithobrake.study.site_kernels import kernel_partner, kernel_spin


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
        kernels=_of_kernels(study),
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
    )


def body_product(study: Study) -> str | None:
    """The product of an archive that the mesh of the body is, as its label has it."""
    return None if study.site.body in BUILT_IN_BODIES else product_id(labelled_mesh(Path(study.site.body)))


def _of_kernels(study: Study) -> KernelNumbers | None:
    """What was read from kernels; None without any."""
    spin, place = kernel_spin(study.site), kernel_partner(study.site)
    if spin is None:
        return None
    own = (spin.period, spin.pole_right_ascension_deg, spin.pole_declination_deg, spin.prime_meridian_deg)
    partner = () if place is None else (place.longitude_deg, place.latitude_deg, place.distance, place.period)
    return KernelNumbers(*own, *partner)
