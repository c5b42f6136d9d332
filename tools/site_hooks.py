"""What the site has beyond the pages in docs/: equations as MathML, and pages made from the program at each build.

mkdocs calls these functions; see ``hooks`` in mkdocs.yml.
"""

from __future__ import annotations

import html
import re
from pathlib import Path
from typing import Any

import click
import typer.main
from latex2mathml.converter import convert
from mkdocs.exceptions import PluginError
from mkdocs.structure.files import File, Files

ROOT = Path(__file__).parent.parent

EQUATION = re.compile(r'<(span|div) class="arithmatex">\\([(\[])(.*?)\\[)\]]</\1>', flags=re.S)
TYPED = re.compile(r'<div class="language-(?:text|sh) highlight">.*?</div>', flags=re.S)
"""Blocks of commands and what they print."""

OPTION = re.compile(r"(?<![\w-])(--?[a-z][\w-]*)")

COMMANDS = """# Commands

Made from the commands themselves when this site was built; `mmgtune COMMAND --help` says the same.

## Exit codes {#exit-codes}

| code | meaning |
|---:|---|
| 0 | good |
| 1 | ran, and the answer is no (`check`, `--strict`, `--fail-on`) |
| 2 | could not run: an option, a file or the output; the message says what, where, why and the fix |
| 3 | a bug; a file with the traceback is named |
| 130 | interrupted by Ctrl-C; what takes long has saved the best so far, `--resume --out FOLDER` continues it |
| 143 | the same, by SIGTERM: what a scheduler or a container sends before it ends a job |

## What all commands share

A profile or a data set is a file, a folder, or the name of one that travels with the program. `--json` prints one JSON
document on stdout and nothing else; [its keys](../formats.md) are documented. `--dry-run` of a command that takes long
says what would be done, and about how long it takes. Ctrl-C or SIGTERM once finishes the step at hand and saves, twice
stops at once; one line says what is saved. A run that is resumed comes to the numbers of one that was never stopped. An
option of the same name means the same in every command.
Results are never replaced without `--force`, and a folder belongs to one run at a time.
"""


def on_files(files: Files, config: Any) -> Files:
    """Add the pages that are made here."""
    for uri, text in (
        ("reference/commands.md", COMMANDS + commands()),
        ("changelog.md", from_root("CHANGELOG.md")),
        ("contributing.md", from_root("CONTRIBUTING.md")),
        ("security.md", from_root("SECURITY.md")),
    ):
        files.append(File.generated(config, uri, content=text))
    return files


def on_page_content(text: str, page: Any, **_: Any) -> str:
    """Equations as MathML, which browsers show without any script; options of commands in one piece."""

    def shown(found: re.Match[str]) -> str:
        tag, bracket, latex = found.groups()
        try:
            math = mathml(html.unescape(latex), "block" if bracket == "[" else "inline")
        except Exception as error:
            raise PluginError(f"{page.file.src_uri}: cannot read the equation {latex}: {error!r}") from error
        return f'<{tag} class="equation" data-search-exclude>{math}</{tag}>'

    text = EQUATION.sub(shown, text)
    return TYPED.sub(lambda block: OPTION.sub(r'<span class="option">\1</span>', block[0]), text)


def mathml(latex: str, display: str) -> str:
    """An equation as MathML.

    Primes stand beside their letter instead of above its index, where fonts without mathematics make them tiny; bars
    of absolute values stand close; functions keep a space to their argument.
    """
    text = convert(re.sub(r"\\operatorname\{(\w+)\}", r"\\text{\1}\\,", latex), display=display)
    one = r"((?:(?!<m(?:sup|subsup)>).)*?)"
    prime = "<mo>&#x02032;</mo>"
    text = re.sub(rf"<msubsup>{one}<mi>&#x02032;</mi></msubsup>", rf"<mrow><msub>\1</msub>{prime}</mrow>", text)
    text = re.sub(rf"<msup>{one}<mi>&#x02032;</mi></msup>", rf"<mrow>\1{prime}</mrow>", text)
    text = re.sub(
        rf"<msubsup>{one}<mrow><mi>&#x02032;</mi>(<mn>\d</mn>)</mrow></msubsup>",
        rf"<msup><mrow><msub>\1</msub>{prime}</mrow>\2</msup>",
        text,
    )
    text = re.sub(
        rf"<msup>{one}<mrow><mi>&#x02032;</mi>(<mn>\d</mn>)</mrow></msup>",
        rf"<msup><mrow>\1{prime}</mrow>\2</msup>",
        text,
    )
    text = re.sub(r"<mo(?: [^>]*)?>(?:&#x0007C;|\|)</mo>", '<mo stretchy="false" lspace="0" rspace="0">|</mo>', text)
    return re.sub(r"<mi>(sin|cos|ln|exp)</mi>", r'<mspace width="0.17em"/><mi>\1</mi><mspace width="0.17em"/>', text)


def from_root(name: str) -> str:
    """A page of the repository's top folder, its links as seen from docs/."""
    return (ROOT / name).read_text(encoding="utf-8").replace("](docs/", "](")


def commands() -> str:
    """Every command with its options, by panel."""
    from mmgtune.cli import app

    command = typer.main.get_command(app)
    return "".join(sections(command, click.Context(command, info_name="mmgtune")))


def sections(command: Any, context: click.Context) -> list[str]:
    """One command, then those below it."""
    below = getattr(command, "commands", {})
    parts = []
    if context.parent is not None:
        parts.append(f"\n## {context.command_path}\n")
        if not below:
            usage = " ".join(["[OPTIONS]", *map(shown_name, filter(is_argument, command.params))])
            parts.append(f"\n```text\n{context.command_path} {usage}\n```\n")
        parts.append(f"\n{described(command.help or '')}\n")
        if not below:
            parts += tables(command, context)
    for name, one in below.items():
        if not one.hidden:
            parts += sections(one, click.Context(one, info_name=name, parent=context))
    return parts


def described(text: str) -> str:
    """Help text as Markdown: command lines become blocks of code."""
    parts: list[str] = []
    for block in text.replace("\f", "").split("\n\n"):
        lines = [line.strip() for line in block.strip().splitlines()]
        if not lines or not lines[0]:
            continue
        if all(line.startswith("mmgtune ") for line in lines):
            code = "\n".join(lines)
            if parts and parts[-1].endswith("\n```"):
                parts[-1] = f"{parts[-1][:-3]}{code}\n```"
            else:
                parts.append(f"```\n{code}\n```")
        else:
            parts.append(escaped(" ".join(lines)))
    return "\n\n".join(parts)


def tables(command: Any, context: click.Context) -> list[str]:
    """Options and arguments of a command, a table a panel."""
    panels: dict[str, list[str]] = {}
    for parameter in command.get_params(context):
        if getattr(parameter, "hidden", False) or parameter.name == "help":
            continue
        panel = getattr(parameter, "rich_help_panel", None)
        panel = panel or ("Arguments" if is_argument(parameter) else "Options")
        panels.setdefault(panel, []).append(row(parameter, context))
    head = "| {} | meaning | default |\n|---|---|---|\n"
    return [f"\n{head.format(panel.lower())}{''.join(rows)}" for panel, rows in panels.items()]


def is_argument(parameter: Any) -> bool:
    """Whether a parameter is an argument, not an option."""
    return bool(parameter.param_type_name == "argument")


def shown_name(parameter: Any) -> str:
    """What stands for an argument in the usage."""
    name = str(parameter.metavar or parameter.name.upper())
    return name if parameter.required else f"[{name}]"


def row(parameter: Any, context: click.Context) -> str:
    """One option or argument."""
    names = ", ".join([*parameter.opts, *parameter.secondary_opts])
    if is_argument(parameter):
        names = shown_name(parameter)
    default = parameter.get_default(context, call=True)
    shown = "required" if parameter.required else ""
    if default not in (None, False, "", ()) and not callable(default):
        shown = f"`{', '.join(map(str, default)) if isinstance(default, (list, tuple)) else default}`"
    return f"| `{names}` | {escaped(getattr(parameter, 'help', None) or '')} | {shown} |\n"


def escaped(text: str) -> str:
    """Text that Markdown leaves as it is."""
    return re.sub(r"([\\`*_{}\[\]<>|$])", r"\\\1", text)
