"""A list of orders: a CSV file with a row an order, its columns time and inputs with units in their headers.

    t [s], delta [deg], n [rpm]
    0, 0, 106
    20, 35, 106
    300, 0, 0

An order holds until the next; the last row says when the prediction ends.  An empty cell leaves an input alone.
``order_table`` reads the same from a table in memory.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .. import limits, units
from ..arrays import FloatArray
from ..errors import OptionError, Problem, closest, reason
from ..inputs import INPUTS
from ..profile import Actuator
from ..trial.schema import LARGEST, LARGEST_RUDDER, RUDDERS, SHORTEST_STEP

TIME = "t"


@dataclass(frozen=True, eq=False)
class OrderList:
    """Orders as they were read.

    id       what a run of them is called
    where    they were given: the file, or the argument
    source   what they are from, in words
    t        (n_orders,) [s], from 0, strictly increasing
    ordered  (n_orders,) by input, in SI; NaN where an input is left alone
    """

    id: str
    where: str
    source: str
    t: FloatArray
    ordered: dict[str, FloatArray]

    @property
    def duration(self) -> float:
        """Time from the first row to the last [s]."""
        return float(self.t[-1])

    def carried_out(
        self, inputs: Sequence[str], actuators: Sequence[Actuator | None], n: float, step: float
    ) -> tuple[FloatArray, FloatArray]:
        """Times (n_samples,) and inputs (n_samples, n_inputs), each moved by its actuator from order to order.

        n     revolutions [1/s] of propellers before they are ordered anything
        step  [s] between samples, at most
        """
        t = np.unique(np.concatenate([np.arange(0.0, self.duration, step), self.t]))
        found = np.empty((len(t), len(inputs)))
        for k, (name, actuator) in enumerate(zip(inputs, actuators, strict=True)):
            begin = n if INPUTS[name].role == "propeller" else 0.0
            found[:, k] = _moved(t, self.t, self.ordered.get(name), begin, actuator)
        return t, found


def _moved(
    t: FloatArray, at: FloatArray, ordered: FloatArray | None, begin: float, gear: Actuator | None
) -> FloatArray:
    """(n_samples,) of one input that stands at ``begin`` before its first order."""
    found = np.full(len(t), begin)
    if ordered is None:
        return found
    held, last = begin, begin
    first = [*np.searchsorted(t, at).tolist(), len(t)]
    for k, when in enumerate(at):
        last = last if math.isnan(ordered[k]) else float(ordered[k])
        part = slice(first[k], first[k + 1])
        found[part] = gear.moved(held, last, t[part] - when) if gear else last
        if k + 1 < len(at):
            held = float(gear.moved(held, last, at[k + 1] - when)) if gear else last
    return found


def read_orders(path: Path, inputs: Sequence[str]) -> OrderList:
    """A list of orders for what has these inputs.

    Raises OptionError for a file that cannot be read or is no such list; it names line and column.
    """
    try:
        text = limits.text(path, limits.ORDERS_BYTES, OptionError)
    except (OSError, ValueError) as error:
        why = reason(error)
        fix = "name a CSV file, or trials with trials=DIR"
        raise OptionError(Problem("the list of orders cannot be read", str(path), why, fix)) from None
    # (line, cells) of what is not empty and no comment
    try:
        rows = [
            (k, [cell.strip() for cell in cells])
            for k, cells in enumerate(csv.reader(text.split("\n")), 1)
            if any(cell.strip() for cell in cells) and not cells[0].lstrip().startswith("#")
        ]
    except csv.Error as error:
        fix = "write a row a line, its cells divided by commas"
        raise OptionError(Problem("the list of orders is no CSV file", str(path), reason(error), fix)) from None
    if len(rows) < 3:
        why = "a header, an order and a last row with the time of the end are needed"
        raise OptionError(Problem("the list of orders is too short", str(path), why, f"write {example(inputs)}"))
    names, factors = header(rows[0][1], inputs, f"{path}, line {rows[0][0]}")
    columns = np.array([_cells(cells, names, f"{path}, line {k}") for k, cells in rows[1:]]).T
    ordered = {name: factor * column for name, factor, column in zip(names, factors, columns, strict=True)}
    t, ordered = held_possible(ordered, lambda k: f"{path}, line {rows[1 + k][0]}")
    return OrderList(path.stem, str(path), path.name, t, ordered)


def held_possible(
    columns: Mapping[str, FloatArray], row: Callable[[int], str]
) -> tuple[FloatArray, dict[str, FloatArray]]:
    """Times from the first on (n_orders,) and what is ordered by input.

    columns  (n_orders,) of time and inputs, in SI; NaN where an input is left alone
    row      where a row stands, by its number from 0
    Raises OptionError for what no ship is ordered, and for times that do not increase.
    """
    ordered = dict(columns)
    t = ordered.pop(TIME)
    for name, column in {TIME: t, **ordered}.items():
        unit, most = _unit(name), LARGEST_RUDDER if name in RUDDERS else LARGEST[_unit(name)]
        for k in np.flatnonzero(np.abs(column) > most)[:1]:
            where = f"{row(k)}, column '{name}'"
            why = f"no ship is ordered more than {most:g} {unit}" if name != TIME else f"the limit is {most:g} s"
            raise OptionError(Problem(f"{name} is {column[k]:g} {unit}", where, why, "correct the number or its unit"))
    late = [k for k in range(1, len(t)) if not t[k] - t[k - 1] > SHORTEST_STEP]
    if late or math.isnan(t[0]):
        where = f"{row(late[0] if late else 0)}, column 't'"
        raise OptionError(Problem("times of orders do not increase", where, fix="write them in order, one a row"))
    return t - t[0], ordered


def header(cells: Sequence[str], inputs: Sequence[str], where: str) -> tuple[list[str], list[float]]:
    """Names of the columns and the factors to SI.

    where  they stand
    Raises OptionError with everything that is wrong in them.
    """
    names, factors, problems = [], [], []
    for cell in cells:
        name, opening, rest = cell.partition("[")
        name, unit = name.strip(), units.canonical(rest.rstrip().removesuffix("]"))
        place = f"{where}, column '{cell}'"
        si = _unit(name) if name in (TIME, *inputs) else ""
        if not si:
            why = f"orders are for {', '.join(inputs)}"
            problems.append(Problem(f"nothing is driven by '{name}'", place, why, closest(name, [TIME, *inputs])))
        elif name in names:
            problems.append(Problem(f"'{name}' is there twice", place, fix="leave one out"))
        elif not opening and name != TIME:
            shown = units.shown_in(si)[0]
            why, fix = "a number does not say what it is in", f"write '{name} [{shown}]' or '{name} [{si}]'"
            problems.append(Problem(f"'{name}' has no unit", place, why, fix))
        elif opening and unit not in units.factors(si):
            known = ", ".join(units.factors(si))
            problems.append(Problem(f"unit '{unit}' is no unit of '{name}'", place, f"it may be {known}", "write one"))
        names.append(name)
        factors.append(units.factors(si).get(unit, 1.0) if si else 1.0)
    if not problems and (TIME not in names or len(names) < 2):
        what = "there is no column 't'" if TIME not in names else "nothing is ordered"
        problems.append(Problem(what, where, fix=f"write {example(inputs)}"))
    if problems:
        raise OptionError(*problems)
    return names, factors


def _unit(name: str) -> str:
    """The SI unit of a column."""
    return "s" if name == TIME else INPUTS[name].unit


def _cells(cells: Sequence[str], names: Sequence[str], where: str) -> list[float]:
    if len(cells) != len(names):
        raise OptionError(
            Problem(f"there are {len(cells)} cells, the header has {len(names)}", where, fix="correct it")
        )
    found = []
    for name, cell in zip(names, cells, strict=True):
        try:
            value = float(cell) if cell else math.nan
            if math.isinf(value) or (name == TIME and math.isnan(value)) or (cell and math.isnan(value)):
                raise ValueError
        except ValueError:
            what = f"'{cell}' is no number" if cell else "the time is missing"
            raise OptionError(Problem(what, f"{where}, column '{name}'", fix="write a plain number")) from None
        found.append(value)
    return found


def example(inputs: Sequence[str]) -> str:
    """How the header of a list for these inputs is written."""
    shown = [f"{name} [{units.shown_in(INPUTS[name].unit)[0]}]" for name in inputs]
    return f"a header such as '{', '.join(['t [s]', *shown])}' and a row an order below it"
