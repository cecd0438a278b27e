"""A small finished study of each method and its page, made once for all tests of the page."""

from pathlib import Path

import pytest

from lithobrake.report import write_report
from lithobrake.results import open_study
from lithobrake.results.page_data import DrawnPage, PaperPage, page_results

from .finished_studies import drawn_study, paper_study


@pytest.fixture(scope="session")
def study_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A finished study by the paper's method, with its page."""
    folder = tmp_path_factory.mktemp("paper") / "study"
    paper_study(folder)
    write_report(folder)
    return folder


@pytest.fixture(scope="session")
def sequence_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A finished drawn study of 96 landings on 12 beds, with its page."""
    folder = tmp_path_factory.mktemp("drawn") / "study"
    drawn_study(folder)
    write_report(folder)
    return folder


@pytest.fixture(scope="session")
def paper_page(study_folder: Path) -> str:
    return (study_folder / "report" / "index.html").read_text(encoding="utf-8")


@pytest.fixture(scope="session")
def drawn_page(sequence_folder: Path) -> str:
    return (sequence_folder / "report" / "index.html").read_text(encoding="utf-8")


@pytest.fixture(scope="session")
def paper(study_folder: Path) -> PaperPage:
    found = page_results(open_study(study_folder))
    assert isinstance(found, PaperPage)
    return found


@pytest.fixture(scope="session")
def drawn(sequence_folder: Path) -> DrawnPage:
    found = page_results(open_study(sequence_folder))
    assert isinstance(found, DrawnPage)
    return found
