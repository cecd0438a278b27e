"""How many landings will leave a walled bed laterally, and how many journeys will have an unknown outcome.

Told from landings that were made, by the angle of their impact; nothing of the soil of a study enters.
"""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from lithobrake.touchdown import Lander, Landing

# Incidence from the normal [deg], and share of the landings that left the bed laterally: 1 of 64 and 57 of 112 with the
# recipe of scenarios/quick.toml (0.7 m wide, a box with a bounding radius of 0.13 m) at 15 and 75 deg,
# two thirds of its impacts above 80 deg; 23 of 870 of scenarios/mission.toml and efficient.toml (2.4 m, 0.22 m) at
# 30 deg. scenarios/aim.toml, over 0 to 88 deg, lost 66 of 300; this table gives 24 %.
MEASURED = ((15.0, 1 / 64), (30.0, 23 / 870), (75.0, 57 / 112), (85.0, 2 / 3))
# Half the width of the bed over the bounding radius of the lander, in those at 75 deg and above.
MEASURED_ROOM = 2.6
# Below this angle [deg] landings are lost near where they come down, whatever the width of the bed.
STEEP = 30.0
# Least and largest share of journeys on soil with an unknown outcome in studies whose speed and incidence reach over
# all impacts to come: 60 to 70 % of 2000 on beds of 2.2 and 1.3 m, 78 % of 4000 on beds of 0.7 m.
UNKNOWN_JOURNEYS = (0.60, 0.78)


def expected_loss(landings: "Sequence[tuple[Lander, Landing]]", width: float) -> float:
    """Share of these landings that will leave a bed of this width [m] laterally, interpolated between MEASURED.

    What is lost beyond the share of steep landings falls with the width of the bed over the size of the lander.
    """
    angles, lost = np.array(MEASURED).T
    incidence = np.array([np.degrees(one.incidence) for _, one in landings])
    room = np.array([0.5 * width / lander.shape.bounding_radius for lander, _ in landings])
    shares = np.interp(incidence, angles, lost)
    steep = np.minimum(shares, np.interp(STEEP, angles, lost))
    return float(np.mean(steep + (shares - steep) * np.minimum(1.0, MEASURED_ROOM / room)))
