"""The run folder: one run at a time, and what a killed run left is no obstacle."""

import fcntl
import multiprocessing
import os
import resource
from dataclasses import replace
from datetime import datetime
from pathlib import Path

import pytest

from mmgtune import run_files
from mmgtune.errors import OutputError, ProfileError
from mmgtune.estimating import read_particulars
from mmgtune.files import all_or_none, atomic, remove_left_overs, write_text
from mmgtune.fitting.sweeping import folder_name
from mmgtune.profile import load_profile, parse_profile
from mmgtune.resources import folder
from mmgtune.run_folders import MARKS, claimed, prepare
from mmgtune.trial import load_trials, write_trial
from tests.command import run, start, typed


def killed_while_writing(path):
    """What SIGKILL leaves of a file."""
    with atomic(path) as part:
        part.write_text("half")
        os.link(part, str(part) + ".kept")
    path.unlink()
    os.rename(str(part) + ".kept", part)
    return part


@pytest.mark.parametrize("name", ["profile.toml", "report.html", "motions.parquet"])
def test_a_folder_with_a_profile_of_ones_own_is_no_run(tmp_path, name):
    """With --force a fit wrote over the user's profile among trials of the user's."""
    (tmp_path / name).write_text("mine")
    with pytest.raises(OutputError, match="not a run of mmgtune"):
        claimed(tmp_path, force=True).__enter__()
    assert (tmp_path / name).read_text() == "mine"


def test_every_result_tells_a_run_folder(tmp_path):
    """Else its command would refuse its own folder with --force."""
    records = {name for name in vars(run_files).values() if isinstance(name, str) and name.endswith(".json")}
    named = records - {run_files.FLEET, run_files.JOBS, run_files.JOB, run_files.INFORMATION}
    assert len(named) > 8
    assert named <= set(MARKS)
    for _ in range(2):
        ended = typed("validate", "suzaku", "suzaku", "--force", "--no-report", "--out", tmp_path / "run")
        assert ended.code == 0, ended.err


def test_what_another_run_left_goes_where_force_lets_one_in(tmp_path):
    """A report of the fit before lay beside the new result, and a sweep left its profile to be taken for its own."""
    for name in ("fit.json", "profile.toml", "report.html", "notes.txt", "figures/tracks.svg"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text("before")
    with claimed(tmp_path, force=True, anew=True):
        write_text(tmp_path / "sweep.json", "after")
        write_text(tmp_path / "profile.toml", "after")
    there = {str(one.relative_to(tmp_path)): one.read_text() for one in tmp_path.rglob("*") if one.is_file()}
    assert there == {"sweep.json": "after", "profile.toml": "after", "notes.txt": "before"}
    with pytest.raises(KeyboardInterrupt), claimed(tmp_path, force=True, anew=True):
        stopped()
    assert (tmp_path / "sweep.json").exists()
    with claimed(tmp_path, force=True):  # of one that adds to the folder
        pass
    assert (tmp_path / "sweep.json").exists()


def stopped(note=None):
    if note:
        note.write_text("so far")
    raise KeyboardInterrupt


@pytest.mark.parametrize("given", ["-p here/profile.toml", "-p here", "-t here/turn_p35.parquet"])
def test_what_a_command_reads_does_not_go_with_what_is_replaced(tmp_path, given):
    """With --force a simulation took away the fit whose profile it had read."""
    here = tmp_path / "here"
    here.mkdir()
    write_text(here / "profile.toml", load_profile("suzaku").text)
    write_text(here / "fit.json", "{}")
    write_trial(load_trials("suzaku").trials["turn_p35"], here / "turn_p35.parquet")
    before = {path.name: path.read_bytes() for path in here.iterdir()}
    orders = () if "-t" in given else ("--turn", "35")
    ended = run("simulate", *given.split(), *orders, "--out", "here", "--force", "--no-report", cwd=tmp_path)
    assert ended.code == 2
    assert "the folder holds what is read" in ended.err
    assert {path.name: path.read_bytes() for path in here.iterdir()} == before


def test_of_a_refused_command_no_folder_stays_that_it_made(tmp_path):
    (tmp_path / "mine").mkdir()
    with pytest.raises(KeyboardInterrupt), claimed(tmp_path / "mine" / "runs" / "one"):
        stopped()
    assert list((tmp_path / "mine").iterdir()) == []
    with pytest.raises(KeyboardInterrupt), claimed(tmp_path / "mine" / "runs" / "two") as own:
        stopped(own / "journal")
    assert (tmp_path / "mine" / "runs" / "two" / "journal").exists()


def test_a_folder_belongs_to_one_run(tmp_path):
    second = claimed(tmp_path / "run", force=True)
    with claimed(tmp_path / "run"), pytest.raises(OutputError, match="another run is writing there"):
        second.__enter__()
    with claimed(tmp_path / "run"):
        pass
    assert list((tmp_path / "run").iterdir()) == []


@pytest.mark.parametrize("command", ["fit", "sweep", "leave-out", "diagnose"])
def test_every_long_command_claims_its_folder(tmp_path, command):
    (tmp_path / "run").mkdir()
    handle = os.open(tmp_path / "run", os.O_RDONLY)
    fcntl.flock(handle, fcntl.LOCK_EX)
    ended = typed(command, "--targets", "R_0,w_P0", "--out", tmp_path / "run")
    os.close(handle)
    assert ended.code == 2
    assert "another run is writing there" in ended.err
    assert list((tmp_path / "run").iterdir()) == []


def _claim(folder, barrier, results):
    barrier.wait()
    try:
        with claimed(folder):
            results.put("claimed")
            (folder / "fit.json").write_text("{}")
    except OutputError as error:
        results.put(error.problems[0].what)


def test_of_many_at_once_one_gets_it(tmp_path):
    """Also where the folder has to be made."""
    context = multiprocessing.get_context("forkserver")  # this process may have threads by now
    context.set_forkserver_preload(["tests.cli.test_folders"])
    for k in range(10):
        barrier, results = context.Barrier(4), context.Queue()
        folder = tmp_path / str(k)
        started = [context.Process(target=_claim, args=(folder, barrier, results)) for _ in range(4)]
        for one in started:
            one.start()
        said = [results.get(timeout=20) for _ in started]
        for one in started:
            one.join()
        assert said.count("claimed") == 1, said


@pytest.mark.parametrize("how", [{}, {"force": True}, {"resume": True}])
def test_half_a_file_of_a_killed_run_is_no_obstacle(tmp_path, how):
    part = killed_while_writing(tmp_path / "checkpoint.npz")
    assert part.exists()
    with claimed(tmp_path, **how):
        assert not part.exists()


def test_files_of_others_are(tmp_path):
    (tmp_path / ".mine.part").write_text("mine")
    with pytest.raises(OutputError, match="exists already"):
        prepare(tmp_path)


def test_each_half_width_has_its_folder():
    widths = (0.2, 0.20000001, 0.3, 1.0, 1 / 3, 0.333333)
    assert len({folder_name(one) for one in widths}) == len(widths)
    assert folder_name(0.2) == "ar_0.2"
    assert folder_name(1.0) == "ar_1"


@pytest.mark.parametrize("name", ["x/../../y", "..", "/etc", "a\\nb", "\\u001b[2J", "a" * 200, " "])
def test_an_id_stays_inside_runs(name):
    text = load_profile("suzaku").text
    assert 'id = "suzaku"' in text
    with pytest.raises(ProfileError, match=r"'id' of \[ship\]"):
        parse_profile(text.replace('id = "suzaku"', f'id = "{name}"', 1))


def test_two_runs_within_a_second_have_a_folder_each(tmp_path, monkeypatch):
    """The second ended with "the output exists already", though nobody had named it."""
    from mmgtune.cli import common

    class Clock(datetime):
        @classmethod
        def now(cls):
            return cls(2026, 1, 1)

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(common, "datetime", Clock)
    ship = load_profile("suzaku")
    for k in range(3):
        folder = common.default_out(ship)
        assert folder == Path("runs") / f"20260101-000000-suzaku{f'-{k + 1}' if k else ''}"
        assert folder.is_dir()


def test_a_folder_that_hides_bundled_trials_is_named_once(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "suzaku").mkdir()
    trial = load_trials(folder("trials") / "suzaku").trials["turn_p35"]
    write_trial(replace(trial, id="own"), tmp_path / "suzaku" / "own.parquet")
    ended = run("validate", "suzaku", "suzaku", "--json", cwd=tmp_path)
    assert ended.code == 0, ended.err
    assert [row["id"] for row in ended.json()["profiles"][0]["trials"]] == ["own"]
    said = f"warning: 'suzaku' is {tmp_path / 'suzaku'}, not what is bundled under that name, which is "
    assert ended.err.count(said + str(folder("trials") / "suzaku")) == 1
    assert ended.err.count("bundled") == 1  # the folder is no profile, and hides none


def test_files_that_hide_bundled_profiles_and_particulars(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "kvlcc2").write_text(load_profile("suzaku").text)
    with pytest.warns(UserWarning, match="not what is bundled"):
        assert load_profile("kvlcc2").id == "suzaku"
    (tmp_path / "suzaku").write_text((folder("ship_profiles") / "particulars" / "kvlcc2.toml").read_text())
    with pytest.warns(UserWarning, match="not what is bundled"):
        assert read_particulars("suzaku").id == "kvlcc2"


def test_the_bundled_folder_itself_hides_nothing(monkeypatch):
    monkeypatch.chdir(folder("trials"))
    assert "turn_p35" in load_trials("suzaku").trials  # a warning would be an error


def test_halves_of_files_are_removed_from_runs_in_a_run_too(tmp_path):
    left = [tmp_path / folder / f".{name}.abcd1234.part" for folder, name in ((".", "a"), ("b", "c"), ("b/d", "e.svg"))]
    kept = tmp_path / "b" / "d" / ".mine.part"
    for path in (*left, kept):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
    remove_left_overs(tmp_path)
    assert [path for path in (*left, kept) if path.exists()] == [kept]


def test_a_link_to_nowhere_is_not_replaced_silently(tmp_path):
    link = tmp_path / "ship.toml"
    link.symlink_to("unmounted/ship.toml")
    ended = run("profile", "copy", "suzaku", "ship.toml", cwd=tmp_path)
    assert ended.code == 2
    assert "the output exists already" in ended.err
    assert link.is_symlink()


def test_a_folder_of_simulations_is_one_run(tmp_path):
    """A second one lay its runs beside the first's, and replaced its record and its report."""
    first, second = ("simulate", "--turn", "35", "--out", "out"), ("simulate", "--turn", "20", "--out", "out")
    assert run(*first, "--no-report", cwd=tmp_path).code == 0
    assert run("report", "out", cwd=tmp_path).code == 0  # the record is there without its report
    before = (tmp_path / "out" / "simulate.json").read_bytes()
    ended = run(*second, cwd=tmp_path)
    assert (ended.code, "exists already" in ended.err) == (2, True)
    assert (tmp_path / "out" / "simulate.json").read_bytes() == before
    assert run(*second, "--force", cwd=tmp_path).code == 0
    assert "turn_p20" in (tmp_path / "out" / "simulate.json").read_text()
    ended = run("profile", "compare", "suzaku", "kvlcc2", "--out", "out", cwd=tmp_path)
    assert (ended.code, "exists already" in ended.err) == (2, True)


def test_two_commands_at_one_time_have_a_folder_each(tmp_path, monkeypatch):
    """The folder was looked for first and made later, and the second ended with "another run is writing there"."""
    from mmgtune.cli import common

    monkeypatch.chdir(tmp_path)
    ship = load_profile("suzaku")
    one, other = common.default_out(ship), common.default_out(ship)
    assert one != other
    (one / "fit.json").touch()
    common.tidy()
    assert (one.is_dir(), other.exists()) == (True, False)


def test_a_name_that_no_folder_can_have_is_refused_with_a_way_out(tmp_path):
    for name in (300 * "a", f"{300 * 'a'}/run"):
        ended = run("simulate", "-p", "suzaku", "--turn", "35", "--out", name, cwd=tmp_path)
        assert ended.code == 2
        assert "cannot write the output" in ended.err
        assert "why: File name too long" in ended.err
        assert "fix: write a shorter name" in ended.err
    assert not list(tmp_path.iterdir())


def test_a_link_to_nothing_is_refused_as_what_it_is(tmp_path):
    """It was "File exists: choose a folder with room"."""
    (tmp_path / "link").symlink_to("nowhere")
    for name in ("link", "link/run"):
        ended = run("simulate", "-p", "suzaku", "--turn", "35", "--out", name, cwd=tmp_path)
        assert ended.code == 2
        assert "cannot write the output (link)" in ended.err
        assert "why: it is a link to nowhere, which is not there" in ended.err
    assert [path.name for path in tmp_path.iterdir()] == ["link"]


def test_where_one_file_of_several_cannot_be_written_none_stays(tmp_path):
    old = write_text(tmp_path / "old.txt", "before")
    (tmp_path / "folder").mkdir()

    @all_or_none()
    def write():
        write_text(old, "after")
        write_text(tmp_path / "new.txt", "new")
        write_text(tmp_path / "folder", "a folder is there")

    with pytest.raises(OutputError):
        write()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["folder", "old.txt"]


def test_a_result_too_large_for_the_place_leaves_what_resume_needs(tmp_path):
    """Of a fit profile.toml and history.parquet stayed, and no fit.json."""
    fit = ("fit", "--method", "least-squares", "--starts", "1", "--targets", "hull.Y_v", "--no-report", "--out", "run")
    limit = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (8192, limit[1]))  # commands take it over
    try:
        process = start(*fit, cwd=tmp_path)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limit)
    _, said = process.communicate(timeout=300)
    assert process.returncode == 2, said
    assert "cannot write the output" in said
    assert [path.name for path in (tmp_path / "run").iterdir()] == ["journal.jsonl"]
    ended = run(*fit, "--resume", cwd=tmp_path)
    assert ended.code == 0, ended.err
