"""Docstrings as Markdown: lists of names and meanings, aligned with spaces in the source, become lists."""

from __future__ import annotations

import re
from importlib import import_module
from typing import Any

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


def say_what_option_means(attribute: Any) -> None:
    """Help, flag and default of the field of a dataclass of options, as the command line has them."""
    module = import_module(attribute.module.path)
    of = getattr(module, attribute.parent.name, None)
    known = choices(of).get(attribute.name) if isinstance(of, type) and issubclass(of, Options) else None
    if known is not None:
        words = f"{known.help} One of: {', '.join(known.values)}." if known.values else known.help
        attribute.docstring = griffe.Docstring(f"{words} Flag: ``{known.flag}``.", parent=attribute)
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
    return "".join(part if k % 2 else re.sub(r"([*_<>\[\]|$])", r"\\\1", part) for k, part in enumerate(parts))
