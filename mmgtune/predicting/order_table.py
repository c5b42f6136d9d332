"""A list of orders as a table in memory, such as a DataFrame: the columns of the CSV file, under the same names."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol, runtime_checkable

import numpy as np

from ..arrays import FloatArray
from ..errors import OptionError, Problem
from ..trial.from_table import numbers_of, with_time
from .order_list import TIME, OrderList, example, header, held_possible

WHERE = "orders"
"""The argument that a table is given as, and what a run of it is called."""


@runtime_checkable
class Columns(Protocol):
    """What has columns by name, as a DataFrame and a dict have."""

    def keys(self) -> Any:
        """The names."""
        ...

    def __getitem__(self, name: Any) -> Any:
        """A column."""
        ...


def orders_in(table: Columns, inputs: Sequence[str]) -> OrderList:
    """A list of orders for what has these inputs.

    table  a DataFrame, or a mapping of names to (n_orders,) numbers, named as in the CSV file: "t [s]", "delta [deg]";
           time may be the index of a DataFrame; NaN and None leave an input alone
    Raises OptionError for what is no such list; it names row, counted from 0, and column.
    """
    columns_of = with_time(table)
    given = list(columns_of.keys())
    names, factors = header([str(one) for one in given], inputs, WHERE)
    columns = {
        name: factor * _numbers(name, columns_of[one]) for name, factor, one in zip(names, factors, given, strict=True)
    }
    lengths = {name: len(column) for name, column in columns.items()}
    odd = next((name for name, n in lengths.items() if n != lengths[TIME]), None)
    if odd is not None:
        what = f"'{odd}' has {lengths[odd]} rows, '{TIME}' {lengths[TIME]}"
        raise OptionError(Problem(what, WHERE, "each order has a time", "write NaN where an input is left alone"))
    if lengths[TIME] < 2:
        why = "an order and a last row with the time of the end are needed"
        raise OptionError(Problem("the list of orders is too short", WHERE, why, f"write {example(inputs)}"))
    for k in np.flatnonzero(np.isnan(columns[TIME]))[:1]:
        where = f"{WHERE}, row {k}, column '{TIME}'"
        raise OptionError(Problem("the time is missing", where, fix="write when each order is given"))
    t, ordered = held_possible(columns, lambda k: f"{WHERE}, row {k}")
    return OrderList(WHERE, WHERE, "a table", t, ordered)


def _numbers(name: str, column: Any) -> FloatArray:
    """A column (n_orders,).  Raises OptionError where it holds anything but numbers."""
    found = numbers_of(column)
    if found is None:
        where, fix = f"{WHERE}, column '{name}'", "write plain numbers"
        raise OptionError(Problem(f"column '{name}' holds no numbers", where, fix=fix))
    return found
