"""JUnit XML: a suite per trial and a test case per metric, as CI servers read it."""

from __future__ import annotations

import re
from pathlib import Path
from xml.etree import ElementTree as ET

from ...errors import OutputError, Problem
from ...files import cannot_write, refuse_existing
from ..result import CheckReport, Item
from .numbers import told

_ILLEGAL = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")

_BEGINS = re.compile(rb"(?:\xef\xbb\xbf)?\s*(?:<\?.*?\?>\s*|<!.*?>\s*)*<testsuites?[\s/>]", re.DOTALL)
_LOOKED_AT = 4096
"""Bytes in which a report says what it is."""


def render(report: CheckReport) -> str:
    """The document; characters XML cannot hold are replaced."""
    root = ET.Element("testsuites", name="mmgtune check")
    suites = {trial: [item for item in report.items if item.trial == trial] for trial in report.trial_ids}
    # Time is of the check as a whole: all trials are simulated together.
    share = report.wall_s / max(len(report.items), 1)
    for trial, items in suites.items():
        failed = sum(item.status == "regressed" for item in items)
        errors = sum(item.status == "not comparable" for item in items)
        skipped = sum(item.status == "not shown" for item in items)
        suite = _suite(root, trial, len(items), failed, errors, skipped, share * len(items))
        for item in items:
            _case(suite, item, share)
    if report.problems:
        suite = _suite(root, report.profile or "mmgtune check", len(report.problems), 0, len(report.problems), 0, 0.0)
        for k, problem in enumerate(report.problems, 1):
            case = ET.SubElement(suite, "testcase", classname="mmgtune.check", name=f"problem {k}", time="0.000")
            error = ET.SubElement(case, "error", message=_clean(problem.what), type="could not run")
            error.text = _clean(str(problem))
    ET.indent(root)
    return '<?xml version="1.0" encoding="utf-8"?>\n' + ET.tostring(root, encoding="unicode") + "\n"


def refuse_other(path: Path) -> None:
    """Raises OutputError where a report is to go to what is there and is none: an older report may be replaced."""
    refuse_existing([path], overwrite=True)
    try:
        with path.open("rb") as file:
            begins = file.read(_LOOKED_AT)
    except OSError as error:
        if path.exists():
            raise cannot_write(path, error) from error
        return
    if begins.strip() and not _BEGINS.match(begins):
        why = "what is there is no JUnit report, and would be lost"
        raise OutputError(Problem("the output exists already", str(path), why, "give another name"))


def _suite(
    root: ET.Element, name: str, tests: int, failures: int, errors: int, skipped: int, seconds: float
) -> ET.Element:
    counts = {"tests": tests, "failures": failures, "errors": errors, "skipped": skipped}
    return ET.SubElement(
        root,
        "testsuite",
        {"name": _clean(name), **{key: str(count) for key, count in counts.items()}, "time": f"{seconds:.3f}"},
    )


def _case(suite: ET.Element, item: Item, seconds: float) -> None:
    case = ET.SubElement(
        suite,
        "testcase",
        classname=_clean(f"mmgtune.check.{item.trial}"),
        name=_clean(item.words),
        time=f"{seconds:.3f}",
    )
    tag = {"regressed": "failure", "not comparable": "error", "not shown": "skipped"}.get(item.status)
    if tag:
        found = ET.SubElement(case, tag, message=_clean(told(item)))
        if tag != "skipped":
            found.set("type", item.status)
            found.text = _clean(f"{item.trial}: {item.words}: {told(item)}")
    elif item.status == "improved":
        ET.SubElement(case, "system-out").text = _clean(f"better: {told(item)}")


def _clean(text: str) -> str:
    return _ILLEGAL.sub("�", text)
