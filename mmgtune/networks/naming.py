"""What commands are given as a ship: a profile, or the file of a trained network."""

from __future__ import annotations

from pathlib import Path
from typing import TypeVar

from ..given import ship_of
from ..profile import ShipProfile
from .file import SUFFIX, load_network
from .predicting import NetworkPredictor

Other = TypeVar("Other")


def named_ship(given: str | Path | Other) -> ShipProfile | NetworkPredictor | Other:
    """The profile, or the network, of a path or bundled name; anything else as it is.

    Raises ProfileError or NetworkError.
    """
    if isinstance(given, (str, Path)):
        is_network = str(given).endswith(SUFFIX)
        return NetworkPredictor(load_network(given)) if is_network else ship_of(given)
    return given
