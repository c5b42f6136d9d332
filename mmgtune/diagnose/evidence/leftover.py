"""What no cause explains: is there more than noise left, and does it look like something that happened?

Slow noise of a sensor and an error of the model look alike in one channel.  They differ in two ways: what really
moved the ship shows in heading and yaw rate, or in position and velocity, alike; and what depends on the state of the
ship can be predicted from it on parts of the record it was not learnt from.  And what a log of the inputs leaves open,
such as when between two samples an order was given, moves the ship without being an error of the model.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy.special import stdtr

from ...arrays import FloatArray
from ...backends import STATES
from ...displayed import Brief
from ...phrases import listed
from ...physics.frame import to_earth
from ...trial import Trial
from ...trial.checks.in_parts import changes_within
from ...trial.kinematics import rounding_noise
from ...units import DEG
from ..bench.noise import by_channel, rows_of_channels, white_level
from ..bench.workbench import Point, Workbench, least_noise
from ..signatures.linear import linearise
from . import FEWEST_BLOCKS, share_explained
from .logged import LOGGED
from .misread import Misread, misread_in

NOTICED = 0.05
"""Variance beyond the white noise of the sensors, as a share of it, that is worth speaking of."""

OF_ANOTHER_FORM = 1.0
"""Variance beyond noise, as a share of it, from which on what causes leave says that their form is another."""

CLEARLY = 0.15
"""Variance beyond noise from which one sensor may be said to err alone: a model form that is a little off shows first
in the best log."""

NEARLY_ALL, MOST = 0.95, 0.75
"""Share of what all channels have beyond their noise from which it is of one sensor alone; where it is noticed in no
other channel."""

SLACK, ERRORS = 0.25, 2.0
"""Share by which slow noise may have been estimated too small, as fitting takes much of it away, and standard errors of
its variance besides: records hold few of its time constants."""

ALIKE = 0.5
"""Share explained by the ship's state from which what is left is an error of the model."""

FEW = 12
"""Groups of blocks below which chance predicts so much of one channel by one of six quantities: of two it takes."""

CERTAIN = 4.0
"""Standard errors of that correlation from which chance is out of the question."""

WINDOWS = (20.0, 60.0)
"""Times [s] over which channels are compared; slow errors stand out over long ones."""


PAIRS = {"heading and yaw rate": ("psi", "r"), "position and velocity": ("x", "y", "u", "v_m")}
"""Channels that the same motion shows in."""

SWELLS = 3.0
"""Periods of a swell that residuals are averaged over to see what is left beside it."""

BLOCK = 20.0
"""Time [s] residuals are averaged over before asking what explains them."""


POSITION = "position"
"""What both channels of the position are called together: one receiver shows them."""

SENSORS: Mapping[tuple[str, ...], str] = {**{(name,): name for name in LOGGED}, ("x", "y"): POSITION}
"""What shows an error alone where that is no force, by the channels it is in."""

OFF = 0.5
"""Share of what a channel has beyond its noise from which an offset is spoken of; by how much of it runs may differ."""

FEWEST_RUNS = 3
"""Runs it takes for that."""

WANDERS, MINUTE = 1.5, 60.0
"""Deviation of the fading part of noise over its white one, and time [s] it fades in, from which it may be no noise."""

BY_CHANCE = 1e-3
"""Probability that the means of runs are as much alike by chance (Student's test) from which it is none."""


@dataclass(frozen=True, repr=False)
class Leftover(Brief):
    """What is left at a point.

    excess     variance of all residuals beyond the white noise of the sensors and what the logged inputs leave open, as
               a share of that noise; of a channel whose noise has no white part, beyond and of all its noise
    channels   ``excess`` by channel
    alike      correlation of what heading and yaw rate say, and of what position and velocity say, over the window
               where it is clearest
    certainty  ``alike`` in standard errors
    explained  by channel, the largest share one quantity explains, and which; n_groups: of blocks that it is predicted
               from, each of which from all others
    offsets    by channel, what its log shows more than the model in every run alike [rad, m/s or rad/s]
    changed    channels, "u" and "r", whose factor changes within trials, by their ids: of those alone whose noise as
               estimated lasts so long that it hides that
    misread    logs that are off in single runs, see ``misread_in``; of whole runs alone
    left_open  variance beyond that noise that what the logged inputs leave open accounts for, as a share of it
    slows      by channel, variance that the noise as estimated has in a part that fades slowly, as a share of the white
               one: part of ``channels``, and noise of the sensors where what is left has no structure; 0 of a channel
               whose noise has no white part
    at_most    upper limit of what noise that fades adds to ``channels``, as it may have been estimated too small
    """

    excess: float
    channels: dict[str, float]
    alike: dict[str, float]
    certainty: dict[str, float]
    explained: dict[str, tuple[str, float]]
    offsets: dict[str, float]
    left_open: float = 0.0
    slows: Mapping[str, float] = field(default_factory=dict)
    at_most: Mapping[str, float] = field(default_factory=dict)
    changed: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    misread: Misread = field(default_factory=dict)
    n_groups: int = FEW

    @property
    def unknown(self) -> float:
        """Variance of the residuals that no noise of the sensors accounts for, as a share of their white noise."""
        return self.excess if self.structured else self.excess - min(self._mean(self.at_most), max(self.excess, 0.0))

    @property
    def slow(self) -> float:
        """The mean of ``slows`` over all channels."""
        return self._mean(self.slows)

    def _mean(self, of_channels: Mapping[str, float]) -> float:
        return sum(of_channels.values()) / max(len(self.channels), 1)

    @property
    def alone(self) -> str:
        """Of ``SENSORS`` the one in which alone more than slow noise is left; "" where others err too, or none does.

        Not the positions where a velocity is off as well, be it slowly: they are where it led.
        """
        left = {name: excess - self.at_most.get(name, 0.0) for name, excess in self.channels.items()}
        beyond = {name for name, excess in left.items() if excess > NOTICED}
        whole = sum(max(excess, 0.0) for excess in left.values())
        for own, sensor in SENSORS.items():
            there = sum(max(left.get(name, 0.0), 0.0) for name in own)
            clear = any(left.get(name, 0.0) > CLEARLY for name in own)
            led = sensor == POSITION and any(self.channels.get(name, 0.0) > CLEARLY for name in ("u", "v_m"))
            if clear and not led and there > (MOST if beyond.issubset(own) else NEARLY_ALL) * whole:
                return sensor
        return ""

    @property
    def noticed(self) -> bool:
        """Whether there is anything left to speak of."""
        return self.unknown >= NOTICED

    @property
    def structured(self) -> bool:
        """Whether more is left than noise of the sensors could be."""
        if self.excess < NOTICED:
            return False
        noticed = {name for name, excess in self.channels.items() if excess > NOTICED}
        strong = sum(share > ALIKE for name, (_, share) in self.explained.items() if name in noticed)
        certain = [one for pair, one in self.certainty.items() if noticed.intersection(PAIRS[pair])]
        return strong >= (1 if self.n_groups >= FEW else 2) or max(certain, default=0.0) > CERTAIN


def leftover(bench: Workbench, point: Point) -> Leftover:
    """What is left at a point, on the trials of the workbench."""
    residuals = residuals_of(bench, point)
    rough = _rough(bench)
    white = _level(bench, residuals)
    level = np.where(rough > 0.0, rough, white)
    left_open = _left_open(bench, point)
    excess, excused = {}, {}
    for k, name in enumerate(STATES):
        if np.isfinite(level[k]) and level[k] > 0.0:
            variance = float(np.nanmean(np.concatenate([r[1:, k] for r in residuals]) ** 2))
            beyond = variance / level[k] ** 2 - 1.0
            excused[name] = min(float(left_open[k]) / level[k] ** 2, max(beyond, 0.0))
            excess[name] = beyond - excused[name]
    slow = {name: _slow(bench, name, level[STATES.index(name)], value) for name, value in excess.items()}
    explained, n_groups = _explained(bench, residuals, [name for name, value in excess.items() if value > NOTICED])
    alike = {window: _alike(bench.trials, residuals, window) for window in WINDOWS}
    clearest = {pair: max((alike[window][pair] for window in WINDOWS), key=lambda one: one[1]) for pair in PAIRS}
    return Leftover(
        excess=float(np.mean(list(excess.values()))),
        channels=excess,
        alike={pair: correlation for pair, (correlation, _) in clearest.items()},
        certainty={pair: certainty for pair, (_, certainty) in clearest.items()},
        explained=explained,
        n_groups=n_groups,
        offsets=offsets_of(residuals, level),
        left_open=float(np.mean(list(excused.values()))),
        slows={name: slow for name, (slow, _) in slow.items()},
        at_most={name: at_most for name, (_, at_most) in slow.items()},
        changed=_changed(bench),
        misread={} if any(one.part_of for one in bench.trials) else misread_in(bench.trials, residuals, white),
    )


def _level(bench: Workbench, residuals: Sequence[FloatArray]) -> FloatArray:
    """(6,) deviation of the white noise of the channels."""
    # Second differences do not show the noise of rounding where a channel moves little.
    shown = np.maximum(white_level(residuals), by_channel(bench.trials, rounding_noise))
    return np.where(shown > 0.0, np.maximum(shown, 1e-3 * least_noise(bench.trials)), shown)


def _rough(bench: Workbench) -> FloatArray:
    """(6,) deviation of the noise of channels where all of it fades; 0 of others.

    As white noise such noise looks small: 2 % of its variance is in second differences where it fades in 30 samples.
    """
    found = np.zeros(len(STATES))
    for name, noise in bench.noise.channels.items():
        if noise.rough:
            found[STATES.index(name)] = math.sqrt(noise.variance) * bench.sigma[STATES.index(name)]
    return found


def beside_swell(bench: Workbench, point: Point, period: float) -> float:
    """Largest variance of a channel, over that of its white noise, of what is left but for swinging of a period [s].

    Averages over three periods, with weights of a cosine, hold nothing of that, and a little of the noise.
    """
    residuals = residuals_of(bench, point)
    level = _level(bench, residuals)
    averages, gain = [], 0.0
    for trial, values in zip(bench.trials, residuals, strict=True):
        n = max(2, round(SWELLS * period / float(np.median(np.diff(trial.t)))))
        weights = np.hanning(n + 2)[1:-1] / np.sum(np.hanning(n + 2))
        gain = max(gain, float(np.sum(weights**2)))
        starts = range(1, len(values) - n + 1, n)
        averages += [weights @ values[i : i + n] for i in starts]
    if not averages:
        return math.inf
    of_channel = np.array(averages)
    known = np.isfinite(of_channel).any(axis=0) & (level > 0.0)
    variance = np.nanmean(of_channel[:, known] ** 2, axis=0) / level[known] ** 2
    return float(np.max(variance - gain, initial=0.0))


def _changed(bench: Workbench) -> dict[str, tuple[str, ...]]:
    """See ``Leftover``."""
    step = float(np.median(np.concatenate([np.diff(trial.t) for trial in bench.trials])))
    found: dict[str, tuple[str, ...]] = {}
    for name, noise in bench.noise.channels.items():
        lasts = -step / math.log(noise.phi) if 0.0 < noise.phi < 1.0 else 0.0
        if noise.fading < WANDERS**2 * noise.white or lasts < MINUTE:
            continue
        ids = tuple(trial.id for trial in bench.trials if name in changes_within(trial))
        found |= {name: ids} if ids else {}
    return found


def change_in_words(name: str, ids: Sequence[str]) -> str:
    """A log whose factor changes as a sentence without its full stop."""
    return (
        f"the log of the {LOGGED[name]} reads by another factor from some time on in {listed(ids)}; what that leaves "
        "looks like noise that lasts for minutes"
    )


def _slow(bench: Workbench, name: str, level: float, excess: float) -> tuple[float, float]:
    """See ``Leftover.slows`` and ``at_most``; no more than the channel has beyond its ``level``."""
    noise = bench.noise.channels.get(name)
    if noise is None or not noise.fading:
        return 0.0, 0.0
    fading = noise.fading * (bench.sigma[STATES.index(name)] / level) ** 2
    independent = sum(trial.n_samples for trial in bench.trials) * (1.0 - noise.phi) / (1.0 + noise.phi)
    errors = 0.0 if bench.noise.may_be_error and not noise.rough else ERRORS * math.sqrt(2.0 / max(independent, 1.0))
    slow = 0.0 if noise.rough else fading
    found = np.clip([slow, slow + (SLACK + errors) * fading], 0.0, max(excess, 0.0))
    return float(found[0]), float(found[1])


def residuals_of(bench: Workbench, point: Point) -> list[FloatArray]:
    """Simulated less measured by trial, (n_samples, 6), in SI units; NaN in gaps, and in channels that do not count."""
    counts = np.where([name in bench.channels for name in STATES], 0.0, np.nan)
    return [own - trial.motion + counts for own, trial in zip(motions_of(bench, point), bench.trials, strict=True)]


def motions_of(bench: Workbench, point: Point) -> list[FloatArray]:
    """Simulated motion by trial, (n_samples, 6), in SI units."""
    problem = bench.problem_of(point.names, point.integrator)
    states = problem.states(point.unit[:, None], point.offsets[:, None]).states
    return [states[i, 0, : trial.n_samples] for i, trial in enumerate(bench.trials)]


def offsets_of(residuals: Sequence[FloatArray], sigma: FloatArray) -> dict[str, float]:
    """Channels whose error beyond noise is mostly one number in every run, and that number, measured less simulated.

    residuals  simulated less measured by run, (n_samples, 6), NaN in gaps
    sigma      (6,) white noise of the channels
    """
    found: dict[str, float] = {}
    for name in LOGGED:
        k = STATES.index(name)
        known = [values[1:, k][np.isfinite(values[1:, k])] for values in residuals]
        known = [values for values in known if len(values)]
        if len(known) < FEWEST_RUNS:
            continue
        means = np.array([np.mean(values) for values in known])
        offset = float(np.mean(means))
        excess = float(np.mean(np.concatenate(known) ** 2) - sigma[k] ** 2)
        alike = bool(np.all(np.abs(means - offset) < OFF * abs(offset)))
        if excess <= NOTICED * sigma[k] ** 2 or not alike or offset**2 <= OFF * excess:
            continue
        if by_chance(means) < BY_CHANCE:
            found[name] = -offset
    return found


def by_chance(means: FloatArray) -> float:
    """Probability of a mean as far from zero where values (n,) have none: Student's test.

    Not SciPy's own, for which all of its statistics would be imported: half a second.
    """
    n = len(means)
    with np.errstate(divide="ignore"):
        t = np.abs(np.mean(means)) / (np.std(means, ddof=1) / np.sqrt(n))
    return float(2.0 * stdtr(n - 1, -t))


def in_words(name: str, offset: float) -> str:
    """An offset of the log of a channel as a sentence without its full stop."""
    shown = f"{offset:+.3f} m/s" if name in ("u", "v_m") else f"{offset / DEG:+.3g} deg{'/s' if name == 'r' else ''}"
    return f"The log of the {LOGGED[name]} is off by {shown} in every run alike, most of what is left in that channel"


def _left_open(bench: Workbench, point: Point) -> FloatArray:
    """(6,) variance of each channel that other inputs, alike in the log, bring beyond re-tuning, in SI units.

    The most that one of a few draws brings: a record has few orders, so theirs do not average out.
    """
    linear = linearise(bench, point)
    changed = bench.noise.restore(linear.wander[linear.measured])
    found = np.zeros(len(STATES))
    for name, series in rows_of_channels(bench.problem.cases).items():
        k = STATES.index(name)
        found[k] = np.mean(changed[np.concatenate(series)] ** 2, axis=0).max() * bench.sigma[k] ** 2
    return found


def _alike(trials: Sequence[Trial], residuals: Sequence[FloatArray], window: float) -> dict[str, tuple[float, float]]:
    """Correlation over windows of what a level's residual gains with what its rate's adds up to, and that in standard
    errors (Fisher's transformation)."""
    turning, moving = PAIRS
    pairs: dict[str, list[FloatArray]] = {pair: [] for pair in PAIRS}
    for trial, r in zip(trials, residuals, strict=True):
        dt = np.diff(trial.t)
        n = max(2, round(window / float(np.median(dt))))
        e_psi = r[:, 2]
        way_north, way_east = to_earth(trial.psi, trial.u, trial.v_m)
        north, east = to_earth(trial.psi, r[:, 3], r[:, 4])
        north, east = north - e_psi * way_east, east + e_psi * way_north
        for pair, level, rate in (
            (turning, e_psi, r[:, 5]),
            (moving, r[:, 0], north),
            (moving, r[:, 1], east),
        ):
            summed = np.concatenate([[0.0], np.cumsum(0.5 * (rate[1:] + rate[:-1]) * dt)])
            pairs[pair].append(np.column_stack([level[n::n] - level[:-n:n], summed[n::n] - summed[:-n:n]]))
    found = {}
    for pair, parts in pairs.items():
        both = np.concatenate(parts)
        both = np.asarray(both[np.isfinite(both).all(axis=1)])
        enough = len(both) > 10 and bool(np.all(np.std(both, axis=0) > 0.0))
        correlation = float(np.asarray(np.corrcoef(both.T))[0, 1]) if enough else 0.0
        certainty = float(np.arctanh(min(correlation, 0.999999)) * np.sqrt(max(len(both) - 3, 1)))
        found[pair] = (correlation, certainty)
    return found


def _explained(
    bench: Workbench, residuals: Sequence[FloatArray], channels: Sequence[str]
) -> tuple[dict[str, tuple[str, float]], int]:
    """By channel, the quantity that explains most of the slow part of its residual; none where windows are short.  And
    from how many groups of blocks that is predicted."""
    lengths = [max(2, round(BLOCK / float(np.median(np.diff(trial.t))))) for trial in bench.trials]

    def means(values: Sequence[FloatArray]) -> FloatArray:
        blocks = [v[: len(v) // n * n].reshape(-1, n) for v, n in zip(values, lengths, strict=True)]
        with np.errstate(invalid="ignore"):  # of a block in which nothing was measured: not a number
            return np.concatenate([np.nansum(one, axis=1) / np.isfinite(one).sum(axis=1) for one in blocks])

    states = {
        "heading": means([np.mod(trial.psi, 2.0 * np.pi) for trial in bench.trials]),
        "speed": means([np.hypot(trial.u, trial.v_m) for trial in bench.trials]),
        "drift": means([np.arctan2(-trial.v_m, trial.u) for trial in bench.trials]),
        "yaw rate": means([trial.r for trial in bench.trials]),
        "rudder angle": means([trial.delta for trial in bench.trials]),
        "time": means([trial.t for trial in bench.trials]),
    }
    whole = enumerate(zip(bench.trials, lengths, strict=True))
    blocks = np.concatenate([np.arange(trial.n_samples // n) // 3 + 1000 * i for i, (trial, n) in whole])
    found = {}
    for name in channels:
        y = means([r[:, STATES.index(name)] for r in residuals])
        if len(np.unique(blocks[np.isfinite(y)])) < FEWEST_BLOCKS:  # short windows: nothing to predict one from
            continue
        shares = share_explained(y, states, blocks=blocks)
        best = max(shares, key=lambda one: shares[one])
        found[name] = (best, float(shares[best]))
    return found, len(np.unique(blocks))
