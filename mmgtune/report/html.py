"""A report as one HTML file that needs nothing else: no network, and for its numbers no script."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .page import Page

_TEMPLATES = Path(__file__).resolve().parent / "templates"


def render(page: Page) -> str:
    """The HTML of a report."""
    import jinja2
    from markupsafe import Markup

    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(_TEMPLATES),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    charts = page.histories()
    library, payload = "", ""
    if charts:
        from plotly.offline import get_plotlyjs

        library, payload = get_plotlyjs(), embedded(charts[0].payload)
    return environment.get_template("report.html.j2").render(
        page=page, drawn=Markup, library=Markup(library), payload=Markup(payload)
    )


def embedded(data: Any) -> str:
    """JSON that is safe inside a script element whatever the strings in it are."""
    text = json.dumps(data, separators=(",", ":"), ensure_ascii=True, allow_nan=False)
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")
