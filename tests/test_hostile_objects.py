"""Objects of classes of others, functions of another form, numbers beyond all measure: refused where they are given."""

from dataclasses import replace

import numpy as np
import pytest

import mmgtune
from mmgtune.fitting.information import Information
from mmgtune.fitting.pooled import SisterClass, pooled
from mmgtune.profile import with_effects, with_values

SHIP = mmgtune.load_profile("suzaku")
TRIALS = mmgtune.load_trials("suzaku")
TURN = mmgtune.TurningOrder(0.6)


class Mute:
    """What cannot be shown."""

    def __repr__(self):
        raise RuntimeError("no words")

    __str__ = __repr__


@pytest.mark.parametrize(
    "call",
    [
        lambda one: mmgtune.FitOptions(a_r=one),
        lambda one: mmgtune.FitOptions(one),
        lambda one: mmgtune.SimulateOptions(turn=(one,)),
        lambda one: mmgtune.fit(SHIP, one),
        lambda one: mmgtune.simulate(SHIP, [one]),
        lambda one: mmgtune.Hooks(stop=one),
        lambda one: mmgtune.trial_of(TRIALS["turn_p35"].columns, one),
        lambda one: mmgtune.simulate(SHIP, TRIALS["turn_p35"])[0].channel(one),
        lambda one: mmgtune.Model(SHIP).matrix([one]),
        lambda one: mmgtune.write_trial(TRIALS["turn_p35"], "never.parquet", overwrite=one),
        lambda one: with_values(SHIP, {one: 1.0}, "a test"),
        lambda one: with_values(SHIP, {"hull.R_0": one}, "a test"),
        lambda one: SHIP.value(one),
        lambda one: TRIALS[one],
        lambda one: TRIALS.plot.tracks(one),
    ],
)
def test_what_cannot_be_shown_is_refused_all_the_same(call):
    with pytest.raises(mmgtune.MmgtuneError):
        call(Mute())


@pytest.mark.parametrize("given", [np.array([True, False]), "no", 1])
def test_overwrite_is_true_or_false(tmp_path, given):
    with pytest.raises(mmgtune.MmgtuneError, match="give True or False"):
        mmgtune.simulate(SHIP, TRIALS["turn_p35"]).write(tmp_path, overwrite=given)
    with pytest.raises(mmgtune.MmgtuneError, match="give True or False"):
        mmgtune.write_trial(TRIALS["turn_p35"], tmp_path / "a.parquet", overwrite=given)
    assert mmgtune.write_trial(TRIALS["turn_p35"], tmp_path / "a.parquet", overwrite=np.True_).is_file()


@pytest.mark.parametrize("name", ["engine", "telegraph"])
@pytest.mark.parametrize(
    ("function", "said"),
    [
        (lambda: 1.0, "cannot be called"),
        (lambda a, b: 1.0, "cannot be called"),
        (lambda a: "full", "returns 'full'"),
        (lambda a: None, "returns None"),
        (lambda a: np.nan, "returns nan"),
        (lambda a: np.ones(2), "returns array"),
    ],
)
def test_a_function_of_another_form_is_told_what_one_is(name, function, said):
    with pytest.raises(mmgtune.MmgtuneError, match=said) as told:
        mmgtune.run_manoeuvres(SHIP, [mmgtune.Sailing(TURN, longest=20.0, **{name: function})])
    assert f"write {name}=lambda" in told.value.problems[0].fix


def test_an_engine_may_return_any_number():
    engines = (lambda _: np.array(1), lambda _: 1.0)
    runs = [mmgtune.run_manoeuvre(SHIP, TURN, longest=20.0, engine=engine) for engine in engines]
    assert np.array_equal(runs[0].states, runs[1].states)


@pytest.mark.parametrize("size", [1e30, 1e150, 1e300])
def test_sisters_whose_trials_say_what_no_trials_say(size):
    one = Information(("hull.R_0",), np.eye(1), np.ones(1), np.zeros(1), np.ones(1))
    members = {"a": one, "b": one, "c": one}
    assert pooled(SisterClass("k", members)).n_ships == 3
    with pytest.raises(mmgtune.MmgtuneError, match="cannot be put together"):
        pooled(SisterClass("k", {**members, "c": replace(one, b=np.full(1, size))}))


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda: mmgtune.TurningOrder(True), "not a number"),
        (lambda: mmgtune.TurningOrder(0.6, at=True), "in seconds"),
        (lambda: mmgtune.ZigzagOrder(0.3, heading=True), "not a number"),
        (lambda: mmgtune.indices_of(mmgtune.track_of(TRIALS["turn_p35"]), 10**400), "above 0"),
        (lambda: mmgtune.indices_of(mmgtune.track_of(TRIALS["turn_p35"]), True), "is no length"),
        (lambda: mmgtune.track_of("turn_p35"), "is no Trial"),
        (lambda: mmgtune.run_manoeuvre(SHIP, TURN, step=1e-9), "take longer steps"),
        (lambda: with_values("suzaku", {"hull.R_0": 0.02}, "a test"), "ShipProfile"),
        (lambda: with_effects("suzaku", {}, "a test"), "ShipProfile"),
        (lambda: with_effects(SHIP, ["current"], "a test"), "dict"),
        (lambda: mmgtune.simulate(SHIP, TRIALS["turn_p35"]).write(""), "the path is empty"),
    ],
)
def test_a_slip_is_told(call, said, tmp_path, monkeypatch):
    """A truth value where a number belongs, a name where a profile does, a step that no memory holds."""
    monkeypatch.chdir(tmp_path)
    with pytest.raises(mmgtune.MmgtuneError, match=said):
        call()
    assert not list(tmp_path.iterdir())
