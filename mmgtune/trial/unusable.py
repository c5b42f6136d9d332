"""What forbids using a trial; all of it at once.  Rows are counted from 0."""

from __future__ import annotations

import re
import shlex
from collections.abc import Collection, Mapping

import numpy as np

from ..arrays import FloatArray
from ..errors import Problem, closest
from .checks.finding import Rescale
from .kinematics import FITS, TIMES, Reading, position_misfits, time_unit, turning
from .raw_logs import import_commands
from .schema import (
    COLUMNS,
    FEWEST_SAMPLES,
    LARGEST,
    LARGEST_RUDDER,
    MAIN_INPUTS,
    MOTION,
    REQUIRED,
    RUDDERS,
    SHORTEST_STEP,
    impossible,
    known_column,
)

PER_MINUTE = 58.6
"""From so many times as far as the heading on, a yaw rate turns in rad/min (60), not in degrees per second (57.3)."""


def unusable(
    columns: Mapping[str, FloatArray], where: str, reported: Collection[str] = (), importing: str = ""
) -> list[Problem]:
    """Every reason why a trial cannot be simulated, [] where there is none.

    columns  arrays (n_samples,) by their name in the file; required ones may be missing, which is a problem
    where    the file, for messages
    reported columns of the file that hold no numbers, and of which that has been said
    importing what makes trials of what is none, where that is no file
    """
    problems = missing_columns(columns, where, reported, importing)
    samples = max((len(values) for values in columns.values()), default=0)
    if samples < FEWEST_SAMPLES:
        return [*problems, too_short(samples, where)]
    with np.errstate(all="ignore"):
        problems += _time(columns, where) + _values(columns, where) + _rudder(columns, where)
        problems += _dead(columns, where)
        damaged = any(impossible(values, _unit(name)).any() for name, values in columns.items())
        return problems if damaged else problems + (_other_time(columns, where) or in_degrees(columns, where))


def too_short(samples: int, where: str) -> Problem:
    """The problem of a record with too few samples to be a motion."""
    count = {0: "no samples", 1: "one sample"}.get(samples, f"{samples} samples")
    why = f"a motion needs {FEWEST_SAMPLES} or more"
    return Problem(f"the trial has {count}", where, why, "write the whole record, or take the file out of the folder")


def increasing(t: FloatArray) -> bool:
    """Whether time is finite and each sample is later than the one before."""
    return bool(np.isfinite(t).all() and (np.diff(t) > 0.0).all())


def unusable_part(columns: Mapping[str, FloatArray], where: str, before: float, row: int) -> list[Problem]:
    """Every reason why rows out of the middle of a record cannot be used: time and numbers that are damaged.

    columns  arrays (n_rows,) by name, ``t`` among them
    before   time of the row before these [s], -inf where there is none
    row      number of the first of these

    Gaps are none of them: a record of days has some, and they are cut out of it.
    """
    with np.errstate(all="ignore"):
        problems = _time(columns, where, before, row) + _values(columns, where, row, gaps=True)
        return problems + _rudder(columns, where)


def missing_columns(
    columns: Collection[str], where: str, reported: Collection[str] = (), importing: str = ""
) -> list[Problem]:
    """Required columns that are not there; ``columns`` by their name in the file, the others as above."""
    others = [name for name in columns if name not in REQUIRED]
    missing = [name for name in REQUIRED if name not in columns and name not in reported]
    renames = renamed(missing, others)
    geographic = [name for name in others if _GEOGRAPHIC.match(name)] if {"x", "y"} <= {*missing} - {*renames} else []
    problems = []
    if renames:
        what = f"columns are called otherwise: {', '.join(renames.values())}"
        why = "names of columns count letter by letter, small letters and capitals apart"
        fix = ", ".join(f"{other} to {name}" for name, other in renames.items())
        problems.append(Problem(what, where, why, f"rename {fix}"))
    if geographic:
        what = f"positions are in latitude and longitude: {', '.join(geographic)}"
        why = "trials have x and y, north and east of a local origin [m]; importing makes them"
        problems.append(Problem(what, where, why, importing or import_commands(shlex.quote(where))))
    said = {*renames, *(("x", "y") if geographic else ())}
    return problems + [
        Problem(
            f"column '{name}' is missing",
            where,
            f"it is {column.meaning} [{column.unit}]",
            closest(name, others) if others else f"add it, in {column.unit}",
        )
        for name, column in REQUIRED.items()
        if name in missing and name not in said
    ]


_GEOGRAPHIC = re.compile(r"(lat|lon|lng)(itude|gitude)?($|[^a-z])", re.IGNORECASE)
"""Names of columns that hold degrees of latitude and longitude."""


def renamed(missing: Collection[str], others: Collection[str]) -> dict[str, str]:
    """The column that each missing one is there as, written in capitals or with spaces around it."""
    written = {other.strip().lower(): other for other in others}
    return {name: written[name] for name in missing if name in written}


def _time(columns: Mapping[str, FloatArray], where: str, before: float = -np.inf, first_row: int = 0) -> list[Problem]:
    t = columns.get("t")
    if t is None:
        return []
    if increasing(t) and (not len(t) or t[0] > before):
        return _steps(t, where, before, first_row)
    if not np.isfinite(t).all():
        bad = ~np.isfinite(t)
        place = f"{where}, row {first_row + _first(bad)}"
        return [Problem(f"time is no number in {bad.sum()} rows", place, "", "drop these rows")]
    earlier = np.concatenate([[before], t[:-1]])
    bad = t <= earlier
    row = _first(bad)
    more = f", and in {bad.sum() - 1} rows more" if bad.sum() > 1 else ""
    return [
        Problem(
            "time repeats" if t[row] == earlier[row] else "time goes back",
            f"{where}, row {first_row + row}: t = {t[row]:.10g} s after {earlier[row]:.10g} s{more}",
            "each step of the simulation goes from one sample to the next",
            "sort the rows by time and drop repeated ones",
        )
    ]


def _steps(t: FloatArray, where: str, before: float, first_row: int) -> list[Problem]:
    """Of time that grows, whether it hardly does."""
    steps = np.diff(t, prepend=before)
    bad = steps < SHORTEST_STEP
    if not bad.any():
        return []
    row = _first(bad)
    return [
        Problem(
            f"time goes on by less than {SHORTEST_STEP:g} s in {bad.sum()} rows",
            f"{where}, row {first_row + row}: {steps[row]:.3g} s after the row before",
            "nothing about a ship is logged so fast: the unit of time is wrong, or stamps are there twice",
            "write 't' in s, and one row for each time",
        )
    ]


def _values(columns: Mapping[str, FloatArray], where: str, first_row: int = 0, *, gaps: bool = False) -> list[Problem]:
    """gaps: whether any column may have some."""
    problems: list[Problem] = []

    def say(what: str, name: str, row: int | None, why: str, fix: str) -> None:
        place = f"{where}, column '{name}'" + ("" if row is None else f", row {first_row + row}")
        problems.append(Problem(what, place, why, fix))

    for name, values in columns.items():
        infinite, missing = np.isinf(values), np.isnan(values)
        damaged = impossible(values, _unit(name)) & ~infinite
        if damaged.any():
            unit = _unit(name)
            say(
                f"'{name}' is up to {np.abs(values[damaged]).max():.3g} {unit} in {damaged.sum()} rows",
                name,
                _first(damaged),
                f"nothing about a ship is beyond {LARGEST[unit]:g} {unit}: the file or its source is damaged",
                "copy or make the file again; mark samples that were never measured as NaN",
            )
        if name == "t":
            continue
        if infinite.any():
            say(f"'{name}' is infinite in {infinite.sum()} rows", name, _first(infinite), "", "mark gaps as NaN")
        if gaps:
            continue
        if name in MAIN_INPUTS and missing.any():
            say(
                f"'{name}' is no number in {missing.sum()} rows",
                name,
                _first(missing),
                "the simulation is driven by it at every sample",
                "fill short gaps by interpolation, or cut the trial there",
            )
        elif name in MOTION and missing.all():
            say(f"'{name}' has no values at all", name, None, "", "measure it, or derive it from the other channels")
        elif name in MOTION and missing[0]:
            say(
                f"'{name}' has no value in the first sample",
                name,
                0,
                "the simulation starts from it",
                f"cut the trial to its first complete row; '{name}' begins in row {_first(~missing)}",
            )
    return problems


def _rudder(columns: Mapping[str, FloatArray], where: str) -> list[Problem]:
    problems = []
    for name in RUDDERS:
        angle = np.abs(columns.get(name, np.zeros(1)))
        angle = angle[np.isfinite(angle)]
        beyond = angle > LARGEST_RUDDER
        if beyond.any():
            few = beyond.mean() < 0.01
            problems.append(
                Problem(
                    f"rudder angle up to {angle.max():.3g} rad",
                    f"{where}, column '{name}'",
                    f"a rudder beyond {LARGEST_RUDDER} rad is not physical; "
                    + ("only some samples are" if few else "the column is probably in degrees"),
                    "remove the wrong samples" if few else Rescale("multiply it by pi/180", name),
                )
            )
    return problems


def _dead(columns: Mapping[str, FloatArray], where: str) -> list[Problem]:
    """A record in which nothing moves and nothing was ordered."""
    there = [columns[name] for name in (*MOTION, *MAIN_INPUTS) if name in columns]
    still = all(len(np.unique(values[np.isfinite(values)])) <= 1 for values in there)
    speeds = [columns[name] for name in ("u", "v", "r", "n") if name in columns]
    if not speeds or not still or any(np.any(values[np.isfinite(values)]) for values in speeds):
        return []
    why = "speeds and revolutions are 0 and nothing changes from the first sample to the last"
    return [Problem("nothing moves in the whole trial", where, why, "export the columns again, or leave the file out")]


def _other_time(columns: Mapping[str, FloatArray], where: str) -> list[Problem]:
    """Time in another unit than seconds, told by yaw rate and velocities at once."""
    if not {"t", "x", "y", "psi", "u", "v", "r"} <= set(columns) or not increasing(columns["t"]):
        return []
    unit = time_unit(columns)
    if not unit:
        return []
    factor = TIMES[unit]
    why = f"heading and positions change {factor:.3g} times as much in a second as 'r', 'u' and 'v' say"
    fix = f"multiply 't' by {factor:g}" if factor > 1.0 else f"divide 't' by {1.0 / factor:g}"
    return [Problem(f"'t' is in {unit}, not s", f"{where}, column 't'", why, Rescale(fix, "t"))]


def in_degrees(columns: Mapping[str, FloatArray], where: str) -> list[Problem]:
    """Heading or yaw rate in degrees, told by each other and by the positions."""
    if not {"t", "psi"} <= set(columns) or not increasing(columns["t"]):
        return []
    if "r" in columns:
        turned = turning(columns)
        column = turned.in_degrees()
        if column:
            ratio = turned.ratio if column == "psi" else 1.0 / turned.ratio
            why = f"it turns {ratio:.3g} times as far as the other of 'psi' and 'r' says"
            if column == "r" and ratio > PER_MINUTE:
                fix = Rescale("divide 'r' by 60", "r")
                return [Problem("'r' is in rad/min, not rad/s", f"{where}, column 'r'", why, fix)]
            return [_in_degrees(column, where, why)]
    psi = columns["psi"][np.isfinite(columns["psi"])]
    if len(psi) == 0 or np.abs(psi).max() < 2.0 * np.pi or not {"x", "y", "u", "v"} <= set(columns):
        return []
    misfits = position_misfits(columns, among=(Reading.IN_DEGREES,))
    if not misfits or misfits[Reading.IN_DEGREES] > FITS:
        return []
    misfits = position_misfits(columns)
    # Only so: angles of a few radians read in degrees are nearly no angles, as if velocities were in earth axes.
    others = [misfit for reading, misfit in misfits.items() if reading is not Reading.IN_DEGREES]
    if min(others) < 3.0 * FITS:
        return []
    problems = [_in_degrees("psi", where, "read in degrees, and only so, it leads u and v along the positions")]
    if "r" in columns and turned.span > 6.0 and turned.miss < 0.15 * turned.span:
        problems.append(_in_degrees("r", where, "it agrees with a heading that is in degrees"))
    return problems


def _in_degrees(column: str, where: str, why: str) -> Problem:
    unit = "degrees" if column == "psi" else "degrees per second"
    what = f"'{column}' is in {unit}, not {COLUMNS[column].unit}"
    return Problem(what, f"{where}, column '{column}'", why, Rescale(f"multiply '{column}' by pi/180", column))


def _unit(name: str) -> str:
    """The unit of a column, "" of one that the program does not know."""
    known = known_column(name)
    return known.unit if known else ""


def _first(condition: np.ndarray) -> int:
    return int(np.flatnonzero(condition)[0])
