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

import numpy as np
import pytest

from mmgtune.errors import OptionError, OutputError
from mmgtune.report import render

from . import fake_run
from .conftest import without_library

FIGURES = {"tracks", "distances", "histories", "coefficients", "convergence", "correlation"}


def read(folder: Path) -> str:
    return without_library((folder / "report.html").read_text(encoding="utf-8"))


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
    assert sections == ["trials", "tracks", "histories", "indices", "coefficients", "trust", "identifiability", "next",
                        "assumptions", "provenance"]  # fmt: skip
    verdict = page.index("<h1>Within ±50")
    assert verdict < page.index("generated, not measured") < page.index('class="tile') < page.index("<section")


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
    targets |= set(re.findall(r"url\(#([^)]+)\)", page))
    targets |= set(re.findall(r'aria-labelledby="([^"]+)"', page))
    assert targets <= set(outline.ids)


def test_every_figure_has_a_caption_and_every_table_a_caption(page: str) -> None:
    tags = Outline(page).tags
    assert tags.count("figure") == tags.count("figcaption") >= 6
    assert tags.count("table") == tags.count("caption") >= 10


def test_numbers_of_the_record_are_on_the_page(fit_folder: Path, page: str) -> None:
    record = json.loads((fit_folder / "fit.json").read_text())
    for row in record["coefficients"]:
        assert f">{row['name'].split('.')[-1]}</th>" in page
        assert html.escape(row["label"]).replace("&#x27;", "&#39;") in page
    for trial in record["trial_results"]:
        assert trial["id"] in page
    assert "3 of 4 restarts" in page
    assert "5 of 5 starts" in page
    assert "(1-t_R) eps^2" in page
    assert record["profile"]["sha256"] in page
    assert "mmgtune sweep -p ship_profiles/suzaku.toml -t trials/suzaku" in page


def test_same_run_same_bytes(fit_folder: Path, tmp_path: Path) -> None:
    again = tmp_path / "elsewhere"
    shutil.copytree(fit_folder, again, ignore=shutil.ignore_patterns("report*", "figures"))
    for path in render(again):
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


@pytest.mark.parametrize("name", HOSTILE)
def test_hostile_names_stay_text(name: str, tmp_path: Path) -> None:
    folder = fake_run.make_renamed_fit(tmp_path / "run", "turn_p10", name)
    render(folder)
    text = read(folder)
    outline = Outline(text)
    assert outline.events == []
    assert "img" not in outline.tags
    assert outline.tags.count("script") == 3
    assert "{{ 7*7 }}" in text or "7*7" not in name
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
    links = re.findall(r'<td class=""><a href="([^"]+)"', read(folder))
    assert links == ["./a%20b/report.html"]


def meagre(tmp_path: Path, **changes: object) -> str:
    """The page of a fit with parts of its record replaced."""
    folder = fake_run.write_fit(tmp_path / "run", *fake_run.edited(**changes))
    render(folder)
    return read(folder)


def test_no_test_set(tmp_path: Path) -> None:
    page = meagre(tmp_path, J_test=None, J_test_before=None, at_bound=[])
    assert "no test set" in page
    assert "leave each trial out in turn" in page


def test_least_squares_only(tmp_path: Path) -> None:
    data, history, motions = fake_run.edited(restarts=[])
    data["agreement"] |= {"restarts": 0, "restarts_agreeing": 0, "J_cmaes": None, "relative_difference": None}
    folder = fake_run.write_fit(tmp_path / "run", data, history.iloc[:0], motions)
    render(folder)
    assert "No evolution strategy ran" in read(folder)
    assert not (folder / "figures" / "convergence.svg").exists()


def test_no_history_file_and_a_figure_left_from_before(tmp_path: Path) -> None:
    data, _, motions = fake_run.edited()
    folder = fake_run.write_fit(tmp_path / "run", data, None, motions)
    (folder / "figures").mkdir()
    (folder / "figures" / "convergence.svg").write_text("old")
    render(folder)
    assert not (folder / "figures" / "convergence.svg").exists()


def test_little_is_known(tmp_path: Path) -> None:
    data, history, motions = fake_run.edited(
        stderr={}, identifiability={}, certificate={}, agreement={}, restarts=[], starts=[], assumptions=[],
        citations=[], warnings=[], environment={}, verdict="", J_tune_before=None,
    )  # fmt: skip
    for row in data["coefficients"]:
        row |= {"stderr": None, "at_bound": None, "determined": True}
    for row in data["trial_results"]:
        row |= {"rms": {}, "indices": {}, "J_before": None}
    folder = fake_run.write_fit(tmp_path / "run", data, history, motions)
    render(folder)
    page = read(folder)
    assert '<section id="identifiability"' not in page
    assert '<section id="indices"' not in page
    assert "0 of 12 coefficients" in page


def test_diverged_trial(tmp_path: Path) -> None:
    data, history, motions = fake_run.edited()
    data["trial_results"][0] |= {"status_after": "diverged", "J_after": None}
    first = data["trial_results"][0]["id"]
    late = (motions["trial"] == first) & (motions["which"] == "after") & (motions["t"] > 20)
    motions.loc[late, ["x", "y", "psi", "u", "v_m", "r"]] = np.nan
    folder = fake_run.write_fit(tmp_path / "run", data, history, motions)
    render(folder)
    page = read(folder)
    assert ">diverged</td>" in page
    assert f"fits worst after tuning: {first}" in page


def test_one_sample_gaps_and_nothing_measured(tmp_path: Path) -> None:
    data, history, motions = fake_run.edited()
    names = [row["id"] for row in data["trial_results"]]
    one = motions["trial"] == names[0]
    motions = motions[~one | (motions["t"] == 0.0)].copy()
    motions.loc[motions["trial"] == names[1], ["x", "y", "psi", "u", "v_m", "r", "n", "delta"]] = np.nan
    motions = motions[(motions["trial"] != names[2]) | (motions["which"] != "measured")]
    motions = motions[motions["trial"] != names[3]]
    folder = fake_run.write_fit(tmp_path / "run", data, history, motions)
    render(folder)
    payload = json.loads(re.search(r'id="payload">(.*?)</script>', read(folder), re.S)[1])
    assert len(payload["trials"]) == 7
    assert payload["trials"][0]["data"][0]["mode"] == "markers"


def test_no_trials_and_no_coefficients(tmp_path: Path) -> None:
    data, history, motions = fake_run.edited(trial_results=[], coefficients=[], at_bound=[])
    folder = fake_run.write_fit(tmp_path / "run", data, history, motions.iloc[:0])
    render(folder)
    assert '<section id="provenance"' in read(folder)


def test_many_long_trials_are_thinned(tmp_path: Path) -> None:
    import pandas as pd

    data, history, _ = fake_run.edited()
    row = data["trial_results"][0]
    data["trial_results"] = [{**row, "id": f"trial {place:02d}", "J_after": float(place)} for place in range(50)]
    motion = fake_run.motion(35.0, 4000, 130.0, 3.1, 20.0)
    parts = [
        pd.DataFrame({"trial": trial["id"], "which": which, **motion})
        for trial in data["trial_results"]
        for which in ("measured", "before", "after")
    ]
    folder = fake_run.write_fit(tmp_path / "run", data, history, pd.concat(parts))
    render(folder)
    page = read(folder)
    assert len(page) < 20e6
    assert "least and the greatest sample of every stretch" in page
    assert "Shown are the 16 trials with the greatest J" in page


def test_sweep(sweep_folder: Path) -> None:
    page = read(sweep_folder)
    assert "<h1>Use a_r = 0.5" in page
    assert "Over-fitting: From a_r = 0.5 to 0.6" in page
    assert 'href="./ar_0.5/report.html"' in page
    assert (sweep_folder / "ar_0.5" / "report.html").is_file()
    assert "w_P0, C_w" in page
    assert "generated, not measured" in page
    assert {path.name for path in (sweep_folder / "figures").iterdir()} == {
        "misfit.svg", "misfit.pdf", "positions.svg", "positions.pdf"
    }  # fmt: skip
    assert "# Use a\\_r = 0.5" in (sweep_folder / "report.md").read_text(encoding="utf-8")


def test_sweep_without_test_set(tmp_path: Path) -> None:
    folder = fake_run.make_sweep(tmp_path / "run", test=False, runs=False)
    render(folder)
    page = read(folder)
    assert "leave-one-trial-out" in page
    assert "left out in turn it is least" in page


def test_errors_name_place_and_remedy(tmp_path: Path) -> None:
    folder = tmp_path / "run"
    with pytest.raises(OptionError, match="no such run folder"):
        render(folder)
    folder.mkdir()
    with pytest.raises(OptionError, match="not a run folder"):
        render(folder)
    (folder / "fit.json").write_text("{")
    with pytest.raises(OptionError, match="cannot be read"):
        render(folder)
    (folder / "fit.json").write_text("[]")
    with pytest.raises(OptionError, match="not the record of a fit"):
        render(folder)
    (folder / "fit.json").write_text('{"kind": "fit", "schema": 1}')
    with pytest.raises(OptionError, match="lacks profile, trials"):
        render(folder)
    fake_run.write_fit(folder, *fake_run.edited(schema=2, mmgtune="9.9"))
    with pytest.raises(OptionError, match=r"newer mmgtune") as caught:
        render(folder)
    problem = caught.value.problems[0]
    assert problem.where.endswith("fit.json")
    assert "9.9" in problem.fix


def test_missing_or_broken_motions(tmp_path: Path) -> None:
    data, history, motions = fake_run.fit_data()
    folder = fake_run.write_fit(tmp_path / "run", data, history, None)
    with pytest.raises(OptionError, match="not whole"):
        render(folder)
    (folder / "motions.parquet").write_text("no parquet")
    with pytest.raises(OptionError, match="cannot be read"):
        render(folder)
    motions.drop(columns="psi").to_parquet(folder / "motions.parquet")
    with pytest.raises(OptionError, match="psi"):
        render(folder)


def test_output_that_cannot_be_written(tmp_path: Path) -> None:
    folder = fake_run.make_fit(tmp_path / "run")
    (folder / "figures").write_text("a file where a folder is needed")
    with pytest.raises(OutputError):
        render(folder)


def test_importing_costs_nothing() -> None:
    code = (
        "import sys, mmgtune.report;"
        "heavy = {'matplotlib', 'plotly', 'pandas', 'jinja2', 'numpy'} & set(sys.modules);"
        "sys.exit(' '.join(heavy) or 0)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
