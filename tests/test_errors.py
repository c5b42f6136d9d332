"""What refusals say of what the system or a library told them."""

import pytest

from mmgtune.errors import ProfileError, cannot_write_reason, reason
from mmgtune.profile import load_profile


def test_a_reason_is_one_line_without_numbers_and_paths(tmp_path):
    with pytest.raises(OSError) as missing:
        (tmp_path / "none").read_text(encoding="utf-8")
    assert reason(missing.value) == "No such file or directory"
    assert cannot_write_reason(missing.value) == f"No such file or directory: {tmp_path / 'none'}"
    assert reason(ValueError("first\nsecond")) == "first"
    assert reason(ValueError()) == "ValueError"
    assert len(reason(ValueError("x" * 10_000))) == 300


def test_a_profile_that_is_no_text(tmp_path):
    path = tmp_path / "ship.toml"
    path.write_bytes(b"id = 'a'\n\xff")
    with pytest.raises(ProfileError) as refused:
        load_profile(path)
    assert refused.value.problems[0].why == "byte 9 is no utf-8 text"
