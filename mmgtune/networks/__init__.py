"""Trained networks that predict the motion of a ship, and the files they are kept in."""

from .file import SUFFIX, load_network, save_network
from .model import Network
from .naming import named_ship
from .predicting import NetworkPredictor

__all__ = ["SUFFIX", "Network", "NetworkPredictor", "load_network", "named_ship", "save_network"]
