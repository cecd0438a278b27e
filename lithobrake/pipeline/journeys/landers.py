"""The landers of a study under way: the ground that they meet, and how far they come from their aims."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.files.reading import hashed_seed
from lithobrake.geometry.attitude import angles, directions
from lithobrake.pipeline.design import arrivals
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.journeys.first_arrivals import Arrivals
from lithobrake.smallbody.landers import Landers, follow
from lithobrake.smallbody.touchdown import Touchdown, out_of_frame
from lithobrake.study.delivery_sections import MOST_TOUCHDOWNS
from lithobrake.vocabulary.array_types import Array, Integers
from lithobrake.vocabulary.outcomes import JourneyEnd
from lithobrake.vocabulary.quantities import IMPACT_INCIDENCE, IMPACT_SPEED

if TYPE_CHECKING:
    from lithobrake.smallbody import Body


def ways_from_aims(body: "Body", site: Mapping[str, np.ndarray], places: Array) -> Array:
    """Ways over the ground [m] from the aims of landers to places [m], [count, 3], as if the body were a ball.

    Of the radius at the aim; what the delivery misses the aim by counts. site: columns of SITE_KEYS, [count] each.
    """
    latitude, longitude = site["latitude_deg"], site["longitude_deg"]
    # All landers of an aim share its radius, which takes a search among the facets.
    aims, inverse = np.unique(np.column_stack([latitude, longitude]), axis=0, return_inverse=True)
    radius = np.linalg.norm(body.shape.surface_point(*aims.T), axis=1)
    there = directions(*body.shape.latitude_longitude(places))
    ways: Array = radius[inverse.ravel()] * angles(directions(latitude, longitude), there)
    return ways


def touchdown_uniforms(seed: int, journey: int, number: int) -> list[float]:
    """Uniform numbers of a touchdown: its impact point on the bed, its azimuth there, and the gradient of the ground.

    Five in every study, so that a given impact point or flat ground leaves the others as they are. They follow from
    journey and touchdown, so that more journeys change none.
    """
    return np.random.default_rng(hashed_seed(seed, "touchdowns", journey, number)).random(5).tolist()


@dataclass(kw_only=True)
class StudyLanders(Landers):
    """Landers of a study; begin: their first touchdowns."""

    design: DrawnDesign
    begin: Arrivals

    @classmethod
    def of(
        cls, design: DrawnDesign, begin: Arrivals, most: int | None = None, threads: int | None = None
    ) -> "StudyLanders":
        """Landers at their first touchdowns, followed for at most so many; None: as many as any lander has."""
        study, incidence = design.study, begin.column(IMPACT_INCIDENCE)
        facets = [row.get(arrivals.MEAN_INCIDENCE, one) for row, one in zip(begin.rows, incidence, strict=True)]
        landers = cls(
            design=design,
            begin=begin,
            body=design.site.body,
            duration=study.journey.duration,
            gravity=study.flight.gravity,
            most=most or MOST_TOUCHDOWNS,
            threads=threads,
            start=begin.clock,
            mass=begin.site["mass"],
            spin_period=begin.site["spin_period"],
            position=np.array(begin.origin),
            axes=np.array(begin.axes),
            speed=begin.column(IMPACT_SPEED),
            incidence_deg=incidence,
            mean_incidence_deg=np.array(facets),
            spin=out_of_frame(np.array(begin.axes), begin.spin),
        )
        landers.ground[:] = begin.ground
        return landers

    @property
    def ways_from_aims(self) -> Array:
        """Ways over the ground from the aim points [m], as if the body were a ball of the radius there; NaN of landers
        on the partner."""
        ways = ways_from_aims(self.body, self.begin.site, self.position)
        return np.where(self.ground == 0, ways, np.nan)

    def ground_met(self, down: Integers, velocity: Array, up: Array, incidence: Array) -> tuple[Array, Array]:
        """As of any landers; where the ground of the study is rough each touchdown has a gradient of its own."""
        study, journeys = self.design.study, self.begin.number[down].tolist()

        def gradients() -> np.ndarray:
            numbers = self.touchdowns[down].tolist()
            drawn = [touchdown_uniforms(study.seed, *one) for one in zip(journeys, numbers, strict=True)]
            return np.array(drawn).reshape(-1, 5)[:, 3:]

        return arrivals.met_ground(study, velocity, up, incidence, gradients)

    def inertia(self, lander: int) -> Array:
        """Inertia of a lander as the study has it [kg m2], [3, 3]."""
        return arrivals.lander_inertia(self.design.study, self.begin.rows[lander])

    def rest_rows(self, ways: Array) -> list[list[float | int | str]]:
        """REST_NUMBERS of each lander; the place of one that does not come to rest is "".

        ways: distance of each from its aim point [m], [count].
        """
        columns = (self.time, ways, self.latitude, self.longitude, self.touchdowns, self.path_length)
        rows = zip((self.end == JourneyEnd.AT_REST).tolist(), *(one.tolist() for one in columns), strict=True)
        return [row if rests else [row[0], "", "", "", *row[4:]] for rests, *row in rows]


def followed(job: Job, begin: Arrivals, touchdown: Touchdown, title: str) -> StudyLanders:
    """Landers of a study followed to their ends; title: of them, for progress."""
    landers = StudyLanders.of(job.design, begin, threads=getattr(job.executor, "worker_count", None))
    follow(landers, touchdown, lambda ended: job.progress(ended, len(landers), title))
    return landers
