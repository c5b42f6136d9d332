"""A network trained for what a model of forces leaves, inside the model's own roll-out."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..arrays import FloatArray, IntArray
from ..backends import Integrator
from ..backends.differentiable import Log, Marching, on_jax
from ..backends.twins import jax_module
from ..model import Model
from ..networks.hybrid import HybridLanes
from ..networks.residual import Ranges, ResidualWeights
from ..trial import Trial
from ..trial.pieces import windows
from .samples import Samples, samples_of

Single = np.float32

EULER = Integrator("euler")
"""Method within training: at half a second scores differ by less than a hundredth from those at a tenth."""

ROBUST = 0.3
"""Error of a window, in L_MSE, from which it counts by its root: one lost window rules nothing."""

QUANTILE = 0.999
"""Share of the data within the largest value of a feature."""


def first_residual(n_features: int, width: int, seed: int) -> ResidualWeights:
    """Weights that add nothing yet: the last layer is zero."""
    rng = np.random.default_rng([seed, 4])
    return ResidualWeights(
        W_1=(rng.standard_normal((n_features, width)) / np.sqrt(n_features)).astype(Single),
        b_1=(0.3 * rng.standard_normal(width)).astype(Single),
        W_2=(rng.standard_normal((width, width)) / np.sqrt(width)).astype(Single),
        b_2=(0.3 * rng.standard_normal(width)).astype(Single),
        W_3=np.zeros((width, 3), dtype=Single),
    )


def ranges_of(samples: Samples, memory: float, roles: Sequence[str]) -> Ranges:
    """Deviations and largest values of features in the data, with the memory as it was while the ship was measured.

    roles  of the inputs: a rudder changes sign where port and starboard change places
    """
    from ..networks.residual import seen

    n_inputs = samples.controls.shape[1]
    plain = Ranges(np.ones(n_inputs + 8), np.ones(n_inputs + 8), np.ones(3), np.ones(n_inputs + 8))
    settled = np.full((len(samples.states), 3), np.nan)
    for begin, end in zip(samples.first[:-1], samples.first[1:], strict=True):
        now = None
        for row in range(begin, end):
            velocities = samples.states[row, 3:]
            if not np.isfinite(velocities).all():
                now = None
                continue
            now = velocities if now is None else now + samples.step / memory * (velocities - now)
            settled[row] = now
    states = samples.states
    x = seen(states[:, 3:], samples.controls, samples.wind, states[:, 2], settled, plain)
    x = x[np.isfinite(x).all(axis=1)]
    deviation = np.sqrt(np.mean(x**2, axis=0))
    deviation = np.where(deviation > 0.0, deviation, 1.0)
    largest = np.quantile(np.abs(x) / deviation, QUANTILE, axis=0)
    stride = max(1, round(1.0 / samples.step))
    starts = samples.starts(stride)
    rates = (states[starts + stride, 3:] - states[starts, 3:]) / (stride * samples.step)
    sides = [1.0, -1.0, -1.0]
    inputs = [-1.0 if role in ("rudder", "thruster") else 1.0 for role in roles]
    return Ranges(
        deviation=deviation,
        largest=np.maximum(largest, 1e-3),
        accelerations=np.sqrt(np.mean(rates**2, axis=0)),
        mirrored=np.array([*sides, *inputs, 1.0, -1.0, *sides]),
    )


class HybridAim:
    """The network of a hybrid on windows of ``horizon`` samples; the model of forces stays as it is.

    quiet  weight of the mean square of what the network adds, over the deviations of accelerations
    """

    def __init__(
        self,
        model: Model,
        learn: Samples,
        choose: Sequence[Trial],
        ranges: Ranges,
        *,
        memory: float,
        sigma: FloatArray,
        horizon: int,
        quiet: float,
        restart: float | None,
    ):
        jnp = jax_module().numpy
        self.starts: IntArray = learn.starts(horizon)
        self.model, self.memory, self.horizon, self.quiet, self.step = model, memory, horizon, quiet, learn.step
        self.ranges = Ranges(*(jnp.asarray(one, dtype=Single) for one in ranges))
        self.theta = jnp.asarray(model.matrix()[:, 0], dtype=Single)
        self.sigma = jnp.asarray(sigma, dtype=Single)
        self._states = jnp.asarray(learn.states, dtype=Single)
        self._controls = jnp.asarray(learn.controls, dtype=Single)
        self._around = jnp.asarray(learn.around, dtype=Single)
        self._windows = _Windows(model, learn.step, choose, restart, sigma)
        self._errors = jax_module().jit(self._squares)

    def roll(self, w: ResidualWeights, initial: Any, controls: Any, around: Any) -> tuple[Any, Any]:
        """States (T, n, 6) from ``initial`` (n, 6) over samples (T, n, ...), and what the network added (T - 1, n, 3)
        over its deviations."""
        jax = jax_module()
        numpy = jax.numpy
        T, n = controls.shape[:2]
        t = numpy.broadcast_to(self.step * numpy.arange(T, dtype=Single)[:, None], (T, n))
        log = Log(t, np.full(n, T), controls, around)
        lanes = HybridLanes(
            self.model, self.theta, weights=w, ranges=self.ranges, memory=self.memory, on=on_jax()
        )
        march = Marching(lanes, log, EULER, lanes.rates)

        def body(now: Any, samples: Any) -> Any:
            added = lanes.added(now.s, now.chain[-1], now.around) / self.ranges.accelerations
            now, shown = march.body(now, samples)
            return now, (numpy.stack(shown, axis=-1), added)

        _, (shown, added) = jax.lax.scan(jax.checkpoint(body), march.begin(initial), march.samples)
        return numpy.concatenate([initial[None], shown]), added

    def loss(self, w: ResidualWeights, starts: Any) -> Any:
        """See ``Aim``."""
        numpy = jax_module().numpy
        rows = starts[None, :] + numpy.arange(self.horizon + 1)[:, None]
        states = self._states[rows]
        begin = numpy.concatenate([states[:1, :, :2], numpy.zeros_like(states[:1, :, 2:])], axis=-1)
        states = states - begin
        found, added = self.roll(w, states[0], self._controls[rows], self._around[rows])
        error = numpy.sum(numpy.mean(((found - states) / self.sigma)[1:] ** 2, axis=0), axis=-1)
        robust = 2.0 * ROBUST * (numpy.sqrt(1.0 + error / ROBUST) - 1.0)
        return numpy.mean(robust) + self.quiet * numpy.mean(added**2)

    def _squares(self, w: ResidualWeights, initial: Any, controls: Any, around: Any, states: Any, counts: Any) -> Any:
        numpy = jax_module().numpy
        off = (self.roll(w, initial, controls, around)[0] - states) / self.sigma
        return numpy.sum(numpy.where(counts, off * off, 0.0), axis=0)

    def errors(self, w: ResidualWeights) -> dict[str, float]:
        """L_MSE by kind of manoeuvre on the windows that choose."""
        squares = np.asarray(self._errors(w, *self._windows.given), dtype=float)
        return self._windows.by_kind(squares)

    def score(self, w: ResidualWeights) -> float:
        """See ``Aim``: the mean over kinds of manoeuvre."""
        total = float(np.mean(list(self.errors(w).values())))
        return total if np.isfinite(total) else float("inf")


class _Windows:
    """Windows of trials side by side, padded at the end: what a score compares."""

    def __init__(self, model: Model, step: float, trials: Sequence[Trial], restart: float | None, sigma: FloatArray):
        jnp = jax_module().numpy
        pieces = [piece for trial in trials for piece in (windows(trial, restart) if restart else [trial])]
        cut = samples_of(pieces, model.inputs, step, model.draught)
        lengths = np.diff(cut.first)
        T, n = int(lengths.max()), len(pieces)
        rows = cut.first[:-1] + np.minimum(np.arange(T)[:, None], lengths - 1)
        states = cut.states[rows].copy()
        states[:, :, :2] -= states[:1, :, :2]
        counts = np.isfinite(states) & (np.arange(T)[:, None] < lengths)[:, :, None]
        counts[0] = False
        states = np.nan_to_num(states)
        self.kinds = np.array([piece.manoeuvre for piece in pieces])
        self.counts = counts.sum(axis=0)
        self.given = (
            jnp.asarray(states[0], dtype=Single),
            jnp.asarray(cut.controls[rows], dtype=Single),
            jnp.asarray(cut.around[rows], dtype=Single),
            jnp.asarray(states, dtype=Single),
            jnp.asarray(counts),
        )

    def by_kind(self, squares: FloatArray) -> dict[str, float]:
        """L_MSE by kind from squares (n_windows, 6) over their variance."""
        found = {}
        for kind in sorted(set(self.kinds.tolist())):
            of = self.kinds == kind
            n = self.counts[of].sum(axis=0)
            found[str(kind)] = float(np.sum(squares[of].sum(axis=0)[n > 0] / n[n > 0]))
        return found
