"""What trials leave open of a physical model: room in its form, and particles that fill it."""

from ..options import PosteriorOptions
from .folder import write_posterior
from .leaving_out import leave_out_with_bands
from .planning import plan_posterior
from .run import Posterior, posterior

__all__ = [
    "Posterior",
    "PosteriorOptions",
    "leave_out_with_bands",
    "plan_posterior",
    "posterior",
    "write_posterior",
]
