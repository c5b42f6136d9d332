"""Which results there are, by the names of their classes: so nothing is imported that did not make one."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from . import fits, fleets, judgements, ships
from .view import View


def _prediction(result: Any) -> View:
    from . import predictions  # imports all that predicts

    return predictions.prediction(result)


def _fit_bands(result: Any) -> View:
    from . import predictions

    return predictions.fit_bands(result)


def _plan(result: Any) -> View:
    from . import predictions

    return predictions.plan(result)


def _learned(name: str) -> Callable[[Any], View]:
    def view(result: Any) -> View:
        from . import learned  # imports what trains

        shown: View = getattr(learned, name)(result)
        return shown

    return view


def _headings(result: Any) -> View:
    from . import predictions

    return predictions.headings(result)


KINDS: Mapping[str, Callable[[Any], View]] = {
    "ShipProfile": ships.profile,
    "Trial": ships.trial,
    "TrialSet": ships.trials,
    "Motion": ships.motion,
    "Simulated": ships.simulation,
    "TrialRecord": ships.record,
    "FitResult": fits.fit,
    "ComparedTrials": fits.trials,
    "SweepResult": fits.sweep,
    "LeftOut": fits.left_out,
    "Posterior": fits.posterior,
    "Diagnosis": judgements.diagnosis,
    "Validation": judgements.validation,
    "ModelComparison": judgements.models,
    "Comparison": judgements.profiles,
    "CheckReport": judgements.check,
    "VoyageValidation": judgements.voyages,
    "FleetRun": fleets.run,
    "FleetPlan": fleets.plan,
    "Inspected": ships.inspected,
    "Made": ships.made,
    "FitBands": _fit_bands,
    "Learned": _learned("networks"),
    "LearnedEnsemble": _learned("ensemble"),
    "LearnedHybrid": _learned("hybrid"),
    "LearnedMixture": _learned("mixture"),
    "Predicted": _prediction,
    "TrialPlan": _plan,
    "HeadingStudy": _headings,
}


def view_of(of: object) -> View:
    """What there is to see of a result."""
    return KINDS[type(of).__name__](of)
