"""The impact of [Dosta-2024] by MercuryDPM: builds its driver from a checkout, runs it, and writes the ball's height.

    python validation/nine_codes/mercury_impact.py --checkout MercuryDPM --work FOLDER --out FOLDER

checkout: of a MercuryDPM repository with Drivers/Papers/OSBenchmark. Writes impact_mercury.csv, height of the ball's
centre [m] and its speed against time [s], and mercury.csv, the run in a line. With --output FILE the run was made
before, and FILE is what it printed.

The driver OSPenetration is changed in four things. Its loops over the lines of a file end where the file ends. Cells of
the contact search fit both sizes of spheres, and spheres are numbered by place: both are for speed. The time step is
4e-6 s while the ball falls freely, 1e-6 s from 20.5 ms on, 3e-6 s from 30 ms, 4e-6 s from 50 ms. It prints the ball's
place every 0.25 ms.
"""

import itertools
import subprocess
import sys
from pathlib import Path

import numpy as np
from impact_bed import published_positions

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from harness import add_row, command_line, origin, read_rows, write_document, write_rows

HERE = Path(__file__).parent
FOLDER = Path("Drivers") / "Papers" / "OSBenchmark"
FLAGS = ("-O3", "-DNDEBUG", "-flto", "-w", "-std=c++17")
ALONE = ("SpeciesHandler.cc",)
NOT_NEEDED = (
    "ParabolaChute.cc", "SpeciesHandler.cc", "Chute.cc", "ChuteBottom.cc", "ChuteWithHopper.cc", "CurvyChute.cc",
    "ClusterGenerator.cc", "MercuryProb.cc",
)  # fmt: skip
FOLDERS = (
    ".", "Boundaries", "CG", "FMM", "Math", "Mixins", "Particles", "Strings", "VTKWriter", "Walls", "Interactions",
    "Species", "Nurbs", "Tools", "Controllers", "Helpers",
)  # fmt: skip
STAGES = ((0.0, 4e-6), (0.0205, 1e-6), (0.03, 3e-6), (0.05, 4e-6))
LOOK = 2.5e-4  # s
# s: the driver begins with this step, whatever the first stage has, so that places are those of that much later.
FIRST = 5e-7
# What is changed in the driver: what stands there, and what does instead.
CHANGES = (
    ("file >> rad >> pos)", "file >> rad && file >> pos.X >> pos.Y >> pos.Z)"),
    ("file >> a >> b >> c)", "file >> a.X >> a.Y >> a.Z >> b.X >> b.Y >> b.Z >> c.X >> c.Y >> c.Z)"),
    ("// turn on gravity", "setHGridDistribution(HGridDistribution::USER); setHGridMaxLevels(2);"),
    ("// Write requested output", "{own}\n// Write requested output"),
)


def driver_of(checkout: Path) -> str:
    """Return the text of the changed driver."""
    text = (checkout / FOLDER / "OSPenetration.cpp").read_text(encoding="utf-8")
    steps = f"{STAGES[-1][1]}"
    for (_, step), (end, _) in reversed(list(itertools.pairwise(STAGES))):
        steps = f"now < {end} ? {step} : {steps}"
    own = (HERE / "penetration.cpp").read_text(encoding="utf-8")
    own = own.replace("STEPS", steps).replace("LOOK", f"{LOOK}")
    for old, new in CHANGES:
        if old not in text:
            raise ValueError(f"OSPenetration.cpp of {checkout} has no {old!r}: give the checkout of commit fb0ebf1d")
        text = text.replace(old, new.replace("{own}", own), 1)
    return "#include <ctime>\n#include <iomanip>\n" + text


def build(checkout: Path, work: Path) -> Path:
    """Compile kernel and driver, a file of the kernel's folder at a time, and return the program."""
    kernel, objects = checkout / "Kernel", []
    settings = (checkout / "Configuration" / "CMakeDefinitions.h").read_text(encoding="utf-8")
    lines = ["#if 0" if line.startswith("#if @") else line for line in settings.splitlines()]
    (work / "CMakeDefinitions.h").write_text("\n".join(lines) + "\n", encoding="utf-8")
    sources = {"driver": driver_of(checkout), "settings": (checkout / "Configuration/CMakeDefinitions.cc").read_text()}
    # Linear algebra of other shapes of particles: named by the kernel, called by nothing here.
    names = ("dgemm_", "dgemv_", "dgesv_")
    sources["absent"] = "#include <cstdlib>\n" + "".join(f'extern "C" void {name}() {{ abort(); }}\n' for name in names)
    for folder in FOLDERS:
        found = kernel.glob("*.cc") if folder == "." else (kernel / folder).rglob("*.cc")
        files = [file for file in sorted(found) if file.name not in NOT_NEEDED]
        sources[f"kernel_{folder}"] = "".join(f'#include "{file.resolve()}"\n' for file in files)
    sources |= {name: f'#include "{(kernel / name).resolve()}"\n' for name in ALONE}
    include = ["-I", str(work), "-I", str(kernel), "-I", str(checkout / FOLDER)]
    for name, text in sources.items():
        source = work / f"{name}.cpp"
        source.write_text(text, encoding="utf-8")
        objects.append(str(source.with_suffix(".o")))
        subprocess.run(["g++", *FLAGS, *include, "-c", str(source), "-o", objects[-1]], check=True)
    subprocess.run(["g++", *FLAGS, *objects, "-o", str(work / "impact")], check=True)
    return work / "impact"


def place_files(checkout: Path, work: Path) -> None:
    """Put positions, by place, and walls where the driver reads them."""
    theirs, ours = checkout / FOLDER / "Penetration", work / "Penetration"
    ours.mkdir(exist_ok=True)
    (ours / "walls.txt").write_bytes((theirs / "walls.txt").read_bytes())
    places = published_positions(theirs / "25KParticles.txt")
    order = np.lexsort(np.floor((places - places.min(axis=0)) / 0.008).T)
    lines = [" ".join(f"{value:.10g}" for value in (0.001, *place)) for place in places[order]]
    # The driver drops the last line.
    (ours / "25KParticles.txt").write_text("radius x y z\n" + "\n".join([*lines, "1 0 0 0"]) + "\n", encoding="ascii")


def main() -> None:
    parser = command_line(__doc__, checkout=Path("."), work=Path("mercury_work"), out=HERE, output=Path())
    options = parser.parse_args()
    output = options.output
    if output == Path():
        options.work.mkdir(parents=True, exist_ok=True)
        program, output = build(options.checkout, options.work).resolve(), options.work / "printed.txt"
        place_files(options.checkout, options.work)
        with output.open("w") as file:
            subprocess.run(["nice", "-n", "10", str(program)], cwd=options.work, stdout=file, check=True)
    rows = [
        line.split() for line in output.read_text().splitlines() if line.startswith("row ") and len(line.split()) == 12
    ]
    curve = [{"time": f"{float(row[1]) + FIRST:.7g}", "z": row[4], "v_z": row[7]} for row in rows]
    write_rows(options.out / "impact_mercury.csv", ("time", "z", "v_z"), curve)
    table = options.out / "mercury.csv"
    if not read_rows(table, {"run": str}):
        add_row(table, {"run": "mercury", "until": float(curve[-1]["time"]), "cpu_s": float(rows[-1][11])}, digits=7)
    write_document(table.with_suffix(".json"), {"stages": STAGES} | origin("validation/nine_codes/mercury_impact.py"))


if __name__ == "__main__":
    main()
