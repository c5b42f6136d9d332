"""The ship without the day: a diagnosed profile for predictions, less what surrounded and what measured her."""

from __future__ import annotations

from dataclasses import replace

from ..effects import effects
from ..profile import ShipProfile


def calm_profile(profile: ShipProfile) -> ShipProfile | None:
    """The profile in calm, deep water with sensors that are right; None where it has nothing of the day."""
    taken = {effect.kind for effect in effects() if effect.of_the_day} & set(profile.sections)
    if not taken:
        return None
    return replace(profile, sections={kind: one for kind, one in profile.sections.items() if kind not in taken})
