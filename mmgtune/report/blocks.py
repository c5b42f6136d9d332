"""The vocabulary of reports: what a page says, apart from how it looks.

Every page is made of these and of nothing else: a headline with what explains it, up to four cards, then sections of
blocks in order of need.  HTML, Markdown and notebooks are renderings of the same blocks.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

if TYPE_CHECKING:
    from .figures.plot import Figure


@dataclass(frozen=True)
class Cell:
    """One table cell: its text, an optional tone ("good", "bad", "note") and an optional relative link."""

    text: str
    tone: str = ""
    link: str = ""


@dataclass(frozen=True)
class Table:
    """A table whose first column heads its rows.  A page sorts it by any column, and filters it where it is long.

    numeric  the columns of numbers, aligned on the right
    about    column or measure -> what it is, where its name does not say so
    raw      numbers to look up: left out on paper
    cards    on a phone every row is a card, for tables that are read row by row
    """

    kind: ClassVar[str] = "table"
    id: str
    caption: str
    columns: tuple[str, ...]
    rows: tuple[tuple[Cell, ...], ...]
    numeric: Sequence[int] = ()
    about: Sequence[tuple[str, str]] = ()
    raw: bool = False
    cards: bool = False


@dataclass(frozen=True)
class Prose:
    """Sentences: a paragraph each, or list items with ``listed``; ``tone`` "warning" draws a frame round them."""

    kind: ClassVar[str] = "prose"
    sentences: tuple[str, ...]
    listed: bool = False
    tone: str = ""


@dataclass(frozen=True)
class Nothing:
    """What was looked for and not found, so that it looks like it: no bar, no colour."""

    kind: ClassVar[str] = "nothing"
    sentence: str
    more: str = ""


@dataclass(frozen=True)
class Picture:
    """A figure, its finding as a caption, and the numbers it was drawn from."""

    kind: ClassVar[str] = "picture"
    id: str
    title: str
    caption: str
    figure: Figure
    data: tuple[Table, ...] = ()


@dataclass(frozen=True)
class Motions:
    """Tracks and time histories to move about in: what the page's script draws, and pictures for paper.

    payload   from ``motions.payload``
    names     of the manoeuvres, in the order of the payload
    static    pictures of the same for paper, Markdown and pages without script
    selected  index of the manoeuvre shown first
    """

    kind: ClassVar[str] = "motions"
    id: str
    title: str
    caption: str
    payload: Mapping[str, Any]
    names: tuple[str, ...]
    static: tuple[Picture, ...]
    selected: int = 0
    notes: tuple[str, ...] = ()
    data: tuple[Table, ...] = ()


@dataclass(frozen=True)
class Commands:
    """Commands to run next: (reason, command) each."""

    kind: ClassVar[str] = "commands"
    items: tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class Fold:
    """Blocks that start folded away under a summary line; ``printed`` ones are opened for paper."""

    kind: ClassVar[str] = "fold"
    summary: str
    blocks: tuple[Block, ...]
    printed: bool = False


Block = Table | Prose | Nothing | Picture | Motions | Commands | Fold


@dataclass(frozen=True)
class Section:
    """A titled part of the report."""

    id: str
    title: str
    blocks: tuple[Block, ...]

    @property
    def printed(self) -> bool:
        """Whether anything of it is there on paper."""
        return not all(
            block.raw if isinstance(block, Table) else isinstance(block, Fold) and not block.printed
            for block in self.blocks
        )


@dataclass(frozen=True)
class Card:
    """One number at the top: label, value, how it changed, and what that means."""

    label: str
    value: str
    change: str = ""
    note: str = ""
    tone: str = ""


@dataclass(frozen=True)
class Page:
    """A whole report.

    lead  sentences under the headline: what its words mean, and on which terms its numbers hold
    """

    title: str
    eyebrow: str
    verdict: str
    lead: tuple[str, ...] = ()
    banners: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    cards: tuple[Card, ...] = ()
    sections: tuple[Section, ...] = ()

    def blocks(self) -> Iterator[Block]:
        """All blocks, those inside others too, in their order."""
        for section in self.sections:
            yield from inside(section.blocks)

    def figures(self) -> Mapping[str, Figure]:
        """What becomes files, by name."""
        return {block.figure.name: block.figure for block in self.blocks() if isinstance(block, Picture)}

    def motions(self) -> Sequence[Motions]:
        """The parts to move about in, of which a page may have none."""
        return [block for block in self.blocks() if isinstance(block, Motions)]


def inside(blocks: Sequence[Block]) -> Iterator[Block]:
    """Blocks and what they hold."""
    for block in blocks:
        yield block
        match block:
            case Fold():
                yield from inside(block.blocks)
            case Motions():
                yield from block.static


def cells(*values: str | Cell) -> tuple[Cell, ...]:
    """A table row from plain strings and ready cells."""
    return tuple(value if isinstance(value, Cell) else Cell(value) for value in values)
