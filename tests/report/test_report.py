"""What a report holds, of whole and of meagre runs."""

from __future__ import annotations

import html
import html.parser
import json
import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

from mmgtune.errors import OptionError
from mmgtune.report import findings, render
from mmgtune.report.blocks import Page, Prose, Section
from mmgtune.report.load import Kind
from mmgtune.report.pages import kinds
from mmgtune.report.wording import shown

from . import fake_run
from .conftest import read

pytestmark = pytest.mark.xdist_group("report")

FIGURES = {"tracks", "distances", "histories", "coefficients", "convergence", "correlation"}


class Outline(html.parser.HTMLParser):
    """Tags, ids and the policy of a page."""

    def __init__(self, text: str):
        super().__init__()
        self.tags: list[str] = []
        self.ids: list[str] = []
        self.sources: list[str] = []
        self.events: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        for name, value in attrs:
            if name == "id":
                self.ids.append(value or "")
            elif name in ("src", "href", "xlink:href"):
                self.sources.append(value or "")
            elif name.startswith("on"):
                self.events.append(name)


def test_files_of_a_fit(fit_folder: Path) -> None:
    assert {path.stem for path in (fit_folder / "figures").glob("*.svg")} == FIGURES
    assert {path.stem for path in (fit_folder / "figures").glob("*.pdf")} == FIGURES
    for path in (fit_folder / "figures").glob("*.svg"):
        ElementTree.parse(path)
    for path in (fit_folder / "figures").glob("*.pdf"):
        assert path.read_bytes().startswith(b"%PDF")


def test_order_of_content(page: str) -> None:
    sections = re.findall(r'<section id="([a-z]+)"', page)
    assert sections == ["motions", "trials", "indices", "coefficients", "next", "bands", "trust", "identifiability",
                        "assumptions", "provenance"]  # fmt: skip
    verdict = page.index("<h1>Within ±50")
    assert verdict < page.index("generated, not measured") < page.index('class="card') < page.index("<section")


def test_a_warning_that_the_banner_says_is_left_out_by_its_code(page: str) -> None:
    assert "Trials start at noisy samples" in page
    assert "as their source says" not in page


def test_page_is_one_file_with_a_strict_policy(page: str) -> None:
    outline = Outline(page)
    assert all(source.startswith(("#", "data:,")) for source in outline.sources)
    assert "default-src 'none'" in page
    assert outline.tags.count("h1") == outline.tags.count("main") == outline.tags.count("nav") == 1
    assert 'lang="en"' in page
    assert "<title>M.V. SUZAKU" in page
    assert outline.events == []


def test_ids_are_unique_and_references_resolve(page: str) -> None:
    outline = Outline(page)
    assert len(outline.ids) == len(set(outline.ids))
    targets = {source[1:] for source in outline.sources if source.startswith("#")}
    targets |= set(re.findall(r'aria-labelledby="([^"]+)"', page))
    assert targets <= set(outline.ids)


def test_every_figure_has_a_caption_and_every_table_a_caption(page: str) -> None:
    tags = Outline(page).tags
    assert tags.count("figure") == tags.count("figcaption") >= 4
    assert tags.count("table") == tags.count("caption") >= 10


def test_numbers_of_the_record_are_on_the_page(fit_folder: Path, page: str) -> None:
    record = json.loads((fit_folder / "fit.json").read_text())
    for row in record["coefficients"]:
        assert f">{row['name'].split('.')[-1]}</th>" in page
        assert html.escape(row["label"]).replace("&#x27;", "&#39;") in page
    for trial in record["trial_results"]:
        assert trial["id"] in page
    assert "3 of 4 restarts" in page
    assert "No coefficient inside the box can be moved" in page
    assert "(1-t_R) eps^2" in page
    assert record["profile"]["sha256"] in page
    assert "licence of the trials" in page
    assert "CC BY-NC 4.0" in page
    assert "Who Measured 2020" in page
    assert "licence, of the data" not in page  # the profile has none
    words = re.sub("</?span>", "", page)
    assert "mmgtune sweep -p ship_profiles/suzaku.toml -t trials/suzaku" in words


def test_options_are_named_as_a_reader_types_them(fit_folder: Path, page: str) -> None:
    assert '<span class="option">--initial</span> estimated removes that.' in page
    assert "--initial estimated removes that." in (fit_folder / "report.md").read_text(encoding="utf-8")


@pytest.mark.long
def test_same_run_same_bytes(fit_folder: Path, tmp_path: Path) -> None:
    again = tmp_path / "elsewhere"
    shutil.copytree(fit_folder, again, ignore=shutil.ignore_patterns("report*", "figures"))
    for path in render(again, pdf=True):
        assert path.read_bytes() == (fit_folder / path.relative_to(again)).read_bytes(), path.name


def test_markdown(fit_folder: Path) -> None:
    text = (fit_folder / "report.md").read_text(encoding="utf-8")
    assert text.startswith("# Within ±50 %")
    for name in FIGURES:
        assert f"](figures/{name}.svg)" in text
    assert r"| turn\_p10 | turning +10 deg | tuned on |" in text
    assert "      mmgtune sweep" in text
    for block in re.findall(r"(?:^\|.*\n)+", text, re.M):
        widths = {len(re.findall(r"(?<!\\)\|", line)) for line in block.splitlines()}
        assert len(widths) == 1, block


HOSTILE = [
    "</script><img src=x onerror=alert(1)>",
    '"><svg onload=alert(1)>',
    "a|b`c*d_e [x](javascript:alert(1)) {{ 7*7 }} $\\frac{1}{0}$ \x01",
    "<!--<script>",
    "&lt;b&gt; 'quoted' \u202e",
]


def test_hostile_names_stay_text(tmp_path: Path) -> None:
    folder = fake_run.make_renamed_fit(tmp_path / "run", HOSTILE)
    assert (
        len({row["id"] for row in json.loads((folder / "fit.json").read_text())["trial_results"]} & set(HOSTILE)) == 5
    )
    render(folder)
    text = read(folder)
    outline = Outline(text)
    assert outline.events == []
    assert "img" not in outline.tags
    assert outline.tags.count("script") == 2
    assert "{{ 7*7 }}" in text
    assert "alert(1)>" not in text
    markdown = (folder / "report.md").read_text(encoding="utf-8")
    prose = "\n".join(line for line in markdown.splitlines() if not line.startswith("      "))
    assert "<img" not in prose
    assert not re.search(r"(?<!\\)\]\(javascript", prose)


def test_hostile_folder_of_a_run_is_no_link(tmp_path: Path) -> None:
    folder = fake_run.make_sweep(tmp_path / "run", runs=False)
    data = json.loads((folder / "sweep.json").read_text())
    for run, out in zip(data["runs"], ("javascript:alert(1)", "../..", "/etc", "a b", ""), strict=True):
        run["out"] = out
    (folder / "sweep.json").write_text(json.dumps(data))
    (folder / "a b").mkdir()
    shutil.copy(fake_run.make_fit(tmp_path / "fit") / "fit.json", folder / "a b")
    with pytest.raises(OptionError, match="not whole"):
        render(folder)
    links = re.findall(r'<td><a href="([^"]+)"', read(folder))
    assert links == ["./a%20b/report.html"]


def test_sweep(sweep_folder: Path) -> None:
    page = read(sweep_folder)
    assert re.search("<h1>On 2 trials not used for tuning, .* is 5.20 m off track and 1.3° off heading", page)
    for value in ("31.4 → 5.2 m", "12 → 1.3°"):  # the same figure on the card
        assert value in page
    assert "Test trials: least off track at a_r = 0.5 (5.2 m) and least off heading at a_r = 0.5 (1.3°)" in page
    assert "Over-fitting from a_r = 0.6" in page
    assert 'href="./ar_0.5/report.html"' in page
    assert (sweep_folder / "ar_0.5" / "report.html").is_file()
    assert "w_P0, C_w" in page
    assert "generated, not measured" in page
    assert {path.name for path in (sweep_folder / "figures").iterdir()} == {
        "misfit.svg", "off.svg", "positions.svg"
    }  # fmt: skip
    assert "tuned with a\\_r = 0.5 is 5.20 m off track" in (sweep_folder / "report.md").read_text(encoding="utf-8")


def test_sweep_without_test_set(tmp_path: Path) -> None:
    folder = fake_run.make_sweep(tmp_path / "run", test=False, runs=False)
    render(folder)
    page = read(folder)
    assert "leaving each trial out in turn" in page
    assert "left out in turn J is least" in page
    assert "Off track, trials left out in turn" in page


def test_importing_costs_nothing() -> None:
    code = (
        "import sys, mmgtune.report;"
        "heavy = {'matplotlib', 'plotly', 'pandas', 'jinja2', 'numpy'} & set(sys.modules);"
        "sys.exit(' '.join(heavy) or 0)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_a_page_is_one_entry(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def build(data: dict[str, str]) -> Page:
        return Page("A voyage", "a test", data["verdict"], sections=(Section("all", "All", (Prose(("Calm.",)),)),))

    kind = Kind("sea-voyage", ("verdict",), lambda _, data: data, build, lambda _: [tmp_path / "leg"])
    monkeypatch.setattr(kinds, "KINDS", (kind, *kinds.KINDS))
    fake_run.make_fit(tmp_path / "leg")
    (tmp_path / "sea_voyage.json").write_text('{"kind": "sea-voyage", "schema": 1, "verdict": "It went well."}')
    written = render(tmp_path)
    assert "<h1>It went well.</h1>" in read(tmp_path)
    assert (tmp_path / "report.md").read_text().startswith("# It went well.")
    assert tmp_path / "leg" / "report.html" in written
    (tmp_path / "sea_voyage.json").write_text('{"kind": "sea-voyage", "schema": 1}')
    with pytest.raises(OptionError, match="lacks verdict"):
        render(tmp_path)
    empty = tmp_path / "empty"
    empty.mkdir()
    with pytest.raises(OptionError, match=r"sea_voyage\.json, diagnosis\.json, sweep\.json, fit\.json"):
        render(empty)


@pytest.mark.parametrize(
    ("name", "file", "first"),
    [
        ("leave-out", "leave_out.json", "# Stopped before its end, after "),
        ("learning", "learning.json", "# The training was stopped before its end. "),
    ],
)
def test_the_first_line_says_that_a_run_was_stopped(
    more: dict[str, Path], tmp_path: Path, name: str, file: str, first: str
) -> None:
    folder = shutil.copytree(more[name], tmp_path / "run")
    data = json.loads((folder / file).read_text(encoding="utf-8"))
    (folder / file).write_text(json.dumps({**data, "interrupted": True}), encoding="utf-8")
    render(folder)
    line = (folder / "report.md").read_text(encoding="utf-8").splitlines()[0]
    assert line.startswith(first)


def test_left_out_trials_are_drawn_and_the_worst_is_named(more: dict[str, Path], tmp_path: Path) -> None:
    folder = more["leave-out"]
    data = json.loads((folder / "leave_out.json").read_text(encoding="utf-8"))
    off = {row["id"]: findings.off_track(row, "after") for row in data["trial_results"]}
    worst, *_, best = sorted(off, key=lambda id: -(off[id] or 0.0))
    said = read(folder)
    assert f"The worst is {worst}, " in said
    assert f"than {best}, " not in said
    whole = data["scores"][0]
    first = f"On trials it has not seen, a tuned model is {shown(whole['position_rms_m_after'], 3)} m off track"
    assert first in said
    marks = (folder / "figures" / "scores.svg").read_text(encoding="utf-8")
    assert all(id in marks for id in off)
    old = tmp_path / "old"  # by a version that kept neither
    old.mkdir()
    del data["trial_results"]
    (old / "leave_out.json").write_text(json.dumps(data), encoding="utf-8")
    assert first in render(old)[0].read_text(encoding="utf-8")
