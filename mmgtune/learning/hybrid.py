"""A network trained for what a model of forces leaves, inside the model's own roll-out."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..arrays import FloatArray, IntArray
from ..backends import STATES, Integrator
from ..backends.differentiable import Log, Marching, on_jax
from ..backends.twins import jax_module
from ..model import Model
from ..networks.hybrid import HybridLanes
from ..networks.residual import Ranges, ResidualWeights, seen
from ..trial import Trial
from ..validation import L_MSE, by_manoeuvre, score
from .choosing import Chooser, Single, from_origin, pieces_of
from .gains import relative
from .samples import Samples
from .starting import acceleration_deviations

EULER = Integrator("euler")
"""Method within training: at half a second scores differ by less than a hundredth from those at a tenth."""

ROBUST = 1.0
"""Error of a window, over that of the model of forces on its kind of manoeuvre, from which it counts by its root."""

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
    sides = [1.0, -1.0, -1.0]
    inputs = [-1.0 if role in ("rudder", "thruster") else 1.0 for role in roles]
    return Ranges(
        deviation=deviation,
        largest=np.maximum(largest, 1e-3),
        accelerations=acceleration_deviations(samples),
        mirrored=np.array([*sides, *inputs, 1.0, -1.0, *sides]),
    )


class HybridAim:
    """The network of a hybrid on windows of ``horizon`` samples; the model of forces stays as it is.

    penalty  weight of the mean square of what the network adds, over the deviations of accelerations
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
        penalty: float,
        restart: float | None,
    ):
        jnp = jax_module().numpy
        self.starts = balanced(learn, horizon)
        self.model, self.memory, self.horizon, self.penalty, self.step = model, memory, horizon, penalty, learn.step
        self.ranges = Ranges(*(jnp.asarray(one, dtype=Single) for one in ranges))
        self.theta = jnp.asarray(model.matrix()[:, 0], dtype=Single)
        self.sigma = jnp.asarray(sigma, dtype=Single)
        self._chooser = Chooser(
            lambda *given: self.roll(*given)[0],
            choose,
            model.inputs,
            learn.step,
            sigma,
            restart=restart,
            draught=model.draught,
        )
        self.runs = self._chooser.runs
        typical = typical_errors(model, learn.trials, restart, sigma)
        by_trial = np.array([typical[trial.manoeuvre] for trial in learn.trials])
        self.data = {
            "states": jnp.asarray(learn.states, dtype=Single),
            "controls": jnp.asarray(learn.controls, dtype=Single),
            "around": jnp.asarray(learn.around, dtype=Single),
            "typical": jnp.asarray(np.repeat(by_trial, np.diff(learn.first)), dtype=Single),
        }
        self._alone: dict[str, float] = {}

    def roll(self, w: ResidualWeights, initial: Any, controls: Any, around: Any) -> tuple[Any, Any]:
        """States (T, n, 6) from ``initial`` (n, 6) over samples (T, n, ...), and what the network added (T - 1, n, 3)
        over its deviations."""
        jax = jax_module()
        numpy = jax.numpy
        T, n = controls.shape[:2]
        t = numpy.broadcast_to(self.step * numpy.arange(T, dtype=Single)[:, None], (T, n))
        log = Log(t, np.full(n, T), controls, around)
        lanes = HybridLanes(self.model, self.theta, weights=w, ranges=self.ranges, memory=self.memory, on=on_jax())
        march = Marching(lanes, log, EULER, lanes.rates)

        def body(now: Any, samples: Any) -> Any:
            added = lanes.added(now.s, now.chain[-1], now.around) / self.ranges.accelerations
            now, shown = march.body(now, samples)
            return now, (numpy.stack(shown, axis=-1), added)

        _, (shown, added) = jax.lax.scan(jax.checkpoint(body), march.begin(initial), march.samples)
        return numpy.concatenate([initial[None], shown]), added

    def loss(self, w: ResidualWeights, starts: Any, data: Any) -> Any:
        """See ``Aim``."""
        numpy = jax_module().numpy
        rows = starts[None, :] + numpy.arange(self.horizon + 1)[:, None]
        states = from_origin(data["states"][rows])
        found, added = self.roll(w, states[0], data["controls"][rows], data["around"][rows])
        error = numpy.sum(numpy.mean(((found - states) / self.sigma)[1:] ** 2, axis=0), axis=-1)
        error = error / data["typical"][starts]
        robust = 2.0 * ROBUST * (numpy.sqrt(1.0 + error / ROBUST) - 1.0)
        return numpy.mean(robust) + self.penalty * numpy.mean(added**2)

    def alone(self, w: ResidualWeights) -> dict[str, float]:
        """L_MSE by run of the model of forces alone, on the windows that choose."""
        if not self._alone:
            self._alone = self._chooser.by_run(w._replace(W_3=0.0 * w.W_3))
        return self._alone

    def judged(self, w: ResidualWeights) -> dict[str, float]:
        """See ``Aim``: L_MSE by run, and the score of ``relative``."""
        errors = self._chooser.by_run(w)
        return {"score": relative(self.alone(w), errors, self.runs), **errors}


def typical_errors(model: Model, trials: Sequence[Trial], restart: float | None, sigma: FloatArray) -> dict[str, float]:
    """L_MSE of the model of forces alone, by kind of manoeuvre."""
    scores = score(model, pieces_of(trials, restart), dict(zip(STATES, sigma.tolist(), strict=True)))
    return {kind: L_MSE(of) for kind, of in by_manoeuvre(scores).items()}


def balanced(samples: Samples, horizon: int) -> IntArray:
    """Rows at which windows begin, each kind of manoeuvre as often as any other."""
    starts = samples.starts(horizon)
    kinds = np.array(samples.kinds(starts))
    several = [starts[kinds == kind] for kind in sorted({*kinds.tolist()})]
    most = max((len(one) for one in several), default=0)
    return np.concatenate([np.resize(one, most) for one in several]) if several else starts
