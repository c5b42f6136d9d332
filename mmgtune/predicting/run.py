"""From options to a prediction."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import cast

from ..arguments import ShipGiven, TrialsGiven, of_one_ship
from ..bands import widest
from ..errors import OptionError, Problem
from ..model import Model
from ..networks import named_ship
from ..options import PredictOptions
from ..options.choice import must_be
from ..options.orders import ORDERS
from ..options.predicting import OF_TRIALS
from ..predictor import Predictor, Sampling, Uncertain, as_predictor, noted, particles_of
from ..resources import must_be_name, trial_set_names
from ..trial import Trial, TrialSet
from ..validating import sigma_of
from .asked import actuators_of, approach_of, asked
from .driven import on_orders, on_trials
from .order_list import read_orders
from .order_table import Columns, orders_in
from .result import Foretold, Predicted
from .steering import sail


def predict(
    model: ShipGiven | Model | Predictor,
    orders: Columns | TrialsGiven | None = None,
    trials: TrialsGiven | None = None,
    options: PredictOptions = PredictOptions(),
) -> Predicted:
    """Predict manoeuvres, or trials with their own inputs, by as many particles as the model has or draws.

    model   a profile, network, hybrid or ensemble: an object, a path or a bundled name
    orders  a CSV file with a row an order, see ``order_list``, or the same as a table: a DataFrame or a dict of columns
            "t [s]", "delta [deg]"; trials are understood here too
    trials  objects, a path or a bundled name; their measured motion is what the bands are held against
    With neither the manoeuvres of the options are predicted, by default hard turns and zigzags to both sides.

    Manoeuvres by orders are integrated finely whatever the options say.  A particle that diverges, or never reaches an
    index, is counted.
    Raises OptionError for orders that make no sense or contradict each other, and as ``as_predictor`` does.
    """
    must_be(options, PredictOptions)
    began = time.perf_counter()
    if trials is None and orders is not None and not isinstance(orders, Columns) and _are_trials(orders):
        orders, trials = None, orders
    _agree(orders, trials, options)
    integrator = options.make_integrator()
    whole = as_predictor(named_ship(model, integrator), integrator=integrator, backend=options.backend)
    several = particles_of(whole, options.particles, options.seed, cast(Sampling, options.sampling))
    name = str(model) if isinstance(model, (str, Path)) else whole.name
    sigma: dict[str, float] = {}
    given, of_ship = ([], "") if trials is None else of_one_ship(trials)
    notes = noted(whole, given, of_ship)
    if isinstance(whole, Uncertain) and several.n_members < options.particles:
        notes.append(
            f"'{name}' holds {several.n_members} particles, fewer than the {options.particles} asked for: all are taken"
        )
    if trials is not None:
        sigma = _sigma(given, of_ship, options)
        runs = tuple(on_trials(several, given, options.restart))
    elif orders is not None:
        of = tuple(several.inputs)
        listed = orders_in(orders, of) if isinstance(orders, Columns) else read_orders(Path(str(orders)), of)
        runs = (on_orders(several, listed, approach_of(several, options)),)
    else:
        approach = approach_of(several, options)
        manoeuvres = asked(several, options, approach)
        runs = tuple(
            Foretold(
                one.id,
                one.manoeuvre,
                one.words,
                found.t,
                found.states,
                found.diverged,
                found.indices,
                approach=approach,
            )
            for one, found in zip(manoeuvres, sail(several, manoeuvres, approach), strict=True)
        )
    notes += _notes(several, options, runs, steered=trials is None)
    spent = time.perf_counter() - began
    return Predicted(name, several, runs, options, isinstance(whole, Uncertain), sigma, tuple(notes), spent)


def _are_trials(given: TrialsGiven) -> bool:
    """Whether what stands in the place of orders is trials: objects, a folder, a trial file or a bundled name."""
    if not isinstance(given, (str, Path)):
        return True
    must_be_name(given, "list of orders", OptionError)
    path = Path(given)
    return path.is_dir() or path.suffix == ".parquet" or (not path.exists() and str(given) in trial_set_names())


def _agree(orders: object, trials: object, options: PredictOptions) -> None:
    """Raises OptionError for what cannot be had together."""
    ordered = options.given(ORDERS)
    if trials is not None and (orders is not None or ordered):
        where = "trials"
        fix = "leave out the orders" if orders is not None else f"leave out {', '.join(ordered)}"
        raise OptionError(Problem("trials have their own inputs", where, "they are what was measured, not orders", fix))
    manoeuvres = [name for name in ordered if name not in ("speed", "rpm")]
    if orders is not None and manoeuvres:
        fix = f"leave out the list, or {', '.join(manoeuvres)}"
        why = "each says what rudder and propeller do"
        raise OptionError(Problem("a list of orders is no standard manoeuvre", manoeuvres[0], why, fix))
    lost = options.given(OF_TRIALS)
    if trials is None and lost:
        why = "windows and spreads are of trials"
        raise OptionError(Problem("nothing was measured", lost[0], why, f"name trials, or leave out {lost[0]}"))


def _sigma(trials: Sequence[Trial], ship: str, options: PredictOptions) -> dict[str, float]:
    data = TrialSet({one.id: one for one in trials}, (), (), ship)
    return sigma_of(data, options.sigma_from, "trials")


def _notes(particles: Predictor, options: PredictOptions, runs: Sequence[Foretold], steered: bool) -> Iterator[str]:
    """What a reader has to know of a prediction."""
    n = particles.n_members
    if n == 1:
        yield (
            f"'{particles.name}' is one model and gives one run: there is no band. Models that know their doubts have "
            "one: particles of coefficients (mmgtune posterior), ensembles (mmgtune learn ensemble), networks of "
            "several seeds (mmgtune learn rnn)"
        )
    elif 100.0 * widest(n) < options.level - 0.5:
        yield (
            f"there are {n} particles: the widest band, from the least to the greatest, holds {100.0 * widest(n):.0f} "
            f"% of what may happen, not {options.level:g} %; bands are drawn so"
        )
    for run in runs:
        lost = int(run.diverged.sum())
        if lost:
            yield f"{run.id}: {lost} of {n} particles diverged; bands over time are of the others, indices count them"
    if steered and all(gear is None for gear in actuators_of(particles)):
        yield "no steering gear is known: rudders and propellers follow their orders at once"
