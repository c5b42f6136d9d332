"""The library as a notebook user meets it."""

import inspect
import re
import signal
import sys
from dataclasses import replace
from fractions import Fraction
from functools import partial
from typing import get_type_hints

import numpy as np
import pandas
import pytest

import mmgtune
from mmgtune.manoeuvres import criteria_of
from mmgtune.networks import Ensemble, Hybrid, Mixture, Network
from mmgtune.orders import SpiralOrder
from mmgtune.planning.question import read_question
from mmgtune.predictor import as_predictor
from mmgtune.provenance import own_version
from mmgtune.resources import folder


def test_everything_listed_can_be_had_twice():
    for name in mmgtune.__all__:
        first, second = getattr(mmgtune, name), getattr(mmgtune, name)
        assert first is second
        assert callable(first)


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda of: mmgtune.fit("suzaku", of.to_frame()), "trial_of(TABLE, ID) makes a trial of a table"),
        (lambda _: mmgtune.simulate("suzaku", mmgtune.SimulateOptions(turn=35)), "options=SimulateOptions(...)"),
        (lambda of: mmgtune.validate(of, "suzaku"), "give the ship first, then the trials"),
        (lambda of: mmgtune.validate("suzaku", mmgtune.simulate("suzaku", of)), "give a TrialSet, a Trial"),
        (lambda of: mmgtune.validate("suzaku", mmgtune.load_profile("suzaku")), "give the ship first"),
        (lambda of: mmgtune.validate("suzaku", of)["suzakku"], "did you mean 'suzaku'?"),
    ],
)
def test_what_is_given_in_the_wrong_place_is_told_what_to_write(call, said):
    with pytest.raises(mmgtune.MmgtuneError) as caught:
        call(mmgtune.load_trials("suzaku")["turn_p35"])
    assert said in str(caught.value)


def test_a_name_that_there_is_not_is_told_what_is_meant():
    with pytest.raises(AttributeError, match="mmgtune has no 'load_trial'; did you mean 'load_trials'"):
        mmgtune.load_trial  # noqa: B018
    with pytest.raises(AttributeError, match=r"^mmgtune has no 'qqqqqq'$"):
        mmgtune.qqqqqq  # noqa: B018
    assert not hasattr(mmgtune, "_repr_html_")


def test_a_set_made_of_trials_alone_tunes_to_those_that_do_not_test():
    trials = [mmgtune.load_trials("suzaku")[id] for id in ("turn_p35", "turn_m35")]
    assert mmgtune.TrialSet(trials).tune == ("turn_p35", "turn_m35")
    some = mmgtune.TrialSet(trials, test=["turn_p35"])
    assert (some.tune, some.test) == (("turn_m35",), ("turn_p35",))
    assert mmgtune.TrialSet(trials, tune=["turn_p35"]).others == ("turn_m35",)


def test_a_predicted_run_is_had_by_its_id_and_a_check_names_its_trials():
    trial = mmgtune.load_trials("suzaku")["turn_p35"]
    found = mmgtune.predict("suzaku", trial)
    assert found["turn_p35"] is found.runs[0]
    with pytest.raises(mmgtune.MmgtuneError, match="did you mean 'turn_p35'"):
        found["turn_p36"]
    report = mmgtune.check("suzaku", trial, mmgtune.record_baseline("suzaku", trial))
    assert repr(report) == "CheckReport(suzaku on trials: pass)"


def test_a_fit_in_the_place_of_trials_is_told_of_lists():
    few = mmgtune.FitOptions(a_r=0.5, method="least-squares", starts=1, targets=("hull.R_0",))
    result = mmgtune.fit("suzaku", "suzaku", few)
    with pytest.raises(mmgtune.MmgtuneError, match="several ships stand in a list, and the trials behind it"):
        mmgtune.validate("suzaku", result)
    scored = mmgtune.validate(["suzaku", result], mmgtune.load_trials("suzaku")["turn_p35"])
    assert scored["suzaku (2)"] is scored.profiles[1]
    assert set(scored.notes) == {note for one in scored.profiles for note in one.notes} | set(scored.oddities)
    assert repr(mmgtune.predict(result, options=mmgtune.PredictOptions(turn=35))) == (
        "Predicted(suzaku, 1 particle: turn_p35)"
    )
    assert len(repr(mmgtune.track_of(mmgtune.load_trials("suzaku")["turn_p35"]))) < 200


def test_help_says_the_same_in_every_run():
    functions = [getattr(mmgtune, name) for name in mmgtune.__all__]
    signatures = {one.__name__: str(inspect.signature(one)) for one in functions if inspect.isfunction(one)}
    assert [name for name, signature in signatures.items() if " at 0x" in signature] == []
    assert "Hooks()" in signatures["fit"]
    assert repr(mmgtune.Hooks(on_phase=print)) == "Hooks(on_phase=print)"


def test_from_profile_to_verdict(tmp_path):
    profile = mmgtune.load_profile("suzaku")
    trials = mmgtune.load_trials("suzaku")
    result = mmgtune.fit(profile, trials, mmgtune.FitOptions(a_r=0.5, method="least-squares", starts=2))
    assert "4 of 4 of these trials improve" in result.sentence()
    motion = mmgtune.simulate(result.tuned_profile(), [trials.trials["turn_p35"]])[0]
    assert not motion.diverged
    assert mmgtune.Model(result).profile.text == result.tuned_profile().text
    (of_result,) = mmgtune.validate(result, trials["turn_p35"]).profiles
    assert (of_result.name, of_result.predictor.model.profile.text) == ("suzaku", result.tuned_profile().text)
    mmgtune.write_run(result, tmp_path / "run")
    assert mmgtune.load_profile(tmp_path / "run").text == result.tuned_profile().text
    report = mmgtune.render(tmp_path / "run")[0]
    assert report.name == "report.html"
    off = re.match(
        r"On 4 trials not used .* is ([\d.]+ m) off track and ([\d.]+°) off heading instead", result.sentence()
    )
    assert off is not None  # the sentence begins with what a seaman can picture, and with the numbers of the cards
    assert all(f"→ {size}" in report.read_text(encoding="utf-8") for size in off.groups())
    one, *others = result.compared
    lost = replace(one.records["after"], motion=replace(one.motions["after"], diverged=True))
    failed = replace(one, role="test", records={**one.records, "after": lost})
    worse = replace(result, compared=[failed, *others]).sentence()
    assert "; it diverges on 1 of " in worse  # and not that there were no test trials
    assert "no test trials" not in worse


def test_a_manoeuvre_of_a_bundled_ship_and_its_forces():
    motion = mmgtune.run_manoeuvre("suzaku", mmgtune.TurningOrder(0.6), longest=60.0)
    assert mmgtune.breakdown("suzaku", motion.states, motion.controls).total.X.shape == motion.t.shape


def test_rows_may_be_lists_and_a_set_is_asked_for_anything():
    states = [[0.0, 0.0, 0.0, 5.0, 0.0, 0.0]] * 9
    of_lists, of_arrays = (mmgtune.breakdown(SHIP, one, CONTROLS) for one in (states, np.array(states)))
    assert np.array_equal(of_lists.total.X, of_arrays.total.X)
    assert [1] not in TRIALS


def test_orders_alone_are_carried_out_and_one_is_a_list_of_one():
    order = mmgtune.TurningOrder(0.6)
    (alone,) = mmgtune.run_manoeuvres("suzaku", order)
    (listed,) = mmgtune.run_manoeuvres("suzaku", [order])
    (sailed,) = mmgtune.run_manoeuvres("suzaku", mmgtune.Sailing(order))
    assert np.array_equal(alone.states, listed.states)
    assert np.array_equal(alone.states, sailed.states)


def test_the_version_is_that_of_the_distribution():
    assert mmgtune.__version__ == own_version()
    assert "__version__" not in mmgtune.__all__


QUICK = mmgtune.FitOptions(method="least-squares", starts=1)


def test_a_trial_and_a_list_of_trials_are_sets_that_tune():
    whole = mmgtune.load_trials("suzaku")
    one = whole["turn_p35"]
    alone, listed = mmgtune.fit("suzaku", one, QUICK), mmgtune.fit("suzaku", [one], QUICK)
    assert alone.J == listed.J
    assert [compared.trial.id for compared in alone.compared] == ["turn_p35"]
    assert [motion.id for motion in mmgtune.simulate("suzaku", one)] == ["turn_p35"]
    assert mmgtune.validate("suzaku", [one, whole["zigzag_20"]]).pieces[1].id == "zigzag_20"


SHIP, TRIALS = mmgtune.load_profile("suzaku"), mmgtune.load_trials("suzaku")
A_TRACK = mmgtune.Track(**dict.fromkeys(("t", "x", "y", "psi", "u", "v_m", "delta"), np.arange(20.0) / 10.0))
SIGMA = dict.fromkeys(("x", "y", "psi", "u", "v_m", "r"), 1.0)
CONTROLS = np.tile([1.7, 0.1], (9, 1))


@pytest.mark.parametrize(
    ("call", "what", "fix"),
    [
        (lambda: mmgtune.fit(SHIP, {"a": 1}), "a dict is no set of trials", "load_trials(NAME)"),
        (lambda: mmgtune.fit(SHIP, SHIP), "a ShipProfile is no set of trials", "ship first"),
        (lambda: mmgtune.fit(SHIP, pandas.DataFrame({"t": [0.0]})), "a DataFrame is no set", "load_trials(NAME)"),
        (lambda: mmgtune.fit(pandas.DataFrame(), TRIALS), "a DataFrame is no ship profile", "load_profile(NAME)"),
        (lambda: mmgtune.fit(TRIALS, SHIP), "a TrialSet is no ship profile", "ship first"),
        (lambda: mmgtune.fit(SHIP, []), "the list of trials is empty", "one at least"),
        (lambda: mmgtune.fit(SHIP, [TRIALS["turn_p35"]] * 2), "two trials are called 'turn_p35'", "own id"),
        (lambda: mmgtune.fit(SHIP, TRIALS, {"a_r": 0.5}), "a dict is no FitOptions", "mmgtune.FitOptions(a_r=0.5)"),
        (lambda: mmgtune.simulate(SHIP, ["no/such.parquet"]), "no such trials", "give a folder or a Parquet file"),
        (
            lambda: mmgtune.simulate(SHIP, [folder("trials") / "suzaku"]),
            "a PosixPath in the list",
            "a set is given by itself",
        ),
        (lambda: mmgtune.simulate(SHIP, ["turn_p35"]), "a str in the list of trials", "[TRIALS['turn_p35']]"),
        (lambda: mmgtune.simulate(SHIP, TRIALS, QUICK), "a FitOptions is no SimulateOptions", "SimulateOptions(...)"),
        (lambda: mmgtune.run_manoeuvre(SHIP, 35), "an int is no helmsman", "TurningOrder(radians(35))"),
        (lambda: mmgtune.run_manoeuvres(SHIP, [35]), "an int is no helmsman", "TurningOrder(radians(35))"),
        (lambda: mmgtune.TurningOrder("35 deg"), "'35 deg', not a number", "math.radians(35.0) for 35 deg"),
        (lambda: SHIP.value("rudder.epsi"), "no number 'rudder.epsi'", "did you mean 'rudder.eps"),
        (lambda: SHIP.value("L_pp"), "no number 'L_pp'", "write 'particulars.L_pp'"),
        (lambda: SHIP.value("rudders.epsilon"), "no number 'rudders.epsilon'", "did you mean 'rudder.eps"),
        (lambda: TRIALS[0], "no trial 0", "or list(TRIALS)[0]"),
        (lambda: TRIALS["turn_p3"], "no trial 'turn_p3'", "did you mean 'turn_p35'"),
        (lambda: TRIALS.plot(), "no picture is named", ".plot.tracks() or .plot.histories()"),
        (lambda: mmgtune.estimate(5), "no name of a file of particulars (5)", "a text or a Path"),
        (lambda: mmgtune.write_trial("turn.parquet", TRIALS["turn_p35"]), "no path (Trial(turn_p35", "where the file"),
        (lambda: mmgtune.load_trials(5), "no name of a data set (5)", "a text or a Path"),
        (lambda: mmgtune.load_trials(""), "no name of a data set ('')", "give a path or a bundled name"),
        (lambda: mmgtune.write_trial(pandas.DataFrame(), "a.parquet"), "a DataFrame is no trial", "give a Trial"),
        (
            lambda: mmgtune.indices_of(TRIALS["turn_p35"], 83.0),
            "a Trial is no track",
            "simulate(SHIP, TRIAL)[0].track()",
        ),
        (lambda: mmgtune.indices_of(A_TRACK, SHIP), "a ShipProfile is no length (L_pp)", "profile.L_pp"),
        (lambda: mmgtune.evaluate(SHIP, TRIALS, theta=[1, 2]), "theta is a list (theta)", "n_members); Model(SHIP)"),
        (lambda: mmgtune.evaluate(SHIP, TRIALS, theta=np.ones(2)), "theta has shape (2,)", "n_members); Model(SHIP)"),
        (lambda: mmgtune.simulate(SHIP, []), "the list of trials is empty", "one at least"),
        (lambda: mmgtune.FitOptions(ar=0.5), "FitOptions has no option ar (ar)", "did you mean 'a_r'?"),
        (lambda: mmgtune.FitOptions(fix=("R_0",)), "FitOptions has no option fix (fix)", "did you mean 'fixed'?"),
        (lambda: mmgtune.FitOptions(0.5), "0.5 is given no name (FitOptions)", "write FitOptions(NAME=0.5)"),
        (
            lambda: mmgtune.run_manoeuvre(SHIP, mmgtune.TurningOrder(0.5), n=106),
            "the revolutions are 6360 rpm (n)",
            "write n=1.767 for 106 rpm",
        ),
        (lambda: mmgtune.indices_of(A_TRACK, 0.0), "the length is 0 m (L_pp)", "in m, above 0"),
        (lambda: mmgtune.indices_of(A_TRACK, -83.0), "the length is -83 m (L_pp)", "in m, above 0"),
        (lambda: mmgtune.indices_of(A_TRACK, np.nan), "the length is nan m (L_pp)", "in m, above 0"),
        (lambda: criteria_of(A_TRACK, -83.0, 7.0), "the length is -83 m (L_pp)", "in m, above 0"),
        (lambda: criteria_of(A_TRACK, 83.0, -7.0), "the speed is -7 m/s (V)", "the test speed in m/s, above 0"),
        (lambda: criteria_of(A_TRACK, 83.0, "7"), "a str is no speed (V)", "profile.approach.speed"),
        (lambda: criteria_of(None, 83.0, 7.0), "is no track", "give a Track"),
        (lambda: mmgtune.score(SHIP, []), "the list of trials is empty", "one at least"),
        (lambda: mmgtune.score(SHIP, [], {"x": 1.0}), "the list of trials is empty", "one at least"),
        (
            lambda: mmgtune.score(SHIP, TRIALS, {"x": 1.0}),
            "sigma says nothing of y, psi, u, v_m, r",
            "for each of x, y",
        ),
        (lambda: mmgtune.score(SHIP, TRIALS, {"v": 1.0}), "sigma is of no state 'v'", "for each of x, y"),
        (lambda: mmgtune.score(SHIP, TRIALS, 1.0), "sigma is a float", "by name"),
        (lambda: mmgtune.score(SHIP, TRIALS, {**SIGMA, "r": 0.0}), "sigma of r is 0.0", "a number above 0"),
        (lambda: mmgtune.score(SHIP, TRIALS, {**SIGMA, "r": 10**400}), "sigma of r is a number of", "above 0"),
        (lambda: mmgtune.score(SHIP, TRIALS, {**SIGMA, "r": "1"}), "sigma of r is '1'", "a number above 0"),
        (lambda: mmgtune.breakdown(SHIP, np.zeros(6), CONTROLS), "states has shape (6,)", "(n_samples, 6)"),
        (lambda: mmgtune.breakdown(SHIP, np.zeros((9, 5)), CONTROLS), "states has shape (9, 5)", "(n_samples, 6)"),
        (lambda: mmgtune.breakdown(SHIP, "states", CONTROLS), "states is a str, no array", "(n_samples, 6)"),
        (lambda: mmgtune.breakdown(SHIP, np.zeros((4, 6)), CONTROLS), "controls has shape (9, 2)", "shape (4, 2)"),
        (
            lambda: mmgtune.breakdown(SHIP, np.zeros((9, 6)), CONTROLS[:, :1]),
            "controls has shape (9, 1)",
            "shape (9, 2)",
        ),
        (
            lambda: mmgtune.breakdown(SHIP, np.zeros((9, 6)), CONTROLS, CONTROLS),
            "around has shape (9, 2)",
            "shape (9, 14)",
        ),
        (
            lambda: mmgtune.breakdown(SHIP, np.zeros((9, 6)), CONTROLS, theta=mmgtune.Model(SHIP).matrix()),
            "theta has shape",
            "give an array of shape (",
        ),
        (lambda: mmgtune.check(SHIP, TRIALS, {"a": 1}), "a dict is no baseline ({'a': 1})", "read_baseline(FILE)"),
        (lambda: TRIALS[[1]], "no trial [1]", "write ['turn_"),
        (lambda: TRIALS[:2], "no trial slice(None, 2, None)", "write ['turn_"),
        (lambda: mmgtune.TurningOrder(0.0), "the rudder angle is 0", "math.radians(35.0)"),
        (lambda: mmgtune.ZigzagOrder(0, 0), "the rudder angle is 0", "math.radians(35.0)"),
        (lambda: mmgtune.ZigzagOrder(0.2, 0.0), "the check heading is 0", "math.radians(35.0)"),
        (lambda: SpiralOrder(0.0, 60.0), "the rudder angle is 0", "Straight()"),
        (lambda: TRIALS.plot.tracks(3), "3 is no id", "write one of these"),
        (lambda: TRIALS.plot.histories(["turn_p35", "turn_m10"]), "2 trials are named", ".plot.histories('turn_p35')"),
        (lambda: TRIALS.plot.histories("turn_p35", 5), "channels is 5", "give a list"),
        (lambda: mmgtune.simulate(SHIP, TRIALS["turn_p35"])["turn_p3"], "no run 'turn_p3'", "'turn_p35'"),
        (lambda: mmgtune.simulate(SHIP, TRIALS["turn_p35"])[99], "no run 99", "a number below"),
        (lambda: mmgtune.simulate(SHIP, TRIALS["turn_p35"])[None], "no run None", "write [0]"),
        (lambda: mmgtune.Hooks(stop=True), "stop is True (stop)", "Hooks(stop=lambda: False)"),
        (lambda: mmgtune.load_profile(None), "no name of a ship profile (None)", "a text or a Path"),
    ],
)
def test_what_is_of_the_wrong_type_is_refused_in_words(call, what, fix):
    with pytest.raises(mmgtune.MmgtuneError) as caught:
        call()
    (problem,) = caught.value.problems
    assert what in str(problem)
    assert fix in problem.fix
    assert problem.why


@pytest.mark.parametrize(
    ("found", "in_place_of"),
    [
        (mmgtune.FitResult, mmgtune.ShipProfile),
        (mmgtune.Diagnosis, mmgtune.ShipProfile),
        (mmgtune.Posterior, mmgtune.Particles),
        (mmgtune.Learned, Network),
        (mmgtune.LearnedHybrid, Hybrid),
        (mmgtune.LearnedEnsemble, Ensemble),
        (mmgtune.LearnedMixture, Mixture | Hybrid | Network),
    ],
)
def test_a_result_stands_for_the_ship_it_found(found, in_place_of):
    assert get_type_hints(found.as_ship, vars(sys.modules[found.__module__]))["return"] == in_place_of


class AResult:
    """As results are that a ship came out of."""

    written_by = "write_run"

    def __init__(self, ship):
        self.ship = ship

    def as_ship(self):
        return self.ship


def test_a_run_is_had_by_its_id_as_by_its_number():
    runs = mmgtune.simulate(SHIP, [TRIALS["turn_p35"], TRIALS["zigzag_20"]])
    assert runs["zigzag_20"] is runs[1] is runs[-1]
    assert [run.id for run in runs] == ["turn_p35", "zigzag_20"]
    with pytest.raises(ValueError):
        runs.index("turn_p35")


def test_equal_profiles_have_the_same_hash():
    other = replace(SHIP, template="")
    assert other == SHIP
    assert {SHIP: 1}[other] == 1
    assert hash(mmgtune.load_profile("suzaku_fam")) != hash(SHIP)


def test_files_stand_for_trials_in_a_list():
    one, two = TRIALS["turn_p35"], TRIALS["zigzag_20"]
    for given in ([one.path, two], [str(one.path), str(two.path)]):
        assert [run.id for run in mmgtune.simulate(SHIP, given)] == [one.id, two.id]


def test_a_result_goes_wherever_a_ship_does():
    turn = TRIALS["turn_p35"]
    tuned = AResult(SHIP)
    assert mmgtune.validate([tuned, SHIP], turn).profiles[1].name == "suzaku (2)"
    assert mmgtune.simulate(tuned, turn)[0].id == "turn_p35"
    assert mmgtune.score(tuned, turn)[0].J == mmgtune.score(SHIP, turn)[0].J
    assert mmgtune.compare_profiles(tuned, "suzaku_fam").profiles[0] == "suzaku"
    assert mmgtune.fit(tuned, turn, QUICK).profile is SHIP
    assert as_predictor(tuned).name == "suzaku"
    name = "hull.Y_v"
    particles = mmgtune.Particles(SHIP, (name,), np.array([[1.0, 1.1]]) * SHIP.value(name), {})
    for several in (AResult(particles), particles):
        assert mmgtune.simulate(several, turn).predictor.drawn(2, 1).n_members == 2
    with pytest.raises(mmgtune.MmgtuneError, match="AResult is no ship profile"):
        mmgtune.fit(AResult(particles), turn, QUICK)


def test_a_result_is_no_folder_before_it_is_written():
    for name in mmgtune.__all__:
        assert getattr(getattr(mmgtune, name), "written_by", "write_run") in mmgtune.__all__
    with pytest.raises(mmgtune.MmgtuneError, match="no name of a run folder") as caught:
        mmgtune.render(AResult(SHIP))
    assert "mmgtune.write_run(RESULT, FOLDER)" in caught.value.problems[0].fix


@pytest.mark.parametrize("wrong", [{"speed": 7.5}])
def test_the_fix_of_a_number_in_place_of_a_text_is_taken(wrong):
    with pytest.raises(mmgtune.MmgtuneError) as caught:
        mmgtune.PredictOptions(**wrong)
    (name,) = wrong
    text = re.search(r"'(.*)'", caught.value.problems[0].fix)[1]
    options = {"turn": ("10",), name: (text,) if name == "turn" else text}
    assert mmgtune.predict("suzaku", options=mmgtune.PredictOptions(**options)).runs


READERS = [
    mmgtune.load_map,
    mmgtune.load_network,
    mmgtune.load_particles,
    mmgtune.load_profile,
    mmgtune.load_trials,
    mmgtune.plan_fleet,
    mmgtune.read_baseline,
    mmgtune.read_particulars,
    mmgtune.read_results,
    mmgtune.read_trial,
    mmgtune.render,
    lambda name: mmgtune.propose_map([name]),
    lambda name: mmgtune.import_logs([name], mmgtune.load_map("nmea-0183", preset=True), ".", dry_run=True),
    lambda name: mmgtune.predict(SHIP, name),
    lambda name: mmgtune.validate([name] if isinstance(name, str) else name, TRIALS),
]


NO_PATHS = {"none": None, "number": 3.5, "too long": 300 * "a"}


@pytest.mark.parametrize(
    ("read", "name"),
    [
        pytest.param(read, name, id=f"{k}-{words}")
        for k, read in enumerate(READERS)
        for words, name in NO_PATHS.items()
        if not (read is READERS[-2] and name is None)  # no orders are orders of the options
    ],
)
def test_what_can_be_no_path_is_refused_in_words(read, name):
    with pytest.raises(mmgtune.MmgtuneError):
        read(name)


WRITERS = sorted(name for name in mmgtune.__all__ if re.match("write_|save_", name))


@pytest.mark.parametrize("name", WRITERS)
def test_nothing_is_written_where_there_is_no_path(name):
    with pytest.raises(mmgtune.MmgtuneError, match=r"no path \(3\.5\)"):
        getattr(mmgtune, name)(None, 3.5)


@pytest.mark.parametrize("name", WRITERS)
def test_nothing_is_replaced_unless_that_is_asked_for(name):
    assert inspect.signature(getattr(mmgtune, name)).parameters["overwrite"].default is False


def test_a_result_is_not_replaced_in_silence(tmp_path):
    result = mmgtune.compare_profiles("suzaku", "suzaku_fam")
    baseline = mmgtune.record_baseline("suzaku", TRIALS["turn_p35"])
    predicted = mmgtune.predict("suzaku", options=mmgtune.PredictOptions(turn=("35",)))
    for write in (
        lambda **how: mmgtune.write_comparison(result, tmp_path / "compare", **how),
        lambda **how: mmgtune.write_baseline(baseline, tmp_path / "check.json", **how),
        lambda **how: mmgtune.write_prediction(predicted, tmp_path / "predict", **how),
    ):
        write()
        with pytest.raises(mmgtune.MmgtuneError, match="exists already") as caught:
            write()
        assert "overwrite=True" in caught.value.problems[0].fix
        write(overwrite=True)


def test_ctrl_c_ends_a_fit_with_the_best_so_far():
    """As the stop button of a notebook does; a second time it is Python's own interrupt, as before and after."""
    own = signal.getsignal(signal.SIGINT)
    with mmgtune.until_interrupted() as hooks:
        signal.raise_signal(signal.SIGINT)
        result = mmgtune.fit(SHIP, TRIALS, QUICK, hooks=hooks)
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
    assert result.interrupted
    assert np.isfinite(result.J)
    assert signal.getsignal(signal.SIGINT) is own


def test_channels_of_a_motion_have_the_names_of_columns():
    motion = mmgtune.simulate("suzaku", TRIALS["turn_p35"])[0]
    assert np.array_equal(motion.channel("v"), motion.channel("v_m"))
    for name, fix in (("heading", "'psi'"), ("t", "motion.t"), ("delta", "motion.controls[:, 1]"), ("speed", "these")):
        with pytest.raises(mmgtune.MmgtuneError, match=f"no channel '{name}'") as caught:
            motion.channel(name)
        (problem,) = caught.value.problems
        assert "x, y, psi, u, v, r" in problem.why
        assert fix in problem.fix
    with pytest.raises(mmgtune.MmgtuneError, match="x, y, psi, u, v, r"):
        mmgtune.fit("suzaku", TRIALS, mmgtune.FitOptions(channels=("x", "y", "heading")))


def test_folders_are_texts_or_paths(tmp_path):
    kept = str(tmp_path / "checkpoint")
    (tmp_path / "checkpoint").mkdir()
    result = mmgtune.fit("suzaku", TRIALS["turn_p35"], QUICK, folder=kept)
    mmgtune.write_run(result, str(tmp_path / "run"))
    assert mmgtune.render(str(tmp_path / "run"))[0] == tmp_path / "run" / "report.html"
    assert mmgtune.simulate("suzaku", TRIALS["turn_p35"]).write(str(tmp_path / "simulated"))


def test_whatever_takes_a_path_takes_a_text():
    """Of the signatures, so that no function is forgotten."""
    for name in mmgtune.__all__:
        thing = getattr(mmgtune, name)
        written = getattr(thing, "write", None)
        for function in (written,) if inspect.isclass(thing) else (thing,):
            for parameter in inspect.signature(function).parameters.values() if function else ():
                kinds = re.findall(r"[\w.]+", str(parameter.annotation))
                assert "Path" not in kinds or "str" in kinds, f"{name}: {parameter}"


A_MAP = mmgtune.load_map("nmea-0183", preset=True)
A_BASELINE = mmgtune.record_baseline(SHIP, TRIALS["turn_p35"], ("J",))
BACK = replace(TRIALS["turn_p35"], t=TRIALS["turn_p35"].t[::-1])
TURN = mmgtune.TurningOrder(0.6)
HUGE = 10**400
JUDGING = (mmgtune.score, mmgtune.evaluate, mmgtune.record_baseline)
NUMBERS = ("speed", "n", "heading", "longest", "sample", "step")


@pytest.mark.parametrize(
    ("call", "words"),
    [
        *((partial(of, SHIP, TRIALS, backend=None), "unknown back end None") for of in JUDGING),
        *((partial(of, SHIP, TRIALS, backend=[]), "unknown back end []") for of in JUDGING),
        *((partial(of, SHIP, TRIALS, backend=b"numpy"), "unknown back end b'numpy'") for of in JUDGING),
        (lambda: mmgtune.check(SHIP, TRIALS, A_BASELINE, backend=None), "unknown back end None"),
        (lambda: mmgtune.check(SHIP, TRIALS, A_BASELINE, names="suzaku"), "names is 'suzaku'"),
        (lambda: mmgtune.check(SHIP, TRIALS, A_BASELINE, metrics=None), "metrics is None"),
        (lambda: mmgtune.check(SHIP, TRIALS, A_BASELINE, metrics="J"), "metrics is 'J'"),
        (lambda: mmgtune.check(SHIP, TRIALS, A_BASELINE, metrics=["J", b"J"]), "a bytes in metrics is no text"),
        (lambda: mmgtune.check(SHIP, TRIALS, A_BASELINE, integrator="x"), "a str is no Integrator (integrator)"),
        (lambda: mmgtune.record_baseline(SHIP, TRIALS, before=1), "an int is no Baseline (before)"),
        (lambda: mmgtune.simulate(SHIP, TRIALS, integrator=np.ones(2)), "no Integrator (integrator)"),
        (lambda: mmgtune.make_trials(None, "out"), "a NoneType is no text (ship)"),
        (lambda: mmgtune.make_trials([], "out"), "a list is no text (ship)"),
        (lambda: read_question(None, as_predictor(SHIP), SHIP.approach), "a NoneType is no text (question)"),
        (lambda: mmgtune.propose_map([]), "the list of logs is empty"),
        (lambda: mmgtune.propose_map(TRIALS["turn_p35"].to_frame()), "make a trial of it: mmgtune.trial_of("),
        (lambda: mmgtune.propose_map(None), "a NoneType is no list of logs"),
        (lambda: mmgtune.import_logs(None, A_MAP, "out"), "no list of logs"),
        (lambda: mmgtune.import_logs("log", A_MAP, "out", step=HUGE), "the step is"),
        (lambda: mmgtune.run_manoeuvre(SHIP, TURN, engine=1), "an int is no function (engine)"),
        (lambda: mmgtune.run_manoeuvre(SHIP, TURN, id=1), "an int is no text (id)"),
        (lambda: mmgtune.run_manoeuvre(SHIP, TURN, theta=1), "theta has shape ()"),
        (lambda: mmgtune.run_manoeuvres(SHIP, np.array(1.0)), "no helmsman"),
        *((partial(mmgtune.Sailing, TURN, **{name: HUGE}), "a number of 40") for name in NUMBERS),
        (lambda: mmgtune.TurningOrder(HUGE), "a number of 40"),
        (lambda: mmgtune.TurningOrder(0.6, at=HUGE), "a number of 40"),
        (lambda: mmgtune.ZigzagOrder(0.2, HUGE), "a number of 40"),
        (lambda: mmgtune.evaluate(SHIP, np.array(1.0)), "no set of trials"),
        (lambda: mmgtune.evaluate(SHIP, []), "the list of trials is empty"),
        (lambda: mmgtune.repeat(SHIP, []), "the list of trials is empty"),
        (lambda: mmgtune.evaluate(SHIP, TRIALS, 1), "an int is no Objective (objective)"),
        (lambda: mmgtune.evaluate(SHIP, TRIALS, offsets="x"), "offsets is a str"),
        (lambda: mmgtune.score(SHIP, TRIALS, theta=mmgtune.Model(SHIP).matrix()[:, :0]), "theta has shape"),
        (lambda: mmgtune.fit(SHIP, TRIALS, QUICK, hooks=None), "a NoneType is no Hooks (hooks)"),
        (lambda: mmgtune.sweep(SHIP, TRIALS, hooks=None), "a NoneType is no Hooks (hooks)"),
        (lambda: mmgtune.fit(SHIP, TRIALS, QUICK, more_starts=None), "more_starts is None"),
        (lambda: mmgtune.Model(SHIP, ties=None), "ties is None"),
        (lambda: mmgtune.Model(SHIP, ties=["x"]), "a str in ties is no Tie"),
        (lambda: mmgtune.read_trial("a\0b"), "its name has a zero byte"),
        (lambda: mmgtune.read_results("a\0b"), "no results of a fleet"),
        (lambda: mmgtune.sweep(SHIP, TRIALS, folder="\udcff"), "not UTF-8 text"),
        *((partial(of, SHIP, BACK), "time does not strictly increase (turn_p35)") for of in (*JUDGING, mmgtune.fit)),
        (lambda: mmgtune.validate(SHIP, replace(TRIALS, trials=[BACK], tune=("turn_p35",), test=())), "time does not"),
    ],
)  # fmt: skip
def test_arguments_of_another_kind_are_refused_in_words(call, words):
    with pytest.raises(mmgtune.MmgtuneError) as caught:
        call()
    assert words in str(caught.value)
    assert all(problem.fix for problem in caught.value.problems)


def test_a_fraction_is_a_number():
    (half,) = mmgtune.run_manoeuvres(SHIP, mmgtune.Sailing(TURN, speed=Fraction(1, 2), longest=20))
    (same,) = mmgtune.run_manoeuvres(SHIP, mmgtune.Sailing(TURN, speed=0.5, longest=20.0))
    assert np.array_equal(half.states, same.states)


@pytest.mark.parametrize("wrong", [None, [1], AResult(SHIP), SHIP])
@pytest.mark.parametrize("name", WRITERS)
def test_what_is_no_result_is_not_written(name, wrong, tmp_path):
    with pytest.raises(mmgtune.MmgtuneError, match=" is no ") as caught:
        getattr(mmgtune, name)(wrong, tmp_path / "out")
    assert not list(tmp_path.iterdir())
    if isinstance(wrong, AResult) and name != "write_trial":
        assert caught.value.problems[0].fix == "mmgtune.write_run(RESULT, FOLDER) writes it"
