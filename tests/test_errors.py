"""What refusals say of what the system or a library told them."""

import json

import pytest

from mmgtune.errors import ProfileError, cannot_write_reason, near_to, reason
from mmgtune.profile import load_profile
from mmgtune.toml_reading import toml_of


def test_a_reason_is_one_line_without_numbers_and_paths(tmp_path):
    with pytest.raises(OSError) as missing:
        (tmp_path / "none").read_text(encoding="utf-8")
    assert reason(missing.value) == "No such file or directory"
    assert cannot_write_reason(missing.value) == f"No such file or directory: {tmp_path / 'none'}"
    assert reason(ValueError("first\nsecond")) == "first"
    assert reason(ValueError()) == "ValueError"
    assert reason(TypeError("'float' object is not iterable")) == "something in it is of another kind than was written"
    assert reason(TypeError("an angle is wanted")) == "an angle is wanted"
    assert len(reason(ValueError("x" * 10_000))) == 300
    assert reason(KeyError("name")) == "it has no 'name'"
    with pytest.raises(OSError) as folder:
        tmp_path.read_text(encoding="utf-8")
    assert reason(folder.value) == "it is a folder"
    with pytest.raises(ValueError) as document:
        json.loads('{"a":\n x')
    assert reason(document.value) == "it is no JSON: line 2, column 2"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[hull]\n[hull]", "the table [hull] is there twice (at line 2, column 6)"),
        ("[a.b]\n[a.b]", "the table [a.b] is there twice (at line 2, column 5)"),
        ("a = 1\na = 2\n", "a name or a table is there twice (at line 2, column 6)"),
        ("a = ", "Invalid value (at end of document)"),
    ],
)
def test_what_is_wrong_with_toml_is_said_in_words(text, said):
    with pytest.raises(ProfileError) as refused:
        toml_of(text, "the profile", "ship.toml", ProfileError)
    assert refused.value.problems[0].why == said


@pytest.mark.parametrize(
    ("name", "known", "said"),
    [
        ("nonsense", ("diagnose", "fit"), ""),
        ("numba", ("numpy", "jax"), ""),
        ("RK4", ("euler", "rk4"), "did you mean 'rk4'?"),
        ("hull.y_v", ("hull.Y_v", "rudder.eps"), "did you mean 'hull.Y_v'?"),
        ("fitt", ("fit", "sweep"), "did you mean 'fit'?"),
        ("v", ("v_m", "x"), "did you mean 'v_m'?"),
        ("", ("v_m", "x"), ""),
    ],
)
def test_only_near_names_are_proposed(name, known, said):
    assert near_to(name, known) == said


def test_a_profile_that_is_no_text(tmp_path):
    path = tmp_path / "ship.toml"
    path.write_bytes(b"id = 'a'\n\xff")
    with pytest.raises(ProfileError) as refused:
        load_profile(path)
    assert refused.value.problems[0].why == "byte 9 is no utf-8 text"
