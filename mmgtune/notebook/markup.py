"""Results as fragments of HTML: no script, no picture, nothing fetched; names from files are text and nothing else."""

from __future__ import annotations

from markupsafe import Markup, escape

from ..displayed import inert
from .view import View
from .words import is_number, words

MOST = 40
"""Rows of a table that are shown; the frame has all."""

BODY = Markup('<div class="mmgtune" style="max-width:60em">{}</div>')
TITLE = Markup('<p style="margin:.2em 0"><code>{}</code></p>')
SAYS = Markup('<p style="margin:.4em 0">{}</p>')
NOTE = Markup('<p style="margin:.3em 0;padding-left:.6em;border-left:3px solid #d55e00">{}</p>')
TABLE = Markup('<div style="overflow-x:auto"><table><thead><tr>{}</tr></thead><tbody>{}</tbody></table></div>')
HEAD = Markup('<th scope="col" style="text-align:{}">{}</th>')
CELL = Markup('<td style="text-align:{}">{}</td>')
ROW = Markup("<tr>{}</tr>")


def html(view: View) -> str:
    """A view as HTML."""
    parts = [TITLE.format(inert(view.title))]
    parts += [SAYS.format(inert(sentence)) for sentence in view.says]
    if view.rows:
        parts.append(_table(view))
    parts += [NOTE.format(inert(note)) for note in view.notes]
    return str(BODY.format(Markup("").join(parts)))


def _table(view: View) -> Markup:
    head = [name for k, name in enumerate(view.rows[0]) if not k or any(words(row[name]) for row in view.rows)]
    side = {name: "right" if all(is_number(row[name]) for row in view.rows) else "left" for name in head}
    titles = Markup("").join(HEAD.format(side[name], inert(name)) for name in head)
    rows = [
        ROW.format(Markup("").join(CELL.format(side[name], inert(words(row[name]))) for name in head))
        for row in view.rows[:MOST]
    ]
    table = TABLE.format(titles, Markup("").join(rows))
    more = len(view.rows) - MOST
    return table + (SAYS.format(f"and {more} rows more: to_frame() has all") if more > 0 else escape(""))
