"""Every trial against the model before and after tuning: J, errors by channel, manoeuvring indices."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..backends import STATES
from ..displayed import Plotted, inert
from ..documents import finite
from ..evaluation import TrialRecord, records
from ..how_far_off import mean
from ..motions import Motion
from ..objective import Objective
from ..phrases import counted, counted_pieces
from ..trial import Trial
from .least_squares import fit_offsets
from .problem import FitProblem

ROLES = ("tune", "test", "other", "left-out")
WHICH = ("before", "after")


@dataclass(frozen=True, eq=False)
class TrialComparison:
    """One trial: its records "before" and "after"; ``role`` is one of ``ROLES``."""

    trial: Trial
    role: str
    records: Mapping[str, TrialRecord]

    @property
    def J(self) -> dict[str, float]:
        """J "before" and "after"; inf where the simulation diverged."""
        return {which: record.J for which, record in self.records.items()}

    @property
    def motions(self) -> dict[str, Motion]:
        """The simulations."""
        return {which: record.motion for which, record in self.records.items()}

    @property
    def rms(self) -> dict[str, dict[str, float]]:
        """Root mean square of the differences by channel, before and after [SI]; NaN for one never measured."""
        return {
            name: {which: record.rms.get(name, np.nan) for which, record in self.records.items()} for name in STATES
        }

    def off(self, which: str) -> tuple[float, float]:
        """Root mean square distance off track [m] and error of heading [deg]; not finite where there is none."""
        x, y, psi = (self.rms[name][which] for name in ("x", "y", "psi"))
        return float(np.hypot(x, y)), float(np.degrees(psi))

    @property
    def closer(self) -> bool:
        """Whether its track comes closer to the measured one, in metres."""
        return self.off("after")[0] < self.off("before")[0]

    @property
    def mixed(self) -> bool:
        """Whether J rises though the track comes closer, as where the heading is further off."""
        return self.J["after"] > self.J["before"] and self.closer

    @property
    def worse(self) -> bool:
        """Whether it is worse than before: J rises, and the track comes no closer."""
        return self.J["after"] > self.J["before"] and not self.closer

    @property
    def indices(self) -> dict[str, dict[str, Any]]:
        """Manoeuvring indices "measured", "before" and "after"."""
        measured = self.records["before"].measured.indices
        return {"measured": measured, **{which: record.indices for which, record in self.records.items()}}

    def __repr__(self) -> str:
        """In a line."""
        return (
            f"TrialComparison({inert(self.trial.id)}, {self.role}: J {self.J['before']:.4g} -> {self.J['after']:.4g})"
        )

    def to_dict(self) -> dict[str, Any]:
        """For JSON; a J that is not finite becomes null."""
        return {
            "id": self.trial.id,
            "run": self.trial.run,
            "part_of": self.trial.part_of or None,
            "role": self.role,
            "manoeuvre": self.trial.manoeuvre,
            "source": self.trial.source,
            "n_samples": self.trial.n_samples,
            "J_before": finite(self.J["before"]),
            "J_after": finite(self.J["after"]),
            "status_before": "diverged" if self.motions["before"].diverged else "ok",
            "status_after": "diverged" if self.motions["after"].diverged else "ok",
            "rms": {
                channel: {which: finite(value) for which, value in errors.items()}
                for channel, errors in self.rms.items()
            },
            "indices": self.indices,
            "order": self.records["before"].measured.order,
        }


class ComparedTrials(tuple[TrialComparison, ...], Plotted):
    """Trials before and after, one by one; together a table: how far off track and heading each is, and its J."""

    __slots__ = ()

    def __repr__(self) -> str:
        """In a line."""
        of = [f"{sum(one.role == role for one in self)} {role}" for role in dict.fromkeys(one.role for one in self)]
        return f"ComparedTrials({', '.join([counted(len(self), 'trial'), *of])})"


def records_at(
    problem: FitProblem, trials: Sequence[Trial], unit: FloatArray, objective: Objective | None = None
) -> tuple[TrialRecord, ...]:
    """Every trial simulated with the coefficients at a position (n_targets,) of the unit cube; arguments as for
    ``compare``, the paper's objective where None."""
    offsets = None if problem.sigma is None else fit_offsets(problem, unit)
    return tuple(records(problem.predictor(unit[:, None]), trials, objective, offsets=offsets))


def compare(
    problem: FitProblem,
    trials: Sequence[Trial],
    objective: Objective,
    roles: Mapping[str, str],
    before: FloatArray,
    after: FloatArray,
) -> list[TrialComparison]:
    """Simulate every trial with the coefficients at two positions (n_targets,) of the unit cube.

    problem    over all of ``trials``, in their order; where it estimates initial states, each trial gets its own
    objective  what J counts
    """
    points = {"before": before, "after": after}
    found = {which: records_at(problem, trials, unit, objective) for which, unit in points.items()}
    return [
        TrialComparison(trial, roles[trial.id], {which: of[i] for which, of in found.items()})
        for i, trial in enumerate(trials)
    ]


def total(compared: Sequence[TrialComparison], role: str, which: str) -> float | None:
    """J over the trials of one role, None where there are none."""
    values = [c.J[which] for c in compared if c.role == role]
    return float(sum(values)) if values else None


def off_in_words(compared: Sequence[TrialComparison], which: str) -> dict[str, str]:
    """How far off "track" and "heading" as mean over trials, "1.23 m" and "0.45°"; without what is not known."""
    ways = {"track": (3, " m"), "heading": (2, "°")}
    return {of: f"{rounded(size, ways[of][0])}{ways[of][1]}" for of, size in mean_off(compared, which).items()}


def mean_off(compared: Sequence[TrialComparison], which: str) -> dict[str, float]:
    """How far off "track" [m] and "heading" [deg] as mean over trials; without what is not known."""
    found = {}
    for of, values in zip(("track", "heading"), zip(*(one.off(which) for one in compared), strict=True), strict=False):
        size = mean(map(finite, values))
        if size is not None:
            found[of] = size
    return found


def off_document(compared: Sequence[TrialComparison]) -> dict[str, Any]:
    """For JSON: the number of trials, and of windows where they were cut, and before and after how far off track and
    heading they are as mean."""
    before, after = (mean_off(compared, which) for which in ("before", "after"))
    return {
        "trials": len({one.trial.whole for one in compared}),
        **({"windows": len(compared)} if any(one.trial.part_of for one in compared) else {}),
        "track_m": {"before": before.get("track"), "after": after.get("track")},
        "heading_deg": {"before": before.get("heading"), "after": after.get("heading")},
    }


def counted_trials(compared: Sequence[TrialComparison]) -> str:
    """How many trials are compared, in words, or windows of how many."""
    return counted_pieces([one.trial.whole for one in compared], [one.trial.id for one in compared])


def rounded(value: float, digits: int) -> str:
    """A number with significant digits, never as a power of ten where it is large."""
    text = f"{value:#.{digits}g}"
    return (f"{float(text):.0f}" if "e+" in text else text).rstrip(".")
