"""The number of threads of the linear algebra libraries changes no bit, and is left as it was."""

import os
import subprocess
import sys

from threadpoolctl import threadpool_info

from lithobrake.chaos.training import one_thread

SCRIPT = """
import hashlib, sys
import numpy as np
from lithobrake.chaos import Uniform, d_optimal, fit, gradient, sobol_sequence
inputs = {name: Uniform(0.0, 1.0) for name in "abcde"}
x = sobol_sequence(inputs, 300)
y = np.column_stack([np.minimum(x[:, 0], x[:, 1]) + x[:, 2] * x[:, 3], np.sin(x @ np.arange(5.0))])
digest = hashlib.sha256()
one = fit(inputs, x, y[:, 0], method="gaussian_process")
for surrogate in (one, fit(inputs, x, y, degree=4), fit(inputs, x[:120], y[:120], method="omp", degree=4)):
    digest.update(surrogate.coefficients.tobytes() + surrogate(x).tobytes() + gradient(surrogate, x).tobytes())
digest.update(d_optimal(inputs, 60, degree=3).tobytes())
print(digest.hexdigest())
"""


def test_same_bits_on_one_thread_and_on_four() -> None:
    names = ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS")

    def bits(count: str) -> str:
        environment = {**os.environ, **dict.fromkeys(names, count)}
        command = [sys.executable, "-c", SCRIPT]
        return subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout

    assert bits("1") == bits("4")


def test_the_number_of_threads_comes_back() -> None:
    before = [(entry["filepath"], entry["num_threads"]) for entry in threadpool_info()]
    with one_thread():
        assert all(entry["num_threads"] == 1 for entry in threadpool_info())
    known = dict(before)
    assert all(entry["num_threads"] == known.get(entry["filepath"], 1) for entry in threadpool_info())
