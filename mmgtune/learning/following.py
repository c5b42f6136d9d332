"""Runs followed where a hybrid takes them, and what any model of forces makes of the same instants."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from ..backends import Cases, Integrator, LaneModel
from ..backends.logged import Logged
from ..backends.numpy_lanes import N_STATES
from ..model import Model
from ..networks.hybrid import N_MEMORY, Hybrid, HybridLanes
from ..physics.quantities import Force, State, Surroundings
from ..predictor import cases_from
from ..trial import Trial
from .choosing import pieces_of

RK4 = Integrator()


@dataclass(frozen=True, eq=False)
class Followed:
    """Windows of trials as a hybrid sails them, a lane each.

    run      (n_lanes,) number of the run each window is of
    s        (T, n_states, n_lanes) the six states, what lags of the model remember, and the network's memory
    control  (T, n_inputs, n_lanes) what acts
    around   (T, n_surroundings, n_lanes)
    h        (T, n_lanes) step that ends at each sample [s]
    counts   (T, n_lanes) instants that are looked at
    """

    model: Model
    cases: Cases
    run: IntArray
    s: FloatArray
    control: FloatArray
    around: FloatArray
    h: FloatArray
    counts: BoolArray

    @property
    def runs(self) -> IntArray:
        """(n,) number of the run of each instant that is looked at."""
        return np.broadcast_to(self.run, self.counts.shape)[self.counts]

    def at(self, values: FloatArray) -> FloatArray:
        """(n_columns, n) of (T, n_columns, n_lanes), at the instants that are looked at."""
        return np.ascontiguousarray(np.moveaxis(values, 1, 2)[self.counts].T)

    def surroundings(self) -> Surroundings:
        """Those of the instants that are looked at, (n,) each."""
        return Surroundings(*self.at(self.around))

    def acts(self, control: FloatArray) -> Any:
        """(n_inputs, n) or (n_inputs, n_lanes) by name."""
        return self.model.arrangement.control(*control)


def follow(hybrid: Hybrid, trials: Sequence[Trial], restart: float | None, most: int) -> Followed:
    """Windows of ``restart`` [s], whole trials where None, each from its first measured state.

    most  instants that are looked at, about; evenly over all
    Raises TrialError for a trial without one of the inputs.
    """
    model = Model(hybrid.profile)
    pieces = pieces_of(trials, restart)
    cases = cases_from(pieces, model.inputs, model.draught)
    ship = HybridLanes(model, model.matrix()[:, 0], weights=hybrid.weights, ranges=hybrid.ranges, memory=hybrid.memory)
    log = Logged(model, cases, 1, _shift(ship, cases))
    h = np.diff(cases.t.T, axis=0, prepend=cases.t.T[:1])
    s, control = [], []
    with np.errstate(all="ignore"):
        sailing = ship.start(State(*cases.initial.T), log.inputs(1, 0.0), log.around(1, 0.0))
        for k in range(cases.t.shape[1]):
            if k:
                sailing.step(log.inputs(k, 1.0), log.around(k, 1.0), h[k], RK4)
            s.append(sailing.s)
            control.append(_stacked(sailing.now.chain[-1]))
    counts = np.arange(len(s))[:, None] < cases.n_samples
    whole = np.array(s)
    counts &= np.isfinite(whole).all(axis=1)
    around = np.ascontiguousarray(np.moveaxis(cases.around, 0, 2))
    runs = {name: k for k, name in enumerate(dict.fromkeys(piece.run for piece in pieces))}
    run = np.array([runs[piece.run] for piece in pieces])
    return Followed(model, cases, run, whole, np.array(control), around, h, thinned(counts, most))


def added_by(hybrid: Hybrid, of: Followed) -> FloatArray:
    """(n, 3) accelerations [m/s^2, m/s^2, rad/s^2] that the network adds at the instants looked at."""
    theta = of.model.matrix()[:, 0]
    ship = HybridLanes(of.model, theta, weights=hybrid.weights, ranges=hybrid.ranges, memory=hybrid.memory)
    return np.asarray(ship.added(of.at(of.s), of.acts(of.at(of.control)), of.surroundings()))


def own_force(of: Followed) -> FloatArray:
    """(n, 3) X, Y [N], N [N m] of the model of forces there."""
    ship = LaneModel(of.model, of.model.matrix()[:, 0])
    s = of.at(of.s)[:-N_MEMORY]
    with np.errstate(all="ignore"):
        control, around = of.acts(of.at(of.control)), of.surroundings()
        total, _ = ship.acting_force(s, control, around, of.at(of.h[:, None])[0], ship.here(around))
    return np.column_stack(np.broadcast_arrays(*total))


def accelerations_by(model: Model, theta: FloatArray, of: Followed) -> FloatArray:
    """(n, 3) accelerations that a model gives at the instants looked at, on the way the hybrid took.

    theta  (n_rows,) as of ``Model.matrix``
    Its actuators and lags follow inputs and motion from the beginning of each window.
    """
    ship = LaneModel(model, theta)
    with np.errstate(all="ignore"):
        control = driven(ship, of) if ship.actuators or any(late is not None for late in ship.shift) else of.control
        if ship.lags:
            return _lagging(ship, control, of)
        rates = ship.rates(of.at(of.s)[:N_STATES], of.acts(of.at(control)), of.surroundings(), 0.0)
        return np.array(rates[3:N_STATES]).T


def driven(ship: LaneModel, of: Followed) -> FloatArray:
    """(T, n_inputs, n_lanes) what acts where the clocks and actuators are those of ``ship``."""
    log = Logged(of.model, of.cases, 1, _shift(ship, of.cases))
    start = log.inputs(1, 0.0)
    chain = ship.moved([], start, None, 0.0 * start[0])
    found = [_stacked(chain[-1])]
    for k in range(1, len(of.h)):
        chain = ship.moved(chain, log.inputs(k, 1.0), chain, of.h[k])
        found.append(_stacked(chain[-1]))
    return np.array(found)


def thinned(counts: BoolArray, most: int) -> BoolArray:
    """Some of the samples that count (n,): about ``most`` at most, evenly spread."""
    there = np.flatnonzero(counts)
    kept = np.zeros(counts.size, dtype=bool)
    kept[there[:: max(1, -(-len(there) // most))]] = True
    return kept.reshape(counts.shape)


def _lagging(ship: LaneModel, control: FloatArray, of: Followed) -> FloatArray:
    """What lags remember is followed sample by sample, by Euler's method; the forces they follow are there before."""
    state = State(*np.moveaxis(of.s[:, :N_STATES], 1, 0))
    acts, around = of.acts(np.moveaxis(control, 1, 0)), Surroundings(*np.moveaxis(of.around, 1, 0))
    p = ship.here(around)
    found = ship.breakdown(state, acts, around, p)
    totals = np.empty((3, *of.h.shape))
    behind = ship.behind(_sample(state, 0), _sample(acts, 0), _sample(around, 0))
    for k in range(len(of.h)):
        step = of.h[k] if k else of.h[min(1, len(of.h) - 1)]
        total, slopes = ship.lagged(_sample(found, k), behind, step)
        totals[:, k] = _stacked(total)
        if k + 1 < len(of.h):
            behind = [was + of.h[k + 1] * slope for was, slope in zip(behind, slopes, strict=True)]
    rates = ship.under(Force(*totals), state, around, p)
    return _stacked(rates[3:N_STATES])[:, of.counts].T


def _sample(values: Any, k: int) -> Any:
    """Sample k of named tuples of (T, n_lanes); what is one number for all stays."""
    if hasattr(values, "_fields"):
        return type(values)(*(_sample(value, k) for value in values))
    return values[k] if np.ndim(values) == 2 else values


def _shift(ship: LaneModel, cases: Cases) -> list[FloatArray | None]:
    return [None if late is None else np.broadcast_to(late, (len(cases),)) for late in ship.shift]


def _stacked(control: Any) -> FloatArray:
    return np.stack(np.broadcast_arrays(*control))
