"""Run folders of every kind of report, written by the library's own functions where that takes a moment."""

from __future__ import annotations

import json
import math
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from mmgtune.checking import check, update_baseline
from mmgtune.comparing_models import CompareModelsOptions, compare_models, write_model_comparison
from mmgtune.comparing_profiles import write_comparison
from mmgtune.diagnose import DiagnoseOptions, diagnose, write_diagnosis
from mmgtune.errors import Problem
from mmgtune.fitting import Information, LeaveOutOptions, leave_out, write_left_out
from mmgtune.fleet import rows
from mmgtune.fleet.commands import Facts
from mmgtune.fleet.job import Job, Source
from mmgtune.fleet.record import write_record
from mmgtune.model import Model
from mmgtune.options import SimulateOptions, ValidateOptions
from mmgtune.predicting import predict, write_prediction
from mmgtune.profile import load_profile
from mmgtune.provenance import made_by
from mmgtune.recording import write_simulation, write_validation
from mmgtune.run_files import INFORMATION, JOBS
from mmgtune.simulating import simulate
from mmgtune.trial import Trial, load_trials
from mmgtune.trial.schema import ATTRIBUTES
from mmgtune.validating import validate
from tests.hidden.cases import single
from tests.hidden.plant import simulate as sail
from tests.hidden.plant import write as write_trials
from tests.predicting.test_predict import scattered, two_trials
from tests.test_comparing_profiles import known

from . import fake_run


def make(base: Path) -> dict[str, Path]:
    """Run folders by name, none of them rendered yet."""
    found = {name: base / name for name in (*HOW, "nothing", "unexplained")}
    for name, how in HOW.items():
        found[name].mkdir()
        how(found[name])
    for name, edit in (("nothing", _nothing), ("unexplained", _unexplained)):
        shutil.copytree(found["diagnosis"], found[name], ignore=shutil.ignore_patterns("trials"))
        _edited(found[name] / "diagnosis.json", edit)
    return found


def _diagnosis(folder: Path) -> None:
    case = single("current", 2, seed=1)
    sailed = sail(case.ship, case.effects, case.seed, case.noise)
    write_trials([_thin(trial) for trial in sailed], folder / "trials")
    options = DiagnoseOptions(effects=("current", "rudder-offset"))
    data = load_trials(folder / "trials")
    document = write_diagnosis(diagnose(load_profile("suzaku"), data, options), folder)
    assert document["verdict"] == "found"


def _thin(trial: Trial) -> Trial:
    """Every third sample, which is plenty for a page."""
    return replace(trial, **{channel: getattr(trial, channel)[::3] for channel in ATTRIBUTES.values()})


def _nothing(data: dict[str, Any]) -> None:
    data |= {"verdict": "none", "causes": [], "sentence": "Nothing is wrong beyond the noise of the measurements."}
    data["unexplained"] |= {"structured": False, "share_of_noise_variance": -0.0004}
    for row in data["candidates"]:
        row |= {"gain": 5.0, "p_value": 0.73}


def _unexplained(data: dict[str, Any]) -> None:
    data["unexplained"] |= {
        "structured": True, "share_of_noise_variance": 18966340.25, "best_known": data["causes"],
        "largest_share_by_one_quantity": {"psi": {"quantity": "heading", "share": -0.0004}},
    }  # fmt: skip
    data |= {"verdict": "unexplained", "causes": [], "sentence": "Something is wrong that this program does not know."}


def _leave_out(folder: Path) -> None:
    options = LeaveOutOptions(a_r=0.3, starts=1, targets=("hull.R_0", "wake.w_P0"))
    write_left_out(leave_out("suzaku", "suzaku", options), folder)


def _validate(folder: Path) -> None:
    data = load_trials("suzaku")
    result = validate(["suzaku", "suzaku_fam"], data, ValidateOptions())
    write_validation(result, folder, "mmgtune validate suzaku suzaku_fam suzaku")


def _simulate(folder: Path) -> None:
    result = simulate("suzaku", None, SimulateOptions(turn=("35",), zigzag=("10/10",)))
    result.write(folder)
    write_simulation(result, folder, "mmgtune simulate --turn 35 --zigzag 10/10 --out run")


def _trials(folder: Path) -> None:
    result = simulate("suzaku", two_trials(), SimulateOptions())
    result.write(folder)
    write_simulation(result, folder, "mmgtune simulate --trials suzaku --out run")


def _check(folder: Path) -> None:
    baseline = folder / "base.json"
    update_baseline("suzaku", "suzaku", baseline)
    report = check("suzaku_fam", "suzaku", baseline)
    (folder / "checked.json").write_text(json.dumps({**report.to_dict(), **made_by("mmgtune check")}), encoding="utf-8")


def _predict(folder: Path) -> None:
    write_prediction(predict(scattered(Model(load_profile("suzaku")), 20), trials=two_trials()), folder)


def _plan(folder: Path) -> None:
    """A plan by hand: the program's own takes particles of a posterior."""
    names = (("turn_m35", "turn, 35 deg to port"), ("zigzag_p20_20", "zigzag 20/20, starboard first"))
    trials = [
        {
            "id": id, "kind": "turn", "trial": words, "duration_s": 500.0, "half_width_after": 6.0 + k,
            "shrinks": 0.4 - k / 9,
        }
        for k, (id, words) in enumerate(names)
    ]  # fmt: skip
    data = {
        "schema": 1, "kind": "plan", "model": "runs/bands", "ship": "suzaku", "sha256": "ab", "linear_share": 0.9,
        "question": {"text": "advance, turn 35", "asked": "turn 35", "index": "advance_m", "words": "advance",
                     "unit": "m", "order": "turn with 35 deg of rudder to starboard", "mean": 250.0, "half_width": 10.0,
                     "particles": 20},
        "trials": trials, "left_out": ["spiral: the ship leaves what the model can do"], "notes": ["a note"],
        "options": {"level": 90.0}, "wall_s": 1.0,
        "provenance": {"command": "mmgtune plan runs/bands -q 'advance, turn 35' --out run", "mmgtune": "1",
                       "created": "2026-01-01"},
    }  # fmt: skip
    (folder / "plan.json").write_text(json.dumps(data), encoding="utf-8")


def _compare(folder: Path) -> None:
    write_comparison(known("suzaku", "suzaku_fam"), folder)


def _compare_models(folder: Path) -> None:
    options = CompareModelsOptions(restart=100.0)
    write_model_comparison(compare_models(["suzaku", "suzaku_fam"], two_trials(), options), folder)


def _learning(folder: Path) -> None:
    """A training by hand: the program's own takes an extra that may not be installed."""
    motion = fake_run.motion(20.0, 200, 190.0, 3.1, 20.0)
    columns = {"north_m": "x", "east_m": "y", "psi_rad": "psi", "u_m_s": "u", "v_m_s": "v_m", "r_rad_s": "r"}
    shown = {name: motion[state].tolist() for name, state in columns.items()}
    score = {"L_MSE": 0.4, "L_MSE_by_state": dict.fromkeys(("x", "y", "psi", "u", "v_m", "r"), 0.07), "runs": 2}
    curve = [{"step": step, "loss": 9.0 / step, "score": 4.0 / step} for step in (100, 200, 300)]
    data = {
        "schema": 1, "kind": "learning", "type": "1", "ship": "suzaku", "recipe": "type 1 of the paper",
        "interrupted": False, "window_s": 100.0, "step_s": 1.0, "memory": None, "width": 64, "inputs": ["n", "delta"],
        "learned_from": ["turn_p10"], "chosen_by": ["turn_m20"], "held_out": ["turn_p35"], "wall_s": 12.0,
        "sigma": {"x": 200.0, "y": 200.0, "psi": 1.5, "u": 0.8, "v_m": 0.4, "r": 0.01},
        "members": [{"seed": 1, "steps": 300, "loss": 0.03, "score": 0.02, "best_step": 300, "curve": curve,
                     "events": [{"step": 150, "why": "loss", "back_to": 100, "rate_factor": 0.5}]}],
        "scores": {"test": {**score, "trials": ["turn_p35"], "by_manoeuvre": {"turning": score}}},
        "drawn": [{"id": "turn_p35", "manoeuvre": "turning", "L_MSE": 0.4, "t_s": motion["t"].tolist(),
                   "measured": shown, "members": [shown]}],
        "provenance": {
            "trials": {"path": "trials/suzaku", "learned_from": ["turn_p10"], "sources": ["generated"], "licence": "",
                       "citation": ""},
            "profile": {"path": "ship_profiles/suzaku.toml"}, "command": "mmgtune learn type1", "mmgtune": "1",
            "created": "2026-01-01", "options": {"seed": 1},
        },
    }  # fmt: skip
    (folder / "learning.json").write_text(json.dumps(data), encoding="utf-8")


def _fleet(folder: Path) -> None:
    """Results of jobs by hand, put together by the program's own."""
    for k, ship in enumerate(("aa", "bb", "cc", "dd")):
        for month in range(12):
            date = f"2025-{month + 1:02d}"
            logs = Source(f"logs/{ship}/{date}", {})
            job = Job(ship, date, "state", "fit", "", "suzaku", logs, {}, "1", "coasters")
            bent = 2.0 if ship == "bb" and month >= 5 else 0.0
            wave = 0.02 * ((7 * month + 3 * k) % 5 - 2)
            off, row = 3.0 + k + 4.0 * bent + wave, ("effects.rudder-offset.angle", "effects.resistance.factor")
            values = [math.radians(bent + wave), 1.0 + 0.02 * month + wave]
            causes = ("rudder-offset",) if bent and month == 6 else ()
            facts = Facts("no" if causes else "good", "as it is", off, 1.0, 1.0 + wave, 0.5, causes, (), row, values,
                          (0.0, 1.0), (0.001, None), True)  # fmt: skip
            known = rows.made(job, facts, "fit.json", 0.4)
            if (ship, month) == ("cc", 3):
                wrong = Problem("the trials cannot be read", "logs/cc/turn.parquet", "no such file", "look for it")
                known = rows.failed(job, [wrong], 0.1)
            rows.write(folder, job, known)
    one = Job("dd", "2025-12", "look", "diagnose", "", "", Source("", {}), {}, "1")
    rows.write(folder, one, rows.made(one, Facts("good", "nothing"), "diagnosis.json", 2.0))
    told = Information(("hull.R_0",), np.eye(1), np.ones(1), np.full(1, 0.9), np.full(1, 0.2))
    for ship in ("aa", "bb", "cc"):
        (folder / "runs" / ship / "2025-01" / "state").mkdir(parents=True)
        (folder / "runs" / ship / "2025-01" / "state" / INFORMATION).write_text(json.dumps(told.to_dict()))
    (folder / JOBS).write_text(json.dumps({"jobs": [{"key": "0" * 16}]}))
    document = write_record(folder, {**made_by("mmgtune fleet run fleet.toml"), "table": "fleet.toml"})
    assert [one["name"] for one in document["changes"]] == [
        "effects.rudder-offset.angle", "off_track"
    ], document["changes"]  # fmt: skip


def _edited(path: Path, edit: Callable[[dict[str, Any]], None]) -> None:
    data = json.loads(path.read_text(encoding="utf-8"))
    edit(data)
    path.write_text(json.dumps(data), encoding="utf-8")


HOW: dict[str, Callable[[Path], None]] = {
    "diagnosis": _diagnosis, "leave-out": _leave_out, "validate": _validate, "simulate": _simulate, "trials": _trials,
    "check": _check, "predict": _predict, "comparison": _compare, "model-comparison": _compare_models,
    "learning": _learning, "plan": _plan, "fleet": _fleet,
}  # fmt: skip
