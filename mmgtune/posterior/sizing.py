"""How much trials are believed: residuals of a model that is wrong are not independent of each other.

What the model with all its room cannot follow shows as residuals larger than the noise.  Such an error is the same
along a run, so it counts as one number for each channel of each run, not as one a sample.  Where trials are of several
kinds and sides, each group is left out besides, and predicted from the others, and so are the runs of a group where it
has several: the trials are believed as far as bands then cover what was left out at the nominal rate, groups and runs
alike.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ..displayed import Brief
from ..fitting.journal import remembered
from ..hooks import Hooks
from ..manoeuvres import manoeuvre_kind
from ..motions import track_if_whole
from ..predictor import PhysicsPredictor, cases_from
from ..trial import Coverage, Trial
from ..units import DEG
from .local import Mode, Windowed, find_mode, particles_about

BASE = 3.0
"""Variance of residuals even where the model fits to the noise, and nothing left out says otherwise: what generated
ships with a hidden effect call for."""

SHARED = 2.0
"""Weight of what is above the noise, over what one number a channel and run gives."""

GRID = (1.0 / 3.0, 1.0, 3.0, 10.0, 30.0, 100.0)
"""Factors on the variance that left-out groups choose among; with the first the noise is what it is."""

CIRCLE = 150.0
"""Change of heading [deg] over a trial from which it shows a turning circle to that side."""

SHARES = 4
"""Parts of a group of several runs that are left out besides: trials of one kind differ among themselves too."""

N_LEFT_OUT = 80
"""Particles that predict a left-out group."""

NOMINAL = 0.9
"""Share of left-out samples that bands of this content are to cover."""

SMALL_RUDDER = 15.0 * DEG
"""Rudder below which a turn or zigzag counts as gentle."""


@dataclass(frozen=True, repr=False)
class Sized(Brief):
    """How much the trials are believed.

    misfit     mean square of the residuals at the mode, 1 where the model is right
    own        variance of residuals that follows from it
    groups     what was left out in turn, kinds and sides in words; none where that was not asked for, and of a
               single one nothing could be
    factor     on ``own`` from which bands cover them, 1 where nothing was left out
    covered    share of left-out samples within bands, by factor as far as these were tried
    stopped    whether that was stopped before its end
    """

    misfit: float
    own: float
    groups: tuple[str, ...] = ()
    factor: float = 1.0
    covered: tuple[float, ...] = ()
    stopped: bool = False

    @property
    def temper(self) -> float:
        """Variance of residuals the distribution is made with."""
        return self.own * self.factor

    def sentence(self) -> str:
        """In words."""
        variance = f"{self.temper:.3g} times the variance of noise (their own is {self.misfit:.2f} times)"
        said = f"Residuals count with {variance}"
        if not self.groups:
            return f"{said}; no kind or side was left out to check it."
        if self.stopped:
            return f"{said}; it was stopped before {', '.join(self.groups)} had been left out to check that."
        if len(self.groups) < 2:
            return f"{said}; all trials are of one kind and side, so nothing could be left out to check it."
        share, of = 100.0 * self.covered[GRID.index(self.factor)], ", ".join(self.groups)
        return f"{said}, with which bands from the others cover {share:.0f} % of {of}."


def own_variance(data: Windowed, mode: Mode) -> float:
    """Variance of residuals from their size at the mode."""
    n = len(mode.residual)
    above = max(mode.misfit - 1.0 - float(np.sqrt(2.0 / n)), 0.0)
    return BASE + SHARED * above * n / data.n_series


def group_of(trial: Trial) -> str:
    """Kind, side and size of a trial in words: "starboard turning", "zigzag"."""
    track = track_if_whole(trial)
    kind = manoeuvre_kind(track) if track is not None else trial.manoeuvre or "other"
    largest = float(trial.delta[np.nanargmax(np.abs(trial.delta))])
    size = "gentle " if abs(largest) < SMALL_RUDDER else ""
    side = ("starboard " if largest > 0.0 else "port ") if kind == "turning" else ""
    return f"{size}{side}{kind}"


@dataclass(frozen=True)
class Shown:
    """What orders trials hold: predictions beyond them rest on the room alone.

    rudder    largest to starboard and to port [deg]
    coverage  what they visit, as a fit to them has it: which sides she turned to
    circles   sides that a turning circle goes to
    astern    whether revolutions are ever astern
    """

    rudder: tuple[float, float]
    coverage: Coverage
    circles: tuple[str, ...]
    astern: bool

    def sentence(self) -> str:
        """In words."""
        starboard, port = self.rudder
        turns = self.coverage.turns
        if self.coverage.sides:
            turns += f", {self._circles()}"
        astern = "" if self.astern else ", no revolutions astern"
        return (
            f"The trials show rudder up to {starboard:.0f} deg to starboard and {port:.0f} deg to port, {turns}{astern}"
            "; beyond that bands are as wide as the room allows."
        )

    def _circles(self) -> str:
        """Where turning circles go, in words."""
        if len(self.circles) == 1:
            return f"turning circles to {self.circles[0]} alone"
        return "turning circles to both" if self.circles else "no turning circle"

    def one_sided(self) -> str | None:
        """A warning where turns, or turning circles, go to one side alone, or rudder to one side less than half as far;
        else None.
        """
        other = {"starboard": "port", "port": "starboard"}
        if len(self.coverage.sides) == 1:
            side = self.coverage.sides[0]
            what = f"turns to {side} alone"
        elif len(self.circles) == 1:
            side = self.circles[0]
            return (
                f"The trials show turns to both sides, but {self._circles()}: bands of circles to {other[side]} rest "
                f"on the shorter turns there, on what the ship does to {side} and on the room."
            )
        elif min(self.rudder) < 0.5 * max(self.rudder):
            side = "starboard" if self.rudder[0] > self.rudder[1] else "port"
            what = f"little rudder to {other[side]}"
        else:
            return None
        return f"The trials show {what}: bands to {other[side]} rest on what the ship does to {side} and on the room."


def shown_by(trials: Sequence[Trial], L_pp: float) -> Shown:
    """What orders trials hold.  L_pp [m]."""
    starboard, port = (max(0.0, *(float(np.nanmax(side * one.delta)) / DEG for one in trials)) for side in (1.0, -1.0))
    turned = [float(trial.psi[-1] - trial.psi[0]) / DEG for trial in trials if np.isfinite(trial.psi[[0, -1]]).all()]
    circles = tuple(
        name for name, side in (("starboard", 1.0), ("port", -1.0)) if any(side * angle >= CIRCLE for angle in turned)
    )
    astern = any(np.nanmin(trial.n) < 0.0 for trial in trials)
    return Shown((starboard, port), Coverage.of(trials, L_pp), circles, astern)


def left_out_of(trials: Sequence[Trial]) -> tuple[tuple[str, ...], list[list[Trial]]]:
    """Groups of trials in words, and what is left out in turn: each group, then parts of those of several runs; nothing
    where there is but one group."""
    groups: dict[str, list[Trial]] = {}
    for trial in trials:
        groups.setdefault(group_of(trial), []).append(trial)
    if len(groups) < 2:
        return tuple(groups), []
    parts = [[one for one in some if one.run in runs] for some in groups.values() for runs in _shares(some)]
    return tuple(groups), [*groups.values(), *parts]


def size(
    data: Windowed,
    mode: Mode,
    remake: Callable[[Sequence[Trial]], Windowed],
    seed: int = 1,
    hooks: Hooks = Hooks(),
) -> Sized:
    """How much the trials of ``data`` are to be believed.

    remake  the same with other trials
    """
    own = own_variance(data, mode)
    groups, left_out = left_out_of(data.trials)
    if not left_out:
        return Sized(mode.misfit, own, groups)
    rests = [remake([one for one in data.trials if not any(one is other for other in left)]) for left in left_out]
    modes = []
    for k, rest in enumerate(rests):
        hooks.on_phase(f"most probable ships without a part of the trials, {k + 1} of {len(rests)}")
        modes.append(find_mode(rest, own, stop=hooks.stop))
    variances = [own_variance(rest, found) for rest, found in zip(rests, modes, strict=True)]
    covered: list[float] = []
    for factor in GRID:
        shares = []
        for k, left in enumerate(left_out):
            if hooks.stop():
                return Sized(mode.misfit, own, groups, _chosen(covered), tuple(covered), stopped=True)
            variance = f"{factor:.2g} times" if factor != 1.0 else "just"
            hooks.on_phase(f"bands of what was left out with {variance} that variance, {k + 1} of {len(left_out)}")
            temper = factor * variances[k]
            modes[k] = find_mode(rests[k], temper, modes[k].z, hooks.stop)
            shares.append(coverage(rests[k], modes[k], temper, left, seed))
        of_groups, of_parts = shares[: len(groups)], shares[len(groups) :] or [1.0]
        covered.append(float(min(np.mean(of_groups), np.mean(of_parts))))
        if covered[-1] >= NOMINAL:
            break
    return Sized(mode.misfit, own, groups, _chosen(covered), tuple(covered))


def _chosen(covered: Sequence[float]) -> float:
    """The factor of those tried with which bands cover what they should, or nearly."""
    if not covered:
        return 1.0
    return GRID[len(covered) - 1 if covered[-1] >= NOMINAL else int(np.argmax(covered))]


def _shares(trials: Sequence[Trial]) -> list[set[str]]:
    """Runs of a group, in at most SHARES parts; none where they are one run."""
    runs = list(dict.fromkeys(trial.run for trial in trials))
    return [set(runs[k::SHARES]) for k in range(min(SHARES, len(runs)))] if len(runs) > 1 else []


@remembered(
    asked=lambda data, mode, temper, trials, seed: [*data.asked, mode.z, temper, [one.id for one in trials], seed],
    note=float,
    recall=float,
)
def coverage(data: Windowed, mode: Mode, temper: float, trials: Sequence[Trial], seed: int) -> float:
    """Share of samples of position and heading of whole left-out trials that bands of ``NOMINAL`` content cover.

    Bands are those of the particles, wider by the noise of the sensors.
    """
    z = particles_about(data, mode, temper, N_LEFT_OUT, seed)
    theta = data.model.matrix(data.room.names, data.room.values(z))
    predicted = PhysicsPredictor(data.model, theta, data.integrator, data.backend.name).predict(
        cases_from(trials, data.model.inputs, data.model.draught)
    )
    covered = []
    for case, trial in enumerate(trials):
        at = np.arange(trial.n_samples // 40, trial.n_samples, max(1, trial.n_samples // 60))
        runs = predicted.states[case][~predicted.diverged[case]][:, at, :3]
        if len(runs) < N_LEFT_OUT // 2:  # hardly any particle stays in the world of ships
            covered.append(0.0)
            continue
        low, high = np.quantile(runs, [0.5 - 0.5 * NOMINAL, 0.5 + 0.5 * NOMINAL], axis=0)
        measured, noise = trial.motion[at, :3], 2.0 * data.sigma[:3]
        inside = (measured >= low - noise) & (measured <= high + noise)
        covered.append(float(np.mean(inside[np.isfinite(measured)])))
    return float(np.mean(covered))
