"""From bounce to bounce until the landers rest, at the study's aim and at others, on soil and on hard ground."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from lithobrake.analysis import sample_inputs
from lithobrake.files.reading import hashed_seed
from lithobrake.geometry.attitude import angles, directions
from lithobrake.pipeline.design.arrivals import roughness
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.first_bounces import bounce_laws
from lithobrake.pipeline.first_bounces.bounce_laws import (
    RESTITUTION_FILE,
    emulator_bounce,
    hard_ground_only,
    restitution_table,
    slow_arrivals,
    why_no_soil,
)
from lithobrake.pipeline.first_bounces.emulator import REFIT_COUNT, drawn_samples
from lithobrake.pipeline.flights import write_table
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.samples import CAPTURED, VELOCITY, Samples, sampling_seed, touchdown_values
from lithobrake.pipeline.site import Site
from lithobrake.study import Study
from lithobrake.vocabulary.file_names import AIM_FILE, ARCS_FILE, REST_FILE, REST_NOTES_FILE
from lithobrake.vocabulary.outcomes import JourneyStatus
from lithobrake.vocabulary.quantities import AIM_COLUMNS, ARC, SPIN_OUT

if TYPE_CHECKING:
    from lithobrake.smallbody import Arcs, Body, Bounce, HardSurface, Impacts, Journeys, Rebounds

    # Spin after the first impact [rad/s], [sample_count, 3], and the bounce of what follows.
    Soil = tuple[np.ndarray, Bounce]

# docs/flights.md says what each is.
COLUMNS = (
    "ground", "sample", "status", "time_s", "latitude_deg", "longitude_deg", "rebounds", "path_length",
    "slid_length", "slid_time_s", "impact_speed", "impact_incidence_deg",
)  # fmt: skip
FILES = (REST_FILE, ARCS_FILE, REST_NOTES_FILE)
# Statuses of landers that lie on, or have just touched, the ground of the body.
DOWN = (
    *(JourneyStatus.SETTLED, JourneyStatus.LOFTED, JourneyStatus.OUTSIDE, JourneyStatus.SLIDING),
    JourneyStatus.BOUNCING,
)
SITE = "site."


def arc_rows(arcs: "Arcs", samples: np.ndarray) -> list[list[Any]]:
    """A row of arcs.csv for each arc, in the columns of outputs.ARC.

    samples: of all landers of the journeys, ascending, [lander_count].
    """
    # Arcs come lander by lander, so each one's number counts from where its lander first stands.
    number = np.arange(len(arcs.lander)) - np.searchsorted(arcs.lander, arcs.lander)
    columns = (
        *(samples[arcs.lander], number, arcs.begin, arcs.end, arcs.clock),
        *(*arcs.position.T, *arcs.velocity.T, arcs.mass, arcs.spin_period),
    )
    return [list(row) for row in zip(*(column.tolist() for column in columns), strict=True)]


def rest_files(study: Study) -> list[str]:
    """What the stage writes; the table of restitution where the emulator knows other impacts than the first."""
    asks = study.design.method == "drawn" and why_no_soil(study) is None and bool(study.rest.count)
    return [*FILES, *([RESTITUTION_FILE] if asks else [])]


def journey_dependencies(study: Study) -> dict[str, Any]:
    """What journeys depend on beside samples and flights; a table with other columns or law is made anew."""
    # The measured line is no key of the study: a better measurement has to outdate the journeys, too.
    law = bounce_laws.INTERCEPT, bounce_laws.SLOPE
    own = study.rest.model_dump(exclude={"arc_count"}, exclude_none=True)
    return own | {"columns": COLUMNS, "sliding_law": law}


def rest_dependencies(study: Study) -> dict[str, Any]:
    return journey_dependencies(study) | {"arc_count": study.rest.arc_count, "arc_columns": tuple(ARC)}


def follow_samples(job: Job) -> None:
    follow(job, "drawn", emulated_soil)


def follow(job: Job, design: str, soil: "Callable[[Job, Samples], Soil]") -> None:
    """Follow the first samples from bounce to bounce and write rest.csv, arcs.csv and rest.json.

    design: the runs in which all inputs vary. soil: what the model that was fitted to them says of these samples.
    """
    study, why = job.study, why_no_soil(job.study)
    rows: list[list[Any]] = []
    arcs: list[list[Any]] = []
    if study.rest.count:
        samples = Samples.load(job.folder).first(study.rest.count)
        sites = Sites.of(job.site, samples, job.site.sampled(len(samples.outcome)))
        if why is None:
            first, bounce = on_soil(job, samples, soil)
            journeys = sites.journeys(job, "soil", first, bounce, study.rest.arc_count)
            rows += sites.rows("soil", first, journeys)
            arcs = arc_rows(journeys.arcs, np.flatnonzero(~first.outside))
        else:
            job.say(hard_ground_only(why))
        rows += sites.follow(job, "hard", *on_hard_ground(study, sites))
        if RESTITUTION_FILE in rest_files(study):
            rows += sites.follow(job, "equivalent", *_on_equivalent_ground(job, sites))
    write_table(job.folder, REST_FILE, COLUMNS, rows)
    write_table(job.folder, ARCS_FILE, tuple(ARC), arcs, ARC)
    ranges = DesignRuns.load(job.folder, design).ranges(job.design.inputs)
    job.folder.write_json(REST_NOTES_FILE, {"why_no_soil": why, "trained_ranges": ranges})


def hard_surface(study: Study) -> "HardSurface":
    from lithobrake.smallbody import HardSurface

    return HardSurface(**study.rest.model_dump(exclude={"count", "duration", "arc_count", "rolling_friction"}))


def first_velocity(samples: Samples) -> np.ndarray:
    """Velocity after the first impact [m/s], [sample_count, 3]; the runs do not tell that of a captured lander."""
    velocity = np.column_stack([samples.output(name) for name in VELOCITY])
    # The velocity of a captured lander is not among the outputs; it is bounded to millimetres a second.
    velocity[samples.outcome == CAPTURED] = 0.0
    return velocity


def emulated_soil(job: Job, samples: Samples) -> "Soil":
    spin = np.column_stack([samples.output(name) for name in SPIN_OUT])
    return spin, emulator_bounce(job, samples)


def on_soil(
    job: Job, samples: Samples, soil: "Callable[[Job, Samples], Soil]" = emulated_soil
) -> tuple["Rebounds", "Bounce"]:
    from lithobrake.smallbody import Rebounds

    spin, bounce = soil(job, samples)
    first = Rebounds(first_velocity(samples), spin, samples.outcome == CAPTURED, ~samples.known)
    return first, on_rough(job.study, slow_arrivals(job.design, samples, bounce))


def sliding_friction(design: DrawnDesign, samples: Samples, ground: str) -> np.ndarray:
    """Friction under each sample once it is captured, [sample_count]: on soil that of hull and grain, or their law."""
    from lithobrake.dem.law.restitution import pair_value

    study = design.study
    rest, rule, hull = study.rest, study.contact.pair_rule, "grain" if study.lander.friction is None else "lander"
    if rest.rolling_friction is not None or ground == "hard":
        fixed = rest.friction if rest.rolling_friction is None else rest.rolling_friction
        return np.full(len(samples.outcome), fixed)
    of_grain, of_hull = (
        touchdown_values(study, samples.input_names, samples.inputs, f"{part}.friction").tolist()
        for part in ("grain", hull)
    )
    of_contacts = np.array([pair_value(one, other, rule) for one, other in zip(of_grain, of_hull, strict=True)])
    return bounce_laws.effective_friction(of_contacts) if bounce_laws.has_measured_size(design) else of_contacts


def on_hard_ground(study: Study, sites: "Sites") -> tuple["Rebounds", "Bounce"]:
    bounce = on_rough(study, hard_surface(study))
    random = np.random.default_rng(sampling_seed(study, "hard ground"))
    return bounce(_first_impacts(study, sites), random), bounce


def on_rough(study: Study, bounce: "Bounce") -> "Bounce":
    from lithobrake.smallbody import RoughGround

    return RoughGround(bounce, roughness(study)) if study.site.roughness_deg else bounce


def _on_equivalent_ground(job: Job, sites: "Sites") -> tuple["Rebounds", "Bounce"]:
    study = job.study
    table = restitution_table(study, Samples.load(job.folder), DesignRuns.load(job.folder, "drawn"))
    table.save(job.folder / RESTITUTION_FILE)
    random, bounce = np.random.default_rng(sampling_seed(study, "equivalent ground")), on_rough(study, table)
    return bounce(_first_impacts(study, sites), random), bounce


def _first_impacts(study: Study, sites: "Sites") -> "Impacts":
    from lithobrake.smallbody import Impacts

    samples = sites.samples
    speed, incidence_deg, *spin = (
        touchdown_values(study, samples.input_names, samples.inputs, f"impact.{name}")
        for name in ("speed", "incidence_deg", "spin_x", "spin_y", "spin_z")
    )
    lander = np.arange(len(samples.outcome))
    return Impacts(speed, np.radians(incidence_deg), np.column_stack(spin), sites.effective_acceleration, lander)


@dataclass(frozen=True)
class Sites:
    """Where and when each of some samples touches down, all arrays [sample_count, ...].

    origin [m] and axes, in rows, of the local frames, body-fixed; clock: time there [s], as of `fly`;
    effective_acceleration: along the outward normal [m/s2]; site: the numbers of SITE_KEYS.
    """

    body: "Body"
    samples: Samples
    site: dict[str, np.ndarray]
    origin: np.ndarray
    axes: np.ndarray
    clock: np.ndarray
    effective_acceleration: np.ndarray

    @classmethod
    def of(cls, centre: Site, samples: Samples, site: dict[str, np.ndarray]) -> "Sites":
        """Those of samples of a study at these places, by the keys of SITE_KEYS [sample_count]."""
        body = centre.body
        origin, axes = centre.frames(site)
        clock = centre.clock(site)
        felt = body.effective_acceleration(origin, mass=site["mass"], spin_period=site["spin_period"], time=clock)
        return cls(body, samples, site, origin, axes, clock, np.einsum("ni,ni->n", felt, axes[:, 2]))

    def follow(self, job: Job, ground: str, first: "Rebounds", bounce: "Bounce") -> list[list[Any]]:
        """A row of rest.csv for each sample, in their order: from how it leaves the first impact to where it ends."""
        return self.rows(ground, first, self.journeys(job, ground, first, bounce))

    def journeys(self, job: Job, ground: str, first: "Rebounds", bounce: "Bounce", arc_count: int = 0) -> "Journeys":
        """Those of the samples of which `first` knows how they leave the first impact, in their order.

        arc_count: of how many samples, the first ones, the flights are noted.
        """
        from lithobrake.smallbody import Launch, hop

        going = np.flatnonzero(~first.outside)
        site = {key: values[going] for key, values in self.site.items()}
        velocity, spin = (np.einsum("nij,ni->nj", self.axes[going], v[going]) for v in (first.velocity, first.spin))
        time, captured = self.clock[going], first.captured[going]
        launch = Launch(self.origin[going], velocity, spin, time, captured, site["mass"], site["spin_period"])
        return hop(
            *(self.body, launch, bounce, job.study.rest.duration),
            friction=sliding_friction(job.design, self.samples, ground)[going],
            rolls=job.study.rest.rolling_friction is not None,
            gravity=job.study.flight.gravity,
            # Samples are counted among all, the landers of hop among those that go on.
            arc_landers=int(np.searchsorted(going, arc_count)),
            seed=sampling_seed(job.study, f"rest on {ground} ground"),
            threads=getattr(job.executor, "worker_count", None),
            progress=lambda done: job.progress(round(done * len(going)), len(going), f"bounces, {ground} ground"),
        )

    def rows(self, ground: str, first: "Rebounds", ends: "Journeys") -> list[list[Any]]:
        latitude, longitude = (one.tolist() for one in self.body.shape.latitude_longitude(self.origin))
        rows: list[list[Any]] = [
            [ground, sample, JourneyStatus.OUTSIDE.value, 0.0, *place, 0, 0.0, 0.0, 0.0, "", ""]
            for sample, place in enumerate(zip(latitude, longitude, strict=True))
        ]
        for row, sample in enumerate(np.flatnonzero(~first.outside).tolist()):
            rows[sample] = [ground, sample, *_end(ends, row, bounced=not first.captured[sample])]
        return rows


def _end(ends: "Journeys", row: int, *, bounced: bool) -> list[Any]:
    """Where one journey ends, in the columns from the status on; bounced: it left the first impact."""
    end, speed = str(ends.status[row]), float(ends.impact_speed[row])
    place = [float(ends.latitude[row]), float(ends.longitude[row])] if end in DOWN else ["", ""]
    last = ["", ""] if np.isnan(speed) else [speed, float(np.degrees(ends.incidence[row]))]
    ways = [float(one[row]) for one in (ends.path_length, ends.slid_length, ends.slid_time)]
    # The journey began with the first rebound, which is counted here.
    return [end, float(ends.time[row]), *place, int(ends.bounce_count[row]) + bounced, *ways, *last]


def aim_files(study: Study) -> list[str]:
    """What the stage writes: nothing where the study has no aims to choose from."""
    return [AIM_FILE] if study.aim.names else []


def aim_dependencies(study: Study) -> dict[str, Any]:
    # Which aims are allowed is asked of what is already there.
    return {"rest": journey_dependencies(study), "grid": study.aim.grid, "lander_count": study.aim.lander_count}


def follow_aims(job: Job) -> None:
    """Follow the landers of every aim on both grounds and write aim.csv, one aim after the other.

    All aims have the same landers: soil, site and refit of each are drawn once, and only what is aimed at differs.
    """
    study, aims = job.study, job.study.aim.aims()
    count = study.aim.lander_count * REFIT_COUNT
    inputs, site = _aimed(job, aims, count)
    samples = drawn_samples(job, inputs, "aims")
    sites = Sites.of(job.site, samples, site)
    rows: list[list[Any]] = []
    for ground, bounce in (("soil", on_soil(job, samples)), ("hard", on_hard_ground(study, sites))):
        ends = sites.follow(job, ground, *bounce)
        distance = _distances(sites.body, site, ends)
        for number, (end, way) in enumerate(zip(ends, distance.tolist(), strict=True)):
            _, _, status, time, *_ = end
            settled = status == JourneyStatus.SETTLED
            rows.append([ground, number // count, number % REFIT_COUNT, status, time, way if settled else ""])
    write_table(job.folder, AIM_FILE, AIM_COLUMNS, rows)


def _aimed(job: Job, aims: list[dict[str, float]], count: int) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Inputs [aim_count * count, input_count] and sites of all landers, one aim after the other."""
    names = list(job.design.inputs)
    x = np.tile(sample_inputs(job.design.inputs, count, hashed_seed(job.study.seed, "aims")), (len(aims), 1))
    site = {key: np.tile(values, len(aims)) for key, values in job.site.sampled(count).items()}
    for number, aim in enumerate(aims):
        own = slice(number * count, (number + 1) * count)
        for name, value in aim.items():
            if name.startswith(SITE):
                site[name.removeprefix(SITE)][own] = value
            else:
                x[own, names.index(name)] = value
    return x, site


def _distances(body: "Body", site: dict[str, np.ndarray], ends: list[list[Any]]) -> np.ndarray:
    """Ways over the ground [m] from the aims to where the journeys end, [count], NaN where that is not on the ground.

    As if the body were a ball of the radius at the aim; what the delivery misses the aim by counts.
    """
    place = np.array([[np.nan, np.nan] if end[4] == "" else end[4:6] for end in ends], dtype=float)
    return ways_from_aims(body, site, directions(*place.T))


def ways_from_aims(body: "Body", site: Mapping[str, np.ndarray], there: np.ndarray) -> np.ndarray:
    """Ways over the ground [m] from the aims of landers to directions [count, 3], [count], as if the body were a ball.

    Of the radius at the aim. site: columns of SITE_KEYS, [count] each.
    """
    latitude, longitude = site["latitude_deg"], site["longitude_deg"]
    # All landers of an aim share its radius, which takes a search among the facets.
    aims, inverse = np.unique(np.column_stack([latitude, longitude]), axis=0, return_inverse=True)
    radius = np.linalg.norm(body.shape.surface_point(*aims.T), axis=1)
    ways: np.ndarray = radius[inverse.ravel()] * angles(directions(latitude, longitude), there)
    return ways
