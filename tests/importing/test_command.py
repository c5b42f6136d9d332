"""``mmgtune trials import`` as a user runs it."""

import signal

import pytest

from mmgtune import import_logs, propose_map
from mmgtune.errors import LogError
from tests.command import run, run_until
from tests.importing.made import MAP, logged, turn, write_csv


@pytest.fixture
def folder(tmp_path):
    write_csv(tmp_path / "zigzag.csv", logged(turn()))
    (tmp_path / "map.toml").write_text(MAP)
    return tmp_path


def test_import_check_and_again(folder):
    command = ("trials", "import", "zigzag.csv", "--map", "map.toml", "-o", "trials")
    dry = run(*command, "--dry-run", cwd=folder)
    assert dry.code == 0, dry.err
    assert "1 trial would be written" in dry.out
    assert "positions missed by u, v, psi" in dry.out
    assert not (folder / "trials").exists()
    ended = run(*command, "--json", cwd=folder)
    assert ended.code == 0, ended.err
    (trial,) = ended.json()["trials"]
    assert trial["n_samples"] == 400
    assert sorted(path.name for path in (folder / "trials").iterdir()) == ["import-report.json", "zigzag.parquet"]
    assert run("trials", "check", "trials", cwd=folder).code == 0
    again = run(*command, cwd=folder)
    assert again.code == 2
    assert "exists already" in again.err
    assert "--force" in again.err
    assert run(*command, "--force", "--step", "2 s", cwd=folder).code == 0


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("-o", "out"), "give either --map or --preset"),
        (("--map", "map.toml"), "add -o FOLDER"),
        (("--map", "map.toml", "-o", "out", "--step", "2"), "has no unit"),
        (("--map", "map.toml", "-o", "out", "--step", "0.5"), 'write --step "0.5 s"'),
        (("--map", "map.toml", "-o", "out", "--step", "0,5"), 'write --step "0.5 s"'),
        (("--map", "map.toml", "-o", "out", "--step", "0,5 s"), 'write --step "0.5 s"'),
        (("--map", "map.toml", "-o", "out", "--step", "1, 2 s"), "it is 2 numbers, not one"),
        (("--map", "map.toml", "-o", "out", "--step", "0 s"), "above 0 s"),
        (("--preset", "frt", "-o", "out"), "no preset is called 'frt'"),
        (("--preset", "frt-ds-esso", "-o", "out"), "column 'x_position_mid' is missing"),
        (("--map", "zigzag.csv", "-o", "out"), "not valid TOML"),
    ],
)
def test_refusals(folder, options, words):
    ended = run("trials", "import", "zigzag.csv", *options, cwd=folder)
    assert ended.code == 2, ended.err
    assert words in ended.err
    assert "Traceback" not in ended.err
    assert not (folder / "out").exists()


def test_the_library_takes_one_log_and_the_path_of_a_map(folder):
    log = folder / "zigzag.csv"
    for one in (log, str(log), [log]):
        assert [trial.id for trial in import_logs(one, folder / "map.toml", "out", dry_run=True).trials] == ["zigzag"]
        assert propose_map(one).text == propose_map([log]).text


def test_a_proposal_is_a_map_and_both_say_in_a_line_what_they_are(folder):
    log = folder / "zigzag.csv"
    proposal = propose_map(log)
    assert repr(proposal) == "Proposal(of 1 log, 9 quantities: 1 trial)"
    found = import_logs(log, proposal, folder / "out")
    assert repr(found) == "Imported(1 trial by the map map, written)"
    columns = logged(turn())
    del columns["rudder"]
    proposal = propose_map(write_csv(log, columns))
    assert f"asks for {proposal.asks[0]}" in repr(proposal)
    with pytest.raises(LogError, match="the map asks for"):
        import_logs(log, proposal, "out", dry_run=True)


def test_stopped_while_reading_leaves_nothing(folder):
    lines = (folder / "zigzag.csv").read_text().splitlines()
    body = "\n".join(lines[1:]) + "\n"
    with (folder / "long.csv").open("w") as file:
        file.write(lines[0] + "\n")
        for _ in range(2000):
            file.write(body)
    started = folder / "started"

    def ready():
        started.touch()
        import time

        time.sleep(1.5)
        return True

    ended = run_until(
        ready, signal.SIGINT, "trials", "import", "long.csv", "--map", "map.toml", "-o", "out", cwd=folder
    )
    assert ended.code == 130, (ended.code, ended.err)
    assert "Traceback" not in ended.err
    assert not (folder / "out").exists()
