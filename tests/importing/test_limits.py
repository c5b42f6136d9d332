"""What logs, maps and options ask for is bounded in time and memory, and the error names the limit."""

import resource
import time
from contextlib import contextmanager
from dataclasses import replace

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from mmgtune.errors import LogError, OptionError
from mmgtune.importing import import_logs, load_map, parse_map
from tests.importing.made import MAP, imported, nmea, refusal, said, sentence, turn, write_csv


@contextmanager
def bounded(seconds=2.0, megabytes=500):
    """Fail where the block takes more CPU time or memory than so much."""
    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    with open("/proc/self/statm") as file:
        now = int(file.read().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (now + (megabytes << 20), hard))
    began = time.process_time()
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, (soft, hard))
    assert time.process_time() - began < seconds


# time


@pytest.mark.parametrize("jump", [1e5, 1e9, 1e10])
def test_a_clock_that_jumps_forward_cuts_the_record(log, columns, jump):
    columns["time"][250:] += jump
    write_csv(log, columns)
    with bounded():
        result = import_logs([log], parse_map(MAP), log.parent / "out")
    assert [trial.n_samples for trial in result.trials] == [250, 150]
    assert f"time jumps forward once, by up to {jump + 1:.6g} s, first from 249 to" in result.text()
    assert any("the record is cut there" in note for note in result.to_dict()["trials"][0]["notes"])


@pytest.mark.parametrize(("silent", "runs"), [(900, 2), (90, 1)])
def test_runs_in_one_file_are_runs_of_their_own(log, columns, silent, runs):
    """A quarter of an hour between two runs of a few minutes was a hole in one run: nothing was held out."""
    columns["time"][250:] += silent
    result = import_logs([write_csv(log, columns)], parse_map(MAP), log.parent / "out")
    assert [trial.n_samples for trial in result.trials] == [250, 150]
    assert len({trial.run for trial in result.trials}) == runs


def test_a_jump_where_controls_are_constants_cuts_too(log, columns):
    columns["time"][250:] += 1e9
    text = MAP.replace('{ column = "shaft", unit = "rpm" }', '{ value = "102 rpm" }')
    text = text.replace('{ column = "rudder", unit = "deg", positive = "starboard" }', '{ value = "0 deg" }')
    with bounded():
        result = import_logs([write_csv(log, columns)], parse_map(text), log.parent / "out")
    assert [trial.n_samples for trial in result.trials] == [250, 150]


def test_a_receiver_that_begins_in_1980(log, columns):
    days = np.datetime64("2024-05-01T10:00:00") + np.arange(400).astype("timedelta64[s]")
    days[:5] = np.datetime64("1980-01-06T00:00:00") + np.arange(5).astype("timedelta64[s]")
    columns["time"] = days.astype(str)
    text = MAP.replace('unit = "s"\n[vel', "[vel")
    with bounded():
        result = import_logs([write_csv(log, columns)], parse_map(text), log.parent / "out")
    assert [trial.n_samples for trial in result.trials] == [395]
    assert "time jumps forward once" in result.text()
    assert "1 part with fewer than 20 rows was left out" in result.text()


def test_nothing_but_jumps(log, columns):
    columns["time"] = np.cumsum(np.where(np.arange(400) % 10, 1.0, 1e7))
    with bounded():
        answer = refusal(lambda: said(write_csv(log, columns)))
    assert "each of the 40 parts of the log has fewer than 20 rows" in answer
    assert "time jumps forward 39 times" in answer


def test_nmea_whose_clock_jumps(tmp_path):
    per = len(nmea(turn())) // 400
    early, late = nmea(turn(), start=1000.0), nmea(turn(), start=31000.0)
    path = tmp_path / "log.nmea"
    path.write_text("\n".join([*early[: 250 * per], *late[250 * per :]]))
    with bounded():
        result = import_logs([path], load_map("nmea-0183", preset=True), tmp_path / "out")
    assert [trial.n_samples for trial in result.trials] == [250, 150]
    assert "time jumps forward once, by up to 30001 s" in result.text()


@pytest.mark.parametrize("step", [1e-9, 1e-300, 1e-3])
def test_steps_that_would_fill_the_machine(log, columns, step):
    write_csv(log, columns)
    with bounded(), pytest.raises(LogError, match="samples would be made of 400 rows") as error:
        import_logs([log], parse_map(MAP), log.parent / "out", step=step)
    assert "the limit is 100000 samples" in str(error.value)
    assert "longer step" in str(error.value)


# text


def first_replaced(lines, old, new):
    return [lines[0], *(line.replace(old, new, 1) for line in lines[1:60])]


def hostile():
    """Names of small logs, and what is done to the lines of a good one."""
    spaces = " " * 60_000
    return {
        "a name with many blanks": lambda lines: [lines[0].replace("rudder", f"r{spaces}]"), *lines[1:]],
        "a name with many brackets": lambda lines: [lines[0].replace("rudder", "r" + "[" * 60_000 + "]"), *lines[1:]],
        "many names": lambda lines: [",".join(f"heading{k}" * 2 for k in range(4000)), *lines[1:]],
        "too many names": lambda lines: [",".join(f"h{k}" for k in range(9000)), *lines[1:]],
        "a long line": lambda lines: [*lines[:50], lines[50] + "," * 300_000, *lines[51:]],
        "a line without an end": lambda lines: ["x" * 500_000],
        "a quote that is not closed": lambda lines: [*lines[:50], '"' + lines[50], *lines[51:]],
        "integers of 5000 digits": lambda lines: first_replaced(lines, ",", "," + "9" * 5000),
        "decimals of 9000 digits": lambda lines: first_replaced(lines, ".", "." + "3" * 9000),
        "exponents without end": lambda lines: first_replaced(lines, ",", "e999999999,"),
        "dates of any kind": lambda lines: first_replaced(lines, "", f"2024-13-77T99:99:99.{'9' * 500}Z,"),
        "one line again and again": lambda lines: [lines[0], *[lines[1]] * 50_000],
        "a form feed in the header": lambda lines: [lines[0].replace("time", "ti\x0cme"), *lines[1:]],
    }  # fmt: skip


@pytest.mark.parametrize("name", hostile())
def test_small_logs_that_would_take_for_ever(log, columns, name):
    write_csv(log, columns)
    log.write_text("\n".join(hostile()[name](log.read_text().splitlines())))
    with bounded():
        answer = refusal(lambda: said(log))
    assert len(answer) < 20_000


def test_numbers_that_nothing_about_a_ship_is(log, columns):
    columns["ahead"][100:103] = 1e300
    columns["time"][7] = 1e300
    report = said(write_csv(log, columns))
    assert "3 of 399 values of 'ahead' are impossible" in report
    assert "up to 5.14e+299 m/s; taken as gaps" in report
    assert "1 row without a time was dropped" in report
    text = MAP.replace('unit = "deg", positive = "starboard"', 'unit = "deg", positive = "starboard", scale = 1e300')
    with bounded():
        answer = refusal(lambda: said(log, text))
    assert "are impossible for rudder angle" in answer
    assert "check unit, scale and offset" in answer


def test_a_mark_of_byte_order_is_no_error(log, columns, tmp_path):
    write_csv(log, columns)
    log.write_bytes(b"\xef\xbb\xbf" + log.read_bytes())
    map_ = tmp_path / "map.toml"
    map_.write_bytes(b"\xef\xbb\xbf" + MAP.encode())
    assert import_logs([log], load_map(map_), tmp_path, dry_run=True).trials[0].n_samples == 400
    log.write_bytes(b"\xef\xbb\xbf" + "\n".join(nmea(turn())).encode())
    bare = replace(load_map("nmea-0183", preset=True), format=None)
    assert import_logs([log], bare, tmp_path, dry_run=True).trials[0].n_samples == 400


def test_wide_characters_without_a_mark_of_byte_order(log, columns):
    write_csv(log, columns)
    log.write_bytes(log.read_text().encode("utf-16-le"))
    assert imported(log, MAP.replace("[time]", '[log]\nencoding = "utf-16-le"\n[time]')).n_samples == 400


def test_rows_that_no_logger_writes_as_quickly(log, columns):
    text = MAP.replace('unit = "s"\n[vel', 'unit = "s"\nscale = 1e-300\n[vel') + "[cut]\n"
    text = text.replace('"north", unit = "m"', '"north", unit = "m", recover = "print-resolution"')
    answer = refusal(lambda: said(write_csv(log, columns), text))
    assert "the rows are 1e-300 s apart" in answer
    assert "check unit and scale in [time]" in answer


# NMEA 0183


def changed(kind, change):
    """A log in which every sentence of a kind, and its number, goes through a function."""
    lines, number = [], 0
    for line in nmea(turn()):
        if line[3:6] == kind:
            line, number = sentence(change(line[1:].split("*")[0], number)), number + 1
        lines.append(line)
    return "\n".join(lines)


def read(tmp_path, text):
    path = tmp_path / "log.nmea"
    path.write_text(text)
    return import_logs([path], load_map("nmea-0183", preset=True), tmp_path / "out", dry_run=True)


def test_units_of_speed_of_the_wind(tmp_path):
    (trial,) = read(tmp_path, changed("MWV", lambda body, k: body.replace("10.0,N", "10.0,S"))).trials
    assert trial.extra["wind_speed_app"] == pytest.approx(4.4704)
    made = read(tmp_path, changed("MWV", lambda body, k: body.replace("10.0,N", "10.0,X")))
    assert "wind_speed_app" not in made.trials[0].extra
    assert "wind_dir_app" not in made.trials[0].extra
    assert "400 sentences are not as the standard says and were dropped: 400 MWV" in made.text()


@pytest.mark.parametrize("wrong", ["139x", "", "nan", "1e300", "1_3900.0", "99999.0", "-13900.0"])
def test_one_longitude_that_cannot_be_read(tmp_path, wrong):
    def change(body, k):
        cells = body.split(",")
        cells[4] = wrong if k == 40 else cells[4]
        return ",".join(cells)

    made = read(tmp_path, changed("GGA", change))
    assert np.isnan(made.trials[0].x[40])
    assert np.isnan(made.trials[0].x).sum() == 1
    assert made.trials[0].n_samples == 400
    assert "1 sentences are not as the standard says and were dropped: 1 GGA" in made.text()


@pytest.mark.parametrize("wrong", ["N", "", "x", "1e999"])
def test_latitudes_that_cannot_be_read_at_all(tmp_path, wrong):
    text = changed("GGA", lambda body, k: ",".join([*body.split(",")[:2], wrong, *body.split(",")[3:]]))
    with pytest.raises(LogError, match="no position is valid") as error:
        read(tmp_path, text)
    assert "every latitude or longitude is missing" in str(error.value)
    with pytest.raises(LogError, match="no position that can be read") as error:
        read(tmp_path, changed("GGA", lambda body, k: body.replace(",", ",x", 1)))
    assert "400 are not as the standard says" in str(error.value)


# Parquet


def test_parquet_that_expands_without_end(tmp_path):
    path = tmp_path / "bomb.parquet"
    rows = 30_000_000
    zeros = pa.array(np.zeros(rows // 10))
    table = pa.table({name: pa.chunked_array([zeros] * 10) for name in ("time", "north")})
    pq.write_table(table, path, compression="zstd", row_group_size=rows)
    assert path.stat().st_size < 1 << 20
    with bounded():
        answer = refusal(lambda: said(path, MAP))
    assert "the file expands far beyond what it can hold" in answer
    assert "the limit for a file of this size is" in answer
    assert "damaged" not in answer


def test_texts_of_parquet_are_cut_before_they_are_repeated(tmp_path, columns):
    path = tmp_path / "log.parquet"
    long = pa.DictionaryArray.from_arrays(np.zeros(400, dtype=np.int32), pa.array(["9" * 4_000_000]))
    pq.write_table(pa.table({**columns, "rudder": long}), path)
    with bounded(megabytes=200):
        answer = refusal(lambda: said(path))
    assert len(answer) < 2000


def test_nested_columns_of_parquet(tmp_path, columns):
    path = tmp_path / "log.parquet"
    pq.write_table(pa.table({**columns, "rudder": pa.array([[1.0]] * 400)}), path)
    assert "column 'rudder' holds list<element: double>, not numbers" in refusal(lambda: said(path))


# maps


@pytest.mark.parametrize(
    "line",
    [
        "skip = " + "9" * 400, "skip = 0x" + "f" * 5000, "fields = " + "9" * 400, "missing = [0x" + "f" * 5000 + "]",
        'encoding = "hex"', 'encoding = "punycode"', 'encoding = "idna"', 'encoding = "undefined"', "encoding = 5",
        "missing = " + "[" * 900 + "]" * 900, "missing = " + "[" * 5000 + "]" * 5000, "skip = " + "9" * 5000,
        'encoding = "a\\u0000b"', "header = { a = { b = 1 } }", "delimiter = 1979-05-27", "decimal = nan",
    ],
)  # fmt: skip
def test_odd_values_in_maps(line):
    with bounded():
        answer = refusal(lambda: parse_map(MAP.replace("[time]", f"[log]\n{line}\n[time]")))
    assert "map" in answer
    assert len(answer) < 3000


@pytest.mark.parametrize(
    ("table", "line"),
    [
        ("time", "scale = " + "9" * 400), ("time", "unit = 0x" + "f" * 5000), ("time", 'step = "1e-999999 s"'),
        ("resample", "gap = " + "9" * 400), ("position", "origin = [" + "9" * 400 + ", 0]"),
        ("position", "origin = [nan, 1]"), ("trial", 'id = "' + "x" * 5000 + '"'),
        ("trial", "noise = { x = " + "9" * 400 + " }"), ("cut", 'start = "1e300 s"'),
        ("antenna", 'x = "1e300 m"\ny = "0 m"'), ("columns.depth", "column = 0x" + "f" * 5000),
        ("columns.depth", 'value = "' + "e" * 100_000 + '\\n\\nx"'),
    ],
)  # fmt: skip
def test_odd_values_in_tables_of_maps(table, line):
    text = f"{MAP}\n[{table}]\n{line}\n"
    text = text.replace('[time]\ncolumn = "time"\nunit = "s"\n', "") if table == "time" else text
    with bounded():
        answer = refusal(lambda: parse_map(text))
    assert len(answer) < 3000


def test_maps_that_are_no_maps(tmp_path):
    path = tmp_path / "map.toml"
    path.write_bytes(b"x = 1\n" * 100_000)
    with bounded():
        answer = refusal(lambda: load_map(path))
    assert "a map of more than 262144 bytes" in answer
    path.write_text(MAP + '[[logs]]\nname = "*"\nlog.skip = 1\n' * 101)
    assert "[[logs]] of 101 entries: too many" in refusal(lambda: load_map(path))


@pytest.mark.parametrize(
    ("step", "said"),
    [
        (0.0, "the step is 0.0"), (-1.0, "the step is -1.0"), (float("nan"), "the step is nan"),
        (float("inf"), "the step is inf"), ("1 s", "the step is '1 s', not a number"), (True, "not a number"),
    ],
)  # fmt: skip
def test_what_is_no_step(log, step, said):
    """0.0 counted as none, -1.0 as too few samples, and a text ended in a traceback."""
    with pytest.raises(OptionError) as found:
        import_logs(log, parse_map(MAP), ".", step=step, dry_run=True)
    assert said in str(found.value)


def test_steps_of_numpy_are_numbers(log, columns):
    write_csv(log, columns)
    (trial,) = import_logs(log, parse_map(MAP), ".", step=np.float32(2.0), dry_run=True).trials
    assert trial.t[1] - trial.t[0] == 2.0
