"""Tables of jobs: what they stand for, and what is said of those that make no sense."""

from __future__ import annotations

from pathlib import Path

import pytest

from mmgtune.errors import MmgtuneError, OptionError
from mmgtune.fleet import read_table
from mmgtune.fleet.expanding import expand
from mmgtune.fleet.places import matching
from mmgtune.fleet.table import iso_date

from .conftest import QUICK, TABLE, make_logs

BASE = {
    "command": '"fit"',
    "profile": '"suzaku"',
    "trials": '"logs/{ship}/{date}"',
}


def table(tmp_path: Path, head: str = "schema = 1", **changed: str) -> Path:
    """A table with one entry; a key that is "" is left out."""
    entry = {**BASE, **changed}
    lines = [f"{key.replace('klass', 'class')} = {value}" for key, value in entry.items() if value]
    path = tmp_path / "fleet.toml"
    path.write_text("\n".join([head, "", "[[jobs]]", *lines, ""]), encoding="utf-8")
    return path


def said(path: Path) -> str:
    """What is wrong with a table, or with what it stands for."""
    with pytest.raises(MmgtuneError) as error:
        expand(read_table(path))
    return str(error.value)


def test_patterns_become_jobs_of_ships_and_dates(fleet: Path) -> None:
    jobs = expand(read_table(fleet))
    assert [(job.ship, job.date) for job in jobs] == [
        (s, d) for s in ("a1", "a2", "a3") for d in ("2025-01", "2025-02")
    ]
    assert len({job.key for job in jobs}) == 6
    assert jobs[0].place == "runs/a1/2025-01/state"
    assert set(jobs[0].trials.files) == {"turn_p35.parquet", "zigzag_20.parquet"}


def test_the_key_follows_contents_not_places(fleet: Path, tmp_path: Path) -> None:
    before = [job.key for job in expand(read_table(fleet))]
    (tmp_path / "logs").rename(tmp_path / "kept")
    fleet.write_text(TABLE.replace("logs/", "kept/"), encoding="utf-8")
    assert [job.key for job in expand(read_table(fleet))] == before
    one = tmp_path / "kept" / "a1" / "2025-01" / "turn_p35.parquet"
    one.write_bytes((tmp_path / "kept" / "a2" / "2025-01" / "turn_p35.parquet").read_bytes())
    after = [job.key for job in expand(read_table(fleet))]
    assert [old == new for old, new in zip(before, after, strict=True)] == [False, *[True] * 5]
    fleet.write_text(TABLE.replace("logs/", "kept/").replace("starts = 1", "starts = 2"), encoding="utf-8")
    assert not set(after) & {job.key for job in expand(read_table(fleet))}


def test_trials_at_urls_are_the_same_jobs(fleet: Path, tmp_path: Path) -> None:
    pytest.importorskip("fsspec")
    fleet.write_text(TABLE.replace("logs/", f"file://{tmp_path}/logs/"), encoding="utf-8")
    jobs = expand(read_table(fleet))
    assert [(job.ship, job.date) for job in jobs][:2] == [("a1", "2025-01"), ("a1", "2025-02")]
    assert jobs[0].trials.path.startswith("file://")
    assert set(jobs[0].trials.files) == {"turn_p35.parquet", "zigzag_20.parquet"}


def test_a_store_that_cannot_be_reached_is_said(fleet: Path) -> None:
    fsspec = pytest.importorskip("fsspec")

    class NoCredentials(Exception):
        """As the clients of stores have them: no OSError."""

    class Store(fsspec.AbstractFileSystem):  # type: ignore[misc, name-defined]
        protocol = "store"

        def ls(self, path: str, detail: bool = True, **options: object) -> list[str]:
            raise NoCredentials("unable to locate credentials")

    fsspec.register_implementation("store", Store, clobber=True)
    fleet.write_text(TABLE.replace("logs/", "store://logs/"), encoding="utf-8")
    message = said(fleet)
    assert message.startswith("the URL cannot be read (store://logs/")
    assert "why: unable to locate credentials" in message
    assert "fix: check the URL" in message


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"profle": '"x"'}, "did you mean 'profile'"),
        ({"command": '"fti"'}, "one of: 'fit'"),
        ({"trials": '"logs/{ship}/all"'}, "nothing says the date"),
        ({"trials": '"logs/x/{date}"'}, "nothing says the ship"),
        ({"trials": '"nowhere/{ship}/{date}"'}, "no trials match 'nowhere/{ship}/{date}'"),
        ({"trials": '"logs/{date}/{ship}"'}, "none says a ship and a date"),
        ({"profile": '"ships/{ship}.toml"'}, "it is that of ship 'a1'"),
        ({"ship": '"a1"'}, "'ship' is said twice"),
        ({"klass": '"a/b"'}, "cannot be the name of a folder"),
        ({"baseline": '"b.json"'}, "a fit takes no baseline"),
        ({"command": '"check"'}, "a check has no baseline"),
        ({"options": "{ starts = 0 }"}, "starts is 0"),
        ({"options": "{ stats = 3 }"}, "did you mean 'starts'"),
        ({"options": '{ starts = "two" }'}, "give a whole number"),
        ({"profile": ""}, "the entry has no 'profile'"),
        ({"trials": '""'}, "'trials' is empty"),
        ({"head": "schema = 2"}, "schema is 2, not 1"),
    ],
)
def test_what_is_wrong_is_said_with_its_line(fleet: Path, tmp_path: Path, changed: dict[str, str], words: str) -> None:
    message = said(table(tmp_path, **changed))
    assert words in message
    assert "fleet.toml" in message or "ships" in message
    assert "fix:" in message


def test_line_numbers_are_those_of_the_entry(tmp_path: Path) -> None:
    make_logs(tmp_path, ("a1",), ("2025-01",))
    path = tmp_path / "fleet.toml"
    path.write_text(QUICK + QUICK.partition("\n")[2].replace('"numpy"', '"abacus"'), encoding="utf-8")
    with pytest.raises(OptionError) as error:
        read_table(path)
    assert "fleet.toml, line 13" in str(error.value)


def test_jobs_that_could_not_be_told_apart(fleet: Path, tmp_path: Path) -> None:
    fleet.write_text(TABLE + "\n" + TABLE.partition("\n")[2], encoding="utf-8")
    assert "two jobs are 'a1 2025-01 state'" in said(fleet)


def test_dates() -> None:
    assert [iso_date(text) for text in ("20250131", "2025-01-31", "2025-01", "2025")] == [
        "2025-01-31", "2025-01-31", "2025-01", "2025"
    ]  # fmt: skip
    assert [iso_date(text) for text in ("2025-02-30", "2025-13", "31.1.2025", "")] == ["", "", "", ""]


def test_folders_with_brackets_in_their_names(tmp_path: Path) -> None:
    inside = tmp_path / "logs[1]" / "what?" / "a"
    inside.mkdir(parents=True)
    assert matching("logs[1]/what?/*", tmp_path) == [str(inside)]
    assert matching("logs*/what?/a", tmp_path) == [str(inside)]
