"""Bands beside what other commands say of a ship."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ..errors import OptionError

if TYPE_CHECKING:
    from ..options import PredictOptions
    from ..predictor import Uncertain


def bands_on(ship: Uncertain, options: PredictOptions) -> tuple[dict[str, Any] | None, list[str]]:
    """Bands on the indices of the manoeuvres of the options, the usual ones where there are none, and notes on them.

    None, with the reason, for a ship that they cannot be ordered of: what stands beside them is worth as much.
    """
    from ..predicting import predict

    try:
        found = predict(ship, options=options)
    except OptionError as error:
        return None, [f"No bands: {one.what}{f' ({one.why})' if one.why else ''}." for one in error.problems]
    return found.indices(), list(found.notes)
