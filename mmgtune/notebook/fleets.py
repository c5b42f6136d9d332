"""Runs of fleets: a row a ship and date."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .view import Row, View

if TYPE_CHECKING:
    from ..fleet import FleetPlan, FleetRun


def run(result: FleetRun) -> View:
    """A row a ship, date and job: its answer, and how far its model is off as given and re-tuned."""
    document = result.document
    rows: list[Row] = [
        {
            "ship": cell["ship"],
            "date": cell["date"],
            "job": cell["name"],
            "answer": cell["answer"],
            "off track [m]": cell["off_track"],
            "off heading [deg]": cell.get("off_heading"),
            "re-tuned [m]": cell["tuned_track"],
            "causes": ", ".join(cell["causes"]),
        }
        for cell in document["cells"]
    ]
    changed = [f"{one['ship']}: {_within(one['sentence'])}." for one in document["changes"]]
    failed = []
    for one in document["failures"]:
        why = "; ".join(problem["what"] for problem in one["problems"])
        failed.append(f"{one['ship']}, {one['date']}, {one['name']} failed{': ' * bool(why)}{why}.")
    return View(
        repr(result), changed or ["Nothing changed."], rows, failed, spare=("off heading [deg]", "causes", "job")
    )


def plan(result: FleetPlan) -> View:
    """A row a job, and whether it is done already."""
    rows: list[Row] = [
        {
            "ship": job.ship,
            "date": job.date,
            "job": job.name,
            "command": job.command,
            "trials": job.trials.path,
            "done": "yes" if job.key in result.there else "",
        }
        for job in result.jobs
    ]
    low, high = result.reckoned.seconds
    return View(repr(result), [f"What is left takes about {low:.2g} to {high:.2g} s on one worker."], rows)


def _within(sentence: str) -> str:
    """A sentence as it goes on behind a colon; names of coefficients are small already."""
    return f"{sentence[:1].lower()}{sentence[1:]}"
