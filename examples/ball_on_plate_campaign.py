"""The ball on a hard plate as a plain function: a campaign in Python, and an expansion of its results.

    python examples/ball_on_plate_campaign.py [FOLDER]

You can stop it at any time and start it again: finished runs are read from FOLDER/runs.sqlite.
"""

import math
import sys
from pathlib import Path
from typing import Any

from ball_on_plate import bounce

from lithobrake import campaign, chaos

INPUTS = {
    "incidence_deg": chaos.Uniform(20.0, 50.0),
    "restitution": chaos.Uniform(0.4, 0.8),
    "friction": chaos.Uniform(0.05, 0.4),
}
OUTPUTS = ["velocity_out_x", "velocity_out_z"]


def model(inputs: dict[str, float], seed: int) -> dict[str, Any]:
    """One run: numbers by name in, numbers by name out; the seed is for a model with chance in it."""
    incidence = math.radians(inputs["incidence_deg"])
    return bounce(0.15, incidence, inputs["restitution"], inputs["friction"], radius=0.05, spin=0.0, tilt=0.0)


def main(folder: Path) -> None:
    """Run the model on a sparse grid, fit, and say what matters."""
    folder.mkdir(parents=True, exist_ok=True)
    x = chaos.smolyak(INPUTS, level=3)
    with campaign.Ledger(folder / "runs.sqlite") as ledger:
        runs = campaign.run(model, x, names=list(INPUTS), ledger=ledger, context={"model": "ball on plate, 1"})
    print(f"{len(x)} runs, {runs.reused_count} of them known before")
    surrogate = chaos.fit(INPUTS, x, runs.outputs(OUTPUTS), degree=3, method="ols", output_names=OUTPUTS)
    print(f"{'total Sobol index of':<20} {'  '.join(OUTPUTS)}")
    for name, shares in zip(INPUTS, surrogate.sobol_total, strict=True):
        print(f"{name:<20} {'  '.join(f'{share:>14.3f}' for share in shares)}")


# Workers import this file, as it defines the model: only the first process may start the campaign.
if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "ball_on_plate"))
