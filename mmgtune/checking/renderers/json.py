"""One JSON document, for machines."""

from __future__ import annotations

import json

from ..result import CheckReport


def render(report: CheckReport) -> str:
    """The document, with a line break at its end."""
    return json.dumps(report.to_dict(), indent=1, ensure_ascii=False, allow_nan=False) + "\n"
