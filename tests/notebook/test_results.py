"""Results at a prompt and in a notebook."""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import replace
from html.parser import HTMLParser

import numpy as np
import pytest

import mmgtune
from mmgtune.errors import OptionError, TrialError
from mmgtune.fitting.comparison import ComparedTrials
from mmgtune.fleet import FleetRun
from mmgtune.model import Model
from mmgtune.motions import motions
from mmgtune.notebook.kinds import KINDS
from mmgtune.predictor import as_predictor
from mmgtune.trial.index_trial import IndexTrial, Stated

HOSTILE = "<img src=x onerror=alert(1)>\"'&amp;\u202e\x9b31m$x_1$"
"""A name as a log may have it: marks of HTML and of mathematics, a turned direction, a control code."""


@pytest.fixture(scope="module")
def trials():
    return mmgtune.load_trials("suzaku")


@pytest.fixture(scope="module")
def fitted():
    return mmgtune.fit("suzaku", "suzaku", mmgtune.FitOptions(a_r=0.5, method="least-squares", starts=2))


@pytest.fixture(scope="module")
def hostile(trials):
    """Two trials, one of them with such a name."""
    evil = replace(trials["turn_p35"], id=HOSTILE, ship=HOSTILE, manoeuvre=HOSTILE)
    ids = (HOSTILE, "turn_m35")
    return replace(trials, trials={HOSTILE: evil, "turn_m35": trials["turn_m35"]}, tune=ids, test=())


@pytest.fixture
def plt():
    import matplotlib as mpl

    mpl.use("agg")
    import matplotlib.pyplot as plt

    yield plt
    plt.close("all")


class Tags(HTMLParser):
    """The tags of a text, and the words between them; a tag left open raises."""

    def __init__(self, text):
        super().__init__()
        self.open, self.tags, self.words = [], set(), []
        self.feed(text)
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        self.open.append(tag)
        self.tags.add(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.words.append(data)


def results(fitted, trials):
    """A result of each kind that is quick to make."""
    from mmgtune import validate

    sailed = mmgtune.simulate("suzaku", "suzaku")
    return [
        fitted.profile,
        trials,
        trials["turn_p35"],
        fitted,
        sailed,
        sailed[0],
        sailed.records[0],
        validate(["suzaku", fitted.tuned_profile()], trials),
        mmgtune.predict("suzaku", "suzaku"),
        mmgtune.compare_profiles("suzaku", "suzaku_fam"),
        mmgtune.compare_models({"a": "suzaku", "b": "suzaku_fam"}, [trials["turn_p35"]]),
        mmgtune.inspect_trials(trials),
    ]


def test_every_result_is_a_line_a_table_and_a_text(fitted, trials):
    for one in results(fitted, trials):
        assert "\n" not in repr(one)
        assert len(repr(one)) < 200
        html = Tags(one._repr_html_())
        assert {"table", "th", "td"} <= html.tags
        assert html.tags.isdisjoint({"script", "img", "iframe", "link", "a"})
        frame = one.to_frame()
        assert len(frame)
        assert one.sentence()
        assert "\n" not in one.sentence()
        lines = repr(one.summary()).splitlines()
        assert repr(one) in " ".join(lines)
        assert max(map(len, lines)) <= 80, type(one)


def test_a_fleet_in_a_notebook(tmp_path):
    cells = [
        {"ship": ship, "date": "2026-01", "name": "state", "answer": "good", "off_track": 158.2, "tuned_track": 113.4,
         "causes": ["current"]}
        for ship in ("aa", HOSTILE)
    ]  # fmt: skip
    failure = {"ship": "bb", "date": "2026-02", "name": "state", "problems": [{"what": "no trials"}]}
    said = "hull.R_0 rises by 0.003 (± 0.0003) between 2026-03 and 2026-04"
    document = {"ships": ["aa", HOSTILE], "dates": ["2026-01"], "jobs": {"total": 2, "failed": 1}, "cells": cells,
                "changes": [{"ship": "aa", "sentence": f"H{said[1:]}"}],
                "failures": [failure]}  # fmt: skip
    run = FleetRun((), {}, 0, 1.0, 1, document)
    assert repr(run) == "FleetRun(2 ships, 1 date: 2 jobs, 1 failed)"
    assert Tags(run._repr_html_()).tags.isdisjoint({"img", "script"})
    told = " ".join(run.summary().split())
    assert f"aa: {said}." in told
    assert "bb, 2026-02, state failed: no trials." in told
    assert run.to_frame()["off track [m]"].tolist() == [158.2, 158.2]


def test_nothing_in_a_result_fills_the_screen(fitted, trials):
    parts = [fitted.certificate, fitted.identifiability, fitted.box, fitted.compared[0].records["after"]]
    parts += [fitted.profile.sections["hull"], fitted.profile.arrangement, mmgtune.Model("suzaku"), fitted.options]
    parts += [mmgtune.repeat("suzaku", [trials["turn_p35"]])[0], mmgtune.score("suzaku", trials)[0]]
    assert [len(repr(one)) for one in parts if len(repr(one)) > 200 or "\n" in repr(one)] == []


def test_options_say_what_was_chosen():
    assert repr(mmgtune.FitOptions()) == "FitOptions()"
    assert repr(mmgtune.FitOptions(a_r=0.3, seed=2)) == "FitOptions(seed=2, a_r=0.3)"


def test_a_fit_as_lmfit_prints_it(fitted):
    frame = fitted.to_frame().set_index("coefficient")
    for row in fitted.coefficients():
        shown = frame.loc[row["name"]]
        assert shown["value"] == row["value"]
        assert shown["low"] <= shown["value"] <= shown["high"]
        assert shown["bound"] == {None: "", "": "", "low": "lower", "high": "upper"}[row["at_bound"]]
    assert frame["std.err"].isna().sum() == sum(row["stderr"] is None for row in fitted.coefficients())
    text = fitted.summary().splitlines()
    (head,) = [line.split() for line in text if line.startswith("coefficient")]
    assert [name for name in head if name != "before"] == [
        "coefficient", "value", "std.err", "low", "high", "bound", "determined"
    ]  # fmt: skip
    (line,) = [line.split() for line in text if line.startswith("wake.w_P0")]
    assert "upper" in line
    assert float(line[1]) == pytest.approx(frame.loc["wake.w_P0", "value"], rel=1e-3)


def test_a_set_of_trials_is_a_collection(trials):
    assert len(trials) == 10
    assert "turn_p35" in trials
    assert "turn" not in trials
    assert trials["turn_p35"] is trials.trials["turn_p35"]
    assert [one.id for one in trials] == list(trials.trials)
    with pytest.raises(TrialError, match="did you mean 'turn_p35'"):
        trials["turn_p3"]
    samples = trials["turn_p35"].to_frame()
    assert list(samples)[:3] == ["x [m]", "y [m]", "psi [rad]"]
    assert samples.index.name == "t [s]"
    assert np.array_equal(samples["v [m/s]"], trials["turn_p35"].v_m)


def test_names_where_objects_are_taken(trials):
    one = [trials["turn_p35"]]
    assert mmgtune.evaluate("suzaku", one)[0].J == mmgtune.evaluate(mmgtune.load_profile("suzaku"), one)[0].J
    assert len(mmgtune.evaluate("suzaku", "suzaku")) == len(trials)
    assert [s.J for s in mmgtune.score("suzaku", "suzaku")] == [r.J for r in mmgtune.evaluate("suzaku", trials)]
    assert mmgtune.repeat("suzaku", one) == mmgtune.repeat(mmgtune.load_profile("suzaku"), one)
    assert mmgtune.estimate("suzaku").name == mmgtune.estimate(mmgtune.read_particulars("suzaku")).name
    assert mmgtune.load_network("esso_osaka_3m_type1").ship


def test_trials_stand_where_orders_do(trials):
    by_name, by_place = mmgtune.predict("suzaku", "suzaku"), mmgtune.predict("suzaku", trials=trials)
    assert [run.id for run in by_name.runs] == [run.id for run in by_place.runs] == list(trials.trials)


def test_hostile_names_stay_words(hostile, plt):
    options = mmgtune.FitOptions(method="least-squares", starts=1, targets=("hull.R_0",))
    results = [hostile, hostile[HOSTILE], mmgtune.simulate("suzaku", hostile), mmgtune.validate("suzaku", hostile)]
    results += [mmgtune.fit("suzaku", hostile, options)]
    for one in results:
        html = Tags(one._repr_html_())
        assert "img" not in html.tags
        if not isinstance(one, mmgtune.FitResult):  # which lists coefficients
            assert any("<img src=x onerror=alert(1)>" in word for word in html.words)
        for text in (one._repr_html_(), repr(one), one.summary(), repr(one.plot)):
            assert "\x9b" not in text
            assert "\u202e" not in text
        for ax in np.ravel(one.plot.tracks()):
            ax.figure.draw_without_rendering()  # what looks like mathematics would raise
        one.plot.histories(HOSTILE, channels=("psi",))[0].figure.draw_without_rendering()


def test_the_trials_of_a_fit_are_a_table(fitted, trials, plt):
    compared = fitted.compared
    assert repr(compared) == "ComparedTrials(10 trials, 4 test, 4 tune, 2 other)"
    frame = compared.to_frame()
    assert frame["trial"].tolist() == list(trials.trials)
    assert frame["role"].tolist() == [trials.role(id) for id in trials.trials]
    for role in ("tune", "test", "other"):
        for which in ("before", "after"):
            J = frame.loc[frame["role"] == role, f"J {which}"].sum()
            assert pytest.approx(fitted.J_of(role, which), rel=1e-12) == J
    for one, row in zip(compared, frame.to_dict("records"), strict=True):
        assert one.off("before") == (row["off track before [m]"], row["off heading before [deg]"])
        assert one.off("after") == (row["off track after [m]"], row["off heading after [deg]"])
    assert not frame["diverged"].any()
    assert max(map(len, compared.summary().splitlines())) <= 80
    assert {"table", "td"} <= Tags(compared._repr_html_()).tags
    assert len(np.ravel(compared.plot.tracks("turn_p35", "zigzag_10"))) == 2


def test_a_trial_on_which_the_model_diverges_has_no_numbers_there(fitted):
    one, *others = fitted.compared
    lost = replace(one.records["after"], motion=replace(one.motions["after"], diverged=True))
    frame = ComparedTrials([replace(one, records={**one.records, "after": lost}), *others]).to_frame()
    assert frame["diverged"].tolist() == ["after"] + [""] * 9
    assert frame.loc[0, ["off track after [m]", "off heading after [deg]", "J after"]].isna().all()
    assert np.isfinite(frame.loc[0, "J before"])
    assert ComparedTrials().to_frame().empty
    assert repr(ComparedTrials()) == "ComparedTrials(0 trials)"


def test_left_out_trials_are_a_table_too(plt):
    options = mmgtune.LeaveOutOptions(a_r=0.5, starts=1, targets=("hull.R_0",))
    left_out = mmgtune.leave_out("suzaku", "suzaku", options)
    assert left_out.compared.to_frame()["role"].tolist() == ["left-out"] * 4
    assert dir(left_out.plot) == ["histories", "tracks"]
    assert len(left_out.plot.tracks()) == 4
    whole = left_out.to_frame().set_index("manoeuvre").loc["all"]
    assert f"{whole['off track left out [m]']:.3g} m off track" in left_out.sentence()


def test_what_a_result_says_is_the_headline_of_its_report(trials, tmp_path):
    of = [trials["turn_p35"], trials["turn_m35"]]
    written = {
        "validated": (mmgtune.validate(["suzaku", "suzaku_fam"], of), mmgtune.write_validation),
        "models": (
            mmgtune.compare_models({"one": "suzaku", "other": "suzaku_fam"}, of),
            mmgtune.write_model_comparison,
        ),
        "profiles": (mmgtune.compare_profiles("suzaku", "suzaku_fam"), mmgtune.write_comparison),
    }
    for name, (result, write) in written.items():
        write(result, tmp_path / name)
        mmgtune.render(tmp_path / name)
        headline = (tmp_path / name / "report.md").read_text().splitlines()[0]
        assert headline.replace("\u00a0", " ").replace("\\", "") == f"# {result.sentence()}"


def test_what_trials_hold_and_what_was_made_are_tables(trials, tmp_path):
    found = mmgtune.inspect_trials(trials)
    frame = found.to_frame().set_index("trial")
    (row,) = (one for one in found.rows if one["id"] == "turn_p35")
    assert frame.loc["turn_p35", "advance [m]"] == row["indices"]["advance_m"]
    stated = {"d": IndexTrial("d", "suzaku", "turning", 0.6, None, None, {"advance": Stated(240.0, 12.0)})}
    assert mmgtune.inspect_trials(replace(trials, stated=stated)).to_frame()["advance, stated [m]"].iloc[-1] == 240.0
    made = mmgtune.make_trials("vectwin", tmp_path, mmgtune.MakeOptions(sets=("test-r",)))
    assert made.to_frame()["trials"].tolist() == [10]
    assert repr(made) == "Made(vectwin_3m, 1 set of 10 trials)"


def test_a_fit_with_bands_is_a_table_of_what_is_foretold(fitted):
    found = mmgtune.fit_bands(fitted, "suzaku")
    assert {"manoeuvre", "index", "low", "high"} <= set(found.to_frame())
    assert found.sentence().startswith(fitted.sentence())
    assert list(found.warnings) == found.to_dict()["warnings"]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("tset", "after"), "tune, test, other, left-out"),
        (("validation", "after"), "tune, test, other, left-out"),
        (("test", "aftr"), "before, after"),
        ((None, "after"), "tune, test, other, left-out"),
    ],
)
def test_J_of_other_words_is_refused_with_those_there_are(fitted, words, said):
    with pytest.raises(OptionError, match="there is no J of") as error:
        fitted.J_of(*words)
    assert said in str(error.value)
    assert "fix: " in str(error.value)


def test_pictures_hold_what_they_are_of(fitted, trials, plt):
    axes = fitted.plot.tracks()
    assert len(axes) == len(fitted.compared)
    measured, before, after = (line for line in axes[0].lines if len(line.get_xdata()) > 1)
    trial = fitted.compared[0]
    assert np.array_equal(measured.get_ydata(), trial.trial.x)
    assert np.array_equal(after.get_xdata(), trial.motions["after"].channel("y"))
    assert not np.array_equal(before.get_xdata(), after.get_xdata())
    (ax,) = plt.figure().subplots(1, 1, squeeze=False).ravel()
    assert fitted.plot.tracks("turn_p35", ax=ax) is ax
    psi, delta = fitted.plot.histories("turn_p35", channels=("psi", "delta"))
    assert np.allclose(psi.lines[0].get_ydata(), np.rad2deg(trials["turn_p35"].psi))
    assert len(delta.lines) == 1  # what drove the ship is the same for all
    rooms = fitted.plot.coefficients()
    assert [label.get_text() for label in rooms.get_yticklabels()] == list(fitted.theta)
    assert dir(fitted.plot) == ["coefficients", "histories", "tracks"]


def test_pictures_of_models_side_by_side(trials, plt):
    of = [trials["turn_p35"], trials["turn_m35"]]
    found = mmgtune.compare_models({"one": "suzaku", "other": "suzaku_fam"}, of)
    assert dir(found.plot) == ["histories", "tracks"]
    axes = found.plot.tracks()
    assert [len([line for line in ax.lines if len(line.get_xdata()) > 1]) for ax in axes] == [3, 3]
    (one,) = motions(found.models[0].predictor, of[:1])
    shown = [line.get_ydata() for line in axes[0].lines if len(line.get_xdata()) > 1]
    assert np.array_equal(shown[0], of[0].x)
    assert np.array_equal(shown[1], one.channel("x"))
    (u,) = found.plot.histories("turn_m35", "u")
    assert len(u.lines) == 3


def test_pictures_of_voyages_are_those_of_the_windows_drawn(trials, plt, tmp_path):
    mmgtune.write_trial(replace(trials["turn_p35"], manoeuvre="voyage"), tmp_path / "log.parquet")
    found = mmgtune.validate_voyages({"one": "suzaku", "other": "suzaku_fam"}, tmp_path)
    names = [found.id_of(one) for one in found.drawn]
    axes = np.ravel(found.plot.tracks())
    assert [ax.get_title() for ax in axes] == names[: len(axes)]
    x = [line.get_ydata() for line in axes[0].lines if len(line.get_xdata()) > 1]
    assert [np.array_equal(x[0], found.drawn[0].measured[:, 0]), len(x)] == [True, 3]
    psi, delta = found.plot.histories(names[-1], ("psi", "delta"))
    assert [len(psi.lines), len(delta.lines)] == [3, 1]


def test_trials_that_are_indices_alone_have_no_picture(plt):
    stated = {"advance": Stated(240.0, 12.0)}
    delivery = IndexTrial("delivery", "suzaku", "turning", 0.6, None, None, stated)
    found = mmgtune.validate("suzaku", [delivery])
    for draw in (found.plot.histories, found.plot.tracks):
        with pytest.raises(OptionError, match="nothing to draw"):
            draw()


def test_what_there_is_no_picture_of(trials, plt):
    with pytest.raises(OptionError, match="no trial 'turn_p3'"):
        trials.plot.tracks("turn_p3")
    with pytest.raises(OptionError, match="no channel 'roll'"):
        trials.plot.histories("turn_p35", channels=("roll",))
    with pytest.raises(OptionError, match="no picture of coefficients"):
        trials.plot.coefficients()
    with pytest.raises(OptionError, match="1 channels on 2 axes"):
        trials.plot.histories(channels=("psi",), ax=plt.figure().subplots(1, 2))


def test_pictures_leave_a_notebook_showing_what_is_drawn_next(tmp_path):
    (tmp_path / "inline.py").write_text(
        "import matplotlib\nfrom matplotlib.backends.backend_agg import *\nmatplotlib.interactive(True)\n"
    )  # as the back end of notebooks does when pyplot first loads it
    code = (
        "import matplotlib, mmgtune; mmgtune.load_trials('suzaku')['turn_p35'].plot.tracks();"
        "assert matplotlib.is_interactive()"
    )
    env = {**os.environ, "MPLBACKEND": "module://inline", "PYTHONPATH": str(tmp_path)}
    subprocess.run([sys.executable, "-c", code], check=True, env=env)


def test_tables_need_no_matplotlib():
    words = "import mmgtune, sys; mmgtune.load_trials('suzaku')._repr_html_(); mmgtune.load_profile('suzaku').summary()"
    words += "; print([m for m in ('matplotlib', 'mmgtune.fitting', 'mmgtune.diagnose') if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", words], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_each_kind_is_a_class_that_can_be_shown():
    from mmgtune.displayed import Displayed

    public = {name: getattr(mmgtune, name) for name in mmgtune.__all__}
    shown = {name for name, of in public.items() if isinstance(of, type) and issubclass(of, Displayed)}
    assert shown <= set(KINDS)
    assert set(KINDS) - shown <= {"SweepResult", "LeftOut", "Motion"} | set(public)


def test_ids_may_stand_in_a_list_and_a_channel_alone(trials):
    assert len(trials.plot.tracks(["turn_p35", "turn_m10"])) == 2
    assert len(trials.plot.histories("turn_p35", "psi")) == 1


@pytest.mark.parametrize("first", [0, 1])
def test_models_with_and_without_members_share_their_columns(first):
    trial = mmgtune.load_trials("suzaku")["turn_p35"]
    model = Model(mmgtune.load_profile("suzaku"))
    twice = as_predictor(model, theta=np.repeat(model.matrix(), 2, axis=1))
    several = [("two", twice), ("one", model)]
    result = mmgtune.validate(dict([several[first], several[1 - first]]), [trial])
    table = result.to_frame()
    assert list(table["member"]) == ([1, 2, 1] if first == 0 else [1, 1, 2])
    lines = [line for line in result.summary().splitlines() if trial.id in line]
    assert len(lines) == 3
    assert all(len(line.split()) == 6 for line in lines)
    assert ">member<" in result._repr_html_()
