"""The folder of a study leaves what it did not make as it is."""

import os

import pytest

from lithobrake.pipeline.study_folder import StudyFolder


def test_a_file_that_is_named_as_a_probe_would_be_stays(tmp_path):
    (tmp_path / ".writable").write_text("a note of mine")
    StudyFolder(tmp_path)
    assert (tmp_path / ".writable").read_text() == "a note of mine"
    assert [path.name for path in tmp_path.iterdir()] == [".writable"]


@pytest.mark.skipif(os.name != "posix" or os.geteuid() == 0, reason="here every folder can be written")
def test_a_folder_that_cannot_be_written_is_refused(tmp_path):
    tmp_path.chmod(0o500)
    with pytest.raises(ValueError, match=r"cannot be written .*; choose another folder with --out"):
        StudyFolder(tmp_path)
