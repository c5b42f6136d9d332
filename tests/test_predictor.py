"""A predictor that is no physics model goes wherever one does: scores, JSON, checks, repetitions, evidence."""

import json
import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise
from types import SimpleNamespace

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
from mmgtune.motions import as_trial, simulate_trials
from mmgtune.options import ValidateOptions
from mmgtune.orders import TurningOrder, ZigzagOrder, run_manoeuvre
from mmgtune.predictor import AT_ONCE, Prediction, Restarted, Steerable, as_predictor, portions, predicted
from mmgtune.profile import with_effects
from mmgtune.repeating import repeat
from mmgtune.scores import L_MSE
from mmgtune.trial import TrialSet
from mmgtune.validating import validate

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
    assert [motion.member for motion in simulate_trials(Nomoto(), trials)] == [0, 1, 2, 0, 1, 2]
    rms = [short_horizon(Nomoto(), trials, window=30.0, member=k).rms[0, 5] for k in (0, 2)]
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


@pytest.mark.long
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


@dataclass
class Still:
    """A predictor of one member, which stays where it is; ``spoil`` makes something else of what it returns."""

    spoil: Callable = lambda found: found
    name: str = "still"
    L_pp: float = 83.0
    n_members: int = 1
    inputs: tuple[str, ...] = ("n", "delta")
    method: str = "none"

    def predict(self, cases):
        states = np.repeat(cases.initial[:, None, None], cases.t.shape[1], axis=2)
        return self.spoil(Prediction(states, np.zeros(states.shape[:2], dtype=bool)))


def with_nan_behind_the_end(found):
    found.states[0, :, 3:] = np.nan
    return found


@pytest.mark.parametrize(
    ("spoil", "what", "fix"),
    [
        (lambda found: None, "predict of Still returns None", "mmgtune.Prediction(states, diverged)"),
        (lambda found: found.states, "predict of Still returns a ndarray", "mmgtune.Prediction(states, diverged)"),
        (lambda found: replace(found, states=found.states[:, 0]), "shape (1, 4, 6)", "return states[:, None]"),
        (lambda found: replace(found, states=found.states[:, :, :3]), "shape (1, 1, 3, 6)", "each sample of cases.t"),
        (lambda found: replace(found, states=found.states.astype(str)), "an array of str", "each sample of cases.t"),
        (lambda found: replace(found, diverged=found.diverged[:, 0]), "diverged of predict of Still", "dtype=bool"),
        (lambda found: replace(found, diverged=np.zeros((1, 1))), "an array of float64", "dtype=bool"),
        (with_nan_behind_the_end, "not finite in case 0, member 0", "isfinite(states)"),
    ],
)
def test_a_prediction_of_another_form_is_refused_and_not_scored(spoil, what, fix):
    cases = pad([np.arange(4.0)], [np.zeros((4, 2))], [np.zeros(6)])
    with pytest.raises(OptionError) as caught:
        predicted(Still(spoil), cases)
    (problem,) = caught.value.problems
    assert what in problem.what
    assert fix in problem.fix
    assert problem.why


def test_a_prediction_may_be_anything_behind_the_end_and_where_it_is_lost():
    long, short = np.arange(4.0), np.arange(3.0)
    cases = pad([short, long], [np.zeros((3, 2)), np.zeros((4, 2))], [np.zeros(6)] * 2)
    found = predicted(Still(with_nan_behind_the_end), cases)
    assert np.isnan(found.states[0, 0, 3]).all()
    lost = Prediction(np.full((2, 1, 4, 6), np.nan), np.ones((2, 1), dtype=bool))
    assert predicted(Still(lambda _: lost), cases).states is lost.states
    huge = Prediction(np.full((2, 1, 4, 6), 1e308), np.zeros((2, 1), dtype=bool))
    assert predicted(Still(lambda _: huge), cases).states is huge.states


def test_wherever_predictors_are_taken_their_form_is_looked_at(sailed):
    wrong, trials = Still(lambda found: replace(found, states=found.states[:, 0])), [*sailed.trials.values()]
    for take in (
        lambda: mmgtune.validate(wrong, sailed),
        lambda: mmgtune.simulate(wrong, sailed),
        lambda: mmgtune.score(wrong, sailed),
        lambda: mmgtune.predict(wrong, trials=sailed),
        lambda: mmgtune.predict(wrong, options=mmgtune.PredictOptions(turn=("35",), speed="12 kn", rpm="100")),
        lambda: short_horizon(wrong, trials),
        lambda: repeat(wrong, trials),
    ):
        with pytest.raises(OptionError, match="states of predict of Still"):
            take()


@pytest.mark.parametrize(
    ("wrong", "what", "fix"),
    [
        (Still(inputs=("rudder",)), "driven by 'rudder', which no trial has", "write 'delta'"),
        (Still(inputs=("n", "delat")), "driven by 'delat', which no trial has", "'delta'"),
        (Still(inputs="n"), "'inputs' of a Still is 'n'", "('n', 'delta')"),
        (Still(L_pp="83 m"), "'L_pp' of a Still is '83 m'", "in metres"),
        (Still(n_members=0), "'n_members' of a Still is 0", "how many predictions"),
        (Still(name=None), "'name' of a Still is None", "give it a name"),
        (Still, "the class Still is no ship", "Still(...)"),
        (SimpleNamespace(name="mine", L_pp=83.0, predict=lambda cases: None), "it lacks n_members, inputs", "method"),
        (SimpleNamespace(name="mine", L_pp=83.0, n_members=1, method="", inputs=()), "lacks predict", "Prediction("),
    ],
)
def test_what_is_not_yet_a_predictor_is_told_what_it_lacks(wrong, what, fix, sailed):
    with pytest.raises(OptionError) as caught:
        mmgtune.validate(wrong, sailed)
    (problem,) = caught.value.problems
    assert what in problem.what
    assert fix in problem.fix
    assert problem.why


def test_inputs_of_a_trial_have_the_names_of_columns(sailed):
    with pytest.raises(mmgtune.MmgtuneError, match="'rudder' is no input of a ship"):
        sailed["turn"].inputs(["rudder"])


@pytest.mark.parametrize("wrong", ["suzaku", 3.0, None])
def test_what_is_no_ship_is_refused(wrong, sailed):
    with pytest.raises(OptionError, match="is no ship"):
        simulate_trials(wrong, list(sailed.trials.values()))


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
