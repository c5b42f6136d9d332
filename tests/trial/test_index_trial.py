"""Files of stated indices: what they say, everything that can be wrong in them, and how they live with time series."""

import pytest

from mmgtune.errors import TrialError
from mmgtune.manoeuvres import StoppingIndices, TurningIndices, ZigzagIndices
from mmgtune.trial import load_trials
from mmgtune.trial.index_trial import INDICES, shown_index
from mmgtune.units import DEG, KNOT
from tests.command import run

TURN = """schema = 1
[trial]
id = "turn_35"
ship = "kvlcc2"
manoeuvre = "turning"
order = "35 deg"
approach_speed = "15.5 kn"
n = "106 rpm"
source = "measured"
[trial.indices]
advance = { value = "3.01 L", tolerance = "0.1 L" }
tactical_diameter = { value = "1050 m", tolerance = "30 m" }
transfer = "400 m"
"""
ZIGZAG = """schema = 1
[[trial]]
id = "zz_20"
manoeuvre = "zigzag"
order = "20/20 deg to port"
[trial.indices]
overshoot_1 = { value = "8.5 deg", tolerance = "1 deg" }
[[trial]]
id = "stop"
manoeuvre = "stopping"
order = "-60 rpm"
[trial.indices]
track_reach = "12 L"
"""


def load(folder, text, name="report.toml"):
    (folder / name).write_text(text)
    return load_trials(folder)


def test_what_a_file_says(tmp_path):
    data = load(tmp_path, TURN)
    one = data.stated["turn_35"]
    assert data.tune_stated == ("turn_35",)
    assert (data.trials, data.tune, data.ship) == ({}, (), "kvlcc2")
    assert (one.manoeuvre, one.rudder, one.check, one.source) == ("turning", 35 * DEG, None, "measured")
    assert (one.approach_speed, one.n) == (pytest.approx(15.5 * KNOT), pytest.approx(106 / 60))
    stated = one.stated(320.0)
    assert stated["advance"] == (pytest.approx(963.2), pytest.approx(32.0))
    assert stated["tactical_diameter"] == (1050.0, 30.0)
    assert stated["transfer"] == (400.0, pytest.approx(40.0))
    assert [one.indices[name].assumed for name in stated] == [False, False, True]
    assert shown_index("overshoot_1", 8.5 * DEG) == (pytest.approx(8.5), "deg")


def test_several_trials_a_file_and_several_files(tmp_path):
    (tmp_path / "a.toml").write_text(ZIGZAG)
    data = load(tmp_path, TURN, "b.toml")
    assert list(data.stated) == ["zz_20", "stop", "turn_35"]
    assert data.stated["zz_20"].rudder == pytest.approx(-20 * DEG)
    assert data.stated["zz_20"].check == pytest.approx(20 * DEG)
    assert data.stated["stop"].astern == pytest.approx(-1.0)
    assert data.stated["zz_20"].order == "zigzag 20/20 deg, to port first"
    (tmp_path / "split.toml").write_text('ship = "kvlcc2"\ntune = ["turn_35"]\ntest = ["zz_20"]\n')
    data = load_trials(tmp_path)
    assert (data.tune_stated, data.test_stated, data.others) == (("turn_35",), ("zz_20",), ("stop",))
    assert load_trials(tmp_path / "b.toml").tune_stated == ("turn_35",)


def test_other_files_in_the_folder_are_left_alone(tmp_path):
    (tmp_path / "map.toml").write_text('[columns]\nt = "time"\n')
    assert list(load(tmp_path, TURN).stated) == ["turn_35"]


@pytest.mark.parametrize(
    ("before", "after", "said"),
    [
        ('"35 deg"', '"35"', "order is"),
        ('"35 deg"', '"20/20 deg"', "order is"),
        ('"35 deg"', '"-35 deg to starboard"', "its sign says port"),
        ('"35 deg"', '"350 deg"', "between 0 and 90 deg"),
        ('"turning"', '"spiral"', "spiral"),
        ('manoeuvre = "turning"', "", "no manoeuvre"),
        ('id = "turn_35"', "", "no id"),
        ('"turn_35"', '"a/b"', "name of a file"),
        ('"15.5 kn"', '"15.5 m"', "unit 'm'"),
        ('"15.5 kn"', '"-3 kn"', "approach_speed"),
        ('"106 rpm"', '"0 rpm"', "n is"),
        ("advance", "advanse", "unknown index 'advanse'"),
        ("advance", "overshoot_1", "none of a turning"),
        ('"3.01 L"', '"3.01"', "no unit"),
        ('"3.01 L"', '"3.01 deg"', "unit 'deg'"),
        ('"3.01 L"', '"-3.01 L"', "no ship does that"),
        ('"3.01 L"', '"nan L"', "not a finite number"),
        ('"3.01 L"', '"1e999 m"', "one number"),
        ('"0.1 L"', '"0 L"', "tolerance of advance"),
        ('"0.1 L"', '"1e-300 L"', "nothing at sea is known to a millionth"),
        ('"30 m"', '"0.001 m"', "give one of 0.002 m or more"),
        ('"400 m"', '"1e-300 m"', "no ship does that"),
        ('"0.1 L"', '"10 m"', "different units"),
        ('"1050 m"', '"300 m"', "transfer is not below tactical_diameter"),
        ("tolerance =", "sigma =", "advance.sigma"),
        ("schema = 1", "schema = 2", "schema is 2"),
        ("source =", "sauce =", "unknown key 'sauce'"),
        ('"measured"', '"guessed"', "guessed"),
        ("schema = 1", "schema = ", "not valid TOML"),
        ("[trial.indices]", "[trial.other]", "no indices"),
    ],
)
def test_what_is_wrong_is_said(tmp_path, before, after, said):
    text = TURN.replace(before, after, 1)
    assert text != TURN
    with pytest.raises(TrialError) as error:
        load(tmp_path, text)
    words = "\n".join(f"{p.what} {p.where} {p.why} {p.fix}" for p in error.value.problems)
    assert said in words
    assert "report.toml" in words


def test_everything_wrong_is_said_at_once(tmp_path):
    text = TURN.replace("35 deg", "35").replace("advance", "advanse").replace("15.5 kn", "15.5 m")
    with pytest.raises(TrialError) as error:
        load(tmp_path, text)
    assert len(error.value.problems) == 3


def test_ids_are_told_apart_across_files(tmp_path):
    (tmp_path / "a.toml").write_text(TURN)
    with pytest.raises(TrialError, match="two trials are called 'turn_35'"):
        load(tmp_path, TURN, "b.toml")


def test_a_set_is_of_one_ship(tmp_path):
    (tmp_path / "a.toml").write_text(TURN)
    with pytest.raises(TrialError, match="is of ship 'other'"):
        load(tmp_path, TURN.replace("kvlcc2", "other").replace("turn_35", "b"), "b.toml")


def test_every_index_is_one_the_program_computes():
    """Names are the fields of what reads records, but for the number behind an overshoot."""
    of = {"turning": TurningIndices, "zigzag": ZigzagIndices, "stopping": StoppingIndices}
    for name, index in INDICES.items():
        for manoeuvre in index.of:
            field = "overshoot" if name.startswith("overshoot") else name
            assert field in of[manoeuvre].__dataclass_fields__, (name, manoeuvre)
        assert (index.share > 0.0) != (index.absolute > 0.0)


def test_commands_of_trials_take_them(tmp_path):
    (tmp_path / "report.toml").write_text(TURN)
    (tmp_path / "bad.toml").write_text(ZIGZAG.replace("overshoot_1", "overshot"))
    said = run("trials", "check", "report.toml", cwd=tmp_path)
    assert (said.code, said.out.split(" ")[0]) == (0, "1")
    said = run("trials", "inspect", "report.toml", cwd=tmp_path)
    assert said.code == 0, said.err
    assert "turning, 35 deg to starboard (measured), tune" in said.out
    assert "3.01 +- 0.1 L" in said.out
    assert "tolerance assumed" in said.out
    assert run("trials", "inspect", "report.toml", "--json", cwd=tmp_path).json()["stated"][0]["id"] == "turn_35"
    said = run("trials", "check", "bad.toml", cwd=tmp_path)
    assert said.code == 2
    assert "unknown index 'overshot'" in said.err
    assert "overshoot_1" in said.err
    for command in (
        ("diagnose", "-p", "kvlcc2", "-t", "report.toml", "-o", "d"),
        ("simulate", "-p", "kvlcc2", "-t", "report.toml"),
    ):
        said = run(*command, cwd=tmp_path)
        assert said.code == 2, (command, said)
        assert "only indices are known" in said.err
