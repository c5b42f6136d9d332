"""The site of the documents: it builds without a warning, and opens without a server and without a net."""

from __future__ import annotations

import ast
import html
import importlib.util
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import pytest

from tests.browser import chromium
from tests.command import run

pytestmark = pytest.mark.xdist_group("site")

ROOT = Path(__file__).parents[2]
OVERFLOW = "document.documentElement.scrollWidth - document.documentElement.clientWidth"


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The site without what is fitted and simulated for it, built so that a warning is an error."""
    return built(tmp_path_factory.mktemp("site"), MMGTUNE_SITE="pages")


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The site as it is read."""
    return built(tmp_path_factory.mktemp("whole"))


def built(folder: Path, **env: str) -> Path:
    """The site in a folder, or a skip."""
    missing = [name for name in ("mkdocs", "material", "mkdocstrings", "latex2mathml") if not found(name)]
    if missing:
        pytest.skip(f"{', '.join(missing)} not installed: pip install '.[docs]'")
    ended = subprocess.run(
        [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", str(folder)],
        cwd=ROOT,
        env={**os.environ, "NO_MKDOCS_2_WARNING": "1", **env},
        capture_output=True,
        text=True,
    )
    assert ended.returncode == 0, ended.stderr
    return folder


def found(name: str) -> bool:
    """Whether a module can be imported."""
    return importlib.util.find_spec(name) is not None


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    """Chromium, or a skip."""
    yield from chromium()


@pytest.fixture
def visit(browser: Any, site: Path) -> Iterator[Any]:
    """Opens pages; fails where one complained, missed a file, asked elsewhere or is wider than the window."""
    context = browser.new_context(offline=True, viewport={"width": 1280, "height": 900})
    page = context.new_page()
    complaints: list[str] = []
    page.on("console", lambda message: complaints.append(f"{message.type}: {message.text}"))
    page.on("pageerror", lambda error: complaints.append(str(error)))
    page.on("requestfailed", lambda request: complaints.append(f"missing: {request.url}"))
    page.on(
        "request",
        lambda request: request.url.startswith(("file:", "data:")) or complaints.append(f"outside: {request.url}"),
    )

    def go(name: str) -> Any:
        page.goto((site / name).as_uri())
        page.wait_for_function("window.document$ !== undefined")  # the theme's script has run
        assert page.evaluate(OVERFLOW) <= 0, name
        return page

    yield go
    context.close()
    assert complaints == []


def test_equations_are_mathml(site):
    for name in ("model", "low-speed", "effects", "calibration", "diagnosis"):
        text = (site / "theory" / f"{name}.html").read_text(encoding="utf-8")
        assert text.count("<math ") >= 5
    for page in site.rglob("*.html"):
        prose = re.sub(r"<(pre|code|script)\b.*?</\1>", "", page.read_text(encoding="utf-8"), flags=re.S)
        assert "arithmatex" not in prose, page
        assert "$$" not in prose, page


def test_nothing_is_asked_from_elsewhere(site):
    for page in site.rglob("*.html"):
        for tag in re.findall(r"<(?:link|script|img|iframe)\b[^>]*>", page.read_text(encoding="utf-8")):
            for address in re.findall(r'(?:src|href)="([^"]*)"', tag):
                assert not urlsplit(address).netloc, (page.name, tag)


def test_every_command_has_its_section(site, tmp_path):
    text = (site / "reference" / "commands.html").read_text(encoding="utf-8")
    help_text = run("--help", cwd=tmp_path).out
    names = re.findall(r"^│ ([a-z][a-z-]+) ", help_text, flags=re.M)
    assert {"fit", "diagnose", "trials"} <= set(names)
    assert [name for name in names if f"mmgtune {name}<" not in text] == []


def test_commands_say_types_choices_and_defaults(site):
    from mmgtune.effects import effect_tags

    text = (site / "reference" / "commands.html").read_text(encoding="utf-8")
    assert "\\" not in re.sub(r"<(script|pre)\b.*?</\1>", "", text, flags=re.S)
    row = re.search(r"<tr>\s*<td><code>--method</code>.*?</tr>", text, flags=re.S)
    cells = re.findall(r"<td>(.*?)</td>", row[0], flags=re.S)
    assert cells[1:3] == ["<code>cma-es</code>, <code>least-squares</code>", "<code>cma-es</code>"]
    assert re.search(r"<code>--starts</code></td>\s*<td>whole number</td>\s*<td><code>20</code>", text)
    assert all(tag in text for tag in effect_tags())
    options = (site / "reference" / "api" / "options.html").read_text(encoding="utf-8")
    assert "<td><code>restart</code></td>" in options.partition('id="mmgtune.options.SweepOptions"')[0]
    assert "<code>float | None</code>" in html.unescape(options)


@pytest.mark.long
def test_the_gallery_has_ten_tasks_with_their_pictures(whole):
    text = (whole / "gallery.html").read_text(encoding="utf-8")
    assert len(re.findall(r"<h2\b", text)) == 10
    pictures = re.findall(r'<figure class="made"><img src="(.*?)" alt="(.*?)"', text)
    assert len(pictures) == 10
    for name, words in pictures:
        assert (whole / name).read_text(encoding="utf-8").count("<path") > 5
        assert words
    assert (whole / "made" / "fit" / "report.html").is_file()
    assert "made/fit/figures/tracks.svg" in (whole / "index.html").read_text(encoding="utf-8")


@pytest.mark.long
def test_notebooks_were_run(whole):
    found = html.unescape((whole / "notebooks" / "diagnose.html").read_text(encoding="utf-8"))
    (north,) = re.findall(r"'effects.current.north': '([\d.]+) m/s'", found)
    (east,) = re.findall(r"'effects.current.east': '(-[\d.]+) m/s'", found)
    # What the notebook hides: noise of 0.4 m over ten minutes leaves a thousandth of a metre a second open.
    assert (float(north), float(east)) == pytest.approx((0.3, -0.2), abs=0.004)
    calibrate = (whole / "notebooks" / "calibrate.html").read_text(encoding="utf-8")
    assert calibrate.count("data:image/png;base64,") == 3
    assert "4 of 4 of these trials improve" in calibrate


def test_every_option_says_what_it_means(site):
    from mmgtune import options

    page = re.sub(r"<[^>]*>", "", (site / "reference" / "api" / "options.html").read_text(encoding="utf-8"))
    text = re.sub(r"\s+", " ", html.unescape(page))
    for name in (name for name in options.__all__ if name.endswith("Options")):
        for known in options.choices(getattr(options, name)).values():
            assert known.help.replace("``", "") in text, (name, known.flag)
            assert known.flag in text


def test_two_spaces_after_a_sentence_are_no_list(site):
    from tools.site_docstrings import as_markdown

    assert as_markdown("A ship.  She sails.\n\nname  what it is") == "A ship.  She sails.\n\n- `name`: what it is"
    for page in (site / "reference" / "api").glob("*.html"):
        assert not re.search(r"<li>\s*<p>?<code>[^<]*\.</code>:", page.read_text(encoding="utf-8")), page.name


def test_the_library_pages_hold_the_public_names(site):
    exported = ast.parse((ROOT / "mmgtune" / "__init__.pyi").read_text(encoding="utf-8")).body
    text = "".join(page.read_text(encoding="utf-8") for page in (site / "reference" / "api").glob("*.html"))
    wanted = [f"{node.module}.{node.names[0].name}" for node in exported if isinstance(node, ast.ImportFrom)]
    assert len(wanted) > 40
    assert [name for name in wanted if f'id="mmgtune.{name}"' not in text] == []


@pytest.mark.browser
def test_home(visit):
    page = visit("index.html")
    assert page.inner_text("h1").startswith("mmgtune")
    page.click("text=Tutorial >> nth=0")
    page.wait_for_selector("h1:has-text('From a raw log')")


@pytest.mark.browser
def test_equations_are_shown(visit):
    page = visit("theory/model.html")
    fraction = page.locator("math mfrac").first
    over, under = (fraction.locator("> *").nth(k).bounding_box() for k in (0, 1))
    assert over["y"] + over["height"] <= under["y"] + 1.0  # one above the other: rendered, not spelt out


@pytest.mark.daily("tutorial/index.html")
@pytest.mark.browser
@pytest.mark.parametrize(
    "name",
    [
        "tutorial/index.html",
        "theory/effects.html",
        "reference/commands.html",
        "reference/api/fitting.html",
        "hidden.html",
        "guides/calibrate.html",
        "nomenclature.html",
        "formats.html",
        "esso-osaka.html",
        "kvlcc2.html",
        "limits.html",
        "changelog.html",
    ],
)  # fmt: skip
def test_every_kind_of_page(visit, name):
    page = visit(name)
    assert page.inner_text("h1")
    assert page.evaluate("[...document.images].every(image => image.complete && image.naturalWidth > 0)")


@pytest.mark.browser
def test_a_narrow_screen(visit):
    page = visit("theory/model.html")
    page.set_viewport_size({"width": 400, "height": 800})
    assert page.evaluate(OVERFLOW) <= 0


@pytest.mark.browser
def test_search(visit):
    page = visit("index.html")
    page.focus(".md-search__input")
    ready = "document.querySelector('.md-search-result__meta').textContent.includes('Type to start')"
    page.wait_for_function(ready)  # the theme's own search fails where letters come before its index is there
    page.keyboard.type("gyro bias")
    page.wait_for_selector(".md-search-result__item a")
    assert "matching" in page.inner_text(".md-search-result__meta")
    page.click(".md-search-result__item a >> nth=0")
    page.wait_for_selector("h1")
    assert "index.html" not in page.url.rsplit("/", 1)[-1].split("?")[0]


@pytest.mark.browser
@pytest.mark.parametrize(
    "name",
    [
        "networks.html",
        "reference/commands.html",
        *(pytest.param(name, marks=pytest.mark.long) for name in ("theory/bands.html", "esso-osaka.html")),
    ],
)
def test_no_table_is_cut_at_1400_pixels(browser, site, name):
    cut = """[...document.querySelectorAll('.md-content table')].filter(one => {
      const holder = one.closest('.md-typeset__scrollwrap');
      return holder && one.scrollWidth > holder.clientWidth + 1;
    }).length"""
    with browser.new_context(viewport={"width": 1400, "height": 900}) as context:
        page = context.new_page()
        page.goto((site / name).as_uri())
        assert page.locator(".md-typeset__scrollwrap table").count()
        assert page.evaluate(cut) == 0
