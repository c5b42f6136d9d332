"""Docstrings as Markdown: lists of names and meanings, aligned with spaces in the source, become lists."""

from __future__ import annotations

import re
from importlib import import_module
from typing import Any, get_args, get_type_hints

import griffe

from mmgtune.options import Options, choices

ENTRY = re.compile(r"^( *)(\S+(?:,? \S+)*?)(?<!\.) {2,}(\S.*)$")
"""A name or some, two spaces or more, and what it is; two spaces after a sentence are none of that."""


class Aligned(griffe.Extension):
    """Rewrites every docstring as it is read, and gives options the help that stands in their fields."""

    def on_object(self, *, obj: Any, **_: Any) -> None:
        """Called by griffe for each object."""
        if not obj.is_alias and obj.is_attribute and obj.path.startswith("mmgtune.options."):
            say_what_option_means(obj)
        if not obj.is_alias and obj.docstring:
            obj.docstring.value = as_markdown(obj.docstring.value)
        if not obj.is_alias and obj.is_class and obj.path.startswith("mmgtune.options.") and obj.docstring:
            obj.docstring.value += table_of_options(obj)


def table_of_options(of: Any) -> str:
    """All fields of a dataclass of options, inherited ones too, with types and defaults; nothing for another class."""
    found = getattr(import_module(of.module.path), of.name, None)
    if not (isinstance(found, type) and issubclass(found, Options) and choices(found)):
        return ""
    hints = get_type_hints(found)
    rows = [
        f"| `{name}` | {coded(typed(hints[name]))} | {coded(repr(getattr(found, name)))} "
        f"| {escaped(' '.join(meaning(known).split()))} |"
        for name, known in choices(found).items()
    ]
    return "\n\n" + "\n".join(["| field | type | default | meaning |", "|---|---|---|---|", *rows])


def coded(text: str) -> str:
    """Code in a cell of a table, where a bar would end the cell."""
    return f"<code>{plain(text)}</code>"


def typed(hint: Any) -> str:
    """A type as it is written in the source."""
    return hint.__name__ if isinstance(hint, type) and not get_args(hint) else str(hint).replace("pathlib.", "")


def meaning(known: Any) -> str:
    """Help, words and flag of an option."""
    words = f"{known.help} One of: {', '.join(known.values)}." if known.values else known.help
    return f"{words} Flag: ``{known.flag}``."


def say_what_option_means(attribute: Any) -> None:
    """Help, flag and default of the field of a dataclass of options, as the command line has them."""
    module = import_module(attribute.module.path)
    of = getattr(module, attribute.parent.name, None)
    known = choices(of).get(attribute.name) if isinstance(of, type) and issubclass(of, Options) else None
    if known is not None:
        attribute.docstring = griffe.Docstring(meaning(known), parent=attribute)
        attribute.value = repr(getattr(of, attribute.name))


def as_markdown(text: str) -> str:
    """The same docstring with lists for aligned lines and line breaks before results."""
    out: list[str] = []
    column = -1
    code = False
    for line in text.splitlines():
        found = ENTRY.match(line)
        indent = len(line) - len(line.lstrip())
        if not line.strip():
            column = -1
            code = False
            out.append("")
        elif code or (indent >= 4 and column < 0 and (not out or not out[-1])):
            code = True
            out.append(line)
        elif found and (column < 0 or indent < column):
            if column < 0 and out and out[-1]:
                out.append("")
            column = found.start(3)
            names = ", ".join(f"`{name}`" for name in found.group(2).split(", "))
            out.append(f"- {names}: {escaped(found.group(3))}")
        elif column >= 0 and indent >= 4:
            out[-1] += " " + escaped(line.strip())
        else:
            if column >= 0:
                column = -1
                out.append("")
            elif line.startswith(("->", "Raises")) and out and out[-1]:
                out[-1] += "  "
            out.append(escaped(line))
    return "\n".join(out)


def escaped(line: str) -> str:
    """A line whose signs Markdown leaves as they are, but for code."""
    parts = re.split(r"(``.*?``|`.*?`)", line)
    return "".join(part if k % 2 else plain(part) for k, part in enumerate(parts))


ENTITIES = {"<": "&lt;", ">": "&gt;", "|": "&#124;", "$": "&#36;"}
"""Signs that Markdown has no backslash for, or not everywhere."""


def plain(text: str) -> str:
    """Text in which Markdown sees no marks."""
    text = re.sub(r"([\\`*_{}\[\]])", r"\\\1", text.replace("&", "&amp;"))
    return re.sub(r"[<>|$]", lambda sign: ENTITIES[sign[0]], text)
