"""Numbers as logs print them, to floats."""

from __future__ import annotations

import re
from typing import Any

import numpy as np

from ..arrays import FloatArray


def holds_numbers(column: Any) -> bool:
    """Whether a pandas column holds numbers, and not texts, dates or truth values."""
    import pandas as pd

    return pd.api.types.is_numeric_dtype(column.dtype) and not pd.api.types.is_bool_dtype(column.dtype)


def numbers_in(texts: Any, decimal: str) -> FloatArray:
    """Numbers (n_rows,) of a pandas column of texts, NaN where one is none.

    decimal  "." or ",": where it is a comma, a point is understood too, as programs that print both do
    """
    import pandas as pd

    if decimal == ",":
        bare = texts.str.replace(",", ".", regex=False)
    else:
        bare = texts.str.replace(",", "", regex=False) if _in_thousands(texts) else texts
    return np.asarray(pd.to_numeric(bare, errors="coerce").to_numpy(dtype=np.float64, na_value=np.nan))


_THOUSANDS = re.compile(r"[-+]?\d{1,3}(,\d{3})+(\.\d*)?")
_PLAINLY = re.compile(r"[-+]?\d{1,3}(,\d{3})+\.\d*|[-+]?\d{1,3}(,\d{3}){2,}")
"""Such as 1,001.5 and 1,234,567: a comma that no decimal sign can be."""


def _in_thousands(texts: Any) -> bool:
    """Whether commas divide the thousands of a column: all that have one read so, and some cannot read otherwise."""
    commas = texts[texts.str.contains(",", regex=False).fillna(False)]
    return bool(
        len(commas) and commas.str.fullmatch(_PLAINLY).any() and commas.str.fullmatch(_THOUSANDS).fillna(False).all()
    )


def number_in(text: str, decimal: str) -> float | None:
    """The number of one text, None where it is none."""
    try:
        return float(text.replace(",", ".") if decimal == "," else text)
    except ValueError:
        return None
