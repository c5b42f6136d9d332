"""The page of a prediction in Debian's chromium, offline."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from mmgtune.model import Model
from mmgtune.predicting import predict, write_prediction
from mmgtune.profile import load_profile
from mmgtune.report import render
from mmgtune.report.wording import share
from tests.browser import chromium
from tests.report.test_browser import OVERFLOW, Visit

from .test_predict import scattered, two_trials

pytestmark = pytest.mark.browser


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    """Chromium, or a skip."""
    yield from chromium()


@pytest.fixture(scope="module")
def page(tmp_path_factory: Any, browser: Any) -> Path:
    """Two trials with bands; there must be a browser to look at it."""
    folder: Path = tmp_path_factory.mktemp("page")
    write_prediction(predict(scattered(Model(load_profile("suzaku")), 20), trials=two_trials()), folder)
    return render(folder)[0]


@pytest.mark.daily("360-light")
@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", [360, 1200])
def test_it_opens_clean_on_every_screen(browser: Any, page: Path, scheme: str, width: int) -> None:
    with Visit(browser, page, color_scheme=scheme, viewport={"width": width, "height": 800}) as visit:
        assert visit.complaints == []
        assert visit.requests == [visit.url]
        assert visit.page.evaluate(OVERFLOW) == 0
        assert visit.page.locator("figure").count() == 7  # to move about in, indices, calibration, two of each run
        heading = visit.page.locator("h1").inner_text()
        assert "too narrow" in heading or "about right" in heading


def test_what_it_says_is_what_was_found(browser: Any, page: Path) -> None:
    document = json.loads((page.parent / "predict.json").read_text())
    with Visit(browser, page, java_script_enabled=False) as visit:
        row = visit.page.locator("#indices-turn_p35 tr", has_text="advance [m]").inner_text()
        (advance,) = [one for one in document["runs"][0]["indices"] if one["index"] == "advance_m"]
        assert f"{advance['mean']:.1f} ± {advance['half_width']:.1f}" in row
        assert f"{advance['measured']:.1f}" in row
        all_of = visit.page.locator("#scores-table tr", has_text="all").inner_text()
        assert share(document["scores"]["coverage_90"], counted=True) in all_of
