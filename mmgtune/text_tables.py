"""Tables of text that fit a width."""

from __future__ import annotations

from collections.abc import Collection, Sequence

GAP = 2
"""Spaces between columns."""

LEAST = 12
"""Letters that a column of words keeps at least."""


def table(
    head: Sequence[str],
    rows: Sequence[Sequence[str]],
    *,
    width: int = 80,
    words: Collection[int] = (0,),
    spare: Sequence[int] = (),
) -> list[str]:
    """Lines of a table, each column as wide as what stands in it.

    head   what stands above each column
    rows   cells, as many in each as in the head
    width  letters of a line at most; a table of many columns of numbers may be wider still
    words  places of the columns of words: flush left, and cut where there is no room
    spare  places of the columns to be left out where there is no room, the first of them first
    -> the head, then a line a row; no line ends with spaces
    """
    kept = list(range(len(head)))
    wide = [max(len(head[k]), *(len(row[k]) for row in rows), 0) for k in kept]

    def excess() -> int:
        return sum(wide[k] for k in kept) + GAP * (len(kept) - 1) - width

    for k in spare:
        if excess() > 0:
            kept.remove(k)
    for k in sorted(words, key=lambda k: -wide[k]):
        if k in kept and excess() > 0:
            wide[k] = max(min(wide[k], LEAST), wide[k] - excess())

    def line(row: Sequence[str]) -> str:
        cells = (cut(row[k], wide[k]).ljust(wide[k]) if k in words else row[k].rjust(wide[k]) for k in kept)
        return (" " * GAP).join(cells).rstrip()

    return [line(head), *map(line, rows)]


def cut(text: str, size: int) -> str:
    """A text of at most ``size`` letters, its middle left out where it is longer: names often differ at their end."""
    if len(text) <= size:
        return text
    behind = (size - 1) // 2
    return f"{text[: size - 1 - behind]}…{text[len(text) - behind :]}"
