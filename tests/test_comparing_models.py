"""Models of any kind on the same trials: predictors whose errors are known, and the command."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from mmgtune.comparing_models import Cell, Column, compare_models
from mmgtune.errors import OptionError, TrialError
from mmgtune.networks import save_network
from mmgtune.objective import spread
from mmgtune.options import CompareModelsOptions
from mmgtune.predictor import Prediction, as_predictor
from mmgtune.trial import TrialSet, write_trial
from tests.command import run
from tests.fitting.conftest import make_set
from tests.networks.made import network


class Drifting:
    """The ship herself, on trials she made, but for a drift to the north [m/s] of each member."""

    def __init__(self, ship, drifts, lost=()):
        self._ship, self._drifts, self._lost = as_predictor(ship), np.array(drifts), list(lost)
        self.name, self.L_pp, self.inputs, self.method = "drifting", ship.L_pp, self._ship.inputs, "by hand"
        self.n_members = len(drifts)

    def predict(self, cases):
        states = np.repeat(self._ship.predict(cases).states, self.n_members, axis=1)
        states[..., 0] += self._drifts[None, :, None] * (cases.t - cases.t[:, :1])[:, None, :]
        diverged = np.zeros(states.shape[:2], dtype=bool)
        diverged[:, self._lost] = True
        return Prediction(states, diverged)


@pytest.fixture(scope="module")
def data(suzaku):
    """Four trials, two of them called berthing."""
    own = {"hull.R_0": suzaku.profile.value("hull.R_0")}
    trials = list(make_set(suzaku, own).trials.values())[:4]
    trials = [replace(one, manoeuvre="berthing" if k > 1 else one.manoeuvre) for k, one in enumerate(trials)]
    return TrialSet({one.id: one for one in trials}, tuple(one.id for one in trials[:3]), (trials[3].id,))


def expected(trials, drift, sigma, window):
    """Mean of the squared drift over sigma, each sample once: a window ends where the next begins."""
    squares = []
    for trial in trials:
        since = trial.t - trial.t[0]
        if window is not None:
            since = since - np.maximum(np.ceil(since / window - 1e-9) - 1.0, 0.0) * window
        squares.append((drift * since[since > 0.0] / sigma["x"]) ** 2)
    return np.mean(np.concatenate(squares))


def test_known_errors_in_both_conventions(suzaku, data):
    drifts = 0.01, 0.02, 0.04
    found = compare_models({"true": suzaku, "off": Drifting(suzaku, drifts)}, data, CompareModelsOptions(restart=50.0))
    sigma = spread(list(data.trials.values()))
    assert [one.name for one in found.columns][:1] == ["all"]
    for column in found.columns:
        trials = [
            one
            for one in data.trials.values()
            if column.kind in (None, one.manoeuvre) and column.run in (None, one.run)
        ]
        assert found.models[0].cell("whole", column).mean == pytest.approx(0.0, abs=1e-12)
        values = [expected(trials, drift, sigma, None) for drift in drifts]
        cell = found.models[1].cell("whole", column)
        np.testing.assert_allclose(cell.members, values, rtol=1e-6)
        assert cell.mean == pytest.approx(np.mean(values))
        assert cell.deviation == pytest.approx(np.std(values, ddof=1))
        short = found.models[1].cell("windows", column)
        np.testing.assert_allclose(short.members, [expected(trials, one, sigma, 50.0) for one in drifts], rtol=1e-6)
        assert short.mean < 0.5 * cell.mean
        assert found.best("whole", column) == "true"


def test_columns(suzaku, data):
    found = compare_models(suzaku, data)
    kinds = {one.manoeuvre for one in data.trials.values()}
    berthing = [one.run for one in data.trials.values() if one.manoeuvre == "berthing"]
    assert {one.kind for one in found.columns} == {None, *kinds}
    assert [one.run for one in found.columns if one.run] == berthing
    assert [one["runs"] for one in found.to_dict()["columns"] if one["run"]] == [1, 1]


def test_ratios_are_to_the_first_model(suzaku, data):
    several = {"a": Drifting(suzaku, [0.01]), "b": Drifting(suzaku, [0.03])}
    document = compare_models(several, data).to_dict()
    assert [one["whole"][0]["ratio"] for one in document["models"]] == pytest.approx([1.0, 9.0], rel=1e-6)
    assert document["models"][0]["whole"][0]["deviation"] is None
    assert {one["best"]["windows"] for one in document["columns"]} == {"a"}


def test_what_diverged_has_no_mean_and_is_never_best(suzaku, data):
    several = {"lost": Drifting(suzaku, [0.001, 0.001], lost=[1]), "b": Drifting(suzaku, [0.03])}
    document = compare_models(several, data).to_dict()
    row = document["models"][0]["windows"][0]
    assert (row["mean"], row["deviation"], row["ratio"], row["diverged"]) == (None, None, None, 1)
    assert row["members"][0] is not None
    assert row["members"][1] is None
    assert document["models"][1]["windows"][0]["ratio"] is None
    assert {one["best"]["windows"] for one in document["columns"]} == {"b"}


def test_bands_of_models_whose_errors_are_known(suzaku, data):
    """Of drifting members the track alone differs: those on both sides of the ship hold her, those on one do not."""
    drifts = np.linspace(-0.05, 0.05, 21)
    several = {"about": Drifting(suzaku, drifts), "beside": Drifting(suzaku, drifts + 0.2), "one": suzaku}
    found = compare_models(several, data, CompareModelsOptions(restart=50.0))
    for convention in ("windows", "whole"):
        about, beside, one = (found.bands[name][convention][0] for name in several)
        held = {name: of[convention][0].coverage_by_state for name, of in found.bands.items()}
        assert held["about"]["x"] == (1.0,) * 10
        assert held["beside"]["x"] == (0.0,) * 10
        assert held["about"]["psi"][0] == 1.0  # no width, no error
        assert about.width_by_state["x"] == pytest.approx(beside.width_by_state["x"])
        assert about.CRPS < beside.CRPS
        assert (about.L_Eucl, one.L_Eucl) == (pytest.approx(0.0, abs=1e-20), pytest.approx(0.0, abs=1e-20))
        assert about.L_Maha is None  # all velocities are the same
        assert about.singular > 0
        assert one.coverage == (None,) * 10
        assert found.surest(convention, 0) == "one"
    document = found.to_dict()
    assert document["models"][0]["particles"] == 21
    assert document["models"][0]["windows"][0]["bands"] == about_in(found)
    assert document["columns"][0]["best_CRPS"] == {"windows": "one", "whole": "one"}


def about_in(found):
    return found.bands["about"]["windows"][0].to_dict()


class Drawing(Drifting):
    """One that draws particles, and notes how."""

    def drawn(self, n, seed, sampling="TS-infinity"):
        self.asked = n, seed, sampling
        return Drifting(self._own, np.linspace(-0.01, 0.01, n))

    def __init__(self, ship, drifts):
        super().__init__(ship, drifts)
        self._own = ship


def test_particles_are_drawn_of_what_can_draw_them(suzaku, data):
    one = Drawing(suzaku, [0.01])
    found = compare_models([one, suzaku], data, CompareModelsOptions(particles=7, seed=3, sampling="TS1"))
    assert one.asked == (7, 3, "TS1")
    assert [of.particles.n_members for of in found.models] == [7, 1]


def test_a_cell_by_hand():
    assert (Cell((1.0, 2.0, 6.0)).mean, Cell((1.0, 2.0, 6.0)).deviation) == (3.0, pytest.approx(np.sqrt(7.0)))
    assert (Cell((2.0,)).mean, Cell((2.0,)).deviation) == (2.0, None)
    assert Column("").name == "not stated"


@pytest.mark.parametrize(("only", "n"), [(("berthing",), 2), (("test",), 1), (("tune", "test"), 4)])
def test_only_some_trials(suzaku, data, only, n):
    assert len(compare_models(suzaku, data, CompareModelsOptions(only=only)).data.trials) == n


def test_sigma_is_of_the_trials_scored_unless_it_is_said(suzaku, data):
    found = compare_models(suzaku, data, CompareModelsOptions(only=("berthing",)))
    scored = [one for one in data.trials.values() if one.manoeuvre == "berthing"]
    assert found.sigma == pytest.approx(spread(scored))
    other = compare_models(suzaku, data, CompareModelsOptions(only=("berthing",), sigma_from="suzaku"))
    assert other.sigma["x"] != pytest.approx(found.sigma["x"])


def test_words_that_name_no_trial_and_sets_without_any(suzaku, data):
    with pytest.raises(OptionError, match="did you mean 'berthing'"):
        compare_models(suzaku, data, CompareModelsOptions(only=("berting",)))
    with pytest.raises(OptionError, match="no trial to compare"):
        compare_models(suzaku, TrialSet({}, (), ()))
    with pytest.raises((OptionError, TrialError)):
        compare_models([], data)


@pytest.mark.long
def test_the_command(tmp_path, data):
    for trial in data.trials.values():
        write_trial(trial, tmp_path / "log" / f"{trial.id}.parquet")
    save_network(network(members=2, size=0.1), tmp_path / "model.safetensors")
    names = "suzaku", "kvlcc2", "model.safetensors", "log"
    ended = run("learn", "compare", *names, "--out", "compared", "--json", cwd=tmp_path)
    assert ended.code == 0, ended.err
    document = ended.json()
    assert [one["members"] for one in document["models"]] == [1, 1, 2]
    assert document["columns"][0]["best"]["whole"] == "suzaku"
    for name in ("model_comparison.json", "report.html", "report.md", "figures/errors.svg"):
        assert (tmp_path / "compared" / name).is_file()
    page = (tmp_path / "compared" / "report.md").read_text()
    assert "berthing" in page
    assert "±" in page
    assert "least CRPS" in page
    assert (tmp_path / "compared" / "figures" / "calibration.svg").is_file()
    again = run("learn", "compare", *names, "--out", "compared", cwd=tmp_path)
    assert again.code == 2
    shown = run("compare", *names, "--only", "berthing", cwd=tmp_path)
    assert "90 % holds" in shown.out
    assert "±" in shown.out
    assert "begun once in each whole run" in shown.out
    assert "deviation over networks" in shown.out


def test_a_comparison_of_profiles_does_not_speak_of_networks(tmp_path, data):
    for trial in data.trials.values():
        write_trial(trial, tmp_path / "log" / f"{trial.id}.parquet")
    ended = run("compare", "suzaku", "kvlcc2", "log", "--out", "compared", cwd=tmp_path)
    assert "network" not in ended.out
    assert "network" not in (tmp_path / "compared" / "report.md").read_text()


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("suzaku",), "missing"),
        (("suzaku", "suzaku", "--restart", "0"), "--restart"),
        (("suzaku", "suzaku", "--only", "stopping"), "--only"),
        (("suzaku", "suzaku", "--force"), "--force"),
        (("nowhere.safetensors", "suzaku"), "nowhere"),
    ],
)
def test_wrong_arguments(arguments, said, tmp_path):
    ended = run("learn", "compare", *arguments, cwd=tmp_path)
    assert ended.code == 2
    assert said in ended.err
    assert "Traceback" not in ended.err
