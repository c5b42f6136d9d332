"""Which hidden events of generated fleets are found, in which month, and how many false alarms there are.

    python -m tools.fleet_hidden FOLDER [--seeds 1,2] [--out docs/fleet-hidden.json]

Fleets are made in FOLDER (``tools.generate_fleet``) unless they are there, run, and what the report calls a change is
held against what was done to each ship.  A change is right where the quantity is the one that was changed and the true
month lies in the interval, or is off by one month at most; the error of the model off track may follow any event of its
ship.  Anything else is a false alarm.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from mmgtune.files import write_text
from mmgtune.fleet import FleetTable, read_table, record_anew, run_fleet
from tools.generate_fleet import make

QUANTITIES = {
    "docking": "effects.resistance.factor",
    "compass": "effects.heading-bias.angle",
    "rudder": "effects.rudder-offset.angle",
}


def number_of(month: str) -> int:
    """Months since year 0."""
    year, rest = month.split("-")
    return 12 * int(year) + int(rest)


def events_of(truth: Mapping[str, Any]) -> list[dict[str, Any]]:
    """What was done, by ship and month."""
    found = []
    for ship, lot in truth["ships"].items():
        found += [{"ship": ship, "kind": "docking", "month": month} for month in lot["docked"]]
        found += [{"ship": ship, "kind": key, **lot[key]} for key in ("compass", "rudder") if lot[key]]
    return found


def agrees(change: Mapping[str, Any], event: Mapping[str, Any]) -> bool:
    """Whether a change is of the month of an event, or next to it."""
    at = number_of(event["month"])
    inside = number_of(change["after"]) < at <= number_of(change["by"])
    return inside or abs(number_of(change["month"]) - at) <= 1


def judged(document: Mapping[str, Any], truth: Mapping[str, Any]) -> dict[str, Any]:
    """Events with what was found of them, and changes that are none."""
    events, explained = events_of(truth), set()
    for event in events:
        own = [
            (k, one)
            for k, one in enumerate(document["changes"])
            if one["ship"] == event["ship"] and one["name"] == QUANTITIES[event["kind"]] and agrees(one, event)
        ]
        explained |= {k for k, _ in own}
        keys = ("month", "after", "by", "size", "error")
        event["found"] = {key: own[0][1][key] for key in keys} if own else None
    wrong = []
    for k, one in enumerate(document["changes"]):
        follows = one["name"] == "off_track" and any(e["ship"] == one["ship"] and agrees(one, e) for e in events)
        if k not in explained and not follows:
            wrong.append({key: one[key] for key in ("ship", "name", "month", "size", "error", "p")})
    looked = sum(one["course"] is not None for one in document["series"])
    growing = {one["ship"] for one in document["trends"] if one["name"] == QUANTITIES["docking"]}
    return {
        "seed": truth["seed"],
        "ships": len(truth["ships"]),
        "months": truth["months"],
        "series": looked,
        "events": events,
        "false_alarms": wrong,
        "fouling_shown": sorted(growing),
    }


def studied(folder: Path, seed: int) -> dict[str, Any]:
    """One fleet: made, run and judged; what is there already is not made again."""
    own = folder / f"seed-{seed}"
    truth_file = own / "truth.json"
    truth = json.loads(truth_file.read_text(encoding="utf-8")) if truth_file.is_file() else make(own, seed=seed)
    table: FleetTable = read_table(own / "fleet.toml")
    out = own / "out"
    run_fleet(table, out, resume=out.exists(), command="tools/fleet_hidden.py")
    return judged(record_anew(out), truth)


def table_of(fleets: list[dict[str, Any]]) -> str:
    """The result as Markdown."""
    lines = ["| event | there were | found | month right | of size |", "|---|---:|---:|---:|---|"]
    words = {"docking": "docking after fouling", "compass": "compass replaced by a wrong one", "rudder": "rudder bent"}
    for kind, name in words.items():
        events = [event for fleet in fleets for event in fleet["events"] if event["kind"] == kind]
        found = [event for event in events if event["found"]]
        right = sum(event["found"]["month"] == event["month"] for event in found)
        sizes = [abs(event["deg"]) for event in events if "deg" in event]
        size = f"{min(sizes):.1f} to {max(sizes):.1f} deg" if sizes else "3 to 18 % of resistance a year"
        lines.append(f"| {name} | {len(events)} | {len(found)} | {right} | {size} |")
    alarms = sum(len(fleet["false_alarms"]) for fleet in fleets)
    series = sum(fleet["series"] for fleet in fleets)
    lines += ["", f"False alarms: {alarms} in {series} series."]
    return "\n".join(lines)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="Which hidden events of generated fleets are found.")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--seeds", default="1,2")
    parser.add_argument("--out", type=Path, default=Path("docs/fleet-hidden.json"))
    asked = parser.parse_args()
    results = [studied(asked.folder, int(seed)) for seed in asked.seeds.split(",")]
    command = f"python -m tools.fleet_hidden FOLDER --seeds {asked.seeds}"
    write_text(asked.out, json.dumps({"schema": 1, "command": command, "fleets": results}, indent=1) + "\n")
    print(table_of(results))
