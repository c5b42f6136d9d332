"""A report draws the inputs a ship has: two rudders and a thruster as well as one rudder."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq
import pytest

from mmgtune.errors import OptionError
from mmgtune.fitting import FitOptions, fit, write_run
from mmgtune.report import render
from mmgtune.report.figures import motions
from mmgtune.report.load import find
from mmgtune.report.pages.kinds import KINDS
from mmgtune.trial import load_trials
from mmgtune.units import DEG
from tests.twin import sail, twin, with_value

from . import fake_run

pytestmark = pytest.mark.xdist_group("report")

INPUTS = ["n", "delta_port", "delta_stbd", "n_bow"]


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run folder of the twin-rudder ship, with its report."""
    folder = tmp_path_factory.mktemp("twin")
    ship = twin()
    (folder / "trials").mkdir()
    sail(ship, folder / "trials")
    options = FitOptions(method="least-squares", starts=1, targets=("thruster.k",))
    result = fit(with_value(ship.profile, "thruster.k", 1.4e4), load_trials(folder / "trials"), options)
    (folder / "run").mkdir()
    write_run(result, folder / "run")
    render(folder / "run")
    return folder / "run"


def payload_of(folder: Path) -> dict[str, Any]:
    """What the charts of a report are drawn from."""
    text = (folder / "report.html").read_text(encoding="utf-8")
    found = re.search(r'<script type="application/json"[^>]*>(.*?)</script>', text, re.DOTALL)
    assert found
    payload: dict[str, Any] = json.loads(found.group(1))
    return payload


@pytest.mark.long
def test_the_record_names_the_inputs(run: Path) -> None:
    record = json.loads((run / "fit.json").read_text(encoding="utf-8"))
    assert [one["name"] for one in record["inputs"]] == INPUTS
    assert record["inputs"][1] == {
        "name": "delta_port", "unit": "rad", "words": "port rudder angle", "role": "rudder",
    }  # fmt: skip
    columns = pq.read_table(run / "motions.parquet").to_pydict()
    assert [name for name in columns if name not in ("trial", "which", "t", "x", "y", "psi", "u", "v_m", "r")] == INPUTS
    trials, ports = np.array(columns["trial"]), np.array(columns["delta_port"])
    assert set(columns["which"]) == {"measured", "before", "after"}
    assert set(ports[trials == "one"]) == {0.3}
    assert set(ports[trials == "two"]) == {-0.3}


def test_the_page_has_every_input(run: Path) -> None:
    payload = payload_of(run)
    titles = {one["name"]: f"{one['words']} [{one['unit']}]" for one in payload["channels"]}
    assert [title for name, title in titles.items() if name not in ("X", "Y", "N")] == [
        "heading [deg]", "surge velocity [m/s]", "sway velocity [m/s]", "yaw rate [deg/s]",
        "port rudder angle [deg]", "starboard rudder angle [deg]", "propeller revolutions [rpm]",
        "bow thruster revolutions [rpm]",
    ]  # fmt: skip
    one = payload["manoeuvres"][0]["runs"]["measured"]
    for name, value in (("delta_port", 0.3 / DEG), ("delta_stbd", 0.2 / DEG), ("n_bow", 120.0)):
        assert motions.unpacked(one[name]) == pytest.approx(value, abs=0.01)
    svg = (run / "figures" / "histories.svg").read_text(encoding="utf-8")
    for words in ("port rudder angle [deg]", "starboard rudder angle [deg]", "bow thruster revolutions [rpm]"):
        assert words in svg


def test_a_record_that_names_no_inputs_has_one_rudder_and_one_propeller(tmp_path: Path) -> None:
    folder = fake_run.make_fit(tmp_path / "old")
    assert "inputs" not in json.loads((folder / "fit.json").read_text(encoding="utf-8"))
    _, record = find(folder, KINDS)
    assert [channel.title for channel in record.inputs] == ["rudder angle [deg]", "propeller revolutions [rpm]"]  # type: ignore[union-attr]
    render(folder)
    assert [one["name"] for one in payload_of(folder)["channels"]] == ["psi", "u", "v_m", "r", "delta", "n"]


@pytest.mark.parametrize("inputs", ["n", [{"name": "n"}], [3]])
def test_inputs_that_make_no_sense(tmp_path: Path, inputs: object) -> None:
    folder = fake_run.write_fit(tmp_path / "run", *fake_run.edited(inputs=inputs))
    with pytest.raises(OptionError, match='"inputs" is not a list of name, unit, words, role'):
        find(folder, KINDS)


def test_an_input_that_the_motions_lack_is_named(tmp_path: Path) -> None:
    named = [{"name": "delta_port", "unit": "rad", "words": "port <b>rudder</b>", "role": "rudder"}]
    data, history, motions = fake_run.edited(inputs=named)
    folder = fake_run.write_fit(tmp_path / "run", data, history, motions)
    with pytest.raises(OptionError, match="columns lack: delta_port"):
        find(folder, KINDS)
    motions["delta_port"] = np.zeros(len(motions))
    render(fake_run.write_fit(tmp_path / "run", data, history, motions))
    assert [one["words"] for one in payload_of(folder)["channels"]][4] == "port brudder/b"
