"""What a report says, apart from how it looks: the pieces both the HTML and the Markdown rendering are made from."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar

if TYPE_CHECKING:
    from .drawing import Drawn


@dataclass(frozen=True)
class Cell:
    """One table cell: its text, an optional tone ("good", "bad", "note") and an optional relative link."""

    text: str
    tone: str = ""
    link: str = ""


@dataclass(frozen=True)
class Table:
    """A table whose first column heads its rows; ``numeric`` names the columns of numbers, aligned on the right."""

    kind: ClassVar[str] = "table"
    id: str
    caption: str
    columns: tuple[str, ...]
    rows: tuple[tuple[Cell, ...], ...]
    numeric: Sequence[int] = ()


@dataclass(frozen=True)
class Prose:
    """Sentences: a paragraph each, or list items with ``listed``; ``tone`` "warning" draws a frame round them."""

    kind: ClassVar[str] = "prose"
    sentences: tuple[str, ...]
    listed: bool = False
    tone: str = ""


@dataclass(frozen=True)
class Picture:
    """A static figure, its finding as a caption, and the numbers it was drawn from."""

    kind: ClassVar[str] = "picture"
    id: str
    title: str
    caption: str
    svg: str
    data: tuple[Table, ...] = ()


@dataclass(frozen=True)
class Histories:
    """The interactive time histories: a payload for the page's script, and ``static`` for paper or without script.

    selected  index of the trial shown first
    """

    kind: ClassVar[str] = "histories"
    id: str
    caption: str
    payload: Mapping[str, Any]
    names: tuple[str, ...]
    static: Picture
    selected: int = 0
    notes: tuple[str, ...] = ()
    data: tuple[Table, ...] = ()


@dataclass(frozen=True)
class Commands:
    """Commands to run next: (reason, command) each."""

    kind: ClassVar[str] = "commands"
    items: tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class Details:
    """Blocks that start folded away under a summary line."""

    kind: ClassVar[str] = "details"
    summary: str
    blocks: tuple[Block, ...]


Block = Table | Prose | Picture | Histories | Commands | Details


@dataclass(frozen=True)
class Section:
    """A titled part of the report."""

    id: str
    title: str
    blocks: tuple[Block, ...]


@dataclass(frozen=True)
class Tile:
    """One number at the top: label, value, how it changed, and what that means."""

    label: str
    value: str
    change: str = ""
    note: str = ""
    tone: str = ""


@dataclass(frozen=True)
class Page:
    """A whole report."""

    title: str
    eyebrow: str
    verdict: str
    banners: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    tiles: tuple[Tile, ...] = ()
    sections: tuple[Section, ...] = ()
    figures: Mapping[str, Drawn] = field(default_factory=dict)
    """What becomes files, by name."""

    def histories(self) -> Sequence[Histories]:
        """The interactive parts, of which a page may have none."""
        return [block for section in self.sections for block in section.blocks if isinstance(block, Histories)]


def cells(*values: str | Cell) -> tuple[Cell, ...]:
    """A table row from plain strings and ready cells."""
    return tuple(value if isinstance(value, Cell) else Cell(value) for value in values)
