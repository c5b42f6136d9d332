"""What a user can choose about particles: predictions of a model that knows its doubts."""

from __future__ import annotations

from dataclasses import dataclass

from .choice import REPRODUCE, Options, choice

BAND = "Band"
"""Panel of the help."""

SAMPLINGS = ("TS-infinity", "TS1")


@dataclass(frozen=True)
class ParticleOptions(Options):
    """How particles are drawn, wherever that is done."""

    particles: int = choice(100, "Particles drawn of a model that knows its doubts.", least=1, most=100_000, panel=BAND)
    sampling: str = choice(
        "TS-infinity",
        "How particles keep to members of an ensemble: TS-infinity, one for the whole path; TS1, another each step.",
        values=SAMPLINGS,
        called="sampling",
        panel=BAND,
    )
    seed: int = choice(1, "Seed of the particles.", least=1, most=2**62, panel=REPRODUCE)
