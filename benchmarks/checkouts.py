"""A process that works with the package of one checkout: benchmarks hand it work in turn with that of another."""

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

Row = dict[str, Any]


class Checkout:
    """A process of a script, told by an option to work, that answers each line that comes in with one."""

    def __init__(self, folder: Path, script: str, option: str) -> None:
        environment = os.environ | {"PYTHONPATH": str(folder.resolve()), "OMP_NUM_THREADS": "1"}
        command = [sys.executable, str(Path(script).resolve()), option]
        self.process = subprocess.Popen(
            command, env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )

    def answer(self, one: Row) -> Row:
        """Do one piece of work."""
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        self.process.stdin.write(json.dumps(one) + "\n")
        self.process.stdin.flush()
        row: Row = json.loads(self.process.stdout.readline())
        return row
