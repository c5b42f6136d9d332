"""A report as Markdown, for a repository or a pull request."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from .blocks import Block, Commands, Fold, Motions, Nothing, Picture, Prose, Table

if TYPE_CHECKING:
    from .blocks import Page

_SPECIAL = re.compile(r"([\\`*_{}\[\]<>#|!&~$@])")


def escaped(text: str) -> str:
    """Text that Markdown shows as it is, on one line."""
    return _SPECIAL.sub(_replaced, re.sub(r"[ \t\r\n]+", " ", text).strip())


def _replaced(match: re.Match[str]) -> str:
    return {"<": "&lt;", ">": "&gt;", "&": "&amp;"}.get(match.group(), "\\" + match.group())


def render(page: Page) -> str:
    """The Markdown of a report; figures are the SVG files beside it."""
    parts = [f"# {escaped(page.verdict)}", escaped(page.eyebrow)]
    parts += [escaped(" ".join(page.lead))] if page.lead else []
    parts += [f"> **{escaped(text)}**" for text in page.banners]
    if page.cards:
        rows = "\n".join(
            f"| {escaped(card.label)} | {escaped(card.value)} | {escaped(card.change)} | {escaped(card.note)} |"
            for card in page.cards
        )
        parts.append(f"| | | change | |\n|---|---|---|---|\n{rows}")
    if page.warnings:
        parts.append("\n".join(f"- {escaped(text)}" for text in page.warnings))
    for section in page.sections:
        parts.append(f"## {escaped(section.title)}")
        parts += [text for block in section.blocks for text in _block(block)]
    return "\n\n".join(parts) + "\n"


def _block(block: Block) -> list[str]:
    match block:
        case Table():
            about = [f"- *{escaped(name)}*: {escaped(text)}" for name, text in block.about]
            return [f"**{escaped(block.caption)}**", _table(block), *(["\n".join(about)] if about else [])]
        case Prose():
            mark = "- " if block.listed else "> " if block.tone else ""
            return ["\n".join(mark + escaped(text) for text in block.sentences)] if block.sentences else []
        case Picture():
            tables = [text for table in block.data for text in _block(table)]
            return [f"![{escaped(block.title)}](figures/{block.id}.svg)", f"*{escaped(block.caption)}*", *tables]
        case Motions():
            pictures = [text for picture in block.static for text in _block(picture)]
            tables = [text for table in block.data for text in _block(table)]
            moving = "They can be zoomed and moved along in [report.html](report.html)."
            return [*pictures, f"{escaped(block.caption)} {moving}", *tables]
        case Nothing():
            return [f"> **{escaped(block.sentence)}** {escaped(block.more)}".strip()]
        case Commands():
            return ["\n".join(f"- {escaped(reason)}:\n\n{_code(command)}\n" for reason, command in block.items)]
        case Fold():
            return [text for inner in block.blocks for text in _block(inner)]


def _code(command: str) -> str:
    """An indented block of code inside a list item, which nothing in the command can end."""
    return "\n".join("      " + line for line in command.splitlines())


def _table(table: Table) -> str:
    marks = ["---:" if place in table.numeric else "---" for place in range(len(table.columns))]
    lines = [table.columns, tuple(marks)]
    text = ["| " + " | ".join(escaped(name) for name in lines[0]) + " |", "|" + "|".join(lines[1]) + "|"]
    for row in table.rows:
        shown = [f"[{escaped(cell.text)}]({cell.link})" if cell.link else escaped(cell.text) for cell in row]
        text.append("| " + " | ".join(shown) + " |")
    return "\n".join(text)
