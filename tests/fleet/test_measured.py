"""Tables of the guide are those of the records that their tools wrote."""

from __future__ import annotations

import json
from typing import Any

from tests.command import ROOT
from tools import fleet_gains, fleet_hidden

GUIDE = (ROOT / "docs" / "guides" / "fleets.md").read_text(encoding="utf-8")


def record(name: str) -> dict[str, Any]:
    """A committed record."""
    found: dict[str, Any] = json.loads((ROOT / "docs" / name).read_text(encoding="utf-8"))
    return found


def test_hidden_events() -> None:
    assert fleet_hidden.table_of(record("fleet-hidden.json")["fleets"]) in GUIDE


def test_gains_of_sisters() -> None:
    found = record("fleet-gains.json")
    assert fleet_gains.table(found) in GUIDE
    assert fleet_gains.summary(
        [{key: _by_count(value) for key, value in row.items()} for row in found["rows"]], 1
    )["trials"] == {int(n): row for n, row in found["trials"].items()}  # fmt: skip


def _by_count(value: Any) -> Any:
    return {int(n): number for n, number in value.items()} if isinstance(value, dict) else value


def test_speed() -> None:
    runs = record("fleet-speed.json")["runs"]
    names = ("plain loop", "2 workers", "Dask, 2 workers", "2 workers, one killed every 20 s")
    assert tuple(runs) == names
    for name, row in runs.items():
        numbers = f"{row['processor_s']:.0f} | {row['wall_s']:.0f} | {row['largest_MB']:.0f} |"
        assert any(line.startswith(f"| {name}") and numbers in line for line in GUIDE.splitlines()), (name, numbers)
    assert all(row["same_numbers"] and row["jobs"] == 200 for row in runs.values())
    assert f"{runs[names[3]]['killed']} killed" in GUIDE
