"""A tuned profile tuned anew without some runs, so that these are unseen by the model of forces too."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from ..fitting import FitOptions, fit
from ..hooks import Hooks
from ..profile import ShipProfile, tuned
from ..trial import Trial, TrialSet

EVERY = 0.02
"""Time between samples that count, as a share of the length of a window; each sample where they are further apart."""

PULL = 5e-4
"""Cost of moving one coefficient to the edge of its box, as a share of J before."""


def tuned_names(profile: ShipProfile) -> tuple[str, ...]:
    """Coefficients that were tuned: those that say what they were before."""
    return tuple(name for name in profile.names() if profile.coefficient(name).pre_determined is not None)


def refitted(
    profile: ShipProfile,
    trials: Sequence[Trial],
    *,
    restart: float | None,
    stop: Callable[[], bool] = lambda: False,
) -> ShipProfile:
    """The profile with the same coefficients tuned to these trials alone, from where it stands, in the same boxes.

    Least squares of all states over their spread in windows of ``restart`` [s], with a small pull towards where they
    began.  A profile that was never tuned comes back as it is.
    """
    names = tuned_names(profile)
    if not names:
        return profile
    before = {name: profile.coefficient(name).pre_determined or 0.0 for name in names}
    at_start = tuned(profile, before, {}, {})
    apart = min(one.t[1] - one.t[0] for one in trials)
    options = FitOptions(
        targets=names,
        a_r=float(profile.provenance.get("a_r") or 0.5),
        method="least-squares",
        starts=1,
        objective="standardised",
        restart=restart,
        every=max(float(apart), EVERY * restart) if restart else None,
        regularise=PULL,
    )
    data = TrialSet({one.id: one for one in trials}, tuple(one.id for one in trials), (), ship=profile.id)
    found = fit(at_start, data, options, hooks=Hooks(stop=stop))
    return tuned(profile, found.theta, {}, dict(profile.provenance))
