"""What a model foretells, and how sure it is: what ``mmgtune predict`` does.

asked     manoeuvres by name, and lists of orders, for a ship
steering  a helmsman to each particle
driven    particles driven by given inputs: lists of orders, trials
reading   indices of all particles
result    a prediction as it is kept and written
run       from options to a result
"""

from .folder import write_prediction
from .result import Foretold, Predicted
from .run import predict

__all__ = ["Foretold", "Predicted", "predict", "write_prediction"]
