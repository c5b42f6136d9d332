"""What a check found: one object that every renderer reads."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Literal

from ..displayed import Displayed
from ..documents import finite
from ..errors import Problem
from ..metrics import METRICS
from ..phrases import counted
from ..profile.doubts import Doubt

Status = Literal["ok", "improved", "regressed", "not comparable", "not shown"]
Verdict = Literal["pass", "regressed", "not comparable"]

ORDER: tuple[Status, ...] = ("regressed", "not comparable", "improved", "not shown", "ok")
"""From what needs most attention to what needs none."""


@dataclass(frozen=True)
class Item:
    """One metric of one trial; ``metric`` is "" where the whole trial cannot be compared.

    baseline, now  its value then and now, in the metric's unit; inf where the simulation diverged or did not get there
    allowed        the largest size of ``now`` that passes, None where nothing limits it
    reason         in words, where the numbers do not say it
    """

    trial: str
    metric: str
    baseline: float | None
    now: float | None
    allowed: float | None
    status: Status
    reason: str = ""

    @property
    def words(self) -> str:
        """What people call the metric."""
        return METRICS[self.metric].words if self.metric else "trial"

    @property
    def unit(self) -> str:
        """Unit of the numbers, "" where they are pure or mixed."""
        unit = METRICS[self.metric].unit if self.metric else ""
        return "" if unit in ("-", "mixed") else unit

    @property
    def change(self) -> float | None:
        """Change of size as a share of the size it had; None where there is nothing to compare."""
        if self.baseline is None or self.now is None or not abs(self.baseline) > 0.0 or math.isinf(self.baseline):
            return None
        return abs(self.now) / abs(self.baseline) - 1.0

    @property
    def severity(self) -> float:
        """Size over what is allowed; inf where nothing can be said."""
        if self.now is None or not self.allowed:
            return math.inf
        return abs(self.now) / self.allowed

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "trial": self.trial,
            "metric": self.metric,
            "unit": self.unit,
            "baseline": finite(self.baseline),
            "now": finite(self.now),
            "allowed": finite(self.allowed),
            "change": finite(self.change),
            "status": self.status,
            "reason": self.reason,
        }


@dataclass(frozen=True)
class Changed:
    """A coefficient that is not what it was in the baseline.

    baseline, now  in the unit of the profile; None where the coefficient is new, or gone
    line   of the profile's file, None where it stands on none
    share  of what J got worse by that is undone by this coefficient's old value alone, None where J did not
    """

    name: str
    baseline: float | None
    now: float | None
    line: int | None
    share: float | None

    def to_dict(self) -> dict[str, Any]:
        """For JSON; a coefficient at infinity is null, as is one that there is not, which ``only`` says."""
        only = "now" if self.baseline is None else "baseline" if self.now is None else None
        return {**self.__dict__, "baseline": finite(self.baseline), "now": finite(self.now), "only": only}

    def __str__(self) -> str:
        if self.baseline is None or self.now is None:
            return f"{self.name}: " + (f"new, {self.now:g}" if self.now is not None else f"gone, was {self.baseline:g}")
        text = f"{self.name}: {self.baseline:g} -> {self.now:g}"
        if self.baseline and math.isfinite(self.baseline) and math.isfinite(self.now):
            text += f" ({100.0 * (self.now / self.baseline - 1.0):+.3g} %)"
        if self.share is not None and self.share >= 0.005:
            part = f"{100.0 * self.share:.0f} %" if self.share < 1.0 else "all"
            text += f", its old value undoes {part} of the loss in J"
        return text


@dataclass(frozen=True)
class CheckReport(Displayed):
    """The outcome of a check.

    profile, trials, baseline  as given: path or name; baseline None where only limits count
    profile_file  its path, "" where it has none
    sha256    of the profile
    items     in the order of trials and metrics; none where nothing could be run
    changed   coefficients that differ from the baseline's, the most responsible first
    notes     what else is worth knowing and fails nothing
    problems  why nothing could be run
    made_by, integrator, substeps, backend  how
    doubts    which of the profile's numbers may be wrong
    orders    what trials ordered, see ``simulation.orders_of``
    """

    written_by = "write_check"

    profile: str
    trials: str
    baseline: str | None
    profile_file: str
    sha256: str
    items: tuple[Item, ...]
    changed: tuple[Changed, ...]
    notes: tuple[str, ...]
    problems: tuple[Problem, ...]
    made_by: str
    integrator: str
    substeps: int
    backend: str
    wall_s: float
    doubts: tuple[Doubt, ...] = ()
    orders: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)

    @cached_property
    def by_status(self) -> Mapping[Status, list[Item]]:
        """Items by status, the most severe first, in the order of ORDER."""
        found: dict[Status, list[Item]] = {status: [] for status in ORDER}
        for item in self.items:
            found[item.status].append(item)
        return {status: sorted(of, key=lambda item: -item.severity) for status, of in found.items()}

    def __repr__(self) -> str:
        """In a line."""
        return f"CheckReport({self.profile[-60:]} on {self.trials[-60:]}: {self.verdict})"

    @property
    def verdict(self) -> Verdict:
        """A regression is one even where other trials cannot be compared."""
        if self.by_status["regressed"]:
            return "regressed"
        return "not comparable" if self.problems or self.by_status["not comparable"] else "pass"

    @property
    def trial_ids(self) -> list[str]:
        """Ids of the trials, in order."""
        return list(dict.fromkeys(item.trial for item in self.items))

    @property
    def n_compared(self) -> int:
        """Metrics that were compared with something."""
        return sum(item.status in ("ok", "improved", "regressed") for item in self.items)

    def sentence(self) -> str:
        """The verdict, as the last line of a log."""
        if self.problems:
            return f"COULD NOT RUN  {self.problems[0].what}"
        bad, odd = self.by_status["regressed"], self.by_status["not comparable"]
        n_trials = counted(len(self.trial_ids), "trial")
        if bad:
            trials = len({item.trial for item in bad})
            text = (
                f"FAIL  {len(bad)} of {self.n_compared} metrics regressed, in {trials} of {n_trials}."
                f" Worst: {bad[0].words} of {bad[0].trial}."
            )
            return text + (f" {len(odd)} could not be compared." if odd else "")
        if odd:
            trials = len({item.trial for item in odd})
            return f"NOT COMPARABLE  {trials} of {n_trials}: {odd[0].trial}: {odd[0].reason}."
        better = len(self.by_status["improved"])
        improved = f", {better} of them better" if better else ""
        return f"pass  {self.n_compared} metrics of {n_trials}{improved}."

    @property
    def next(self) -> str:
        """The command that tells more, "" where there is nothing to ask."""
        if self.verdict == "regressed":
            return f"mmgtune diagnose -p {self.profile} -t {self.trials}"
        if self.baseline and not self.problems and (self.verdict == "not comparable" or self.by_status["improved"]):
            return f"mmgtune check {self.profile} {self.trials} --baseline {self.baseline} --update-baseline"
        return ""

    def to_dict(self) -> dict[str, Any]:
        """For JSON; what is infinite or absent is null."""
        return {
            "schema": 1,
            "kind": "check",
            "verdict": self.verdict,
            "sentence": self.sentence(),
            "profile": self.profile,
            "profile_sha256": self.sha256,
            "trials": self.trials,
            "baseline": self.baseline,
            "made_by": self.made_by,
            "integrator": self.integrator,
            "substeps": self.substeps,
            "backend": self.backend,
            "counts": {status: len(of) for status, of in self.by_status.items()},
            "orders": {id: dict(order) for id, order in self.orders.items()},
            "items": [item.to_dict() for item in self.items],
            "changed": [one.to_dict() for one in self.changed],
            "notes": list(self.notes),
            "doubts": [one.to_dict() for one in self.doubts],
            "problems": [problem.to_dict() for problem in self.problems],
            "next": self.next,
            "wall_s": self.wall_s,
        }
