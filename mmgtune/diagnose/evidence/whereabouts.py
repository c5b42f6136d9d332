"""Where an error that nothing explains lives: in which runs, when in them, in which force, against which quantity.

The motion of a simulation carries every error on; the force that the measured motion needed beyond the model's does
not, so that it shows when and where something acts.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

import numpy as np

from ...arrays import FloatArray, IntArray
from ...documents import finite
from ...phrases import QUANTITIES, figures
from ...trial import Trial, measured_wind
from ...trial.checks.set_checks import odd_in_words
from ...units import DEG
from . import FEWEST_BLOCKS, ResidualForces, share_explained
from .leftover import POSITION, in_words
from .logged import LOGGED

AXES = {"X": "surge force", "Y": "sway force", "N": "yaw moment"}
PHASES = {
    "before": "before the first order",
    "entry": "entry: within three ship lengths of an order",
    "checking": "checking: rudder against the turn",
    "steady": "steady: later than that",
}
"""When in a run, in words."""

_DURING = {
    "before": "before the first order",
    "entry": "within three ship lengths of an order",
    "checking": "while the rudder checks the turn",
    "steady": "later than three ship lengths after an order",
}
"""Phases as they stand inside a sentence."""

ENTRY = 3.0
"""Ship lengths run since an order that count as entry."""

LEAST = DEG
"""Rudder angle [rad] from which it can be against a turn."""

BLOCK = 60.0
"""Time [s] whose forces are predicted from those of the others."""

BINS = 12
"""Bins of a quantity that forces are drawn over."""

FOLLOWS = 0.1
"""Share of the variance of a force predicted by one quantity from which it is spoken of."""

ELSEWHERE = ("north", "east", "time")
"""Quantities that are of the place and the hour, not of the ship."""

LITTLE = 0.01
"""Share of the error up to which nothing is said to remove any."""

MOST_OF_IT = 0.8
"""Share of the error in runs whose logs warn of something, from which that is what to look at."""

NEAR = 0.1
"""By this much one share must exceed another to be told from it."""

MOST_POINTS = 240
"""Points of a run's history that are kept."""

IN_FEW, SEVERAL = 0.65, 4
"""Share of the error in a third of the runs, of so many at least, from which the others are told well: a ship that is
unlike her profile errs in all."""

RUNS_DRAWN = 4
"""Runs whose history is kept: the worst."""

SLOW = 0.2
"""Share of the usual speed below which forces over the square of the speed say nothing."""

PERIODIC = ("heading", "wind_angle")

TELLS = {
    "heading": (
        "the same manoeuvre on the opposite heading; wind, current and waves measured: what follows the heading is "
        "outside the ship, or a deviation of the compass"
    ),
    "wind_angle": "the same manoeuvre without wind, or the wind measured on another mast: its force is not the model's",
    "wind_speed": "the same manoeuvre without wind, or the wind measured on another mast: its force is not the model's",
    "drift": "turns with 10, 20 and 35 deg of rudder to both sides, with the velocity through the water logged",
    "yaw_rate": "turns with 10, 20 and 35 deg of rudder to both sides, at two speeds each",
    "rudder": "the angle of the rudder stock logged beside the order, and zigzags of other angles than these",
    "ordered": "order and angle of the rudder logged by one clock, five times a second or more, shaft speed with them",
    "speed": "the same manoeuvre at two other speeds, and straight runs at each with the thrust or torque logged",
    "time": "the same run again at once: what grows with time is a tide, a sensor that drifts, or an engine",
    "north": "the same manoeuvre elsewhere; depth and current measured along the track",
    "east": "the same manoeuvre elsewhere; depth and current measured along the track",
}
REPEAT = "the same run again, with the same orders on the same heading: what differs between the two is not the ship's"
"""What would tell where nothing shows."""


@dataclass(frozen=True, eq=False)
class Whereabouts:
    """Where the error of the re-tuned model without any cause lives.

    runs     share of the error beyond noise by run, worst first, of the motion
    phases   by phase and axis: mean square of the residual force beyond its noise, over that of the noise
    samples  by phase, the share of the time
    axes     by axis, mean square of the residual force beyond its noise over all phases, over that of the noise
    follows  by axis and quantity, share of its variance that the quantity alone predicts on stretches left out
    curves   by axis, the quantity it follows most: bins of it with mean force, its scatter and the noise
    histories  of the worst runs: time, phase and residual forces
               forces of both are averages over the time of a ship length, over 0.5 rho L d U^2, U the rms speed
    removable  by effect, the largest share of the error beyond noise that it alone removes when refitted
    offsets    by channel, what its log shows more than the model in every run alike [rad, m/s or rad/s]
    odd        what the logs of runs warn of, by run, where these have most of the error
    channel    of ``leftover.SENSORS`` that which alone errs, "" where others do too: its log is wrong, not a force
    """

    runs: Mapping[str, float]
    phases: Mapping[str, Mapping[str, float]]
    samples: Mapping[str, float]
    axes: Mapping[str, float]
    follows: Mapping[str, Mapping[str, float]]
    curves: Mapping[str, Mapping[str, Any]]
    histories: Sequence[Mapping[str, Any]]
    removable: Mapping[str, float]
    offsets: Mapping[str, float]
    odd: Mapping[str, str] = field(default_factory=dict)
    channel: str = ""

    @property
    def strongest(self) -> tuple[str, str, float] | None:
        """Axis, quantity and share of the force that follows one most, weighed by how it stands out of its noise."""
        found = [
            (axis, name, shares[name])
            for axis, shares in self.follows.items()
            if (name := _followed(shares)) and shares[name] >= FOLLOWS
        ]
        return max(found, key=lambda one: one[2] * max(self.axes.get(one[0], 0.0), 0.0), default=None)

    @property
    def suggestion(self) -> str:
        """The trial or the sensor that would tell most."""
        if self.offsets:
            (first, *_) = self.offsets
            return f"the {LOGGED[first]} from a second sensor in the same runs"
        if self.odd:
            return f"the same without what is odd: {odd_in_words(self.odd)}"
        if self.channel == POSITION:
            return "positions of a second receiver in the same runs, and the speeds over ground and through the water"
        if self.channel:
            return f"the {LOGGED[self.channel]} from a second sensor in the same runs"
        best = self.strongest
        return TELLS[best[1]] if best else REPEAT

    @property
    def in_few(self) -> bool:
        """Whether most of the error is in a few of the runs, and the others are told well."""
        worst = sorted(self.runs.values(), reverse=True)[: math.ceil(len(self.runs) / 3)]
        return len(self.runs) >= SEVERAL and sum(worst) >= IN_FEW

    def sentences(self) -> list[str]:
        """What of it is worth saying, in words."""
        found = []
        if self.runs:
            total, listed = 0.0, []
            for name, share in self.runs.items():
                listed.append(name)
                total += share
                if total >= 0.5 or len(listed) == 3:
                    break
            found.append(
                f"{_percent(total)} of the error is in {len(listed)} of {len(self.runs)} runs: {', '.join(listed)}."
            )
        found += [
            f"{in_words(name, offset)}: look at its sensor first, how it is mounted and how it was calibrated."
            for name, offset in self.offsets.items()
        ]
        if self.channel == POSITION:
            found.append(
                "What is left is in the positions alone, and the rest of the motion is told to its noise: look at the "
                "receiver first, its filter, its clock and an antenna that heels with the ship, then at water that "
                "moved otherwise than is known. No force is read from that."
            )
        elif self.channel:
            found.append(
                f"What is left is in the log of the {LOGGED[self.channel]} alone, and hardly any in the rest of the "
                "motion: look at that sensor, its filter and its clock first. No force is read where it is wrong."
            )
        found += [*([] if self.channel else self._of_forces()), *self._of_effects()]
        found.append(f"What would tell: {self.suggestion}.")
        return found

    def _of_forces(self) -> list[str]:
        """Which force stands out, when, and what it follows."""
        found = []
        axis = max(self.axes, key=lambda one: self.axes[one], default=None)
        if axis is not None and self.axes[axis] > 0.0:
            size = math.sqrt(self.axes[axis])
            when = max(self.phases, key=lambda one: self.phases[one].get(axis, 0.0))
            there = math.sqrt(max(self.phases[when].get(axis, 0.0), 0.0))
            found.append(
                f"By inverse dynamics the {AXES[axis]} stands out most, {figures(size)} times its noise, and most "
                f"{_DURING[when]}, {figures(there)} times."
            )
        best = self.strongest
        if best:
            shares = self.follows[best[0]]
            others = [name for name in shares if name != best[1] and shares[name] >= max(FOLLOWS, best[2] - NEAR)]
            beside = ", ".join(f"{QUANTITIES[name]} {_percent(shares[name])}" for name in others)
            found.append(
                f"The {AXES[best[0]]} follows the {QUANTITIES[best[1]]}, which alone predicts {_percent(best[2])} of it"
                + (f"; nearly as well do: {beside}." if beside else ".")
            )
        elif self.follows:
            found.append("No force follows any single quantity that was logged.")
        return found

    def _of_effects(self) -> list[str]:
        """What a single known effect would do, where that is worth saying."""
        if not self.removable or max(self.removable.values()) < LITTLE:
            return []
        tag = next(iter(self.removable))
        said = f"Of {len(self.removable)} effects tried alone, with one value for all runs, {tag} would remove the "
        return [f"{said}largest share of the error, {_percent(self.removable[tag])}."]

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        best = self.strongest
        return {
            "sentences": self.sentences(),
            "runs": dict(self.runs),
            "phases": {name: {axis: finite(value) for axis, value in of.items()} for name, of in self.phases.items()},
            "share_of_time": dict(self.samples),
            "axes": {axis: finite(value) for axis, value in self.axes.items()},
            "follows": {axis: dict(shares) for axis, shares in self.follows.items()},
            "strongest": None if best is None else {"axis": best[0], "quantity": best[1], "share": best[2]},
            "curves": dict(self.curves),
            "histories": list(self.histories),
            "removable": dict(self.removable),
            "offsets": dict(self.offsets),
            "channel": self.channel or None,
            "suggestion": self.suggestion,
        }


def _followed(shares: Mapping[str, float]) -> str:
    """The quantity a force follows; place and hour last, as they go with all else that happens in a run."""
    own = max((name for name in shares if name not in ELSEWHERE), key=lambda one: shares[one], default="")
    best = max(shares, key=lambda one: shares[one], default="")
    return own if own and shares[own] >= max(FOLLOWS, shares[best] - NEAR) else best


def _percent(share: float) -> str:
    return f"{100.0 * min(max(share, 0.0), 1.0):.0f} %"


def whereabouts(
    forces: Sequence[tuple[ResidualForces, Trial]],
    by_run: Mapping[str, float],
    removable: Mapping[str, float],
    offsets: Mapping[str, float],
    odd: Mapping[str, str] = MappingProxyType({}),
) -> Whereabouts:
    """Where the error lives.

    forces              residual forces of the trials that are long enough for these, with the trials
    by_run              error of the motion beyond noise, by run
    removable, offsets  see ``Whereabouts``
    odd                 what the log of a run warns of, by run
    """
    whole = sum(max(value, 0.0) for value in by_run.values())
    runs = {name: max(value, 0.0) / whole for name, value in by_run.items()} if whole > 0.0 else {}
    runs = dict(sorted(runs.items(), key=lambda one: -one[1]))
    share = sum(runs.get(run, 0.0) for run in odd)
    odd = odd if share >= MOST_OF_IT else {}
    if not forces:
        return Whereabouts(runs, {}, {}, {}, {}, {}, (), removable, offsets, odd)
    phase = [phases_of(found, trial) for found, trial in forces]
    ratio = [(found.force / np.maximum(found.noise, 1e-100)) ** 2 - 1.0 for found, _ in forces]
    every, excess = np.concatenate(phase), np.concatenate(ratio)
    names = list(PHASES)
    axes = dict(zip(AXES, map(float, np.mean(excess, axis=0)), strict=True))
    phases = {
        name: dict(zip(AXES, map(float, np.mean(excess[every == k], axis=0)), strict=True))
        for k, name in enumerate(names)
        if (every == k).any()
    }
    samples = {name: float(np.mean(every == names.index(name))) for name in phases}
    slow = _Slow.of(forces)
    follows = slow.follows()
    curves = {}
    for k, (axis, shares) in enumerate(follows.items()):
        name = _followed(shares)
        curves[axis] = {"quantity": name, "share": shares[name], **slow.curve(name, k)}
    worst = sorted(forces, key=lambda one: -runs.get(one[1].run, 0.0))[:RUNS_DRAWN]
    return Whereabouts(
        runs,
        phases,
        samples,
        axes,
        follows,
        curves,
        tuple(_history(found, trial, _unit(forces), _ship_length(forces)) for found, trial in worst),
        removable,
        offsets,
        odd,
    )


def phases_of(found: ResidualForces, trial: Trial) -> IntArray:
    """(n,) which of ``PHASES`` each sample of residual forces is in."""
    r = trial.r[found.sample]
    turning = np.abs(r) > 0.1 * float(np.max(np.abs(r), initial=0.0))
    against = (found.rudder * r < 0.0) & turning & (np.abs(found.rudder) > LEAST)
    run = found.ordered * found.speed / found.L_pp
    names = list(PHASES)
    with np.errstate(invalid="ignore"):
        entry = run <= ENTRY
    phase = np.where(entry, names.index("entry"), names.index("steady"))
    phase = np.where(against, names.index("checking"), phase)
    return np.asarray(np.where(np.isnan(found.ordered), names.index("before"), phase), dtype=np.int64)


def _variables(forces: Sequence[tuple[ResidualForces, Trial]]) -> dict[str, FloatArray]:
    """What forces may follow, (n,) each, of all trials one after the other."""
    parts = []
    for found, trial in forces:
        own = {**found.variables, "north": trial.x[found.sample], "east": trial.y[found.sample]}
        wind = measured_wind(trial)
        if wind[:, 2].any():
            north, east = wind[found.sample, :2].T
            own["wind_speed"] = np.hypot(north, east)
            own["wind_angle"] = np.arctan2(-east, -north) - found.heading
        parts.append(own)
    n = [len(found.time) for found, _ in forces]
    names = dict.fromkeys(name for part in parts for name in part)
    return {
        name: np.concatenate([part.get(name, np.full(k, np.nan)) for part, k in zip(parts, n, strict=True)])
        for name in names
    }


@dataclass(frozen=True, eq=False)
class _Slow:
    """Residual forces and what they may follow, averaged over the time of a ship length: what is quicker is waves,
    gusts and what the sensors' noise leaves of slopes.

    force, noise, unit  (n, 3) [N], [N m]
    variables           (n,) each
    label               (n,) stretches of about a minute
    """

    force: FloatArray
    noise: FloatArray
    unit: FloatArray
    variables: Mapping[str, FloatArray]
    label: IntArray

    @classmethod
    def of(cls, forces: Sequence[tuple[ResidualForces, Trial]]) -> _Slow:
        moment, first, labels, groups, at = _ship_length(forces), 0, [], [], 0
        for found, _ in forces:
            since = found.time - found.time[0]
            groups.append(np.floor(since / moment).astype(int) + at)
            at = int(groups[-1][-1]) + 1
            labels.append(np.floor(since / BLOCK).astype(int) + first)
            first = int(labels[-1][-1]) + 1
        _, group, count = np.unique(np.concatenate(groups), return_inverse=True, return_counts=True)

        def mean(values: FloatArray) -> FloatArray:
            known = np.isfinite(values)
            total = np.bincount(group, weights=np.where(known, values, 0.0), minlength=len(count))
            n = np.bincount(group, weights=known.astype(float), minlength=len(count))
            return np.where(n > 0.0, total / np.maximum(n, 1.0), np.nan)

        def columns(name: str) -> FloatArray:
            whole = np.concatenate([getattr(found, name) for found, _ in forces])
            return np.column_stack([mean(column) for column in whole.T])

        # Noise within a time scale of the smoothing goes together.
        fewer = np.concatenate(
            [np.full(len(one.time), math.sqrt(max(1.0, 0.5 * moment / one.tau))) for one, _ in forces]
        )

        variables = {}
        for name, values in _variables(forces).items():
            turning = name in PERIODIC
            variables[name] = np.arctan2(mean(np.sin(values)), mean(np.cos(values))) if turning else mean(values)
        stretch = np.round(mean(np.concatenate(labels).astype(float))).astype(np.int64)
        return cls(columns("force"), columns("noise") / mean(fewer)[:, None], columns("unit"), variables, stretch)

    def follows(self) -> dict[str, dict[str, float]]:
        """By axis, the share each quantity predicts of the force, in newtons or in prime values, whichever is more."""
        if len(np.unique(self.label)) < FEWEST_BLOCKS:
            return {}
        moving = self.unit[:, 0] > SLOW**2 * float(np.median(self.unit[:, 0]))
        shares: dict[str, dict[str, float]] = {}
        for k, axis in enumerate(AXES):
            own = self._shares(self.force[:, k], self.noise[:, k])
            unit = np.where(moving, self.unit[:, k], 1.0)
            prime = np.where(moving, self.force[:, k] / unit, np.nan)
            if len(np.unique(self.label[moving])) >= FEWEST_BLOCKS:
                by_prime = self._shares(prime, np.where(moving, self.noise[:, k] / unit, 1.0))
                own = {name: max(own[name], by_prime[name]) for name in own}
            shares[axis] = own
        return shares

    def _shares(self, force: FloatArray, noise: FloatArray) -> dict[str, float]:
        typical = float(np.median(noise[np.isfinite(force)]))
        weights = 1.0 / np.clip(noise / typical, 0.3, 1e3) ** 2 if typical > 0.0 else np.ones(len(noise))
        return share_explained(force, self.variables, PERIODIC, blocks=self.label, weights=weights)

    def curve(self, name: str, k: int) -> dict[str, list[float]]:
        """Bins of a quantity, as many in each, with the mean of a force there, its scatter, and that of the noise."""
        unit = max(float(np.mean(self.unit[:, k])), 1e-300)
        values = self.variables[name]
        values = np.mod(values, 2.0 * np.pi) if name in PERIODIC else values
        known = np.isfinite(values)
        order = np.argsort(values[known], kind="stable")
        x, y, e = (column[known][order] for column in (values, self.force[:, k] / unit, self.noise[:, k] / unit))
        rows = [row for row in np.array_split(np.arange(len(x)), BINS) if len(row)]
        return {
            "at": [float(np.mean(x[row])) for row in rows],
            "mean": [float(np.mean(y[row])) for row in rows],
            "spread": [float(np.std(y[row])) for row in rows],
            "noise": [float(np.sqrt(np.mean(e[row] ** 2))) for row in rows],
        }


def _ship_length(forces: Sequence[tuple[ResidualForces, Trial]]) -> float:
    """Time [s] in which the ships run their own length, in the mean."""
    speed = float(np.mean(np.concatenate([found.speed for found, _ in forces])))
    return forces[0][0].L_pp / max(speed, 1e-3)


def _unit(forces: Sequence[tuple[ResidualForces, Trial]]) -> FloatArray:
    """(3,) what forces are drawn over: 0.5 rho L d U^2 [N] twice, 0.5 rho L^2 d U^2 [N m], U the rms speed of all.

    Prime values of the speed of the moment would say nothing near rest.
    """
    unit = np.concatenate([found.unit for found, _ in forces])
    return np.asarray(np.maximum(np.mean(unit, axis=0), 1e-300))


def _history(found: ResidualForces, trial: Trial, unit: FloatArray, moment: float) -> dict[str, Any]:
    every = max(1, math.ceil(len(found.time) / MOST_POINTS))
    phase = phases_of(found, trial)[::every]
    names = list(PHASES)
    return {
        "trial": trial.id,
        "t": found.time[::every].round(2).tolist(),
        "phase": [names[k] for k in phase],
        "rudder_deg": (found.rudder[::every] / DEG).round(2).tolist(),
        **{
            axis: _running(found.time, found.force[:, k] / unit[k], moment)[::every].tolist()
            for k, axis in enumerate(AXES)
        },
    }


def _running(t: FloatArray, values: FloatArray, length: float) -> FloatArray:
    """Mean over a stretch of some length [s] about each sample."""
    total = np.concatenate([[0.0], np.cumsum(values)])
    first = np.searchsorted(t, t - 0.5 * length)
    last = np.searchsorted(t, t + 0.5 * length, side="right")
    return np.asarray((total[last] - total[first]) / (last - first))
