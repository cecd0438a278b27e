"""Measured numbers of the documents are those of committed files, or of the scripts that write them."""

import runpy
from pathlib import Path

import pytest
from blocks import PAGES, ROOT
from sources import agrees, numbers_of, wrong


@pytest.mark.parametrize(
    "page", [one for one in PAGES if "<!-- numbers:" in one.read_text("utf-8")], ids=lambda one: one.name
)
def test_numbers_are_those_of_the_files_that_are_named(page: Path) -> None:
    assert wrong(page.read_text(encoding="utf-8")) == []


def test_the_table_of_times_is_what_its_script_makes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(ROOT / "benchmarks"))
    script = runpy.run_path(str(ROOT / "benchmarks" / "write_times.py"))
    page = (ROOT / "docs" / "performance.md").read_text(encoding="utf-8")
    assert page == script["page"](), "make it again with: python benchmarks/write_times.py"


def test_the_tables_of_what_is_left_out_are_those_of_their_script(capsys: pytest.CaptureFixture[str]) -> None:
    runpy.run_path(str(ROOT / "validation" / "experiments" / "left_out.py"), run_name="__main__")
    rows = [line.strip() for line in capsys.readouterr().out.splitlines() if line.startswith("|")]
    page = (ROOT / "docs" / "what_the_model_leaves_out.md").read_text(encoding="utf-8").splitlines()
    assert len(rows) > 20
    assert [row for row in rows if row not in page] == []


@pytest.mark.parametrize(
    ("shown", "value", "same"),
    [
        ("0.71", 0.7149, True), ("0.71", 0.7151, False), ("5300", 5349.0, True), ("5300", 5351.0, False),
        ("240", 240, True), ("240", 241, False), ("2.5e4", 25_400.0, True), ("2.5e4", 25_600.0, False),
        ("-3", -3.4, True), ("100", 99.9, True), ("13", 13.8, False), ("100", 91.0, False), ("0", 0.6, False),
        ("20000", 20_342.0, True), ("150", 146.2, True), ("150", 144.0, False), ("20", 20.6, False),
    ],
)  # fmt: skip
def test_a_value_agrees_to_the_digits_that_are_shown(shown: str, value: float, same: bool) -> None:
    assert agrees(shown, value) is same


def test_numbers_of_a_text_are_found_with_signs_ranges_and_thousands() -> None:
    text = "| `held_speed` 0.03 | 10 800 grains | -2 to +1.5e3 | 97-99.7 % | $n^2$ | [Zhu-2023] | x2 | 6U |"
    assert numbers_of(text) == ["0.03", "10800", "-2", "+1.5e3", "97", "99.7"]


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ("ends.at_rest.count, 240", ["line 5: 98, not 236"]),
        ("100 * ends.at_rest.share", ["line 5: 2 numbers ['98', '240'] and 1 values [98.1532492744241]"]),
        ("[[...], 240]", []),
    ],
)
def test_a_number_that_is_not_in_its_file_is_found(values: str, said: list[str]) -> None:
    ends = 'ends = kept("showcase/mission/summary.json").results.ends'
    assert wrong(f"First 7.\n\n- Of 5.\n- At rest: 98 of 240.\n  <!-- numbers:\n  {ends}\n  {values}\n  -->") == said
