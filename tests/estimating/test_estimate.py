"""Whole profiles from main dimensions: every number explained, self-propelled, with box and scatter."""

import numpy as np
import pytest

import mmgtune
from mmgtune import EstimateOptions, estimate, load_profile, read_particulars
from mmgtune.errors import OptionError, ProfileError
from mmgtune.estimating import parse_particulars
from mmgtune.physics.regressions import wageningen
from mmgtune.profile import parse_profile
from mmgtune.profile.doubts import in_words
from mmgtune.resources import folder, particulars_names

SETS = [("mmg", None), ("fam", "inoue"), ("fam", "clarke"), ("fam", "kijima")]
SMALL = """
schema = 1
[ship]
name = "A coaster"
id = "coaster"
[particulars]
L_pp = "83 m"
B = "13.5 m"
d = "3.8 m"
C_b = 0.737
[approach]
speed = "12 kn"
"""


def changed(**values):
    """The small file with lines replaced, or taken away."""
    lines = []
    for line in SMALL.splitlines():
        name = line.partition(" =")[0]
        lines += [line] if name not in values else [f"{name} = {values[name]}"] if values[name] else []
    return "\n".join(lines)


@pytest.mark.parametrize(("form", "derivatives"), SETS)
@pytest.mark.parametrize("name", particulars_names())
def test_every_number_is_explained_and_reads_back(name, form, derivatives):
    options = EstimateOptions(form=form, derivatives=derivatives)
    ship = estimate(read_particulars(name), options)
    assert parse_profile(ship.text) == ship
    for kind, section in ship.sections.items():
        for symbol, coefficient in section.coefficients.items():
            assert coefficient.source, f"{kind}.{symbol}"
    for target in ship.targets:
        assert ship.coefficient(target).scatter > 0.0
    assert len(ship.targets) > 20
    assert ship.provenance["options"]["form"] == form


def test_gear_and_approach_say_what_they_were_taken_from():
    ship = estimate(parse_particulars(SMALL))
    assert "max_angle: usual (assumption); rate: SOLAS" in ship.steering_gear.source
    assert ship.approach.source == "speed: given; n: thrust is resistance at that speed"
    assert 'rate = "2.32 deg/s"' in ship.text
    given = SMALL + 'n = "160 rpm"\n[steering_gear]\nsource = "maker"\nmax_angle = "45 deg"\nrate = "3 deg/s"\n'
    ship = estimate(parse_particulars(given))
    assert (ship.steering_gear.source, ship.approach.source) == ("maker", "given")
    assert parse_profile(ship.text) == ship


def test_the_bundled_profile_is_what_the_command_makes():
    made = estimate(read_particulars("suzaku"), EstimateOptions(form="fam"))
    assert (folder("ship_profiles") / "suzaku_fam.toml").read_text() == made.text


def test_numbers_of_suzaku_to_the_digits_of_the_formulas():
    ship = load_profile("suzaku_fam")
    for name, text in {
        "hull.Y_v": "-0.312",
        "hull.N_v": "-0.092",
        "particulars.m_y_": "0.162",
        "hull.Y_vv": "-0.418",
        "hull.N_vvr": "-0.127",
    }.items():
        assert f"{ship.value(name):.3f}" == text
    assert ship.value("rudder.t_R") == ship.value("propeller.t_P")  # as Mathioudakis et al. take it


@pytest.mark.parametrize(("form", "derivatives"), SETS)
def test_the_approach_is_at_self_propulsion(form, derivatives):
    """Started at the approach speed with the revolutions found, she neither gains nor loses speed."""
    ship = estimate(parse_particulars(SMALL), EstimateOptions(form=form, derivatives=derivatives))
    U, n = ship.approach.speed, ship.approach.n
    found = mmgtune.breakdown(ship, np.array([[0.0, 0.0, 0.0, U, 0.0, 0.0]]), np.array([[n, 0.0]]))
    assert found.total.X[0] == pytest.approx(0.0, abs=1e-3 * abs(found.hull.X[0]))


def test_pitch_is_found_from_the_revolutions():
    ship = estimate(parse_particulars(SMALL + 'n = "180 rpm"\n[propeller]\nD_P = "2.8 m"\n'))
    found = mmgtune.breakdown(ship, np.array([[0.0, 0.0, 0.0, ship.approach.speed, 0.0, 0.0]]), np.array([[3.0, 0.0]]))
    assert found.total.X[0] == pytest.approx(0.0, abs=0.05 * abs(found.hull.X[0]))  # the parabola's own error
    assert not ship.doubts()


def test_revolutions_that_no_pitch_explains_are_a_warning():
    ship = estimate(parse_particulars(SMALL + 'n = "40 rpm"\n[propeller]\nD_P = "2.8 m"\n'))
    found = ship.doubts()
    assert [one.name for one in found] == ["propeller.k_0", "propeller.k_1", "propeller.k_2"]
    assert found[0].value == ship.value("propeller.k_0")
    assert found[0].unit == "-"
    (words,) = in_words(found)
    assert words.startswith("propeller.k_0, propeller.k_1, propeller.k_2 are doubtful: no pitch of the series")
    assert words.endswith("do not go together")  # and nothing of a range


def test_an_open_water_curve_is_followed():
    J = np.linspace(0.0, 0.8, 9)
    K_T = wageningen.thrust_coefficient(J, 0.8, 0.6, 4.0)
    curve = f"\n[propeller]\nJ = {J.tolist()}\nK_T = {[round(float(k), 4) for k in K_T]}\n"
    ship = estimate(parse_particulars(SMALL + curve))
    k = [ship.value(f"propeller.k_{i}") for i in range(3)]
    np.testing.assert_allclose(np.polyval(k[::-1], J), K_T, atol=0.01)
    assert ship.coefficient("propeller.k_0").note.startswith("parabola through it")


def test_outside_a_formulas_range_is_a_warning_with_the_numbers():
    ship = estimate(parse_particulars(changed(B='"30 m"')))
    found = ship.doubts()
    told = {one.name: one.warning for one in found}
    assert told["hull.R_0"].startswith("Holtrop 1984")
    assert "L/B is 2.77, outside 3.9 to 9.5" in told["hull.R_0"]
    assert parse_profile(ship.text).doubts() == found
    assert in_words([one.to_dict() for one in found]) == in_words(found)
    assert len(in_words(found)) == len(set(told.values()))


@pytest.mark.long
def test_starboard_circle_is_wider_than_port_where_the_slipstream_makes_it_so():
    """The paper's finding of its own model, and a model without such a term turns alike."""
    for form, wider in (("fam", True), ("mmg", False)):
        ship = estimate(read_particulars("suzaku"), EstimateOptions(form=form))
        rows = mmgtune.simulate(ship, options=mmgtune.SimulateOptions(turn=("35", "-35"))).rows()
        stbd, port = (row["indices"]["tactical_diameter_m"] for row in rows)
        assert (stbd > 1.02 * port) if wider else stbd == pytest.approx(port, rel=1e-6)


@pytest.mark.parametrize(
    ("text", "what"),
    [
        (changed(C_b="1.4"), "'particulars.C_b' = 1.4 is impossible"),
        (changed(B='"830 m"'), "'particulars.B' = 830 is impossible"),
        (changed(B='"90 m"'), "the breadth is not below the length"),
        (changed(d='"20 m"'), "the draught is not below the breadth"),
        (changed(L_pp=None), "'particulars.L_pp' is missing"),
        (changed(speed='"60 kn"'), "the approach speed is impossible for this length"),
        (changed(speed="12"), "has no unit"),
        (SMALL + '\n[rudder]\nA_R = "60 m^2"\n', "a rudder of 60 m^2 is too large for this ship"),
        (SMALL + '\n[rudder]\nA_R = "0.06 m^2"\n', "a rudder of 0.06 m^2 is too small for this ship"),
        (SMALL + '\n[rudder]\nH_R = "12 m"\n', "a rudder span of 12 m is more than 1.5 draughts"),
        (SMALL + '\n[propeller]\nD_P = "9 m"\n', "a propeller of 9 m is more than 1.5 draughts"),
        (SMALL + '\n[propeller]\nD_P = "28 mm"\n', "a propeller of 0.028 m is less than a fiftieth of the draught"),
        (SMALL + "\n[propeller]\nJ = [0, 0.2, 0.1]\nK_T = [0.3, 0.2, 0.1]\n", "advance ratios do not rise"),
        (SMALL + "\n[propeller]\nJ = [0, 0.2, 0.4]\nK_T = [0.3, 0.2]\n", "no list of 3 to 50 numbers"),
        (SMALL + "\n[propeller]\npitch = 0.8\n", "unknown key 'propeller.pitch'"),
        (SMALL + '\n[above_water]\nA_T = "100 m^2"\n', "[above_water] lacks A_L"),
        (SMALL.replace('id = "coaster"', ""), "'ship.id' is missing or no id"),
        (SMALL.replace("C_b = 0.737", "C_b = nan"), "'particulars.C_b' is nan"),
        (SMALL.replace("[approach]", "[aproach]"), "unknown key 'aproach'"),
        ("schema = 1\nship = 3\nparticulars = []\n", "section [ship] is missing"),
    ],
)
def test_impossible_particulars_are_named(text, what):
    with pytest.raises(ProfileError) as told:
        parse_particulars(text)
    assert any(what in problem.what for problem in told.value.problems), [p.what for p in told.value.problems]


def test_derivatives_of_another_form_are_refused():
    with pytest.raises(OptionError, match="has no derivatives of the form 'mmg'"):
        EstimateOptions(form="mmg", derivatives="kijima")
