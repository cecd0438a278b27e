"""A command that is refused leaves nothing behind, and no number of its options is left unread where it is none."""

from pathlib import Path

import pytest

from ...command_line import lithobrake


@pytest.mark.parametrize(("words", "said"), [
    (["compare", "none", "other", "--out", "made"], "none holds no results of a study"),
    (["export", "none", "--to", "geojson", "--resolution", "nan"], "--resolution is nan; allowed: a finite number"),
    (["film", "none", "--seconds=-inf"], "--seconds is -inf; allowed: a finite number"),
    (["push", "none", "--speed", "0.1", "--speed-std", "inf"], "--speed-std is inf; allowed: a finite number"),
    (["run", "quick", "--out", "made", "--scheduler", "here"], "the address of the Dask scheduler is 'here'"),
])  # fmt: skip
def test_a_refused_command_makes_no_folder(
    words: list[str], said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    ended = lithobrake(*words)
    assert ended.returncode == 2
    assert said in ended.stderr
    assert list(tmp_path.iterdir()) == []
