"""The sites that each run flies from: 64, spread evenly over all that is uncertain of the site."""

import math

import numpy as np

from lithobrake.files.hashing import hashed_seed
from lithobrake.pipeline.site import SITE_KEYS, Site
from lithobrake.study.correlated_keys import drawn_together

# Flights of each run. In equal steps of the heading so many leave nothing to gain from more.
FLIGHT_COUNT = 64
# Numbers of a site in the order of their powers: those that matter most fill their plane best.
FIRST = ("heading_deg", "partner_longitude_deg")
LATTICE = (*FIRST, *(key for key in SITE_KEYS if key not in FIRST))


def run_sites(site: Site, run_count: int, flight_count: int = FLIGHT_COUNT) -> dict[str, np.ndarray]:
    """Sites of the flights of runs by the keys of SITE_KEYS, each [run_count, flight_count].

    Each uncertain number goes through its law in equal steps from a random first one of the run, the heading in order,
    the others so that together they fill all that may be evenly (a lattice of powers of one generator): a share of
    these flights hardly scatters. More runs change no earlier site.
    """
    sites, laws = site.columns((run_count, flight_count)), site.distributions
    generator = _generator(flight_count)
    for run in range(run_count):
        random = np.random.Generator(np.random.PCG64(hashed_seed(site.study.seed, "flights of runs", run)))
        # All keys take their random numbers, whether uncertain or not, so that one more leaves the others as they were.
        for key in SITE_KEYS:
            first = random.random()
            if key in laws:
                steps = np.arange(flight_count) * pow(generator, LATTICE.index(key), flight_count)
                share = (steps / flight_count + first) % 1.0
                # Half a unit in the last place off the ends, where an unbounded law is infinite.
                sites[key][run] = laws[key].ppf(np.clip(share, 2.0**-54, 1.0 - 2.0**-53))
    together = drawn_together(site.study, {key: values.ravel() for key, values in sites.items()})
    return {key: values.reshape(run_count, flight_count) for key, values in together.items()}


def _generator(count: int) -> int:
    """The number next to the golden section of a count that has no divisor with it."""
    golden = 0.5 * (math.sqrt(5.0) - 1.0) * count
    return min((one for one in range(1, count + 1) if math.gcd(one, count) == 1), key=lambda one: abs(one - golden))
