"""Trials that turn to one side only: what is tied, what is said, and that the unseen side is not made wrong."""

import shlex
from dataclasses import replace

import numpy as np
import pytest

from mmgtune.backends import Integrator
from mmgtune.cli.fit import next_steps
from mmgtune.fitting import fit
from mmgtune.fitting.one_sided import coverage_notes, followers, tied
from mmgtune.model import Model, Tie
from mmgtune.motions import as_trial, simulate_trials
from mmgtune.options import FitOptions, SimulateOptions
from mmgtune.profile import load_profile, parse_profile, tuned
from mmgtune.simulating import simulate
from mmgtune.trial import Coverage, TrialSet, load_trials

BOTH = ("rudder.gamma_Rp", "rudder.gamma_Rn")
TARGETS = ("hull.R_0", *BOTH)


@pytest.fixture(scope="module")
def turns():
    """The bundled turns of 35 deg, to starboard and to port."""
    trials = load_trials("suzaku").trials
    return {"port": trials["turn_m35"], "starboard": trials["turn_p35"]}


def coverage(*trials):
    return Coverage.of(trials, 83.0)


@pytest.mark.parametrize(("side", "follows", "leads"), [("starboard", *BOTH[::-1]), ("port", *BOTH)])
def test_the_coefficient_of_the_unseen_side_is_tied(turns, side, follows, leads):
    profile = load_profile("suzaku")
    names, ties = tied(profile, TARGETS, coverage(turns[side]))
    assert names == ("hull.R_0", leads)
    assert ties == (Tie(follows, leads, profile.value(follows) / profile.value(leads)),)
    assert followers(ties, {leads: 0.6}) == {follows: pytest.approx(0.6 * ties[0].ratio)}
    said = " ".join(coverage_notes(Model(profile, ties), names, coverage(turns[side])))
    assert f"turn to {side} only" in said
    assert f"Tied, as nothing was measured on its side: {follows} (to {leads})" in said


def test_a_weave_about_a_turn_is_not_told_as_nothing(turns):
    turn = turns["starboard"]
    weave = replace(
        turn,
        delta=turn.delta * np.where(turn.t < 0.4 * turn.t[-1], -0.4, 1.0),
        r=turn.r * np.where(turn.t < 0.3 * turn.t[-1], -0.05, 1.0),
    )
    profile, seen = load_profile("suzaku"), coverage(weave)
    names, ties = tied(profile, TARGETS, seen)
    notes = coverage_notes(Model(profile, ties), names, seen)
    assert seen.unseen_side == "port"
    assert notes[0].startswith("The trials hardly turn to port (r L/U of ")
    assert f"Tied, as hardly anything was measured on its side: {BOTH[1]}" in notes[1]


def test_with_both_sides_nothing_is_tied_and_nothing_said(turns):
    profile = load_profile("suzaku")
    both = coverage(*turns.values())
    assert tied(profile, TARGETS, both) == (TARGETS, ())
    assert coverage_notes(Model(profile), TARGETS, both) == []
    assert tied(profile, ("hull.R_0",), coverage(turns["port"])) == (("hull.R_0",), ())


def test_with_both_sides_the_other_of_a_pair_is_offered(turns):
    notes = coverage_notes(Model(load_profile("suzaku")), ("hull.R_0", BOTH[0]), coverage(*turns.values()))
    assert len(notes) == 1
    assert BOTH[1] in notes[0]


def test_a_target_of_one_side_without_its_twin_is_named(turns):
    notes = coverage_notes(
        Model(load_profile("suzaku")), ("hull.R_0", BOTH[0], "propeller.C_PY0"), coverage(turns["starboard"])
    )
    assert "turns to port wrong" in notes[-1]
    assert BOTH[0] in notes[-1]
    assert "propeller.C_PY0" in notes[-1]
    assert "hull.R_0" not in notes[-1]


def test_a_tied_row_follows_where_its_leader_is_changed():
    profile = load_profile("suzaku")
    model = Model(profile, (Tie(BOTH[1], BOTH[0], 0.5),))
    theta = model.matrix([BOTH[0]], [[0.4, 0.8]])
    assert theta[model.rows[BOTH[1]]] == pytest.approx([0.2, 0.4])
    assert model.matrix()[model.rows[BOTH[1]], 0] == profile.value(BOTH[1])
    assert model.matrix(BOTH, [[0.4], [0.3]])[model.rows[BOTH[1]], 0] == 0.3


@pytest.fixture(scope="module")
def one_sided(turns):
    """A fit to the starboard turn of a ship with both coefficients 20 % larger, and that ship's turns."""
    profile = load_profile("suzaku")
    truth = tuned(profile, {name: 1.2 * profile.value(name) for name in BOTH}, {}, {})
    sailed = {}
    for side, trial in turns.items():
        (motion,) = simulate_trials(truth, [trial], integrator=Integrator("rk4"))
        sailed[side] = replace(as_trial(truth, motion), id=side, ship="suzaku", source="measured")
    trials = TrialSet({"starboard": sailed["starboard"]}, ("starboard",), (), "suzaku", None, "", "")
    options = FitOptions(targets=TARGETS, method="least-squares", starts=1, integrator="rk4", a_r=0.5)
    return fit(profile, trials, options), sailed


def test_a_fit_to_one_side_does_not_make_the_other_wrong(one_sided):
    result, sailed = one_sided
    profile = load_profile("suzaku")
    assert result.box.names == ("hull.R_0", BOTH[0])
    assert result.tuned_values[BOTH[1]] == pytest.approx(1.2 * profile.value(BOTH[1]), rel=1e-3)
    assert any("turn to starboard only" in note for note in result.warnings)
    (port,) = simulate_trials(result.tuned_profile(), [sailed["port"]], integrator=Integrator("rk4"))
    assert port.states[-1, :2] == pytest.approx(sailed["port"].motion[-1, :2], abs=0.5)
    document = result.to_dict()
    assert document["tied"][BOTH[1]]["to"] == BOTH[0]
    assert document["coverage"]["sides"] == ["starboard"]


def test_simulate_says_where_nothing_was_measured(one_sided):
    ship = parse_profile(one_sided[0].tuned_text())
    found = simulate(ship, options=SimulateOptions(turn=("35", "-35")))
    assert [note.partition(":")[0] for note in found.notes if "tuned to did not" in note] == ["turn_m35"]
    by_id = {row["id"]: row["unvisited"] for row in found.rows()}
    assert by_id["turn_p35"] == []
    assert any("no turn to port" in words for words in by_id["turn_m35"])
    untold = simulate("suzaku", options=SimulateOptions(turn=("35",)))
    assert untold.rows()[0]["unvisited"] == []


def test_a_fit_without_test_trials_does_not_miss_them(one_sided):
    result, _ = one_sided
    assert not result.misses
    (tune,) = result.compared
    worse = replace(tune, role="test", records={"before": tune.records["after"], "after": tune.records["before"]})
    assert replace(result, compared=(tune, worse)).misses
    as_good = replace(tune, role="test")
    assert not replace(result, compared=(tune, as_good)).misses


def test_next_steps_are_commands_for_what_was_given(one_sided):
    result = replace(one_sided[0], J_of_noise={}, J_free_start=None)
    (tune,) = result.compared
    assert next_steps(result, "suzaku", "my trials") == []  # one run cannot be left out
    other = replace(tune, trial=replace(tune.trial, id="other"))
    (line,) = next_steps(replace(result, compared=(tune, other)), "a ship.toml", "my trials")
    assert shlex.split(line.partition(": ")[2]) == ["mmgtune", "leave-out", "-p", "a ship.toml", "-t", "my trials"]
    worse = replace(tune, role="test", records={"before": tune.records["after"], "after": tune.records["before"]})
    (line,) = next_steps(replace(result, compared=(tune, worse)), "suzaku", "my_trials")
    assert shlex.split(line.partition(": ")[2]) == ["mmgtune", "diagnose", "-p", "suzaku", "-t", "my_trials"]
    (line,) = next_steps(replace(result, J_of_noise={"tune": 2.0 * tune.J["after"]}), "suzaku", "my_trials")
    assert line.endswith("--initial estimated")
