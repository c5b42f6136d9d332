"""A belief as a rule sees it: what the rule asks is given, whatever else there would be is not there."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

from mmgtune.diagnose.causes.belief import Belief

FIELDS = [one.name for one in fields(Belief)]


def belief_with(**given: Any) -> Belief:
    """A belief with fields as given, nothing in the place of the others; what is no field replaces that property."""
    replaced = {name: value for name, value in given.items() if name not in FIELDS}
    unknown = [name for name in replaced if not hasattr(Belief, name)]
    assert not unknown, unknown
    without = {name: () if name == "causes" else None for name in FIELDS}
    return type("Given", (Belief,), replaced)(**without | {k: v for k, v in given.items() if k in FIELDS})
