"""Results as text in columns, as lmfit prints its fits."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence

from ..displayed import inert
from ..report.wording import MINUS
from ..text_tables import table
from .view import View
from .words import is_number, words

WIDTH = 80


class Text(str):
    """A text whose ``repr`` is the text itself, so that it reads well at a prompt."""

    def __repr__(self) -> str:
        return str(self)


def summary(view: View, width: int = WIDTH) -> Text:
    """Title, sentences, table and notes, in lines of at most ``width`` letters where the numbers leave that."""
    parts = ["\n".join(wrapped(inert(view.title), width))]
    parts += ["\n".join(wrapped(inert(sentence), width)) for sentence in view.says]
    if view.rows:
        parts.append("\n".join(lines_of(view, width)))
    parts += ["\n".join(wrapped(inert(f"Note: {note}"), width)) for note in view.notes]
    return Text("\n\n".join(parts))


def lines_of(view: View, width: int = WIDTH) -> list[str]:
    """The table of a view."""
    head = list(view.rows[0])
    rows = [[inert(words(cell)).replace("\n", " ").replace(MINUS, "-") for cell in row.values()] for row in view.rows]
    text = [k for k, name in enumerate(head) if not all(is_number(row[name]) for row in view.rows)]
    spare = [head.index(name) for name in view.spare if name in head]
    # What has nothing in it tells nothing.
    empty = [k for k in range(len(head)) if k and not any(row[k] for row in rows)]
    kept = [k for k in range(len(head)) if k not in empty]
    place = {k: new for new, k in enumerate(kept)}
    return table(
        [head[k] for k in kept],
        [[row[k] for k in kept] for row in rows],
        width=width,
        words={place[k] for k in text if k in place},
        spare=[place[k] for k in spare if k in place],
    )


def wrapped(text: str, width: int) -> Sequence[str]:
    """A text in lines, none of which begins with a per cent sign."""
    kept = text.replace(" %", "\u00a0%")
    lines = textwrap.wrap(kept, width, break_long_words=False, break_on_hyphens=False)
    return [line.replace("\u00a0", " ") for line in lines] or [""]
