"""What the site has beyond the pages in docs/: equations as MathML, and pages made from the program at each build.

mkdocs calls these functions; see ``hooks`` in mkdocs.yml.  With MMGTUNE_SITE=pages nothing is fitted or simulated for
it: pictures are their captions and notebooks their cells, and the rest of the site is there in a third of the time.
"""

from __future__ import annotations

import atexit
import html
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any, get_args, get_origin

import click
import typer.main
from latex2mathml.converter import convert
from mkdocs.exceptions import PluginError
from mkdocs.structure.files import File, Files

ROOT = Path(__file__).parent.parent
if str(ROOT) not in sys.path:  # MkDocs loads hooks by their path
    sys.path.insert(0, str(ROOT))

from mmgtune.cli.options import help_of  # noqa: E402
from tools import notebooks  # noqa: E402
from tools.site_docstrings import plain  # noqa: E402

EQUATION = re.compile(r'<(span|div) class="arithmatex">\\([(\[])(.*?)\\[)\]]</\1>', flags=re.S)
TYPED = re.compile(r'<div class="language-(?:text|sh) highlight">.*?</div>', flags=re.S)
"""Blocks of commands and what they print."""

OPTION = re.compile(r"(?<![\w-])(--?[a-z][\w-]*)")

COMMANDS = "<!-- commands -->"
"""Where a page in docs/ has the commands."""

FROM_ROOT = {"changelog.md": "CHANGELOG.md", "contributing.md": "CONTRIBUTING.md", "security.md": "SECURITY.md"}
"""Pages that are files of the repository's top folder; in docs/ stands a page that says where these are."""

EXAMPLES = "gallery.md"
"""The page whose commands make the pictures of the site."""

PICTURE = re.compile(r"^<!-- picture: (\S+) \| (.*?) -->$", flags=re.M)
"""A picture that is made at the build: its file, and what is seen in it."""

NOTEBOOK = re.compile(r"^<!-- notebook: (\S+) -->$", flags=re.M)
"""A notebook that is run at the build."""

RUN = os.environ.get("MMGTUNE_SITE") != "pages"
"""Whether the gallery and the notebooks are run."""


def on_files(files: Files, config: Any) -> Files:
    """Run the gallery, and add the pictures and reports that its commands make."""
    if not RUN:
        return files
    made = Path(tempfile.mkdtemp(prefix="mmgtune-site-"))
    atexit.register(shutil.rmtree, made, ignore_errors=True)
    run = [sys.executable, "-m", "tools.site_examples", str(ROOT / "docs" / EXAMPLES), str(made)]
    done = subprocess.run(run, cwd=ROOT, capture_output=True, text=True)
    if done.returncode:
        raise PluginError(f"the gallery could not be made:\n{done.stderr}")
    for path in sorted([*made.rglob("*.svg"), *made.rglob("report.html")]):
        uri = f"made/{path.relative_to(made).as_posix()}"
        files.append(File.generated(config, uri, abs_src_path=str(path)))
    return files


def on_page_markdown(text: str, page: Any, config: Any, files: Files) -> str:
    """What is made here in the places where pages want it."""
    uri = page.file.src_uri
    if uri in FROM_ROOT:
        text = from_root(FROM_ROOT[uri])
    text = text.replace(COMMANDS, commands() if COMMANDS in text else "")
    text = NOTEBOOK.sub(lambda found: notebooks.page(ROOT / "docs" / "notebooks" / found[1], RUN), text)
    return PICTURE.sub(lambda found: figure(found[1], found[2], uri, files), text)


def figure(name: str, words: str, uri: str, files: Files) -> str:
    """A picture with what is seen in it, and with the report it is from where there is one."""
    up = "../" * uri.count("/")
    seen = html.escape(words)
    if not RUN:
        return f'<figure class="made"><figcaption>{seen}</figcaption></figure>\n'
    if files.get_file_from_path(f"made/{name}") is None:
        raise PluginError(f"{uri}: no command of {EXAMPLES} makes the picture {name}")
    report = f"made/{name.partition('/')[0]}/report.html"
    more = f' <a href="{up}{report}">The whole report</a>.' if files.get_file_from_path(report) else ""
    picture = f'<img src="{up}made/{name}" alt="{seen}">'
    return f'<figure class="made">{picture}<figcaption>{seen}{more}</figcaption></figure>\n'


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
            parts.append(plain(" ".join(lines)))
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
    head = "| {} | type | default | meaning |\n|---|---|---|---|\n"
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
    if isinstance(default, bool):
        shown = "on" if default else "off"
    return f"| `{names}` | {kind_of(parameter)} | {shown} | {plain(help_of(parameter))} |\n"


KINDS = {int: "whole number", float: "number", bool: "on or off", str: "text", Path: "path"}
"""Types in words."""


def kind_of(parameter: Any) -> str:
    """What may be given: words to choose from, a kind of path or list, else a type."""
    written = None if is_argument(parameter) else parameter.metavar
    if written:
        return ", ".join(f"`{word}`" for word in written.split("|"))
    kind = parameter.type_descriptor.annotation
    listed = get_origin(kind) is list
    word = KINDS.get(get_args(kind)[0] if listed else kind, "text")
    return f"{word}, one or more" if listed else word
