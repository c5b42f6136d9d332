"""Every kind of report on every screen and on paper, as a reader meets it."""

from __future__ import annotations

import base64
import json
import re
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from mmgtune.report import html, load, render
from mmgtune.report.pages.kinds import KINDS
from tests import axe
from tests.browser import chromium

from .test_browser import OPEN_ALL, OVERFLOW, Visit

pytestmark = [pytest.mark.browser, pytest.mark.xdist_group("report")]

HOSTILE = "</script><img src=x onerror=alert(1)>"
SCREENS = {
    "desktop": ({"width": 1400, "height": 900}, "light"),
    "desktop, dark": ({"width": 1400, "height": 900}, "dark"),
    "phone, dark": ({"width": 390, "height": 844}, "dark"),
    "phone": ({"width": 390, "height": 844}, "light"),
}
PAGES = ("fit", "sweep", "leave-out", "diagnosis", "nothing", "unexplained", "validate", "voyages", "predict",
         "comparison", "model-comparison", "simulate", "trials", "check", "learning", "plan", "fleet")  # fmt: skip
OF_EVERY_BLOCK = ("fit", "diagnosis", "nothing", "unexplained", "validate", "trials")
"""Pages that have all blocks between them."""
PAGES_NOW = [one if one in OF_EVERY_BLOCK else pytest.param(one, marks=pytest.mark.long) for one in PAGES]


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    """Chromium, or a skip."""
    yield from chromium()


@pytest.fixture(scope="module")
def runs(more: dict[str, Path], fit_folder: Path, sweep_folder: Path, voyages_folder: Path) -> dict[str, Path]:
    """A rendered run folder of every kind."""
    return {"fit": fit_folder, "sweep": sweep_folder, "voyages": voyages_folder, **more}


def test_every_kind_is_here(runs: dict[str, Path]) -> None:
    assert set(PAGES) == set(runs)
    files = {kind.file for kind in KINDS} - {"ensemble.json", "hybrid.json", "heading_keeping.json"}
    assert files == {one.file for one in KINDS for folder in runs.values() if (folder / one.file).is_file()}


def test_options_are_in_words(runs: dict[str, Path]) -> None:
    """Not None, True or null, which are words of Python and JSON."""
    tables = {
        name: re.findall(r'<table id="options-table".*?</table>', (folder / "report.html").read_text(), re.S)
        for name, folder in runs.items()
    }
    assert len(tables["fit"]) == len(tables["validate"]) == len(tables["learning"]) == 1
    cells = {cell for found in tables.values() for table in found for cell in re.findall(r">([^<>]+)<", table)}
    assert {"yes", "no"} & cells
    assert not {"None", "True", "False", "null", "true", "false", "[]"} & cells


@pytest.mark.daily("diagnosis", "trials")
@pytest.mark.parametrize("name", PAGES_NOW)
def test_screens(browser: Any, runs: dict[str, Path], name: str) -> None:
    rules = axe.script() if _has_axe() else ""
    with Visit(browser, runs[name] / "report.html") as visit:
        page = visit.page
        assert 1 <= page.locator(".card").count() <= 4
        first = page.locator("main section").first
        assert first.locator("canvas, svg.panel, .nothing").count()  # a picture before any table
        for screen, (shape, scheme) in SCREENS.items():
            page.set_viewport_size(shape)
            page.emulate_media(color_scheme=scheme)
            page.wait_for_timeout(60)
            assert page.evaluate(OVERFLOW) == 0, screen
            assert painted(visit) > 0.05, screen  # 0.09 to 0.27; of a page with nothing on it 0.02 to 0.03
            if rules and screen == "desktop, dark":  # a phone in light, with all open, is looked at below
                assert axe.violations(page, rules) == [], screen
        page.evaluate(OPEN_ALL)
        assert page.evaluate(OVERFLOW) == 0
        if rules:
            assert axe.violations(page, rules) == []
        page.set_viewport_size({"width": 360, "height": 800})
        for size in ("150%", "200%"):  # the letters a reader has chosen in the browser
            page.evaluate(f"document.documentElement.style.fontSize = '{size}'")
            page.wait_for_timeout(60)
            assert page.evaluate(OVERFLOW) == 0, size
        boxes = [box for one in page.locator('input[type="checkbox"]').all() if (box := one.bounding_box())]
        assert all(box["width"] == box["height"] > 24.0 for box in boxes)  # with the letters, not 13 pixels as before
        text = page.locator("body").inner_text()
        assert not re.search(r"[−-]0\.0+\s%|\d{5,}\s%|NaN|undefined", text)
        assert visit.complaints == []
        assert visit.requests == [visit.url]


HIDDEN_COLUMNS = """() => [...document.querySelectorAll('.scroll')].filter((one) => one.clientWidth).map((one) => ({
  table: one.querySelector('table').id,
  inside: one.getBoundingClientRect().right <= document.documentElement.clientWidth,
  wide: one.scrollWidth > one.clientWidth + 2,
  told: getComputedStyle(one).overflowX === 'auto' && one.classList.contains('more')
        && one.previousElementSibling.checkVisibility(),
}))"""
"""Of every table whether it stays inside the page, is wider than its box, and can be scrolled there, as is said."""


@pytest.mark.daily("fit", "diagnosis")
@pytest.mark.parametrize("name", PAGES)
def test_a_tablet_shows_all_columns_or_says_where_more_are(browser: Any, runs: dict[str, Path], name: str) -> None:
    """At 768 px the last columns of the tables of a fit stood outside their box."""
    with Visit(browser, runs[name] / "report.html", viewport={"width": 768, "height": 1024}) as visit:
        visit.page.evaluate(OPEN_ALL)
        visit.page.wait_for_timeout(100)
        assert visit.page.evaluate(OVERFLOW) == 0
        tables = visit.page.evaluate(HIDDEN_COLUMNS)
        assert tables
        assert all(one["inside"] and one["told"] == one["wide"] for one in tables)
        if name in ("fit", "diagnosis"):
            assert not [one["table"] for one in tables if one["wide"]]


SMALL_TARGETS = """() => [...document.querySelectorAll('button, summary, a, select, input')]
  .filter((one) => one.checkVisibility() && !one.classList.contains('skip'))
  .map((one) => ({ what: `${one.tagName} ${one.textContent.slice(0, 20)}`, ...one.getBoundingClientRect().toJSON() }))
  .filter((one) => one.width < 24 || one.height < 24).map((one) => one.what)"""
"""What can be tapped and is smaller than WCAG 2.2 (2.5.8) asks for."""


@pytest.mark.daily("fit", "diagnosis")
@pytest.mark.parametrize("name", PAGES)
def test_fingers_find_what_can_be_tapped(browser: Any, runs: dict[str, Path], name: str) -> None:
    """Heads that sort were 18 px high."""
    shape: dict[str, Any] = {"viewport": {"width": 375, "height": 812}, "has_touch": True, "is_mobile": True}
    with Visit(browser, runs[name] / "report.html", **shape) as visit:
        visit.page.evaluate(OPEN_ALL)
        assert visit.page.evaluate("matchMedia('(pointer: coarse)').matches")
        assert visit.page.evaluate(SMALL_TARGETS) == []
        assert visit.page.evaluate(OVERFLOW) == 0


def painted(visit: Visit) -> float:
    """Bytes a pixel of a picture of the whole page; packed loosely, since packing takes most of the time."""
    devtools = visit.context.new_cdp_session(visit.page)
    whole = devtools.send("Page.getLayoutMetrics")["cssContentSize"]
    how = {"format": "png", "optimizeForSpeed": True, "captureBeyondViewport": True, "clip": {**whole, "scale": 1}}
    picture = base64.b64decode(devtools.send("Page.captureScreenshot", how)["data"])
    devtools.detach()
    return len(picture) / (whole["width"] * whole["height"])


def _has_axe() -> bool:
    try:
        axe.script()
    except pytest.skip.Exception:
        return False
    return True


@pytest.mark.daily("diagnosis")
@pytest.mark.parametrize("name", OF_EVERY_BLOCK)
def test_paper(browser: Any, runs: dict[str, Path], name: str) -> None:
    with Visit(browser, runs[name] / "report.html") as visit:
        paper = visit.page.pdf(format="A4")
        assert 2 <= len(re.findall(rb"/Type\s*/Page\b(?!s)", paper)) <= 6
        visit.page.emulate_media(media="print")
        assert visit.page.locator(".static svg.panel >> visible=true").count() >= 4
        assert visit.page.locator(".raw >> visible=true").count() == 0
        assert visit.page.locator(".viewer, .copy, .filter, nav >> visible=true").count() == 0
        empty = """() => [...document.querySelectorAll('main section')].filter((one) => one.checkVisibility())
          .filter((one) => one.getBoundingClientRect().height < 1.5 * one.querySelector('h2').offsetHeight).length"""
        assert visit.page.evaluate(empty) == 0  # no heading stands alone


@pytest.mark.daily("diagnosis")
@pytest.mark.parametrize("name", PAGES_NOW)
def test_the_keyboard_reaches_everything(browser: Any, runs: dict[str, Path], name: str) -> None:
    with Visit(browser, runs[name] / "report.html", viewport={"width": 390, "height": 844}) as visit:
        wanted = visit.page.evaluate(
            """() => { const seen = (one) => one.checkVisibility() && !one.disabled;
            const all = [...document.querySelectorAll('a, button, input, select, summary, [tabindex="0"]')]
              .filter(seen);
            all.forEach((one, k) => { one.dataset.k = k; });
            const scrolled = [...document.querySelectorAll('.scroll')]
              .filter((one) => seen(one) && one.scrollWidth > one.clientWidth + 2 && one.tabIndex !== 0);
            return [all.length, scrolled.length]; }"""
        )
        assert wanted[1] == 0  # what scrolls can be scrolled by keys
        visit.page.evaluate(
            """() => { document.body.tabIndex = -1; document.body.focus(); window.reached = new Set();
            document.addEventListener('focusin', (event) => window.reached.add(event.target.dataset.k)); }"""
        )
        for _ in range(wanted[0] + 2):
            visit.page.keyboard.press("Tab")
        reached = set(visit.page.evaluate("[...window.reached]"))
        assert len(reached - {None}) == wanted[0]


def test_nothing_found_looks_like_nothing_found(runs: dict[str, Path]) -> None:
    page = (runs["nothing"] / "report.html").read_text(encoding="utf-8")
    assert '<p class="nothing"><strong>No cause was found.</strong>' in page
    assert "explains most" not in page
    bars = re.findall(r'<figure id="candidates-figure".*?</figure>', page, re.S)
    assert not any("var(--after)" in one for one in bars)


def test_unexplained_opens_where_the_error_lives(runs: dict[str, Path]) -> None:
    page = (runs["unexplained"] / "report.html").read_text(encoding="utf-8")
    sections = re.findall(r'<section id="([a-z]+)"', page)
    assert sections[:3] == ["motions", "evidence", "causes"]
    assert "times the noise" in page
    assert not re.search(r"predicts 0\s%", page)
    assert not re.search(r"\d{4,}\s%", page)


def test_one_result_has_one_figure(runs: dict[str, Path]) -> None:
    record = json.loads((runs["diagnosis"] / "diagnosis.json").read_text(encoding="utf-8"))
    page = (runs["diagnosis"] / "report.html").read_text(encoding="utf-8")
    said = re.search(r"removes ([\d.]+) % of the error", record["sentence"])
    assert said is not None
    assert f">{said[1]}\u00a0%<" in page
    assert "100.00" not in page
    assert "100.0 to 100.0" not in page


def test_fragments_for_notebooks(runs: dict[str, Path]) -> None:
    for folder in runs.values():
        kind, run = load.find(folder, KINDS)
        text = html.fragment(kind.build(run))
        assert text.startswith('<div class="mmgtune">')
        assert "<script" not in text
        assert "prefers-color-scheme" not in text  # a notebook has a theme of its own
        assert "<h1>" in text
        assert text.count("<div") == text.count("</div>")


@pytest.mark.long
def test_hostile_names_stay_inert_everywhere(browser: Any, runs: dict[str, Path], tmp_path: Path) -> None:
    for name in ("leave-out", "diagnosis", "validate", "check", "comparison", "learning", "fleet"):
        folder = tmp_path / name
        shutil.copytree(runs[name], folder, ignore=shutil.ignore_patterns("report.*", "figures"))
        path = next(folder / kind.file for kind in KINDS if (folder / kind.file).is_file())
        path.write_text(json.dumps(_renamed(json.loads(path.read_text(encoding="utf-8")))), encoding="utf-8")
        render(folder)
        kind, run = load.find(folder, KINDS)
        assert "<img" not in html.fragment(kind.build(run)), name
        with Visit(browser, folder / "report.html", viewport={"width": 390, "height": 844}) as visit:
            assert visit.complaints == [], name
            assert visit.requests == [visit.url], name
            assert visit.page.locator("img").count() == 0, name
            assert HOSTILE in visit.page.locator("body").inner_text() or name == "learning"
            assert visit.page.evaluate(OVERFLOW) == 0, name


TEXTS = (
    "sentence",
    "reason",
    "name",
    "profile",
    "trials",
    "ship",
    "what",
    "why",
    "note",
    "citation",
    "licence",
    "source",
)


def _renamed(data: Any, key: str = "") -> Any:
    """The record with a hostile ending on every text that is shown as it is."""
    if isinstance(data, dict):
        return {name: value if name == "inputs" else _renamed(value, name) for name, value in data.items()}
    if isinstance(data, list):
        return [_renamed(value, key) for value in data]
    return f"{data} {HOSTILE}" if isinstance(data, str) and key in TEXTS else data
