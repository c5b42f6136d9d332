"""Which of two explanations stands first: one value for all runs, or values that differ between them."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace

import pytest

from mmgtune.diagnose.answering import judging
from mmgtune.diagnose.answering.judging import _of_kin
from mmgtune.diagnose.bench.hypotheses import Hypothesis
from mmgtune.diagnose.searching import look, search
from mmgtune.diagnose.searching.look import Step
from mmgtune.diagnose.searching.refit import Refit, believable_first, decide, kin_among, rivals_among
from mmgtune.diagnose.searching.refitting import Refitting
from mmgtune.diagnose.searching.search import Found
from mmgtune.effects import find_effect

N_RESIDUALS, BEFORE = 10_000, 15_000.0


def refit(chi2, by, cost):
    """A refit that leaves chi2, of values that differ or not."""
    return SimpleNamespace(
        hypothesis=SimpleNamespace(by=by),
        score=SimpleNamespace(inflation=2.0),
        point=SimpleNamespace(chi2=chi2),
        gain=BEFORE - chi2,
        cost=cost,
        evidence=(BEFORE - chi2) / 2.0 - cost,
    )


@pytest.mark.parametrize(
    ("differing", "alike", "first"),
    [
        (9_900.0, 10_100.0, ""),  # both leave no more than noise
        (10_100.0, 13_000.0, "trial"),
        (12_000.0, 14_000.0, ""),  # neither is the answer: values of many runs bend to anything
        (8_000.0, 9_500.0, "trial"),  # noise was known as too large, from a model without the cause
        (9_400.0, 9_600.0, ""),
        (9_590.0, 9_600.0, ""),
    ],
)
def test_values_that_differ_stand_first_where_they_leave_far_less(differing, alike, first):
    bench = SimpleNamespace(problem=SimpleNamespace(n_residuals=N_RESIDUALS))
    refitting = Refitting(SimpleNamespace(strong=True, bench=bench))
    ordered = refitting._ordered([refit(alike, "", 20.0), refit(differing, "trial", 60.0)])
    assert ordered[0].hypothesis.by == first


def fitted(tag, gain, inflation, p_value, unvisited=""):
    """A refit of one parameter, along a signature of which noise has ``inflation``."""
    akin = {"wave-drift": ("wind",)}.get(tag, ())
    hypothesis = SimpleNamespace(by="", tag=tag, bases=(), holds=lambda _: False, effect=SimpleNamespace(akin=akin))
    known = hypothesis, SimpleNamespace(inflation=inflation), SimpleNamespace(chi2=0.0)
    return Refit(*known, gain, 9.0, gain / inflation - 9.0, 1.0, p_value, unvisited)


NOISE = fitted("rudder-gain", 375.0, 66.0, 0.87)
"""Gusts bring as much."""

TRUE = fitted("gyro-bias", 220.0, 1.2, 1e-30)


def test_a_cause_is_not_hidden_behind_what_chance_explains_more_by():
    """A rate gyro that is off in a gusty wind: gusts have much of other signatures, nothing of that one."""
    less = fitted("antenna", 150.0, 1.0, 1e-20)
    ordered = believable_first([NOISE, less, TRUE], 0.01)
    assert [one.hypothesis.tag for one in ordered] == ["gyro-bias", "rudder-gain", "antenna"]
    assert [one.hypothesis.tag for one in rivals_among(ordered)] == ["antenna"] * (not TRUE.beats(less))
    assert TRUE.beats(NOISE)
    assert not NOISE.beats(TRUE)


def test_where_chance_brings_all_of_it_nothing_comes_first():
    others = [NOISE, fitted("antenna", 15.0, 1.0, 0.3), fitted("gyro-bias", 220.0, 1.2, 1e-30, unvisited="turns")]
    assert believable_first(others, 0.01) == others


@pytest.mark.parametrize(
    ("before", "gain", "by", "takes"),
    [
        (1_780.0, 1_800.0, "", True),
        (1_780.0, 1_500.0, "", False),
        (300.0, 310.0, "", False),
        (1_780.0, 1_800.0, "trial", False),
    ],
    ids=["all that is left", "a part of it", "hardly more than noise was left", "values of runs bend to anything"],
)
def test_what_groups_of_waves_may_leave_has_not_the_shape_of_a_single_cause(before, gain, by, takes):
    """A tenth less draught beside waves: groups may leave 110 times as much along it, and nothing was left."""
    one = fitted("loading", gain, 110.0, 0.001)
    one.hypothesis.by, one.point.chi2 = by, N_RESIDUALS + before - gain
    bench = SimpleNamespace(problem=SimpleNamespace(n_residuals=N_RESIDUALS), options=SimpleNamespace(level=0.01))
    assert decide(bench, [one], []) == (takes, "" if takes else "it explains too little for one more parameter")
    assert not decide(bench, [replace(one, p_value=0.02)], [])[0]


@pytest.mark.parametrize(("wind", "kin"), [(118_000.0, ["wind"]), (30_000.0, [])])
def test_a_wind_may_be_meant_where_the_drift_of_waves_fits_badly(wind, kin):
    drift = fitted("wave-drift", 340_000.0, 1.0, 0.0)
    others = [fitted("current", 200_000.0, 1.0, 0.0), fitted("wind", wind, 1.0, 0.0)]
    assert [one.hypothesis.tag for one in kin_among([drift, *others], "wave-drift")] == kin
    assert rivals_among([drift, *others]) == []


@pytest.mark.parametrize(
    ("left", "of_gusts", "by", "chi2", "wind", "kin"),
    [
        (0.2, 0.0, "", 1.2, 337_000.0, True),
        (0.2, 0.0, "", 1.2, 330_000.0, False),
        (0.0, 0.07, "", 1.07, 337_000.0, False),
        (0.0, 0.2, "", 1.2, 337_000.0, True),
        (0.0, 0.2, "", 1.2, 330_000.0, False),
        (0.0, 0.07, "trial", 1.07, 337_000.0, True),
        (0.0, 0.07, "trial", 1.07, 330_000.0, False),
        (0.0, 0.01, "trial", 1.01, 337_000.0, False),
    ],
)
def test_where_a_little_more_than_noise_is_left_the_form_of_a_force_may_be_off(left, of_gusts, by, chi2, wind, kin):
    """Waves of another hand, whose drift had an envelope, were a wind that differed from run to run: values of each run
    bend to that, and leave nothing that gusts would not.  Those that were the same in all runs were a wind, which left
    a fifth of the noise, as its gusts would."""
    looked_at = [fitted("wave-drift", 340_000.0, 1.0, 0.0), fitted("current", 339_000.0, 1.0, 0.0)]
    looked_at.append(fitted("wind", wind, 1.0, 0.0))
    looked_at[0].hypothesis.by, looked_at[0].hypothesis.effect = by, find_effect("wave-drift")
    found = SimpleNamespace(causes=[looked_at[0].hypothesis], steps=[SimpleNamespace(refits=looked_at)])
    leftover = SimpleNamespace(unknown=left, left_open=of_gusts)
    of = _of_kin(SimpleNamespace(leftover=leftover, chi2=(9.0, chi2)), found)
    assert [one.hypothesis.tag for one in of] == ["wind"] * kin


@pytest.mark.parametrize("looked_at", [True, False])
@pytest.mark.parametrize(
    ("chi2", "inflation", "plainer"), [(9_510.0, 1.0, True), (9_530.0, 1.0, False), (9_730.0, 200.0, True)]
)
def test_one_rate_of_the_rudder_stands_for_two_that_are_alike(monkeypatch, chi2, inflation, plainer, looked_at):
    """A gear of 1.2 deg/s was told as one of 1.214 to starboard and 1.201 to port; one of 2.7 as one of 2.73 and 2.67,
    where orders logged every 2 s leave much open.  A rudder that moved by 1.08 times its order did by 1.077 and 1.075,
    as one factor had not been refitted: it starts from the mean then."""
    gear = find_effect("steering-lag")
    two, one = Hypothesis(gear, ("to_starboard", "to_port")), Hypothesis(gear, ("rate_limit",))
    other = Hypothesis(find_effect("dead-time"), ("seconds",))
    score = SimpleNamespace(inflation=inflation)
    refitted = (two, other, *([one] if looked_at else []))
    step = SimpleNamespace(refits=[SimpleNamespace(hypothesis=of, score=score) for of in refitted])
    final = SimpleNamespace(chi2=9_500.0, names=("hull.R_0", *two.names), unit=[0.5, 0.3, 0.4])
    found = SimpleNamespace(causes=[two], final=final, steps=[step])
    there, fewer, started = SimpleNamespace(chi2=chi2), SimpleNamespace(), []
    monkeypatch.setattr(search, "without", lambda *_: fewer)
    monkeypatch.setattr(search, "fitted_beside", lambda *_: there)
    monkeypatch.setattr(search, "_exchanged", lambda *asked: started.append(asked[1:]) or there)
    answer = search._in_plainer_form(SimpleNamespace(price=9.0), found, two, [two, other, one])
    assert answer == ((one, there) if plainer else None)
    assert [(point, gone, names, list(unit)) for point, gone, names, unit in started] == (
        [] if looked_at else [(fewer, (), one.names, [pytest.approx(0.35)])]
    )


@pytest.mark.parametrize("lost", [False, True], ids=["sailed without it", "a run is lost without it"])
@pytest.mark.parametrize(("gain", "rivals"), [(5_645.0, ["rpm-scale"]), (4_000.0, []), (-math.inf, [])])
def test_what_was_near_to_another_form_of_a_cause_is_its_rival(monkeypatch, gain, rivals, lost):
    """A displacement that did as well as a factor on the revolutions was exchanged for a draught, and told alone.

    What loses a run was a rival, for not a number is not beaten, and ended the diagnosis with a failed decomposition.
    """
    draught, other = Hypothesis(find_effect("loading"), ("draught",)), fitted("rpm-scale", 5_640.0, 1.0, 0.0)
    first = [fitted("loading", 5_648.0, 1.0, 0.0), other]
    second = [replace(fitted("loading", 24.0, 1.0, 0.0), hypothesis=draught)]
    base = SimpleNamespace(chi2=20_000.0, names=())
    steps = [Step(base, None, [], refits, [], True, "") for refits in (first, second)]
    final = SimpleNamespace(chi2=base.chi2 - 5_650.0)
    found = SimpleNamespace(causes=[draught], final=final, base=base, steps=steps, left_out=[])
    fewer = SimpleNamespace(chi2=math.inf if lost else base.chi2, names=())
    monkeypatch.setattr(search, "without", lambda *_: fewer)
    monkeypatch.setattr(search, "hopeless_beside", lambda *_: math.inf)
    monkeypatch.setattr(search, "_where", lambda point, _: point)
    monkeypatch.setattr(search, "fitted_beside", lambda *_: SimpleNamespace(chi2=base.chi2 - gain))
    assert [one.hypothesis.tag for one in search.rivals_of(None, found, draught)] == rivals
    # What a second search leaves out did as well at the first look, and may in the place of what it finds.
    found.steps, found.left_out = steps[1:], [fitted("thrust", 5_640.0, 1.0, 0.0)]
    beside = [one.hypothesis.tag for one in search.rivals_of(None, found, draught)]
    assert beside == (["thrust"] if rivals else [])


@pytest.mark.parametrize(("left", "rivals"), [(14_300.0, ["rpm-scale"]), (19_800.0, [])])
def test_rivals_are_judged_anew_where_the_noise_was_known_badly(monkeypatch, left, rivals):
    """Waves and a wind of 12 m/s left as much in a noise that was taken for half as large again as it was."""
    refits = [fitted("loading", 6_000.0, 1.0, 0.0), fitted("rpm-scale", 5_998.0, 1.0, 0.0)]
    refits = [replace(one, point=SimpleNamespace(chi2=14_000.0)) for one in refits]
    base, cause = SimpleNamespace(chi2=20_000.0, names=()), refits[0].hypothesis
    final = SimpleNamespace(chi2=left)
    steps = [Step(base, None, [], refits, [], True, "")]
    found = SimpleNamespace(causes=[cause], final=final, base=base, steps=steps, left_out=[])
    monkeypatch.setattr(search, "without", lambda *_: SimpleNamespace(chi2=1e6, names=()))
    monkeypatch.setattr(search, "hopeless_beside", lambda *_: math.inf)
    monkeypatch.setattr(search, "_where", lambda point, _: point)
    monkeypatch.setattr(search, "fitted_beside", lambda *_: SimpleNamespace(chi2=left + 4_000.0))
    assert [one.hypothesis.tag for one in search.rivals_of(None, found, cause)] == rivals


@pytest.mark.parametrize(
    ("forms", "told"),
    [
        ([("steering-lag", 1800.0, 65.0, 3e-6)], True),
        ([("clock-offset", 1600.0, 55.0, 1e-6), ("steering-lag", 1800.0, 65.0, 3e-6)], True),
        ([("clock-offset", 1600.0, 55.0, 1e-6), ("steering-lag", 1800.0, 600.0, 0.4)], False),
        ([("clock-offset", 5000.0, 55.0, 1e-30), ("steering-lag", 1800.0, 65.0, 3e-6)], False),
    ],
    ids=["itself", "a rival", "by chance as well", "far from as good"],
)
def test_what_chance_may_bring_is_no_doubt_where_a_plainer_form_of_it_is_told(forms, told):
    """Two rates of a gear explained more, by chance perhaps, than its one rate or a clock, and nothing was named."""
    effects_of = {tag: SimpleNamespace(akin=()) for tag in ("steering-lag", "clock-offset")}

    def of(tag, *known):
        one = fitted(tag, *known)
        one.hypothesis.effect = effects_of[tag]
        return one

    best, *others = [of(*form) for form in forms]
    two_rates = of("steering-lag", 3300.0, 290.0, 0.1)
    assert look._in_a_form_told([best, two_rates, *others], two_rates, 0.01) == told


@pytest.mark.parametrize(("plain", "told"), [(9_300.0, 2), (8_000.0, 4)], ids=["steady does as well", "it changed"])
def test_the_first_of_a_sum_is_told_in_its_plainest_form(monkeypatch, plain, told):
    """Of a hull of another form "the current changed within a run by up to 0.7 m/s in ten minutes": it was steady."""
    steady, changing = (
        Hypothesis(find_effect("current"), names)
        for names in find_effect("current").variants
        if "north" in names and "carried" not in names
    )
    of_each = replace(changing, by="trial", groups=("trial:a", "trial:b", "trial:c"))
    falls = {steady.names: plain, changing.names: 9_500.0 if told == 4 else plain}
    base = SimpleNamespace(chi2=20_000.0)
    monkeypatch.setattr(judging, "as_special", lambda *asked: SimpleNamespace(chi2=20_000.0 - falls[asked[-1].names]))
    found = Found(base, SimpleNamespace(chi2=10_000.0), [of_each])
    asker = SimpleNamespace(bench=None, asked=[changing, steady, Hypothesis(find_effect("flap"), ("factor",))])
    (cause,) = judging.Judge._plainest(asker, found).causes
    assert (cause.by, len(cause.names)) == ("", told)
    falls |= dict.fromkeys(falls, 100.0)
    assert judging.Judge._plainest(asker, found) is found
