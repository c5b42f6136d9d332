"""Trained networks that predict the motion of a ship, and the files they are kept in."""

from .ensemble import Ensemble, EnsemblePredictor
from .file import SUFFIX, load_network, save_network
from .hybrid import Hybrid, HybridPredictor
from .mixture import Mixture, MixturePredictor
from .model import Network
from .naming import named_ship, predictor_of
from .predicting import NetworkPredictor

__all__ = [
    "SUFFIX",
    "Ensemble",
    "EnsemblePredictor",
    "Hybrid",
    "HybridPredictor",
    "Mixture",
    "MixturePredictor",
    "Network",
    "NetworkPredictor",
    "load_network",
    "named_ship",
    "predictor_of",
    "save_network",
]
