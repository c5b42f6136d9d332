"""Particles driven by inputs that do not depend on them: lists of orders, and trials."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from .. import limits
from ..arrays import BoolArray, FloatArray
from ..backends import pad
from ..errors import OptionError, TrialError
from ..evaluation import Measured, TrialRecord
from ..inputs import INPUTS
from ..manoeuvres.summary import indices_of
from ..motions import Motion
from ..orders import sample_of
from ..predictor import Predictor, cases_from, draught_of, portions, predicted
from ..scores import window_scores
from ..stated_indices import no_reverse
from ..trial import Trial
from .asked import Approach, actuators_of, profile_behind, require_reached
from .order_list import OrderList
from .reading import Values, of_records
from .result import Foretold


def on_orders(predictor: Predictor, orders: OrderList, approach: Approach) -> Foretold:
    """All particles through a list of orders, from straight ahead.

    Raises OptionError for one that takes too long, and for orders that the ship cannot carry out.
    """
    _possible(predictor, orders)
    step = sample_of(predictor.L_pp, approach.speed)
    limits.ORDERS_STEPS.require(orders.duration / step * predictor.n_members, orders.where, OptionError)
    t, controls = orders.carried_out(tuple(predictor.inputs), actuators_of(predictor), approach.n, step)
    initial = np.array([0.0, 0.0, 0.0, approach.speed, 0.0, 0.0])
    found = predicted(predictor, pad([t], [controls], [initial]))
    states, diverged = found.states[0], found.diverged[0]
    motions = [
        Motion(orders.id, t, one, controls, bool(lost), tuple(predictor.inputs), k)
        for k, (one, lost) in enumerate(zip(states, diverged, strict=True))
    ]
    indices = of_records([_shown(motion, predictor.L_pp) for motion in motions])
    words = f"{len(orders.t) - 1} orders of {orders.source}"
    return Foretold(orders.id, "orders", words, t, states, diverged, indices, approach=approach)


def _possible(predictor: Predictor, orders: OrderList) -> None:
    """Raises OptionError for orders beyond what moves an input, and astern for a ship whose equations end there."""
    profile = profile_behind(predictor)
    for name, gear in zip(predictor.inputs, actuators_of(predictor), strict=True):
        ordered = orders.ordered.get(name, np.zeros(0))
        where = f"{orders.where}, column '{name}'"
        require_reached(name, gear, ordered, where)
        astern = INPUTS[name].role == "propeller" and bool((ordered < 0.0).any())
        if profile is not None and astern and (problem := no_reverse(profile, where, "order none below 0")):
            raise OptionError(problem)


def on_trials(predictor: Predictor, trials: Sequence[Trial], restart: float | None) -> Iterator[Foretold]:
    """All particles on each trial, driven by its inputs, with the scores of its windows, or of the whole of it.

    restart  length of the windows [s], None for whole trials
    """
    inputs = tuple(predictor.inputs)
    for portion in portions([trial.n_samples for trial in trials], predictor.n_members):
        some = trials[portion]
        found = predicted(predictor, cases_from(some, inputs, draught_of(predictor)))
        for i, trial in enumerate(some):
            states = np.array(found.states[i, :, : trial.n_samples])  # a copy: a view would hold all of them
            yield replace(
                _beside(predictor, trial, states, found.diverged[i]),
                scores=tuple(window_scores(predictor, list(_windows(trial, restart)))),
            )


def _windows(trial: Trial, restart: float | None) -> Iterator[Trial]:
    from ..trial.pieces import windows

    yield from [trial] if restart is None else windows(trial, restart)


def _beside(predictor: Predictor, trial: Trial, states: FloatArray, diverged: BoolArray) -> Foretold:
    measured = Measured(trial, predictor.L_pp, np.zeros((trial.n_samples, 6)))
    controls = trial.inputs(tuple(predictor.inputs))
    values: Values = {}
    if measured.kind != "other":
        rows = [
            TrialRecord(
                measured,
                Motion(trial.id, trial.t, one, controls, bool(lost), tuple(predictor.inputs), k),
                predictor.method,
            ).indices
            for k, (one, lost) in enumerate(zip(states, diverged, strict=True))
        ]
        values = of_records(rows)
    own = {key: float(of[0]) for key, of in of_records([measured.indices]).items()}
    kind = trial.manoeuvre or measured.kind
    words = f"{kind}, driven by its inputs"
    return Foretold(trial.id, kind, words, trial.t, states, diverged, values, trial, own, approach=_begins(trial))


def _begins(trial: Trial) -> Approach | None:
    """Measured speed and revolutions a trial begins with; None where they have gaps there."""
    begins = Approach(float(trial.u[0]), float(trial.n[0]))
    return begins if np.isfinite([begins.speed, begins.n]).all() else None


def _shown(motion: Motion, L_pp: float) -> dict[str, object]:
    """Indices of a run, empty where it shows none."""
    if motion.diverged:
        return {}
    try:
        return indices_of(motion.track(), L_pp)
    except TrialError:
        return {}
