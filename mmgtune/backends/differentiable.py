"""The equations on JAX: lanes in one compiled scan, for ``Backend.run`` and for whoever needs derivatives.

``rates_of``, ``matrix_of`` and ``rollout`` are functions that JAX can trace: put them into a loss and differentiate it.
They compute in the precision of what they are given; ``JaxLanes`` computes in double precision whatever JAX is set to.

    import jax
    from mmgtune.backends.differentiable import Log, matrix_of, rollout

    def loss(values):
        theta = matrix_of(model, names)(values)
        return jax.numpy.mean((rollout(model, theta, initial, log) - measured) ** 2)

    with jax.enable_x64(True):
        gradient = jax.jit(jax.grad(loss))(values)

One step is ``Marching.body``, the body of the scan, with which other scans can be built.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache, partial
from typing import Any, NamedTuple

import numpy as np

from ..arrays import FloatArray, IntArray
from ..effects import CoefficientsEffect, LagEffect
from ..model import Model
from ..physics.integration import between
from ..physics.quantities import HELD, UNKNOWN, State, Surroundings
from .cases import Cases, Integrator, LaneResult, finish
from .numpy_lanes import N_STATES, Arithmetic, LaneModel, Moment
from .twins import jax_module, twin

Array = Any
"""An array of NumPy or of JAX."""

Rates = Callable[[tuple[Array, ...], Any, Surroundings, Array], tuple[Array, ...]]
"""Rates of states, (n_lanes,) each, from them, what acts, the surroundings, and the step [s]."""


@cache
def on_jax() -> Arithmetic:
    """What evaluates equations on JAX.  Raises OptionError where JAX is missing."""
    return Arithmetic(of=twin, states=tuple, each=_each)


def _each(function: Callable[..., Array], *given: Any) -> tuple[Array, ...]:
    """States are kept apart, in a tuple: one array of all has XLA compute the forces anew for each of them."""
    count = next(len(one) for one in given if isinstance(one, tuple))
    return tuple(function(*(one[k] if isinstance(one, tuple) else one for one in given)) for k in range(count))


def rates_of(model: Model) -> Callable[[Array, Array, Any, Surroundings, Array], Array]:
    """A function that JAX can trace: the rates (6, ...) of states (6, ...).

    Its arguments: theta (n_rows,) or (n_rows, ...), as of ``matrix_of``; state (6, ...) x, y [m], psi [rad], u, v_m
    [m/s], r [rad/s]; control, the inputs that act, a tuple in the order of ``model.inputs``; the Surroundings
    (``UNKNOWN`` where nothing was measured); and h [s], the step of the integration, which nothing but lags looks at.
    Effects on flow, factors and force act; those on clocks, actuators and sensors are before and behind it.
    Raises ValueError for a model with lags, whose rates are not those of the six states alone.
    """
    if model.acting(LagEffect):
        raise ValueError("a model with lags has more states than six")

    def rates(theta: Array, state: Array, control: Any, around: Surroundings, h: Array) -> Array:
        numpy = jax_module().numpy
        parts = numpy.broadcast_arrays(*state, *control)
        acts = model.arrangement.control(*parts[N_STATES:])
        return numpy.stack(LaneModel(model, theta, on_jax()).rates(parts[:N_STATES], acts, Surroundings(*around), h))

    return rates


def matrix_of(model: Model, names: Sequence[str] = ()) -> Callable[[Array], Array]:
    """``Model.matrix`` as a function that JAX can trace: values (n_names, ...) -> coefficients (n_rows, ...).

    Effects on coefficients have acted on what it returns.  Raises ProfileError for an unknown name.
    """
    rows = np.array(model.rows_of(names), dtype=np.int64)
    base = model.base

    def matrix(values: Array) -> Array:
        numpy, of = jax_module().numpy, on_jax().of
        values = numpy.asarray(values)
        theta = numpy.broadcast_to(base.reshape(-1, *(1,) * (values.ndim - 1)), (len(base), *values.shape[1:]))
        theta = theta.astype(values.dtype).at[rows].set(values)
        for effect in model.acting(CoefficientsEffect):
            now = {name: theta[row] for name, row in model.rows.items()}
            changed = of(effect.function)(now, model.parameters(effect, theta))
            for name, value in changed.items():
                theta = theta.at[model.rows[name]].set(value)
        return theta

    return matrix


class Log(NamedTuple):
    """What drives lanes, samples first, so that a scan runs over it.

    t          (T, n_logs) time [s]; repeats its last where a log is shorter
    n_samples  (n_logs,) samples of each
    controls   (T, n_logs, n_inputs), in the order of ``model.inputs``
    around     (T, n_logs, n_surroundings), in the order of ``Surroundings``
    log_of     (n_lanes,) which log drives each lane; None where lane i has log i
    """

    t: Array
    n_samples: Array
    controls: Array
    around: Array
    log_of: Array | None = None

    def per_lane(self, values: Array) -> Array:
        """(n_lanes, ...) of (n_logs, ...)."""
        if self.log_of is None:
            return values
        if len(values) == 1:
            return jax_module().numpy.broadcast_to(values, (len(self.log_of), *values.shape[1:]))
        return values[self.log_of]


def log_of_cases(cases: Cases, log_of: Array | None = None) -> Log:
    """The log of cases; by default a lane to each of them."""
    return Log(cases.t.T, cases.n_samples, _swapped(cases.controls), _swapped(cases.around), log_of)


def _swapped(values: Array) -> Array:
    """Logs before samples, or the other way round."""
    return values.swapaxes(0, 1)


class Sample(NamedTuple):
    """The log at one sample: t (n_logs,), controls (n_logs, n_inputs), around (n_logs, n_surroundings)."""

    t: Array
    controls: Array
    around: Array


@dataclass(frozen=True, eq=False)
class Marching:
    """Lanes of a model along a log, from sample to sample.

    by  what takes the place of the model's own rates: a model and something learnt, say
    """

    ship: LaneModel
    log: Log
    integrator: Integrator = Integrator()
    by: Rates | None = None

    @property
    def samples(self) -> tuple[Sample, Sample]:
        """The log at the beginning and at the end of each step: what the scan runs over."""
        whole = Sample(self.log.t, self.log.controls, self.log.around)
        return Sample(*(values[:-1] for values in whole)), Sample(*(values[1:] for values in whole))

    def begin(self, initial: Array) -> Moment:
        """Where lanes start, from the states (n_lanes, 6) that the sensors show."""
        first = Sample(self.log.t[0], self.log.controls[0], self.log.around[0])
        logged, around, _ = self._given((first, first), 0.0)
        return self.ship.begin(self.ship.unsensed(State(*initial.T)), logged, around)

    def body(self, now: Moment, samples: tuple[Sample, Sample]) -> tuple[Moment, State]:
        """One sample later, and the State as the sensors show it: the body of a scan."""
        if self.integrator.substeps == 1:
            now, _ = self._substep(now, (samples, 1.0))
        else:
            count = self.integrator.substeps
            shares = np.arange(1, count + 1, dtype=now.s[0].dtype) / count
            now, _ = jax_module().lax.scan(lambda at, f: self._substep(at, (samples, f)), now, shares)
        return now, self.ship.shown(now)

    def _substep(self, now: Moment, given: tuple[tuple[Sample, Sample], Array]) -> tuple[Moment, None]:
        logged, around, step = self._given(*given)
        h = step / self.integrator.substeps
        return self.ship.step(now, logged, around, h, self.integrator, self.by), None

    def _given(self, samples: tuple[Sample, Sample], f: Array) -> tuple[Any, Surroundings, Array]:
        """Inputs and surroundings at the share f of a step, and the length of the whole step [s]."""
        before, after = samples
        log = self.log
        shift = self.ship.shift
        if all(late is None for late in shift):
            logged = log.per_lane(between(before.controls, after.controls, f)).T
        else:
            time = log.per_lane(between(before.t, after.t, f))
            t, n, values = log.per_lane(log.t.T), log.per_lane(log.n_samples), log.per_lane(_swapped(log.controls))
            at = jax_module().vmap(_logged_at)
            logged = [at(time if late is None else time + late, t, n, values[:, :, k]) for k, late in enumerate(shift)]
        around = UNKNOWN
        if self.ship.looks_around or self.by:
            held = np.array([name in HELD for name in Surroundings._fields])
            found = jax_module().numpy.where(held, after.around, between(before.around, after.around, f))
            around = Surroundings(*log.per_lane(found).T)
        return self.ship.arrangement.control(*logged), around, log.per_lane(after.t - before.t)


def _logged_at(time: Array, t: Array, n: Array, values: Array) -> Array:
    """Values (T,) logged at t (T,), of which n count, at a time: linear between samples, held beyond the ends.

    At a sample the derivative by the time is the mean of those before and after, as a central difference finds it.
    """
    numpy = jax_module().numpy
    last = t[n - 1]
    time = numpy.minimum(numpy.maximum(time, t[0]), last)  # of half a derivative at either end, unlike clip
    k = numpy.clip(numpy.searchsorted(t, time, side="right"), 1, n - 1)
    slope = (values[k] - values[k - 1]) / _length(t[k] - t[k - 1])
    earlier = numpy.maximum(k - 2, 0)
    at_sample = (time == t[k - 1]) & (k > 1)
    into = time - t[k - 1]
    mean = 0.5 * (slope + (values[k - 1] - values[earlier]) / _length(t[k - 1] - t[earlier]))
    return values[k - 1] + into * numpy.where(at_sample, mean, slope)


def _length(step: Array) -> Array:
    """A step [s], 1 where it has none."""
    return jax_module().numpy.where(step > 0.0, step, 1.0)


def rollout(
    model: Model,
    theta: Array,
    initial: Array,
    log: Log,
    *,
    integrator: Integrator = Integrator(),
    by: Callable[[LaneModel], Rates] | None = None,
) -> Array:
    """States (T, n_lanes, 6) as the sensors show them, from ``initial`` (n_lanes, 6): a function that JAX can trace.

    theta  (n_rows, n_lanes), as of ``matrix_of``
    by     from the lanes' model, what takes the place of its rates
    Gradients keep the state of every step and compute the rest of it anew (``jax.checkpoint``).
    """
    jax = jax_module()
    ship = LaneModel(model, theta, on_jax())
    lanes = Marching(ship, log, integrator, by(ship) if by else None)
    _, shown = jax.lax.scan(jax.checkpoint(lanes.body), lanes.begin(initial), lanes.samples)
    return jax.numpy.concatenate([initial[None], jax.numpy.stack(shown, axis=-1)])


class JaxLanes:
    """Runs the scan under jit, in portions that bound its memory; double precision."""

    name = "jax"

    def __init__(self) -> None:
        jax_module()
        self._compiled: dict[Any, tuple[Model, Callable[..., Any]]] = {}

    def run(
        self,
        model: Model,
        theta: FloatArray,
        cases: Cases,
        *,
        initial: FloatArray | None = None,
        integrator: Integrator = Integrator(),
        keep_states: bool = False,
        keep_residuals: bool = False,
        paired: bool = False,
    ) -> LaneResult:
        """See ``Backend.run``."""
        n_cases, n_candidates = len(cases), 1 if paired else theta.shape[-1]
        T = cases.t.shape[1]
        if initial is None:
            initial = np.repeat(cases.initial[:, None], n_candidates, axis=1)
        cost, fastest2 = np.zeros((n_cases, n_candidates)), np.zeros((n_cases, n_candidates))
        last = initial.copy()
        states = np.empty((n_cases, n_candidates, T, N_STATES)) if keep_states else None
        residuals = np.empty((cases.n_residuals, n_candidates)) if keep_residuals else None
        keep = keep_states or keep_residuals
        march = self._marching(model, integrator, keep)
        with jax_module().enable_x64(True):
            for case, candidate in _portions(cases, n_candidates):
                of, steps = len(case), int(cases.n_samples[case].max(initial=1))
                lanes = filled(of)
                case_of, candidate_of = case[lanes], candidate[lanes]
                own, log_of = np.unique(case_of, return_inverse=True)
                if theta.ndim == 3:
                    of_lane = theta[:, case_of, candidate_of]
                else:
                    of_lane = theta[:, case_of if paired else candidate_of]
                found = march(of_lane, initial[case_of, candidate_of], _given(cases, own, log_of, steps))
                J, v2, end, shown = (np.asarray(values) for values in found)
                cost[case, candidate], fastest2[case, candidate], last[case, candidate] = J[:of], v2[:of], end.T[:of]
                if not keep:
                    continue
                shown = np.concatenate([initial[None, case, candidate], shown[: steps - 1, :, :of].transpose(0, 2, 1)])
                if states is not None:
                    states[case, candidate, :steps] = shown.transpose(1, 0, 2)
                    states[case, candidate, steps:] = shown[-1][:, None]
                if residuals is not None:
                    _put_residuals(residuals, cases, case, candidate, shown)
        return finish(cost, fastest2, last, states, residuals)

    def _marching(self, model: Model, integrator: Integrator, keep: bool) -> Callable[..., Any]:
        """The compiled simulator for the components of a model; compiled anew for other counts of lanes or samples."""
        parts = (model.arrangement, *model.parts, *model.effects)
        key = (tuple(model.rows), tuple(map(id, parts)), integrator, keep)
        if key not in self._compiled:  # beside the model, so that no other part comes to have the identity of one
            self._compiled[key] = model, jax_module().jit(partial(_march, model, integrator, keep))
        return self._compiled[key][1]


PORTION = 1 << 20
"""Lanes times samples that run at once: some 50 MB where states are kept."""


def _portions(cases: Cases, n_candidates: int) -> Iterator[tuple[IntArray, IntArray]]:
    """Case and candidate of the lanes that run together: cases of like length, so that few wait for the longest."""
    case = np.repeat(np.argsort(cases.n_samples, kind="stable"), n_candidates)
    candidate = np.tile(np.arange(n_candidates), len(cases))
    longest = filled_length(int(cases.n_samples.max(initial=1)))
    size = max(1, PORTION // longest)
    for begin in range(0, len(case), size):
        yield case[begin : begin + size], candidate[begin : begin + size]


def filled_length(n: int) -> int:
    """A count not much above n, of which there are few: each is compiled for."""
    step = 1 << max(0, n.bit_length() - 3)
    return -(-n // step) * step


def filled(n: int) -> IntArray:
    """Places of n lanes, and the last again until there are as many as something is compiled for."""
    return np.minimum(np.arange(filled_length(n)), n - 1)


def _given(cases: Cases, own: IntArray, log_of: IntArray, steps: int) -> tuple[Log, Array, Array]:
    """The log of some of the cases, with what their motion is compared with and its weights, samples first.

    Samples and cases are filled up to counts that are compiled for; time stands still there.
    """
    few = own[filled(len(own))]
    long = np.minimum(np.arange(filled_length(steps)), steps - 1)
    compared = (np.arange(len(long)) < steps)[:, None, None]

    def part(values: FloatArray) -> FloatArray:
        return np.swapaxes(values[few][:, long], 0, 1)

    log = Log(part(cases.t), cases.n_samples[few], part(cases.controls), part(cases.around), log_of)
    return log, part(cases.target), part(cases.weight) * compared


def _march(model: Model, integrator: Integrator, keep: bool, theta: Array, initial: Array, given: Any) -> Any:
    """Cost (n_lanes,), largest squared speed [m^2/s^2] likewise, the last states (6, n_lanes), and where they are kept
    those shown, (T - 1, 6, n_lanes)."""
    log, target, weight = given
    numpy = jax_module().numpy
    lanes = Marching(LaneModel(model, theta, on_jax()), log, integrator)

    def body(carry: Any, samples: Any) -> Any:
        now, cost, fastest2 = carry
        sample, target, weight = samples
        now, shown = lanes.body(now, sample)
        fastest2 = numpy.fmax(fastest2, now.s[3] * now.s[3] + now.s[4] * now.s[4])
        for one, aim, weigh in zip(shown, log.per_lane(target).T, log.per_lane(weight).T, strict=True):
            cost = cost + weigh * (one - aim) * (one - aim)
        return (now, cost, fastest2), (shown if keep else None)

    zero = numpy.zeros(len(initial))
    samples = (lanes.samples, target[1:], weight[1:])
    (now, cost, fastest2), shown = jax_module().lax.scan(body, (lanes.begin(initial), zero, zero), samples)
    last = numpy.stack(now.s[:N_STATES])
    return cost, fastest2, last, numpy.stack(shown, axis=1) if keep else zero


def _put_residuals(residuals: FloatArray, cases: Cases, case: IntArray, candidate: IntArray, shown: FloatArray) -> None:
    """Into their rows, those of lanes with these cases and candidates; shown (T, n_lanes, 6)."""
    T = len(shown)
    for one in np.unique(case):
        lanes = np.flatnonzero(case == one)
        rows = cases.rows[one, :T]
        counts = rows >= 0
        scaled = np.sqrt(cases.weight[one, :T])[:, None] * (shown[:, lanes] - cases.target[one, :T][:, None])
        residuals[rows[counts][:, None], candidate[lanes]] = scaled.transpose(0, 2, 1)[counts]
