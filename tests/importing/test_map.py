"""Maps: everything wrong is said at once, with its line and the closest thing that is known."""

import pytest

from mmgtune.importing import load_map, parse_map
from tests.importing.made import MAP, refusal


def test_a_placeholder_that_there_is_not():
    told = refusal(lambda: parse_map(MAP.replace("[time]", '[trial]\nid = "{prt}"\ngroup = "{folder}"\n[time]')))
    assert "'trial.id' has '{prt}' in it" in told
    assert "'part'" in told
    assert "'trial.group' has '{folder}' in it" in told


def test_everything_wrong_at_once():
    text = MAP.replace('x = { column = "north", unit = "m" }', 'x = { colum = "north", unit = "furlong" }')
    text = text.replace("psi = ", "phi = ").replace("[velocity]", "[velocities]") + '[cut]\nlead = "5 s"\n'
    answer = refusal(lambda: parse_map(text))
    for words in (
        "unknown key 'columns.x.colum'", "did you mean 'column'", "unit of 'x' is 'furlong'", "unknown column 'phi'",
        "did you mean 'psi'", "unknown key 'velocities'", "did you mean 'velocity'", "no column is named for 'psi'",
        "'cut.lead' is given without 'cut.from'",
    ):  # fmt: skip
        assert words in answer, (words, answer)
    assert "line 9" in answer


@pytest.mark.parametrize(
    ("before", "after", "words"),
    [
        ("schema = 1", "schema = 2", "schema is 2"),
        ("schema = 1", "schema = = 1", "not valid TOML"),
        ('axes = "ship"', 'axes = "boat"', "one of: 'ship', 'earth'"),
        ('unit = "kn"', 'unit = "m"', "unit of 'u' is 'm'"),
        ('column = "rudder"', "column = 0", "counted from 1"),
        ('column = "time"', "", "no column is named for time"),
        ('unit = "rpm"', 'unit = "rpm", value = "90 rpm"', "a value and keys of a column"),
        ('{ column = "shaft", unit = "rpm" }', "{ value = 90 }", "has no unit"),
        ('unit = "rpm"', 'unit = "rpm", zero = "east"', "has no meaning"),
        ('unit = "rpm"', 'unit = "rpm", scale = 0', "not 0"),
        ('positive = "starboard"', 'positive = "left"', "'starboard', 'port'"),
        ("[columns]", '[columns.wind_dir]\ncolumn = "w"\nunit = "deg"\n[columns]', "comes from or goes to?"),
        ("[columns]", '[antenna]\nx = "3 m"\ny = "0 m"\n[columns]', "of midship or of the antenna?"),
        ("[columns]", '[antenna]\nx = "3 m"\n[columns]', "'antenna.y' is missing"),
        ("[columns]", '[antenna]\nx = "-5000 m"\ny = "0 m"\n[columns]', "the antenna is 5000 m from midship"),
        ("[columns]", "[position]\norigin = [100.0, 3.0]\n[columns]", "[latitude, longitude]"),
        ("[columns]", '[log]\nencoding = "utf-9"\n[columns]', "unknown encoding"),
        ("[columns]", '[log]\nformat = "docx"\n[columns]', "'csv', 'parquet', 'nmea'"),
        ("[columns]", '[cut]\nstart = "9 s"\nend = "3 s"\n[columns]', "not before"),
        ("[columns]", '[trial]\nnoise = { w = "1 m" }\n[columns]', "noise of unknown column 'w'"),
        ("[columns]", "[resample]\ngap = 0.5\n[columns]", "at least 1"),
        ('axes = "ship"', 'axes = "ship"\nframe = 1', "unknown key 'velocity.frame'"),
        ("[columns]", '[columns.sog]\ncolumn = "s"\n[columns]', "speed over ground"),
        ('psi = { column = "heading", unit = "deg" }', 'psi = { value = "3 deg" }', "is given as a constant"),
        ("[columns]", '[log]\nformat = "parquet"\nskip = 3\n[columns]', "'log.skip' has no meaning for Parquet"),
        ("[columns]", '[log]\nformat = "nmea"\n[columns]', "'columns.psi.column' has no meaning for NMEA 0183"),
        ("[columns]", '[log]\nformat = "nmea"\n[columns]', "no sentence holds 'x'"),
        ('y = { column = "east", unit = "m" }', "", "no columns are named for the position"),
        ("[columns]", 'shifted = "earth-axes"\n[columns]', "but not from where"),
        ("[columns]", 'shifted = "ship-axes"\n[columns]', "one of: 'earth-axes'"),
        ('axes = "ship"', 'point = { x = "3 m", y = "0 m" }\nshifted = "earth-axes"', "ship axes or in earth axes?"),
        ('axes = "ship"', 'axes = "ship"\npoint = { x = "3 m" }', "'velocity.point.y' is missing"),
        ('axes = "ship"', 'axes = "ship"\npoint = { x = "3", y = "0 m" }', "'velocity.point.x'"),
        ('axes = "ship"', 'axes = "ship"\npoint = { x = "3 m", y = "0 m", z = "1 m" }', "'velocity.point.z'"),
        ('unit = "rpm"', 'unit = "rpm", recover = "yaw-rate"', "is for positions x and y and for the heading"),
        ('"heading", unit = "deg"', '"heading", unit = "deg", recover = "print-resolution"', "one of: 'yaw-rate'"),
        ("[columns]", '[cut]\nend = "0 s"\n[columns]', "nothing would be left"),
        ("[columns]", '[cut]\nend = "3, 4 s"\n[columns]', "has 2 values, not 1"),
        ("[columns]", "[log]\nheader = false\nfields = -1\n[columns]", "'log.fields' is -1"),
        ("[columns]", "[log]\nheader = false\nfields = 0\n[columns]", "'log.fields' is 0"),
        ("[columns]", "[log]\nfields = 9\n[columns]", "'log.fields' is for logs without a header"),
        ("[columns]", '[cut]\nto = "last order"\n[columns]', "one of: 'last-order'"),
        ("[columns]", '[cut]\nsplit = "pullout"\n[columns]', "one of: 'pull-out'"),
        ("[columns]", '[logs]\nname = "a"\n[columns]', "'logs' is not a list"),
        ("[columns]", '[[logs]]\ntrial = { ship = "a" }\n[columns]', "a pattern of names of logs, is missing"),
        ("[columns]", '[[logs]]\nname = "a*"\n[columns]', "the entry changes nothing"),
        ("[columns]", '[[logs]]\nname = "a*"\ntrail = { ship = "a" }\n[columns]', "did you mean 'trial'"),
        ("[columns]", '[[logs]]\nname = "a*"\ncut = { end = "9" }\n[columns]', "[[logs]] 1"),
    ],
)
def test_mistakes(before, after, words):
    assert before in MAP
    answer = refusal(lambda: parse_map(MAP.replace(before, after, 1)))
    assert words in answer, answer


def test_heading_from_a_rate_of_unknown_sign():
    text = MAP.replace('"heading", unit = "deg"', '"heading", unit = "deg", recover = "yaw-rate"')
    text = text.replace('unit = "deg/min", positive = "starboard"', 'unit = "deg/min"')
    assert "does not say where that is and its sign" in refusal(lambda: parse_map(text))


def test_absent_maps(tmp_path):
    assert "did you mean 'frt-ds-esso'" in refusal(lambda: load_map("frt-ds-eso", preset=True))
    assert "cannot read the map" in refusal(lambda: load_map(tmp_path / "no.toml"))
