"""What commands print.  Text that came from files steers no terminal and no log of a CI server."""

from __future__ import annotations

import json
import re
import sys
from typing import Any

from ..displayed import inert

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


def print_json(document: dict[str, Any]) -> None:
    """One JSON document on stdout."""
    show(json.dumps(document, indent=1, allow_nan=False, ensure_ascii=False))
