"""Debian's chromium, for tests that open a page."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from threading import Timer
from typing import Any

import psutil
import pytest

FLAGS = (
    "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-sync",
)  # fmt: skip

SECONDS = 120.0
"""After which a page counts as stuck; tests keep one open for a few seconds."""


class Chromium:
    """Opens pages.  A browser that is stuck is ended, so that its test fails and does not wait for ever; the next page
    gets a new one.
    """

    def __init__(self, playwright: Any, path: str | None):
        self._type, self._path = playwright.chromium, path
        self._browser: Any = None

    def new_context(self, **options: Any) -> Any:
        if self._browser is None or not self._browser.is_connected():
            self._browser = self._type.launch(executable_path=self._path, args=list(FLAGS))
        timer = Timer(SECONDS, _end_browsers)
        timer.daemon = True
        timer.start()
        context = self._browser.new_context(**options)
        context.on("close", lambda _: timer.cancel())
        return context

    def close(self) -> None:
        if self._browser is not None and self._browser.is_connected():
            self._browser.close()


def _end_browsers() -> None:
    """End every chromium that this process has started: calls that wait for one then raise TargetClosedError."""
    for process in psutil.Process().children(recursive=True):
        try:
            if "chrom" in process.name():
                process.kill()
        except psutil.NoSuchProcess:
            continue


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
        opened = Chromium(playwright, path)
        yield opened
        opened.close()
