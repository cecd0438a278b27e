"""Compiling ahead of a study leaves nothing to compile for its beds, landings and flights."""

import hashlib
import os
import shutil
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from lithobrake.campaign import LocalExecutor
from lithobrake.compilation.compiled import disk_cache
from lithobrake.files.atomic import atomic_path
from lithobrake.pipeline.runs import beds

QUICK = Path(__file__).parents[3] / "scenarios" / "first_bounce.toml"

# In a process of its own: elsewhere in this one other tests have called kernels.
SCRIPT = """
import sys
from lithobrake.compilation.compiled import Kernel
from lithobrake.dem import Box, Material
from lithobrake.pipeline.runs.beds import compile_kernels
from lithobrake.touchdown import BedRecipe, GrainSizes, Lander, Landing, land, pour_bed

def called():
    modules = [module for name, module in sys.modules.items() if name.startswith("lithobrake.dem.")]
    kernels = {id(k): k for module in modules for k in vars(module).values() if isinstance(k, Kernel)}
    return sorted((kernel.__qualname__, str(form)) for kernel in kernels.values() for form in kernel.signatures)

shown = []
compile_kernels(lambda *what: shown.append(what))
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
import lithobrake.pipeline.runs.beds as kernels
from lithobrake.dem.local_stepping.local_steps import advance_locally
from lithobrake.dem.stepping.time_loop import advance
kernels.available_cores = lambda: 2
shown = []
kernels.compile_kernels(lambda *what: shown.append(what))
(form,) = advance.signatures
(local,) = advance_locally.signatures
assert str(local[2]) == "none", "nothing is joined, and what joints call was compiled"
print("found" if advance.stats.cache_hits else "compiled here")
print(len({done for done, *_ in shown}))
print(all(detail == f"{done} of {total} kernels" for done, total, _, *details in shown for detail in details))
"""

FLYING = """
import sys
from pathlib import Path
from dataclasses import replace
import numpy as np
from lithobrake.compilation.compiled import Kernel
from lithobrake.pipeline.runs.beds import fly_briefly
from lithobrake.pipeline.site import Site
from lithobrake.smallbody import fly
from lithobrake.smallbody.sliding import OnGround, slide
from lithobrake.study import read_study

def called():
    modules = [module for name, module in sys.modules.items() if name.startswith("lithobrake.smallbody.")]
    kernels = {id(k): k for module in modules for k in vars(module).values() if isinstance(k, Kernel)}
    return sorted((kernel.__qualname__, str(form)) for kernel in kernels.values() for form in kernel.signatures)

study = read_study(Path(sys.argv[1]))
fly_briefly(study)
ahead = called()
site = Site(study)
origin, axes = site.frames(site.columns(3))
velocity = 0.01 * axes[:, 2]
fly(replace(site.body, partner=None), origin, velocity, 60.0, gravity="table", threads=2).jacobi_drift
# Over the equator the ground of this body holds nothing.
body, one = site.body, np.ones(3)
place = np.tile(body.shape.surface_point(60.0, 0.0), (3, 1))
ground = OnGround(body, body.shape.nearest(place)[1], one, body.mass * one, body.spin_period * one, 0.0 * one)
ends = slide(ground, place, 0.01 * axes[:, 0], 3600.0 * one)
print(len(ahead), [form for form in called() if form not in ahead], ends.time.max() > 0.0)
"""


def keep(cache: Path) -> None:
    """Take what was compiled over to this user's kernels where it is missing: a fresh machine compiles it once then."""
    kept = disk_cache("dem").folder
    for path in cache.glob("lithobrake/dem-*/dem.*"):
        if kept is not None and path.parent.name == kept.name and not (kept / path.name).exists():
            with atomic_path(kept / path.name) as draft:
                shutil.copy2(path, draft)


def note_name() -> str:
    """Under which this user's kernels, which are of the same sources of engine and compiler, have a note that all of
    them were compiled from an empty cache by the same code and by this test.
    """
    sources = b"".join(Path(file).read_bytes() for file in (beds.__file__, __file__))
    return f"from_empty-{hashlib.sha256(sources).hexdigest()[:16]}"


def compiled(**environment: str) -> tuple[list[str], str]:
    """What a process prints and says that compiles all kernels ahead."""
    told = os.environ | environment
    ended = subprocess.run([sys.executable, "-c", COLD], env=told, capture_output=True, text=True, check=True)
    return ended.stdout.splitlines(), ended.stderr


def test_from_an_empty_cache_each_kernel_is_compiled_once_and_progress_moves(tmp_path):
    """On two cores two processes compile, and the one that waits for them says alone what happens.

    That takes a minute. Where it has been seen of these very sources, the same process finds all of them.
    """
    known = disk_cache("dem").read(note_name())
    if known is None:
        (made, moves, rest), said = compiled(LITHOBRAKE_CACHE=str(tmp_path))
        assert int(moves) > 20
        assert said == "Compiling the soft-surface engine for this processor, once: about half a minute.\n"
        files = [path.name for path in tmp_path.glob("lithobrake/dem-*/dem.*")]
        names = [file.rpartition("-")[0] for file in files]
        assert len(names) == len(set(names)) == 8
        keep(tmp_path)
        disk_cache("dem").write(note_name(), "\n".join(files).encode())
    else:
        (made, moves, rest), said = compiled()
        assert (said, int(moves)) == ("", 2)
        assert all(disk_cache("dem").has(name) for name in known.decode().splitlines())
    assert made == "found"
    assert rest == "True"


def test_beds_and_landings_find_all_kernels_compiled():
    ended = subprocess.run([sys.executable, "-c", SCRIPT], capture_output=True, text=True, check=True)
    first, last = ended.stdout.splitlines()
    count, _, rest = first.partition(" ")
    assert int(count) > 0
    assert rest == "[] (0, 1, 'compiling kernels')"
    assert last == "(1, 1, 'compiling kernels') True"


def test_flights_and_journeys_find_all_kernels_compiled():
    ended = subprocess.run([sys.executable, "-c", FLYING, str(QUICK)], capture_output=True, text=True, check=True)
    count, _, rest = ended.stdout.strip().partition(" ")
    assert int(count) > 0
    assert rest == "[] True"


@pytest.mark.parametrize(("workers", "on_disk", "calls"), [(2, False, 1), (2, True, 0), (1, False, 0)])
def test_one_of_several_workers_compiles_flights_that_are_not_on_disk(monkeypatch, workers, on_disk, calls):
    asked = []
    monkeypatch.setattr("lithobrake.compilation.compiled.lies_on_disk", lambda kernel: on_disk)
    monkeypatch.setattr(LocalExecutor, "submit", lambda self, *call: asked.append(call[1:]))
    with LocalExecutor(workers) as executor:
        assert beds.compile_flights(SimpleNamespace(executor=executor, study="the study")) == calls
    assert asked == [(beds.fly_briefly, "the study")] * calls
