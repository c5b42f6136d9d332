"""Numbers as logs print them, to floats."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...arrays import FloatArray
from .thousands import closed, divider, in_thousands, undivided


def holds_numbers(column: Any) -> bool:
    """Whether a pandas column holds numbers, and not texts, dates or truth values."""
    import pandas as pd

    return pd.api.types.is_numeric_dtype(column.dtype) and not pd.api.types.is_bool_dtype(column.dtype)


def numbers_in(texts: Any, decimal: str, thousands: str | None = None) -> FloatArray:
    """Numbers (n_rows,) of a pandas column of texts, NaN where one is none.

    decimal    "." or ",": where it is a comma, a point is understood too, as programs that print both do
    thousands  what divides thousands, "none" for nothing; None where the column has to show it
    """
    import pandas as pd

    texts = closed(texts)
    divided = in_thousands(texts, decimal) if thousands != "none" else False
    bare = undivided(texts, decimal) if divided or (divided is None and thousands == divider(decimal)) else texts
    if decimal == ",":
        bare = bare.str.replace(",", ".", regex=False)
    return np.asarray(pd.to_numeric(bare, errors="coerce").to_numpy(dtype=np.float64, na_value=np.nan))


def number_in(text: str, decimal: str) -> float | None:
    """The number of one text, None where it is none."""
    try:
        return float(text.replace(",", ".") if decimal == "," else text)
    except ValueError:
        return None
