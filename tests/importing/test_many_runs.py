"""Many runs in one file: what they cost, what one that is wrong does to the others, and in what they may differ."""

import json

import numpy as np
import openpyxl
import pytest
import scipy.io

from mmgtune import import_logs, propose_map
from mmgtune.errors import LogError, OutputError
from mmgtune.importing import parse_map
from mmgtune.importing.formats import matlab
from mmgtune.units import KNOT
from tests.command import run

from .made import MAP, close, logged, refusal, turn, write_csv
from .test_workbooks import TURN, UNITS, ZIGZAG, book, imported, rows

MIXED = {"one": TURN, "two": ZIGZAG}
EMPTY = [[*row[:4], None, row[5]] if k else row for k, row in enumerate(rows(ZIGZAG))]
"""A run without revolutions."""


@pytest.fixture(scope="module")
def log_map(tmp_path_factory):
    folder = tmp_path_factory.mktemp("map")
    return propose_map(book(folder / "log.xlsx", a=rows(TURN), b=rows(ZIGZAG), c=rows(TURN))).map()


def test_a_file_is_opened_once_for_all_its_runs(tmp_path, monkeypatch):
    reads = []
    for module, name in ((matlab, "content"), (openpyxl, "load_workbook")):
        before = getattr(module, name)
        monkeypatch.setattr(module, name, lambda *a, _of=before, **k: (reads.append(a[0]), _of(*a, **k))[1])
    held = {f"run{k}": logged(turn()) for k in range(1, 4)}
    scipy.io.savemat(tmp_path / "log.mat", held)
    book(tmp_path / "log.xlsx", **{f"run{k}": rows(TURN) for k in range(1, 4)})
    for log in (tmp_path / "log.mat", tmp_path / "log.xlsx"):
        reads.clear()
        proposal = propose_map(log)
        assert (proposal.imported, len(reads)) == (3, 1)
        assert len(imported(log, proposal).trials) == 3
        assert len(reads) == 2
    log_map = parse_map(propose_map(tmp_path / "log.xlsx").text)
    book(tmp_path / "more.xlsx", **{f"run{k}": rows(ZIGZAG) for k in range(1, 4)})
    reads.clear()
    both = import_logs([tmp_path / "log.xlsx", tmp_path / "more.xlsx"], log_map, ".", dry_run=True)
    assert [trial.n_samples for trial in both.trials] == [TURN.n_samples] * 3 + [ZIGZAG.n_samples] * 3
    assert len(reads) == 2


def test_one_run_that_is_wrong_keeps_out_all_unless_told_to_keep_going(tmp_path, log_map):
    log = book(tmp_path / "log.xlsx", a=rows(TURN), b=EMPTY, c=rows(TURN))
    with pytest.raises(LogError) as error:
        import_logs(log, log_map, tmp_path / "out")
    (problem,) = error.value.problems
    assert problem.where.endswith("column 'RPM', in 'b'")
    assert problem.fix.endswith("; keep_going=True imports the 2 others")
    assert not (tmp_path / "out").exists()
    assert propose_map(log).problems == (problem,)
    found = import_logs(log, log_map, tmp_path / "out", keep_going=True)
    assert [trial.id for trial in found.trials] == ["log_a", "log_c"]
    (refused,) = found.refused
    assert (refused.log, refused.part, [one.where for one in refused.problems]) == (log, "b", [problem.where])
    told = json.loads((tmp_path / "out" / "import-report.json").read_text())["refused"]
    assert [(one["part"], one["problems"][0]["what"]) for one in told] == [("b", "the column has no numbers at all")]
    assert "'b': refused" in found.text()
    with pytest.raises(OutputError):
        import_logs(log, log_map, tmp_path / "out", keep_going=True)
    with pytest.raises(LogError, match="no numbers at all"):
        import_logs(book(tmp_path / "bad.xlsx", a=EMPTY, b=EMPTY, c=EMPTY), log_map, tmp_path / "none", keep_going=True)
    assert not (tmp_path / "none").exists()


def test_keep_going_as_a_command(tmp_path):
    write_csv(tmp_path / "good.csv", logged(turn()))
    (tmp_path / "bad.csv").write_text("time,north\n0,1\n")
    (tmp_path / "map.toml").write_text(MAP)
    command = ("trials", "import", "good.csv", "bad.csv", "--map", "map.toml", "-o", "out")
    none = run(*command, cwd=tmp_path)
    assert none.code == 2
    assert "--keep-going imports the 1 other" in none.err
    assert not (tmp_path / "out").exists()
    some = run(*command, "--keep-going", cwd=tmp_path)
    assert some.code == 1, some.err
    assert "bad.csv: refused" in some.out
    assert "not all came in: 1 log or run was refused, 1 trial made of the others" in some.err
    assert (tmp_path / "out" / "good.parquet").exists()
    again = run(*command, "--keep-going", "--force", "--json", cwd=tmp_path)
    assert (again.code, [one["log"] for one in again.json()["refused"]]) == (1, ["bad.csv"])
    assert run("trials", "import", "good.csv", *command[4:], "--keep-going", "--force", cwd=tmp_path).code == 0


def with_speed(trial, name, factor, units=()):
    """Rows with a speed over ground in another unit, and a row of units where there are any."""
    names, *body = rows(trial)
    speed = np.hypot(trial.u, trial.v_m) * factor
    below = [[*UNITS, *units]] if units else []
    return [[*names, name], *below, *([*row, float(one)] for row, one in zip(body, speed, strict=True))]


@pytest.mark.parametrize("below", [False, True], ids=["in the name", "below it"])
def test_each_sheet_is_read_in_its_own_units(tmp_path, below):
    def sheets(**factors):
        said = {
            name: with_speed(
                MIXED[name],
                "Speed" if below else f"Speed [{unit}]",
                1.0 / KNOT if unit == "kn" else 1.0,
                [unit] if below else (),
            )
            for name, unit in factors.items()
        }
        return book(tmp_path / "log.xlsx", **said)

    alike = imported(sheets(one="m/s", two="m/s"))
    proposal = propose_map(sheets(one="kn", two="m/s"))
    assert 'sog = { column = "Speed" }' in proposal.text
    assert (
        "'Speed' is in kn in 'one' and in m/s in 'two': each is read in the unit that its header says" in proposal.notes
    )
    for trial, other in zip(imported(tmp_path / "log.xlsx", proposal).trials, alike.trials, strict=True):
        close(trial, other, 1e-6)
    # A map that says one of them is refused by the sheet that says another.
    stated = parse_map(proposal.text.replace('column = "Speed"', 'column = "Speed", unit = "kn"'))
    told = refusal(lambda: import_logs(tmp_path / "log.xlsx", stated, ".", dry_run=True))
    assert "is in kn, its header says m/s" in told
    assert "in 'two'" in told
    assert "in 'one'" not in told


def test_names_of_columns_in_another_row_of_each_sheet(tmp_path):
    plain = imported(book(tmp_path / "plain.xlsx", one=rows(TURN), two=rows(ZIGZAG)))
    titles = [["Trial of the morning"], ["by", "somebody"], []]
    capitals = [[str(name).upper() for name in rows(ZIGZAG)[0]], *rows(ZIGZAG)[1:]]
    log = book(tmp_path / "log.xlsx", one=[*titles[:1], *rows(TURN)], two=[*titles, *capitals])
    proposal = propose_map(log)
    assert "skip = 1" in proposal.text
    found = imported(log, proposal)
    for trial, other in zip(found.trials, plain.trials, strict=True):
        close(trial, other)
    assert "the names of the columns were found in row 4, not in row 2" in found.quality[1]["notes"]
    lost = book(tmp_path / "lost.xlsx", one=[*titles[:1], *rows(TURN)], two=[*titles, *(row[1:] for row in capitals)])
    told = refusal(lambda: import_logs(lost, proposal.map(), ".", dry_run=True))
    assert "column 'Time' is missing" in told
    assert "sheet 'two', row 2" in told


def test_no_run_takes_the_place_of_another(tmp_path):
    log = book(tmp_path / "log.xlsx", **{"a_3": rows(TURN), "a": rows(ZIGZAG), "a ": rows(TURN)})
    assert [trial.id for trial in imported(log).trials] == ["log_a_3", "log_a", "log_a_4"]
    holed = [[row[0], *[None] * 5] if 300 < k < 340 else row for k, row in enumerate(rows(TURN))]
    log = book(tmp_path / "cut.xlsx", turn=holed, turn_1=rows(ZIGZAG))
    (problem,) = propose_map(log).problems
    assert problem.what == "several parts would become trial 'cut_turn_1'"
    assert problem.why == "'turn' is cut in parts, and they are numbered"
    assert problem.fix.startswith('say id = "{part}-{stem}" in [trial]')
    text = propose_map(log).text.replace("[trial]", '[trial]\nid = "{part}-{stem}"')
    found = import_logs(log, parse_map(text), ".", dry_run=True)
    assert [trial.id for trial in found.trials] == ["turn-cut_1", "turn-cut_2", "turn_1-cut"]


def test_a_log_cut_in_parts_and_one_called_like_a_part(tmp_path):
    columns = logged(turn())
    columns["heading"][200:260] = np.nan
    columns["shaft"][200:260] = np.nan
    write_csv(tmp_path / "log.csv", columns)
    write_csv(tmp_path / "log_1.csv", logged(turn()))
    told = refusal(
        lambda: import_logs([tmp_path / "log.csv", tmp_path / "log_1.csv"], parse_map(MAP), ".", dry_run=True)
    )
    assert "several logs would become trial 'log_1'" in told
    assert "give 'log_1.csv' another name, or import it by itself" in told
    (tmp_path / "b").mkdir()
    write_csv(tmp_path / "b" / "log_1.csv", logged(turn()))
    logs = [tmp_path / "b" / "log_1.csv", tmp_path / "log_1.csv"]
    assert 'say id = "{parent}-{stem}"' in refusal(lambda: import_logs(logs, parse_map(MAP), ".", dry_run=True))
