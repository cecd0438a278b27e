"""Compiling ahead of a study leaves nothing to compile for its beds and landings."""

import os
import subprocess
import sys

# In a process of its own: elsewhere in this one other tests have called kernels.
SCRIPT = """
import sys
from types import SimpleNamespace
from lithobrake.compilation.compiled import Kernel
from lithobrake.dem import Box, Material
from lithobrake.pipeline.runs.kernels import compile_kernels
from lithobrake.touchdown import BedRecipe, GrainSizes, Lander, Landing, land, pour_bed

def called():
    modules = [module for name, module in sys.modules.items() if name.startswith("lithobrake.dem.")]
    kernels = {id(k): k for module in modules for k in vars(module).values() if isinstance(k, Kernel)}
    return sorted((kernel.__qualname__, str(form)) for kernel in kernels.values() for form in kernel.signatures)

shown = []
compile_kernels(SimpleNamespace(progress=lambda *what: shown.append(what)))
ahead = called()
rock = Material(density=2000.0, young_modulus=2e5, poisson_ratio=0.25, restitution=0.4, friction=0.5)
sizes = GrainSizes(distribution="constant", lower=0.1, upper=0.1)
bed = pour_bed(BedRecipe(
    grain_count=3, sizes=sizes, cloud_point_count=8, width=(0.3, 0.3), material=rock, gravity=(0.0, 0.0, -0.01),
    pour_gravity=0.1, seed=1,
))
fall = Landing(
    grain=rock, speed=0.1, incidence=0.1, azimuth=0.0, place=(0.0, 0.0), orientation=(1.0, 0.0, 0.0, 0.0),
    spin=(0.1, 0.0, 0.0), gravity=(0.0, 0.0, -0.01), time_limit=0.2,
)
land(bed, Lander(shape=Box((0.1, 0.1, 0.1)), mass=0.5, material=rock), fall)
print(len(ahead), [form for form in called() if form not in ahead], shown[0])
print(shown[-1], all(0 <= done <= total for done, total, *_ in shown))
"""

COLD = """
from types import SimpleNamespace
import lithobrake.pipeline.runs.kernels as kernels
from lithobrake.dem.stepping.time_loop import advance
kernels.available_cores = lambda: 2
shown = []
kernels.compile_kernels(SimpleNamespace(progress=lambda *what: shown.append(what)))
(form,) = advance.signatures
print("found" if advance.stats.cache_hits else "compiled here")
print(len({done for done, *_ in shown}))
print(all(detail == f"{done} of {total} kernels" for done, total, _, *details in shown for detail in details))
"""


def test_beds_and_landings_find_all_kernels_compiled():
    ended = subprocess.run([sys.executable, "-c", SCRIPT], capture_output=True, text=True, check=True)
    first, last = ended.stdout.splitlines()
    count, _, rest = first.partition(" ")
    assert int(count) > 0
    assert rest == "[] (0, 1, 'compiling kernels')"
    assert last == "(1, 1, 'compiling kernels') True"


def test_from_an_empty_cache_each_kernel_is_compiled_once_and_progress_moves(tmp_path):
    """On two cores a process of its own compiles a part of them, and the one that waits says alone what happens."""
    environment = {**os.environ, "LITHOBRAKE_CACHE": str(tmp_path)}
    ended = subprocess.run([sys.executable, "-c", COLD], env=environment, capture_output=True, text=True, check=True)
    made, moves, rest = ended.stdout.splitlines()
    assert made == "found"
    assert int(moves) > 50
    assert rest == "True"
    assert ended.stderr == ("Compiling the soft-surface engine for this processor, once: about half a minute.\n")
    names = [path.name.rpartition("-")[0] for path in tmp_path.glob("lithobrake/dem-*/dem.*")]
    assert len(names) == len(set(names)) > 8
