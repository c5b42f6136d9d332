"""How long tests take on one core with kernels compiled, as ``make times`` measured and wrote it to times.json.

By test, and by file for what a fixture of the whole file takes, since any of its tests may be the first.
"""

from __future__ import annotations

import json
from collections import defaultdict
from pathlib import Path

import pytest

SLOW = 0.05
"""Seconds from which a test is slow, and listed."""

FILE = Path(__file__).with_name("times.json")


def read() -> dict[str, float]:
    """Seconds by test and by file; what is not listed is quick, or new."""
    found: dict[str, float] = json.loads(FILE.read_text()) if FILE.exists() else {}
    return found


def file_of(name: str) -> str:
    """The file of a test."""
    return name.partition("::")[0]


def beginning(taken: dict[str, float], place: str) -> float:
    """What fixtures took longest that are of a file, or of files in a folder."""
    return max((seconds for name, seconds in taken.items() if "::" not in name and name.startswith(place)), default=0.0)


class Writer:
    """Listens to a whole run and writes what took long."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = defaultdict(float)

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Once for the setup of a test, for the test and for what follows; workers add ``@group`` to its name."""
        head, bracket, tail = report.nodeid.rpartition("]")
        name = head + bracket + tail.partition("@")[0]
        if report.when == "setup":
            name = file_of(name)
            self.seconds[name] = max(self.seconds[name], report.duration)
        else:
            self.seconds[name] += report.duration

    def pytest_sessionfinish(self) -> None:
        """Sorted by name, so that changes are read easily."""
        listed = {name: round(s, 2) for name, s in sorted(self.seconds.items()) if s >= SLOW}
        FILE.write_text(json.dumps(listed, indent=0, ensure_ascii=False) + "\n")
