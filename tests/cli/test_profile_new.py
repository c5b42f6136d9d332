"""``mmgtune profile new`` and ``profile compare`` as a user types them."""

import io
from importlib import import_module

import pytest

from mmgtune.cli import profiles
from mmgtune.profile import load_profile
from mmgtune.resources import particulars
from tests.command import run, typed

ANSWERS = ("M.V. Ask Me", "83 m", "13.5 m", "3.8 m", "0.737", "12 kn", "", "", "", "", "")


class Terminal(io.StringIO):
    """Somebody who answers."""

    def isatty(self):
        return True


def test_a_profile_from_a_file(tmp_path):
    ended = run("profile", "new", "ship.toml", "--from", "suzaku", "--form", "fam", cwd=tmp_path)
    assert ended.code == 0, ended.err
    assert "88 coefficients, 26 of them free in a fit" in ended.out
    assert "approach at 6 kn with 106 rpm" in ended.out
    assert load_profile(tmp_path / "ship.toml").sections["hull"].component.tag == "derivatives"
    again = run("profile", "new", "ship.toml", "--from", "suzaku", cwd=tmp_path)
    assert again.code == 2
    assert "--force" in again.err


def test_a_profile_by_questions(monkeypatch, capsys):
    wrong = (
        "3,8 m",
        "1, 2 m",
        "3.8 furlongs",
    )  # the first of them was taken, and the file refused after the last answer
    answers = (*ANSWERS[:3], *wrong, *ANSWERS[3:4], "seven", *ANSWERS[4:5], "12 knots", *ANSWERS[6:])
    monkeypatch.setattr("sys.stdin", Terminal("\n".join(answers) + "\n"))
    ship = profiles._asked()
    said = capsys.readouterr().err
    assert "numbers have a decimal point here, as 3.8 m; once more" in said
    assert "'1, 2 m' is 2 numbers, not one; once more" in said
    assert said.count("; once more") == 4
    assert (ship.name, ship.id) == ("M.V. Ask Me", "m_v__ask_me")
    assert ship["particulars", "C_b"] == 0.737
    assert ship["approach", "speed"] == pytest.approx(12 * 1852 / 3600)
    assert ship.get("approach", "n") is None
    assert "propeller" not in ship.values


def test_answers_that_end_too_early_are_said(monkeypatch, tmp_path):
    """Ctrl-D ended with "Aborted." and the exit code of an answer that is no."""
    monkeypatch.setattr("sys.stdin", Terminal("\n".join(ANSWERS[:3]) + "\n"))
    ended = typed("profile", "new", tmp_path / "ship.toml")
    assert ended.code == 2
    assert "the answers ended before the questions" in ended.err
    assert not (tmp_path / "ship.toml").exists()


def test_nobody_to_ask_is_said(tmp_path):
    ended = run("profile", "new", "ship.toml", cwd=tmp_path)
    assert ended.code == 2
    assert "there is nobody to ask for particulars" in ended.err
    assert not (tmp_path / "ship.toml").exists()


def test_what_is_wrong_with_particulars_leaves_nothing(tmp_path):
    (tmp_path / "p.toml").write_text('schema = 1\n[ship]\nname = "x"\nid = "x"\n[particulars]\nC_b = 1.4\n')
    ended = run("profile", "new", "ship.toml", "--from", "p.toml", cwd=tmp_path)
    assert ended.code == 2
    assert "'particulars.C_b' = 1.4 is impossible" in ended.err
    assert "'particulars.L_pp' is missing (length between perpendiculars [m])" in ended.err
    assert "p.toml, line 6" in ended.err
    assert not (tmp_path / "ship.toml").exists()


def test_other_formulas_by_flag(tmp_path):
    ended = run(
        "profile", "new", "a.toml", "--from", "kvlcc2", "--form", "mmg", "--derivatives", "kijima", cwd=tmp_path
    )
    assert ended.code == 2
    assert "--derivatives" in ended.err
    made = run(
        "profile", "new", "a.toml", "--from", "kvlcc2", "--form", "fam", "--derivatives", "clarke",
        "--added-mass", "clarke", "--holtrop", "1982", "--json", cwd=tmp_path,
    )  # fmt: skip
    assert made.json()["options"]["holtrop"] == "1982"
    ship = load_profile(tmp_path / "a.toml")
    assert "Clarke" in ship.coefficient("hull.N_r").source
    assert "1982" in ship.coefficient("wake.w_P0").source


def test_an_output_that_exists_is_found_before_the_work(tmp_path, monkeypatch):
    def work(*_args, **_named):
        raise AssertionError("worked before it looked")

    monkeypatch.setattr("mmgtune.comparing_profiles.compare_profiles", work)
    monkeypatch.setattr("mmgtune.simulating.simulate", work)
    for module, names in (("fitting", ("plan_fit", "plan_sweep", "plan_leave_out")), ("diagnose", ("plan_diagnosis",))):
        for name in names:
            monkeypatch.setattr(import_module(f"mmgtune.{module}"), name, work)
    (tmp_path / "comparison.json").write_text("{}")
    (tmp_path / "turn_p20.parquet").write_text("")
    tuning = (("fit",), ("sweep",), ("leave-out",), ("diagnose",))
    for words in (("profile", "compare", "suzaku", "kvlcc2"), ("simulate", "--turn", "20"), *tuning):
        ended = typed(*words, "--out", tmp_path)
        assert ended.code == 2
        assert "exists already" in ended.err


def test_two_profiles_compared(tmp_path):
    ended = run("profile", "compare", "suzaku", "suzaku_fam", "--out", "both", cwd=tmp_path)
    assert ended.code == 0, ended.err
    assert "turn 35° to starboard, tactical diameter [L_pp]" in ended.out
    assert (tmp_path / "both" / "report.html").is_file()
    again = run("profile", "compare", "suzaku", "suzaku_fam", "--out", "both", cwd=tmp_path)
    assert again.code == 2


@pytest.mark.parametrize("more", [(), ("--force",), ("--from", "suzaku", "--force")])
def test_particulars_are_no_place_for_the_profile_made_of_them(tmp_path, more):
    """They were to be replaced by --force, it said."""
    before = (particulars() / "suzaku.toml").read_text()
    (tmp_path / "my ship.toml").write_text(before)
    ended = run("profile", "new", "my ship.toml", *more, cwd=tmp_path)
    assert ended.code == 2
    assert "my ship.toml holds particulars" in ended.err
    assert "fix: write mmgtune profile new my_ship.toml --from 'my ship.toml'" in ended.err
    assert (tmp_path / "my ship.toml").read_text() == before
