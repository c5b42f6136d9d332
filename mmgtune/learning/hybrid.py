"""A network trained for what a model of forces leaves, inside the model's own roll-out."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np

from ..arrays import FloatArray, IntArray
from ..backends import STATES, Integrator
from ..backends.differentiable import Log, Marching, on_jax
from ..backends.twins import jax_module
from ..model import Model
from ..networks.hybrid import HybridLanes
from ..networks.motion import SIDES, mirror
from ..networks.residual import Ranges, ResidualWeights, seen
from ..scores import L_MSE, by_manoeuvre, score
from ..trial import Trial
from .choosing import Chooser, Single, Squares, from_origin, pieces_of, squares_of
from .gains import Runs, relative
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
    return Ranges(
        deviation=deviation,
        largest=np.maximum(largest, 1e-3),
        accelerations=acceleration_deviations(samples),
        mirrored=np.array([*mirror(roles), *SIDES]),
    )


class ResidualLoss:
    """Roll-outs of a model of forces with a network beside it, and their loss: the same for all parts of the runs.

    model    its components and effects; coefficients are data
    memory   time constant of the network's memory [s]
    step     of the integration [s]
    horizon  samples that a window has
    """

    def __init__(self, model: Model, *, memory: float, step: float, horizon: int):
        self.model, self.memory, self.step, self.horizon = model, memory, step, horizon

    def roll(self, w: ResidualWeights, fixed: Any, initial: Any, controls: Any, around: Any) -> tuple[Any, Any]:
        """States (T, n, 6) from ``initial`` (n, 6) over samples (T, n, ...), and what the network added (T - 1, n, 3)
        over its deviations.

        fixed  coefficients ``theta`` of the model (n_rows,) and ``ranges`` of the network
        """
        jax = jax_module()
        numpy = jax.numpy
        T, n = controls.shape[:2]
        t = numpy.broadcast_to(self.step * numpy.arange(T, dtype=Single)[:, None], (T, n))
        log = Log(t, np.full(n, T), controls, around)
        ranges = fixed["ranges"]
        lanes = HybridLanes(self.model, fixed["theta"], weights=w, ranges=ranges, memory=self.memory, on=on_jax())
        march = Marching(lanes, log, EULER)

        def body(now: Any, samples: Any) -> Any:
            added = lanes.added(now.s, now.chain[-1], now.around) / ranges.accelerations
            now, shown = march.body(now, samples)
            return now, (numpy.stack(shown, axis=-1), added)

        _, (shown, added) = jax.lax.scan(jax.checkpoint(body), march.begin(initial), march.samples)
        return numpy.concatenate([initial[None], shown]), added

    def __call__(self, w: ResidualWeights, starts: Any, data: Any) -> Any:
        """Loss of the windows that begin in rows ``starts`` (n,) of ``HybridAim.data``."""
        numpy = jax_module().numpy
        rows = starts[None, :] + numpy.arange(self.horizon + 1)[:, None]
        states = from_origin(data["states"][rows])
        found, added = self.roll(w, data["fixed"], states[0], data["controls"][rows], data["around"][rows])
        error = numpy.sum(numpy.mean(((found - states) / data["sigma"])[1:] ** 2, axis=0), axis=-1)
        error = error / data["typical"][starts]
        robust = 2.0 * ROBUST * (numpy.sqrt(1.0 + error / ROBUST) - 1.0)
        return numpy.mean(robust) + data["penalty"] * numpy.mean(added**2)

    @cached_property
    def squares(self) -> Squares:
        """See ``squares_of``; parameters are weights and what is fixed."""
        return squares_of(lambda given, *windows: self.roll(*given, *windows)[0])


class HybridAim:
    """The network of a hybrid on windows of runs; the model of forces stays as it is.

    loss     of this kind of model
    model    of forces, with its coefficients
    choose   runs that choose among weights; none where the number of updates is known
    penalty  weight of the mean square of what the network adds, over the deviations of accelerations
    rows     that the data is filled up to, so that several parts of runs share one compilation
    """

    def __init__(
        self,
        loss: ResidualLoss,
        model: Model,
        learn: Samples,
        choose: Sequence[Trial],
        ranges: Ranges,
        *,
        sigma: FloatArray,
        penalty: float,
        restart: float | None,
        rows: int = 0,
    ):
        self.loss = loss
        self.starts = balanced(learn, loss.horizon)
        typical = typical_errors(model, learn.trials, restart, sigma)
        by_trial = np.array([typical[trial.manoeuvre] for trial in learn.trials])
        filled = rows - len(learn.states)

        def table(values: FloatArray) -> Any:
            more = ((0, max(0, filled)), *((0, 0),) * (values.ndim - 1))
            return single(np.pad(values, more))

        self.data = {
            "states": table(learn.states),
            "controls": table(learn.controls),
            "around": table(learn.around),
            "typical": table(np.repeat(by_trial, np.diff(learn.first))),
            "sigma": single(sigma),
            "penalty": single(penalty),
            "fixed": {"theta": single(model.matrix()[:, 0]), "ranges": Ranges(*(single(one) for one in ranges))},
        }
        self._chooser = None
        if choose:
            self._chooser = Chooser(
                loss.squares, choose, model.inputs, learn.step, sigma, restart=restart, draught=model.draught
            )
        self._alone: dict[str, float] = {}

    @property
    def runs(self) -> Runs:
        """Those that choose."""
        return self._chooser.runs if self._chooser else {}

    def alone(self, w: ResidualWeights) -> dict[str, float]:
        """L_MSE by run of the model of forces alone, on the windows that choose."""
        if not self._alone:
            self._alone = self._by_run(w._replace(W_3=0.0 * w.W_3))
        return self._alone

    def judged(self, w: ResidualWeights) -> dict[str, float]:
        """See ``Aim``: L_MSE by run, and the score of ``relative``."""
        errors = self._by_run(w)
        return {"score": relative(self.alone(w), errors, self.runs), **errors} if errors else {}

    def _by_run(self, w: ResidualWeights) -> dict[str, float]:
        return self._chooser.by_run((w, self.data["fixed"])) if self._chooser else {}


def single(values: Any) -> Any:
    """An array of JAX in single precision."""
    return jax_module().numpy.asarray(values, dtype=Single)


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
