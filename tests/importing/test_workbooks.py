"""Workbooks as people write them: sheets for runs, summaries, hidden sheets, units in words and in cells."""

import numpy as np
import openpyxl
import pytest

from mmgtune.errors import LogError
from mmgtune.importing import import_logs, parse_map, propose_map
from mmgtune.units import DEG
from tests.command import run

from .made import close, refusal, suzaku

TURN, ZIGZAG = suzaku(), suzaku("zigzag_20")
UNITS = ("s", "m", "m", "deg", "rpm", "deg")


def rows(trial):
    """Names, and a row for each sample."""
    columns = [trial.t, trial.x, trial.y, np.mod(trial.psi / DEG, 360.0), 60.0 * trial.n, trial.delta / DEG]
    names = ["Time", "North", "East", "Heading", "RPM", "Rudder"]
    return [names, *([float(cell) for cell in row] for row in zip(*columns, strict=True))]


SUMMARY = [["ship", "Suzaku"], ["length", 3.0], ["beam", 1.0], ["most", 35, 1], ["least", 2, 3]]


def book(path, hidden=(), **sheets):
    made = openpyxl.Workbook()
    made.remove(made.active)
    for name, cells in sheets.items():
        sheet = made.create_sheet(name)
        for row in cells:
            sheet.append(row)
        if name in hidden:
            sheet.sheet_state = "hidden"
    made.save(path)
    return path


def imported(log, proposal=None):
    return import_logs([log], (proposal or propose_map(log)).map(), ".", dry_run=True)


def test_sheets_of_the_same_columns_are_a_trial_each(tmp_path):
    log = book(tmp_path / "book.xlsx", notes=SUMMARY, turn=rows(TURN), zigzag=rows(ZIGZAG))
    proposal = propose_map(log)
    assert 'sheet = ["turn", "zigzag"]' in proposal.text
    assert proposal.notes[:2] == ("2 sheets have the same columns: each becomes a trial", "not read: sheet 'notes'")
    found = imported(log, proposal)
    assert [trial.id for trial in found.trials] == ["book_turn", "book_zigzag"]
    alone = [imported(book(tmp_path / f"{k}.xlsx", log=rows(one))).trials[0] for k, one in enumerate((TURN, ZIGZAG))]
    for trial, other in zip(found.trials, alone, strict=True):
        close(trial, other)
    (tmp_path / "map.toml").write_text(proposal.text.replace("[trial]", '[trial]\nid = "{part}-{stem}"'))
    done = run("trials", "import", "book.xlsx", "--map", "map.toml", "-o", "out", cwd=tmp_path)
    assert done.code == 0, done.err
    assert {one.stem for one in (tmp_path / "out").glob("*.parquet")} == {"turn-book", "zigzag-book"}
    again = run("trials", "import", "book.xlsx", "--map", "map.toml", "-o", "out", cwd=tmp_path)
    assert again.code == 2
    assert "turn-book.parquet" in again.err


@pytest.mark.parametrize("value", ['["turn", "turn"]', '["turn", ""]', "[]", "[1]", '["turn", "lost"]'])
def test_lists_of_sheets_that_are_none(tmp_path, value):
    log = book(tmp_path / "book.xlsx", turn=rows(TURN), zigzag=rows(ZIGZAG))
    text = propose_map(log).text.replace('["turn", "zigzag"]', value)
    told = refusal(lambda: import_logs([log], parse_map(text), ".", dry_run=True))
    assert ("no sheet 'lost'" if "lost" in value else "'log.sheet' is") in told


def test_the_sheet_of_the_log_is_found_and_the_others_are_told(tmp_path):
    plain = imported(book(tmp_path / "plain.xlsx", log=rows(TURN))).trials[0]
    log = book(tmp_path / "summary.xlsx", summary=SUMMARY, data=rows(TURN))
    proposal = propose_map(log)
    assert proposal.notes == ("the workbook has 2 sheets: 'data' is read, 'summary' not",)
    close(imported(log, proposal).trials[0], plain)
    # Without a word of it in the map the import finds the same one, and says so.
    unsaid = import_logs([log], parse_map(proposal.text.replace('sheet = "data"\n', "")), ".", dry_run=True)
    close(unsaid.trials[0], plain)
    assert "the workbook has 2 sheets: 'data' is read, 'summary' not" in unsaid.quality[0]["notes"]
    log = book(tmp_path / "hidden.xlsx", hidden=["old"], old=rows(ZIGZAG), data=rows(TURN))
    proposal = propose_map(log)
    assert proposal.notes == ("the workbook has 2 sheets: 'data' is read, 'old' (hidden) not",)
    close(imported(log, proposal).trials[0], plain)
    other = book(tmp_path / "other.xlsx", data=rows(TURN), more=[row[1:] for row in rows(ZIGZAG)])
    assert 'sheet = "more" in [log] of a map reads another one' in propose_map(other).notes[0]


def test_sheets_that_differ_a_little_are_runs_too(tmp_path):
    """Columns in another order, and one more; a calibration with more rows than the log is none."""
    swapped = [[row[0], row[2], row[1], *row[3:]] for row in rows(ZIGZAG)]
    more = [[*row, "Wind" if k == 0 else 3.0] for k, row in enumerate(rows(TURN))]
    volts = [["Volt", "deg"], *([0.01 * k, 0.1 * k] for k in range(2500))]
    log = book(tmp_path / "book.xlsx", calibration=volts, turn=rows(TURN), other=swapped, more=more)
    proposal = propose_map(log)
    assert 'sheet = ["turn", "other", "more"]' in proposal.text
    first, second, third = imported(log, proposal).trials
    close(second, imported(book(tmp_path / "plain.xlsx", log=rows(ZIGZAG))).trials[0])
    np.testing.assert_array_equal(first.x, third.x)


def test_workbooks_whose_sheets_are_called_otherwise(tmp_path):
    logs = [
        book(tmp_path / "monday.xlsx", turn=rows(TURN), zigzag=rows(ZIGZAG)),
        book(tmp_path / "tuesday.xlsx", notes=SUMMARY, again=rows(TURN)),
    ]
    proposal = propose_map(logs)
    assert 'sheet = "*"' in proposal.text
    found = import_logs(logs, proposal.map(), ".", dry_run=True)
    assert [trial.id for trial in found.trials] == ["monday_turn", "monday_zigzag", "tuesday_again"]


def test_names_of_sheets_that_files_cannot_have(tmp_path):
    log = book(tmp_path / "book.xlsx", **{"run 1": rows(TURN), "run_1": rows(ZIGZAG), "Run 1.": rows(TURN)})
    ids = [trial.id for trial in imported(log).trials]
    assert ids == ["book_run_1", "book_run_1_2", "book_Run_1_3"]


def test_a_sheet_that_is_wrong_is_named(tmp_path):
    empty = [[*row[:4], None, row[5]] if k else row for k, row in enumerate(rows(ZIGZAG))]
    log = book(tmp_path / "book.xlsx", good=rows(TURN), bad=empty)
    text = propose_map(book(tmp_path / "other.xlsx", good=rows(TURN), bad=rows(ZIGZAG))).text
    told = refusal(lambda: import_logs([log], parse_map(text), ".", dry_run=True))
    assert "in 'bad'" in told or "sheet 'bad'" in told
    assert "'good'" not in told


@pytest.mark.parametrize(
    "units",
    [UNITS, ("seconds from start", "metres", "metres", "degrees true", "per minute", "port positive")],
    ids=["units", "words"],
)
def test_units_below_the_names(tmp_path, units):
    plain = imported(book(tmp_path / "plain.xlsx", log=rows(TURN))).trials[0]
    names, *body = rows(TURN)
    log = book(tmp_path / "log.xlsx", log=[["Sea trial"], [], names, units, *body])
    close(imported(log).trials[0], plain)


def test_cells_with_units_are_no_angles(tmp_path):
    names, *body = rows(TURN)
    cells = [[f"{cell:.4f} {unit}" for cell, unit in zip(row, UNITS, strict=True)] for row in body]
    log = book(tmp_path / "log.xlsx", log=[names, *cells])
    proposal = propose_map(log)
    assert not proposal.asks
    close(imported(log, proposal).trials[0], imported(book(tmp_path / "plain.xlsx", log=rows(TURN))).trials[0], 1e-3)


def test_what_cannot_be_read_is_told(tmp_path):
    names, *body = rows(TURN)
    log = book(tmp_path / "log.xlsx", log=[names, *([f"=ROW()-{k}", *row[1:]] for k, row in enumerate(body))])
    assert "column 'Time' holds formulas without results" in refusal(lambda: propose_map(log))
    idle = book(tmp_path / "idle.xlsx", log=[[*names, "Calc"], *([*row, "=B2*2"] for row in body)])
    proposal = propose_map(idle)
    assert "note: formulas without results are left out: 'Calc'" in proposal.lines()
    close(imported(idle, proposal).trials[0], imported(book(tmp_path / "plain.xlsx", log=rows(TURN))).trials[0])
    cut = tmp_path / "cut.xlsx"
    cut.write_bytes(log.read_bytes()[:9000])
    told = refusal(lambda: propose_map(cut))
    assert "it is cut short, or damaged" in told
    assert "BadZipFile" not in told
    book(tmp_path / "good.xlsx", log=rows(TURN))
    text = tmp_path / "log.csv"
    text.write_text("Time,North\n0,1\n1,2\n")
    told = refusal(lambda: import_logs([text], propose_map(tmp_path / "good.xlsx").map(), ".", dry_run=True))
    assert "it is no .xlsx file" in told
    assert "there are no rows in it" in refusal(lambda: propose_map(book(tmp_path / "empty.xlsx", log=[])))


def test_a_refusal_names_the_sheet_once(tmp_path):
    """Also where a column is called as the sheet, and where the place names the sheet by itself."""
    log_map = propose_map(book(tmp_path / "good.xlsx", Rudder=rows(TURN), zigzag=rows(ZIGZAG))).map()
    damaged = [row if k == 0 else [*row[:-1], "lost"] for k, row in enumerate(rows(TURN))]
    for cells, ends in ((damaged, "column 'Rudder', in 'Rudder'"), ([row[:-1] for row in damaged], "'Rudder', row 1")):
        log = book(tmp_path / "damaged.xlsx", Rudder=cells, zigzag=rows(ZIGZAG))
        with pytest.raises(LogError) as error:
            import_logs([log], log_map, ".", dry_run=True)
        assert [one.where.endswith(ends) for one in error.value.problems] == [True], error.value
