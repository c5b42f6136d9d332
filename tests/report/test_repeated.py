"""Manoeuvres that models repeat, in the reports of what the program itself writes."""

from __future__ import annotations

import json
from pathlib import Path

from mmgtune.fitting import LeaveOutOptions, leave_out, write_left_out
from mmgtune.options import ValidateOptions
from mmgtune.recording import write_validation
from mmgtune.repeating import document, repeat
from mmgtune.report import render, repeated
from mmgtune.report.blocks import Nothing, Table
from mmgtune.trial import load_trials
from mmgtune.validating import validate


def test_of_a_validation(tmp_path: Path) -> None:
    data = load_trials("suzaku")
    result = validate(["suzaku", "suzaku_fam"], data, ValidateOptions(manoeuvres=True))
    write_validation(result, tmp_path)
    render(tmp_path)
    page = (tmp_path / "report.md").read_text(encoding="utf-8")
    _, _, told = page.partition("## Manoeuvres repeated")
    measured, first, second = (
        f"{values['advance_over_L']:.2f}"
        for one in [next(one for one in result.profiles[0].repeated if one.id == "turn_p35")]
        for other in [next(one for one in result.profiles[1].repeated if one.id == "turn_p35")]
        for values in (one.measured, one.simulated, other.simulated)
    )
    row = rf"| turn\_p35 | advance \[L\] | {measured} | {first} | {second} |"
    assert row in told
    assert r"turn\_p35: 35 deg to starboard; " in told
    assert r"| trial | index | measured | suzaku | suzaku\_fam |" in told
    errors = document(result.profiles[0].repeated)["errors"]["overshoot_1_deg"]
    assert f"| 1st overshoot | 2 | +{errors['mean']:.1f}° | {errors['rms']:.1f}° |" in told
    assert (tmp_path / "report.html").read_text(encoding="utf-8").count('id="repeated-table"') == 1


def test_of_trials_left_out(tmp_path: Path) -> None:
    options = LeaveOutOptions(a_r=0.3, starts=1, targets=("hull.R_0",), folds=2, manoeuvres=True)
    write_left_out(leave_out("suzaku", "suzaku", options), tmp_path)
    render(tmp_path)
    _, _, told = (tmp_path / "report.md").read_text(encoding="utf-8").partition("## Manoeuvres repeated")
    assert "| measured | before tuning | tuned to the others |" in told
    found = json.loads((tmp_path / "leave_out.json").read_text(encoding="utf-8"))["manoeuvres"]["left_out"]
    last = found["runs"][-1]["simulated"]["tactical_diameter_over_L"]
    assert f"| {last:.2f} |" in told


def test_where_there_are_none() -> None:
    assert repeated.section({"suzaku": None}) is None
    empty = repeated.section({"suzaku": document([])})
    assert empty is not None
    assert isinstance(empty.blocks[0], Nothing)


def test_members_are_told_by_their_mean() -> None:
    runs = [one for one in document(repeat("suzaku", [load_trials("suzaku").trials["turn_p35"]]))["runs"]]
    other = {**runs[0], "member": 1, "simulated": {**runs[0]["simulated"], "advance_over_L": 9.0}}
    lost = {**runs[0], "member": 2, "simulated": None}
    section = repeated.section({"ship": {"runs": [{**runs[0], "member": 0}, other, lost], "errors": {}}})
    assert section is not None
    table = section.blocks[-1]
    assert isinstance(table, Table)
    assert [row[0].text for row in table.rows] == ["turn_p35"] * 4
    assert table.rows[0][-1].text == f"{0.5 * (runs[0]['simulated']['advance_over_L'] + 9.0):.2f}"
