"""Debian's chromium, for tests that open a page."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from typing import Any

import pytest

FLAGS = (
    "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-sync",
)  # fmt: skip


def chromium() -> Iterator[Any]:
    """Chromium, or a skip that a job may forbid with MMGTUNE_REQUIRE_BROWSER=1."""
    path = os.environ.get("MMGTUNE_CHROMIUM") or shutil.which("chromium")
    missing = "" if path else "there is no chromium; set MMGTUNE_CHROMIUM to one"
    try:
        from playwright.sync_api import sync_playwright
    except ImportError:
        missing = "playwright is not installed"
    if missing:
        if os.environ.get("MMGTUNE_REQUIRE_BROWSER") == "1":
            pytest.fail(missing)
        pytest.skip(missing)
    with sync_playwright() as playwright:
        opened = playwright.chromium.launch(executable_path=path, args=list(FLAGS))
        yield opened
        opened.close()
