"""A log to be changed, and where to write it."""

import pytest

from tests.importing.made import imported, logged, turn, write_csv


@pytest.fixture
def columns():
    return {name: values.copy() for name, values in logged(turn()).items()}


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    """The trial that the columns make."""
    return imported(write_csv(tmp_path_factory.mktemp("plain") / "log.csv", logged(turn())))


@pytest.fixture
def log(tmp_path):
    return tmp_path / "log.csv"
