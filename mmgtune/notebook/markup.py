"""Results as fragments of HTML, of the blocks of reports: no script, no picture, nothing fetched."""

from __future__ import annotations

from ..displayed import inert
from ..report import html as pages
from ..report.blocks import Block, Cell, Page, Prose, Section, Table
from .view import View
from .words import is_number, words

MOST, COLUMNS = 40, 9
"""Rows and columns of a table that are shown; the frame has all."""


def html(view: View) -> str:
    """A view as HTML; names from files are text and nothing else."""
    says = [inert(sentence) for sentence in view.says]
    more = len(view.rows) - MOST
    blocks: list[Block] = [
        *([Prose(tuple(says[1:]))] if says[1:] else []),
        *([_table(view)] if view.rows else []),
        *([Prose((f"and {more} rows more: to_frame() has all",))] if more > 0 else []),
    ]
    title = inert(view.title)
    notes = tuple(inert(note) for note in view.notes)
    eyebrow, verdict = (title, says[0]) if says else ("", title)
    return pages.fragment(Page(title, eyebrow, verdict, warnings=notes, sections=(Section("", "", tuple(blocks)),)))


def _table(view: View) -> Table:
    head = [name for k, name in enumerate(view.rows[0]) if not k or any(words(row[name]) for row in view.rows)]
    for name in view.spare:
        if len(head) > COLUMNS and name in head:
            head.remove(name)
    numeric = [k for k, name in enumerate(head) if all(is_number(row[name]) for row in view.rows)]
    rows = [tuple(Cell(inert(words(row[name]))) for name in head) for row in view.rows[:MOST]]
    return Table("mmgtune-table", "", tuple(inert(name) for name in head), tuple(rows), numeric)
