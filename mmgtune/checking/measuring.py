"""The metrics of trials: how far a model is from each, in the numbers people judge by."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from ..arrays import FloatArray
from ..backends import Integrator
from ..evaluation import TrialRecord, records
from ..metrics import METRICS, RELATIVE
from ..model import Model
from ..objective import default_scales
from ..predictor import PhysicsPredictor, Predictor, as_predictor
from ..profile import ShipProfile
from ..stated_indices import compare_stated, possible
from ..trial import IndexTrial, Trial
from ..units import DEG

Values = dict[str, float]
"""Metrics of one trial by name; inf where the simulation diverged, absent where the trial does not show them."""

LENGTHS = {"advance": "advance_m", "tactical_diameter": "tactical_diameter_m"}
ANGLES = {"overshoot_1": "overshoot_1_deg", "overshoot_2": "overshoot_2_deg"}
"""Indices whose errors are metrics: of lengths a share of the measured one, of angles the difference."""


def measure(
    ship: Predictor | ShipProfile | Model,
    trials: Sequence[Trial],
    names: Sequence[str],
    *,
    theta: FloatArray | None = None,
    integrator: Integrator = Integrator(),
    backend: str = "compiled",
) -> list[dict[str, Values]]:
    """Metrics of each member on each trial, simulated from its first measured state with its measured inputs.

    names  of METRICS
    theta  (n_rows, n_members) coefficients of a profile or model, its own where None
    -> for each member, by trial and metric
    """
    predictor = as_predictor(ship, theta=theta, integrator=integrator, backend=backend)
    found: list[dict[str, Values]] = [{} for _ in range(predictor.n_members)]
    for record in records(predictor, trials):
        values = values_of(record)
        found[record.member][record.trial.id] = {name: values[name] for name in names if name in values}
    return found


def measure_stated(
    ship: PhysicsPredictor, trials: Sequence[IndexTrial], names: Sequence[str], backend: str = "compiled"
) -> dict[str, Values]:
    """Errors of stated indices as a profile's own helmsman makes them, by trial and metric; see ``measure``.

    ship  its first member is asked

    Raises OptionError for trials the ship cannot be asked for.
    """
    possible(ship.model.profile, trials)
    roles = {one.id: "other" for one in trials}
    found: dict[str, Values] = {one.id: {} for one in trials}
    now = {"now": ship.theta[:, 0]}
    compared = compare_stated(ship.model, now, trials, roles, backend) if trials else []
    for one in compared:
        value = one.simulated["now"]
        if one.name not in names:
            continue
        if value is None:
            found[one.trial][one.name] = math.inf
        elif one.name in ANGLES:
            found[one.trial][one.name] = (value - one.stated) / DEG
        else:
            found[one.trial][one.name] = 100.0 * (value / one.stated - 1.0)
    return found


def values_of(record: TrialRecord) -> Values:
    """All metrics that a record has; infinite where the simulation diverged."""
    values = {"J": record.J, **record.measures}
    for state, value in record.rms.items():
        values["rms_v" if state == "v_m" else f"rms_{state}"] = value / (DEG if state in ("psi", "r") else 1.0)
    return {name: value if math.isfinite(value) else math.inf for name, value in (values | _errors(record)).items()}


def _errors(record: TrialRecord) -> Values:
    """Errors of indices; what the simulation does not reach within the trial is as wrong as can be."""
    measured, simulated = record.measured.indices, record.indices
    found = {}
    for name, key in (LENGTHS | ANGLES).items():
        value, reached = measured.get(key), simulated.get(key)
        if value is None or (name in LENGTHS and not value):
            continue
        if not reached and (name in LENGTHS or reached is None):
            found[name] = math.inf
        else:
            found[name] = reached - value if name in ANGLES else 100.0 * (reached / value - 1.0)
    return found


def floors(L_pp: float) -> dict[str, float]:
    """Absolute change of each metric that never matters, in its unit, for a ship of this length [m]."""
    scales = default_scales(L_pp)
    of = {"": 1.0, "length": L_pp, "speed": scales["u"], "turning": scales["r"] / DEG}
    return {name: metric.floor * of[metric.of] for name, metric in METRICS.items()}


def default_tolerances(names: Sequence[str], L_pp: float) -> dict[str, dict[str, float]]:
    """For each metric: share of its baseline value, and absolute change, it may get worse by."""
    absolute = floors(L_pp)
    return {name: {"relative": RELATIVE, "absolute": float(f"{absolute[name]:.3g}")} for name in names}


def applicable(found: Mapping[str, Values]) -> list[str]:
    """Metrics that any of the trials shows, in the order of METRICS."""
    return [name for name in METRICS if any(name in values for values in found.values())]
