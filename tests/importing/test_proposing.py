"""``mmgtune trials map``: what columns are, from how they behave and what they are called."""

import csv
import os
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import tomlkit

from mmgtune.errors import LogError
from mmgtune.importing import import_logs, load_map, parse_map, propose_map
from mmgtune.importing.proposing.sampling import heading, sample_of
from mmgtune.importing.proposing.words import quantity_named, side_named, unit_named
from mmgtune.profile import load_profile
from mmgtune.trial import load_trials
from mmgtune.units import DEG, KNOT
from tests.command import run
from tools.map_disguises import SETS, bundled_logs, disguised, equal, judged, plain_logs

from .made import MAP, close, imported, logged, nmea, printed, refusal, suzaku, turn, write_csv

DATA = Path(os.environ.get("MMGTUNE_DATA", Path(__file__).parents[2].parent / "shared" / "data"))


LOG = Path(__file__).parents[2] / "docs" / "tutorial" / "logs" / "turn_p35.csv"


def needs(name):
    """Skip where measured data are not at hand, and say so."""
    reason = f"no measured data at {DATA / name}; MMGTUNE_DATA names the folder they are in"
    return pytest.mark.skipif(not (DATA / name).is_dir(), reason=reason)


# disguises


@pytest.mark.long
def test_disguises_of_bundled_trials(tmp_path):
    logs = bundled_logs()
    right = total = 0
    for number in range(8):
        rng = np.random.default_rng([5, number])
        folder = tmp_path / str(number)
        folder.mkdir()
        out = disguised(rng, [logs[k] for k in rng.permutation(len(logs))[:2]], folder)
        score, same = judged(out)
        right += score.ends["right"]
        total += score.ends.total()
        assert not score.ends["wrong"], (number, out.shown, score.wrong)
        assert same is not False, (number, out.shown, score.wrong)
    assert right > 0.97 * total


@pytest.mark.parametrize(
    ("direction", "unit"),
    [
        (lambda wave: 120.0 + wave, "deg"),
        (lambda wave: 120.0 + 4.0 * wave, "deg"),
        (lambda wave: 2.1 + 0.02 * wave, "rad"),
    ],
    ids=["deg, steady", "deg, unsteady", "rad"],
)
def test_a_wind_whose_name_says_no_unit(tmp_path, direction, unit):
    """A wind that hardly turns was taken for radians, whatever its numbers."""
    log = pd.read_csv(LOG, skiprows=2)
    wave = np.sin(0.1 * np.arange(len(log)))
    log["wind speed [m/s]"], log["wind dir"] = 6.0 + 0.5 * wave, direction(wave)
    log.to_csv(tmp_path / "log.csv", index=False)
    assert propose_map([tmp_path / "log.csv"]).guesses["wind_dir"].keys["unit"] == unit


@pytest.mark.daily("kvlcc2-hsva")
@pytest.mark.parametrize("name", [pytest.param(name, marks=needs(name)) for name in SETS])
def test_disguises_of_measured_trials(tmp_path, name):
    preset, pattern, _ = SETS[name]
    logs = plain_logs(DATA / name, preset, pattern)
    rng = np.random.default_rng([7, 0])
    score, same = judged(disguised(rng, [logs[k] for k in rng.permutation(len(logs))[:3]], tmp_path))
    assert same is not False, score.wrong
    assert score.ends["right"] >= 0.9 * score.ends.total(), score.wrong


@pytest.mark.parametrize(
    ("column", "as_logged", "quantity", "unit"),
    [
        ("HDG [deg]", np.radians, "psi", "rad"),
        ("ROT [deg/min]", lambda of: of / 60.0, "r", "deg/s"),
        ("SOG [kn]", lambda of: of * KNOT, "sog", "m/s"),
        ("COG [deg]", np.radians, "cog", "rad"),
        ("Time [s]", lambda of: of * 1000.0, "t", "ms"),
        ("Time [s]", lambda of: of / 60.0, "t", "min"),
    ],
)
def test_a_unit_that_a_name_says_and_the_motion_refutes(tmp_path, column, as_logged, quantity, unit):
    """The course was taken for the heading, surely, where that was logged in radians under "deg"."""
    log = pd.read_csv(LOG, skiprows=2)
    stamps = pd.to_datetime(log.pop("UTC"))
    log.insert(0, "Time [s]", (stamps - stamps[0]).dt.total_seconds())
    log.to_csv(tmp_path / "plain.csv", index=False)
    log[column] = as_logged(log[column])
    log.to_csv(tmp_path / "log.csv", index=False)
    plain, proposal = propose_map([tmp_path / "plain.csv"]), propose_map([tmp_path / "log.csv"])
    assert proposal.asks == proposal.problems == ()
    guess = proposal.guesses[quantity]
    assert (guess.keys["unit"], guess.confidence) == (unit, "likely")
    assert guess.keys["header_says"] == column.partition("[")[2].rstrip("]")
    rest = [name for name in plain.guesses if name != quantity]
    assert {name: proposal.guesses[name].keys for name in rest} == {name: plain.guesses[name].keys for name in rest}
    (trial,) = import_logs([tmp_path / "log.csv"], proposal.map(), ".", dry_run=True).trials
    (usual,) = import_logs([tmp_path / "plain.csv"], plain.map(), ".", dry_run=True).trials
    np.testing.assert_allclose(trial.t, usual.t, atol=1e-6)
    np.testing.assert_allclose(trial.motion, usual.motion, rtol=1e-4, atol=1e-4)


def test_a_column_called_a_heading_that_the_course_does_not_follow_is_told(tmp_path):
    columns = logged(turn())
    columns = {("A1" if name == "heading" else name): values for name, values in columns.items()}
    columns["Heading [deg]"] = 90.0 + 5.0 * np.sin(columns["time"] / 7.0)
    found = propose_map([write_csv(tmp_path / "log.csv", columns)])
    assert found.guesses["psi"].column == list(columns).index("A1")
    assert found.guesses["psi"].confidence == "likely"
    assert any("called a heading, is not what the course follows, 'A1' is" in note for note in found.notes)


@pytest.mark.parametrize("more", [(), ("COG [deg]",)])
@pytest.mark.parametrize("heading", ["Heading [deg]", "Gyro [deg]"])
def test_a_turn_alone_with_an_antenna_far_aft(tmp_path, heading, more):
    """There the course is 50 deg off the heading for most of the time, and the wind on board follows it as well."""
    trial = suzaku()
    x = trial.x - 30.0 * np.cos(trial.psi) + 3.0 * np.sin(trial.psi)
    y = trial.y - 30.0 * np.sin(trial.psi) - 3.0 * np.cos(trial.psi)
    north, east = np.gradient(trial.x, trial.t), np.gradient(trial.y, trial.t)
    blows = 8.0 * np.exp(40j * DEG) + north + 1j * east  # from there, and from where she goes to
    columns = {
        "Time [s]": trial.t,
        "Lat [deg]": -33.9 + x / 110924.0,
        "Lon [deg]": 151.3 + y / 92500.0,
        heading: np.mod(trial.psi / DEG, 360.0),
        "SOG [kn]": np.hypot(trial.u, trial.v_m) / KNOT,
        "Shaft [rpm]": 60.0 * trial.n,
        "Rudder [deg]": trial.delta / DEG,
        "Wind speed rel [kn]": np.abs(blows) / KNOT,
        "Wind dir rel [deg]": np.mod(np.angle(blows * np.exp(-1j * trial.psi)) / DEG, 360.0),
    } | {name: np.mod(np.arctan2(east, north) / DEG, 360.0) for name in more}
    found = propose_map([write_csv(tmp_path / "log.csv", columns)])
    assert found.guesses["psi"].column == list(columns).index(heading)
    assert "counterclockwise" not in str(found.guesses["psi"].keys)
    assert found.guesses["wind_dir_app"].column == list(columns).index("Wind dir rel [deg]")


def test_a_course_that_is_taken_for_the_heading_is_said_to_be(tmp_path):
    pd.read_csv(LOG, skiprows=2).drop(columns=["HDG [deg]", "ROT [deg/min]"]).to_csv(tmp_path / "log.csv", index=False)
    proposal = propose_map([tmp_path / "log.csv"])
    assert proposal.guesses["psi"].confidence == "likely"
    assert any("no heading is found: 'COG [deg]'" in note for note in proposal.notes)


@pytest.mark.parametrize(("noise", "recovers"), [(0.0, True), (1.2, False)])  # deg/min
def test_a_heading_in_whole_degrees_is_left_as_printed_beside_a_noisy_yaw_rate(tmp_path, noise, recovers):
    """What the noise of a rate adds up to is slow, and was taken for motion; digits are noise like any other."""
    columns = logged(turn())
    columns["heading"] = np.round(columns["heading"])
    columns["rate"] = columns["rate"] + noise * np.random.default_rng(3).standard_normal(len(columns["rate"]))
    found = propose_map([write_csv(tmp_path / "log.csv", columns)])
    assert ("recover" in found.guesses["psi"].keys) is recovers
    evidence = found.guesses["psi"].evidence[-1]
    assert ("recovered" in evidence) is recovers
    assert ("the noise of the yaw rate would add up to" in evidence) is not recovers
    (quality,) = import_logs(found.logs, found.map(), tmp_path, dry_run=True).quality
    fixes = [one["fix"] for one in quality["findings"] if "'psi' is printed with" in one["what"]]
    if recovers:
        assert not fixes
        assert quality["yaw"]["recovered"]["wander_deg"] < 0.1 * quality["yaw"]["recovered"]["rounding_deg"]
    else:
        assert all("recover" not in fix for fix in fixes)
        assert quality["yaw"]["recovered"] is None


def test_a_wrong_map_makes_other_trials(tmp_path):
    rng = np.random.default_rng(3)
    out = disguised(rng, bundled_logs()[:1], tmp_path)
    trial = import_logs(out.paths, parse_map(out.text), ".", dry_run=True).trials[0]
    assert equal(trial, trial)
    other = "port" if 'positive = "starboard" }' in out.text.split("delta")[1].splitlines()[0] else "starboard"
    line = next(line for line in out.text.splitlines() if line.startswith("delta"))
    turned = line.replace("port" if other == "starboard" else "starboard", other)
    against = import_logs(out.paths, parse_map(out.text.replace(line, turned)), ".", dry_run=True).trials[0]
    assert not equal(trial, against)


# measured sets as they are


@pytest.mark.daily("kvlcc2")
@pytest.mark.parametrize("name", [pytest.param(name, marks=needs(name)) for name in ("esso-osaka-frt", "kvlcc2-hsva")])
def test_the_map_of_a_measured_set_is_the_preset(name):
    preset, pattern, _ = SETS[name]
    logs = sorted((DATA / name).glob(pattern))[::3]
    proposal = propose_map(logs)
    assert proposal.asks == ()
    assert proposal.problems == ()
    ours = import_logs(logs, proposal.map(), ".", dry_run=True).trials
    theirs = import_logs(logs, load_map(preset, preset=True), ".", dry_run=True).trials
    for one, other in zip(ours, theirs, strict=True):
        both = min(one.n_samples, other.n_samples)
        for channel in ("t", "x", "y", "psi", "u", "v_m", "r", "n", "delta"):
            assert getattr(one, channel)[:both] == pytest.approx(getattr(other, channel)[:both], abs=1e-12, nan_ok=True)
        assert set(one.extra) == set(other.extra)


@needs("kvlcc2-marin")
@pytest.mark.long
def test_columns_of_marin_in_another_language(tmp_path):
    """Columns renamed, speeds in knots, dates with the day first: one command, and nothing asked."""
    from mmgtune.importing.importer import _records

    log = sorted((DATA / "kvlcc2-marin").glob("*zz_20*.dat"))[0]
    log_map = load_map("simman-marin", preset=True)
    (record, *_), _ = _records(log, log_map.of(log))
    series = record.series
    t = series["x"].t
    stamps = [pd.Timestamp("2008-04-14 23:58:00") + pd.Timedelta(seconds=float(one)) for one in t]
    columns = {
        "Datum/Zeit": [one.strftime("%d/%m/%Y %H:%M:%S.%f") for one in stamps],
        "Roerhoek": -np.rad2deg(series["delta"].values),
        "Koers": np.rad2deg(series["psi"].printed) % 360.0,
        "Noord": series["x"].printed,
        "Oost": series["y"].printed,
        "V noord": series["u"].values / KNOT,
        "V oost": series["v"].values / KNOT,
        "Draaisnelheid": np.rad2deg(series["r"].values) * 60.0,
        "Toeren": series["n"].values * 60.0,
    }
    write_csv(tmp_path / "log.csv", columns, sep=";", decimal=",")
    ended = run("trials", "map", "log.csv", "-o", "map.toml", cwd=tmp_path)
    assert ended.code == 0, ended.err
    assert "the map imports the log, as 1 trial" in ended.out
    found = parse_map((tmp_path / "map.toml").read_text(encoding="utf-8"))
    units = {name: (one.column, one.unit, one.positive) for name, one in found.sources.items()}
    assert units == {
        "x": ("Noord", "m", "north"), "y": ("Oost", "m", "east"), "psi": ("Koers", "deg", "clockwise"),
        "u": ("V noord", "kn", "north"), "v": ("V oost", "kn", "east"), "r": ("Draaisnelheid", "deg/min", "starboard"),
        "n": ("Toeren", "rpm", None), "delta": ("Roerhoek", "deg", "port"),
    }  # fmt: skip
    assert (found.axes, found.time.column, found.time.format) == ("earth", "Datum/Zeit", "dmy")


def circle(path, head="", turns=60.0):
    """A log of a circle at about 1 deg/s without names; ``turns`` times the revolutions per second."""
    trial = load_trials("suzaku")["turn_p35"]
    columns = (
        trial.t, trial.x, trial.y, np.degrees(trial.psi) % 360.0, np.hypot(trial.u, trial.v_m) / KNOT,
        60.0 * np.degrees(trial.r), turns * trial.n, np.degrees(trial.delta),
    )  # fmt: skip
    path.write_text(head + "".join(",".join(f"{one:.3f}" for one in row) + "\n" for row in zip(*columns, strict=True)))
    return path


@pytest.mark.parametrize("head", ["", "A,A,A,A,A,A,A,A\n"])
def test_a_circle_at_a_degree_a_second_without_names(tmp_path, head):
    """North is the slope of east then, times the yaw rate of about 1 deg/s, but no velocity in any unit."""
    proposal = propose_map([circle(tmp_path / "log.csv", head)])
    guesses = proposal.guesses
    assert {name: one.column for name, one in guesses.items()} == {
        "t": 0, "x": 1, "y": 2, "psi": 3, "sog": 4, "r": 5, "n": 6, "delta": 7,
    }  # fmt: skip
    units = {name: guesses[name].keys["unit"] for name in ("sog", "r", "n", "delta")}
    assert units == {"sog": "kn", "r": "deg/min", "n": "rpm", "delta": "deg"}
    assert [row[1] for row in proposal.table()] == [f"column {k + 1}" for k in (0, 1, 2, 3, 4, 5, 6, 7)]


# what is asked


def test_revolutions_that_no_ship_has_are_asked(tmp_path):
    """Without a name, and with 0.008 ship lengths a turn: of an engine before its gear, or none at all."""
    proposal = propose_map([circle(tmp_path / "log.csv", turns=180.0)])
    assert "columns.n.unit" in proposal.asks


def still(columns):
    """The same of a ship that lies still, with a rudder that nobody moves."""
    n = len(columns["time"])
    held = {name: np.full(n, 1.0) for name in columns}
    return {**held, "time": columns["time"], "heading": np.full(n, 45.0), "rudder": np.zeros(n)}


def test_what_does_not_show_is_asked(tmp_path):
    columns = {**logged(turn()), "rudder": np.full(400, 3.0)}
    log = write_csv(tmp_path / "log.csv", columns)
    proposal = propose_map([log])
    assert "columns.delta.positive" in proposal.asks
    said = refusal(lambda: imported(log, proposal.text))
    assert "the map asks for 'columns.delta.positive'" in said
    assert 'fix: write positive = "starboard" or "port"' in said
    line = proposal.text[: proposal.text.index("delta = {")].count("\n") + 1
    assert f"line {line}" in said


@pytest.mark.parametrize("gap", ["---", "*", "N/A"])
def test_cells_that_stand_for_nothing_do_not_hide_the_table(tmp_path, gap):
    """Dates and times with a blank between look like two columns then."""
    trial = turn()
    stamps = pd.date_range("2024-05-14 10:33:00", periods=400, freq="s").strftime("%d.%m.%Y %H:%M:%S")
    columns = {**logged(trial), "time": stamps}
    text = (
        pd.DataFrame(columns)
        .round(4)
        .astype(str)
        .apply(lambda one: one.str.replace(".", ",") if one.name != "time" else one)
    )
    text.iloc[7::20, 1:] = gap
    log = tmp_path / "log.csv"
    log.write_text("Sea trial;MS Example\n" + text.to_csv(index=False, sep=";"), encoding="utf-8")
    proposal = propose_map([log])
    assert proposal.asks == ()
    assert 'delimiter = ";"' in proposal.text
    back = imported(log, proposal.text)
    assert np.isfinite(back.delta).all()


def test_positions_and_rudders_that_say_their_sides(tmp_path):
    """Degrees with a dash, and a rudder of P1.3: more than half of the cells of a row are no plain numbers."""
    trial = turn()
    latitude, longitude = 34.6 + trial.x / 111_000.0, 135.1 + trial.y / 111_000.0 / np.cos(np.radians(34.6))
    written = {
        "TIME": pd.date_range("2024-05-14 10:33:00", periods=400, freq="s").strftime("%Y/%m/%d %H:%M:%S"),
        "LAT": [f"{int(one)}-{60.0 * (one % 1.0):08.5f}N" for one in latitude],
        "LON": [f"{int(one)}-{60.0 * (one % 1.0):08.5f}E" for one in longitude],
        "HDG": np.mod(np.degrees(trial.psi), 360.0).round(2),
        "RUDDER": [f"{'P' if one < 0.0 else 'S'}{abs(np.degrees(one)):.1f}" for one in trial.delta],
        "SHAFT REV.": np.round(60.0 * trial.n, 1),
    }
    log = tmp_path / "log.csv"
    pd.DataFrame(written).to_csv(log, index=False)
    proposal = propose_map([log])
    assert proposal.asks == ()
    back = imported(log, proposal.text)
    assert back.delta == pytest.approx(trial.delta, abs=np.radians(0.1))
    assert back.x - back.x[0] == pytest.approx(trial.x - trial.x[0], abs=0.5, rel=2e-3)


def test_a_line_of_units_is_noted_once(tmp_path):
    columns = logged(turn())
    frame = pd.DataFrame({name: values.round(4).astype(str) for name, values in columns.items()})
    units = {"time": "s", "north": "m", "heading": "deg", "ahead": "kn", "rate": "deg/min"}
    frame = pd.concat([pd.DataFrame([{name: units.get(name, "") for name in frame}]), frame])
    frame.to_csv(tmp_path / "log.csv", index=False)
    result = import_logs([tmp_path / "log.csv"], parse_map(MAP), tmp_path / "out", None, False, True)
    said = [note for one in result.quality for note in one["notes"] if "line 2" in note]
    assert said == ["line 2 holds units"]  # and not that it has no time


@pytest.mark.parametrize(("rudder", "shaft"), [("Ruder Soll/Grad", "Telegraph rpm"), ("Rudder cmd", "RPM order")])
def test_orders_are_taken_where_nothing_else_is_logged(tmp_path, rudder, shaft):
    columns = logged(turn())
    ordered = {key: values for key, values in columns.items() if key not in ("rudder", "shaft")}
    ordered |= {rudder: columns["rudder"], shaft: columns["shaft"]}
    alone = propose_map([write_csv(tmp_path / "alone.csv", ordered)])
    found = alone.map().sources
    assert (found["delta"].column, found["n"].column, alone.asks) == (rudder, shaft, ())
    assert alone.text.replace("\n# ", " ").count("this one holds orders, which") == 2
    both = propose_map(
        [write_csv(tmp_path / "both.csv", {**ordered, "Rudder": columns["rudder"], "rpm": columns["shaft"]})]
    )
    found = both.map().sources
    assert (found["delta"].column, found["n"].column) == ("Rudder", "rpm")
    assert "holds orders" not in both.text


@pytest.mark.parametrize(
    ("name", "side", "expected"),
    [
        ("Rudder", "S", ("starboard", "sure")), ("Rudder", "P", ("starboard", "likely")),
        ("CH 9", "S", (None, "asked")), ("Lat 2", "S", (None, "asked")),
    ],
)  # fmt: skip
def test_cells_that_say_starboard_or_south(tmp_path, name, side, expected):
    """S alone is starboard where the name speaks of a rudder; elsewhere it may be south, and is no rudder to port."""
    columns = logged(suzaku("turn_p35"))
    columns[name] = [f"{abs(one):.2f}{side}" for one in columns.pop("rudder")]
    guess = propose_map([write_csv(tmp_path / "log.csv", columns)]).guesses["delta"]
    assert (guess.keys.get("positive"), guess.confidence) == expected
    assert ("she turns to the other one" in " ".join(guess.evidence)) == (expected[1] == "likely")


def test_no_import_is_proposed_before_what_it_is_refused_with_is_mended(tmp_path):
    columns = logged(turn())
    columns["rudder"] = [f"{one:.3f} x" if k % 3 == 0 else one for k, one in enumerate(columns["rudder"])]
    proposal = propose_map([write_csv(tmp_path / "log.csv", columns)])
    *_, refused, following = proposal.lines("m.toml")
    assert refused.startswith("the import would be refused: ")
    assert following.startswith("next: mend what is refused, in m.toml or in the logs; then mmgtune trials import ")


def test_answers_make_the_map_whole(tmp_path):
    columns = logged(turn())
    del columns["shaft"]
    log = write_csv(tmp_path / "log.csv", columns)
    proposal = propose_map([log])
    assert proposal.asks == ("columns.n.column",)
    start = proposal.text.index("n = { column = ")
    line = proposal.text[start : proposal.text.index("\n", start)]
    trial = imported(log, proposal.text.replace(line, 'n = { value = "100 rpm" }'))
    assert trial.n == pytest.approx(100.0 / 60.0)


def test_a_profile_is_no_log(tmp_path):
    path = tmp_path / "ship.toml"
    path.write_text(load_profile("suzaku").text)
    assert "the file is no log" in refusal(lambda: propose_map(path))
    assert "it is TOML" in refusal(lambda: imported(path, MAP))


def test_a_log_that_tells_nothing_is_asked_by_names(tmp_path):
    proposal = propose_map([write_csv(tmp_path / "log.csv", still(logged(turn())))])
    assert "columns.delta.positive" in proposal.asks
    assert any("names alone" in note for note in proposal.notes)


# what logs are like


@pytest.mark.parametrize(
    ("change", "keys"),
    [
        ({"sep": ";", "decimal": ","}, {"delimiter": ";", "decimal": ","}),
        ({"sep": "\t"}, {"delimiter": "tab"}),
        ({"sep": " ", "header": False}, {"delimiter": "space", "header": False, "fields": 9, "skip": 0}),
        ({"encoding": "utf-16"}, {"encoding": "utf-16"}),
    ],
)
def test_layouts(tmp_path, change, keys):
    columns = logged(turn())
    log = write_csv(tmp_path / "log.csv", columns, **change)
    layout = sample_of(log).layout
    assert {name: layout[name] for name in keys} == keys
    close(imported(log, propose_map([log]).text), imported(write_csv(tmp_path / "plain.csv", columns)), 1e-8)


@pytest.mark.parametrize("turns", ["U/min", "1/min", "r/min", "min-1"])
def test_lines_above_and_a_line_of_units(tmp_path, turns):
    columns = logged(turn())
    path = tmp_path / "log.csv"
    units = f"s;m;m;°;kn;kn;°/min;{turns};°"
    frame = pd.DataFrame(columns).to_csv(index=False, sep=";")
    head, _, body = frame.partition("\n")
    path.write_text(f"Ship X\n\nrun 3; 2024\n{head}\n{units}\n{body}", encoding="utf-8")
    sample = sample_of(path)
    assert sample.layout["skip"] == 3
    assert sample.units == tuple(units.split(";"))
    close(imported(path, propose_map([path]).text), imported(write_csv(tmp_path / "plain.csv", columns)), 1e-8)


@pytest.mark.parametrize(
    ("rows", "expected"),
    [
        ([["a", "b"], ["1", "2"], ["3", "4"]], (1, 0, None, 2)),
        ([["1", "2"], ["3", "4"]], (0, None, None, 2)),
        ([["title"], [], ["t", "x"], ["s", "m"], ["1", "2"], ["3", "4"]], (4, 2, 3, 2)),
        ([[]], (0, None, None, 0)),
    ],
)
def test_headings(rows, expected):
    assert heading(rows) == expected


@pytest.mark.parametrize("turns", ["U/min", "1/min", "min-1", "min\u207b\u00b9", "tr/min", "omw/min", "giri/min"])
def test_revolutions_that_are_called_by_their_unit_alone(tmp_path, turns):
    columns = logged(turn())
    called = {turns if name == "shaft" else name: one for name, one in columns.items()}
    proposal = propose_map([write_csv(tmp_path / "log.csv", called)])
    assert proposal.map().sources["n"].column == turns
    assert proposal.map().sources["n"].unit == "rpm"
    assert (quantity_named(f"Soll {turns}"), quantity_named(f"Welle Bb {turns}")) == ("order", "n_port")


def test_decimal_commas_in_quotes_between_commas(tmp_path):
    columns = logged(turn())
    log = write_csv(tmp_path / "log.csv", printed(columns, ","), quoting=csv.QUOTE_ALL)
    proposal = propose_map([log])
    assert (proposal.map().delimiter, proposal.map().decimal) == (",", ",")
    close(imported(log, proposal.text), imported(write_csv(tmp_path / "plain.csv", columns)), 1e-7)
    thousands = printed({**columns, "shaft": columns["shaft"] + 0.5 - columns["shaft"] % 1.0}, digits=3)
    thousands["shaft"] = [f"1,{one}" for one in thousands["shaft"]]
    assert "decimal" not in sample_of(write_csv(tmp_path / "log2.csv", thousands, quoting=csv.QUOTE_ALL)).layout


def test_a_row_of_units_that_most_columns_lack(tmp_path):
    """The log was one without names."""
    log = write_csv(tmp_path / "log.csv", logged(turn()), sep=";")
    names, _, rest = log.read_text(encoding="utf-8").partition("\n")
    units = {"heading": "deg", "shaft": "rpm"}
    log.write_text("\n".join([names, ";".join(units.get(one, "") for one in names.split(";")), rest]), encoding="utf-8")
    proposal = propose_map(log)
    assert proposal.asks == proposal.problems == ()
    assert proposal.map().sources["psi"].column == "heading"
    close(imported(log, proposal.text), turn())


def test_columns_go_by_name_in_logs_of_another_order(tmp_path):
    columns = logged(turn())
    first = write_csv(tmp_path / "a.csv", columns)
    second = write_csv(tmp_path / "b.csv", {name: columns[name] for name in sorted(columns)})
    proposal = propose_map([first, second])
    assert (proposal.asks, proposal.problems, proposal.imported) == ((), (), 2)
    one, other = import_logs([first, second], proposal.map(), ".", dry_run=True).trials
    close(one, other)
    twice = pd.DataFrame({**columns, "shaft.1": columns["shaft"]}).rename(columns={"shaft.1": "shaft"})
    twice.to_csv(tmp_path / "a.csv", index=False)
    twice[twice.columns[::-1].unique()].to_csv(tmp_path / "b.csv", index=False)
    with pytest.raises(LogError, match="of different kinds"):
        propose_map([first, second])


@pytest.mark.parametrize("code", [-999.0, 9999.0, 999.9, -32768.0])
def test_numbers_for_no_value(tmp_path, code):
    """They made latitude and longitude swapped, as one was beyond a pole."""
    columns = logged(turn())
    lat, lon = 35.0 + columns.pop("north") * 9e-6, 139.0 + columns.pop("east") * 1.1e-5
    columns = {"time": columns.pop("time"), "lat": lat, "lon": lon, **columns}
    gaps = {name: one.copy() for name, one in columns.items()}
    for name, row in (("lat", 50), ("lon", 60), ("lat", 61), ("heading", 90), ("rudder", 120), ("shaft", 130)):
        gaps[name][row] = np.nan
    log = write_csv(tmp_path / "log.csv", {name: np.nan_to_num(one, nan=code) for name, one in gaps.items()})
    proposal = propose_map([log])
    assert (proposal.asks, proposal.problems, proposal.imported) == ((), (), 1)
    assert proposal.map().missing == (f"{code:g}",)
    assert any(note.startswith(f"{code:g} in 'lat', 'lon', 'heading'") for note in proposal.notes)
    empty = write_csv(tmp_path / "empty.csv", gaps)
    plain = propose_map([empty])
    assert not plain.map().missing
    trials = [import_logs([one.logs[0]], one.map(), ".", dry_run=True).trials[0] for one in (proposal, plain)]
    np.testing.assert_array_equal(trials[0].motion, trials[1].motion)
    counter = write_csv(tmp_path / "log.csv", {**pd.read_csv(log), "count": code - 100.0 + np.arange(400)})
    assert any("seems to stand for no value, but 'count' holds it" in note for note in propose_map([counter]).notes)


def test_whole_degrees_and_minutes_in_columns_of_their_own(tmp_path):
    columns = logged(turn())
    north, east = columns.pop("north"), columns.pop("east")
    columns |= {"lat_deg": 0 * north + 34, "lat_min": 34.6 + north * 5.4e-4}
    columns |= {"lon_deg": 0 * east + 135, "lon_min": 0.4 + east * 6.6e-4}
    log = write_csv(tmp_path / "log.csv", columns)
    proposal = propose_map([log])
    assert proposal.asks == proposal.problems == proposal.notes == ()
    assert [proposal.guesses[one].keys["minutes"] for one in ("latitude", "longitude")] == ["lat_min", "lon_min"]
    without = write_csv(tmp_path / "whole.csv", {name: one for name, one in columns.items() if "_min" not in name})
    for one in ("lat_deg", "lon_deg"):
        said = f"'{one}' holds whole degrees only, by which the position does not change"
        assert any(note.startswith(said) for note in propose_map([without]).notes)
    text = MAP.replace('x = { column = "north", unit = "m" }', 'latitude = { column = "lat_deg", unit = "deg" }')
    text = text.replace('y = { column = "east", unit = "m" }', 'longitude = { column = "lon_deg", unit = "deg" }')
    assert "the position never changes: latitude and longitude are whole degrees" in refusal(
        lambda: imported(log, text)
    )


def test_numbers_that_are_values(tmp_path):
    columns = logged(turn())
    rpm = np.where(columns["time"] > 200.0, 999.0, 970.0) + (columns["time"] % 5.0)
    assert not propose_map([write_csv(tmp_path / "log.csv", {**columns, "shaft": rpm})]).map().missing


def test_logs_of_two_kinds(tmp_path):
    first = write_csv(tmp_path / "a.csv", logged(turn()))
    second = write_csv(tmp_path / "b.csv", {name.upper(): one for name, one in logged(turn()).items()})
    with pytest.raises(LogError, match="of different kinds"):
        propose_map([first, second])


def test_columns_that_only_some_logs_have(tmp_path):
    columns = logged(turn())
    more = {"Torque": columns["shaft"] * 2.0, **columns, "Note": "x"}
    logs = [write_csv(tmp_path / "a.csv", columns), write_csv(tmp_path / "b.csv", more, sep=",")]
    for given in (logs, logs[::-1]):
        proposal = propose_map(given)
        assert proposal.asks == proposal.problems == ()
        assert "not all logs have 'Torque' and 'Note': left out" in proposal.notes
        for trial in import_logs(given, proposal.map(), ".", dry_run=True).trials:
            close(trial, turn())
    lacking = write_csv(tmp_path / "c.csv", {name: one for name, one in columns.items() if name != "rudder"})
    assert "of different kinds" in refusal(lambda: propose_map([*logs, lacking]))
    assert "column 'rudder' is missing from the log" in refusal(
        lambda: import_logs([*logs, lacking], proposal.map(), ".", dry_run=True)
    )


def test_extra_columns_of_logs_that_are_imported(tmp_path):
    columns = logged(turn())
    more = {"Torque [kN m]": "n/a", **columns, "Rudder cmd": columns["rudder"], "Note": "a, b"}
    logs = [write_csv(tmp_path / "a.csv", columns), write_csv(tmp_path / "b.csv", more)]
    for trial in import_logs(logs, parse_map(MAP), ".", dry_run=True).trials:
        close(trial, turn())


def test_sentences(tmp_path):
    log = tmp_path / "log.nmea"
    log.write_text("\n".join(nmea(turn())), encoding="ascii")
    proposal = propose_map([log])
    assert proposal.imported == 1
    assert "RSA" in proposal.notes[0]
    log.write_text("\n".join(line for line in nmea(turn()) if "RSA" not in line), encoding="ascii")
    proposal = propose_map([log])
    assert proposal.asks == ("columns.delta.value",)
    assert "the map asks for 'columns.delta.value'" in refusal(lambda: parse_map(proposal.text))


def test_json_and_console(tmp_path):
    write_csv(tmp_path / "log.csv", logged(turn()))
    ended = run("trials", "map", "log.csv", "--json", cwd=tmp_path)
    found = ended.json()
    assert found["kind"] == "map"
    assert {one["quantity"] for one in found["columns"]} == {"t", "x", "y", "psi", "u", "v", "r", "n", "delta"}
    assert all(one["confidence"] == "sure" for one in found["columns"])
    # Without a file the map alone is on stdout.
    ended = run("trials", "map", "log.csv", cwd=tmp_path)
    assert parse_map(ended.out).sources["r"].unit == "deg/min"
    assert "the heading changes by it" in ended.err
    (tmp_path / "map.toml").write_text("mine")
    assert run("trials", "map", "log.csv", "-o", "map.toml", cwd=tmp_path).code == 2
    assert (tmp_path / "map.toml").read_text() == "mine"


def test_a_rudder_ordered_is_taken_before_a_velocity_that_looks_like_one(tmp_path):
    columns = logged(suzaku("zigzag_10"))
    columns["rudder_cmd"] = columns.pop("rudder")
    del columns["ahead"]
    columns["CH 4"] = columns.pop("abeam")
    found = propose_map([write_csv(tmp_path / "log.csv", columns)])
    assert found.map().sources["delta"].column == "rudder_cmd"
    assert found.asks == ()


@pytest.mark.parametrize(("name", "track"), [("SOG", True), ("Speed", True), ("Speed", False)])
def test_one_speed_is_the_track_s_or_its_part_ahead(tmp_path, name, track):
    """Of a tight turn drift tells them apart; a speed along the track has the direction of the positions."""
    trial = suzaku("turn_p35")
    columns = logged(trial)
    both = columns.pop("ahead"), columns.pop("abeam")
    columns[f"{name} [kn]"] = np.hypot(*both) if track else both[0]
    log = write_csv(tmp_path / "log.csv", columns)
    proposal = propose_map([log])
    assert ("sog" in proposal.guesses) == track
    assert ("u" in proposal.guesses) != track
    assert proposal.asks == proposal.problems == ()
    back = imported(log, proposal.text)
    drifting = slice(60, None)
    apart = np.hypot(trial.u, trial.v_m)[drifting] - trial.u[drifting]
    assert np.sqrt(np.mean((back.u - trial.u)[drifting] ** 2)) < 0.2 * np.sqrt(np.mean(apart**2))


def test_a_speed_whose_cells_and_name_are_in_cm(tmp_path):
    columns = logged(turn())
    for name, new in (("ahead", "u (cm/s)"), ("abeam", "v (cm/s)")):
        columns[new] = columns.pop(name) * KNOT * 100.0
    found = propose_map([write_csv(tmp_path / "log.csv", columns)]).map().sources
    assert [(found[name].column, found[name].unit) for name in "uv"] == [("u (cm/s)", "cm/s"), ("v (cm/s)", "cm/s")]


@pytest.mark.parametrize("head", ["% t [s]  north [m]  east[m] HDG (deg)  RUD [deg] RPM", "# t north east HDG RUD RPM"])
def test_names_in_a_comment_between_blanks(tmp_path, head):
    columns = logged(turn())
    kept = [columns[name] for name in ("time", "north", "east", "heading", "rudder", "shaft")]
    log = tmp_path / "log.dat"
    rows = [" ".join(f"{one:.6f}" for one in row) for row in zip(*kept, strict=True)]
    log.write_text("\n".join(["% zigzag, full scale", head, *rows]))
    proposal = propose_map([log])
    assert proposal.problems == ()
    text = proposal.text.replace('? "deg"', "deg")
    assert "RUD" in str(parse_map(text).sources["delta"].column)
    close(imported(log, text), imported(write_csv(tmp_path / "log.csv", {**columns, "ahead": np.nan}), _WITHOUT), 1e-5)


_WITHOUT = "\n".join(line for line in MAP.splitlines() if not line.startswith(("u =", "v =", "r =", "[vel", "axes")))


def test_a_log_without_positions_says_so(tmp_path):
    columns = {name: values for name, values in logged(turn()).items() if name not in ("north", "east")}
    proposal = propose_map([write_csv(tmp_path / "log.csv", columns)])
    assert any("no column is called a position" in note for note in proposal.notes)
    assert {"columns.x.column", "columns.y.column"} <= set(proposal.asks)


def test_axes_east_and_north_with_bare_names_leave_a_note_that_can_be_followed(tmp_path):
    trial = suzaku("zigzag_10")
    columns = {
        "time": trial.t, "pose.x": trial.y, "pose.y": trial.x, "pose.yaw": 0.5 * np.pi - trial.psi, "u": trial.u,
        "v": -trial.v_m, "r": -trial.r, "delta": -trial.delta, "rpm": trial.n * 60.0,
    }  # fmt: skip
    log = write_csv(tmp_path / "log.csv", columns)
    proposal = propose_map([log])
    (note,) = [one for one in proposal.notes if "mirror image" in one]
    assert "exchange" in note
    as_said = tomlkit.parse(proposal.text)
    entries = as_said["columns"]
    entries["x"]["column"], entries["y"]["column"] = entries["y"]["column"], entries["x"]["column"]
    entries["psi"]["positive"], entries["psi"]["zero"] = "counterclockwise", "east"
    for name in ("v", "r", "delta"):
        entries[name]["positive"] = {"port": "starboard", "starboard": "port"}[entries[name]["positive"]]
    back = imported(log, tomlkit.dumps(as_said))
    assert np.abs(back.x - trial.x).max() < 1e-3
    assert np.abs(back.motion[:, 2:] - trial.motion[:, 2:]).max() < 1e-4
    assert np.abs(back.delta - trial.delta).max() < 1e-6


def test_names_of_directions_leave_no_note_of_mirror_images(tmp_path):
    columns = logged(suzaku("zigzag_10"))
    columns["yaw"] = columns.pop("heading")
    assert not any("mirror" in one for one in propose_map([write_csv(tmp_path / "log.csv", columns)]).notes)


def over_ground(trial, start=0.0):
    """A trial's columns as of a GPS and a gyro: speed and course over the ground instead of velocities."""
    columns = logged(trial)
    ahead, abeam = columns.pop("ahead"), columns.pop("abeam")
    course = np.degrees(trial.psi + np.arctan2(abeam, ahead))
    return columns | {"time": columns["time"] + start, "SOG [kn]": np.hypot(ahead, abeam), "COG [deg]": course % 360.0}


@pytest.mark.parametrize("runs", [("turn_p35", "turn_m35"), ("turn_p35", "zigzag_10", "turn_m35")])
def test_runs_with_pauses_between_them_in_one_log(tmp_path, runs):
    """She comes out of a turn slow and begins the next fast: 5 kn between two rows were taken for an angle that wraps,
    and the speed for one that contradicts the positions."""
    columns, start = [], 0.0
    for name in runs:
        columns.append(pd.DataFrame(over_ground(suzaku(name), start)))
        columns[-1]["SOG [kn]"] *= 7.3 / columns[-1]["SOG [kn]"].max()
        for axis in ("north", "east"):
            columns[-1][axis] *= 7.3 * KNOT / np.hypot(suzaku(name).u, suzaku(name).v_m).max()
        start = columns[-1]["time"].iloc[-1] + 300.0
    log = write_csv(tmp_path / "log.csv", pd.concat(columns))
    proposal = propose_map([log])
    found = {name: proposal.guesses[name] for name in ("psi", "sog", "cog", "r")}
    assert [one.column for one in found.values()] == [3, 7, 8, 4]
    assert {one.confidence for one in found.values()} == {"sure"}
    assert not any("contradicts" in note for note in proposal.notes)


@pytest.mark.parametrize(
    ("course", "heading"), [("Kurs", "Vorausrichtung"), ("Kurs", "Heading"), ("Koers", "CH 7"), ("Heading", "Gyro")]
)
def test_the_angle_that_leads_the_track_in_turns_is_the_heading(tmp_path, course, heading):
    """The course of the positions follows itself best: a column that may be called so was the heading, surely."""
    logs = []
    for name in ("turn_p35", "zigzag_20"):
        columns = over_ground(suzaku(name))
        columns[f"{course} [°]"], columns[f"{heading} [°]"] = columns.pop("COG [deg]"), columns.pop("heading")
        del columns["rate"]
        logs.append(write_csv(tmp_path / f"{name}.csv", columns))
    guesses = propose_map(logs).guesses
    found = [next(iter(pd.read_csv(logs[0]).columns[[guesses[name].column]])) for name in ("psi", "cog")]
    assert found == [f"{heading} [°]", f"{course} [°]"]
    assert "leads it in turns" in " ".join(guesses["psi"].evidence)


def taken(log, quantity):
    """The name of the column that is proposed for a quantity."""
    guess = propose_map([log]).guesses[quantity]
    return pd.read_csv(log).columns[guess.column]


@pytest.mark.parametrize(
    ("ordered", "measured"),
    [("RSA_CMD", "RSA"), ("Helm", "Rudder"), ("Steering Order", "Steering Feedback"), ("Rudder SP", "Rudder PV")],
)
def test_the_rudder_is_the_one_measured_and_not_its_order(tmp_path, ordered, measured):
    """Steps of 20 deg in a second were the rudder, surely."""
    trial = suzaku("zigzag_20")
    columns = over_ground(trial)
    rudder = columns.pop("rudder")
    columns |= {ordered: 20.0 * np.sign(np.round(rudder / 15.0)), measured: rudder}
    assert taken(write_csv(tmp_path / "log.csv", columns), "delta") == measured


@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("PRP_SHAFT1_TRQ_KNM", 100.0), ("SHAFT_TRQ", 60.0), ("ME_LOAD_PCT", 75.0), ("TC RPM", 12000.0),
        ("ME2 rpm", 25000.0),  # called what it may be, and beyond what any propeller is driven by
    ],
)  # fmt: skip
def test_torque_and_turbochargers_are_no_revolutions(tmp_path, name, values):
    """A constant torque was the revolutions, surely, and nothing told it."""
    columns = over_ground(suzaku("turn_p35"))
    shaft = columns.pop("shaft")
    columns |= {name: np.full(len(shaft), values), "Shaft [rpm]": shaft}
    assert taken(write_csv(tmp_path / "log.csv", columns), "n") == "Shaft [rpm]"


@pytest.mark.parametrize(("ahead", "abeam"), [("VBW_lon", "VBW_tra"), ("STW long", "STW trans")])
def test_a_velocity_abeam_is_no_yaw_rate(tmp_path, ahead, abeam):
    """It goes with the yaw rate, and was one of deg/s to port where no other was logged."""
    columns = over_ground(suzaku("zigzag_20"))
    trial = logged(suzaku("zigzag_20"))
    columns |= {ahead: trial["ahead"] / KNOT, abeam: trial["abeam"] / KNOT}
    del columns["rate"]
    proposal = propose_map([write_csv(tmp_path / "log.csv", columns)])
    assert [list(columns)[proposal.guesses[name].column] for name in ("u", "v")] == [ahead, abeam]
    assert "r" not in proposal.guesses
    assert not any(
        "contradicts" in note for note in proposal.notes
    )  # the speed and course over the ground, which agree


def test_a_speed_is_off_by_no_factor_that_it_is_not_off_by_on_the_straight(tmp_path):
    """In a turn the speed along the track is 5 % more than that ahead, which "may be a factor"."""
    columns = over_ground(suzaku("turn_p35"))
    columns["Fahrt [kn]"] = columns.pop("SOG [kn]")
    del columns["COG [deg]"]
    guess = propose_map([write_csv(tmp_path / "log.csv", columns)]).guesses["sog"]
    assert guess.confidence == "sure"
    assert "factor" not in " ".join(guess.evidence)


def test_names_of_latitude_and_longitude_that_are_exchanged(tmp_path):
    """135.2 deg was read as 1 deg 35.2 min, and the ship turned to the other side at a fiftieth of her speed."""
    trial = suzaku("turn_p35")
    columns = over_ground(trial)
    north, east = columns.pop("north"), columns.pop("east")
    columns |= {"Longitude": 34.5 + north / 111_000.0, "Latitude": 135.2 + east / (111_000.0 * np.cos(34.5 * DEG))}
    proposal = propose_map([write_csv(tmp_path / "log.csv", columns)])
    assert [list(columns)[proposal.guesses[name].column] for name in ("latitude", "longitude")] == [
        "Longitude",
        "Latitude",
    ]
    assert proposal.guesses["psi"].keys["positive"] == "clockwise"
    assert proposal.guesses["sog"].confidence == "sure"
    assert any("'Latitude' is beyond 90 deg" in note for note in proposal.notes)


@pytest.mark.long
def test_a_log_of_a_day_is_looked_at_where_most_happens(tmp_path):
    """Windows of six minutes saw neither speed nor rudder: "contradicts the positions", and a side that was asked."""
    trial = suzaku("zigzag_20")
    columns = over_ground(trial)
    rest = 40_000
    t = np.arange(len(trial.t) + 2 * rest, dtype=float)
    long = {"time": t}
    before = np.arange(-rest, 0)
    after = np.arange(1, rest + 1)
    for name, values in columns.items():
        if name == "time":
            continue
        values = np.unwrap(values, period=360.0) if "deg" in name or name == "heading" else values
        steps = {"north": np.diff(values[:5]).mean(), "east": np.diff(values[:5]).mean()}
        slope = steps.get(name, 0.0)
        last = {"north": np.diff(values[-5:]).mean(), "east": np.diff(values[-5:]).mean()}.get(name, 0.0)
        noise = 1e-3 * np.std(values) * np.random.default_rng(1).standard_normal(len(t))
        long[name] = np.concatenate([values[0] + slope * before, values, values[-1] + last * after]) + noise
    proposal = propose_map([write_csv(tmp_path / "log.csv", long)])
    assert {proposal.guesses[name].confidence for name in ("psi", "sog", "cog", "n", "delta")} == {"sure"}
    assert proposal.guesses["delta"].keys["positive"] == "starboard"


@pytest.mark.parametrize(
    "before", ["", "2023-05-12T08:00:00.123Z ", "\\s:GP0001,c:1683878400*00\\", "12/05/2023,COM3,"]
)
def test_sentences_with_something_before_them(tmp_path, before):
    """Said to be no table of numbers, though the preset read them."""
    log = tmp_path / "log.txt"
    log.write_text("\n".join(before + line for line in nmea(turn())), encoding="utf-8")
    assert propose_map([log]).notes[0].startswith("sentences seen: ")


@pytest.mark.parametrize(
    ("names", "expected"),
    [
        (("ME RPM", "Shaft RPM"), "sure"), (("Shaft RPM", "M/E RPM"), "sure"), (("RPM 1", "RPM 2"), "sure"),
        (("ME RPM",), "likely"), (("RPM",), "likely"),
    ],
)  # fmt: skip
def test_of_revolutions_before_and_behind_a_gear_those_behind_it_are_taken(tmp_path, names, expected):
    """What the engine makes was taken, surely, where it stood first."""
    columns = over_ground(suzaku("turn_p35"))
    shaft = columns.pop("shaft")
    engine = next((one for one in names if "M" in one.removesuffix("RPM")), names[0])
    columns |= {name: shaft * (5.2 if name == engine else 1.0) for name in names}
    guess = propose_map([write_csv(tmp_path / "log.csv", columns)]).guesses["n"]
    assert list(columns)[guess.column] == next((one for one in names if one != engine), engine)
    assert guess.confidence == expected
    said = " ".join(guess.evidence)
    assert ("on the other side of a gear" in said) == (len(names) == 2)
    assert ("an engine before a gear?" in said) == (len(names) == 1)


@pytest.mark.parametrize(
    ("name", "quantity"),
    [
        ("Hauptmaschine [U/min]", "n"), ("Main engine [rpm]", "n"), ("ME rpm", "n"), ("Drehzahl Hauptmaschine", "n"),
        ("ME Speed [rpm]", "n"), ("Engine speed [1/min]", "n"), ("Engine speed", "n"), ("Hoofdmotor [omw/min]", "n"),
        ("Bb-Maschine [U/min]", "n_port"), ("Régime moteur [tr/min]", "n"), ("Huvudmaskin [varv/min]", "n"),
        ("Motor vessel speed [kn]", "u"), ("Main engine load [%]", "other"), ("ME power [kW]", "other"),
        ("Main engine cmd [rpm]", "order"), ("Turbocharger [rpm]", "other"), ("Bow thruster [rpm]", "n_bow"),
        ("Diesel generator 1 [rpm]", "other"), ("Steering pump motor [rpm]", "other"), ("ROT [1/min]", "r"),
    ],
)  # fmt: skip
def test_revolutions_of_engines_by_name(name, quantity):
    assert quantity_named(name) == quantity


@pytest.mark.parametrize("name", ["Hauptmaschine [U/min]", "Main engine [rpm]", "Engine speed [1/min]", "Drehzahl HM"])
@pytest.mark.parametrize("below", [False, True])
def test_revolutions_of_an_engine_that_drives_the_propeller_itself(tmp_path, name, below):
    """They were taken for it by their behaviour, or left out as a speed."""
    columns = over_ground(suzaku("turn_p35"))
    columns[name] = columns.pop("shaft")
    log = write_csv(tmp_path / "log.csv", columns, sep=";")
    if below:
        head, _, rest = log.read_text(encoding="utf-8").partition("\n")
        names = head.split(";")
        units = ["rpm" if one == name else "deg" if one in ("heading", "rudder") else "" for one in names]
        shown = [one.partition(" [")[0] for one in names]
        log.write_text("\n".join([";".join(shown), ";".join(units), rest]), encoding="utf-8")
    proposal = propose_map(log)
    guess = proposal.guesses["n"]
    assert list(columns)[guess.column] == name
    assert guess.evidence[0] == "its name says so"
    if "[" in name or below:
        assert guess.keys["unit"] == "rpm"


def test_the_shafts_of_both_sides_are_taken_before_their_engines(tmp_path):
    columns = over_ground(suzaku("turn_p35"))
    shaft = columns.pop("shaft")
    for side in ("port", "stbd"):
        columns |= {f"Shaft RPM {side}": shaft, f"ME RPM {side}": 3.0 * shaft}
    proposal = propose_map([write_csv(tmp_path / "log.csv", columns)])
    found = [list(columns)[proposal.guesses[name].column] for name in ("n_port", "n_stbd")]
    assert found == ["Shaft RPM port", "Shaft RPM stbd"]


@pytest.mark.parametrize(("name", "factor"), [("Logge", 1.06), ("EM log", 1.0), ("Corredera", 0.95), ("CH 5", 1.06)])
def test_a_speed_of_a_log_is_the_speed_ahead_and_a_factor_is_not_sure(tmp_path, name, factor):
    """It was the speed over the ground, surely, within 6 %."""
    columns = logged(suzaku("turn_p35"))
    del columns["abeam"]
    columns[f"{name} [kn]"] = factor * columns.pop("ahead")
    guesses = propose_map([write_csv(tmp_path / "log.csv", columns)]).guesses
    guess = guesses["u" if name != "CH 5" or "u" in guesses else "sog"]
    assert list(columns)[guess.column] == f"{name} [kn]"
    assert guess.confidence == ("sure" if factor == 1.0 else "likely")
    assert ("off by a factor" in " ".join(guess.evidence)) == (factor != 1.0)


# names


@pytest.mark.parametrize(
    ("name", "quantity", "unit"),
    [
        ("Kurs über Grund [°]", "cog", "deg"), ("Ruderlage BB", "delta_port", ""), ("s", "", ""), ("CH01", "", ""),
        ("Vitesse de giration (°/min)", "r", "deg/min"), ("対地速力 [ノット]", "sog", "kn"), ("船首方位", "psi", ""),
        ("Geschwindigkeit quer", "v", ""), ("Heading_deg", "psi", "deg"), ("Rudder Order", "order", ""),
        ("Wind dir app", "wind_dir_app", ""), ("shaft_rpm", "n", "rpm"), ("Telegraph rpm", "order", "rpm"),
        ("vel_n", "u", ""), ("Vorausrichtung", "psi", ""), ("Voorliggende koers", "psi", ""),
        ("Kurs over grunn", "cog", ""),
        ("Senshu hoi", "psi", ""), ("Shinro", "cog", ""), ("Rumbo efectivo", "cog", ""),
        ("vel_e", "v", ""), ("pos_n", "x", ""), ("utm_e", "y", ""), ("RPM", "n", "rpm"),
        ("sog_ms", "sog", "m/s"), ("Speed [ms]", "u", "m/s"), ("timestamp_ms", "time", "ms"),
        ("PRP_SHAFT1_TRQ_KNM", "other", ""), ("ME1_LOAD_PCT", "other", ""), ("TC RPM", "other", "rpm"),
        ("Rudder SP", "order", ""), ("Rudder PV", "delta", ""), ("VBW_tra", "v", ""), ("STW long", "u", ""),
        ("data.eta 1", "", ""), ("Скорость, уз", "u", "kn"), ("Курс, град", "psi", "deg"),
        ("Руль ПБ", "delta_stbd", ""),
        ("Обороты об/мин", "n", "rpm"), ("Угловая скорость град/мин", "r", "deg/min"), ("Широта", "latitude", ""),
        ("Speed mph", "u", "mph"), ("Heading gon", "psi", "gon"), ("Заданный курс", "order", ""),
    ],
)  # fmt: skip
def test_names(name, quantity, unit):
    assert (quantity_named(name), unit_named(name)) == (quantity, unit)


def test_speed_through_water_is_told(tmp_path):
    trial = turn()
    columns = logged(trial)
    circle = np.linspace(0.0, 4.0 * np.pi, 400)
    north, east = np.cumsum(8.0 * np.cos(circle)), np.cumsum(8.0 * np.sin(circle))
    drift = 0.8 * np.arange(400.0)
    log = write_csv(
        tmp_path / "log.csv",
        {"time": columns["time"], "N": north + drift, "E": east, "gyro": np.rad2deg(circle) % 360.0,
         "log": np.full(400, 8.0) / KNOT + 0.01 * np.sin(circle * 7), "rudder": columns["rudder"],
         "rpm": np.full(400, 100.0)},
    )  # fmt: skip
    proposal = propose_map([log])
    assert "u" not in proposal.guesses
    assert any("speed through the water" in note for note in proposal.notes)


def test_the_map_of_the_tests_is_found_again(tmp_path):
    log = write_csv(tmp_path / "log.csv", logged(turn()))
    found, ours = propose_map([log]).map(), parse_map(MAP)
    for name, source in ours.sources.items():
        other = found.sources[name]
        assert (other.column, other.unit) == (source.column, source.unit)
        assert source.positive in (None, other.positive)


@pytest.mark.parametrize(
    ("name", "side"),
    [
        ("Rudder angle (P+)", "port"), ("Rudder [+ to stbd]", "starboard"), ("Ruder (BB positiv)", "port"),
        ("delta, positive starboard", "starboard"), ("Rudder port pos [deg]", ""), ("rudder_port [deg]", ""),
        ("rudder +/- 35", ""),
    ],
)  # fmt: skip
def test_names_may_say_to_which_side_a_rudder_is_positive(name, side):
    assert side_named(name) == side


def test_a_side_that_only_the_name_says_is_likely(tmp_path):
    """One turn in a log of five rows a second tells too little: the side was asked for, though the header says it."""
    trial, t = suzaku("turn_p35"), np.arange(0.0, 480.0, 0.2)
    columns = {name: np.interp(t, trial.t, values) for name, values in logged(trial).items() if name != "rudder"}
    columns["heading"] = np.mod(np.interp(t, trial.t, trial.psi) / DEG, 360.0)
    columns["Rudder (P+)"] = -np.interp(t, trial.t, trial.delta) / DEG
    guess = propose_map(write_csv(tmp_path / "log.csv", columns)).guesses["delta"]
    assert guess.keys["positive"] == "port"
    assert guess.confidence == "likely" or "positive to port in 1 of 1 logs" in guess.evidence


def test_a_speed_along_the_track_is_not_off_by_what_drift_takes_of_it(tmp_path):
    trial = suzaku("turn_m20")
    columns = {"time [s]": trial.t, "north [m]": trial.x, "east [m]": trial.y, "heading [deg]": trial.psi / DEG}
    columns |= {
        "SOG [kn]": np.hypot(trial.u, trial.v_m) / KNOT,
        "rpm": 60.0 * trial.n,
        "rudder [deg]": trial.delta / DEG,
    }
    guess = propose_map(write_csv(tmp_path / "log.csv", columns)).guesses["sog"]
    assert guess.confidence == "sure"
    assert "off by a factor" not in " ".join(guess.evidence)


def test_a_magnetic_heading_is_told_and_a_true_one_is_taken_before_it(tmp_path):
    columns = logged(turn())
    true = columns.pop("heading")
    magnetic = {"Heading Mag": (true + 7.5) % 360.0}
    alone = propose_map([write_csv(tmp_path / "alone.csv", columns | magnetic)])
    assert [note for note in alone.notes if "'Heading Mag' is magnetic by its name: give it an offset" in note]
    both = propose_map([write_csv(tmp_path / "both.csv", columns | magnetic | {"Heading True": true})])
    assert 'psi = { column = "Heading True"' in both.text
    assert not [note for note in both.notes if "magnetic" in note]
