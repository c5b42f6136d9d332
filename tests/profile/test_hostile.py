"""Profiles as an attacker, an editor or a machine would write them: refused with a reason, or read."""

import pytest

from mmgtune.errors import OptionError, ProfileError
from mmgtune.profile import load_profile
from mmgtune.profile.reading import parse_profile
from mmgtune.toml_reading import toml_of

TEXT = load_profile("suzaku").text
LONG = "9" * 400


def changed(before, after):
    assert before in TEXT
    return TEXT.replace(before, after, 1)


TUNING = TEXT[TEXT.index("[tuning]") : TEXT.index("]", TEXT.index("targets = [")) + 1]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (changed(TUNING, "").replace("schema = 1", "schema = 1\ntuning = 3", 1), "'tuning' is not a table"),
        (changed("schema = 1", "schema = 1\nprovenance = 3"), "'provenance' is not a table"),
        (changed(TUNING, "[tuning]\ntargets = [3]"), "not a list of names"),
        (changed(TUNING, "[tuning]\ntargets = [[]]"), "not a list of names"),
        (changed(TUNING, "[tuning]\ntargets = 3"), "not a list of names"),
        (changed("t_P = 0.080", f"t_P = {LONG}"), "more than a number can be"),
        (changed("t_P = 0.080", f"t_P = {'9' * 5000}"), "cannot be read"),
        (changed("t_P = 0.080", f"t_P = '{LONG}'"), "is inf"),
        (changed("schema = 1", f"schema = {LONG}"), "schema is a number of 400 digits"),
        (changed("schema = 1", f"schema = {'[' * 5000}{']' * 5000}"), "nested too deeply"),
        (changed("schema = 1", f"schema = {'[' * 300}{']' * 300}"), "the limit is 32"),
        (changed('value = "converted"', "value = []"), "one of: converted"),
        (changed('value = "converted"', "value = {}"), "one of: converted"),
        (changed("t_P = 0.080", "t_P = { value = 0.08, source = nan }"), "source of 'propeller.t_P' is nan, not text"),
        (changed("t_P = 0.080", "t_P = { value = 0.08, note = [1] }"), "note of 'propeller.t_P' is [1], not text"),
        (changed("t_P = 0.080", "t_P = { value = 0.08, assumption = 'no' }"), "is 'no', not true or false"),
    ],
    ids=range(16),
)
def test_refused(text, words):
    with pytest.raises(ProfileError) as error:
        parse_profile(text)
    assert words in str(error.value)
    assert all(len(line) < 500 for line in str(error.value).splitlines())


def refusal_of(name, written):
    """What is said of a profile with another value of one name."""
    line = next(line for line in TEXT.splitlines() if line.startswith(f"{name} ="))
    with pytest.raises(ProfileError) as error:
        parse_profile(changed(line, f"{name} = {written}"))
    return str(error.value)


@pytest.mark.parametrize(
    ("name", "written", "words"),
    [
        ("kappa", "-0.1", "must be 0 or more"),
        ("C_w", '"0.1 1/rad^2"', "must be 0 or less"),
        ("N_v", "0.106", "must be 0 or less"),
        ("Y_v", "0.2", "must be 0 or less"),
        ("N_r", "0.05", "must be 0 or less"),
        ("K_T0", "-0.167", "must be above 0"),
        ("x_R_", "0.482", "must be above -1 and below 0"),
        ("rho", '"1.025 kg/m^3"', "must be above 500 kg/m^3 and below 2000 kg/m^3"),
        ("D_P", '"-1 m"', "must be above 0 m and below 20 m"),
        ("max_angle", '"200 deg"', "must be above 0 rad and below 1.6 rad"),
    ],
)
def test_what_is_impossible_is_told_with_what_is_not(name, written, words):
    said = refusal_of(name, written)
    assert "is impossible" in said
    assert f"{words}\n" in said


@pytest.mark.parametrize(
    ("name", "written", "words"),
    [
        ("A_R", '"0.0006282 m^2"', "a rudder of 0.0006282 m^2 is too small for this ship"),
        ("A_R", '"62.82 m^2"', "a rudder of 62.82 m^2 is too large for this ship"),
        ("H_R", '"3.49 mm"', "span^2 over area is 1.94e-06"),
        ("D_P", '"28 mm"', "a propeller of 0.028 m is less than a fiftieth of the draught"),
        ("d", '"13.5 m"', "the draught is not below the breadth"),
        ("x_G", '"41 m"', "more than a quarter of L_pp from midship"),
    ],
)
def test_one_wrong_unit_is_told_by_its_fellows(name, written, words):
    said = refusal_of(name, written)
    assert words in said
    assert "check number and unit" in said


@pytest.mark.parametrize(
    ("name", "written", "words"),
    [
        ("L_pp", '"1e-308 m"', "length between perpendiculars must be above 0.01 m"),
        ("B", '"1e-308 m"', "breadth must be above 0.001 m"),
        ("A_T", '"1e-308 m^2"', "the coefficients of the wind cannot be worked out"),
        ("speed", '"1e150 kn"', "ships stay below 0.5"),
        ("speed", '"60 kn"', "a Froude number of 1.08; ships stay below 0.5"),
        ("n", '"1e9 rpm"', "must be above -100 1/s and below 100 1/s"),
    ],
)
def test_numbers_of_no_ship(name, written, words):
    """Formulas divided by a length of next to nothing, and runs took all the memory there is."""
    assert words in refusal_of(name, written)


def test_a_mark_at_the_beginning(tmp_path):
    (tmp_path / "ship.toml").write_text(TEXT, encoding="utf-8-sig")
    found = load_profile(tmp_path / "ship.toml")
    assert found.sha256 == load_profile("suzaku").sha256
    assert toml_of("\ufeffa = 1", "it", "here", OptionError) == {"a": 1}


def test_more_than_a_profile_is_refused_before_it_is_read_whole(tmp_path):
    path = tmp_path / "ship.toml"
    path.write_text(TEXT + "#" * (2 << 20))
    with pytest.raises(ProfileError, match="a profile of more than 1048576 bytes"):
        load_profile(path)


def test_lines_ended_as_on_another_system(tmp_path):
    path = tmp_path / "ship.toml"
    path.write_bytes(b"\xef\xbb\xbf" + TEXT.replace("\n", "\r\n").encode())
    assert load_profile(path).text == TEXT
