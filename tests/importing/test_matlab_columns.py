"""MATLAB files as programs and people put them together: matrices, several runs, timeseries, what Simulink logs."""

import numpy as np
import pandas as pd
import pytest
import scipy.io

from mmgtune.importing import import_logs, parse_map, propose_map
from mmgtune.importing.formats.matlab import variables
from mmgtune.importing.formats.matlab_columns import columns_of, runs_in
from mmgtune.importing.proposing.words import numbered, quantity_named
from mmgtune.units import DEG

from .made import close, refusal, suzaku

RUN = suzaku()


def logged(trial):
    """Vectors by name, as a MATLAB user calls them."""
    return {
        "t": trial.t,
        "north": trial.x,
        "east": trial.y,
        "heading": np.mod(trial.psi / DEG, 360.0),
        "rpm": 60.0 * trial.n,
        "rudder": trial.delta / DEG,
    }


HELD = logged(RUN)
NAMES = list(HELD)
MATRIX = np.column_stack(list(HELD.values()))
SECOND = logged(suzaku("zigzag_20"))
STAMPS = pd.Timestamp("2020-05-17 23:58:00") + pd.to_timedelta(RUN.t, unit="s")
TIMELESS = {name: values for name, values in HELD.items() if name != "t"}


def texts(values):
    """A cell array of texts."""
    return np.array([*values], dtype=object)


def array_of(*several):
    """An array of structures."""
    made = [tuple(one.values()) for one in several]
    return np.array(made, dtype=[(name, "O") for name in several[0]]).reshape(1, -1)


def series(values):
    """What a timeseries is as a structure."""
    return {"Time": RUN.t, "Data": values, "Name": "unnamed"}


def datevec():
    fields = [STAMPS.year, STAMPS.month, STAMPS.day, STAMPS.hour, STAMPS.minute]
    return np.column_stack([*fields, STAMPS.second + STAMPS.microsecond / 1e6]).astype(np.float64)


SIGNALS = array_of(*({"values": one.reshape(-1, 1), "label": name, "dimensions": 1} for name, one in TIMELESS.items()))

FILES = {
    "vectors": HELD,
    "rows": {name: values.reshape(1, -1) for name, values in HELD.items()},
    **{f"matrix called {name}": {name: MATRIX} for name in ("data", "datum", "zeit", "Data", "m")},
    "a row for each quantity": {"data": MATRIX.T},
    "names in cells beside a matrix": {"data": MATRIX, "colheaders": texts(NAMES)},
    "names in a text beside a matrix": {"data": MATRIX, "header": ", ".join(NAMES)},
    "what importdata makes": {"A": {"data": MATRIX, "textdata": texts(NAMES), "colheaders": texts(NAMES)}},
    "timeseries": {name: series(values) for name, values in TIMELESS.items()},
    "timeseries in a structure": {"log": {name: series(values) for name, values in TIMELESS.items()}},
    "signals of Simulink": {"logsout": {"time": RUN.t, "signals": SIGNALS, "blockName": "x"}},
    "one signal of Simulink": {"out": {"time": RUN.t, "signals": {"values": MATRIX[:, 1:], "label": ""}}},
    "dates as datevec makes them": {**TIMELESS, "time": datevec()},
    "dates in cells": {**TIMELESS, "time": texts(map(str, STAMPS))},
    "two structures": {"run1": HELD, "run2": SECOND},
    "an array of structures": {"run": array_of(HELD, SECOND)},
    "structures in one": {"data": {"run1": HELD, "run2": SECOND, "ship": "suzaku"}},
    "two matrices": {"run1": MATRIX, "run2": np.column_stack(list(SECOND.values()))},
}


def saved(path, held, **how):
    scipy.io.savemat(path, held, **how)
    return path


@pytest.mark.parametrize("held", FILES.values(), ids=FILES)
def test_the_proposed_map_imports_the_run(tmp_path, held):
    log = saved(tmp_path / "log.mat", held)
    proposal = propose_map(log)
    assert not proposal.asks
    plain = propose_map(saved(tmp_path / "plain.mat", HELD))
    found = import_logs([log], proposal.map(), ".", dry_run=True).trials[0]
    close(found, import_logs([tmp_path / "plain.mat"], plain.map(), ".", dry_run=True).trials[0], 1e-4)


@pytest.mark.parametrize(
    ("held", "runs"),
    [
        ("two structures", ["run1", "run2"]),
        ("an array of structures", ["run(1)", "run(2)"]),
        ("structures in one", ["data.run1", "data.run2"]),
        ("two matrices", ["run1", "run2"]),
    ],
)
def test_several_runs_are_told_and_each_can_be_read(tmp_path, held, runs):
    log = saved(tmp_path / "log.mat", FILES[held])
    proposal = propose_map(log)
    assert proposal.notes[0] == "the file holds 2 runs: each becomes a trial"
    assert list(proposal.map().parts) == runs
    lengths = [len(columns_of(log, run).columns[0]) for run in runs]
    assert lengths == [len(HELD["t"]), len(SECOND["t"])]
    found = import_logs([log], proposal.map(), ".", dry_run=True)
    parts = [run.replace("(", "_").replace(")", "").replace(".", "_") for run in runs]
    assert [trial.id for trial in found.trials] == [f"log_{part}" for part in parts]
    assert [trial.n_samples for trial in found.trials] == lengths
    # A map that names one reads it alone; one that names none says which it reads.
    whole = f"variable = [{', '.join(f'{chr(34)}{run}{chr(34)}' for run in runs)}]"
    assert whole in proposal.text
    second = parse_map(proposal.text.replace(whole, f'variable = "{runs[1]}"'))
    assert [trial.n_samples for trial in import_logs([log], second, ".", dry_run=True).trials] == lengths[1:]
    if held != "two matrices":  # whose columns have the matrix's name then
        unsaid = import_logs([log], parse_map(proposal.text.replace(whole, "")), ".", dry_run=True)
        assert any(f"holds 2 runs, '{runs[0]}' and" in note for note in unsaid.quality[0]["notes"])


def fields(trial, **other):
    return {**logged(trial), **other}


NAN = np.full(20, np.nan)
PADDED = {name: np.concatenate([values, NAN]) for name, values in HELD.items()}
REPEATED = {**HELD, "t": np.concatenate([HELD["t"][:1], HELD["t"][:-1]])}
NAVIGATION = ("t", "north", "east", "heading")
APART = [
    {"nav": {name: of[name] for name in NAVIGATION}, "engine": {name: of[name] for name in ("t", "rpm", "rudder")}}
    for of in (HELD, {name: values[: len(RUN.t)] for name, values in SECOND.items()})
]


@pytest.mark.parametrize(
    ("held", "runs"),
    [
        ({"a": PADDED, "b": HELD}, ["a", "b"]),
        ({"a": REPEATED, "b": SECOND}, ["a", "b"]),
        ({"a": fields(RUN, wind=RUN.t), "b": SECOND}, ["a", "b"]),
        ({"a": {"data": MATRIX, "colheaders": texts(NAMES)}, "b": {"data": 1.1 * MATRIX, "colheaders": texts(NAMES)}},
         ["a", "b"]),
        ({"a": {"out": {"time": RUN.t, "signals": SIGNALS}}, "b": {"out": {"time": RUN.t, "signals": SIGNALS}}},
         ["a.out", "b.out"]),
        ({"day1": {"turn": HELD, "zigzag": SECOND}, "day2": {"turn": HELD}}, ["day1.turn", "day1.zigzag", "day2.turn"]),
        ({"run1": APART[0], "run2": APART[1]}, ["run1", "run2"]),
        ({"run": array_of(HELD, SECOND), "more": HELD}, ["run(1)", "run(2)", "more"]),
        ({"run": array_of(HELD, dict.fromkeys(HELD, np.zeros((0, 0))), SECOND)}, ["run(1)", "run(3)"]),
        ({"a": MATRIX.T, "b": 1.1 * MATRIX.T}, ["a", "b"]),
        ({"position": MATRIX[:, 1:5], "velocity": MATRIX[:, 2:6], "t": RUN.t}, []),
        ({"port": {"rpm": RUN.n, "angle": RUN.delta, "torque": RUN.n, "thrust": RUN.n}, **HELD}, []),
    ],
)  # fmt: skip
def test_what_is_a_run(tmp_path, held, runs):
    found = runs_in(variables(saved(tmp_path / "log.mat", held)))
    assert found == (runs if len(runs) > 1 else [])


def test_columns_of_two_runs_are_never_one_trial(tmp_path):
    """Runs as long as each other, with navigation and engine in a structure each: mixed, they were sure."""
    log = saved(tmp_path / "log.mat", {"run1": APART[0], "run2": APART[1]})
    trials = import_logs([log], propose_map(log).map(), ".", dry_run=True).trials
    assert [trial.id for trial in trials] == ["log_run1", "log_run2"]
    for trial, of in zip(trials, (HELD, SECOND), strict=True):
        np.testing.assert_allclose(60.0 * trial.n, of["rpm"][: trial.n_samples], rtol=1e-6)
        np.testing.assert_allclose(trial.x, of["north"][: trial.n_samples], rtol=1e-6, atol=1e-6)


def test_a_name_that_is_taken_takes_no_column_away(tmp_path):
    held = {"data": MATRIX, "colheaders": texts(NAMES), "rpm": RUN.t}
    found = columns_of(saved(tmp_path / "log.mat", held))
    assert [*NAMES, "rpm.rpm"] == found.names


def test_what_describes_a_run_is_no_run(tmp_path):
    log = saved(tmp_path / "log.mat", HELD | {"info": {"ship": "suzaku", "draught": 3.0}})
    assert not propose_map(log).problems


def test_files_whose_runs_are_called_otherwise(tmp_path):
    logs = [
        saved(tmp_path / "a.mat", {"run": array_of(HELD, SECOND)}),
        saved(tmp_path / "b.mat", {"first": SECOND, "second": HELD}),
    ]
    proposal = propose_map(logs)
    assert 'variable = "*"' in proposal.text
    assert proposal.notes[0] == "the logs differ in their variables: each that holds a log becomes a trial"
    found = import_logs(logs, proposal.map(), ".", dry_run=True)
    assert [trial.id for trial in found.trials] == ["a_run_1", "a_run_2", "b_first", "b_second"]


def test_a_run_that_lacks_a_column_is_named(tmp_path):
    lacking = {**SECOND, "rpm": np.zeros(3)}
    told = refusal(lambda: propose_map(saved(tmp_path / "log.mat", {"run": array_of(HELD, HELD, lacking)})))
    assert "'run(3)' 5, without 'rpm'" in told


def test_a_run_that_there_is_not(tmp_path):
    log = saved(tmp_path / "log.mat", FILES["an array of structures"])
    for name in ("run", "run(3)", "run(x)", "run(0)"):
        told = refusal(lambda name=name: columns_of(log, name))
        assert "an array of 2 structures" in told
        assert 'such as "run(1)"' in told
    assert "no variable 'runs(1)'" in refusal(lambda: columns_of(log, "runs(1)"))


def test_what_is_left_out_is_told(tmp_path):
    more = {"wind": np.arange(50.0), "z": 1j * RUN.t, "cube": np.ones((4, 4, 4)), "L": 3.0, "name": "a ship"}
    notes = columns_of(saved(tmp_path / "log.mat", HELD | more)).notes
    assert notes == [
        "left out, as the columns have 481 rows: 'wind' (50 values)",
        "left out: 'z' (array of complex numbers) and 'cube' (array of 3 dimensions)",
    ]
    other = {**FILES["timeseries"], "wind": {"Time": 1e4 + RUN.t[::5], "Data": RUN.t[::5]}}
    told = columns_of(saved(tmp_path / "log.mat", other))
    assert "wind" not in told.names
    assert "'wind', which has times of its own" in told.notes[0]


@pytest.mark.parametrize(("late", "kept"), [(0.0, True), (1e4, False), (1.7e9, True)])
def test_structures_as_long_as_each_other_are_joined_where_their_times_are_the_same(tmp_path, late, kept):
    """Rows of 3.2 s later stood beside those of the motion as if they had been logged at once."""
    controls = {"t": RUN.t + late, "rpm": 100.0 + RUN.t, "rudder": np.sin(RUN.t)}
    motion = {"t": RUN.t, **{name: np.cos(RUN.t + k) for k, name in enumerate("xyhur")}}
    found = columns_of(saved(tmp_path / "log.mat", {"controls": controls, "motion": motion}))
    assert ("controls.rpm" in found.names) is kept
    assert "motion.x" in found.names
    told = "left out: 'controls', which has times of its own; bring it to those of the others first, as they have too "
    assert any(one.startswith(told) for one in found.notes) is not kept
    assert ("controls.rudder" in found.other) is not kept


def test_a_structure_beside_vectors_keeps_its_name(tmp_path):
    wind = {"t": RUN.t, "speed": 5.0 + np.sin(RUN.t), "dir": np.full(len(RUN.t), 30.0)}
    proposal = propose_map(saved(tmp_path / "log.mat", HELD | {"wind": wind}))
    assert proposal.table()[-2][:2] == ("wind_speed", "'wind.speed'")
    assert quantity_named("wind.t") == "time"
    assert quantity_named("wind.speed") == "wind_speed"


@pytest.mark.parametrize("name", ["data", "datum", "dia"])
def test_numbered_columns_of_a_table_say_nothing(name):
    names = [f"{name} {k}" for k in range(1, 8)]
    assert numbered(["time", *names]) == set(range(1, 8))
    assert numbered(["RPM 1", "RPM 2", "Rudder 1", "Rudder 2"]) == set()


def test_files_that_are_not_read_say_what_they_are(tmp_path):
    old = saved(tmp_path / "old.mat", HELD, format="4")
    assert "is of version 4" in refusal(lambda: propose_map(old))
    noise = tmp_path / "noise.mat"
    noise.write_bytes(bytes(range(256)) * 8)
    assert "no MATLAB file of version 5 to 7" in refusal(lambda: propose_map(noise))


def test_all_runs_of_files_of_which_one_is_damaged(tmp_path):
    """Each is told what is wrong with it, and nothing is written."""
    logs = [saved(tmp_path / f"{name}.mat", {"a": HELD, f"b{name}": SECOND}) for name in ("one", "two")]
    log_map = propose_map(logs).map()
    logs[0].write_bytes(logs[0].read_bytes()[:5000])
    told = refusal(lambda: import_logs(logs, log_map, tmp_path / "out"))
    assert "the MATLAB file cannot be read" in told
    assert "two.mat" not in told
    assert not (tmp_path / "out").exists()


def test_more_runs_than_any_log_has(tmp_path):
    short = {name: values[:4] for name, values in HELD.items()}
    held = {f"s{k}": array_of(*[short] * 400) for k in range(3)}
    assert "1200 runs" in refusal(lambda: propose_map(saved(tmp_path / "log.mat", held)))
