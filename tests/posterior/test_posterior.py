"""Particles of a ship whose truth is known."""

from __future__ import annotations

import re
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from mmgtune.effects import discrepancy
from mmgtune.errors import OptionError, TrialError
from mmgtune.model import Model
from mmgtune.options import PosteriorOptions
from mmgtune.posterior import posterior
from mmgtune.posterior.room import make_room, tags_of
from mmgtune.posterior.sizing import group_of, shown_by
from mmgtune.profile import load_profile
from mmgtune.trial import Coverage, TrialSet
from mmgtune.trial.schema import ATTRIBUTES
from tests.hidden.cases import null
from tests.hidden.plant import SILENT, simulate
from tools.band_coverage import scored
from tools.band_leave_run_out import turns

QUICK = PosteriorOptions(particles=100, leave_out=False)


@pytest.fixture(scope="module")
def ship():
    return load_profile("suzaku")


@pytest.fixture(scope="module")
def sailed():
    """A ship with nothing hidden: her noisy trials and what perfect sensors log."""
    case = null(1004)
    return tuple(
        {trial.id: trial for trial in simulate(case.ship, case.effects, case.seed, noise)}
        for noise in (case.noise, SILENT)
    )


@pytest.fixture(scope="module")
def starboard(ship, sailed):
    """Learnt from two turns to starboard."""
    return posterior(ship, [sailed[0]["turn_p10"], sailed[0]["turn_p35"]], QUICK)


def test_the_middle_of_the_room_is_the_ship_herself(ship):
    room = make_room(ship)
    values = room.values(np.zeros((len(room), 1)))[:, 0]
    model = Model(room.profile)
    assert np.allclose(values, [model.base[model.rows[name]] for name in room.names], atol=1e-12)
    far = room.values(np.full((len(room), 1), 50.0))[:, 0]
    held = {name: value for name, value in zip(room.names, far, strict=True) if name.startswith("hull.")}
    assert all(np.sign(value) == np.sign(ship.value(name)) for name, value in held.items())


def test_what_is_left_out_of_the_room_is_not_there(ship):
    room = make_room(ship, without=("current", "discrepancy"))
    assert {"current", "discrepancy"}.isdisjoint(tags_of(room))
    assert "effects.current" not in room.profile.sections


def test_an_effect_that_does_not_exist_cannot_be_left_out():
    with pytest.raises(OptionError, match="did you mean 'current'"):
        PosteriorOptions(without=("curent",))


def test_the_force_of_a_measured_wind_has_room_where_it_acts(ship):
    acts, calm = make_room(load_profile("esso_osaka_3m")), make_room(ship)
    k = acts.names.index("effects.wind.measured")
    assert (acts.centre[k], acts.deviation[k]) == (1.0, 0.2)
    k = acts.names.index("effects.wind.turned")
    assert (acts.centre[k], acts.deviation[k]) == (0.0, pytest.approx(np.radians(10.0)))
    above = [name for name in acts.names if name.startswith("above_water.")]
    assert above == [name for name in acts.profile.targets if name.startswith("above_water.")] != []
    assert not any(name.endswith((".measured", ".turned")) or name.startswith("above_water.") for name in calm.names)


def test_tuned_coefficients_have_room_about_what_they_were(ship):
    from mmgtune.profile import tuned

    other = tuned(ship, {"hull.R_0": 0.02}, {}, {})
    before, after = (make_room(one) for one in (ship, other))
    assert np.array_equal(before.centre, after.centre)


@pytest.mark.parametrize("term", discrepancy.TERMS)
def test_forces_of_unknown_form_know_which_sides_are_alike(term):
    def force(v_, r_, alpha_R):
        found = SimpleNamespace(flow=SimpleNamespace(v_=v_, r_=r_, U=2.0), rudder=SimpleNamespace(alpha_R=alpha_R))
        p = SimpleNamespace(ship=SimpleNamespace(rho=1025.0, L_pp=83.0, d=3.8))
        e = discrepancy.Discrepancy(**{**dict.fromkeys(discrepancy.TERMS, 0.0), term: 0.01})
        return getattr(discrepancy.discrepancy(None, None, found, None, p, e), term[0])

    starboard, port = force(-0.2, 0.6, 0.3), force(0.2, -0.6, -0.3)
    mirrored = starboard if term[0] == "X" else -starboard
    assert starboard != 0.0
    assert port == pytest.approx(mirrored if discrepancy.shared_by_sides(term) else -mirrored, rel=1e-12)
    assert force(0.0, 0.0, 0.0) == 0.0
    unit = 0.5 * 1025.0 * 83.0 * 3.8 * 2.0**2 * (83.0 if term[0] == "N" else 1.0)
    assert abs(starboard) <= 0.01 * unit


def test_a_ship_of_the_right_form_is_covered(ship, sailed, starboard):
    measured, truth = sailed
    both = posterior(ship, [measured[name] for name in ("turn_p10", "turn_m20", "zigzag_10")], QUICK)
    assert both.converged
    assert both.sized.misfit == pytest.approx(1.0, abs=0.15)
    from tools.band_coverage import prior_of

    before = prior_of(ship, QUICK)
    particles = both.particles.predictor(as_logged=True).drawn(100, 1)
    rows = [scored(particles, before, truth[name]) for name in ("turn_m10", "turn_p20", "turn_p35", "turn_m35")]
    assert np.mean([row["covered"] for row in rows]) > 0.85
    assert np.median([row["width_over_prior"] for row in rows]) < 0.5


def test_the_side_that_no_trial_shows_is_less_certain(starboard):
    of = starboard.particles.predictor().drawn(100, 1)
    low, _, high = turns(of, 35.0)["tactical_diameter"]
    port_low, _, port_high = turns(of, -35.0)["tactical_diameter"]
    assert port_high - port_low > 1.3 * (high - low)


def test_particles_hold_what_trials_do_not_tell(starboard):
    spread = np.std(starboard.particles.values, axis=1) / starboard.room.deviation
    names = starboard.room.names
    assert spread[names.index("hull.X_vvvr")] > 0.6  # hardly acts in these turns
    assert np.median(spread) <= 1.1
    best = starboard.particles.profile
    for name in names:
        assert np.isfinite(best.value(name)), name


def test_no_trials_say_so(ship):
    with pytest.raises(TrialError, match="no time series"):
        posterior(ship, [])


def test_a_trial_of_three_samples_is_too_short(ship, sailed, tmp_path):
    turn = sailed[0]["turn_p10"]
    columns = {name: getattr(turn, name)[:3] for name in ATTRIBUTES.values()}
    short = replace(turn, extra={name: values[:3] for name, values in turn.extra.items()}, **columns)
    few = TrialSet({"turn_p10": short}, ("turn_p10",), ())
    with pytest.raises(TrialError, match="trial 'turn_p10' is too short") as error:
        posterior(ship, few, QUICK, folder=tmp_path)
    (problem,) = error.value.problems
    assert "are compared 10.8 s apart for this ship" in problem.why
    assert not list(tmp_path.iterdir())


def test_kinds_and_sides_have_names(sailed):
    trials = sailed[0]
    assert group_of(trials["turn_p35"]) == "starboard turning"
    assert group_of(trials["turn_m10"]) == "gentle port turning"
    assert group_of(trials["zigzag_20"]) == "zigzag"


def test_one_side_alone_is_said(sailed):
    trials = sailed[0]

    def said(*names):
        return shown_by([trials[name] for name in names], 83.0).one_sided()

    assert said("turn_p35", "turn_m35") is None
    assert said("zigzag_10", "zigzag_20") is None
    assert "turns to starboard alone: bands to port" in said("turn_p35", "turn_p10")
    assert "turns to port alone: bands to starboard" in said("turn_m35")
    assert "both sides, but turning circles to starboard alone: bands of circles to port" in said(
        "turn_p35", "zigzag_10"
    )
    assert "both sides, but turning circles to port alone: bands of circles to star" in said("turn_m35", "zigzag_10")
    both = shown_by([trials["turn_p35"], trials["turn_m35"]], 83.0)
    weak = replace(both, rudder=(10.0, 35.0))
    assert "little rudder to starboard: bands to starboard rest on what the ship does to port" in weak.one_sided()
    assert "no revolutions astern" in weak.sentence()


@pytest.mark.parametrize(
    "names", [("turn_p35", "zigzag_10"), ("turn_p35",), ("turn_m35",), ("turn_p35", "turn_m35"), ("zigzag_20",)]
)
def test_a_fit_and_a_posterior_say_the_same_of_the_sides(sailed, names):
    """Of a turn to starboard and a zigzag a fit said "both sides", a posterior "turns to starboard alone"."""
    trials = [sailed[0][name] for name in names]
    coverage = Coverage.of(trials, 83.0)
    shown = shown_by(trials, 83.0)
    assert coverage.turns in coverage.sentence
    assert coverage.turns in shown.sentence()
    warned = shown.one_sided() or ""
    assert bool(re.search(r"show turns to (starboard|port) alone", warned)) == (len(coverage.sides) == 1)
