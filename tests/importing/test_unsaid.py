"""Tables without units: what a proposal says of those it takes, and where it asks."""

import numpy as np
import pytest

from mmgtune import import_logs, propose_map
from mmgtune.importing import parse_map
from mmgtune.units import DEG, KNOT

from .made import suzaku, write_csv

RUN = suzaku("zigzag_20")
FEET = 0.3048


def table(**more):
    """A run in SI, with names that say no unit."""
    return {
        "t": RUN.t, "x": RUN.x, "y": RUN.y, "psi": RUN.psi, "u": RUN.u, "v": RUN.v_m, "r": RUN.r, "n": RUN.n,
        "delta": RUN.delta, **more,
    }  # fmt: skip


def proposed(tmp_path, **more):
    columns = {name: values for name, values in table(**more).items() if values is not None}
    return propose_map(write_csv(tmp_path / "log.csv", columns))


def evidence(proposal, name):
    return "; ".join(proposal.guesses[name].evidence)


def test_what_is_taken_as_si_is_said_with_what_speaks_for_it(tmp_path):
    found = proposed(tmp_path)
    assert found.asks == ()
    assert "no unit is said: in m the track is 1.01 times as fast as 'u' in m/s, of which no" in evidence(found, "x")
    assert "no unit is said: in rad it turns 1.07 times as far as the course, in deg 0.0187 times" in evidence(
        found, "psi"
    )
    assert "no unit is said: in m/s it is 0.993 times the speed of the track, in kn 0.511 times" in evidence(found, "u")
    assert "no unit is said: in rad/s it is 1.00 times the slope of the heading" in evidence(found, "r")
    assert "no unit is said: rad is taken, in which it is 0.351 at most" in evidence(found, "delta")
    assert {one.confidence for one in found.guesses.values()} == {"sure"}
    assert "# sure: " in found.text
    assert "no unit is said: in m the track is" in found.text.replace("\n# ", " ")


def test_positions_that_no_speed_confirms_are_likely(tmp_path):
    found = proposed(tmp_path, u=None, v=None)
    assert [found.guesses[name].confidence for name in ("x", "y", "psi")] == ["likely", "likely", "sure"]
    assert "m is the usual one, and no speed is logged that would show another" in evidence(found, "y")


def test_units_that_are_said_are_not_doubted(tmp_path):
    units = {
        "t": "s",
        "x": "m",
        "y": "m",
        "psi": "rad",
        "u": "m/s",
        "v": "m/s",
        "r": "rad/s",
        "n": "1/s",
        "delta": "rad",
    }
    columns = {f"{name} [{units[name]}]": values for name, values in table().items()}
    found = propose_map(write_csv(tmp_path / "log.csv", columns))
    assert "no unit is said" not in found.text
    half = propose_map(write_csv(tmp_path / "log.csv", {"x [m]" if k == "x" else k: v for k, v in table().items()}))
    assert "no unit is said: m, as 'x [m]' says" in evidence(half, "y")


@pytest.mark.parametrize("stated", ["", "speed [kn]", "SOG [m/s]"])
def test_positions_that_contradict_the_speed_in_m_are_asked_for(tmp_path, stated):
    more = {"x": RUN.x / FEET, "y": RUN.y / FEET}
    if stated:
        more |= {"u": None, "v": None, stated: np.hypot(RUN.u, RUN.v_m) / (KNOT if "kn" in stated else 1.0)}
    found = proposed(tmp_path, **more)
    assert {"columns.x.unit", "columns.y.unit"} <= set(found.asks)
    asked = found.guesses["x"].keys["unit"]
    assert asked.startswith('? "ft" or "m": no unit is said; in m the track is ')
    assert "in ft as fast" in asked
    assert "u" in found.guesses or "sog" in found.guesses
    answered = "\n".join(
        line.replace(line[line.index("unit = ") : line.index(", positive")], 'unit = "ft"')
        if line.startswith(("x = ", "y = ")) else line for line in found.text.splitlines()
    )  # fmt: skip
    (trial,) = import_logs(tmp_path / "log.csv", parse_map(answered), ".", dry_run=True).trials
    assert np.abs(trial.x - RUN.x).max() < 1e-6


def test_a_speed_in_knots_beside_positions_in_metres_is_no_contradiction(tmp_path):
    found = proposed(tmp_path, u=None, v=None, speed=np.hypot(RUN.u, RUN.v_m) / KNOT, psi=RUN.psi / DEG)
    assert found.asks == ()
    assert found.guesses["u"].keys["unit"] == "kn"
    assert "in kn it is 1.00 times the speed of the track, in m/s 1.94 times" in evidence(found, "u")
    assert "in deg it turns 1.07 times as far as the course" in evidence(found, "psi")
