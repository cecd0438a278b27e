"""The folder of compiled kernels follows their sources."""

import os
import subprocess
import sys
from pathlib import Path

import lithobrake.compiled as compiled


def test_cache_folder_changes_with_any_source_of_the_part(tmp_path, monkeypatch):
    package = tmp_path / "package"
    (package / "dem").mkdir(parents=True)
    (package / "compiled.py").write_text("")
    callee = package / "dem" / "callee.py"
    callee.write_text("a = 1\n")
    monkeypatch.setattr(compiled, "__file__", str(package / "compiled.py"))
    compiled.cache_folder.cache_clear()
    before = compiled.cache_folder("dem")
    callee.write_text("a = 2\n")
    compiled.cache_folder.cache_clear()
    after = compiled.cache_folder("dem")
    compiled.cache_folder.cache_clear()
    assert isinstance(before, Path)
    assert before != after


TURN = """
import sys
import numpy as np
from lithobrake.compiled import announce
from lithobrake.dem.motion import write_rotations
announce("dem", "a kernel")
print("ready", flush=True)
sys.stdin.readline()
rotation = np.zeros((1, 3, 3))
write_rotations(np.array([[0.5, 0.5, -0.5, 0.5]]), rotation)
print(rotation.ravel().tolist())
"""


def test_processes_that_compile_at_once_do_no_harm(tmp_path):
    """Three start into an empty cache together, a fourth finds it filled: all with the same numbers, and told so."""
    environment = {**os.environ, "LITHOBRAKE_CACHE": str(tmp_path)}

    def process() -> subprocess.Popen[str]:
        return subprocess.Popen(
            [sys.executable, "-c", TURN], env=environment, text=True,
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        )  # fmt: skip

    together = [process() for _ in range(3)]
    for one in together:
        assert one.stdout is not None
        assert one.stdout.readline() == "ready\n"
    for one in together:
        assert one.stdin is not None
        one.stdin.write("go\n")
        one.stdin.flush()
    told = [one.communicate() for one in together]
    assert {out for out, _ in told} == {"[0.0, -1.0, 0.0, 0.0, 0.0, -1.0, 1.0, 0.0, 0.0]\n"}
    assert all("Compiling a kernel" in message for _, message in told)
    out, message = process().communicate("go\n")
    assert out == "ready\n" + told[0][0]
    assert "Compiling" not in message
