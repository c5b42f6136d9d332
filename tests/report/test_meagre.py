"""Reports of runs that lack something, and folders no report can be made of."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest

from mmgtune.errors import OptionError, OutputError
from mmgtune.files import write_text
from mmgtune.report import render
from mmgtune.report.figures import motions as motions_of_page

from . import fake_run
from .conftest import read

pytestmark = pytest.mark.xdist_group("report")


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


@pytest.mark.long
def test_no_history_file_and_a_figure_left_from_before(tmp_path: Path) -> None:
    data, history, motions = fake_run.edited()
    folder = fake_run.write_fit(tmp_path / "run", data, history, motions)
    for name in ("convergence", "tracks"):  # as if from --pdf, which takes seconds for all figures
        write_text(folder / "figures" / f"{name}.pdf", "")
    render(folder)
    (folder / "figures" / "mine.svg").write_text("somebody's own")
    assert (folder / "figures" / "convergence.svg").exists()
    assert (folder / "figures" / "convergence.pdf").read_bytes().startswith(b"%PDF")
    tracks = (folder / "figures" / "tracks.pdf").read_bytes()
    assert tracks.startswith(b"%PDF")
    (folder / "history.parquet").unlink()
    render(folder)
    assert not (folder / "figures" / "convergence.svg").exists()
    assert not (folder / "figures" / "convergence.pdf").exists()
    assert (folder / "figures" / "mine.svg").exists()
    assert (folder / "figures" / "tracks.pdf").read_bytes() == tracks  # written again, as it was there


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


def test_bands_or_how_to_get_them(tmp_path: Path) -> None:
    data, history, motions = fake_run.fit_data()
    without = fake_run.write_fit(tmp_path / "without", data, history, motions)
    render(without)
    assert "mmgtune posterior -p" in (without / "report.md").read_text()
    advance = {"mean": 3.104, "half_width": 0.21, "low": 2.9, "high": 3.32, "reached": 99, "particles": 100}
    row = {"index": "advance_m", "words": "advance", "unit": "m", "measured": None}
    run = {"id": "turn_p35", "indices": [{**row, **advance, "over_L": {**advance, "measured": None}}]}
    found = {"level": 90.0, "particles": 100, "runs": [run]}
    data["bands"] = {"sentences": ["The trials show little."], "warnings": ["One side alone"], "predicted": found}
    render(fake_run.write_fit(tmp_path / "bands", data, history, motions))
    text = (tmp_path / "bands" / "report.md").read_text()
    assert "mmgtune posterior" not in text
    assert text.index("- One side alone") < text.index("- The trials show little") < text.index("3.10 ± 0.21")
    data["bands"]["predicted"] = None  # a ship that no manoeuvre can be ordered of
    render(fake_run.write_fit(tmp_path / "none", data, history, motions))
    assert "- One side alone" in (tmp_path / "none" / "report.md").read_text()


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
    assert f"Time histories of {first}, which fits worst." in page


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
    payload = json.loads(re.search(r'class="payload">(.*?)</script>', read(folder), re.S)[1])
    assert len(payload["manoeuvres"]) == 7
    assert len(motions_of_page.unpacked(payload["manoeuvres"][0]["runs"]["measured"]["x"])) == 1


def test_no_trials_and_no_coefficients(tmp_path: Path) -> None:
    data, history, motions = fake_run.edited(trial_results=[], coefficients=[], at_bound=[])
    folder = fake_run.write_fit(tmp_path / "run", data, history, motions.iloc[:0])
    render(folder)
    assert '<section id="provenance"' in read(folder)


@pytest.mark.long
def test_many_long_trials_are_thinned(tmp_path: Path) -> None:
    import pandas as pd

    data, history, _ = fake_run.edited()
    row = data["trial_results"][0]
    data["trial_results"] = [
        {**row, "id": f"window {place:03d} of a voyage", "J_after": float(place)} for place in range(150)
    ]
    motion = fake_run.motion(35.0, 1200, 130.0, 3.1, 20.0)
    parts = [
        pd.DataFrame({"trial": trial["id"], "which": which, **motion})
        for trial in data["trial_results"]
        for which in ("measured", "before", "after")
    ]
    folder = fake_run.write_fit(tmp_path / "run", data, history, pd.concat(parts))
    render(folder)
    page = read(folder)
    assert len(page) < 5e6
    assert "the least and the greatest of every stretch" in page
    assert "Shown are 12 of 150, those that fit worst" in page
    assert "Filter rows" in page


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
