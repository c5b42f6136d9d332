"""Rendered reports, made once for all tests of this folder."""

from __future__ import annotations

from pathlib import Path

import pytest

from mmgtune.report import render

from . import fake_run, more_runs


@pytest.fixture(scope="session")
def fit_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A rendered run folder of a good fit."""
    folder = fake_run.make_fit(tmp_path_factory.mktemp("fit") / "run")
    render(folder, pdf=True)
    return folder


@pytest.fixture(scope="session")
def sweep_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A rendered sweep whose runs have no folders of their own but one."""
    folder = fake_run.make_sweep(tmp_path_factory.mktemp("sweep") / "run", runs=False)
    fake_run.make_fit(folder / "ar_0.5", 0.5)
    render(folder)
    return folder


@pytest.fixture(scope="session")
def voyages_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A rendered run folder of two models on voyages."""
    folder = fake_run.make_voyages(tmp_path_factory.mktemp("voyages") / "run")
    render(folder)
    return folder


@pytest.fixture(scope="session")
def more(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Rendered run folders of all other kinds, by name."""
    found = more_runs.make(tmp_path_factory.mktemp("more"))
    for folder in found.values():
        render(folder)
    return found


@pytest.fixture(scope="session")
def page(fit_folder: Path) -> str:
    """The HTML of the fit's report."""
    return read(fit_folder)


def read(folder: Path) -> str:
    """The page of a report."""
    return (folder / "report.html").read_text(encoding="utf-8")
