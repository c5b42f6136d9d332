"""What stands under headlines: on which terms the numbers of a page hold, and what its words mean."""

from __future__ import annotations

import json
from dataclasses import replace
from html import unescape
from pathlib import Path

import numpy as np
import pytest

from mmgtune.checking import check, update_baseline
from mmgtune.documents import write_json
from mmgtune.fitting import fit, write_run
from mmgtune.model import Model
from mmgtune.motions import order_of, trial_indices
from mmgtune.options import FitOptions, PredictOptions, SimulateOptions
from mmgtune.predicting import predict, write_prediction
from mmgtune.profile import load_profile
from mmgtune.provenance import made_by
from mmgtune.recording import write_simulation, write_validation
from mmgtune.report import approaches, codes, load, render
from mmgtune.report.pages.kinds import KINDS
from mmgtune.simulating import simulate
from mmgtune.trial import load_trials
from mmgtune.validating import validate
from tests.predicting.test_predict import scattered, two_trials

from . import fake_run


def lead(folder: Path) -> str:
    """Of the report of a run folder, which is rendered too."""
    text = unescape(render(folder)[0].read_text(encoding="utf-8"))
    kind, record = load.find(folder, KINDS)
    said = kind.build(record).lead
    assert all(one in text for one in said)
    return " ".join(said)


def test_of_a_prediction_by_orders(tmp_path: Path) -> None:
    options = PredictOptions(turn=("35",), speed="12 kn", rpm="200")
    write_prediction(predict(scattered(Model(load_profile("suzaku")), 20), options=options), tmp_path)
    said = lead(tmp_path)
    assert said.startswith("Approach straight ahead at 6.17 m/s (12 kn) and 200 rpm. All numbers are simulated, none")
    assert "± is half of the band that holds 90 % of 20 particles" in said
    caption = "Indices of turn_p35: turn with 35 deg of rudder to starboard, from 6.17 m/s (12 kn) and 200 rpm"
    assert caption in (tmp_path / "report.html").read_text(encoding="utf-8")


def test_of_a_prediction_on_trials(tmp_path: Path) -> None:
    trials = two_trials()
    write_prediction(predict("suzaku", trials=trials), tmp_path)
    low, high = sorted(float(one.u[0]) for one in trials)
    assert lead(tmp_path).startswith(f"Each run begins as measured, at {low:.3g} to {high:.3g} m/s")
    assert "±" not in lead(tmp_path)


def test_of_a_simulation(tmp_path: Path) -> None:
    result = simulate("suzaku", None, SimulateOptions(turn=("35",), speed="5 m/s"))
    assert result.rows()[0]["approach"] == pytest.approx({"speed_m_per_s": 5.0, "rpm": 106.0})
    write_simulation(result, tmp_path, "")
    assert lead(tmp_path) == (
        "Approach straight ahead at 5 m/s (9.72 kn) and 106 rpm. All numbers are simulated, none is measured."
    )


def test_of_a_check(tmp_path: Path) -> None:
    update_baseline("suzaku", "suzaku", tmp_path / "base.json")
    found = check("suzaku", "suzaku", tmp_path / "base.json")
    write_json({**found.to_dict(), **made_by("mmgtune check")}, tmp_path / "checked.json")
    assert lead(tmp_path).startswith("To pass is to be no worse than the committed baseline, but for its tolerances;")
    text = (tmp_path / "report.md").read_text(encoding="utf-8")
    assert r"- Turning circles, rudder to port: turn\_m10 (10°)," in text
    assert "Nearest to failing" in text
    assert text.splitlines()[2] == "suzaku on suzaku against base.json"


@pytest.mark.long
def test_of_misfits(fit_folder: Path, voyages_folder: Path) -> None:
    assert lead(fit_folder).startswith("The misfit J: squared differences of simulated and measured motion")
    assert lead(voyages_folder).startswith("cVDM, a distance measure of Mathioudakis et al., adds up how far off")


def test_of_a_fit_how_it_was_simulated_stands_below(tmp_path: Path) -> None:
    folder = fake_run.make_fit(tmp_path / "run")
    path = folder / "fit.json"
    data = json.loads(path.read_text(encoding="utf-8"))
    data["verdict"] = "On 4 trials (root mean square); J (rk4, 2 substeps) falls by 99.7 %."
    data["options"] |= {"integrator": "rk4", "substeps": 2}
    path.write_text(json.dumps(data), encoding="utf-8")
    render(folder)
    text = (folder / "report.md").read_text(encoding="utf-8")
    assert text.startswith("# On 4 trials (root mean square); the misfit J falls by 99.7 %.")
    assert "| simulated by | rk4, 2 substeps |" in text


def test_of_a_validation(tmp_path: Path) -> None:
    data = load_trials("suzaku")
    write_validation(validate("suzaku", data), tmp_path)
    assert lead(tmp_path).startswith("The misfit J: squared differences")
    text = (tmp_path / "report.md").read_text(encoding="utf-8")
    assert "root mean square over all samples of 10 trials together" in text
    assert "| suzaku simulated by | rk4 |" in text
    assert r"- *turning circles, rudder to port*: turn\_m10 (10°), turn\_m20 (20°), " in text
    assert r"- *zigzags, rudder first to starboard*: zigzag\_10 (10/10) and zigzag\_20 (20/20)" in text


@pytest.mark.parametrize("id", ["turn_p35", "zigzag_20"])
def test_the_rudder_tells_over_a_gap_what_was_ordered(id: str) -> None:
    whole, L_pp = load_trials("suzaku").trials[id], load_profile("suzaku").L_pp
    x = np.array(whole.x)
    x[200:260] = np.nan
    gap = replace(whole, x=x)
    assert trial_indices(gap, L_pp) == {}
    found, known = order_of(gap, L_pp), order_of(whole, L_pp)
    assert list(found) == list(known)
    assert found["direction"] == known["direction"]
    assert found["rudder_angle_deg"] == pytest.approx(known["rudder_angle_deg"], abs=0.5)  # one is of the name
    if id == "zigzag_20":
        assert (known["heading_angle_deg"], found["heading_angle_deg"]) == (pytest.approx(20.0), None)
        said = order_of(replace(gap, manoeuvre="zigzag 20/10"), L_pp)
        assert (said["rudder_angle_deg"], said["heading_angle_deg"]) == pytest.approx((20.0, 10.0))


def test_a_trial_with_a_gap_stands_in_the_note_of_a_fit(tmp_path) -> None:
    trials = load_trials("suzaku").trials
    x = np.array(trials["turn_p35"].x)
    x[200:260] = np.nan
    own = [replace(trials["turn_p35"], x=x), trials["turn_p10"]]
    options = FitOptions(a_r=0.5, method="least-squares", starts=1, targets=("hull.R_0",))
    write_run(fit("suzaku", own, options), tmp_path)
    text = next(path for path in render(tmp_path) if path.suffix == ".md").read_text()
    assert r"- *turning circles, rudder to starboard*: turn\_p35 (35°) and turn\_p10 (10°)" in text


def test_codes_of_trials() -> None:
    turn = {"rudder_angle_deg": 34.8, "direction": "starboard"}
    odd = {"rudder_angle_deg": 12.4, "direction": "port"}
    zigzag = {"rudder_angle_deg": 20.0, "heading_angle_deg": 10.0, "direction": "port"}
    assert codes.legend({"a": turn, "b": odd, "c": zigzag, "d": {}, "e": {"rudder_angle_deg": 5.0}}) == (
        ("turning circles, rudder to starboard", "a (35°)"),
        ("turning circles, rudder to port", "b (12.4°)"),
        ("zigzags, rudder first to port", "c (20/10)"),
    )
    over_a_gap = {"rudder_angle_deg": 20.0, "heading_angle_deg": None, "direction": "port"}
    assert codes.legend({"a": over_a_gap}) == (("zigzags, rudder first to port", "a (20°)"),)
    older = {"id": "b", "indices": {"measured": odd}}
    assert codes.of_rows([{"id": "a", "order": turn}, older, {"id": "c", "order": {}}]) == (
        ("turning circles, rudder to starboard", "a (35°)"),
        ("turning circles, rudder to port", "b (12.4°)"),
    )
    assert codes.sentences({"a": turn}) == ("Turning circles, rudder to starboard: a (35°).",)


def test_approaches_of_several_runs_and_of_older_records() -> None:
    runs = [{"approach": {"speed_m_per_s": speed, "rpm": 106.0}} for speed in (3.0, 3.1)]
    assert approaches.sentence(runs, ordered=False) == (
        "Each run begins as measured, at 3 to 3.1 m/s (5.83 to 6.03 kn) and 106 rpm."
    )
    assert approaches.sentence([{"approach": None}, {}], ordered=True) == ""
    assert approaches.in_caption({"approach": {"speed_m_per_s": 3.0}}) == ", from 3 m/s (5.83 kn)"
