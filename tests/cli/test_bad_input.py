"""Bad input: exit code 2, what and where and why and the fix, never a traceback, and nothing written."""

import errno
import os
from dataclasses import replace

import numpy as np
import pytest

from mmgtune.errors import LogError, OptionError, OutputError
from mmgtune.files import write_text
from mmgtune.fitting.checkpoint import Checkpoint
from mmgtune.importing import propose_map
from mmgtune.profile import load_profile
from mmgtune.resources import folder
from mmgtune.run_folders import prepare
from mmgtune.trial import read_trial, write_trial
from tests.command import QUICK, run

SUZAKU = folder("trials") / "suzaku"


@pytest.fixture
def data(tmp_path):
    """A data set of one trial to spoil, with its split."""
    (tmp_path / "data").mkdir()
    trial = read_trial(SUZAKU / "turn_p35.parquet")
    write_text(tmp_path / "data" / "split.toml", 'tune = ["turn_p35"]\n')

    def spoil(**changes):
        return write_trial(replace(trial, **changes), tmp_path / "data" / "turn_p35.parquet", overwrite=True)

    spoil()
    spoil.trial = trial
    return spoil


def refused(ended, *words):
    assert ended.code == 2, ended.err
    assert "Traceback" not in ended.err
    for word in words:
        assert word in ended.err, ended.err


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--ar", "0"), ("a_r is 0", "--ar")),
        (("--ar", "-0.5"), ("a_r is -0.5",)),
        (("--ar", "nan"), ("a_r is nan",)),
        (("--seed", "0"), ("seed is 0", "1 or more")),
        (("--starts", "0"), ("starts is 0",)),
        (("--method", "cmaes"), ("unknown method 'cmaes'", "did you mean 'cma-es'")),
        (("--backend", "cuda"), ("unknown back end 'cuda'",)),
        (("--integrator", "rk5"), ("did you mean 'rk4'",)),
        (("--initial", "estimate"), ("did you mean 'estimated'",)),
        (("--targets", "hull.Y_vvvr"), ("no coefficient is called 'hull.Y_vvvr'", "did you mean")),
        (("--fix", "epsilon"), ("no coefficient is called 'epsilon'",)),
        (("--channels", "x,speed"), ("unknown channel 'speed'",)),
        (("--channels", "x:-1"), ("not a positive number",)),
        (("--fix", "*"), ("no coefficient is left to tune (--fix)", "--fix * leaves out all targets: hull.R_0, ")),
        (("--every", "1e9"), ("has no sample to compare with (--every)", "choose a time below 800 s")),
        (("--every", "1e9", "--window", "5000:6000"), ("has no sample to compare with (--window)",)),
        (("--window", "300:100"), ("is empty",)),
        (("--window", "soon"), ("not a time window", "FIRST:LAST")),
        (("--window", "5000:6000"), ("has no sample to compare with",)),
        (("--profile", "suzuka"), ("no such ship profile", "suzaku")),
        (("--trials", "nowhere"), ("no such trials", "suzaku")),
        (("--resume",), ("--resume needs the folder", "--out")),
        (("--resume", "--out", "new"), ("nothing to resume",)),
        (("--targets", "rudder.slipstream_kt"), ("no coefficient",)),
    ],
    ids=lambda value: "-".join(value) if isinstance(value, tuple) else None,
)
def test_options(tmp_path, arguments, words):
    quick = QUICK if "--method" not in arguments and "--starts" not in arguments else ("--no-report",)
    refused(run("fit", *quick, *arguments, cwd=tmp_path), *words)
    assert not (tmp_path / "runs").exists()


@pytest.mark.parametrize("command", ["sweep", "leave-out", "diagnose"])
def test_all_targets_fixed(tmp_path, command):
    refused(run(command, "--fix", "*", "--ar", "0.5", "--dry-run", cwd=tmp_path), "left to tune (--fix)")


def test_truncated_file(tmp_path, data):
    path = tmp_path / "data" / "turn_p35.parquet"
    path.write_bytes(path.read_bytes()[:5000])
    refused(
        run("fit", *QUICK, "-t", "data", cwd=tmp_path), "the Parquet file is damaged", "turn_p35.parquet", "cut off"
    )


def test_missing_column(tmp_path, data):
    import pyarrow.parquet as pq

    path = tmp_path / "data" / "turn_p35.parquet"
    table = pq.read_table(path)
    pq.write_table(table.rename_columns(["heading" if n == "psi" else n for n in table.column_names]), path)
    refused(run("fit", *QUICK, "-t", "data", cwd=tmp_path), "column 'psi' is missing", "heading", "[rad]")


@pytest.mark.parametrize(
    ("column", "word"), [("delta", "'delta'"), ("psi", "'psi' is in degrees"), ("r", "'r' is in degrees")]
)
def test_degrees_where_radians_belong(tmp_path, data, column, word):
    data(**{column: np.degrees(getattr(data.trial, column))})
    refused(run("fit", *QUICK, "-t", "data", cwd=tmp_path), word, "degrees", "multiply", "pi/180")


@pytest.mark.parametrize("column", ["n", "delta", "t"])
def test_gap_in_an_input(tmp_path, data, column):
    values = getattr(data.trial, column).copy()
    values[100] = np.nan
    data(**{column: values})
    refused(run("fit", *QUICK, "-t", "data", cwd=tmp_path), "row 100")


def test_gap_in_the_motion_does_not_count_and_is_said(tmp_path, data):
    x = data.trial.x.copy()
    x[100:120] = np.nan
    data(x=x)
    ended = run("fit", *QUICK, "--json", "-t", "data", "--out", "run", cwd=tmp_path)
    assert ended.code == 0
    assert any("Gaps" in warning for warning in ended.json()["warnings"])
    checked = run("trials", "check", "data", "--strict", cwd=tmp_path)
    assert checked.code == 1
    assert "'x' has gaps: 20 of 481 samples; the longest has 20 samples" in checked.out


def test_gap_in_the_first_sample(tmp_path, data):
    u = data.trial.u.copy()
    u[0] = np.nan
    data(u=u)
    refused(run("fit", *QUICK, "-t", "data", cwd=tmp_path), "'u' has no value in the first sample")


@pytest.mark.parametrize(("step", "words"), [(0.0, "time repeats"), (-3.0, "time goes back")])
def test_time_that_does_not_increase(tmp_path, data, step, words):
    t = data.trial.t.copy()
    t[50] = t[49] + step
    data(t=t)
    refused(run("fit", *QUICK, "-t", "data", cwd=tmp_path), words, "row 50", "sort")


@pytest.mark.parametrize(
    ("split", "words"),
    [
        ("tune = []", ("no trial tunes",)),
        ("", ("no trial tunes",)),
        ('tune = ["turn_p35", "turn_p35"]', ("named 2 times",)),
        ('tune = ["turn_p35"]\ntest = ["turn_p35"]', ("is both in 'tune' and in 'test'",)),
        ('tune = ["turn_p53"]', ("which is not there", "did you mean 'turn_p35'")),
        ('tunes = ["turn_p35"]', ("unknown key 'tunes'", "did you mean 'tune'")),
        ("tune = [", ("not valid TOML", "correct the line")),
        ('tune = ["turn_p35"]\nship = "kvlcc2"', ("of ship 'suzaku'",)),
    ],
)
def test_split(tmp_path, data, split, words):
    write_text(tmp_path / "data" / "split.toml", split)
    refused(run("fit", *QUICK, "-t", "data", cwd=tmp_path), "split.toml", *words)


def test_two_files_of_one_trial(tmp_path, data):
    write_trial(data.trial, tmp_path / "data" / "copy.parquet")
    refused(run("fit", *QUICK, "-t", "data", cwd=tmp_path), "two files are of trial 'turn_p35'", "copy.parquet")


def test_profile_with_several_mistakes_names_them_all(tmp_path):
    text = load_profile("suzaku").text
    text = (
        text.replace("Y_vvr =", "Y_vvvr =")
        .replace('L_pp = "83.0 m"', 'L_pp = "83.0 kg"')
        .replace("C_b = 0.737", "C_b = 7.37")
    )
    (tmp_path / "ship.toml").write_text(text)
    ended = run("fit", *QUICK, "-p", "ship.toml", cwd=tmp_path)
    refused(
        ended,
        "unknown key 'hull.Y_vvvr'",
        "did you mean 'Y_vvv'",
        "unit 'kg'",
        "'particulars.C_b' = 7.37 is impossible",
    )
    assert "'hull.Y_vvr' is missing" in ended.err
    assert ended.err.count("error: ") == 4
    assert "ship.toml, line " in ended.err


@pytest.mark.parametrize(
    ("before", "after", "word"),
    [
        ("[wake]", "[wakes]", "did you mean 'wake'"),
        ('model = "flapped"', 'model = "flaped"', "unknown rudder model 'flaped'"),
        ("schema = 1", "schema = 2", "schema is 2"),
        ("schema = 1", "schema = true", "schema is True, not 1"),
        ("schema = 1", "schema = 1.0", "schema is 1.0, not 1"),
        ("w_P0 = 0.422", 'w_P0 = "0.422 m"', "pure number"),
        ("w_P0 = 0.422", "w_P0 = true", "not a number"),
        ("w_P0 = 0.422", "w_P0 = nan", "only finite"),
        ("w_P0 = 0.422\n", "", "'wake.w_P0' is missing"),
        ('D_P = "2.80 m"', "D_P = 2.80", "has no unit"),
        ("t_P = 0.080", "t_P = { value = 0.08, bound = 3 }", "did you mean 'bounds'"),
        ("t_P = 0.080", "t_P = { value = 0.08, bounds = [0.1, 0.2] }", "outside its own bounds"),
        ('"hull.R_0",', '"hull.R_O",', "unknown target 'hull.R_O'"),
        ("0, 10, 18, 25,", "0, 10, 25,", "has 9 values, not 10"),
        ("schema = 1", "schema = = 1", "not valid TOML"),
        ('value = "converted"', 'value = "convertet"', "one of: converted, as-printed"),
        ('phi_min = { value = "-10 deg"', 'phi_min = { value = "60 deg"', "not below phi_max"),
    ],
)
def test_profile_mistakes(tmp_path, before, after, word):
    text = load_profile("suzaku").text
    assert before in text
    (tmp_path / "ship.toml").write_text(text.replace(before, after, 1))
    refused(run("profile", "validate", "ship.toml", cwd=tmp_path), word)


def test_output_is_a_file(tmp_path):
    (tmp_path / "run").write_text("mine")
    refused(run("fit", *QUICK, "--out", "run", cwd=tmp_path), "is a file")
    assert (tmp_path / "run").read_text() == "mine"


@pytest.mark.parametrize(
    "line",
    [
        ("fit", "--dry-run"),
        ("sweep", "--dry-run"),
        ("learn", "rnn", "--dry-run"),
        ("trials", "make", "vectwin"),
        ("trials", "import", "a.csv", "--preset", "nmea-0183", "--dry-run"),
        ("fleet", "run", "fleet.toml", "--dry-run"),
        ("simulate", "--turn", "35"),
        ("simulate", "--turn", "35", "--force"),
        ("profile", "compare", "suzaku", "suzaku_fam"),
        ("check", "suzaku", "suzaku"),
        ("posterior",),
    ],
    ids=" ".join,
)
@pytest.mark.parametrize("out", ["mine", "mine/run"])
def test_a_file_in_the_place_of_a_folder_is_told_at_once(tmp_path, line, out):
    (tmp_path / "mine").write_text("mine")
    refused(run(*line, "--out", out, cwd=tmp_path), "the output is a file, not a folder (mine)", "name a folder")
    assert [one.name for one in tmp_path.iterdir()] == ["mine"]


def test_folders_in_folders_beyond_measure(tmp_path):
    deep = 1500 * "a/"
    refused(run("fit", "--no-report", "--out", deep, cwd=tmp_path), "cannot write the output", "too many folders")
    assert not list(tmp_path.iterdir())


def test_names_with_a_zero_byte(tmp_path):
    """The command line cannot hold one; files and programs that name others can."""
    with pytest.raises(OutputError, match="cannot write the output"):
        write_text(tmp_path / "a\0b", "")
    with pytest.raises(LogError, match="cannot be opened"):
        propose_map(["a\0b"])


def test_read_only_folder(tmp_path, monkeypatch):
    monkeypatch.setattr(os, "access", lambda path, mode: False)
    with pytest.raises(OutputError, match="cannot write the output"):
        prepare(tmp_path / "run")


@pytest.mark.parametrize("where", ["replace", "fsync"])
def test_full_disk_leaves_the_old_file_and_no_rest(tmp_path, monkeypatch, where):
    path = write_text(tmp_path / "result.json", "old")

    def full(*_arguments):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, where, full)
    with pytest.raises(OutputError, match="No space left"):
        write_text(path, "new")
    monkeypatch.undo()
    assert path.read_text() == "old"
    assert [p.name for p in tmp_path.iterdir()] == ["result.json"]


def test_full_disk_on_the_command_line(tmp_path):
    """A device that is always full, where the system has one."""
    if not os.path.exists("/dev/full"):
        pytest.skip("no /dev/full on this system")
    ended = run("fit", *QUICK, "--out", "/dev/full", cwd=tmp_path)
    refused(ended, "/dev/full")


def test_broken_checkpoint(tmp_path):
    (tmp_path / "run").mkdir()
    (tmp_path / "run" / "checkpoint.npz").write_bytes(b"PK\x03\x04 not a checkpoint")
    refused(
        run("fit", "--no-report", "--resume", "--out", "run", cwd=tmp_path), "checkpoint cannot be read", "delete it"
    )


def test_damaged_checkpoints(tmp_path):
    """A changed byte of the archive may say that it is encrypted, of a later version, or packed in an unknown way."""
    checkpoint = Checkpoint(tmp_path, {"seed": 1})
    checkpoint.save([np.arange(12.0)])
    written = checkpoint.path.read_bytes()
    listed = written.rindex(b"PK\x01\x02")
    damaged = [written[: listed + at] + b"\x85" + written[listed + at + 1 :] for at in (6, 8, 10)]
    for content in damaged:
        checkpoint.path.write_bytes(content)
        with pytest.raises(OptionError, match="checkpoint cannot be read"):
            checkpoint.load()
    good = {"identity": np.array('{"seed": 1}'), "sizes": np.array([2]), "costs": np.zeros(2)}
    wrong = [{"identity": np.array(text)} for text in ("[1]", "null", 10_000 * "[")]
    wrong += [{"sizes": np.array([1.5, 1.0])}, {"sizes": np.array(2)}, {"costs": np.array(["a", "b"])}]
    for change in wrong:
        np.savez(checkpoint.path, **{**good, **change})
        with pytest.raises(OptionError, match="checkpoint cannot be read"):
            checkpoint.load()


def test_checkpoint_survives_a_failed_save(tmp_path, monkeypatch):
    checkpoint = Checkpoint(tmp_path, {"seed": 1})
    checkpoint.save([np.arange(12.0)])

    def full(*_arguments, **_named):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(np, "savez", full)
    with pytest.raises(OutputError):
        checkpoint.save([np.arange(12.0), np.arange(12.0)])
    assert [c.tolist() for c in checkpoint.load()] == [np.arange(12.0).tolist()]
