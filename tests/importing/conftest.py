"""A log to be changed, and where to write it."""

import pytest

from tests.importing.made import logged, turn


@pytest.fixture
def columns():
    return {name: values.copy() for name, values in logged(turn()).items()}


@pytest.fixture
def log(tmp_path):
    return tmp_path / "log.csv"
