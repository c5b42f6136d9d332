"""Words put together as in a sentence."""

from __future__ import annotations

from collections.abc import Sequence


def counted(amount: int, noun: str, plural: str = "") -> str:
    """A number with its noun: "1 trial", "8 trials"."""
    return f"{amount} {noun if amount == 1 else plural or noun + 's'}"


def listed(words: Sequence[str], most: int | None = None) -> str:
    """Words as a phrase: "a, b and c"; "" for none.

    most  of more than so many the first are named, and how many more there are: "a, b and 4 more"
    """
    if most is not None and len(words) > most:
        words = [*words[: most - 1], f"{len(words) - most + 1} more"]
    return " and ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words)
