"""What a user can choose, a dataclass a command: one field is the keyword, the flag, the line of help and the JSON.

choice      a field that is an option, and what all such dataclasses do
simulation  integrator, step, back end
tuning      fit, sweep, leave-out
diagnosis   diagnose
scoring     validate, on trials and on voyages, check, and compare
orders      simulate
particles   how particles are drawn: predict, compare
predicting  predict
posterior   posterior
planning    plan
estimating  profile new
learning    learn
generating  trials make
studying    study
fleet       fleet run
flags       what fields are called on the command line

Nothing here is heavy to import: the command line builds its flags from it before it knows what is wanted.
"""

from .choice import Choice, Options, again, choice, choices
from .diagnosis import DiagnoseOptions
from .estimating import EstimateOptions
from .flags import FLAGS, flags_of, in_flags
from .fleet import FleetOptions
from .generating import MakeOptions
from .learning import EnsembleOptions, HybridOptions, LearnOptions, MixtureOptions, TrainingOptions
from .orders import SimulateOptions
from .particles import SAMPLINGS, ParticleOptions
from .planning import PlanOptions
from .posterior import PosteriorOptions
from .predicting import PredictOptions
from .scoring import FORMATS, CheckOptions, CompareModelsOptions, ValidateOptions, VoyageOptions
from .simulation import BACKENDS, INTEGRATORS, SimulationOptions
from .studying import HeadingOptions
from .tuning import METHODS, FitOptions, LeaveOutOptions, SearchOptions, SweepOptions, TuningOptions

__all__ = [
    "BACKENDS",
    "FLAGS",
    "FORMATS",
    "INTEGRATORS",
    "METHODS",
    "SAMPLINGS",
    "CheckOptions",
    "Choice",
    "CompareModelsOptions",
    "DiagnoseOptions",
    "EnsembleOptions",
    "EstimateOptions",
    "FitOptions",
    "FleetOptions",
    "HeadingOptions",
    "HybridOptions",
    "LearnOptions",
    "LeaveOutOptions",
    "MakeOptions",
    "MixtureOptions",
    "Options",
    "ParticleOptions",
    "PlanOptions",
    "PosteriorOptions",
    "PredictOptions",
    "SearchOptions",
    "SimulateOptions",
    "SimulationOptions",
    "SweepOptions",
    "TrainingOptions",
    "TuningOptions",
    "ValidateOptions",
    "VoyageOptions",
    "again",
    "choice",
    "choices",
    "flags_of",
    "in_flags",
]

for _of in (
    CheckOptions,
    CompareModelsOptions,
    DiagnoseOptions,
    EnsembleOptions,
    EstimateOptions,
    FitOptions,
    FleetOptions,
    HeadingOptions,
    HybridOptions,
    LearnOptions,
    MixtureOptions,
    LeaveOutOptions,
    PredictOptions,
    MakeOptions,
    PlanOptions,
    PosteriorOptions,
    SimulateOptions,
    SweepOptions,
    VoyageOptions,
):
    flags_of(_of)
