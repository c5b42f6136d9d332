"""A check's report for those who read it: a terminal, a machine, a CI server, a pull request.

A further format is one file here with a function ``render``, and one word in ``options.FORMATS``.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib import import_module

from ...options import FORMATS

RENDERERS: Mapping[str, Callable[..., str]] = {name: import_module(f".{name}", __name__).render for name in FORMATS}
"""Functions from a ``CheckReport`` to text, by the name of the format."""
