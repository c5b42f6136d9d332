"""Bands out of particles, and how well they hold what was measured: pure functions of arrays.

quantiles  where particles lie, sample by sample
indices    a band on one number, such as an advance that some particles never reach
scores     distances, coverage, CRPS and widths of one window
pooled     the same over many windows
"""

from .indices import IndexBand, index_band
from .pooled import LEVELS, Pooled, WindowScore, pooled, pooled_by, score_window
from .quantiles import central, fan, quantiles, widest
from .scores import covariances, covered, crps, squared_error, squared_mahalanobis, standardised_error

__all__ = [
    "LEVELS",
    "IndexBand",
    "Pooled",
    "WindowScore",
    "central",
    "covariances",
    "covered",
    "crps",
    "fan",
    "index_band",
    "pooled",
    "pooled_by",
    "quantiles",
    "score_window",
    "squared_error",
    "squared_mahalanobis",
    "standardised_error",
    "widest",
]
