"""A Dask cluster on this machine: a scheduler and workers, each a process of its own."""

import contextlib
import os
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path


class Cluster:
    """Processes of a cluster that are ended with the test."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.processes = folder, dict[str, subprocess.Popen[bytes]]()
        self._has_nannies = False
        here = [str(Path(__file__).parent), str(Path(__file__).parents[2]), os.environ.get("PYTHONPATH", "")]
        self.environment = os.environ | {"PYTHONPATH": os.pathsep.join(here)}
        self.start("scheduler", "--host", "127.0.0.1", "--port", "0")
        self.address = self.said("scheduler", "Scheduler at:").split("Scheduler at:")[1].split()[0]

    def start(self, name: str, *arguments: str) -> None:
        kind = "scheduler" if name == "scheduler" else "worker"
        command = [sys.executable, "-m", f"distributed.cli.dask_{kind}", *arguments, "--no-dashboard"]
        with (self.folder / f"{name}.txt").open("wb") as log:
            self.processes[name] = subprocess.Popen(
                command, stdout=log, stderr=log, cwd=self.folder, env=self.environment
            )

    def add_worker(self, name: str, nanny: bool = False) -> None:
        self.start(name, self.address, "--nthreads", "1", "--nanny" if nanny else "--no-nanny", "--name", name)
        self.said(name, "Registered to:")

    def workers(self, count: int, nannies: bool = False) -> list["subprocess.Popen[bytes]"]:
        """So many workers, those that live still and new ones; none of the other kind, with or without a nanny."""
        if nannies != self._has_nannies:
            for worker in self._living():
                worker.terminate()
                worker.wait()
            self._has_nannies = nannies
        for number in range(len(self.processes), len(self.processes) + count - len(self._living())):
            self.add_worker(f"worker_{number}", nannies)
        return self._living()

    def _living(self) -> list["subprocess.Popen[bytes]"]:
        return [one for name, one in self.processes.items() if name != "scheduler" and one.poll() is None]

    def said(self, name: str, words: str) -> str:
        """The line of a log that has these words, once it is there."""
        limit = time.monotonic() + 60
        while time.monotonic() < limit:
            for line in (self.folder / f"{name}.txt").read_text().splitlines():
                if words in line:
                    return line
            time.sleep(0.05)
        raise AssertionError((self.folder / f"{name}.txt").read_text())


@contextlib.contextmanager
def cluster(folder: Path) -> Iterator[Cluster]:
    made = Cluster(folder)
    try:
        yield made
    finally:
        for process in made.processes.values():
            process.kill()
            process.wait()
