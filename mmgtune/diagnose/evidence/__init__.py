"""What a fitted model gets wrong, before any cause is considered.

smoothing      measured motion without its noise
forces         residual forces by inverse dynamics
short_horizon  residuals of simulations restarted every window
explained      the share of a residual that one variable alone explains, and the share that is noise
leftover       what is left beyond noise, and whether it looks like something that happened
misread        logs that are off in single runs; odd_runs: rudders and positions that are; logged: channels in words
whereabouts    where an error lives that nothing explains; gathering: all of it for the report
"""

from .explained import FEWEST_BLOCKS, can_be_explained, explain_forces, noise_share, share_explained
from .forces import ResidualForces, residual_forces
from .short_horizon import ShortHorizon, short_horizon

__all__ = [
    "FEWEST_BLOCKS",
    "ResidualForces",
    "ShortHorizon",
    "can_be_explained",
    "explain_forces",
    "noise_share",
    "residual_forces",
    "share_explained",
    "short_horizon",
]
