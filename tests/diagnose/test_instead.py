"""What one cause would do in the place of re-tuning, and causes that lose parameters that earn nothing."""

import importlib
import re

import numpy as np
import pytest

from mmgtune.diagnose.bench.hypotheses import Hypothesis, hypotheses
from mmgtune.diagnose.bench.workbench import make_workbench
from mmgtune.diagnose.searching.base_fit import base_fit
from mmgtune.diagnose.searching.instead import Instead, instead_of_tuning
from mmgtune.diagnose.searching.search import Found
from mmgtune.effects import find_effect
from mmgtune.options import DiagnoseOptions
from mmgtune.profile import load_profile
from mmgtune.trial import load_trials
from tests.hidden.cases import draw_ship
from tests.hidden.plant import TUNING, WHITE, simulate, write

search = importlib.import_module("mmgtune.diagnose.searching.search")  # the package has a function of that name

TAGS = ("shallow-water", "loading", "rudder-gain", "rpm-scale", "current", "resistance")
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
