"""A report as one HTML file that needs nothing else: no network, and for its numbers no script."""

from __future__ import annotations

import json
import re
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .blocks import Page

_TEMPLATES = Path(__file__).resolve().parent / "templates"
_OPTION = re.compile(r"--[a-z][a-z-]*")


def render(page: Page) -> str:
    """The HTML of a report."""
    payloads = [embedded({**block.payload, "names": list(block.names)}) for block in page.motions()]
    return _rendered("report.html.j2", page, payloads)


def fragment(page: Page) -> str:
    """The blocks of a report as a piece of another page, such as a notebook: no script, styles of its own alone."""
    return _rendered("fragment.html.j2", page, [])


def _rendered(template: str, page: Page, payloads: list[str]) -> str:
    from markupsafe import Markup

    from .figures import svg

    text: str = (
        _environment()
        .get_template(template)
        .render(page=page, drawn=lambda figure: Markup(svg.inline(figure)), payloads=[Markup(one) for one in payloads])
    )
    return text


@cache
def _environment() -> Any:
    """What makes pages of templates; it compiles each of them once in a process."""
    import jinja2

    made = jinja2.Environment(
        loader=jinja2.FileSystemLoader(_TEMPLATES),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    made.filters["options"] = _options_whole
    return made


def _options_whole(text: str) -> str:
    """Escaped text in which no option of a command is broken over two lines."""
    from markupsafe import Markup, escape

    return Markup(_OPTION.sub(r'<span class="option">\g<0></span>', str(escape(text))))


def embedded(data: Any) -> str:
    """JSON that is safe inside a script element whatever the strings in it are."""
    text = json.dumps(data, separators=(",", ":"), ensure_ascii=True, allow_nan=False)
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")
