"""Sizes in words: what their signs mean, and several of them."""

import re
from collections.abc import Mapping

from ..units import KNOT

UNLIMITED = "infinite"
"""A size that is infinite, in words."""


def signed(size: str, positive: str, negative: str) -> str:
    """A size in words with what its sign means: "-2.1 ± 0.3 m", forward or aft, is "2.1 ± 0.3 m aft"."""
    return f"{size.removeprefix('-')} {negative if size.startswith('-') else positive}"


def each(words: Mapping[str, str], sizes: Mapping[str, str], signs: tuple[str, str] | None = None) -> str:
    """What is said of each size that there is, joined by "and".

    words  by parameter, with a place for the size
    signs  what a positive and a negative size mean, as in ``signed``
    """
    told = {name: signed(size, *signs) if signs else size for name, size in sizes.items()}
    return " and ".join(said.format(told[name]) for name, said in words.items() if name in told)


AS_KNOTS = 0.04
"""How far a factor may be from that of another unit."""


def as_logged(what: str, comes: str, sizes: Mapping[str, str]) -> list[str]:
    """What is said of the factor ``measured`` on something logged around the ship, and of how far its direction is
    ``turned``.

    comes  where it is logged from, or to: "comes from"
    """
    told = []
    if "measured" in sizes:
        factor = sizes["measured"].removeprefix("-")
        way = " the other way" if sizes["measured"].startswith("-") else ""
        acts = f"the {what} measured in the trials acts on the ship{way}, with {factor} times its measured speed"
        told.append(f"{acts}{_of_unit(factor)}")
    if "turned" in sizes:
        off = signed(sizes["turned"], "clockwise", "anticlockwise")
        told.append(f"the {what} is logged {off} of where it {comes}")
    return told


def _of_unit(factor: str) -> str:
    """Which units may have been taken for each other by a factor in words; "" for none."""
    number = re.match(r"[\d.]+", factor)
    times = float(number[0]) / KNOT if number else 0.0
    if abs(times - 1.0) < AS_KNOTS:
        return ", as of knots taken for m/s"
    return ", as of m/s taken for knots" if abs(times * KNOT**2 - 1.0) < AS_KNOTS else ""
