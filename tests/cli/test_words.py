"""What the command line completes, shows of choices, and fits into narrow terminals."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path
from types import SimpleNamespace

import pytest

import mmgtune
from mmgtune import text_tables
from mmgtune.cli import at_home
from mmgtune.effects import effect_tags
from mmgtune.hooks import Phase
from mmgtune.units import in_time
from tests.command import run


def completed(typed, cwd):
    """What bash would be told for a line that is typed so far."""
    words = f"mmgtune {typed}"
    env = {"_MMGTUNE_COMPLETE": "complete_bash", "COMP_WORDS": words, "COMP_CWORD": str(len(words.split(" ")) - 1)}
    code = "import sys; sys.argv = ['mmgtune']; from mmgtune.cli import app; app(prog_name='mmgtune')"
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=cwd, env={**os.environ, **env}, capture_output=True, text=True
    )
    return done.stdout.split()


@pytest.mark.long
def test_the_shell_completes_words_names_and_files(tmp_path):
    (tmp_path / "my_ship.toml").write_text("")
    (tmp_path / "my_notes.txt").write_text("")
    (tmp_path / "my_trials").mkdir()
    assert completed("fit --method ", tmp_path) == ["cma-es", "least-squares"]
    assert completed("diagnose --effects current,wav", tmp_path) == ["current,waves", "current,wave-drift"]
    assert completed("fit --profile suz", tmp_path) == ["suzaku", "suzaku_fam"]
    assert completed("fit --profile my_", tmp_path) == ["my_ship.toml", "my_trials/"]
    assert completed("fit --profile esso_osaka_3m --targets rudder.e", tmp_path) == ["rudder.eps"]
    assert completed("predict esso_osaka_3m_h", tmp_path) == ["esso_osaka_3m_hybrid"]
    assert completed("check suzaku suzaku --format j", tmp_path) == ["json", "junit"]
    assert completed("learn mixture esso_osaka_3m_h", tmp_path) == ["esso_osaka_3m_hybrid"]
    assert completed("learn mixture suzaku a.safetensors esso_osaka_3m_ty", tmp_path) == ["esso_osaka_3m_type1"]
    assert completed("learn mixture suzaku a.safetensors b.safetensors my_t", tmp_path) == ["my_trials/"]


def test_help_shows_the_choices(tmp_path):
    help_text = run("fit", "--help", cwd=tmp_path, env={"COLUMNS": "160"}).out
    assert "cma-es|least-squares" in help_text
    assert "DIR|FILE|NAME" in help_text
    diagnose = " ".join(run("diagnose", "--help", cwd=tmp_path, env={"COLUMNS": "160"}).out.replace("│", " ").split())
    assert all(tag in diagnose for tag in effect_tags())


def test_tables_fit_sixty_columns(tmp_path):
    env = {"COLUMNS": "60"}
    quick = ("--method", "least-squares", "--starts", "1", "--quiet", "--no-report", "--out")
    for command in (
        ("fit", *quick, "f"),
        ("sweep", "--ar", "0.3,0.4,0.5", *quick, "s"),
        ("validate", "suzaku", "suzaku"),
        ("simulate", "--trials", "suzaku"),
    ):
        said = run(*command, cwd=tmp_path, env=env)
        assert said.code == 0, said.err
        table = [line for line in said.out.splitlines() if "  " in line.strip()]
        assert len(table) > 10
        assert max(map(len, table)) <= 60


def test_a_table_cuts_words_and_leaves_out_what_is_spare():
    rows = [("a_name_that_is_rather_long", "1.5", "note")]
    assert text_tables.table(("name", "x", "more"), rows, words=(0, 2)) == [
        "name                          x  more",
        "a_name_that_is_rather_long  1.5  note",
    ]
    assert text_tables.table(("name", "x", "more"), rows, width=32, words=(0, 2), spare=(2,)) == [
        "name                          x",
        "a_name_that_is_rather_long  1.5",
    ]
    assert (
        text_tables.table(("name", "x"), [("a_name_that_is_rather_long", "1.5")], width=20)[1] == "a_name_…er_long  1.5"
    )


def test_a_profile_is_copied_to_be_changed(tmp_path):
    from mmgtune.profile import load_profile

    assert run("profile", "copy", "suzaku", "mine.toml", cwd=tmp_path).out == "wrote mine.toml\n"
    assert load_profile(tmp_path / "mine.toml").sha256 == load_profile("suzaku").sha256
    again = run("profile", "copy", "suzaku", "mine.toml", cwd=tmp_path)
    assert again.code == 2
    assert "--force" in again.err
    assert run("profile", "copy", "suzaku", "mine.toml", "--force", cwd=tmp_path).code == 0
    assert run("profile", "copy", "suzaku", ".", cwd=tmp_path).out == "wrote suzaku.toml\n"


def test_what_is_no_profile_lists_trained_models_too(tmp_path):
    said = run("fit", "-p", "esso_osaka_3m_type1", cwd=tmp_path)
    assert said.code == 2
    assert "it is a trained model" in said.err
    assert "esso_osaka_3m_hybrid" in run("validate", "nope", "suzaku", cwd=tmp_path).err


@pytest.mark.long
def test_a_dry_run_that_nobody_reads_is_no_failure(tmp_path):
    line = f"{sys.executable} -m mmgtune fit --method least-squares --dry-run"
    done = subprocess.run(
        ["bash", "-o", "pipefail", "-c", f"{line} | true"], cwd=tmp_path, capture_output=True, text=True
    )
    assert (done.returncode, done.stderr) == (0, "")


def test_how_long_a_diagnosis_may_still_take(monkeypatch):
    from mmgtune.cli.diagnose import Left

    now = [100.0]
    monkeypatch.setattr(time, "monotonic", lambda: now[0])
    left = Left((30.0, 120.0), most=4)
    assert left.words("re-tuning the model without any cause") == ""
    now[0] = 110.0
    assert left.words(Phase("looking for a cause", look=1)) == "about 20 s to 1.8 min left"
    now[0] = 150.0
    assert left.words(Phase("looking for a cause", look=1)) == "up to 70 s left"
    now[0] = 170.0  # the first look took a minute; three more may follow
    assert left.words(Phase("looking for cause 2", look=2)) == "up to 3 min more of looking"
    assert left.words("comparing the causes with their rivals") == ""
    now[0] = 400.0  # it said "up to 1 s left" from then on
    assert left.words(Phase("looking for cause 2", look=2)) == "longer than was reckoned, 5 min so far"


def test_a_first_look_that_takes_longer_than_reckoned(monkeypatch):
    from mmgtune.cli.diagnose import Left

    now = [0.0]
    monkeypatch.setattr(time, "monotonic", lambda: now[0])
    left = Left((30.0, 120.0), most=4)
    assert left.words(Phase("looking for a cause", look=1)) == "about 30 s to 2 min left"
    now[0] = 119.0
    assert left.words(Phase("looking for a cause", look=1)) == "up to 1 s left"
    now[0] = 240.0
    assert left.words(Phase("looking for a cause", look=1)) == "longer than was reckoned, 4 min so far"


def test_the_time_left_is_that_of_the_measured_pace(monkeypatch):
    """A resumed run said "about 1 s left" for an hour: what it had done before was taken for work of now."""
    from mmgtune.cli.pace import Pace

    now = [1000.0]
    monkeypatch.setattr(time, "monotonic", lambda: now[0])
    pace = Pace()
    assert pace.left(900, 100) == ""  # done before
    now[0] += 1.0
    assert pace.left(901, 99) == ""  # too short to tell
    now[0] += 9.0
    assert pace.left(910, 90) == "about 90 s left"
    for done in range(911, 931):  # it becomes five times slower
        now[0] += 5.0
        said = pace.left(done, 1000 - done)
    assert said == "about 5.8 min left"
    assert pace.left(1000, 0) == ""
    assert pace.left(10, 90) == ""  # begun anew


def test_progress_says_how_long_it_has_been_where_the_rest_is_not_known(monkeypatch, capsys):
    from mmgtune.cli.progress import Progress

    now = [0.0]
    monkeypatch.setattr(time, "monotonic", lambda: now[0])
    progress = Progress(False, Path("run"))
    hooks = progress.hooks()
    hooks.on_phase("measuring the gain")
    for now[0] in (1.0, 59.0, 61.0, 70.0, 150.0):
        assert not hooks.stop()
    progress.on_share(50, 100, "seed 1")
    now[0] = 160.0
    progress.on_share(60, 100, "seed 1")
    assert capsys.readouterr().err.splitlines() == [
        "measuring the gain",
        "measuring the gain, 61 s so far",
        "measuring the gain, 2.5 min so far",
        "seed 1: 60 %, about 40 s left",
    ]


def test_least_squares_and_parts_left_out_say_how_long_they_take(monkeypatch, capsys):
    from mmgtune.cli.progress import Progress

    now = [0.0]
    monkeypatch.setattr(time, "monotonic", lambda: now[0])
    progress = Progress(False, Path("run"))
    hooks = progress.hooks()
    hooks.on_phase("fitting all runs")
    for done in (0, 100, 200, 300, 1100):
        now[0] += 6.0
        hooks.on_progress(done, 1000, "evaluations")
        hooks.stop()
    for k in range(3):
        hooks.on_progress(k, 3, "parts")
        hooks.on_phase(f"leaving out {'abc'[k]}")
        now[0] += 6.0
        hooks.stop()
    assert capsys.readouterr().err.splitlines() == [
        "fitting all runs",
        "fitting all runs: 0 evaluations, 6 s so far",
        "fitting all runs: 100 evaluations, about 54 s left of it",
        "fitting all runs: 200 evaluations, about 48 s left of it",
        "fitting all runs: 300 evaluations, about 42 s left of it",
        "fitting all runs: more than the usual 1000 evaluations, 30 s so far",
        "leaving out a, 0 of 3 parts done, 30 s so far",
        "leaving out a: 0 of 3 parts done, 36 s so far",
        "leaving out b, 1 of 3 parts done, about 12 s left",
        "leaving out b: 1 of 3 parts done, about 6 s left",
        "leaving out c, 2 of 3 parts done, about 6 s left",
        "leaving out c: 2 of 3 parts done, 48 s so far",
    ]


def test_fits_and_leaving_out_tell_how_far_they_have_come():
    told = []
    hooks = mmgtune.Hooks(on_progress=lambda *of: told.append(of))
    few = {"targets": ("hull.R_0",), "starts": 2, "a_r": 0.5}
    mmgtune.fit("suzaku", "suzaku", mmgtune.FitOptions(method="least-squares", **few), hooks=hooks)
    done = [done for done, _, noun in told if noun == "evaluations"]
    assert done[0] < 10  # what it begins with
    assert done == sorted(done)
    assert done[-1] < told[0][1]
    told.clear()
    mmgtune.leave_out("suzaku", "suzaku", mmgtune.LeaveOutOptions(folds=2, **few), hooks=hooks)
    assert {noun for _, _, noun in told} == {"evaluations", "parts"}
    assert [(done, of) for done, of, noun in told if noun == "parts"] == [(0, 2), (1, 2)]


def test_a_search_with_more_generations_than_usual_says_so(monkeypatch, capsys):
    from mmgtune.cli.progress import Progress
    from mmgtune.fitting.cmaes import LAMBDAS, USUAL_GENERATIONS, Generation

    now = [100.0]
    monkeypatch.setattr(time, "monotonic", lambda: now[0])
    progress = Progress(False, Path("run"))
    last, usual = len(LAMBDAS) - 1, USUAL_GENERATIONS[-1]

    def tell(generation: int) -> str:
        one = Generation(last, generation, 10 * generation, LAMBDAS[-1], 1.0, 1.0, 0.1)
        progress.hooks().on_generation(SimpleNamespace(history=[one], J=1.0, diverged=0))
        now[0] += 10.0
        return capsys.readouterr().err.strip().rpartition("lost 0, ")[2]

    assert tell(usual - 4) == "1 s so far"
    assert tell(usual - 3) == "about 30 s left of it"
    assert tell(usual - 1) == "about 10 s left of it"
    assert tell(usual + 1) == f"more than the usual {usual} generations, 30 s so far"


@pytest.mark.parametrize(
    ("seconds", "words"), [(0.2, "1 s"), (42.0, "42 s"), (330.0, "5.5 min"), (7200.0, "2 h"), (5e5, "139 h")]
)
def test_times_in_words(seconds, words):
    assert in_time(seconds) == words


@pytest.mark.parametrize("command", [("fit",), ("fleet", "run")])
def test_flags_that_turn_something_off_show_no_default(tmp_path, command):
    text = " ".join(run(*command, "--help", cwd=tmp_path, env={"COLUMNS": "160"}).out.replace("│", " ").split())
    assert "--no-" in text
    assert "default: True" not in text


@pytest.mark.parametrize(
    ("typed", "read"),
    [
        ("~", "/home/jo"), ("~/map.toml", "/home/jo/map.toml"), ("--out=~/a ~b", "--out=/home/jo/a ~b"),
        ("~$log.xlsx", "~$log.xlsx"), ("./~/map.toml", "./~/map.toml"), ("--set=a~/b", "--set=a~/b"),
        ("a ~/b", "a ~/b"),
    ],
)  # fmt: skip
def test_the_tilde_is_the_home_folder(typed, read, monkeypatch):
    monkeypatch.setenv("HOME", "/home/jo")
    assert at_home(typed) == read


def test_quoted_tildes_make_no_folder_of_that_name(tmp_path):
    (tmp_path / "home").mkdir()
    ended = run("profile", "copy", "suzaku", "~/own.toml", cwd=tmp_path, env={"HOME": str(tmp_path / "home")})
    assert ended.code == 0, ended.err
    assert (tmp_path / "home" / "own.toml").is_file()
    assert not (tmp_path / "~").exists()
