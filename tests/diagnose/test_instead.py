"""What one cause would do in the place of re-tuning, and causes that lose parameters that earn nothing."""

import importlib
import re
from dataclasses import replace

import numpy as np
import pytest

from mmgtune.diagnose.bench.hypotheses import Hypothesis, hypotheses, of_runs
from mmgtune.diagnose.bench.runs import within
from mmgtune.diagnose.bench.workbench import make_workbench
from mmgtune.diagnose.searching import instead
from mmgtune.diagnose.searching.base_fit import base_fit
from mmgtune.diagnose.searching.instead import Instead, instead_of_tuning
from mmgtune.diagnose.searching.search import Found
from mmgtune.effects import find_effect
from mmgtune.options import DiagnoseOptions
from mmgtune.profile import load_profile
from mmgtune.trial import load_trials
from tests.hidden.cases import draw_ship
from tests.hidden.plant import TUNING, WHITE, simulate, write
from tests.trial.made import made

search = importlib.import_module("mmgtune.diagnose.searching.search")  # the package has a function of that name

TAGS = ("shallow-water", "loading", "rudder-gain", "rpm-scale", "current", "resistance")
FEW = ("hull.R_0", "wake.w_P0", "rudder.eps")
HULL = ("hull.*", "wake.w_P0", "rudder.gamma_Rp", "rudder.gamma_Rn", "rudder.eps")


def bench_of(folder, ship, effects):
    """The workbench of SUZAKU on trials of a ship of the tests' own plant, and what is asked there."""
    write([one for one in simulate(ship, effects, 1, WHITE) if one.id in TUNING], folder)
    options = DiagnoseOptions(effects=TAGS, targets=HULL, a_r=0.9)
    trials = list(load_trials(folder).trials.values())
    asked = [Hypothesis(find_effect(tag), variant) for tag in TAGS for variant in find_effect(tag).variants]
    bench = make_workbench(load_profile("suzaku"), trials, options, [name for one in asked for name in one.names])
    known = hypotheses(bench.model, bench.targets, TAGS, (), ())
    return bench, known


def test_water_that_the_hull_took_up_is_told(tmp_path):
    bench, known = bench_of(tmp_path, {}, {"shallow-water": {"depth": 9.0}})
    found = instead_of_tuning(bench, base_fit(bench), known)
    assert found.effect == "shallow-water"
    assert found.share > 0.9
    assert found.next_effect == "loading"  # whose forms, bent, leave hardly more: the noise decides
    assert "that alone removes" in found.why
    (depth,) = re.findall(r"for a cause: the ship sailed in shallow water, as if ([0-9.]+) m deep\.", found.sentence)
    assert float(depth) == pytest.approx(9.0, abs=0.1)


def test_other_forms_of_the_cause_are_told_beside_it():
    loaded = "The ship was loaded otherwise than the profile says"
    forms = (f"{loaded}: 0.8 times the displacement", "The water was shallow")
    found = Instead("loading", f"{loaded}: a trim by the stern of 0.4 of the draught", 0.99, "", 0.0, forms)
    assert found.sentence == (
        "Re-tuning may stand for a cause: the ship was loaded otherwise than the profile says: "
        "a trim by the stern of 0.4 of the draught; or 0.8 times the displacement; or the water was shallow."
    )
    assert found.to_dict()["forms"] == list(forms)


@pytest.mark.long
def test_neither_of_the_ship_of_the_profile_nor_of_one_unlike_her_in_many_ways(tmp_path):
    for name, ship in (("own", {}), ("other", draw_ship(np.random.default_rng(5)))):
        bench, known = bench_of(tmp_path / name, ship, {})
        assert instead_of_tuning(bench, base_fit(bench), known) is None


@pytest.mark.long
@pytest.mark.parametrize(("rate", "left"), [(0.0, ("north", "east")), (3e-4, None)])
def test_a_current_keeps_its_rates_where_it_changes(tmp_path, rate, left):
    water = {"current": {"north": 0.2, "east": -0.1, "north_rate": rate, "east_rate": 0.0}}
    bench, known = bench_of(tmp_path, {}, water)
    (richest,) = (one for one in known if one.tag == "current" and len(one.names) == 4)
    base = base_fit(bench)
    start = np.concatenate([base.unit, bench.null(richest.names)])
    point = bench.refit((*base.names, *richest.names), start[:, None], base.offsets)
    found = Found(base, point, [richest])
    search._make_plain(bench, found, known)
    (cause,) = found.causes
    assert cause.variant == (left or richest.variant)
    assert set(found.final.names) == {*base.names, *cause.names}


@pytest.mark.parametrize(
    ("name", "other", "of_it"),
    [
        ("effects.current.north@trial:a", "effects.current.north@group:monday", True),
        ("effects.current.north@trial:b", "effects.current.north@group:monday", False),
        ("effects.current.north@trial:b", "effects.current.north", True),
        ("effects.current.east@trial:a", "effects.current.north@group:monday", False),
    ],
)
def test_which_values_of_runs_a_value_of_a_day_takes_the_place_of(name, other, of_it):
    runs = [made("a", group="monday"), made("b", group="tuesday")]
    assert within(name, other, runs) == of_it


@pytest.mark.long
def test_less_than_its_typical_size_is_not_told(tmp_path, monkeypatch):
    """Of a hull a few per cent off: "the ship was loaded otherwise: 1.02 times the draught"."""
    bench, known = bench_of(tmp_path, {}, {"shallow-water": {"depth": 9.0}})
    base = base_fit(bench)
    monkeypatch.setattr(instead, "LEAST", 1e9)
    assert instead_of_tuning(bench, base, known) is None


def test_runs_of_two_days_whose_values_are_those_of_the_day(tmp_path):
    """A compass that deviated made a current of two days differ from run to run; that it then was one of each day was
    not asked again."""
    waters = {"day 1": {"north": 0.15, "east": -0.1}, "day 2": {"north": -0.1, "east": 0.1}}
    day_of = {name: f"day {1 + k % 2}" for k, name in enumerate(sorted(TUNING))}
    write(simulate({}, {}, seed=3, of_trial={name: {"current": waters[day_of[name]]} for name in TUNING}), tmp_path)
    trials = [replace(one, group=day_of[one.id]) for one in load_trials(tmp_path).trials.values() if one.id in TUNING]
    (plain,) = (
        Hypothesis(find_effect("current"), one) for one in find_effect("current").variants if one == ("north", "east")
    )
    finest, days = of_runs([plain], trials)
    options = DiagnoseOptions(effects=("current",), targets=FEW)
    names = list(plain.names)
    bench = make_workbench(load_profile("suzaku"), trials, options, names)
    base = base_fit(bench)
    start = np.concatenate([base.unit, bench.null(finest.names)])
    spreads = {f"{base}@trial": 0.05 for base in finest.bases}
    point = bench.refit((*base.names, *finest.names), start[:, None], base.offsets, spreads=spreads)
    found = Found(base, point, [finest])
    search._make_plain(bench, found, [plain, finest, days])
    assert found.causes == [days]
    values = bench.values(found.final)
    assert values["effects.current.north@group:day 1"] == pytest.approx(0.15, abs=0.01)
    assert values["effects.current.east@group:day 2"] == pytest.approx(0.1, abs=0.01)
