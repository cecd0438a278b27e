"""Published numbers of slopes and potentials, and the tolerances of their comparison, set before any of it was run.

Source: [Kanjanatarayont-2026], repository praponkan/shape-based-surface-gravity, paper4/README.md and
paper4/results/all_results.json (there: CORRECTED_after_centrifugal_signfix), data under CC BY 4.0, read at 5a7fc34.
"""

from typing import NamedTuple

# Of a mean slope and of the spread of the potential, relative: meshes and facet counts differ from the published ones.
WITHIN = 0.05
# Of facet by facet against another code on the same mesh: what the source has for Ryugu.
CORRELATION, RMS_DEG, CLOSE_DEG, CLOSE_SHARE = 0.9989, 0.48, 2.0, 0.999


class Published(NamedTuple):
    """One number of the source.

    body      key of the mesh it is compared with. density [kg/m3] and period [h] as there
    measure   column of slopes.csv. facets: of the mesh of the source
    """

    words: str
    body: str
    density: float
    period_h: float
    measure: str
    value: float
    facets: int


BENNU_PERIOD = 4.296061
PUBLISHED = (
    Published("Bennu, mean slope, 850 kg/m3 [deg]", "bennu", 850.0, BENNU_PERIOD, "mean_deg", 25.55, 30_561),
    Published("Bennu, mean slope, 1150 kg/m3 [deg]", "bennu", 1150.0, BENNU_PERIOD, "mean_deg", 16.06, 30_561),
    Published(
        "Bennu, below 20 deg of latitude, 1194 kg/m3 [deg]", "bennu", 1194.0, BENNU_PERIOD, "equator_deg", 11.19, 30_561
    ),
    Published(
        "Bennu, above 60 deg of latitude, 1194 kg/m3 [deg]", "bennu", 1194.0, BENNU_PERIOD, "pole_deg", 17.81, 30_561
    ),
    Published("Eros, mean slope by area [deg]", "eros", 2670.0, 5.27, "area_mean_deg", 13.263, 36_030),
    Published("Eros, spread of the potential over its mean", "eros", 2670.0, 5.27, "potential_spread", 0.03413, 36_030),
    Published("Itokawa, mean slope by area [deg]", "itokawa", 1950.0, 12.132, "area_mean_deg", 16.727, 41_369),
    Published(
        "Itokawa, spread of the potential over its mean", "itokawa", 1950.0, 12.132, "potential_spread", 0.08608, 41_369
    ),
)  # fmt: skip
