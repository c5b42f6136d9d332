"""Whether a trial can be used, and what is odd about it."""

from __future__ import annotations

import difflib

import numpy as np

from ..model import Trial
from ..schema import OPTIONAL, known_column
from ..unusable import unusable
from .control_checks import control_findings
from .control_clock import clock_findings
from .cross_checks import cross_findings
from .finding import SEVERITIES, Finding
from .motion_checks import CONTRADICTED, motion_findings, sway_findings
from .saturation import saturation_findings
from .sensor_ends import ends_of
from .standing import standing_findings
from .surroundings_checks import surroundings_findings
from .swell import swell_findings
from .wind_checks import wind_findings

__all__ = ["Finding", "check_trial"]


def check_trial(trial: Trial, L_pp: float | None = None, *, usable: bool = False) -> list[Finding]:
    """Everything a user should know about a trial, worst first.

    L_pp    of the ship [m], where it is known: speeds and revolutions are then held against it
    usable  whether it is known already that the trial can be used, as ``unusable`` says

    Where there are errors the trial cannot be used, and nothing but them is reported: ``read_trial`` raises them as
    TrialError, so they are seen here only for trials made in memory.
    """
    where = str(trial.path or trial.id)
    errors = [] if usable else unusable(trial.columns, where)
    if errors:
        return [Finding("error", problem.what, problem.where, problem.why, problem.fix) for problem in errors]
    with np.errstate(all="ignore"):
        motion = motion_findings(trial, where)
        contradicted = any(one.code == CONTRADICTED for one in motion)
        ends = ends_of([trial])
        follows = {"yaw-rate": "r", CONTRADICTED: "u"}  # what the end of a sensor is the reason of
        motion = [one for one in motion if follows.get(one.code) not in ends]
        found = [
            *sway_findings(trial, where),
            *standing_findings(trial, where),
            *saturation_findings(trial, where, ends),
            *motion,
            *swell_findings(trial, where, L_pp),
            *control_findings(trial, where),
            *clock_findings(trial, where),
            *cross_findings(trial, where, L_pp, contradicted, ends),
            *surroundings_findings(trial, where),
            *wind_findings(trial, where),
            *_facts(trial, where),
        ]
    return sorted(found, key=lambda finding: SEVERITIES.index(finding.severity))


def _facts(trial: Trial, where: str) -> list[Finding]:
    """Notes: neither good nor bad."""
    found = []
    dt = np.diff(trial.t)
    if dt.max() > 1.01 * dt.min():
        found.append(Finding("note", f"the time step varies between {dt.min():.4g} and {dt.max():.4g} s", where))
    for name in trial.extra:
        near = [] if known_column(name) else difflib.get_close_matches(name, list(OPTIONAL), n=1, cutoff=0.8)
        if near:
            found.append(
                Finding(
                    "note",
                    f"column '{name}' is not known to the program",
                    f"{where}, column '{name}'",
                    "it is kept, but nothing uses it",
                    f"rename it if it is meant to be '{near[0]}' [{OPTIONAL[near[0]].unit}]",
                )
            )
    for name in trial.ignored:
        found.append(Finding("note", f"column '{name}' holds no numbers and is ignored", f"{where}, column '{name}'"))
    if trial.path is not None and not trial.sealed:
        found.append(
            Finding(
                "note",
                "the file holds no digest of its data",
                where,
                "damage that leaves readable numbers would not be noticed",
                "write it with mmgtune.trial.write_trial, which adds one",
            )
        )
    if trial.source == "generated":
        found.append(Finding("note", "generated, not measured", where))
    elif not trial.source:
        fix = "write the metadata key 'source'"
        found.append(Finding("note", "the file does not say whether it was measured", where, fix=fix))
    return found
