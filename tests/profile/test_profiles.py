"""Bundled profiles and the reader."""

from contextlib import suppress

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mmgtune import units
from mmgtune.components import COMPONENTS, KINDS
from mmgtune.errors import MmgtuneError, OptionError, ProfileError
from mmgtune.estimating import read_particulars
from mmgtune.fleet.table import read_table
from mmgtune.importing import load_map
from mmgtune.model import Model
from mmgtune.profile import Coefficient, load_profile, parse_profile, tuned, with_effects, with_values
from mmgtune.resources import profile_names
from mmgtune.trial import load_trials


@pytest.mark.parametrize("name", profile_names())
def test_every_number_has_a_source_and_every_assumption_is_marked(name):
    profile = load_profile(name)
    for section in profile.sections.values():
        for symbol, coefficient in section.coefficients.items():
            assert coefficient.source, symbol
    assert profile.assumptions()
    assert profile.approach is not None
    assert profile.steering_gear is not None
    assert set(profile.targets) <= set(profile.names())


@pytest.mark.parametrize("name", profile_names())
def test_tuned_text_round_trip(name):
    profile = load_profile(name)
    values = {target: 1.1 * profile.value(target) for target in profile.targets}
    read = parse_profile(tuned(profile, values, dict.fromkeys(values, 0.01), {"a_r": 0.5}).text)
    for target, value in values.items():
        assert read.value(target) == value
        first = profile.coefficient(target).pre_determined  # of a profile that is itself tuned, from before that
        assert read.coefficient(target).pre_determined == (profile.value(target) if first is None else first)
        assert read.coefficient(target).stderr == 0.01
    untouched = [n for n in profile.names() if n not in values]
    assert [read.value(n) for n in untouched] == [profile.value(n) for n in untouched]


MAY_BE_LEFT_OUT = {"rho", "phi_switch", "J_max", "slipstream_kt"}


@pytest.mark.parametrize("component", [c for c in COMPONENTS if c.kind in KINDS], ids=lambda c: f"{c.kind} {c.tag}")
def test_no_term_of_a_force_has_a_default(component):
    assert {symbol for symbol, field in component.fields.items() if field.default is not None} <= MAY_BE_LEFT_OUT


def test_every_term_that_is_left_out_is_named_at_once():
    lines = load_profile("suzaku").text.splitlines()
    gone = ("X_vvvr", "Y_rrr", "N_v", "C_PN0_low", "u_R0", "t_R")
    with pytest.raises(ProfileError) as told:
        parse_profile("\n".join(line for line in lines if not line.startswith(tuple(f"{name} =" for name in gone))))
    hull, propeller, rudder = told.value.problems
    assert hull.what.startswith("'hull.X_vvvr' (surge force, vvvr term [prime]), 'hull.Y_rrr' (")
    assert hull.where == "profile, line 27"
    assert hull.fix.startswith("add X_vvvr = ..., Y_rrr = ..., N_v = ... to [hull]; write 0.0 for a term that")
    assert propeller.what.startswith("'propeller.C_PN0_low' is missing (yaw moment coefficient below phi_switch, ")
    assert "'rudder.u_R0'" in rudder.what
    assert "'rudder.t_R'" in rudder.what


def test_a_term_the_source_does_not_have_is_written_as_zero():
    hull = load_profile("kvlcc2").sections["hull"].coefficients
    assert hull["X_vvvr"].value == 0.0
    assert "not in this form" in hull["X_vvvr"].source


@pytest.mark.parametrize("name", profile_names())
def test_what_was_tuned_to_measurements_says_under_which_licence(name):
    profile = load_profile(name)
    measured = "measured" in profile.provenance.get("source_of_trials", {}).values()
    assert bool(profile.licence) == bool(profile.citation) == measured
    changed = tuned(with_effects(profile, {"current": {"north": 1.0}}, "a test"), {}, {}, {}, "tuned", "CC BY 4.0", "A")
    assert changed.licence.split("; ") == [one for one in (profile.licence, "CC BY 4.0") if one]
    assert parse_profile(changed.text).citation == changed.citation


def test_values_are_shown_as_people_write_them():
    profile = load_profile("suzaku")
    assert profile.written("propeller.slipstream_kt") == "converted"
    assert profile.written("particulars.L_pp") == "83 m"
    assert profile.written("wake.w_P0") == "0.422"
    assert profile.written("rudder.flap").startswith("0, 0.1745, ")
    assert profile.written("rudder.flap").endswith(" rad")


@settings(max_examples=150, deadline=None)
@given(data=st.data())
def test_any_damage_to_a_profile_is_a_profile_error_or_none(data):
    text = load_profile("suzaku").text
    at = data.draw(st.integers(0, len(text) - 1))
    length = data.draw(st.integers(0, 40))
    rest = data.draw(st.text(max_size=12))
    with suppress(ProfileError):  # any other exception fails the test
        parse_profile(text[:at] + rest + text[at + length :])


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("12 kn", "m/s", 12 * 1852 / 3600),
        ("35 deg", "rad", 0.6108652381980153),
        ("106 rpm", "1/s", 106 / 60),
        ("-2.60e-3 1/deg", "1/deg", -2.6e-3),
        ("2 1/rad", "1/deg", 0.03490658503988659),
        ("7.00 m", "m", 7.0),
        ("0.5", "-", 0.5),
        ("6.282 m^2", "m^2", 6.282),
    ],
)
def test_units(text, unit, value):
    assert units.parse(text, unit) == (pytest.approx(value),)


@pytest.mark.parametrize("text", ["", "m", "1 2 m", "twelve kn", "12", "12 furlong"])
def test_what_is_no_speed(text):
    with pytest.raises(ValueError):
        units.parse(text, "m/s")


def a_run(folder, *more):
    """A run folder with a tuned profile, and files that are empty."""
    folder.mkdir(parents=True)
    (folder / "profile.toml").write_text(load_profile("suzaku").text, encoding="utf-8")
    for name in more:
        (folder / name).touch()
    return folder


def problems_of(text):
    try:
        parse_profile(text)
    except ProfileError as error:
        return error.problems
    return ()


@pytest.mark.parametrize("name", ["suzaku", "kvlcc2"])
def test_the_fix_of_what_is_no_number_can_be_copied(name):
    """It was no TOML where there is a unit, and beyond the limits of what is small or negative."""
    lines = load_profile(name).text.splitlines()
    copied = 0
    for k, line in enumerate(lines):
        key = line.partition(" = ")[0]
        for problem in problems_of("\n".join([*lines[:k], f"{key} = []", *lines[k + 1 :]])):
            if "not a number" in problem.what:
                written = "\n".join([*lines[:k], problem.fix.removeprefix("write "), *lines[k + 1 :]])
                said = " ".join(map(str, problems_of(written)))
                assert not any(words in said for words in ("TOML", "impossible", "has no unit")), (line, said)
                copied += 1
    assert copied > 30


def test_a_limit_without_unit_is_said_without_one():
    text = load_profile("suzaku").text.replace("x_R_ = { value = -0.5", "x_R_ = { value = -7.0")
    (problem,) = problems_of(text)
    assert problem.why.endswith("must be above -1 and below 0")


def test_a_run_folder_is_taken_for_the_profile_in_it(tmp_path):
    run = a_run(tmp_path / "diagnosed", "calm.toml", "diagnosis.json", "particles.parquet")
    assert load_profile(run).path == run / "profile.toml"
    assert load_profile(str(run)).text == load_profile("suzaku").text
    several = a_run(tmp_path / "ships", "other.toml")
    with pytest.raises(ProfileError, match="is a folder, not a file") as caught:
        load_profile(several)
    assert "other.toml, profile.toml" in caught.value.problems[0].fix


@pytest.mark.parametrize("name", ["fit.json", "report.html", "report.md", "history.jsonl"])
def test_a_document_of_a_run_is_no_profile_and_the_one_beside_it_is_named(tmp_path, name):
    run = a_run(tmp_path / "fit", name)
    with pytest.raises(ProfileError, match="this is a document, not a ship profile") as caught:
        load_profile(run / name)
    assert str(run / "profile.toml") in caught.value.problems[0].fix
    (tmp_path / name).touch()
    with pytest.raises(ProfileError) as caught:
        load_profile(tmp_path / name)
    assert caught.value.problems[0].fix == "name the TOML file of the profile"


@pytest.mark.parametrize(
    ("read", "wanted"),
    [
        (load_trials, "the file of stated indices"),
        (load_map, "the map"),
        (read_table, "the table of jobs"),
        (read_particulars, "the file of particulars"),
    ],
)
def test_a_profile_in_the_place_of_another_file_is_told_as_one(tmp_path, read, wanted):
    """A list of its tables as unknown keys said nothing."""
    (tmp_path / "ship.toml").write_text(load_profile("suzaku").text)
    with pytest.raises(MmgtuneError) as refused:
        read(tmp_path / "ship.toml")
    (problem,) = refused.value.problems
    assert problem.what == "this is a ship profile"
    assert problem.fix.startswith(f"give {wanted}")


@pytest.mark.parametrize("read", [load_profile, read_table, read_particulars])
def test_a_map_of_a_log_in_the_place_of_another_file_is_told_as_one(tmp_path, read):
    (tmp_path / "map.toml").write_text('schema = 1\n[time]\ncolumn = "t"\n[columns]\nx = { column = "x" }\n')
    with pytest.raises(MmgtuneError, match="this is the map of a log"):
        read(tmp_path / "map.toml")


@pytest.mark.parametrize("change", [lambda *given: tuned(*given, {}, {}), lambda *given: with_values(*given, "a test")])
@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"hull.R_0": np.nan}, "'hull.R_0' is nan"),
        ({"particulars.L_pp": -1.0}, "'particulars.L_pp' = -1 is impossible .*\n.*must be above 0.01 m"),
        ({"hull.R_0": "0.02"}, "'hull.R_0' is '0.02'"),
        ({"hull.R_0": True}, "'hull.R_0' is True"),
        ({"hull.R_0": None}, "'hull.R_0' is None"),
        ({"hull.nope": 1.0}, "no number 'hull.nope'"),
        ({"rudder.flap": 1.0}, "'rudder.flap' is a table"),
        ([("hull.R_0", 1.0)], "a list is no dict"),
    ],
)
def test_a_coefficient_is_changed_to_what_it_can_be(change, values, words):
    with pytest.raises(MmgtuneError, match=words) as told:
        change(load_profile("suzaku"), values)
    assert told.value.problems[0].where
    assert told.value.problems[0].fix


def test_a_number_that_is_changed_by_hand_says_where_it_is_from():
    ship = load_profile("suzaku")
    changed = with_values(tuned(ship, {"hull.R_0": 0.02}, {"hull.R_0": 0.001}, {}), {"hull.R_0": 0.018}, "by hand")
    assert changed.coefficient("hull.R_0") == Coefficient(0.018, source="by hand")
    assert parse_profile(changed.text) == changed
    with pytest.raises(OptionError, match="source"):
        with_values(ship, {"hull.R_0": 0.018}, 3)


def test_effects_that_are_none_are_named():
    ship = load_profile("suzaku")
    for values, words in (
        ({"curent": {}}, "did you mean 'current'"),
        ({"current": {"nord": 1.0}}, "effect 'current' has no 'nord'"),
        ({"current": {"north": np.nan}}, "'effects.current.north' is nan"),
        ({"current": {"north": "1 m/s"}}, "'effects.current.north' is '1 m/s'"),
    ):
        with pytest.raises(ProfileError, match=words):
            with_effects(ship, values, "a test")


def test_a_matrix_is_of_numbers_that_are_there():
    model = Model("suzaku")
    for names, values, words in (
        (["nope"], None, "no number 'nope'"),
        (["hull.R0"], [[1.0]], "did you mean 'hull.R_0'"),
        (["hull.R_0"], [1.0], r"shape \(1,\)"),
        (["hull.R_0"], [[1.0], [2.0]], r"give \(1, n_candidates\)"),
        (["hull.R_0"], [["a"]], "no numbers"),
    ):
        with pytest.raises(MmgtuneError, match=words):
            model.matrix(names, values)
