"""What a restitution that falls with speed changes: the question of the quick study under each law of restitution.

    python validation/restitution_laws.py [--laws LAW ...] [--work FOLDER]

COUNT landers each, on the same beds. constant: as shipped; yields: a weak carbonaceous rock, whose yield strength is
reduced along with the modulus (docs/what_the_model_leaves_out.md); viscoelastic: the restitutions of the study hold at
the mean speed of delivery. Writes restitution_laws.csv, a line for each law as it ends; what stands there is not done
again.
"""

import tempfile
from pathlib import Path

# It lets harness.py be found.
from fine_ground import found
from harness import SCENARIOS, Row, add_row, command_line, read_rows, study_tables

import lithobrake

LAWS = {"constant": {}, "yields": {"yield_strength": 7.2e3}, "viscoelastic": {"restitution_speed": 0.055}}
COUNT = 96
TABLE = Path(__file__).with_suffix(".csv")


def tables(law: str) -> Row:
    """The study under a law."""
    return study_tables(
        SCENARIOS / "quick.toml", {"journey": {"count": COUNT, "emulated_count": 0}, "grain": LAWS[law]}
    )


def main() -> None:
    work = Path(tempfile.gettempdir()) / "lithobrake_restitution_laws"
    given = command_line(__doc__, laws=list(LAWS), work=work).parse_args()
    done = {row["law"] for row in read_rows(TABLE, {"law": str})}
    for law in given.laws:
        if law not in done:
            study = lithobrake.run(tables(law), given.work / law, workers=1, report=False)
            add_row(TABLE, {"law": law, "landers": COUNT, **found(study)}, 4)


if __name__ == "__main__":
    main()
