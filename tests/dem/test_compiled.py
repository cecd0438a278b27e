"""The folder of compiled kernels follows their sources."""

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
