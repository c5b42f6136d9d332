"""Sizes in words: what their signs mean, and several of them."""

from collections.abc import Mapping

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
