"""Trials kept for testing that an answer does not tell, and that were looked at with the others therefore.

Coefficients fitted to a few trials can take up a cause, which then shows in none but those that were kept.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from .gain import Gain


@dataclass(frozen=True)
class Together:
    """The answer without the trials kept for testing, and the error it left on these.

    effects  tags of the causes, with ``believed`` whether they were
    left     error that was left there, over the noise of the sensors
    settled  whether the answer given is that of all trials together, not that without the trials kept for testing
    """

    effects: tuple[str, ...]
    believed: bool
    left: float
    settled: bool

    @classmethod
    def of(cls, gain: Gain, effects: tuple[str, ...], *, believed: bool, settled: bool) -> Together:
        """From the gain on test trials."""
        return cls(effects, believed, gain.left, settled)

    @property
    def sentence(self) -> str:
        """What was done, in words."""
        times = f"an error {self.left:,.3g} times the noise of the sensors"
        if not self.settled:
            return f"That leaves {times} on trials kept for testing, and a look at all trials together tells no more."
        shown = " + ".join(dict.fromkeys(self.effects)) or "no cause"
        doubt = "" if self.believed or not self.effects else ", not to be believed,"
        return (
            f"Without the trials kept for testing {shown} showed{doubt} and {times} was left on these, so all were "
            "looked at together."
        )

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "effects_of_others": list(self.effects),
            "believed": self.believed,
            "error_over_noise": self.left,
            "settled": self.settled,
        }
