"""Calibrate MMG manoeuvring models of ships against measured trials.

    import mmgtune
    result = mmgtune.fit("suzaku", "suzaku", mmgtune.FitOptions(a_r=0.5))
    print(result.verdict())

Everything listed here is what the commands call; it is imported when first used.
"""

from __future__ import annotations

from importlib import import_module

TYPE_CHECKING = False  # as type checkers know it; ``typing`` takes most of the time that this module would
if TYPE_CHECKING:
    from typing import Any

    from .checking import CheckReport as CheckReport
    from .checking import check as check
    from .checking import read_baseline as read_baseline
    from .checking import record_baseline as record_baseline
    from .checking import update_baseline as update_baseline
    from .checking import write_baseline as write_baseline
    from .diagnose import Diagnosis as Diagnosis
    from .diagnose import diagnose as diagnose
    from .diagnose import write_diagnosis as write_diagnosis
    from .errors import MmgtuneError as MmgtuneError
    from .evaluation import TrialRecord as TrialRecord
    from .evaluation import evaluate as evaluate
    from .fitting import FitResult as FitResult
    from .fitting import LeftOut as LeftOut
    from .fitting import SweepResult as SweepResult
    from .fitting import fit as fit
    from .fitting import leave_out as leave_out
    from .fitting import sweep as sweep
    from .fitting import write_run as write_run
    from .importing import import_logs as import_logs
    from .importing import load_map as load_map
    from .manoeuvres import Track as Track
    from .manoeuvres.summary import indices_of as indices_of
    from .measures import distance_measures as distance_measures
    from .model import Model as Model
    from .options import DiagnoseOptions as DiagnoseOptions
    from .options import FitOptions as FitOptions
    from .options import LeaveOutOptions as LeaveOutOptions
    from .options import SimulateOptions as SimulateOptions
    from .options import SweepOptions as SweepOptions
    from .options import ValidateOptions as ValidateOptions
    from .orders import TurningOrder as TurningOrder
    from .orders import ZigzagOrder as ZigzagOrder
    from .orders import run_manoeuvre as run_manoeuvre
    from .predictor import PhysicsPredictor as PhysicsPredictor
    from .predictor import Prediction as Prediction
    from .predictor import Predictor as Predictor
    from .profile import ShipProfile as ShipProfile
    from .profile import load_profile as load_profile
    from .repeating import repeat as repeat
    from .report import render as render
    from .simulating import Simulated as Simulated
    from .simulating import simulate as simulate
    from .simulation import breakdown as breakdown
    from .trial import Trial as Trial
    from .trial import TrialSet as TrialSet
    from .trial import load_trials as load_trials
    from .trial import read_trial as read_trial
    from .trial import write_trial as write_trial
    from .validating import Validation as Validation
    from .validating import validate as validate
    from .validation import score as score

_WHERE = {
    "CheckReport": "checking",
    "check": "checking",
    "read_baseline": "checking",
    "record_baseline": "checking",
    "update_baseline": "checking",
    "write_baseline": "checking",
    "Diagnosis": "diagnose",
    "write_diagnosis": "diagnose",
    "LeftOut": "fitting",
    "leave_out": "fitting",
    "DiagnoseOptions": "options",
    "LeaveOutOptions": "options",
    "SimulateOptions": "options",
    "SweepOptions": "options",
    "ValidateOptions": "options",
    "Validation": "validating",
    "validate": "validating",
    "Simulated": "simulating",
    "repeat": "repeating",
    "score": "validation",
    "MmgtuneError": "errors",
    "TrialRecord": "evaluation",
    "evaluate": "evaluation",
    "PhysicsPredictor": "predictor",
    "Prediction": "predictor",
    "Predictor": "predictor",
    "FitOptions": "options",
    "FitResult": "fitting",
    "SweepResult": "fitting",
    "fit": "fitting",
    "sweep": "fitting",
    "write_run": "fitting",
    "import_logs": "importing",
    "load_map": "importing",
    "Track": "manoeuvres",
    "indices_of": "manoeuvres.summary",
    "Model": "model",
    "TurningOrder": "orders",
    "ZigzagOrder": "orders",
    "run_manoeuvre": "orders",
    "ShipProfile": "profile",
    "load_profile": "profile",
    "render": "report",
    "breakdown": "simulation",
    "distance_measures": "measures",
    "simulate": "simulating",
    "Trial": "trial",
    "TrialSet": "trial",
    "load_trials": "trial",
    "read_trial": "trial",
    "write_trial": "trial",
}

__all__ = sorted([*_WHERE, "diagnose"])


def __getattr__(name: str) -> Any:
    if name == "diagnose":  # the package, which is called like the function
        return import_module(".diagnose", __name__)
    if name not in _WHERE:
        raise AttributeError(f"module 'mmgtune' has no attribute '{name}'")
    return getattr(import_module(f".{_WHERE[name]}", __name__), name)


def __dir__() -> list[str]:
    return __all__
