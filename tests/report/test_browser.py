"""The reports in Debian's chromium, offline."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from mmgtune.report import html, render
from mmgtune.report.blocks import Cell, Page, Section, Table
from tests.browser import chromium

from . import fake_run

pytestmark = [pytest.mark.browser, pytest.mark.xdist_group("report")]

READY = 'html[data-ready="1"]'
OVERFLOW = "document.documentElement.scrollWidth - document.documentElement.clientWidth"
OPEN_ALL = "document.querySelectorAll('details').forEach(part => { part.open = true; })"


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

    def said(self, name: str) -> float:
        """What the viewer says of itself: the time it is at, the ends of what is shown, metres to a pixel."""
        return float(self.page.evaluate(f"document.querySelector('.viewer').dataset.{name}"))

    def ink(self, selector: str) -> int:
        """Pixels of a canvas that are painted."""
        return int(
            self.page.evaluate(
                "(selector) => { const canvas = document.querySelector(selector); const all = canvas.getContext('2d')"
                ".getImageData(0, 0, canvas.width, canvas.height).data; let n = 0;"
                " for (let k = 3; k < all.length; k += 4) n += all[k] > 0; return n; }",
                selector,
            )
        )


def contrast(one: str, other: str) -> float:
    """The contrast of two colours as browsers write them."""

    def luminance(color: str) -> float:
        parts = [int(part) / 255 for part in color.removeprefix("rgb(").removesuffix(")").split(",")]
        linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts]
        return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]

    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_fit_opens_clean_and_draws(browser: Any, fit_folder: Path, scheme: str) -> None:
    with Visit(browser, fit_folder / "report.html", color_scheme=scheme) as visit:
        assert visit.complaints == []
        assert visit.requests == [visit.url]
        assert visit.ink(".track > canvas") > 10_000
        panels = visit.page.locator(".viewer .small")
        titles = panels.locator("h3").all_text_contents()
        assert len(titles) == panels.count() == 7  # two inputs, the distance off track, four motions
        assert all("[" in title for title in titles)
        assert visit.ink(".grid .small:nth-child(2) canvas") > 2_000
        assert visit.page.evaluate(OVERFLOW) == 0
        ink, paper = visit.page.evaluate(
            "[getComputedStyle(document.querySelector('.panel text:last-of-type')).fill,"
            " getComputedStyle(document.body).backgroundColor]"
        )
        assert contrast(ink, paper) > 5.0


@pytest.mark.daily("dark")
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_colours_of_text_can_be_read(browser: Any, fit_folder: Path, scheme: str) -> None:
    with Visit(browser, fit_folder / "report.html", color_scheme=scheme) as visit:
        colors = visit.page.evaluate(
            """() => { const probe = document.body.appendChild(document.createElement("i"));
            const names = ["ink", "muted", "link", "good", "bad", "flag", "before", "after", "third", "paper"];
            const found = names.map(name => { probe.style.color = `var(--${name})`;
              return getComputedStyle(probe).color; });
            return found; }"""
        )
        paper = colors.pop()
        assert min(contrast(color, paper) for color in colors) >= 4.5


THEMES = {"light": ("#ffffff", "#f5f5f5", "#212121"), "dark": ("#111111", "#212121", "#e0e0e0")}
"""Paper of notebooks, every second row of their tables, and ink, as JupyterLab has them."""

SEEN = """() => {
  const canvas = document.createElement("canvas").getContext("2d");
  const seen = (color, paper) => {
    for (const layer of [paper, color]) { canvas.fillStyle = layer; canvas.fillRect(0, 0, 1, 1); }
    return `rgb(${canvas.getImageData(0, 0, 1, 1).data.slice(0, 3).join(", ")})`;
  };
  const style = selector => getComputedStyle(document.querySelector(selector));
  const probe = document.querySelector(".mmgtune").appendChild(document.createElement("i"));
  const names = ["ink", "muted", "link", "good", "bad", "flag", "before", "after", "third"];
  const papers = ["tbody tr:nth-child(odd)", "tbody tr:nth-child(even)"].map(row => style(row).backgroundColor);
  const inks = names.map(name => { probe.style.color = `var(--${name})`; return getComputedStyle(probe).color; });
  const pairs = inks.flatMap(ink => papers.map(paper => [seen(ink, paper), seen(paper, paper)]));
  return { pairs, paper: style(".mmgtune").backgroundColor };
}"""


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("theme", THEMES)
def test_a_fragment_can_be_read_in_a_notebook_whatever_the_system_prefers(
    browser: Any, theme: str, scheme: str
) -> None:
    rows = tuple((Cell(name), Cell("1", "good")) for name in ("one", "two"))
    table = Table("rows", "", ("name", "value"), rows)
    fragment = html.fragment(Page("A result", "", "A result", sections=(Section("", "", (table,)),)))
    paper, second, ink = THEMES[theme]
    rules = (
        f"body {{ background: {paper}; color: {ink}; }} tbody tr {{ background: {paper}; }}"
        f" tbody tr:nth-child(even) {{ background: {second}; }}"
    )
    context = browser.new_context(offline=True, color_scheme=scheme)
    page = context.new_page()
    page.set_content(f"<!doctype html><style>{rules}</style>{fragment}")
    found = page.evaluate(SEEN)
    context.close()
    assert found["paper"] == "rgba(0, 0, 0, 0)"
    assert len(found["pairs"]) == 18
    assert min(contrast(*pair) for pair in found["pairs"]) >= 4.5


def test_dragging_across_a_history_rescales_all_and_comes_back(browser: Any, fit_folder: Path) -> None:
    with Visit(browser, fit_folder / "report.html", viewport={"width": 1400, "height": 1000}) as visit:
        before = visit.said("from"), visit.said("to")
        panel = visit.page.locator(".grid canvas").nth(1)
        panel.scroll_into_view_if_needed()
        box = panel.bounding_box()
        assert box is not None
        height = box["y"] + box["height"] / 2
        visit.page.mouse.move(box["x"] + 0.4 * box["width"], height)
        visit.page.mouse.down()
        visit.page.mouse.move(box["x"] + 0.6 * box["width"], height, steps=5)
        visit.page.mouse.up()
        visit.wait(f"Number(document.querySelector('.viewer').dataset.to) < {before[1]} - 50")
        assert before[0] < visit.said("from") < visit.said("to") < before[1]
        assert float(visit.page.input_value(".to")) == pytest.approx(visit.said("to"), abs=0.1)
        panel.dblclick()
        visit.wait(f"Number(document.querySelector('.viewer').dataset.to) > {before[1]} - 1")
        assert visit.page.input_value(".to") == ""
        assert visit.complaints == []


@pytest.mark.long
def test_all_by_keyboard(browser: Any, fit_folder: Path) -> None:
    with Visit(browser, fit_folder / "report.html") as visit:
        viewer, keys = "document.querySelector('.viewer')", visit.page.keyboard
        visit.page.focus(".from")
        keys.type("100")
        keys.press("Tab")
        keys.type("200")
        keys.press("Tab")
        visit.wait(f"{viewer}.dataset.from === '100.00' && {viewer}.dataset.to === '200.00'")
        keys.press("Enter")  # the focus is on "Whole time"
        visit.wait(f"Number({viewer}.dataset.to) > 600")
        now = visit.said("now")
        visit.page.focus("input[type=range]")
        keys.press("ArrowRight")
        visit.wait(f"Number({viewer}.dataset.now) > {now}")
        assert visit.page.get_attribute("input[type=range]", "aria-valuetext").endswith(" s")  # type: ignore[union-attr]
        scale = visit.said("scale")
        visit.page.focus(".track")
        keys.press("+")
        visit.wait(f"Number({viewer}.dataset.scale) < {scale} / 1.4")
        keys.press("ArrowLeft")
        keys.press("0")
        visit.wait(f"Math.abs(Number({viewer}.dataset.scale) - {scale}) < 1e-3 * {scale}")
        assert visit.complaints == []


def test_pointing_at_a_track_tells_the_state_there(browser: Any, fit_folder: Path) -> None:
    with Visit(browser, fit_folder / "report.html", viewport={"width": 1400, "height": 1000}) as visit:
        visit.page.locator(".track").scroll_into_view_if_needed()
        box = visit.page.locator(".track").bounding_box()
        assert box is not None
        for step in range(40):  # along the middle until a track is met
            visit.page.mouse.move(box["x"] + 70 + step * (box["width"] - 90) / 40, box["y"] + 0.5 * box["height"])
            if visit.page.locator(".tip").is_visible():
                break
        lines = visit.page.locator(".tip").inner_text().split("\n")
        assert lines[0] in ("measured", "before tuning", "after tuning")
        assert lines[1].endswith(" s")
        assert lines[2].endswith(" m/s")
        assert lines[3].startswith("rudder angle ")
        visit.wait(f"Math.abs(document.querySelector('.viewer').dataset.now - {lines[1].removesuffix(' s')}) <= 0.5")


def test_selecting_a_trial(browser: Any, fit_folder: Path) -> None:
    with Visit(browser, fit_folder / "report.html") as visit:
        visit.page.select_option(".pick select", label="turn_m40")
        visit.wait("Number(document.querySelector('.viewer').dataset.to) < 450")
        assert "turning -40 deg" in visit.page.locator(".hint.note").inner_text()


@pytest.mark.parametrize("width", [1400, 768, 375])
def test_controls_stand_above_all_that_they_control(browser: Any, fit_folder: Path, width: int) -> None:
    """Those of all histories stood below half of them, with the button that saves the whole manoeuvre."""
    with Visit(browser, fit_folder / "report.html", viewport={"width": width, "height": 900}) as visit:
        page = visit.page

        def tops(selector: str) -> list[float]:
            return [box["y"] for one in page.locator(selector).all() if (box := one.bounding_box())]

        histories = tops(".small")
        assert len(histories) > 6
        for control in (".from", ".to", ".all", ".differences"):
            assert max(tops(control)) < min(histories), control
        assert max(tops(".save")) < min(tops(".track"))
        page.focus(".differences")
        page.keyboard.press("Space")  # the charts are made anew, the control is not
        assert page.evaluate("document.activeElement.className") == "differences"
        assert page.locator(".small h3", has_text="simulated − measured").count()
        assert visit.complaints == []


def test_saving_a_trial(browser: Any, fit_folder: Path) -> None:
    with Visit(browser, fit_folder / "report.html") as visit:
        with visit.page.expect_download() as started:
            visit.page.click(".save")
        lines = Path(started.value.path()).read_text(encoding="utf-8").splitlines()
        assert lines[0] == "motion,quantity,unit,t_s,value"
        assert lines[1].startswith('"measured","position north",m,0,')
        assert len(lines) > 3 * 6 * 400


def test_tables_sort_and_filter(browser: Any, fit_folder: Path) -> None:
    with Visit(browser, fit_folder / "report.html") as visit:
        button = visit.page.locator("#trials-table thead button", has_text="J after")
        button.click()
        column = visit.page.locator("#trials-table tbody td:nth-child(9)")
        found = [float(text.replace("\u202f", "")) for text in column.all_text_contents()]
        assert found == sorted(found)
        button.click()
        assert [float(text.replace("\u202f", "")) for text in column.all_text_contents()] == found[::-1]
        assert visit.page.locator("#trials-table th[aria-sort=descending]").count() == 1
        visit.page.evaluate(OPEN_ALL)
        field = visit.page.locator("#indices-table-holder input[type=search]")
        field.fill("turn_p10")
        rows = visit.page.locator("#indices-table tbody tr:visible")
        assert 0 < rows.count() < visit.page.locator("#indices-table tbody tr").count()
        assert all("turn_p10" in text for text in rows.all_text_contents())


def test_commands_are_copied(browser: Any, fit_folder: Path) -> None:
    with Visit(browser, fit_folder / "report.html", permissions=["clipboard-read", "clipboard-write"]) as visit:
        first = visit.page.locator(".command").first
        first.locator("button").click()
        visit.wait("document.querySelector('.copy').textContent === 'Copied'")
        copied = visit.page.evaluate("navigator.clipboard.readText()")
        assert copied == first.locator("code").inner_text()
        assert copied.startswith("mmgtune ")


def test_without_script(browser: Any, fit_folder: Path) -> None:
    with Visit(browser, fit_folder / "report.html", java_script_enabled=False) as visit:
        assert visit.page.locator("#coefficients-table").is_visible()
        assert visit.page.locator("#trials-table tbody tr").count() == 8
        assert visit.page.locator("#tracks-static svg.panel").first.is_visible()
        assert visit.page.locator("noscript p").is_visible()


@pytest.mark.daily("390")
@pytest.mark.parametrize("width", [390, 1400])
def test_the_buttons_over_a_track_hide_none_of_it(browser: Any, fit_folder: Path, width: int) -> None:
    dark = """() => {
      const canvas = document.querySelector(".track > canvas"), box = canvas.getBoundingClientRect();
      const at = document.querySelector(".track .zoom").getBoundingClientRect(), k = canvas.width / box.width;
      const pen = canvas.getContext("2d");
      const all = pen.getImageData((at.x - box.x) * k, (at.y - box.y) * k, at.width * k, at.height * k);
      let n = 0;
      for (let i = 0; i < all.data.length; i += 4)
        n += all.data[i + 3] > 100 && Math.min(all.data[i], all.data[i + 1], all.data[i + 2]) < 120;
      return n;
    }"""
    with Visit(browser, fit_folder / "report.html", viewport={"width": width, "height": 900}) as visit:
        assert visit.ink(".track > canvas") > 5_000
        assert visit.page.evaluate(dark) == 0


@pytest.mark.daily("360")
@pytest.mark.parametrize("width", [360, 768, 1280])
def test_no_sideways_scrolling(browser: Any, fit_folder: Path, sweep_folder: Path, width: int) -> None:
    for folder in (fit_folder, sweep_folder):
        with Visit(browser, folder / "report.html", viewport={"width": width, "height": 800}) as visit:
            visit.page.evaluate(OPEN_ALL)
            assert visit.page.evaluate(OVERFLOW) == 0
            assert visit.complaints == []


def test_a_table_that_is_wider_than_a_phone_says_so(browser: Any, fit_folder: Path) -> None:
    with Visit(browser, fit_folder / "report.html", viewport={"width": 390, "height": 844}) as visit:
        hint = visit.page.locator("#trials-table-holder .swipe")
        assert hint.is_visible()
        assert visit.page.locator("#trials-table-holder .scroll").get_attribute("tabindex") == "0"
        tuned = visit.page.locator("#coefficients-table tbody tr").first.locator("td[data-label=tuned]")
        box = tuned.bounding_box()
        assert box is not None
        assert box["x"] >= 0.0
        assert box["x"] + box["width"] <= 390.0  # a card: the tuned value is in sight


def test_folded_numbers_open_by_keyboard(browser: Any, fit_folder: Path) -> None:
    with Visit(browser, fit_folder / "report.html") as visit:
        summary = visit.page.locator("#motions-viewer summary")
        summary.focus()
        visit.page.keyboard.press("Enter")
        assert visit.page.locator("#distances-table").is_visible()


def test_printing(browser: Any, fit_folder: Path) -> None:
    with Visit(browser, fit_folder / "report.html") as visit:
        paper = visit.page.pdf(format="A4")
        assert 3 <= paper.count(b"/Type /Page\n") + paper.count(b"/Type /Page ") <= 6
        visit.page.emulate_media(media="print")
        assert not visit.page.locator(".viewer").is_visible()
        assert visit.page.locator("#tracks-static svg").first.is_visible()


@pytest.mark.long
def test_heads_of_tables_are_printed_with_their_rows(browser: Any, fit_folder: Path) -> None:
    """On every page that a table goes over, and never alone at the end of one."""
    style = "([name, property]) => getComputedStyle(document.querySelector(name))[property]"
    wanted = {
        ("#trials-table thead", "display"): "table-header-group",
        ("#trials-table thead", "breakInside"): "avoid",
        ("#trials-table thead", "breakAfter"): "avoid",
        ("#trials-table caption", "breakAfter"): "avoid",
        ("#trials-table tbody tr", "breakBefore"): "avoid",
        ("#trials-table tbody tr:nth-child(2)", "breakBefore"): "auto",
        ("#trials-table thead button", "display"): "contents",  # else chromium repeats none
    }
    with Visit(browser, fit_folder / "report.html") as visit:
        visit.page.emulate_media(media="print")
        assert {key: visit.page.evaluate(style, list(key)) for key in wanted} == wanted


@pytest.mark.long
def test_colour_scheme_can_change_while_open(browser: Any, fit_folder: Path) -> None:
    drawn = "document.querySelector('.track > canvas').toDataURL()"
    with Visit(browser, fit_folder / "report.html", color_scheme="light") as visit:
        light = visit.page.evaluate(drawn)
        visit.page.emulate_media(color_scheme="dark")
        visit.wait(f"{drawn} !== '{light}'")
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
        assert visit.page.locator(".pick option").all_text_contents()[:3] == names
        assert visit.page.evaluate(OVERFLOW) == 0


@pytest.mark.long
def test_sweep_leads_to_its_runs(browser: Any, sweep_folder: Path) -> None:
    with Visit(browser, sweep_folder / "report.html") as visit:
        assert visit.complaints == []
        assert visit.requests == [visit.url]
        link = visit.page.locator("#misfit-table a")
        assert link.count() == 1
        link.click()
        visit.page.wait_for_selector(f"{READY}.js .track canvas", state="attached")
        assert visit.page.url.endswith("/ar_0.5/report.html")
        assert visit.complaints == []


def test_structure_for_screen_readers(browser: Any, fit_folder: Path) -> None:
    with Visit(browser, fit_folder / "report.html") as visit:
        for role in ("banner", "navigation", "main", "contentinfo"):
            assert visit.page.get_by_role(role).count() == 1, role
        assert visit.page.get_by_role("heading", level=1).count() == 1
        assert visit.page.get_by_role("rowheader", name="w_P0", exact=True).count() >= 1
        assert visit.page.get_by_role("figure", name="Tracks and time histories", exact=True).count() == 1
        assert visit.page.get_by_role("combobox", name="Manoeuvre").count() == 1
        assert visit.page.get_by_role("slider", name="Time").count() == 1


@pytest.mark.daily("light-390")
@pytest.mark.parametrize("width", [390, 1280])
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_voyages_open_clean(browser: Any, voyages_folder: Path, width: int, scheme: str) -> None:
    shape = {"width": width, "height": 844}
    with Visit(browser, voyages_folder / "report.html", viewport=shape, color_scheme=scheme) as visit:
        assert visit.complaints == []
        assert visit.requests == [visit.url]
        visit.page.evaluate(OPEN_ALL)
        assert visit.page.evaluate(OVERFLOW) == 0
        for name in ("classes", "distributions", "where", "parts"):
            assert visit.page.locator(f"#{name}-figure svg.panel >> visible=true").count(), name
        assert visit.page.locator("#measures-table tbody tr").count() == 14
        assert visit.ink(".track > canvas") > 5_000


@pytest.mark.long
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
