"""The reports in Debian's chromium, offline."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from mmgtune.report import render
from tests.browser import chromium

from . import fake_run

pytestmark = [pytest.mark.browser, pytest.mark.xdist_group("report"), pytest.mark.slow(10)]

READY = 'html[data-ready="1"]'
OVERFLOW = "document.documentElement.scrollWidth - document.documentElement.clientWidth"


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    """Chromium, or a skip."""
    yield from chromium()


class Visit:
    """A report open in a fresh context, and everything it said and asked for."""

    def __init__(self, browser: Any, path: Path, **options: Any):
        self.context = browser.new_context(offline=True, **options)
        self.page = self.context.new_page()
        self.complaints: list[str] = []
        self.requests: list[str] = []
        self.page.on("console", lambda message: self.complaints.append(f"{message.type}: {message.text}"))
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.on("dialog", lambda dialog: (self.complaints.append(dialog.message), dialog.dismiss()))
        self.page.on("request", lambda request: self.requests.append(request.url))
        self.url = path.as_uri()
        self.page.goto(self.url)
        if options.get("java_script_enabled", True):
            self.page.wait_for_selector(READY, state="attached")

    def __enter__(self) -> Visit:
        return self

    def __exit__(self, *_: object) -> None:
        self.context.close()

    def wait(self, condition: str) -> None:
        """Wait for a JavaScript condition; asked from outside, since the page's policy forbids eval inside."""
        for _ in range(200):
            if self.page.evaluate(condition):
                return
            self.page.wait_for_timeout(50)
        pytest.fail(f"never came true: {condition}")

    def limits(self, axis: str = "xaxis") -> list[float]:
        """The limits of an axis of the time histories."""
        found: list[float] = self.page.evaluate(f"document.getElementById('chart')._fullLayout.{axis}.range")
        return found

    def drag(self) -> None:
        """Zoom into the middle of the first panel with the mouse."""
        panel = self.page.locator("#chart .nsewdrag").first
        panel.scroll_into_view_if_needed()
        box = panel.bounding_box()
        assert box is not None
        height = box["y"] + box["height"] / 2
        self.page.mouse.move(box["x"] + 0.3 * box["width"], height)
        self.page.mouse.down()
        self.page.mouse.move(box["x"] + 0.6 * box["width"], height, steps=5)
        self.page.mouse.up()


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_fit_opens_clean_and_draws(browser: Any, fit_folder: Path, scheme: str) -> None:
    with Visit(browser, fit_folder / "report.html", color_scheme=scheme) as visit:
        assert visit.complaints == []
        assert visit.requests == [visit.url]
        drawn = visit.page.locator("#chart .scatterlayer path.js-line").evaluate_all(
            "paths => paths.filter(path => path.getAttribute('d').length > 100).length"
        )
        assert drawn >= 26  # one for each trace, more where there are gaps
        titles = visit.page.locator("#chart .infolayer text[class^='y'][class$='title']").all_text_contents()
        assert len(titles) == 12
        assert all("[" in title for title in titles)
        assert visit.page.evaluate(OVERFLOW) == 0
        ink, paper = visit.page.evaluate(
            "[getComputedStyle(document.querySelector('svg.drawn text')).fill,"
            " getComputedStyle(document.body).backgroundColor]"
        )
        assert contrast(ink, paper) > 7.0


def contrast(one: str, other: str) -> float:
    """The contrast of two colours as browsers write them."""

    def luminance(color: str) -> float:
        parts = [int(part) / 255 for part in color.removeprefix("rgb(").removesuffix(")").split(",")]
        linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts]
        return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]

    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_colours_of_text_can_be_read(browser: Any, fit_folder: Path, scheme: str) -> None:
    with Visit(browser, fit_folder / "report.html", color_scheme=scheme) as visit:
        colors = visit.page.evaluate(
            """() => { const probe = document.body.appendChild(document.createElement("i"));
            const names = ["ink", "muted", "link", "good", "bad", "flag", "before", "after", "paper"];
            const found = names.map(name => { probe.style.color = `var(--${name})`;
              return getComputedStyle(probe).color; });
            return found; }"""
        )
        paper = colors.pop()
        assert min(contrast(color, paper) for color in colors) >= 4.5


def test_zoom_moves_all_panels_and_comes_back(browser: Any, fit_folder: Path) -> None:
    with Visit(browser, fit_folder / "report.html") as visit:
        before = visit.limits()
        visit.drag()
        visit.wait(f"document.getElementById('chart')._fullLayout.xaxis.range[1] < {before[1]} - 50")
        zoomed = visit.limits()
        assert before[0] < zoomed[0] < zoomed[1] < before[1]
        assert visit.limits("xaxis12") == pytest.approx(zoomed)
        assert float(visit.page.input_value("#to")) == pytest.approx(zoomed[1], abs=0.1)
        visit.page.locator("#chart .nsewdrag").first.dblclick()
        visit.wait(f"document.getElementById('chart')._fullLayout.xaxis.range[1] > {before[1]} - 1")
        assert visit.page.input_value("#to") == ""
        assert visit.complaints == []


def test_zoom_by_keyboard(browser: Any, fit_folder: Path) -> None:
    with Visit(browser, fit_folder / "report.html") as visit:
        visit.page.focus("#from")
        visit.page.keyboard.type("100")
        visit.page.keyboard.press("Tab")
        visit.page.keyboard.type("200")
        visit.page.keyboard.press("Tab")
        visit.wait("document.getElementById('chart')._fullLayout.xaxis.range[0] === 100")
        assert visit.limits("xaxis7") == [100, 200]
        visit.page.keyboard.press("Enter")  # the focus is on "Whole trial"
        visit.wait("document.getElementById('chart')._fullLayout.xaxis.range[1] > 600")


def test_selecting_a_trial(browser: Any, fit_folder: Path) -> None:
    with Visit(browser, fit_folder / "report.html") as visit:
        first = "document.getElementById('chart').data[0].y"
        before = visit.page.evaluate(first)
        visit.page.select_option("#trial", label="turn_m40")
        visit.wait(f"{first}.length !== {len(before)}")
        assert min(visit.page.evaluate(first)) < -300.0
        assert visit.limits()[1] < 450.0


def test_saving_a_trial(browser: Any, fit_folder: Path) -> None:
    with Visit(browser, fit_folder / "report.html") as visit:
        with visit.page.expect_download() as started:
            visit.page.click("#save")
        lines = Path(started.value.path()).read_text(encoding="utf-8").splitlines()
        assert lines[0] == "panel,motion,t_s,value"
        assert lines[1].startswith("heading [deg],measured,0,")
        assert len(lines) > 26 * 600


def test_without_script(browser: Any, fit_folder: Path) -> None:
    with Visit(browser, fit_folder / "report.html", java_script_enabled=False) as visit:
        assert visit.page.locator("#coefficients-table").is_visible()
        assert visit.page.locator("#trials-table tbody tr").count() == 8
        assert visit.page.locator("#histories-chart .static svg").is_visible()
        assert visit.page.locator("noscript p").is_visible()
        assert not visit.page.locator(".controls").is_visible()


@pytest.mark.parametrize("width", [360, 768, 1280])
def test_no_sideways_scrolling(browser: Any, fit_folder: Path, sweep_folder: Path, width: int) -> None:
    for folder in (fit_folder, sweep_folder):
        with Visit(browser, folder / "report.html", viewport={"width": width, "height": 800}) as visit:
            visit.page.evaluate("document.querySelectorAll('details').forEach(part => { part.open = true; })")
            assert visit.page.evaluate(OVERFLOW) == 0
            assert visit.complaints == []


def test_folded_numbers_open_by_keyboard(browser: Any, fit_folder: Path) -> None:
    with Visit(browser, fit_folder / "report.html") as visit:
        summary = visit.page.locator("#tracks-figure summary")
        summary.focus()
        visit.page.keyboard.press("Enter")
        assert visit.page.locator("#positions-table").is_visible()
        visit.page.keyboard.press("Shift+Tab")
        assert visit.page.evaluate("document.activeElement.className") == "scroll plot"


def test_printing(browser: Any, fit_folder: Path) -> None:
    with Visit(browser, fit_folder / "report.html") as visit:
        assert len(visit.page.pdf()) > 50_000
        visit.page.emulate_media(media="print")
        assert not visit.page.locator("#chart").is_visible()
        assert visit.page.locator("#histories-chart .static svg").is_visible()


def test_colour_scheme_can_change_while_open(browser: Any, fit_folder: Path) -> None:
    with Visit(browser, fit_folder / "report.html", color_scheme="light") as visit:
        color = "document.getElementById('chart').data[0].line.color"
        light = visit.page.evaluate(color)
        visit.page.emulate_media(color_scheme="dark")
        visit.wait(f"{color} !== '{light}'")
        assert visit.complaints == []


def test_hostile_names_are_harmless(browser: Any, tmp_path: Path) -> None:
    names = ["</script><img src=x onerror=alert(1)>", '"><svg onload=alert(1)>', "x" * 300]
    folder = fake_run.make_renamed_fit(tmp_path / "run", names)
    render(folder)
    with Visit(browser, folder / "report.html", viewport={"width": 360, "height": 800}) as visit:
        assert visit.complaints == []
        assert visit.requests == [visit.url]
        assert visit.page.locator("img").count() == 0
        assert visit.page.locator("#trials-table tbody th").all_text_contents()[:3] == names
        assert visit.page.locator("#trial option").all_text_contents()[:3] == names
        assert visit.page.evaluate(OVERFLOW) == 0


def test_sweep_leads_to_its_runs(browser: Any, sweep_folder: Path) -> None:
    with Visit(browser, sweep_folder / "report.html") as visit:
        assert visit.complaints == []
        assert visit.requests == [visit.url]
        link = visit.page.locator("#misfit-table a")
        assert link.count() == 1
        link.click()
        visit.page.wait_for_selector(f"{READY}.js #chart .js-line", state="attached")
        assert visit.page.url.endswith("/ar_0.5/report.html")
        assert visit.complaints == []


def test_structure_for_screen_readers(browser: Any, fit_folder: Path) -> None:
    with Visit(browser, fit_folder / "report.html") as visit:
        for role in ("banner", "navigation", "main", "contentinfo"):
            assert visit.page.get_by_role(role).count() == 1, role
        assert visit.page.get_by_role("heading", level=1).count() == 1
        assert visit.page.get_by_role("rowheader", name="w_P0", exact=True).count() >= 1
        assert visit.page.get_by_role("figure", name="Tracks", exact=True).count() == 1
        assert visit.page.get_by_role("combobox", name="Trial").count() == 1


@pytest.mark.parametrize("width", [390, 1280])
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_voyages_open_clean(browser: Any, voyages_folder: Path, width: int, scheme: str) -> None:
    shape = {"width": width, "height": 844}
    with Visit(browser, voyages_folder / "report.html", viewport=shape, color_scheme=scheme) as visit:
        assert visit.complaints == []
        assert visit.requests == [visit.url]
        visit.page.evaluate("document.querySelectorAll('details').forEach(part => { part.open = true; })")
        assert visit.page.evaluate(OVERFLOW) == 0
        for name in ("classes", "distributions", "where", "parts", "windows"):
            assert visit.page.locator(f"#{name}-figure svg").is_visible(), name
        assert visit.page.locator("#measures-table tbody tr").count() == 14
        ink, paper = visit.page.evaluate(
            "[getComputedStyle(document.querySelector('#classes-figure svg text')).fill,"
            " getComputedStyle(document.body).backgroundColor]"
        )
        assert contrast(ink, paper) > 7.0


def test_hostile_names_of_voyages_are_harmless(browser: Any, tmp_path: Path) -> None:
    name = "</script><img src=x onerror=alert(1)>"
    folder = fake_run.make_voyages(tmp_path / "run", model=name, id="<svg onload=alert(1)>")
    render(folder)
    with Visit(browser, folder / "report.html", viewport={"width": 360, "height": 800}) as visit:
        assert visit.complaints == []
        assert visit.requests == [visit.url]
        assert visit.page.locator("img").count() == 0
        assert visit.page.locator("#voyages-table tbody th").all_text_contents() == ["<svg onload=alert(1)>"]
        assert visit.page.evaluate(OVERFLOW) == 0
