"""What commands print.  Text that came from files steers no terminal and no log of a CI server."""

from __future__ import annotations

import json
import os
import re
import shutil
import sys
from collections.abc import Sequence
from typing import Any

from .. import text_tables
from ..displayed import inert

WIDE = 1000
"""Letters in a line where there is no terminal: as many as there are."""

_AZURE = re.compile(r"##(?=(?:vso|teamcity)?\[)")
_GITHUB = re.compile(r"(?m)^(\s*):(?=:)")
"""Beginnings of what servers take for a command in a log: anywhere in a line, and before all else in it."""


def harmless(text: str, commands: bool = False) -> str:
    r"""A text with what could steer a terminal written as ``\u001b``, as JSON does; so it is JSON still if it was.

    commands  whether lines that GitHub takes for commands are meant as such
    """
    text = inert(text)
    text = _AZURE.sub(r"#\\u0023", text)
    return text if commands else _GITHUB.sub(r"\1\\u003a", text)


def show(text: str = "", end: str = "\n", commands: bool = False) -> None:
    """Text on stdout: the result."""
    print(harmless(text, commands), end=end)


def say(text: str) -> None:
    """A line for people, on stderr: stdout is data."""
    print(harmless(text), file=sys.stderr, flush=True)


def width() -> int:
    """Letters in a line of the terminal; more where stdout goes elsewhere."""
    return shutil.get_terminal_size((WIDE, 24)).columns


def limit_width() -> None:
    """Have no line longer than ``WIDE`` because COLUMNS says so: the help is filled up to it with spaces."""
    told = os.environ.get("COLUMNS", "")
    if told.isdecimal() and len(told) >= len(str(WIDE)):
        os.environ["COLUMNS"] = str(WIDE)


def table(head: Sequence[str], rows: Sequence[Sequence[str]], *, less: int = 0, **how: Any) -> list[str]:
    """Lines of a table that fits the terminal, less some letters; ``how`` as for ``text_tables.table``."""
    return text_tables.table(head, rows, width=width() - less, **how)


def filled(parts: Sequence[str], start: str) -> list[str]:
    """Parts side by side in as many lines as they need, each of which begins with ``start``."""
    lines = [start + parts[0]] if parts else []
    for part in parts[1:]:
        if len(lines[-1]) + 3 + len(part) <= width():
            lines[-1] += f"   {part}"
        else:
            lines.append(start + part)
    return lines


def print_json(document: dict[str, Any]) -> None:
    """One JSON document on stdout."""
    show(json.dumps(document, indent=1, allow_nan=False, ensure_ascii=False))
