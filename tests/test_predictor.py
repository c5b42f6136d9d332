"""A predictor that is no physics model goes wherever one does: scores, JSON, checks, repetitions, evidence."""

import json
import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pytest

import mmgtune
from mmgtune.backends import Integrator, pad
from mmgtune.checking.measuring import measure
from mmgtune.cli.validate import summary
from mmgtune.diagnose.evidence import short_horizon
from mmgtune.errors import OptionError
from mmgtune.evaluation import evaluate
from mmgtune.metrics import METRICS
from mmgtune.options import ValidateOptions
from mmgtune.orders import TurningOrder, ZigzagOrder, run_manoeuvre
from mmgtune.predictor import AT_ONCE, Prediction, Restarted, Steerable, as_predictor, portions
from mmgtune.profile import with_effects
from mmgtune.repeating import repeat
from mmgtune.simulation import as_trial, simulate
from mmgtune.trial import TrialSet
from mmgtune.validating import validate
from mmgtune.validation import L_MSE

RAD = math.radians(1.0)


@dataclass
class Nomoto:
    """T r' + r = K delta at constant speed, by Euler steps: three members of different K."""

    L_pp: float = 83.0
    K: tuple[float, ...] = (0.02, 0.025, 0.03)
    T: float = 20.0
    name = "nomoto"
    inputs = ("n", "delta")
    method = "euler"
    n_members = 3

    def predict(self, cases):
        states = np.empty((len(cases), 3, *cases.t.shape[1:], 6))
        states[:, :, 0] = cases.initial[:, None]
        for k in range(1, cases.t.shape[1]):
            h = (cases.t[:, k] - cases.t[:, k - 1])[:, None]
            psi, u, v, r = np.moveaxis(states[:, :, k - 1, 2:], -1, 0)
            turn = (np.array(self.K) * cases.controls[:, k - 1, 1:2] - r) / self.T
            rates = u * np.cos(psi), u * np.sin(psi), r, 0.0 * u, -v / self.T, turn
            states[:, :, k] = states[:, :, k - 1] + h[..., None] * np.stack(rates, axis=-1)
        return Prediction(states, np.zeros(states.shape[:2], dtype=bool))


@pytest.fixture(scope="module")
def sailed(suzaku):
    """A turn and a zigzag of a physics model."""
    orders = {"turn": TurningOrder(-25.0 * RAD, 30.0, 400.0 * RAD), "zigzag": ZigzagOrder(20.0 * RAD, 20.0 * RAD, 30.0)}
    trials = {
        name: as_trial(suzaku.profile, run_manoeuvre(suzaku, order, id=name, heading=1.2))
        for name, order in orders.items()
    }
    return TrialSet(trials, tuple(trials), (), "suzaku")


def test_validation_and_its_document(suzaku, sailed):
    found = validate({"physics": suzaku, "simple": Nomoto()}, sailed, ValidateOptions(manoeuvres=True))
    document = json.loads(json.dumps(found.to_dict(), allow_nan=False))
    said = summary(found)
    assert "simple (nomoto), euler" in said
    assert "physics (suzaku), rk4" in said
    physics, simple = document["profiles"]
    assert (simple["id"], simple["method"], simple["sha256"]) == ("nomoto", "euler", None)
    assert (physics["id"], physics["method"]) == ("suzaku", "rk4")
    assert "members" not in physics
    assert [one["member"] for one in simple["members"]] == [0, 1, 2]
    assert len({one["J"] for one in simple["members"]}) == 3
    for key in ("J", "L_MSE"):
        assert simple[key] == pytest.approx(np.mean([one[key] for one in simple["members"]]))
    assert physics["L_MSE"] < min(one["L_MSE"] for one in simple["members"])
    runs = simple["manoeuvres"]["runs"]
    assert [(one["id"], one["member"]) for one in runs] == [(name, k) for name in sailed.trials for k in range(3)]
    diameters = [one["simulated"]["tactical_diameter_m"] for one in runs[:3]]
    assert diameters == sorted(diameters, reverse=True)  # the larger K, the tighter the turn
    # A steady turn of the Nomoto model: 2 U / (K delta); the tactical diameter adds a little for the transient.
    assert 1.0 < diameters[1] / (2.0 * suzaku.profile.approach.speed / (0.025 * 25.0 * RAD)) < 1.3
    assert all("overshoot_1_deg" in one["simulated"] for one in runs[3:])


def test_a_members_score_is_that_of_the_member_alone(sailed):
    trials = list(sailed.trials.values())
    records = evaluate(Nomoto(), trials)
    assert [(one.trial.id, one.member) for one in records] == [(trial.id, k) for trial in trials for k in range(3)]
    alone = evaluate(Nomoto(K=(0.025, 0.025, 0.025)), trials)
    assert [one.J for one in records[1::3]] == [one.J for one in alone[::3]]
    assert records[0].method == "euler"


def test_check_measures_it(sailed):
    found = measure(Nomoto(), list(sailed.trials.values()), list(METRICS))
    assert len(found) == 3
    assert {"J", "cVDM", "rms_v", "advance", "tactical_diameter"} <= set(found[0]["turn"])
    assert {"overshoot_1", "overshoot_2"} <= set(found[2]["zigzag"])


def test_evidence_and_simulation_take_it(sailed):
    trials = list(sailed.trials.values())
    assert [motion.member for motion in simulate(Nomoto(), trials)] == [0, 1, 2, 0, 1, 2]
    rms = [short_horizon(Nomoto(), trials, window=30.0, member=k).pooled_rms[5] for k in (0, 2)]
    assert rms[0] != rms[1]


def test_the_front_of_the_package_simulates_it_and_writes_every_member(sailed, tmp_path):
    found = mmgtune.simulate(Nomoto(), sailed)
    document = json.loads(json.dumps(found.to_dict(), allow_nan=False))
    assert (document["profile"], document["sha256"]) == ("nomoto", None)
    assert [(row["id"], row["member"]) for row in document["runs"]] == [(i, k) for i in sailed.trials for k in range(3)]
    paths = found.write(tmp_path)
    assert len(set(paths)) == 6
    back = mmgtune.read_trial(tmp_path / "turn_2.parquet")
    assert (back.id, back.ship) == ("turn_2", "nomoto")
    assert np.array_equal(back.psi, found[2].channel("psi"))
    with pytest.raises(OptionError, match="has no forces"):
        found.write(tmp_path / "more", with_forces=True)
    with pytest.raises(OptionError, match="no trials"):
        mmgtune.simulate(Nomoto())


def test_two_of_one_name_are_both_scored(suzaku, sailed):
    """A ship and what was tuned of it share their id."""
    other = with_effects(suzaku.profile, {"current": {"north": 0.3}}, "test")
    both = validate([suzaku.profile, other, suzaku.profile], sailed, ValidateOptions(manoeuvres=True))
    assert [one.name for one in both.profiles] == ["suzaku", "suzaku (2)", "suzaku (3)"]
    one, two, three = (L_MSE(one.scores) for one in both.profiles)
    assert one == three != two
    named = summary(validate(["suzaku", "suzaku"], sailed, ValidateOptions(manoeuvres=True)))
    assert "suzaku (2) (suzaku), rk4" in named


def test_a_physics_model_begun_anew_each_step_steers_as_one_that_goes_on(suzaku):
    """What predictors without a stepper of their own get; the physics model, which has no memory, must not differ."""
    predictor = as_predictor(suzaku)
    state = np.array([0.0, 0.0, 0.3, 6.0, 0.0, 0.0])
    stepper = Restarted(predictor, 0, state)
    controls = np.array([[1.7, 0.0], [1.7, 0.1], [1.7, 0.2], [1.7, 0.2]])
    for now, then in pairwise(controls):
        reached = stepper.step(now, then, 0.5)
    whole = predictor.predict(pad([np.arange(4) * 0.5], [controls], [state]))
    assert reached == pytest.approx(whole.states[0, 0, -1], rel=1e-12)


def test_a_predictor_with_a_memory_steps_by_itself(sailed):
    class Own(Nomoto):
        begun = 0

        def stepper(self, member, state, controls):
            self.begun += 1
            return Restarted(self, member, state)

    own = Own()
    assert isinstance(own, Steerable)
    assert repeat(own, list(sailed.trials.values())) == repeat(Nomoto(), list(sailed.trials.values()))
    assert own.begun == 6


def test_one_that_loses_itself_is_marked(sailed):
    class Lost(Nomoto):
        def predict(self, cases):
            found = super().predict(cases)
            found.diverged[:, 1] = True
            return found

    document = validate({"lost": Lost()}, sailed, ValidateOptions(manoeuvres=True)).to_dict()["profiles"][0]
    assert [one["J"] is None for one in document["members"]] == [False, True, False]
    assert document["J"] is None
    assert [one["simulated"] is None for one in document["manoeuvres"]["runs"]] == 2 * [False, True, False]
    assert measure(Lost(), list(sailed.trials.values()), ["J", "MMD"])[1]["turn"] == {"J": math.inf, "MMD": math.inf}


@pytest.mark.parametrize("wrong", ["suzaku", 3.0, None])
def test_what_is_no_ship_is_refused(wrong, sailed):
    with pytest.raises(OptionError, match="is no ship"):
        simulate(wrong, list(sailed.trials.values()))


def test_the_integrator_is_named(suzaku):
    assert as_predictor(suzaku).method == "rk4"
    assert as_predictor(suzaku, integrator=Integrator("euler", 2)).method == "euler, 2 substeps"


def test_portions_hold_every_case_once_and_little_at_a_time():
    lengths = [1200] * 1000
    cut = list(portions(lengths, 1))
    assert [k for part in cut for k in range(part.start, part.stop)] == list(range(1000))
    assert max(part.stop - part.start for part in cut) * 1200 <= AT_ONCE
    assert list(portions([10**7], 1)) == [slice(0, 1)]
    assert list(portions([], 1)) == []
