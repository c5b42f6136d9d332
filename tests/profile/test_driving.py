"""What drives a ship, in her profile: ``[arrangement]`` and ``[actuators.<input>]``, read, written and obeyed."""

from dataclasses import replace

import numpy as np
import pytest

import mmgtune.components.registry
import mmgtune.profile.reading
from mmgtune.components import ARRANGEMENTS, COMPONENTS, KINDS
from mmgtune.errors import ProfileError
from mmgtune.model import Model
from mmgtune.orders import TurningOrder, run_manoeuvre
from mmgtune.profile import Actuator, load_profile, parse_profile
from mmgtune.units import DEG
from tests.profile.test_writing import read_back
from tests.twin import THRUSTER, TWIN, twin

SUZAKU = load_profile("suzaku")
RUDDER = """
[actuators.delta]
source = "the yard"
low = "-20 deg"
high = { value = "30 deg", note = "a stop" }
rate = "1.5 deg/s"
"""
SHAFT = '[actuators.n]\nlow = "0 rpm"\nhigh = "120 rpm"\nrate = "1.2 rpm/s"\n'


@pytest.fixture
def known(monkeypatch):
    """The twin-rudder arrangement and her thruster, as if they stood in the lists of components."""
    kinds = (*KINDS, "thruster")
    monkeypatch.setattr(mmgtune.components.registry, "ARRANGEMENTS", (*ARRANGEMENTS, TWIN))
    monkeypatch.setattr(mmgtune.components.registry, "COMPONENTS", (*COMPONENTS, THRUSTER))
    monkeypatch.setattr(mmgtune.profile.reading, "ARRANGEMENTS", (*ARRANGEMENTS, TWIN))
    monkeypatch.setattr(mmgtune.profile.reading, "KINDS", kinds)
    monkeypatch.setattr(mmgtune.profile.reading, "SECTIONS", (*mmgtune.profile.reading.SECTIONS, "thruster"))


def refusal(text):
    with pytest.raises(ProfileError) as told:
        parse_profile(text)
    return [str(problem) for problem in told.value.problems]


def test_limits_of_inputs_are_read_in_their_units():
    ship = parse_profile(SUZAKU.text + RUDDER + SHAFT)
    assert ship.actuators == {
        "delta": Actuator(*(pytest.approx(angle * DEG) for angle in (-20.0, 30.0, 1.5))),
        "n": Actuator(0.0, 2.0, pytest.approx(0.02)),
    }
    assert ship.actuator("delta") is ship.actuators["delta"]
    assert SUZAKU.actuators == {}
    assert SUZAKU.actuator("delta").high == SUZAKU.steering_gear.max_angle
    assert SUZAKU.actuator("n") is None


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (("[actuators.delta]", "[actuators.delta_port]"), "nothing drives this ship that is called 'delta_port'"),
        (("[actuators.delta]", "[actuators.dleta]"), "did you mean 'delta'"),
        (('"-20 deg"', '"30 deg"'), "'actuators.delta.low' is not below high"),
        (('"-20 deg"', '"-20 rpm"'), "unit 'rpm' is not one of rad, deg"),
        (('"-20 deg"', "-20.0"), "'actuators.delta.low' = -20.0 has no unit"),
        (('"1.5 deg/s"', '"0 deg/s"'), "'actuators.delta.rate' = 0 is impossible"),
        (('"1.5 deg/s"', '"1.5 deg"'), "unit 'deg' is not one of rad/s, deg/s"),
        (('rate = "1.5 deg/s"\n', ""), "'actuators.delta.rate' is missing"),
        (("rate =", "speed ="), "unknown key 'actuators.delta.speed'"),
    ],
)
def test_limits_that_make_no_sense(change, said):
    told = refusal(SUZAKU.text + RUDDER.replace(*change))
    assert any(said in problem for problem in told), told
    assert all("profile, line" in problem for problem in told)


@pytest.mark.parametrize("text", ["actuators = 3\n", "[actuators]\ndelta = 3\n"])
def test_limits_that_are_no_tables(text):
    assert "actuators" in "\n".join(refusal(text + SUZAKU.text if text[0] == "a" else SUZAKU.text + text))


def test_an_arrangement_that_does_not_exist(known):
    (told,) = refusal(SUZAKU.text + '\n[arrangement]\nmodel = "twin-ruder"\n')
    assert "unknown arrangement 'twin-ruder'" in told
    assert "did you mean 'twin-rudder'" in told
    told = refusal(SUZAKU.text + '\n[arrangement]\nmodle = "twin-rudder"\n')
    assert "unknown key 'arrangement.modle'" in told[0]
    assert "arrangement" in "\n".join(refusal('arrangement = "twin-rudder"\n' + SUZAKU.text))


def test_an_arrangement_has_its_parts_and_no_others(known):
    text = load_profile("kvlcc2").text
    assert parse_profile(text + f'\n[arrangement]\nmodel = "{ARRANGEMENTS[0].tag}"\n').arrangement is ARRANGEMENTS[0]
    (told,) = refusal(text + '\n[arrangement]\nmodel = "twin-rudder"\n')
    assert "[thruster]" in told
    part = '\n[thruster]\nmodel = "tunnel"\nsource = "a test"\nk = "1 N"\nx = "3 m"\n'
    assert any("[thruster] is no part of this ship" in problem for problem in refusal(text + part))


def test_another_arrangement_is_written_and_read(known):
    ship = twin().profile
    again = read_back(ship)
    assert again.arrangement is TWIN
    assert '[arrangement]\nmodel = "twin-rudder"\n' in again.text
    limits = {"delta_port": Actuator(-0.6, 0.6, 0.05), "n_bow": Actuator(-4.0, 4.0, 0.5)}
    assert read_back(replace(ship, actuators=limits)).actuators == limits


def test_limits_are_written_changed_and_removed():
    limits = {"delta": Actuator(-0.3, 0.5, 0.02), "n": Actuator(0.0, 2.0, 0.1)}
    ship = read_back(replace(SUZAKU, actuators=limits))
    assert '[actuators.delta]\nlow = "-0.3 rad"' in ship.text
    assert 'rate = "0.1 1/s^2"' in ship.text
    changed = read_back(replace(ship, actuators={"delta": Actuator(-0.3, 0.4, 0.02)}))
    assert "actuators.n" not in changed.text
    assert "actuators" not in read_back(replace(changed, actuators={})).text
    commented = parse_profile(SUZAKU.text + RUDDER.replace('low = "-20 deg"', 'low = "-20 deg" # measured'))
    again = read_back(replace(commented, actuators={"delta": replace(commented.actuators["delta"], rate=0.05)}))
    assert 'low = "-20 deg" # measured' in again.text
    assert 'note = "a stop"' in again.text


def test_limits_of_inputs_that_another_arrangement_lacks_go(known):
    ship = replace(twin().profile, template=load_profile("kvlcc2").text + RUDDER)
    assert "[actuators.delta]" not in read_back(ship).text


def turned(profile, angle, **options):
    return run_manoeuvre(profile, TurningOrder(angle), longest=90.0, **options)


@pytest.mark.parametrize(("angle", "stop"), [(0.7, 30.0 * DEG), (-0.7, -20.0 * DEG), (0.1, 0.1)])
def test_the_rudder_obeys_its_own_limits(angle, stop):
    """Not those of the steering gear, which would let it go further, and faster."""
    rudder = turned(parse_profile(SUZAKU.text + RUDDER), angle).controls[:, 1]
    gear = turned(SUZAKU, angle).controls[:, 1]
    assert rudder[-1] == pytest.approx(stop)
    assert np.abs(np.diff(rudder)).max() == pytest.approx(1.5 * DEG)
    assert gear[-1] == pytest.approx(angle)
    assert np.abs(np.diff(gear)).max() == pytest.approx(2.32 * DEG)


def test_the_propeller_obeys_its_limits_where_the_engine_changes_revolutions():
    def reversing(share):
        return -1.0 if share < 0.97 else 1.0

    free = turned(SUZAKU, 0.6, engine=reversing)
    held = turned(parse_profile(SUZAKU.text + SHAFT), 0.6, engine=reversing)
    n, n_0 = held.controls[:, 0], SUZAKU.approach.n
    assert free.controls[:, 0].min() == -n_0
    assert np.abs(np.diff(free.controls[:, 0])).max() == 2.0 * n_0
    assert n[0] == n_0
    falling = np.flatnonzero(np.diff(n) < 0.0)
    assert np.diff(n)[falling[1:-1]] == pytest.approx(-0.02)
    # Never astern, though that is the order.
    slow = turned(parse_profile(SUZAKU.text + SHAFT.replace("1.2 rpm/s", "60 rpm/s")), 0.6, engine=reversing)
    assert slow.controls[:, 0].min() == 0.0


def test_every_input_has_its_own_limits():
    ship = twin()
    limits = {"delta_port": Actuator(-0.1, 0.1, 0.01)}
    motion = turned(Model(replace(ship.profile, actuators=limits)), 0.5)
    port, stbd = motion.controls[:, 1], motion.controls[:, 2]
    assert port.max() == pytest.approx(0.1)
    assert np.diff(port).max() == pytest.approx(0.01)
    assert stbd.max() == pytest.approx(0.5)
    assert np.diff(stbd).max() == pytest.approx(ship.profile.steering_gear.rate)
    assert (motion.controls[:, 3] == 0.0).all()
