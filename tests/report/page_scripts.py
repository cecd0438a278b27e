"""The scripts of the page run outside a browser, where node is installed."""

import json
import re
import shutil
import subprocess
from importlib.resources import files
from typing import Any

import pytest

NODE = shutil.which("node")
needs_node = pytest.mark.skipif(NODE is None, reason="no node on this machine, so no script runs alone")


def answer_of(scripts: tuple[str, ...], program: str, given: dict[str, Any]) -> Any:
    """What a program returns that has these scripts before it and `given` as an object."""
    text = "\n".join(files("lithobrake.report").joinpath(name).read_text("utf-8") for name in scripts)
    whole = (
        'globalThis.addEventListener ??= () => {}; const given = JSON.parse(require("fs").readFileSync(0, "utf8"));\n'
        f"process.stdout.write(JSON.stringify((() => {{ {text}\n{program} }})()));"
    )
    assert NODE is not None
    ended = subprocess.run(
        [NODE, "-e", whole], input=json.dumps(given), capture_output=True, text=True, check=False, timeout=120
    )
    assert ended.returncode == 0, ended.stderr
    return json.loads(ended.stdout)


def explorer_data(page: str, name: str = "explorer") -> dict[str, Any]:
    """What an explorer of a page is given."""
    text = re.search(rf'<script type="application/json" id="{name}-data">(.*?)</script>', page, flags=re.DOTALL)
    content: dict[str, Any] = json.loads(text[1])
    return content
