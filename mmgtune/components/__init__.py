"""What a ship model can be put together from: components by kind and tag, with the meaning of every coefficient.

A component is a tuple of coefficients, one pure function of ``mmgtune.physics`` and the facts in a module of this
package.  A new hull, wake, propeller or rudder is one new file there and one entry here, in the module of its kind.
"""

from .arrangements import ARRANGEMENTS
from .component import AT_LEAST_0, AT_MOST_0, Arrangement, Component, Field
from .registry import COMPONENTS, KINDS, UNTAGGED, effect_tag, find, find_arrangement, split_name, tags
from .ship import ABOVE_WATER, SHIP

__all__ = [
    "ABOVE_WATER",
    "ARRANGEMENTS",
    "AT_LEAST_0",
    "AT_MOST_0",
    "COMPONENTS",
    "KINDS",
    "SHIP",
    "UNTAGGED",
    "Arrangement",
    "Component",
    "Field",
    "effect_tag",
    "find",
    "find_arrangement",
    "split_name",
    "tags",
]
