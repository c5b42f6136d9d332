"""Logs of ships with several rudders, propellers and thrusters: inputs are mapped by their names, whatever there is."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mmgtune.importing import import_logs, parse_map, propose_map
from mmgtune.importing.proposing.words import of_starboard
from mmgtune.trial import check_trial, read_trial
from mmgtune.units import DEG
from tests.importing.made import MAP, imported, logged, refusal, said, turn, write_csv

TWIN = MAP.replace(
    'delta = { column = "rudder", unit = "deg", positive = "starboard" }',
    """delta_port = { column = "port rudder", unit = "deg" }
delta_stbd = { column = "starboard rudder", unit = "deg", positive = "port" }
n_bow = { column = "bow", unit = "rpm", positive = "starboard" }""",
).replace(
    'n = { column = "shaft", unit = "rpm" }\n', 'n_port = { value = "100 rpm" }\nn_stbd = { value = "104 rpm" }\n'
)


def twin_columns() -> dict[str, np.ndarray]:
    """A zigzag with the port rudder 1 deg ahead of the other, which counts to port in the log; a thruster at rest."""
    columns = logged(turn())
    rudder = columns.pop("rudder")
    del columns["shaft"]
    return columns | {
        "port rudder": rudder + 1.0,
        "starboard rudder": -rudder,
        "bow": np.where(columns["time"] > 300.0, 120.0, 0.0),
    }


def test_rudders_and_propellers_give_their_mean(tmp_path: Path) -> None:
    log = write_csv(tmp_path / "twin.csv", twin_columns())
    trial, truth = imported(log, TWIN), turn()
    assert np.abs(trial.extra["delta_stbd"] - truth.delta).max() < 1e-9
    assert np.abs(trial.extra["delta_port"] - truth.delta - DEG).max() < 1e-9
    assert np.abs(trial.delta - truth.delta - 0.5 * DEG).max() < 1e-9
    assert np.abs(trial.n - 1.7).max() < 1e-12
    assert trial.extra["n_bow"][-1] == pytest.approx(2.0)
    assert np.isfinite(trial.inputs(["n_port", "n_stbd", "delta_port", "delta_stbd", "n_bow"])).all()
    report = said(log, TWIN)
    assert "'delta', rudder angle: the mean of delta_port and delta_stbd" in report
    assert "'n', propeller revolutions: the mean of n_port and n_stbd" in report
    assert "delta_port: a positive angle of the log turns the ship to starboard, as the motion shows" in report
    assert "port rudder angle up to 2.3 deg/s" in report
    assert "bow thruster revolutions up to 120 rpm/s" in report


def test_each_rudder_has_a_sign_of_its_own(tmp_path: Path) -> None:
    log = write_csv(tmp_path / "twin.csv", twin_columns())
    trial = imported(log, TWIN.replace(', positive = "port"', ""))
    assert np.abs(trial.extra["delta_stbd"] - turn().delta).max() < 1e-9
    still = twin_columns() | {"port rudder": np.zeros(400)}
    said_so = refusal(lambda: said(write_csv(tmp_path / "still.csv", still), TWIN))
    assert "does a positive port rudder angle, 'delta_port', turn the ship to starboard or to port?" in said_so
    assert "[columns.delta_port]" in said_so


@pytest.mark.parametrize("name", ["port rudder", "starboard rudder", "bow"])
def test_a_hole_in_any_mapped_input_cuts_the_log(tmp_path: Path, name: str) -> None:
    columns = twin_columns()
    columns[name] = np.where((columns["time"] > 200.0) & (columns["time"] < 230.0), np.nan, columns[name])
    text = TWIN.replace('"port rudder", unit = "deg" }', '"port rudder", unit = "deg", positive = "starboard" }')
    result = import_logs([write_csv(tmp_path / "twin.csv", columns)], parse_map(text), tmp_path / "out")
    assert len(result.trials) == 2
    for trial in result.trials:
        assert np.isfinite(read_trial(tmp_path / "out" / f"{trial.id}.parquet").inputs(["delta_port", "n_bow"])).all()


def test_a_turning_thruster_keeps_the_tail(tmp_path: Path) -> None:
    """``to = "last-order"`` drops what no input drives, and a thruster is one."""
    columns = logged(turn())
    idle = columns["time"] > 250.0
    columns |= {name: np.where(idle, 0.0, columns[name]) for name in ("shaft", "rudder")}
    columns["bow"] = np.where(columns["time"] < 330.0, 120.0, 0.0)
    text = MAP + '[cut]\nto = "last-order"\n'
    assert imported(write_csv(tmp_path / "one.csv", columns), text).duration == 250.0
    text = text.replace("[cut]", 'n_bow = { column = "bow", unit = "rpm" }\n[cut]')
    assert imported(write_csv(tmp_path / "two.csv", columns), text).duration == 329.0


def test_one_rudder_of_two_is_not_the_rudder() -> None:
    text = TWIN.replace('delta_stbd = { column = "starboard rudder", unit = "deg", positive = "port" }\n', "")
    assert "no column is named for 'delta'" in refusal(lambda: parse_map(text))


def test_checks_go_over_every_input() -> None:
    """A trial whose further inputs are wrong says so by their names; one that is right says nothing."""
    trial = turn()
    right = {"delta_port": trial.delta, "delta_stbd": trial.delta, "n_port": trial.n, "n_bow": 2.0 + 0.0 * trial.t}

    def warned(**wrong: np.ndarray) -> list[tuple[str, str]]:
        found = check_trial(replace(trial, extra=right | wrong))
        return [(one.where.rpartition("column ")[2], one.what) for one in found if one.severity == "warning"]

    assert warned() == []
    assert warned(delta_port=-trial.delta) == [("'delta_port'", "the ship turns away from its rudder")]
    jumps = 10.0 * DEG * np.sign(np.sin(trial.t / 20.0 + 0.1))
    assert any(one[0] == "'delta_stbd'" and "the rudder moves at" in one[1] for one in warned(delta_stbd=jumps))
    assert warned(n_port=60.0 * trial.n) == [("'n_port'", "102 revolutions per second at 2.76 m/s")]
    assert warned(n_bow=np.full(400, 120.0)) == [("'n_bow'", "up to 120 revolutions per second")]
    gap = np.where(trial.t == 7.0, np.nan, 2.0)
    assert warned(n_bow=gap) == [("'n_bow', row 7", "'n_bow' is no number in 1 rows")]


NEW = """
from mmgtune.inputs import INPUTS, Input
INPUTS["delta_bow"] = Input("delta_bow", "rad", "bow rudder angle", "rudder")
from mmgtune.importing import import_logs, parse_map, propose_map
from mmgtune.importing.proposing.words import of_starboard
text, log = open("map.toml").read(), "log.csv"
trial, = import_logs([log], parse_map(text), "out").trials
print(float(trial.extra["delta_bow"].max()), [*trial.extra])
from mmgtune.trial import read_trial
read_trial("out/log.parquet").inputs(["n", "delta_bow"])
"""


def test_an_input_is_one_entry(tmp_path: Path) -> None:
    """What is in ``inputs.INPUTS`` can be imported, checked, stored and read without another edit."""
    columns = logged(turn()) | {"bow rudder": logged(turn())["rudder"]}
    write_csv(tmp_path / "log.csv", columns)
    line = 'delta_bow = { column = "bow rudder", unit = "deg", positive = "starboard" }\n'
    (tmp_path / "map.toml").write_text(MAP + line, encoding="utf-8")
    ran = subprocess.run([sys.executable, "-c", NEW], cwd=tmp_path, capture_output=True, text=True)
    assert ran.returncode == 0, ran.stderr
    assert ran.stdout.split(" ", 1)[1].strip() == "['delta_bow']"
    assert float(ran.stdout.split()[0]) == pytest.approx(float(turn().delta.max()))


@pytest.mark.parametrize(
    ("name", "quantity", "hundred"),
    [
        ("RPM [%]", "n", 120.0),
        ("Drehzahl (% MCR)", "n", 120.0),
        ("shaft speed %", "n", 120.0),
        ("Rudder [%]", "delta", 35.0),
        ("rudder_pct", "delta", 35.0),
    ],
)
def test_what_is_in_percent_is_asked_what_a_hundred_are(
    tmp_path: Path, name: str, quantity: str, hundred: float
) -> None:
    """Revolutions of 89 % of the largest were imported as 89 rpm without a word."""
    own = {"n": "shaft", "delta": "rudder"}[quantity]
    columns = {name if one == own else one: values for one, values in logged(turn()).items()}
    columns[name] = 100.0 * columns[name] / hundred
    log = write_csv(tmp_path / "log.csv", columns)
    proposal = propose_map([log])
    assert proposal.asks == (f"columns.{quantity}.scale",)
    assert f"% of '{name}'?" in proposal.text
    question = next(line for line in proposal.text.splitlines() if f"% of '{name}'?" in line)
    before, _, rest = question.partition("scale = ")
    answered = f"{before}scale = {hundred / 100.0}{rest[rest.index('?' + chr(34)) + 2 :]}"
    trial = imported(log, proposal.text.replace(question, answered))
    assert getattr(trial, quantity) == pytest.approx(getattr(turn(), quantity), abs=1e-6)
    by_hand = MAP.replace(f'column = "{own}"', f'column = "{name}"')
    assert "is in percent, as its header says" in refusal(lambda: imported(log, by_hand))
    beside = 'unit = "rpm"' if quantity == "n" else 'unit = "deg"'
    imported(log, by_hand.replace(beside, f'{beside}, header_says = "%"'))


@pytest.mark.parametrize(
    ("port", "starboard"), [("Rudder P [deg]", "Rudder S [deg]"), ("Ruder BB [deg]", "Ruder StB [deg]")]
)
def test_two_rudders_are_told_by_their_letters(tmp_path: Path, port: str, starboard: str) -> None:
    """That to starboard was taken for the rudder, and the other one asked about."""
    columns = logged(turn())
    rudder = columns.pop("rudder")
    log = write_csv(tmp_path / "log.csv", columns | {port: rudder + 1.0, starboard: rudder})
    proposal = propose_map([log])
    assert {name: guess.column for name, guess in proposal.guesses.items() if name.startswith("delta")} == {
        "delta_port": len(columns),
        "delta_stbd": len(columns) + 1,
    }


def test_a_header_with_a_unit_is_not_in_percent(tmp_path: Path) -> None:
    columns = {"RPM (100 % = 120) [rpm]" if one == "shaft" else one: of for one, of in logged(turn()).items()}
    proposal = propose_map([write_csv(tmp_path / "log.csv", columns)])
    assert proposal.asks == ()
    assert imported(tmp_path / "log.csv", proposal.text).n == pytest.approx(turn().n)


def test_an_s_stands_for_starboard_beside_a_p_alone() -> None:
    assert of_starboard(["rudder s", "n_p", "n_s"], ["delta", "n_port", "n"]) == [2]
