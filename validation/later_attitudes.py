"""Whether landers that have bounced come down in any attitude, as the emulator of touchdowns takes it.

    python validation/later_attitudes.py STUDY_FOLDER ...

reads finished studies of journeys of one long box, as validation/journey_seed_pairs.py makes them, and writes to
later_attitudes.json how upright the box's z axis is at all touchdowns but the first: the size of its component along
the normal is uniform from 0 to 1 where attitudes are uniform over rotations (Kolmogorov-Smirnov).
"""

import sys
from pathlib import Path

import numpy as np
from scipy import stats

from lithobrake.pipeline.design.lander_attitude import seen
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.study_folder import StudyFolder
from lithobrake.vocabulary.quantities import JOURNEY_DESIGN

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from harness import command_line, origin, write_document

RESULTS = Path(__file__).with_suffix(".json")


def upright(folder: Path) -> np.ndarray:
    """Size of the z axis along the normal at the later touchdowns of a study [touchdown_count]."""
    inputs = DesignRuns.load(StudyFolder(folder), JOURNEY_DESIGN).inputs
    found: np.ndarray = np.abs(seen(inputs)[0][:, 2])[inputs["touchdown"] > 0]
    return found


def main() -> None:
    studies = command_line(__doc__, "studies...").parse_args().studies
    values = np.concatenate([upright(folder) for folder in studies])
    found = {
        "studies": [folder.name for folder in studies],
        "touchdowns": len(values),
        "tenths": np.histogram(values, 10, (0.0, 1.0))[0].tolist(),
        "p": float(stats.kstest(values, "uniform").pvalue),
    }
    write_document(RESULTS, found | origin("validation/later_attitudes.py STUDY_FOLDER ..."))


if __name__ == "__main__":
    main()
