"""Trial files: what is written is what is read, and broken files say what is wrong with them."""

from __future__ import annotations

import errno
import json
import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from mmgtune.errors import OutputError, TrialError
from mmgtune.trial import Trial, read_trial, write_trial
from mmgtune.trial.schema import COLUMNS, LARGEST

from .made import changed, made, problems_of, with_value, write_raw


def assert_same(one: Trial, other: Trial) -> None:
    assert list(one.columns) == list(other.columns)
    for name, values in one.columns.items():
        assert values.tobytes() == other.columns[name].tobytes(), name
    for name in ("id", "ship", "manoeuvre", "source", "noise", "note"):
        assert getattr(one, name) == getattr(other, name)


def test_round_trip_keeps_every_bit(tmp_path: Path) -> None:
    wind = np.linspace(0.1, 7.0 / 3.0, 500)
    trial = made(seed=1, extra={"wind_speed": wind, "fuel": -wind}, noise={"x": 0.4}, note="calm; “öre” \n second line")
    trial = with_value(trial, "v_m", slice(40, 45), np.nan)
    path = write_trial(trial, tmp_path / "any.parquet")
    again = read_trial(path)
    assert_same(trial, again)
    assert again.path == path
    assert len(again.sha256) == 64
    schema = pq.read_schema(path)
    assert schema.field("v").metadata == {b"unit": b"m/s"}
    assert schema.field("fuel").metadata is None
    assert json.loads(schema.metadata[b"mmgtune"])["schema"] == 1


names = st.text("abcdefghijklmnopqrstuvwxyz_0123456789", min_size=1, max_size=12)


@st.composite
def trials(draw: st.DrawFn) -> Trial:
    """Any numbers that a file may hold: gaps in the motion, uneven time, extremes of what a ship and a float may be."""
    samples = draw(st.integers(3, 12))

    def column(low: float, high: float, gaps: bool = False) -> np.ndarray:
        number = st.floats(low, high)
        first = [draw(number)]
        rest = draw(
            st.lists(number | st.just(float("nan")) if gaps else number, min_size=samples - 1, max_size=samples - 1)
        )
        return np.array(first + rest)

    limits = {"x": LARGEST["m"], "y": LARGEST["m"], "psi": 0.09, "u": LARGEST["m/s"], "v_m": LARGEST["m/s"], "r": 1e-3}
    motion = {name: column(-limit, limit, gaps=True) for name, limit in limits.items()}
    steps = draw(st.lists(st.floats(1e-3, 10.0), min_size=samples, max_size=samples))
    extra = draw(st.dictionaries(names.filter(lambda name: name not in {*COLUMNS, "v_m"}), st.none(), max_size=3))
    return Trial(
        id=draw(names),
        ship=draw(st.text(max_size=8)),
        manoeuvre=draw(st.text(max_size=8)),
        source=draw(st.sampled_from(["measured", "generated", ""])),
        t=np.cumsum(steps),
        **motion,
        n=column(-LARGEST["1/s"], LARGEST["1/s"]),
        delta=column(-1.5, 1.5),
        extra={name: column(-1e300, 1e300, gaps=True) for name in extra},
        noise=draw(st.dictionaries(st.sampled_from(["x", "psi", "v"]), st.floats(0.0, 1e4))),
        note=draw(st.text(max_size=20)),
    )


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(trials())
def test_any_trial_survives_the_round_trip(tmp_path: Path, trial: Trial) -> None:
    assume(np.any(np.nan_to_num([trial.u, trial.v_m, trial.r, trial.n])))  # a record in which nothing moves is refused
    assert_same(trial, read_trial(write_trial(trial, tmp_path / "any.parquet", overwrite=True)))


def test_file_without_metadata_is_named_after_itself(tmp_path: Path) -> None:
    trial = read_trial(write_raw(tmp_path / "sea_trial_3.parquet", made().columns))
    assert (trial.id, trial.ship, trial.source, trial.noise) == ("sea_trial_3", "", "", {})
    assert trial.label == "sea_trial_3"


def test_arrays_are_read_only_and_of_one_length() -> None:
    trial = made(extra={"depth": np.ones(500)})
    for values in trial.columns.values():
        assert not values.flags.writeable
    assert trial.motion.shape == (500, 6)
    assert np.array_equal(trial.motion[:, 4], trial.v_m)
    assert trial.duration == pytest.approx(499.0)
    assert trial.label == "turn_p20 (turning, ketch)"
    with pytest.raises(TrialError, match="delta has shape"):
        replace(trial, delta=trial.delta[1:])
    with pytest.raises(TrialError, match="delta holds what is no number"):
        replace(trial, delta=["hard over"] * 500)
    with pytest.raises(TrialError, match="t has shape"):
        replace(trial, t=3.0)
    with pytest.raises(TrialError, match="repeat required ones: v"):
        replace(trial, extra={"v": trial.v_m})


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        (lambda whole: whole[: len(whole) // 2], "the Parquet file is damaged"),
        (lambda whole: whole[:-100] + bytes(100), "the Parquet file is damaged"),
        (lambda whole: b"t,x,y\n0,0,0\n", "the file is not Parquet"),
        (lambda whole: b"PARE" + whole[4:-4] + b"PARE", "the Parquet file is encrypted"),
        (lambda whole: b"", "the file is empty"),
    ],
)
def test_files_that_are_no_parquet(tmp_path: Path, content: Any, expected: str) -> None:
    path = write_trial(made(), tmp_path / "cut.parquet")
    path.write_bytes(content(path.read_bytes()))
    (problem,) = problems_of(path)
    assert expected in problem
    assert str(path) in problem
    assert "fix:" in problem


def test_file_that_is_not_there(tmp_path: Path) -> None:
    assert "No such file" in problems_of(tmp_path / "none.parquet")[0]
    assert "cannot be opened" in problems_of(tmp_path)[0]


def test_missing_column_names_the_nearest(tmp_path: Path) -> None:
    columns = made().columns
    columns["detla"] = columns.pop("delta")
    (problem,) = problems_of(write_raw(tmp_path / "a.parquet", columns))
    assert "column 'delta' is missing" in problem
    assert "did you mean 'detla'" in problem
    columns = made().columns
    columns["v_m"] = columns.pop("v")
    assert "did you mean 'v_m'" in problems_of(write_raw(tmp_path / "b.parquet", columns))[0]


def test_columns_of_other_kinds(tmp_path: Path) -> None:
    columns: dict[str, Any] = made().columns
    columns["n"] = np.full(500, 2)
    columns["x"] = columns["x"].astype(np.float32)
    columns["helmsman"] = ["Ann"] * 500
    trial = read_trial(write_raw(tmp_path / "a.parquet", columns))
    assert trial.n.dtype == trial.x.dtype == np.float64
    assert trial.ignored == ("helmsman",)
    columns["u"] = ["fast"] * 500
    (problem,) = problems_of(write_raw(tmp_path / "b.parquet", columns))
    assert "column 'u' holds string, not numbers" in problem


def test_a_column_that_is_there_twice(tmp_path: Path) -> None:
    columns = made().columns
    table = pa.table([*columns.values(), columns["x"]], names=[*columns, "x"])
    pq.write_table(table, tmp_path / "a.parquet")
    (problem,) = problems_of(tmp_path / "a.parquet")
    assert "column 'x' is there twice" in problem


@pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="threads are counted in /proc")
def test_reading_leaves_no_threads_that_could_abort_a_quick_exit(tmp_path: Path) -> None:
    path = write_trial(made(), tmp_path / "a.parquet")
    code = "import os, sys, pyarrow.parquet; from mmgtune.trial import read_trial; "
    code += "count = lambda: len(os.listdir('/proc/self/task')); before = count(); "
    code += "read_trial(sys.argv[1]); sys.exit(count() - before)"
    assert subprocess.run([sys.executable, "-c", code, path], check=False).returncode == 0


@pytest.mark.parametrize(
    ("metadata", "expected"),
    [
        (b"{", "not a JSON object"),
        (b"\xff\xfe", "not a JSON object"),
        (b"[1]", "it is a list"),
        (b'{"schema": 2}', "schema is 2, not 1"),
        (b'{"shp": "ketch"}', "did you mean 'ship'"),
        (b'{"ship": 7}', "'ship' is 7, not text"),
        (b'{"source": "guessed"}', "one of: measured, generated"),
        (b'{"source": []}', "'source' is [], not text"),
        (b'{"noise": [1]}', "not an object of standard deviations"),
        (b'{"noise": {"x": -1}}', "noise of 'x' is -1"),
        (b'{"noise": {"x": 1e308}}', "noise of 'x' is 1e+308 m"),
        (b'{"noise": {"x": NaN}}', "noise of 'x' is nan"),
        (b'{"noise": {"v_m": 0.1}}', "noise of unknown column 'v_m'"),
        (b'{"id": "../../etc"}', "cannot be the name of a file"),
    ],
)
def test_metadata_that_makes_no_sense(tmp_path: Path, metadata: bytes, expected: str) -> None:
    (problem,) = problems_of(write_raw(tmp_path / "a.parquet", made().columns, metadata))
    assert expected in problem


def _saying(path: Path, units: dict[str, bytes]) -> Path:
    """A trial whose columns say these units in their own metadata."""
    table = pq.read_table(write_raw(path, made().columns))
    fields = [
        one.with_metadata({"unit": units[one.name]}) if one.name in units else one.remove_metadata()
        for one in table.schema
    ]
    pq.write_table(table.cast(pa.schema(fields, metadata=table.schema.metadata)), path)
    return path


def test_columns_that_say_another_unit(tmp_path: Path) -> None:
    said = {"u": b"Knots", "psi": b"deg", "r": "°/min".encode(), "x": b"m", "y": b"\xff", "v": b"m/s", "n": b"turns"}
    problems = problems_of(_saying(tmp_path / "a.parquet", said))
    assert [problem.splitlines()[0] for problem in problems] == [
        f"column '{name}' says that it is in {unit} ({tmp_path / 'a.parquet'})"
        for name, unit in (("psi", "deg"), ("u", "kn"), ("r", "deg/min"))
    ]
    read_trial(_saying(tmp_path / "b.parquet", {"n": b"rps", "t": b"seconds", "x": b"metres"}))


def test_all_problems_at_once(tmp_path: Path) -> None:
    columns = {name: np.array(values) for name, values in made().columns.items()}
    columns["t"][7] = columns["t"][6]
    columns["n"][3] = np.nan
    columns["u"][:] = np.nan
    columns["y"][9] = np.inf
    columns["delta"] /= np.pi / 180.0
    del columns["r"]
    text = "\n".join(problems_of(write_raw(tmp_path / "a.parquet", columns, b'{"ship": 7}')))
    for expected in (
        "'ship' is 7",
        "'r' is missing",
        "row 7",
        "'n' is no number",
        "'u' has no",
        "'y' is inf",
        "degrees",
    ):
        assert expected in text, expected


def test_an_existing_file_is_not_overwritten(tmp_path: Path) -> None:
    path = write_trial(made(), tmp_path / "a.parquet")
    before = path.read_bytes()
    with pytest.raises(OutputError, match="exists already"):
        write_trial(made("other"), path)
    assert path.read_bytes() == before
    assert read_trial(write_trial(made("other"), path, overwrite=True)).id == "other"


@pytest.mark.parametrize("call", ["os.replace", "os.open", "pyarrow.parquet.write_table"])
def test_a_full_disk_leaves_everything_as_it_was(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, call: str) -> None:
    path = write_trial(made(), tmp_path / "a.parquet")
    before = path.read_bytes()

    def full(*_: Any, **__: Any) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    with monkeypatch.context() as patch:
        patch.setattr(call, full)
        with pytest.raises(OutputError, match="No space left"):
            write_trial(changed(made(), "x", lambda x: x + 1.0), path, overwrite=True)
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]


def test_one_bad_file_raises_a_trial_error_only(tmp_path: Path) -> None:
    with pytest.raises(TrialError) as caught:
        read_trial(write_raw(tmp_path / "a.parquet", {}))
    assert len(caught.value.problems) == 10


def test_importing_trials_imports_nothing_heavy() -> None:
    code = "import sys, mmgtune.trial; sys.exit(bool({'pandas', 'pyarrow'} & set(sys.modules)))"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_columns_in_capitals_are_told_in_one_problem(tmp_path: Path) -> None:
    columns = {name.upper(): values for name, values in made().columns.items()}
    (problem,) = problems_of(write_raw(tmp_path / "a.parquet", columns))
    assert "rename T to t, X to x, Y to y, PSI to psi" in problem
    some = made().columns
    some["Delta"] = some.pop("delta")
    assert "rename Delta to delta" in problems_of(write_raw(tmp_path / "b.parquet", some))[0]


def test_latitude_and_longitude_lead_to_the_import(tmp_path: Path) -> None:
    columns = made().columns
    columns["lat"], columns["Longitude"] = columns.pop("x"), columns.pop("y")
    (problem,) = problems_of(write_raw(tmp_path / "a.parquet", columns))
    assert "positions are in latitude and longitude: lat, Longitude" in problem
    assert "mmgtune trials map" in problem
    assert "mmgtune trials import" in problem
