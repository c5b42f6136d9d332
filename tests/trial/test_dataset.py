"""Folders of trials and their splits."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mmgtune.errors import MmgtuneError, OptionError, TrialError
from mmgtune.trial import IndexTrial, TrialSet, load_trials, write_trial

from .made import made, with_value

IDS = ("turn_m10", "turn_p10", "turn_p20", "zigzag_10")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Four trials of one ship, no split."""
    for name in IDS:
        write_trial(made(name, samples=60), tmp_path / f"{name}.parquet")
    return tmp_path


def complaints(path: Path) -> list[str]:
    with pytest.raises(TrialError) as caught:
        load_trials(path)
    return [str(problem) for problem in caught.value.problems]


def with_split(folder: Path, text: str) -> Path:
    (folder / "split.toml").write_text(text, encoding="utf-8")
    return folder


def test_without_a_split_every_trial_tunes(folder: Path) -> None:
    (folder / "._turn_p10.parquet").write_bytes(b"left by another system")
    data = load_trials(folder)
    assert tuple(data.trials) == data.tune == IDS
    assert data.test == data.others == ()
    assert data.ship == "ketch"
    assert data.path == folder


def test_split(folder: Path) -> None:
    data = load_trials(with_split(folder, 'ship = "ketch"\ntune = ["turn_p20", "turn_m10"]\ntest = ["turn_p10"]\n'))
    assert data.tune == ("turn_p20", "turn_m10")
    assert data.test == ("turn_p10",)
    assert data.others == ("zigzag_10",)
    assert set(data.hashes()) == set(IDS)
    assert data.hashes()["turn_p10"] == data.trials["turn_p10"].sha256


def test_one_file_is_a_set_of_one(folder: Path) -> None:
    data = load_trials(with_split(folder, "not even TOML") / "turn_p10.parquet")
    assert data.tune == tuple(data.trials) == ("turn_p10",)


def test_bundled_by_name(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.chdir(tmp_path)
    data = load_trials("suzaku")
    assert len(data.tune) == len(data.test) == 4
    assert data.others == ("zigzag_10", "zigzag_20")
    with pytest.raises(TrialError, match="did you mean 'suzaku'"):
        load_trials("suzuka")
    with pytest.raises(TrialError, match="no trial files"):
        load_trials(tmp_path)


@pytest.mark.parametrize(
    ("split", "expected", "line"),
    [
        ("tune = []", "no trial tunes", 1),
        ("", "'tune' is missing", None),
        ('tune = ["turn_p10",\n"turn_p10"]', "trial 'turn_p10' is named 2 times in 'tune'", 1),
        ('tune = ["turn_p10"]\ntest = ["turn_p21"]', "did you mean 'turn_p20'", 2),
        ('tune = ["turn_p10"]\ntest = ["turn_p10"]', "trial 'turn_p10' is both in 'tune' and in 'test'", 1),
        ('tune = ["turn_p10"]\ntset = []', "did you mean 'test'", 2),
        ('tune = ["turn_p10"]\ntest = [7]', "'test' is not a list of trial ids", 2),
        ('tune = "turn_p10"', "'tune' is not a list of trial ids", 1),
        ('ship = 7\ntune = ["turn_p10"]', "'ship' is 7, not text", 1),
        ("tune = [", "the split is not valid TOML", None),
    ],
)
def test_splits_that_make_no_sense(folder: Path, split: str, expected: str, line: int | None) -> None:
    (problem,) = complaints(with_split(folder, split))
    assert expected in problem
    assert "split.toml" in problem
    assert f"split.toml, line {line})" in problem or line is None
    assert "fix:" in problem


def test_two_files_of_one_trial(folder: Path) -> None:
    write_trial(made("turn_p10", samples=60), folder / "copy.parquet")
    (problem,) = complaints(folder)
    assert "two files are of trial 'turn_p10'" in problem
    assert "copy.parquet" in problem
    assert "turn_p10.parquet" in problem


def test_ships_must_agree(folder: Path) -> None:
    write_trial(made("other", samples=60, ship="barge"), folder / "other.parquet")
    (problem,) = complaints(folder)
    assert "trial 'other' is of ship 'barge', not 'ketch'" in problem
    assert len(complaints(with_split(folder, 'ship = "yawl"\ntune = ["turn_p10"]'))) == 5
    write_trial(made("other", samples=60, ship=""), folder / "other.parquet", overwrite=True)
    (folder / "split.toml").unlink()
    assert load_trials(folder).ship == "ketch"


def test_everything_wrong_with_a_folder_at_once(folder: Path) -> None:
    write_trial(with_value(made("turn_p20", samples=60), "t", 5, np.nan), folder / "renamed.parquet")
    (folder / "turn_p20.parquet").unlink()
    write_trial(with_value(made("turn_m10", samples=60), "n", 5, np.nan), folder / "turn_m10.parquet", overwrite=True)
    text = "\n".join(complaints(with_split(folder, 'tune = ["turn_p20", "turn_x"]\ntets = []')))
    for expected in ("renamed.parquet, row 5", "'n' is no number", "unknown key 'tets'", "names trial 'turn_x'"):
        assert expected in text
    assert "'turn_p20', which is not there" not in text


def test_ids_are_not_doubted_where_a_file_cannot_be_read(folder: Path) -> None:
    (folder / "turn_p20.parquet").write_bytes(b"PAR1")
    (problem,) = complaints(with_split(folder, 'tune = ["turn_p20"]'))
    assert "damaged" in problem


def test_licence_and_citation_of_a_data_set_reach_the_profile_tuned_to_it(folder: Path) -> None:
    terms = 'licence = "CC BY-NC 4.0"\ncitation = "Who Measured 2020"\ntune = ["turn_p10"]'
    data = load_trials(with_split(folder, terms))
    assert (data.licence, data.citation) == ("CC BY-NC 4.0", "Who Measured 2020")
    assert data.in_windows(50.0).licence == "CC BY-NC 4.0"
    assert "'licence' is 4, not text" in complaints(with_split(folder, 'licence = 4\ntune = ["turn_p10"]'))[0]


A, B = (made(name, samples=60) for name in ("a", "b"))
STATED = IndexTrial("report", "ketch", "turning", 0.6, None, None, {})


@pytest.mark.parametrize(
    "given", [[A, B], (A, B), {"a": A, "b": B}, iter([A, B])], ids=["list", "tuple", "dict", "iterator"]
)
def test_a_set_is_made_by_hand(given: object) -> None:
    data = TrialSet(given, ["a"], ["b"])
    assert list(data.trials.items()) == [("a", A), ("b", B)]
    assert (data.tune, data.test, data.ship) == (("a",), ("b",), "ketch")
    assert data["b"] is B


def test_a_single_trial_and_stated_indices_are_put_where_they_belong() -> None:
    assert list(TrialSet(A, ["a"], []).trials) == ["a"]
    data = TrialSet([A, STATED], ["a", "report"], [])
    assert (data.tune, data.tune_stated, list(data.stated)) == (("a",), ("report",), ["report"])
    again = replace(data, ship="yawl")
    assert (again.tune, again.tune_stated, again.ship) == (("a",), ("report",), "yawl")


@pytest.mark.parametrize(
    ("given", "error", "said"),
    [
        (
            ([A, B], ["a", "c"], ["d"]),
            TrialError,
            ["'tune' names trial 'c', which is not there", "'test' names trial 'd'"],
        ),
        (([A, B], ["a"], ["a"]), TrialError, ["trial 'a' is both in 'tune' and in 'test'"]),
        (([A, B], ["a", "a"], []), TrialError, ["trial 'a' is named 2 times in 'tune'"]),
        (([A, A], ["a"], []), TrialError, ["two trials are called 'a'"]),
        (({"c": A}, ["c"], []), TrialError, ["trial 'a' stands under 'c'"]),
        (({"a": A.to_frame()}, ["a"], []), OptionError, ["a DataFrame in trials is no trial"]),
        ((A.to_frame(), ["a"], []), OptionError, ["a DataFrame is no set of trials"]),
        (("suzaku", ["a"], []), OptionError, ["a str is no set of trials"]),
        (([A], "a", []), OptionError, ["tune is 'a'"]),
        (([A], [A], []), OptionError, ["a Trial in tune is no text"]),
        (([A], ["a"], None), OptionError, ["test is None"]),
    ],
)
def test_what_makes_no_set_is_told(given: tuple, error: type[MmgtuneError], said: list[str]) -> None:
    with pytest.raises(error) as caught:
        TrialSet(*given)
    told = [str(one) for one in caught.value.problems]
    assert len(told) == len(said)
    for one, words in zip(told, said, strict=True):
        assert words in one
        assert "why: " in one
        assert "fix: " in one
