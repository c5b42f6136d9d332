"""The rules of axe-core, held against a page that is open in a browser."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import pytest

_NEAR = Path(__file__).resolve().parents[1] / "node_modules" / "axe-core" / "axe.min.js"


def script() -> str:
    """axe-core, from MMGTUNE_AXE or from node_modules beside the tests; or a skip."""
    path = Path(os.environ.get("MMGTUNE_AXE") or _NEAR)
    if not path.is_file():
        pytest.skip("there is no axe-core; npm install --no-save axe-core@4, or set MMGTUNE_AXE to axe.min.js")
    return path.read_text(encoding="utf-8")


def violations(page: Any, axe: str) -> list[str]:
    """What breaks a rule, each with the first place that does."""
    page.evaluate(axe)
    found = page.evaluate("axe.run(document, {resultTypes: ['violations']})")
    return [f"{one['id']}: {one['nodes'][0]['html'][:160]}" for one in found["violations"]]
