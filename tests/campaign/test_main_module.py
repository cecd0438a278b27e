"""Scripts of a user's own, from which campaigns are started with and without a guard."""

import subprocess
import sys
from pathlib import Path

import pytest

from lithobrake.campaign.worker import MainModuleError, refuse_unreachable

# The model stands in a file of its own; what the script prints would come twice if a process imported it.
SCRIPT = """
print("started")
import numpy as np
import sums
from lithobrake import campaign

with campaign.Ledger("runs.sqlite") as ledger, campaign.LocalExecutor(2) as executor:
    runs = campaign.run(sums.model, np.ones((3, 2)), names=["a", "b"], ledger=ledger, executor=executor)
print(runs.outputs(["sum"]).ravel())
"""
OWN_MODEL = """
import numpy as np
from lithobrake import campaign

def model(inputs, seed):
    return {"sum": inputs["a"] + inputs["b"]}

def main():
    with campaign.Ledger("runs.sqlite") as ledger, campaign.LocalExecutor(1) as executor:
        runs = campaign.run(model, np.ones((3, 2)), names=["a", "b"], ledger=ledger, executor=executor)
    print(runs.outputs(["sum"]).ravel())

if __name__ == "__main__":
    main()
"""


def python(folder: Path, *words: str, given: str | None = None) -> subprocess.CompletedProcess[str]:
    """What Python says in a folder."""
    return subprocess.run(
        [sys.executable, *words], cwd=folder, input=given, capture_output=True, text=True, check=False
    )


@pytest.mark.parametrize("piped", [False, True])
def test_a_script_without_a_guard_starts_a_campaign_and_is_not_started_again(piped: bool, tmp_path: Path) -> None:
    (tmp_path / "sums.py").write_text("def model(inputs, seed):\n    return {'sum': inputs['a'] + inputs['b']}\n")
    (tmp_path / "script.py").write_text(SCRIPT)
    said = python(tmp_path, "-", given=SCRIPT) if piped else python(tmp_path, "script.py")
    assert (said.stderr, said.stdout) == ("", "started\n[2. 2. 2.]\n")


def test_a_model_of_a_guarded_script_is_found(tmp_path: Path) -> None:
    (tmp_path / "script.py").write_text(OWN_MODEL)
    assert python(tmp_path, "script.py").stdout == "[2. 2. 2.]\n"
    (tmp_path / "runs.sqlite").unlink()
    assert python(tmp_path, "-m", "script").stdout == "[2. 2. 2.]\n"


def test_a_model_of_a_piped_script_is_refused_in_one_sentence(tmp_path: Path) -> None:
    said = python(tmp_path, "-", given=OWN_MODEL)
    assert said.returncode == 1
    assert "MainModuleError: the model is defined in a notebook, an interactive session or a piped" in said.stderr
    assert said.stderr.count("Traceback") == 1


def test_words_like_those_of_a_script_are_no_part_of_it() -> None:
    import pickle

    # Nothing of these tests is a script that a process could import.
    refuse_unreachable(pickle.dumps("call it __main__"))
    with pytest.raises(MainModuleError, match="write it to a file, say"):
        refuse_unreachable(b"c__main__\nmodel\n.".replace(b"c__main__\nmodel\n", b"\x8c\x08__main__\x8c\x05model\x93"))
