"""What is kept with every figure: when, where, beside what other work and by which command it was measured."""

import os
import platform
import sys
import time
from typing import Any


def origin(command: str) -> dict[str, Any]:
    """Return date, machine, mean load of the last minute, and a command that begins with the path of its script."""
    return {
        "date": time.strftime("%Y-%m-%d"), "machine": f"{platform.machine()}, {sys.platform}",
        "load": os.getloadavg()[0], "command": f"python {command}",
    }  # fmt: skip
