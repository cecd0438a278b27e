"""Hashes of the package's own code."""

import pytest

from lithobrake.files.reading import source_hash


def test_each_part_of_the_code_has_a_hash_of_its_own() -> None:
    assert source_hash("files") != source_hash("files/reading.py") != source_hash("vocabulary")


def test_a_part_that_there_is_not_is_refused() -> None:
    with pytest.raises(ValueError, match=r"outputs\.py"):
        source_hash("files", "outputs.py")
