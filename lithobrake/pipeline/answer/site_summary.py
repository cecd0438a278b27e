"""What the summary says of the body and of a point at rest on the ground at the site."""

from pathlib import Path
from typing import Any

import numpy as np

from lithobrake.geometry.mesh_labels import labelled_mesh, product_id
from lithobrake.pipeline.site import Site
from lithobrake.study import BUILT_IN_BODIES, Study
from lithobrake.study.site_kernels import kernel_partner, kernel_spin


def site_results(site: Site) -> dict[str, Any]:
    """The body at the medians, and the acceleration of a point at rest on the ground at the site."""
    study, body, medians, effective = site.study, site.body, site.medians, site.acceleration
    built_in, heads = study.site.body in BUILT_IN_BODIES, site.has_heading
    partner = None if body.partner is None else body.partner.body.name
    return {
        "body": study.site.body if built_in else "mesh",
        "product_id": body_product(study),
        "mass_kg": body.mass,
        "bulk_density_kg_m3": body.density,
        "spin_period_s": body.spin_period,
        "kernels": _of_kernels(study),
        "extents_m": np.ptp(body.shape.vertices, axis=0).tolist(),
        "facet_count": len(body.shape.faces),
        "centroid_m": body.shape.centroid.tolist(),
        "partner": partner,
        "partner_distance_m": None if partner is None else float(body.orbit.distance),
        **{key: medians[key] for key in ("latitude_deg", "longitude_deg")},
        "heading_deg": medians["heading_deg"] if heads else None,
        "place_m": body.shape.surface_point(medians["latitude_deg"], medians["longitude_deg"]).tolist(),
        "effective_acceleration_outward": float(effective[2]),
        "effective_acceleration_along_heading": float(effective[0]) if heads else None,
        # In axes that do not turn, from the body alone.
        "escape_speed_m_s": site.escape_speed,
        "warning": site.warning,
        "gravity_warning": site.gravity_warning,
    }


def body_product(study: Study) -> str | None:
    """The product of an archive that the mesh of the body is, as its label has it."""
    return None if study.site.body in BUILT_IN_BODIES else product_id(labelled_mesh(Path(study.site.body)))


def _of_kernels(study: Study) -> dict[str, float] | None:
    """What was read from kernels, degrees and SI; None without any."""
    spin, place = kernel_spin(study.site), kernel_partner(study.site)
    if spin is None:
        return None
    table = {
        "spin_period_s": spin.period,
        "pole_right_ascension_deg": spin.pole_right_ascension_deg,
        "pole_declination_deg": spin.pole_declination_deg,
        "prime_meridian_deg": spin.prime_meridian_deg,
    }
    if place is None:
        return table
    return table | {
        "partner_longitude_deg": place.longitude_deg,
        "partner_latitude_deg": place.latitude_deg,
        "partner_distance_m": place.distance,
        "partner_period_s": place.period,
    }
