"""What trials leave open of a physical model: room in its form, and particles that fill it."""

from ..options import PosteriorOptions
from .folder import write_posterior
from .run import Posterior, posterior

__all__ = ["Posterior", "PosteriorOptions", "posterior", "write_posterior"]
