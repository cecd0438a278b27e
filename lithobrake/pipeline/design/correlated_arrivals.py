"""First touchdowns whose speed, incidence or heading go together with each other, or with the place."""

import numpy as np

from lithobrake.pipeline.site import Site
from lithobrake.study import Study
from lithobrake.study.correlated_keys import correlated_keys, drawn_together
from lithobrake.study.journey_sections import PLACE_KEYS

Row = dict[str, float]


def arriving_together(study: Study, rows: list[Row], first: int) -> list[Row]:
    """Rows of journeys from number `first` on with what [delivery] correlates; where it lands the site draws."""
    keys = {key: f"impact.{key}" for key in correlated_keys(study) if key not in PLACE_KEYS}
    if not keys:
        return rows
    place = {key: values[first:] for key, values in Site(study).sampled_apart(first + len(rows)).items()}
    arrival = {key: np.array([row[dotted] for row in rows]) for key, dotted in keys.items()}
    found = drawn_together(study, place | arrival)
    return [
        row | {dotted: float(found[key][number]) for key, dotted in keys.items()} for number, row in enumerate(rows)
    ]
