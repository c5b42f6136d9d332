"""Numbers whose thousands are divided: 12.345,67."""

import numpy as np
import pandas as pd
import pytest

from mmgtune.importing import parse_map, propose_map
from mmgtune.importing.cells.numerals import numbers_in
from mmgtune.importing.cells.thousands import in_thousands
from tests.command import run

from .made import MAP, close, imported, logged, refusal, turn, write_csv

COMMAS = MAP + '[log]\ndelimiter = ";"\ndecimal = ","\n'


def grouped(values, digits=6):
    """Numbers as 12.345,678901."""
    return [f"{one:,.{digits}f}".translate(str.maketrans(",.", ".,")) for one in values]


def far():
    """A log whose positions are beyond a thousand metres, and of whose times some are beyond a thousand seconds."""
    columns = logged(turn())
    return columns | {
        "time": columns["time"] + 800.0,
        "north": columns["north"] + 12345.0,
        "east": columns["east"] - 4e3,
    }


@pytest.mark.parametrize(
    ("texts", "numbers"),
    [
        (["1.234,5", "999", "-2.000"], [1234.5, 999.0, -2000.0]),
        (["1.234.567", "3,5"], [1234567.0, 3.5]),
        (["1.234", "3,5"], [1234.0, 3.5]),  # one column is printed in one way
        (["998", "999", "997", "1.001"], [998.0, 999.0, 997.0, 1001.0]),
        (["1.234", "1.235"], [1.234, 1.235]),  # asked for, where they are of use
        (["1.234", "0.999"], [1.234, 0.999]),  # no thousands begin with 0
        (["1.234", "1.23"], [1.234, 1.23]),
        (["1.234", "1234"], [1.234, 1234.0]),
        (["1.234", "-999", "-999"], [1.234, -999.0, -999.0]),  # a code for no value
        ([*["1.234,5"] * 99, "1.5"], [*[1234.5] * 99, np.nan]),
        (["1.234,5", "n.a.", "x"], [1234.5, np.nan, np.nan]),
    ],
)
def test_points_that_divide_thousands(texts, numbers):
    assert numbers_in(pd.Series(texts, dtype="string"), ",") == pytest.approx(numbers, nan_ok=True)


def test_what_the_map_says_decides_what_nothing_shows():
    texts = pd.Series(["1.234", "1.235"], dtype="string")
    assert in_thousands(texts, ",") is None
    assert list(numbers_in(texts, ",", ".")) == [1234.0, 1235.0]
    assert list(numbers_in(pd.Series(["1.234,5", "1.235,5"], dtype="string"), ",", "none")) != [1234.5, 1235.5]


def test_a_log_with_thousands(tmp_path):
    columns = far()
    plain = imported(write_csv(tmp_path / "plain.csv", columns))
    texts = {name: grouped(one) for name, one in columns.items()}
    log = write_csv(tmp_path / "log.csv", texts, sep=";")
    close(imported(log, COMMAS), plain, 1e-4)
    proposal = propose_map(log)
    assert proposal.asks == proposal.problems == ()
    assert (proposal.map().decimal, proposal.map().thousands) == (",", ".")
    close(imported(log, proposal.text), plain, 1e-4)


def test_whole_numbers_with_thousands(tmp_path):
    """Nothing has a decimal comma; beside 999 a 1.000 is a thousand."""
    columns = far()
    texts = {name: [str(round(float(one), 2)) for one in values] for name, values in columns.items()}
    whole = {name: [one.partition(",")[0] for one in grouped(np.round(columns[name]), 1)] for name in ("time", "north")}
    log = write_csv(tmp_path / "log.csv", texts | {"time": whole["time"]}, sep=";")
    proposal = propose_map(log)  # the other columns have decimal points: so has this one
    # Times from 999 on begin again at 1.000 then, with which no columns make a track.
    assert proposal.sample.layout.get("decimal", ".") == "."
    assert "columns.x.column" in proposal.asks
    commas = {name: [one.replace(".", ",") for one in values] for name, values in texts.items()}
    log = write_csv(tmp_path / "log.csv", commas | whole, sep=";")
    proposal = propose_map(log)
    assert (proposal.map().decimal, proposal.map().thousands) == (",", ".")
    rounded = imported(write_csv(tmp_path / "plain.csv", texts | {"north": np.round(columns["north"])}))
    close(imported(log, COMMAS + 'thousands = "."\n'), rounded, 1e-9)


def test_what_may_be_either_is_asked_for(tmp_path):
    columns = logged(turn())
    texts = {name: [f"{one:.6f}".replace(".", ",") for one in values] for name, values in columns.items()}
    texts["shaft"] = ["1.102"] * len(columns["time"])
    log = write_csv(tmp_path / "log.csv", texts, sep=";")
    told = refusal(lambda: imported(log, COMMAS))
    assert "is '1.102' 1102, or 1.102 with a decimal point?" in told
    assert "line 2, column 'shaft'" in told
    assert imported(log, COMMAS + 'thousands = "."\n').n[0] == pytest.approx(1102.0 / 60.0)
    assert imported(log, COMMAS + 'thousands = "none"\n').n[0] == pytest.approx(1.102 / 60.0)
    proposal = propose_map(log)
    assert proposal.asks == ("log.thousands",)
    assert any("is 1.102 in 'shaft' 1102, or a decimal point?" in line for line in proposal.lines())
    assert "the map asks for 'log.thousands'" in refusal(lambda: parse_map(proposal.text))
    # A column that the map does not name asks nothing.
    beside = write_csv(tmp_path / "beside.csv", texts | {"shaft": "102,000", "Power": texts["shaft"]}, sep=";")
    assert propose_map(beside).asks == ()
    imported(beside, COMMAS)


def test_a_time_that_may_be_either_is_asked_for(tmp_path):
    columns = logged(turn())
    texts = {name: [f"{one:.6f}".replace(".", ",") for one in values] for name, values in columns.items()}
    texts["time"] = [f"{1.0 + one / 1000.0:.3f}" for one in columns["time"]]
    log = write_csv(tmp_path / "log.csv", texts, sep=";")
    assert "is '1.000' 1000, or 1.000 with a decimal point?" in refusal(lambda: imported(log, COMMAS))
    close(imported(log, COMMAS + 'thousands = "."\n'), turn(), 1e-4)


def test_a_sign_that_would_be_both(tmp_path):
    write_csv(tmp_path / "log.csv", logged(turn()))
    (tmp_path / "map.toml").write_text(MAP + '[log]\nthousands = "."\n', encoding="utf-8")
    ended = run("trials", "import", "log.csv", "--map", "map.toml", "-o", "out", cwd=tmp_path)
    assert ended.code == 2
    assert "'log.thousands' is the decimal sign" in ended.err


@pytest.mark.parametrize("mark", ["'", "\u2019", " ", "\u00a0", "\u202f"])
def test_apostrophes_and_blanks_divide_thousands(tmp_path, mark):
    columns = far()
    plain = imported(write_csv(tmp_path / "plain.csv", columns))
    for decimal, how in ((".", {}), (",", {"sep": ";"})):
        texts = {
            name: [f"{one:,.6f}".translate({ord(","): mark, ord("."): decimal}) for one in values]
            for name, values in columns.items()
        }
        log = write_csv(tmp_path / "log.csv", texts, **how)
        proposal = propose_map(log)
        assert proposal.asks == proposal.problems == ()
        assert proposal.map().decimal == decimal
        close(imported(log, proposal.text), plain, 1e-4)


def test_blanks_that_divide_no_thousands():
    texts = pd.Series(["12 34", "1 2345", "0 123", "12 345", "-1'234.5"], dtype="string")
    assert np.array_equal(numbers_in(texts, "."), [np.nan, np.nan, np.nan, 12345.0, -1234.5], equal_nan=True)
