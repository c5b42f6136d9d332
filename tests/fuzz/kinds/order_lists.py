"""Lists of orders, as CSV."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from mmgtune import limits
from mmgtune.errors import OptionError
from mmgtune.predicting.order_list import read_orders
from mmgtune.profile import Actuator

from ..mutating import encoded, line_doubled, mutated_bytes, mutated_cells, mutated_lines, several
from . import Files, Kind

INPUTS = ("n", "delta")


def make(rng: np.random.Generator) -> Files:
    """A list with something wrong in its cells, lines or bytes."""
    t = np.cumsum(rng.integers(1, 60, size=12))
    rows = zip(t, rng.integers(-35, 36, size=12), rng.integers(40, 120, size=12), strict=True)
    lines = ["t [s],delta [deg],n [rpm]", *(",".join(map(str, row)) for row in rows)]
    if rng.random() < 0.7:
        lines = several(rng, lines, [lambda rng, lines: mutated_cells(rng, lines, ","), mutated_lines])
        return {"orders.csv": encoded("\n".join(lines))}
    return {"orders.csv": several(rng, encoded("\n".join(line_doubled(rng, lines))), [mutated_bytes])}


def run(folder: Path) -> str:
    """Read it and carry it out; what is carried out is finite and within the limits of what moves it."""
    orders = read_orders(folder / "orders.csv", INPUTS)
    limits.ORDERS_STEPS.require(orders.duration, "orders", OptionError)
    t, controls = orders.carried_out(INPUTS, (None, Actuator(-0.6, 0.6, 0.05)), 1.0, 1.0)
    assert (np.diff(t) > 0.0).all()
    assert np.isfinite(controls).all()
    assert (np.abs(controls[:, 1]) <= 0.6 + 1e-9).all()
    return f"{len(orders.t)} orders"


KIND = Kind("order-list", make, run)
