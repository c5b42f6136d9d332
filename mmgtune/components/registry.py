"""Every component and every arrangement there is, and how they are found by name."""

from __future__ import annotations

import copyreg
from collections.abc import Callable

from .arrangements import ARRANGEMENTS
from .component import Arrangement, Component
from .hull import HULLS
from .propeller import PROPELLERS
from .rudder import RUDDERS
from .rudder_pair import PROPELLER_WITH_TWO_RUDDERS
from .ship import ABOVE_WATER, SHIP
from .thruster import THRUSTERS
from .wake import WAKES

COMPONENTS = (
    SHIP,
    *HULLS,
    *WAKES,
    *PROPELLERS,
    *RUDDERS,
    *PROPELLER_WITH_TWO_RUDDERS,
    *THRUSTERS,
    ABOVE_WATER,
)
"""Every component there is, in the order documentation lists them."""

KINDS = tuple(dict.fromkeys(kind for arrangement in ARRANGEMENTS for kind in arrangement.kinds))
"""Every kind of component that some arrangement has."""

UNTAGGED = {"particulars": SHIP, "above_water": ABOVE_WATER}
"""Kinds of which there is only one component, so that a profile names no model."""


def split_name(name: str) -> tuple[str, str]:
    """Section and symbol of "hull.Y_v" or "effects.current.north"."""
    section, _, symbol = name.rpartition(".")
    return section, symbol


def effect_tag(name: str) -> str:
    """Tag of the effect that a section or coefficient is of: "current" of "effects.current.north"; "" of one of the
    ship's."""
    kind, _, rest = name.partition(".")
    return rest.partition(".")[0] if kind == "effects" else ""


def tags(kind: str) -> tuple[str, ...]:
    """The tags a profile may name for one kind of component."""
    return tuple(component.tag for component in COMPONENTS if component.kind == kind)


def find_arrangement(tag: str) -> Arrangement | None:
    """The arrangement of that tag, None if there is none."""
    return next((arrangement for arrangement in ARRANGEMENTS if arrangement.tag == tag), None)


def find(kind: str, tag: str) -> Component | None:
    """The component of that kind and tag, None if there is none."""
    for component in COMPONENTS:
        if (component.kind, component.tag) == (kind, tag):
            return component
    return None


def _component(kind: str, tag: str) -> Component:
    """A component pickled by name.  Raises TypeError for one that is not in ``COMPONENTS``."""
    if (found := find(kind, tag)) is None:
        raise TypeError(f"{kind} '{tag}' is not one of COMPONENTS and cannot be found again")
    return found


def _arrangement(tag: str) -> Arrangement:
    """An arrangement pickled by tag.  Raises TypeError for one that is not in ``ARRANGEMENTS``."""
    if (found := find_arrangement(tag)) is None:
        raise TypeError(f"arrangement '{tag}' is not one of ARRANGEMENTS and cannot be found again")
    return found


def _by_name(component: Component) -> tuple[Callable[..., Component], tuple[str, str]]:
    """Functions stay where they are.  Raises TypeError for another component of the name of one of these."""
    if _component(component.kind, component.tag) is not component:
        raise TypeError(f"{component.kind} '{component.tag}' is another than that of COMPONENTS: it would be lost")
    return _component, (component.kind, component.tag)


def _by_tag(arrangement: Arrangement) -> tuple[Callable[..., Arrangement], tuple[str]]:
    """The same of an arrangement."""
    if _arrangement(arrangement.tag) is not arrangement:
        raise TypeError(f"arrangement '{arrangement.tag}' is another than that of ARRANGEMENTS: it would be lost")
    return _arrangement, (arrangement.tag,)


copyreg.pickle(Component, _by_name)
copyreg.pickle(Arrangement, _by_tag)
