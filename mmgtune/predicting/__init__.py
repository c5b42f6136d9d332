"""What a model foretells, and how sure it is: what ``mmgtune predict`` does.

asked     manoeuvres by name, and lists of orders, for a ship
steering  a helmsman to each particle
driven    particles driven by given inputs: lists of orders, trials
reading   indices of all particles
result    a prediction as it is kept and written
beside    bands beside a simulation or a fit
run       from options to a result
"""

from .beside import FitBands, fit_bands, with_bands, write_fit_bands
from .folder import write_prediction
from .result import Foretold, Predicted
from .run import predict

__all__ = [
    "FitBands",
    "Foretold",
    "Predicted",
    "fit_bands",
    "predict",
    "with_bands",
    "write_fit_bands",
    "write_prediction",
]
