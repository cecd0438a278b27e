"""Small finished studies and their pages, made once for all tests of the page."""

from collections.abc import Callable
from pathlib import Path

import pytest

from lithobrake.report import write_report
from lithobrake.results import open_study
from lithobrake.results.page_data import PageData, page_results

from ..quick_studies import blank_pictures, quick_studies
from ..shared_folders import shared_folder
from .finished_studies import asked_study, first_study, paper_study


def finished(factory: pytest.TempPathFactory, study: Callable[[Path], None]) -> Path:
    """The folder of a study with its page, whose PNG files are blank."""

    def make(folder: Path) -> None:
        with quick_studies(), blank_pictures("png"):
            study(folder)
            write_report(folder)

    return shared_folder(factory, study.__name__, make)


def html(folder: Path) -> str:
    return (folder / "report" / "index.html").read_text(encoding="utf-8")


@pytest.fixture(scope="session")
def paper_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Expansions of the first touchdown alone: no lander is drawn."""
    return finished(tmp_path_factory, paper_study)


@pytest.fixture(scope="session")
def first_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """First touchdowns of 96 landers on 12 beds, and samples of their emulator."""
    return finished(tmp_path_factory, first_study)


@pytest.fixture(scope="session")
def asked_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """48 landers that are followed to rest, and all else that can be asked."""
    return finished(tmp_path_factory, asked_study)


@pytest.fixture(scope="session")
def paper_page(paper_folder: Path) -> str:
    return html(paper_folder)


@pytest.fixture(scope="session")
def first_page(first_folder: Path) -> str:
    return html(first_folder)


@pytest.fixture(scope="session")
def asked_page(asked_folder: Path) -> str:
    return html(asked_folder)


@pytest.fixture(scope="session")
def paper(paper_folder: Path) -> PageData:
    return page_results(open_study(paper_folder))


@pytest.fixture(scope="session")
def first(first_folder: Path) -> PageData:
    return page_results(open_study(first_folder))


@pytest.fixture(scope="session")
def asked(asked_folder: Path) -> PageData:
    return page_results(open_study(asked_folder))
