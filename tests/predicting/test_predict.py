"""Predictions by particles: runs of single models, bands that know how many particles there are, files."""

from __future__ import annotations

import json

import numpy as np
import pyarrow.parquet as pq
import pytest

from mmgtune.bands import quantiles
from mmgtune.errors import OptionError
from mmgtune.manoeuvres import turning_indices, zigzag_indices
from mmgtune.model import Model
from mmgtune.networks import NetworkPredictor
from mmgtune.options import PredictOptions, SimulateOptions
from mmgtune.orders import TurningOrder, ZigzagOrder, run_manoeuvre
from mmgtune.particles import Particles
from mmgtune.predicting import predict, write_prediction
from mmgtune.predictor import PhysicsPredictor, Prediction, as_predictor
from mmgtune.profile import load_profile
from mmgtune.report import render
from mmgtune.simulating import simulate
from mmgtune.trial import TrialSet, load_trials
from mmgtune.units import DEG
from tests.networks.made import network

TURN, ZIGZAG = PredictOptions(turn=("35",)), PredictOptions(zigzag=("20/20",))


def scattered(model, n, size=0.05, seed=1, parts="hull."):
    """A model with hull coefficients drawn about those of the profile, the first its own."""
    theta = np.repeat(model.matrix(), n, axis=1)
    rng = np.random.default_rng(seed)
    for k, name in enumerate(model.rows):
        if name.startswith(parts):
            theta[k, 1:] *= 1.0 + size * rng.standard_normal(n - 1)
    return PhysicsPredictor(model, theta)


class Wrapped:
    """A predictor of which nothing is known but that it predicts, and whose model it moves by."""

    def __init__(self, inside):
        self.inside, self.model = inside, inside.model
        self.name, self.L_pp, self.inputs, self.method = "wrapped", inside.L_pp, inside.inputs, inside.method
        self.n_members = inside.n_members

    def predict(self, cases):
        return self.inside.predict(cases)


class Pairs(Wrapped):
    """The same, which runs a member on each case."""

    asked = 0

    def paired(self, cases, members):
        self.asked += len(members)
        found = self.inside.predict(cases)
        rows = np.arange(len(cases))
        return np.where(found.diverged[rows, members, None, None], np.nan, found.states[rows, members])


class Knowing(Wrapped):
    """One that draws as many particles as are asked for."""

    def drawn(self, n, seed, sampling="TS-infinity"):
        self.wanted = n, seed, sampling
        return scattered(self.model, n, seed=seed)


@pytest.fixture(scope="module")
def kvlcc2():
    return Model(load_profile("kvlcc2_l7"))


@pytest.fixture(scope="module")
def five(kvlcc2):
    return scattered(kvlcc2, 5)


@pytest.fixture(scope="module")
def turned(five):
    return predict(five, options=TURN)


def test_a_single_run_has_the_indices_of_a_helmsman_at_fine_steps(kvlcc2):
    found = predict(kvlcc2, options=PredictOptions(turn=("-35",), zigzag=("10/10",)))
    turn, zigzag = found.runs
    L = kvlcc2.L_pp
    motion = run_manoeuvre(kvlcc2, TurningOrder(-35.0 * DEG), sample=0.25, longest=400.0)
    expected = turning_indices(motion.track(), L).to_dict()
    for key, rel in (
        ("advance_m", 0.01),
        ("tactical_diameter_m", 0.01),
        ("steady_diameter_m", 0.01),
        ("time_90_s", 0.01),
    ):
        assert turn.indices[key][0] == pytest.approx(expected[key], rel=rel)
    motion = run_manoeuvre(kvlcc2, ZigzagOrder(10.0 * DEG, 10.0 * DEG), sample=0.25, longest=400.0)
    expected = zigzag_indices(motion.track(), L, (10.0 * DEG, 10.0 * DEG)).to_dict()
    for key in ("overshoot_1_deg", "overshoot_2_deg", "overshoot_3_deg", "overshoot_4_deg"):
        assert zigzag.indices[key][0] == pytest.approx(expected[key], abs=0.25)
    assert not found.has_band
    assert "no band" in found.notes[0]
    assert turn.index("advance_m", 0.9).half is None


@pytest.mark.parametrize("ship", ["suzaku", "kvlcc2_l7"])
def test_simulate_gives_the_same_turn_and_nearly_the_same_zigzag(ship):
    """Of a ship that is not yet at her steady speed when the order comes, so that the approach has to be as long."""
    found = predict(ship, options=PredictOptions(turn=("35",), zigzag=("20/20",))).to_dict("")["runs"]
    simulated = simulate(ship, options=SimulateOptions(turn=("35",), zigzag=("20/20",)))
    turn, zigzag = (row["indices"] for row in simulated.rows())
    for own, indices, keys, tolerance in (
        (found[0], turn, ("advance_m", "tactical_diameter_m", "time_90_s", "time_360_s"), 5e-4),
        # Her helmsman reverses the rudder when he next looks, not at the moment that she passes the heading.
        (found[1], zigzag, ("overshoot_1_deg", "overshoot_2_deg", "period_s"), 0.02),
    ):
        means = {row["index"]: row["mean"] for row in own["indices"]}
        assert [indices[key] for key in keys] == pytest.approx([means[key] for key in keys], rel=tolerance)


def test_without_orders_the_usual_manoeuvres(kvlcc2):
    found = predict(kvlcc2)
    assert [one.id for one in found.runs] == ["turn_p35", "turn_m35", "zigzag_p10_10", "zigzag_p20_20"]
    assert repr(found) == "Predicted(kvlcc2_l7, 1 particle: turn_p35, turn_m35, zigzag_p10_10, zigzag_p20_20)"


def test_a_particle_goes_as_if_alone(kvlcc2, five, turned):
    alone = predict(PhysicsPredictor(kvlcc2, five.theta[:, 3:4]), options=TURN)
    n = min(len(alone.runs[0].t), len(turned.runs[0].t))
    np.testing.assert_array_equal(turned.runs[0].states[3, :n], alone.runs[0].states[0, :n])
    for key, values in alone.runs[0].indices.items():
        assert turned.runs[0].indices[key][3] == pytest.approx(values[0], rel=1e-9)


def test_all_turn_until_the_last_is_done(turned):
    run = turned.runs[0]
    heading = np.abs(run.states[:, -1, 2]) / DEG
    assert heading.min() == pytest.approx(545.0, abs=2.0)
    assert (np.diff(np.abs(run.states[:, 20:, 2]), axis=1) > 0.0).all()  # none stands still meanwhile


def test_bands_are_quantiles_of_the_particles(turned):
    run = turned.runs[0]
    band = run.band("u", 0.5)
    np.testing.assert_array_equal(band["low"], quantiles(run.states[:, :, 3], (0.25,))[0])
    np.testing.assert_allclose(band["mean"], run.states[:, :, 3].mean(axis=0))
    index = run.index("advance_m", 0.5)
    assert (index.low, index.high) == pytest.approx(tuple(quantiles(run.indices["advance_m"], (0.25, 0.75))))
    (note,) = turned.notes
    assert "widest band" in note
    assert "67 %" in note


@pytest.mark.parametrize("wrapper", [Wrapped, Pairs])
@pytest.mark.parametrize("options", [TURN, ZIGZAG])
def test_any_predictor_is_steered_as_a_model_on_lanes_is(five, wrapper, options):
    one = wrapper(scattered(five.model, 3))
    found, expected = predict(one, options=options), predict(one.inside, options=options)
    for key, values in expected.runs[0].indices.items():
        np.testing.assert_allclose(found.runs[0].indices[key], values, rtol=1e-9)
    np.testing.assert_allclose(found.runs[0].states, expected.runs[0].states, rtol=1e-8, atol=1e-10)
    if wrapper is Pairs:
        assert one.asked > 0


def test_no_particle_is_drawn_twice_of_few(tmp_path):
    profile = load_profile("suzaku")
    values = profile.value("hull.R_0") * (1.0 + 0.01 * np.arange(12.0))
    few = Particles(profile, ("hull.R_0",), values[None], {})
    found = predict(few.predictor(), options=TURN)
    assert found.predictor.n_members == 12
    assert len({run[-1].tobytes() for run in found.runs[0].states}) == 12
    assert any("holds 12 particles, fewer than the 100 asked for: all are taken" in note for note in found.notes)
    fewer = predict(few.predictor(), options=PredictOptions(turn=("35",), particles=5))
    assert fewer.predictor.n_members == 5
    assert not any("asked for" in note for note in fewer.notes)


def test_particles_are_drawn_of_what_can_draw_them(five):
    one = Knowing(five)
    found = predict(one, options=PredictOptions(turn=("35",), particles=30, seed=7, sampling="TS1"))
    assert one.wanted == (30, 7, "TS1")
    assert found.predictor.n_members == 30
    assert found.drawn
    assert found.notes == ()
    document = found.to_dict()
    assert json.loads(json.dumps(document, allow_nan=False)) == document
    (advance,) = [row for row in document["runs"][0]["indices"] if row["index"] == "advance_m"]
    assert advance["over_L"]["mean"] == pytest.approx(advance["mean"] / five.L_pp)
    assert advance["low"] < advance["mean"] < advance["high"]
    assert advance["half_width"] == pytest.approx(0.5 * (advance["high"] - advance["low"]))
    with pytest.raises(OptionError, match="cannot be sampled by TS1"):
        predict(five, options=PredictOptions(sampling="TS1"))


@pytest.mark.filterwarnings("error")
def test_what_diverges_or_never_turns_is_counted(kvlcc2):
    theta = np.repeat(kvlcc2.matrix(), 30, axis=1)
    rows = list(kvlcc2.rows)
    theta[rows.index("hull.R_0"), 0] = -5.0  # faster and faster
    for name in ("hull.N_r", "hull.N_v"):  # a ship that nothing turns
        theta[rows.index(name), 1:4] = {"hull.N_r": -1.0, "hull.N_v": 0.05}[name]
    found = predict(PhysicsPredictor(kvlcc2, theta), options=TURN)
    (run,) = found.runs
    assert run.diverged.tolist() == [True] + [False] * 29
    advance = run.index("advance_m", 0.9)
    assert (advance.reached, advance.particles) == (26, 30)
    assert advance.high is None  # four of thirty are more than one in twenty
    assert advance.low is not None
    assert np.isfinite(run.band("x", 0.9)["high"]).all()
    assert any("1 of 30 particles diverged" in note for note in found.notes)
    assert found.to_dict()["runs"][0]["diverged"] == 1


def test_a_crash_stop(esso_osaka):
    """By a ship whose propeller goes astern; full astern until she is dead in the water."""
    found = predict(scattered(esso_osaka, 3), options=PredictOptions(stop=True))
    (run,) = found.runs
    assert (run.states[:, -1, 3] <= 1e-9).all()
    reach = run.indices["track_reach_m"]
    length = np.sum(np.hypot(*np.diff(run.states[:, :, :2], axis=1).transpose(2, 0, 1)), axis=1)
    np.testing.assert_allclose(reach, length - 0.5 * esso_osaka.L_pp, rtol=0.02)  # half a length is the approach
    slower = predict(esso_osaka, options=PredictOptions(stop=True, astern="300"))
    assert slower.runs[0].indices["track_reach_m"][0] > 1.2 * reach[0]


def test_a_network_needs_an_approach(kvlcc2):
    made = NetworkPredictor(network(members=3, size=0.05, step=1.0))
    with pytest.raises(OptionError, match="begins is not known"):
        predict(made, options=TURN)
    found = predict(made, options=PredictOptions(turn=("35",), speed="0.5 m/s", rpm="600"))
    assert any("no steering gear" in note for note in found.notes)
    assert found.predictor.n_members == 3


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"turn": ("60",)}, "goes from -35 to 35"),
        ({"turn": ("0.6",)}, "radians"),
        ({"zigzag": ("60/10",)}, "goes from"),
        ({"stop": True}, "no revolutions astern"),
        ({"restart": 50.0}, "nothing was measured"),
    ],
)
def test_orders_that_make_no_sense(kvlcc2, options, said):
    with pytest.raises(OptionError, match=said):
        predict(kvlcc2, options=PredictOptions(**options))


def test_orders_that_contradict_each_other(kvlcc2, tmp_path):
    with pytest.raises(OptionError, match="own inputs"):
        predict(kvlcc2, trials="suzaku", options=TURN)
    with pytest.raises(OptionError, match="own inputs"):
        predict(kvlcc2, tmp_path / "orders.csv", trials="suzaku")
    with pytest.raises(OptionError, match="no standard manoeuvre"):
        predict(kvlcc2, tmp_path / "orders.csv", options=TURN)
    with pytest.raises(OptionError, match="crash stop"):
        PredictOptions(astern="60")


def two_trials():
    data = load_trials("suzaku")
    return TrialSet({id: data.trials[id] for id in ("turn_p35", "zigzag_10")}, (), ())


@pytest.fixture(scope="module")
def on_trials(suzaku):
    return predict(scattered(suzaku, 12), trials=two_trials())


def test_trials_are_driven_by_their_inputs(suzaku, on_trials):
    expected = as_predictor(suzaku)
    for run, trial in zip(on_trials.runs, two_trials().trials.values(), strict=True):
        alone = predict(expected, trials=[trial]).runs[0]
        np.testing.assert_allclose(run.states[0], alone.states[0], rtol=1e-9, atol=1e-9)
        np.testing.assert_array_equal(run.t, trial.t)
        np.testing.assert_array_equal(run.states[:, 0], np.repeat(trial.motion[:1], 12, axis=0))
    assert on_trials.runs[0].measured["advance_m"] > 0.0
    assert on_trials.score.windows == 2


def test_particles_about_the_truth_hold_it(suzaku):
    """A trial that one more draw of the particles has made."""
    every = scattered(suzaku, 61, size=0.1, seed=3)
    (trial,) = [one for one in two_trials().trials.values() if one.id == "turn_p35"]
    truth = predict(PhysicsPredictor(suzaku, every.theta[:, 5:6]), trials=[trial]).runs[0].states[0]
    from dataclasses import replace

    own = replace(trial, **dict(zip(("x", "y", "psi", "u", "v_m", "r"), truth.T, strict=True)))
    rest = PhysicsPredictor(suzaku, np.delete(every.theta, (0, 5), axis=1))
    right = predict(rest, trials=[own]).score
    assert right.covers(0.95) > 0.9
    assert right.L_Maha < 12.0
    wrong = predict(PhysicsPredictor(suzaku, rest.theta * 1.0), trials=[trial]).score
    assert wrong.L_Maha > right.L_Maha


def test_scores_of_windows(suzaku, on_trials):
    found = predict(scattered(suzaku, 12), trials=two_trials(), options=PredictOptions(restart=60.0))
    assert found.score.windows > 10
    assert found.score.L_Eucl < on_trials.score.L_Eucl  # begun anew, errors do not add up
    assert found.score.correlation is not None
    np.testing.assert_array_equal(found.runs[0].states, on_trials.runs[0].states)  # what is drawn are whole trials


def test_what_is_written_is_what_was_found(on_trials, tmp_path):
    document = write_prediction(on_trials, tmp_path, "mmgtune predict", keep_particles=True)
    assert json.loads((tmp_path / "predict.json").read_text()) == document
    bands = pq.read_table(tmp_path / "bands.parquet").to_pandas()
    part = bands[(bands["run"] == "zigzag_10") & (bands["variable"] == "r")]
    run = on_trials.runs[1]
    np.testing.assert_array_equal(part["high"], run.band("r", 0.9)["high"])
    np.testing.assert_array_equal(part["measured"], run.trial.r)
    paths = pq.read_table(tmp_path / "paths.parquet").to_pandas()
    one = paths[(paths["run"] == "turn_p35") & (paths["particle"] == 7)]
    np.testing.assert_array_equal(one[["x", "y", "psi", "u", "v_m", "r"]], on_trials.runs[0].states[7])
    assert not paths["diverged"].any()
    files = render(tmp_path)
    assert {"report.html", "calibration.svg", "track_1.svg", "motions_2.svg", "indices.svg"} <= {
        one.name for one in files
    }
    page = (tmp_path / "report.md").read_text()
    assert "generated" in page
    assert "too narrow" in page


def test_a_prediction_of_which_nothing_is_left(kvlcc2, tmp_path):
    class Lost(Wrapped):
        def predict(self, cases):
            shape = (len(cases), 2, cases.t.shape[1])
            return Prediction(np.full((*shape, 6), np.nan), np.ones(shape[:2], dtype=bool))

    lost = Lost(scattered(kvlcc2, 2))
    for name, found in {"orders": predict(lost, options=TURN), "trials": predict(lost, trials=two_trials())}.items():
        document = write_prediction(found, tmp_path / name)
        assert document["runs"][0]["diverged"] == 2
        assert render(tmp_path / name)
