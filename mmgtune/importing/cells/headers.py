"""Names of columns as logs print them, and the units in them."""

from __future__ import annotations

import re
from collections.abc import Sequence

from ...units import canonical, name_and_unit

BRACKETS = (("[", "]"), ("(", ")"))
"""What logs write units in."""


def unit_in(header: str) -> str | None:
    """The unit in a header such as "u_velo [m/s]" or "speed (kn)"; None where it has none."""
    unit = name_and_unit(header, BRACKETS)[1]
    return canonical(unit) if unit else None


PERCENT = "%"
"""What a header says that is of a share of something, and what a map calls that."""

_OF_A_SHARE = re.compile(r"%|\b(pct|percent|perc|prozent|procent|pourcent|pourcentage|porcentaje|por ?ciento)\b")


def in_percent(header: str, below: str = "") -> bool:
    """Whether a header, or what stands below it, says that a column is in percent of something."""
    return bool(_OF_A_SHARE.search(f"{header[:200]} {below[:40]}".lower().replace("_", " ")))


def bare(header: str) -> str:
    """A header without its unit."""
    return name_and_unit(header, BRACKETS)[0].strip()


def find_column(wanted: str | int, names: Sequence[str]) -> int | None:
    """Position of a column by number (from 1), by name, or by its name without unit or case; None if not there."""
    if isinstance(wanted, int):
        return wanted - 1 if wanted <= len(names) else None
    found = columns_called(wanted, names)
    return found[0] if len(found) == 1 else None


def columns_called(wanted: str, names: Sequence[str]) -> list[int]:
    """Positions of all columns of a name, or of that name without unit or case where none is exactly so."""
    for same in (str.strip, bare, lambda name: bare(name).lower()):
        if found := [k for k, name in enumerate(names) if same(name) == same(wanted)]:
            return found
    return []
