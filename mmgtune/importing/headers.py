"""Names of columns as logs print them, and the units in them."""

from __future__ import annotations

import re
from collections.abc import Sequence

from ..units import canonical

_UNIT = re.compile(r"^(.*?)\s*(?:\[([^\[\]]+)\]|\(([^()]+)\))\s*$")


def unit_in(header: str) -> str | None:
    """The unit in a header such as "u_velo [m/s]" or "speed (kn)"; None where it has none."""
    match = _UNIT.match(header)
    return canonical(match.group(2) or match.group(3)) if match else None


def bare(header: str) -> str:
    """A header without its unit."""
    match = _UNIT.match(header)
    return (match.group(1) if match else header).strip()


def find_column(wanted: str | int, names: Sequence[str]) -> int | None:
    """Position of a column by number (from 1), by name, or by its name without unit or case; None if not there."""
    if isinstance(wanted, int):
        return wanted - 1 if wanted <= len(names) else None
    for same in (str.strip, bare, lambda name: bare(name).lower()):
        found = [k for k, name in enumerate(names) if same(name) == same(wanted)]
        if len(found) == 1:
            return found[0]
        if found:
            return None
    return None
