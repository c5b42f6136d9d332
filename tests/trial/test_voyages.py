"""Voyages: read block by block, cut into windows, and what is left out of them."""

import tracemalloc
from dataclasses import replace

import numpy as np
import pyarrow.parquet as pq
import pytest

from mmgtune.errors import TrialError
from mmgtune.trial import (
    Cutting,
    holds_voyages,
    load_voyages,
    open_voyage,
    voyage_windows,
    window_at,
    windows,
    write_trial,
)
from mmgtune.trial.parquet import GROUP_ROWS
from mmgtune.trial.voyages import voyage as reading
from tests.trial.made import made, with_value, write_raw
from tests.voyages.conftest import rows, with_nan, write_foreign

LENGTH = 120.0


def cut(path, **options):
    counted = Cutting()
    found = list(voyage_windows(open_voyage(path), LENGTH, counted=counted, **{"gap": 10.0, **options}))
    assert counted.used + sum(counted.left_out.values()) == counted.rows == open_voyage(path).n_rows
    assert counted.windows == len(found)
    return found, counted


def same(one, other):
    assert [w.trial.id for w in one] == [w.trial.id for w in other]
    for a, b in zip(one, other, strict=True):
        assert (a.row, a.begins) == (b.row, b.begins)
        for name, values in a.trial.columns.items():
            np.testing.assert_array_equal(values, b.trial.columns[name])


def test_as_a_trial_is_cut(voyage, voyage_file):
    """One rule: without a gap, a voyage that is streamed has the windows of a trial that is held."""
    found, counted = cut(voyage_file)
    whole = windows(voyage, LENGTH)
    assert [one.trial.id for one in found] == [one.id for one in whole]
    for one, other in zip(found, whole, strict=True):
        for name, values in one.trial.columns.items():
            np.testing.assert_array_equal(values, other.columns[name])
        assert (one.trial.part_of, one.trial.run, one.trial.manoeuvre) == ("voyage", "voyage", "voyage")
    assert counted.used == voyage.n_samples


@pytest.mark.parametrize("block", [64, 500, 7000])
def test_blocks_and_row_groups_make_no_difference(voyage, tmp_path, monkeypatch, block):
    odd = with_nan(with_nan(voyage, "x", slice(1000, 1008)), "delta", slice(3000, 3001))
    odd = rows(odd, np.r_[0:4000, 4300:7201])
    whole, counted = cut(write_foreign(odd, tmp_path / "whole.parquet", 10**6))
    for group in (50, 333, 4096):
        found, other = cut(write_foreign(odd, tmp_path / str(group) / "whole.parquet", group))
        same(whole, found)
        assert other == counted
    monkeypatch.setattr(reading, "BLOCK", block)
    found, other = cut(tmp_path / "whole.parquet")
    same(whole, found)
    assert other == counted


def test_an_hours_stop_ends_a_window(voyage, tmp_path):
    t = np.where(voyage.t < 1000.0, voyage.t, voyage.t + 3600.0)
    found, counted = cut(write_trial(replace(voyage, t=t), tmp_path / "a.parquet"))
    begins = [one.begins for one in found]
    assert begins[:9] == [*(120.0 * k for k in range(8)), 4600.0]
    assert all(not one.begins < 1000.0 <= one.begins + one.trial.duration for one in found)
    # 960 to 999 s is less than half a window.
    assert counted.left_out == {"unknown inputs": 0, "incomplete motion": 0, "too short": 39}


def test_a_long_gap_ends_a_window_and_a_short_one_does_not(voyage, tmp_path):
    short, counted = cut(write_trial(with_nan(voyage, "x", slice(200, 209)), tmp_path / "short.parquet"))
    assert counted.gaps == 9
    assert [one.begins for one in short[:3]] == [0.0, 120.0, 240.0]
    assert np.isnan(short[1].trial.x).sum() == 9
    long, counted = cut(write_trial(with_nan(voyage, "x", slice(200, 230)), tmp_path / "long.parquet"))
    assert [one.begins for one in long[:3]] == [0.0, 120.0, 230.0]
    assert counted.left_out["incomplete motion"] == 30
    assert long[1].trial.duration == 79.0
    wider, _ = cut(tmp_path / "long.parquet", gap=60.0)
    assert [one.begins for one in wider[:3]] == [0.0, 120.0, 240.0]


def test_an_unknown_input_ends_a_window(voyage, tmp_path):
    found, counted = cut(write_foreign(with_nan(voyage, "delta", slice(300, 301)), tmp_path / "a.parquet", 10**6))
    assert [one.begins for one in found[:4]] == [0.0, 120.0, 301.0, 421.0]
    assert counted.left_out["unknown inputs"] == 1
    assert counted.left_out["too short"] == 2 * 59  # from 241 to 299 s, and as many at the end
    assert all(np.isfinite(one.trial.delta).all() for one in found)


def test_every_window_begins_complete(voyage, tmp_path):
    rng = np.random.default_rng(3)
    spotted = {}
    for name in ("x", "psi", "r"):
        values = np.array(getattr(voyage, name))
        values[rng.random(len(values)) < 0.2] = np.nan
        spotted[name] = values
    found, counted = cut(write_foreign(replace(voyage, **spotted), tmp_path / "a.parquet", 10**6))
    assert len(found) > 50
    assert all(np.isfinite(one.trial.motion[0]).all() for one in found)
    assert counted.used > 0.95 * counted.rows


def test_headings_run_on_past_half_a_turn(voyage, voyage_file):
    """Unwrapped headings cross 180 deg and go on."""
    assert np.ptp(voyage.psi) > 4.0 * np.pi
    found, _ = cut(voyage_file)
    assert any(abs(one.trial.psi[0]) < np.pi < abs(one.trial.psi[-1]) for one in found)


@pytest.mark.parametrize("low", [-np.pi, 0.0])
def test_wrapped_headings_go_on_within_a_window(voyage, voyage_file, tmp_path, low):
    """They were refused, as they would count as a miss of a turn."""
    wrapped = replace(voyage, psi=np.mod(voyage.psi - low, 2.0 * np.pi) + low)
    found, _ = cut(write_trial(wrapped, tmp_path / "a.parquet"))
    expected, _ = cut(voyage_file)
    assert len(found) == len(expected) > 50
    for one, other in zip(found, expected, strict=True):
        off = (one.trial.psi - other.trial.psi) / (2.0 * np.pi)
        assert np.allclose(off, round(off[0]), atol=1e-9)


def test_a_turn_of_headings_across_a_stop_is_no_jump(voyage, tmp_path):
    late = voyage.t >= 1000.0
    moved = replace(voyage, t=voyage.t + 600.0 * late, psi=voyage.psi + 2.0 * np.pi * late)
    found, _ = cut(write_trial(moved, tmp_path / "a.parquet"))
    assert len(found) > 50


def test_a_window_is_read_anew(voyage_file):
    opened = open_voyage(voyage_file)
    found, _ = cut(voyage_file)
    one = found[17]
    same([one], [window_at(opened, one.row, one.trial.n_samples)])


def test_memory_stays_flat(voyage, tmp_path, monkeypatch):
    """Twelve times the rows take no more memory; a foreign file has them all in one row group."""
    monkeypatch.setattr(reading, "BLOCK", 4096)
    peaks = []
    for times in (1, 12):
        columns = {name: np.tile(values, times) for name, values in voyage.columns.items() if name != "t"}
        n = len(columns["x"])
        path = write_raw(tmp_path / f"{times}.parquet", {"t": np.arange(float(n)), **columns}, b"{}")
        assert pq.ParquetFile(path).num_row_groups == 1
        tracemalloc.start()
        count = sum(1 for _ in voyage_windows(open_voyage(path), LENGTH, gap=10.0))
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
        assert count > 59 * times - 2
    assert peaks[1] < 1.3 * peaks[0]


def test_long_trials_are_written_in_row_groups(tmp_path):
    n = GROUP_ROWS + 10
    trial = made(samples=20)
    t = np.arange(float(n))
    long = replace(
        trial,
        **{name: np.resize(getattr(trial, name), n) for name in ("x", "y", "psi", "u", "v_m", "r", "n", "delta")},
        t=t,
    )
    path = write_trial(long, tmp_path / "long.parquet")
    assert [pq.ParquetFile(path).metadata.row_group(k).num_rows for k in range(2)] == [GROUP_ROWS, 10]


def test_what_a_voyage_is(voyage_file, tmp_path):
    assert open_voyage(voyage_file).is_voyage
    assert holds_voyages(voyage_file)
    hour = made("hour", samples=3601)
    path = write_trial(hour, tmp_path / "a" / "hour.parquet")
    assert not open_voyage(path).is_voyage
    assert not holds_voyages(path.parent)
    write_trial(made("longer", samples=3602), path.parent / "longer.parquet")
    assert holds_voyages(path.parent)
    assert load_voyages(path.parent).shorter == ("hour",)
    assert open_voyage(write_trial(made("says", manoeuvre="voyage"), tmp_path / "says.parquet")).is_voyage
    assert not holds_voyages("suzaku")


def test_the_digest_is_held_against_the_file(voyage, voyage_file, tmp_path):
    opened = open_voyage(voyage_file)
    assert opened.sealed
    assert len(opened.verify()) == 64
    table = pq.read_table(voyage_file)
    x = table.column("x").to_numpy().copy()
    x[5000] += 0.5
    changed = table.set_column(table.schema.get_field_index("x"), table.schema.field("x"), [x])
    pq.write_table(changed, tmp_path / "a.parquet")
    with pytest.raises(TrialError, match="not what was written"):
        open_voyage(tmp_path / "a.parquet").verify()


def test_a_damaged_row_group_is_named(voyage, tmp_path):
    import pyarrow as pa

    path = tmp_path / "a.parquet"
    table = pa.table({name: pa.array(values) for name, values in voyage.columns.items()})
    pq.write_table(table, path, row_group_size=1000, write_page_checksum=True, compression="none", use_dictionary=False)
    metadata = pq.ParquetFile(path).metadata
    at = metadata.row_group(4).column(1).data_page_offset + 2000
    content = bytearray(path.read_bytes())
    content[at] ^= 0xFF
    path.write_bytes(content)
    with pytest.raises(TrialError, match=r"row group 5 of 8, rows 4000 to 4999"):
        cut(path)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda c: c.pop("v"), "column 'v' is missing"),
        (lambda c: c.update(u=[str(one) for one in c["u"]]), "holds string, not numbers"),
        (lambda c: c["t"].__setitem__(slice(5000, 5001), 1.0), "time goes back"),
        (lambda c: c["t"].__setitem__(slice(5000, 5001), np.nan), "time is no number"),
        (lambda c: c["u"].__setitem__(slice(5000, 5001), 1e300), "nothing about a ship is beyond"),
        (lambda c: c["u"].__setitem__(slice(5000, 5001), np.inf), "infinite"),
        (lambda c: c["delta"].__imul__(180.0 / np.pi), "rudder angle up to"),
        (lambda c: c["psi"].__imul__(180.0 / np.pi), "in degrees"),
    ],
)
def test_hostile_columns(voyage, tmp_path, change, said):
    columns = {name: np.array(values) for name, values in voyage.columns.items()}
    change(columns)
    path = write_raw(tmp_path / "a.parquet", columns, b'{"manoeuvre": "voyage"}')
    with pytest.raises(TrialError, match=said) as caught:
        cut(path)
    assert "5000" in str(caught.value) or "5000" not in said


@pytest.mark.parametrize("content", [b"", b"PAR1", b"PAR1" + b"\0" * 100 + b"PAR1", b"t,x\n1,2\n"])
def test_files_that_are_none(tmp_path, content):
    path = tmp_path / "a.parquet"
    path.write_bytes(content)
    with pytest.raises(TrialError):
        open_voyage(path)
    assert not holds_voyages(path)


def test_limits(voyage_file, tmp_path, monkeypatch):
    from mmgtune import limits

    monkeypatch.setattr(limits, "VOYAGE_ROWS", replace(limits.VOYAGE_ROWS, most=7000))
    with pytest.raises(TrialError, match="a voyage of 7201 rows: too many"):
        open_voyage(voyage_file)


def test_twins_and_other_ships(voyage, tmp_path):
    write_trial(voyage, tmp_path / "a.parquet")
    write_trial(replace(voyage, ship="other"), tmp_path / "b.parquet")
    with pytest.raises(TrialError, match="two files are of trial 'voyage'") as caught:
        load_voyages(tmp_path)
    assert "of ship 'other'" in str(caught.value) or "of ship 'suzaku'" in str(caught.value)


def test_a_stretch_that_is_too_short_is_left_out(tmp_path):
    trial = with_value(made("short", samples=50, manoeuvre="voyage"), "x", slice(20, 40), np.nan)
    found, counted = cut(write_trial(trial, tmp_path / "a.parquet"))
    assert found == []
    assert counted.left_out == {"unknown inputs": 0, "incomplete motion": 20, "too short": 30}
