"""A check's report for those who read it: a terminal, a machine, a CI server, a pull request."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping

from ..result import CheckReport
from .github import github
from .junit import junit
from .markdown import markdown
from .text import text


def as_json(report: CheckReport) -> str:
    """One JSON document."""
    return json.dumps(report.to_dict(), indent=1, ensure_ascii=False, allow_nan=False) + "\n"


RENDERERS: Mapping[str, Callable[[CheckReport], str]] = {
    "text": text,
    "json": as_json,
    "junit": junit,
    "github": github,
    "markdown": markdown,
}
"""Functions from a report to text, by the name of the format."""

__all__ = ["RENDERERS", "as_json", "github", "junit", "markdown", "text"]
