"""Notebooks run without Jupyter, cell by cell, and as Markdown with what they show.

    python -m tools.notebooks docs/notebooks/calibrate.ipynb

A cell shows what its last expression is, by ``_repr_html_`` where it has one, and the figures that it drew.
"""

from __future__ import annotations

import ast
import base64
import contextlib
import html
import io
import json
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any


@dataclass(frozen=True)
class Cell:
    """A cell that was run.

    kind    "markdown" or "code"
    said    what it printed
    shown   what it showed, as HTML; "" where nothing
    images  its figures, as PNG
    """

    kind: str
    source: str
    said: str = ""
    shown: str = ""
    images: tuple[bytes, ...] = ()


def run(path: Path, code: bool = True) -> list[Cell]:
    """Run a notebook, or read it where code is not to be run.  Whatever a cell raises is raised here, with the cell's
    number."""
    import matplotlib as mpl

    mpl.use("agg")
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    names: dict[str, Any] = {"__name__": "__main__"}
    found = []
    for k, cell in enumerate(cells, 1):
        source = "".join(cell["source"])
        kind = "code" if cell["cell_type"] == "code" else "markdown"
        if kind != "code" or not code:
            found.append(Cell(kind, source))
            continue
        try:
            found.append(_run(source, names, f"{path.name}, cell {k}"))
        except Exception as error:
            raise RuntimeError(f"{path.name}, cell {k}: {error!r}") from error
    return found


def _run(source: str, names: dict[str, Any], where: str) -> Cell:
    import matplotlib.pyplot as plt

    plt.close("all")
    body = ast.parse(source).body
    last = body.pop() if body and isinstance(body[-1], ast.Expr) else None
    said = io.StringIO()
    value = None
    with contextlib.redirect_stdout(said):
        exec(compile(ast.Module(body, []), where, "exec"), names)
        if last is not None:
            value = eval(compile(ast.Expression(last.value), where, "eval"), names)
    images = []
    for number in plt.get_fignums():
        file = io.BytesIO()
        plt.figure(number).savefig(file, format="png", dpi=80, metadata={"Software": None})
        images.append(file.getvalue())
    shown = "" if value is None or images else as_html(value)
    return Cell("code", source, said.getvalue(), shown, tuple(images))


def as_html(value: object) -> str:
    """An object as a notebook shows it."""
    own = getattr(value, "_repr_html_", None)
    return own() if own is not None else f"<pre><code>{html.escape(repr(value))}</code></pre>"


def page(path: Path, code: bool = True) -> str:
    """A notebook as Markdown, run where its code is to be."""
    parts = []
    for cell in run(path, code):
        if cell.kind == "markdown":
            parts.append(cell.source)
            continue
        parts.append(f"```python\n{cell.source}\n```")
        if cell.said:
            parts.append(f"```text\n{cell.said.rstrip()}\n```")
        shown = [cell.shown.replace("\n", "")] if cell.shown else []
        shown += [f'<img alt="what the cell draws" src="data:image/png;base64,{_text(one)}">' for one in cell.images]
        parts += [f'<div class="notebook-output">{one}</div>' for one in shown]
    return "\n\n".join(parts)


def _text(image: bytes) -> str:
    return base64.b64encode(image).decode()


if __name__ == "__main__":
    print(page(Path(sys.argv[1])))
