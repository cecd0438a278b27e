"""Score the forecast against what happened: the logarithmic score, in bits.

    python validation/forecast_hera/score.py LANDER --end at_rest [--time-min 35] [--contacts 4] ...

For each thing that was observed: -log2 of the probability that a forecast gave to the bin in which it lies; smaller is
better. Beside the forecast stand that of hard ground and, as one who knows nothing, equal probabilities of all bins.
The bins are those of forecast.json; what is not known is left out. Scores of one lander add up as if its bins were
independent, which they are not: compare forecasts, do not test them. Write a side or a number that begins with a minus
behind an equals sign: --face=-z --latitude-deg=-12. The forecast is that of the first edition, or of --edition DATE.
"""

import argparse
import math
import sys
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[1]))
sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))

import numpy as np
from answers import FIRST_EDITION, FORECAST
from branches import LANDERS
from harness import read_document
from samples import BINS, ENDS, FACES, cells

EDITIONS = FIRST_EDITION.parent


def forecast_of(edition: str) -> dict[str, Any]:
    """The forecast of an edition, by its date."""
    path = EDITIONS / edition / FORECAST
    if not path.exists():
        dates = ", ".join(sorted(one.parent.name for one in EDITIONS.glob(f"*/{FORECAST}")))
        raise SystemExit(f"--edition is {edition}; allowed: {dates}; name one")
    return read_document(path)


def observed_bins(options: argparse.Namespace) -> dict[str, int]:
    """The bin of each thing that was observed."""
    if (options.latitude_deg is None) != (options.longitude_deg is None):
        raise SystemExit("--latitude-deg and --longitude-deg are one place; give both, or neither")
    found = {"end": ENDS.index(options.end)}
    for name, edges in BINS.items():
        value = getattr(options, name)
        if value is not None:
            if not edges[0] <= value < math.inf:
                raise SystemExit(f"--{name.replace('_', '-')} is {value:g}; allowed: at least {edges[0]:g}")
            found[name] = int(np.searchsorted(edges, value, side="right") - 1)
    if options.latitude_deg is not None:
        if not abs(options.latitude_deg) <= 90.0 or not abs(options.longitude_deg) <= 360.0:
            raise SystemExit(
                f"--latitude-deg is {options.latitude_deg:g} and --longitude-deg {options.longitude_deg:g}; allowed: "
                "-90 to 90, and -360 to 360, eastward"
            )
        place = np.array([options.latitude_deg]), np.array([options.longitude_deg])
        found["cell"] = int(cells(*place)[0])
    if options.face is not None:
        found["face"] = FACES.index(options.face)
    return found


def scores(forecast: dict[str, list[float]], bins: dict[str, int]) -> dict[str, float]:
    """Bits that each observation costs a forecast, of those that it answers."""
    return {name: -math.log2(forecast[name][number]) for name, number in bins.items() if name in forecast}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("lander", choices=LANDERS)
    parser.add_argument("--end", choices=ENDS, required=True)
    for name in (*BINS, "latitude_deg", "longitude_deg"):
        parser.add_argument(f"--{name.replace('_', '-')}", type=float, default=None)
    parser.add_argument("--face", choices=FACES)
    parser.add_argument("--edition", default=FIRST_EDITION.name)
    options = parser.parse_args()
    document = forecast_of(options.edition)
    bins, of = observed_bins(options), document["landers"][options.lander]
    soil, hard = (scores(of[ground]["scored"], bins) for ground in ("soil", "hard"))
    print(f"{'bits':20}{'forecast':>10}{'hard ground':>13}{'even':>8}")
    for name in bins:
        even = math.log2(len(of["soil"]["scored"][name]))
        beside = f"{hard[name]:13.2f}" if name in hard else f"{'-':>13}"
        print(f"{name:20}{soil[name]:10.2f}{beside}{even:8.2f}")


if __name__ == "__main__":
    main()
