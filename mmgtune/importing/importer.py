"""Logs to trial files."""

from __future__ import annotations

import itertools
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Protocol, runtime_checkable

import numpy as np

from ..arrays import FloatArray
from ..displayed import inert
from ..documents import write_json
from ..errors import LogError, Problem, kind_of, parts_of
from ..files import all_or_none, path_of, refuse_existing, refuse_file, require_flag, true_path
from ..phrases import counted
from ..resources import must_be_name
from ..trial import Trial, write_trial
from ..trial.schema import ATTRIBUTES, directions, known_column
from ..trial.unusable import unusable
from . import conventions, motion
from .cleaning import without_spikes
from .clock import falls, put_right
from .cutting import kept, pull_out
from .doubts import fix_in_map
from .formats.forms import form_of, refuse_binary
from .formats.kept import opened_once
from .formats.matlab import variables
from .formats.matlab_columns import read_matlab, runs_in
from .formats.nmea import read_nmea
from .formats.parquet_log import read_parquet
from .formats.sides import as_cells_say
from .formats.table import InPart, Table
from .formats.text import binary, read_text, start_of
from .formats.workbook import logs_among, outlines_of, read_workbook
from .geodesy import not_mirrored, with_local_positions
from .gridding import FEWEST, Grid, missing_between, on_grid, require_step, stretches
from .jumps import cut_at_jumps
from .maps.mapping import ALL, LogMap
from .maps.quantities import MEASURED
from .maps.reading_map import load_map
from .means import with_mean
from .proposing.elsewhere import yaw_rate_elsewhere
from .quality import quality_of, quality_text, same_units_throughout
from .record import Record, record_of, time_in_seconds, when_it_happened
from .yaw import heading_recovered

REPORT = "import-report.json"
QUICKEST = 1e-7
"""Time between rows [s] that no logger comes near."""


@runtime_checkable
class HasMap(Protocol):
    """What a map can be had of, as of a proposal."""

    def map(self) -> LogMap:
        """The map.  Raises LogError where it asks."""
        ...


@dataclass(frozen=True, eq=False)
class Piece:
    """What becomes one trial.

    columns  of the trial format, (n_samples,)
    began    time of the first sample on the log's clock [s]
    notes    what was done, in sentences
    derived  columns of the motion that were worked out from others
    follows  "pull-out" where it is what follows the piece before it; else ""
    cut      where the log was cut before it, as the end of "cut where ..."; "" where it was not
    """

    columns: dict[str, FloatArray]
    record: Record
    grid: Grid
    began: float
    notes: list[str]
    derived: tuple[str, ...] = ()
    follows: str = ""
    cut: str = ""


@dataclass(frozen=True)
class Refused:
    """A log, or a part of one, of which no trial was made.

    log       path of it
    part      its sheet or variable, "" where the log is one trial
    problems  what is wrong with it
    """

    log: Path
    part: str
    problems: tuple[Problem, ...]

    @property
    def name(self) -> str:
        """The log, and the part where there are several, for people."""
        return f"{self.log}, '{self.part}'" if self.part else str(self.log)

    def to_dict(self) -> dict[str, Any]:
        """As JSON."""
        problems = [one.to_dict() for one in self.problems]
        return {"log": str(self.log), "part": self.part, "problems": problems}

    def text(self) -> str:
        """What is wrong with it, for people."""
        return "\n".join(
            [f"{self.name}: refused", *(f"  {line}" for one in self.problems for line in str(one).splitlines())]
        )


@dataclass(frozen=True, eq=False)
class Imported:
    """Trials made from logs.

    trials   in the order of the logs
    quality  one entry per trial (``quality.quality_of``)
    files    what was written, () after a dry run
    map      name of the map
    refused  logs, and parts of logs, of which no trial was made: () unless the import was to keep going
    """

    trials: tuple[Trial, ...]
    quality: tuple[dict[str, Any], ...]
    files: tuple[Path, ...]
    map: str
    refused: tuple[Refused, ...] = ()

    def __repr__(self) -> str:
        """In a line."""
        refused = f", {len(self.refused)} refused" if self.refused else ""
        written = "written" if self.files else "not written"
        return f"Imported({counted(len(self.trials), 'trial')} by the map {inert(self.map)[:40]}, {written}{refused})"

    def to_dict(self) -> dict[str, Any]:
        """The report as written to ``import-report.json``."""
        return {
            "schema": 1,
            "kind": "import",
            "map": self.map,
            "trials": list(self.quality),
            "files": [str(path) for path in self.files],
            "refused": [one.to_dict() for one in self.refused],
        }

    def text(self) -> str:
        """The report for people."""
        common: set[str] = set.intersection(*(set(one["notes"]) for one in self.quality)) if self.quality else set()
        if len(self.quality) < 2:
            common = set()
        told: set[tuple[str, str]] = set()
        lines = [quality_text(one, common, told) for one in self.quality]
        of_all = [note for note in self.quality[0]["notes"] if note in common] if self.quality else []
        lines += [f"all {len(self.quality)} trials: {note}" for note in of_all]
        return "\n".join([*lines, *(one.text() for one in self.refused)])


@opened_once()
def import_logs(
    logs: Path | str | Sequence[Path | str],
    log_map: LogMap | HasMap | Path | str,
    out: Path | str,
    step: float | None = None,
    overwrite: bool = False,
    dry_run: bool = False,
    keep_going: bool = False,
) -> Imported:
    """Write each log as one trial file in the folder ``out``, or several where it has to be cut, and a report beside.

    logs        paths of them; of one a path does
    log_map     what their columns are, the file that says so, or what ``propose_map`` found
    step        time step of the trials [s]; None: what the map says, else the log's own median
    dry_run     write nothing
    keep_going  import the logs, and the sheets or variables of logs, that can be read where others cannot: these are
                ``refused`` of the result. False: all or none

    Raises LogError with everything wrong in any of the logs, also where none can be imported or two would become one
    trial, OptionError for a step that is none, and OutputError where a file exists already and ``overwrite`` is false;
    nothing is written then.
    """
    require_step(step)
    out = path_of(out)
    paths = paths_of(logs)
    if isinstance(log_map, HasMap):
        log_map = log_map.map()
    log_map = log_map if isinstance(log_map, LogMap) else load_map(log_map)
    refuse_file(out)
    require_flag(overwrite)
    refused: list[Refused] = []
    runs: list[tuple[Path, LogMap]] = []
    for log in paths:
        try:
            runs += [(log, own) for own in _each(log_map, log)]
        except LogError as error:
            refused.append(Refused(log, "", error.problems))
    if not dry_run and not overwrite:
        # Known before the work is done; parts of a log that is cut are found out later.
        refuse_existing([out / REPORT, *(out / f"{_name(own, log)}.parquet" for log, own in runs)])
    trials: list[Trial] = []
    quality: list[dict[str, Any]] = []
    sources: dict[str, list[tuple[Path, LogMap]]] = {}
    good = 0
    for log, own in runs:
        try:
            # Damaged numbers overflow on their way to where they are found out.
            with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
                made = _trials(log, own, step)
        except LogError as error:
            problems = [_of_part(one, own.part) if own.part else one for one in error.problems]
            refused.append(Refused(log, own.part, tuple(problems)))
            continue
        good += 1
        trials += [trial for trial, _ in made]
        quality += [one for _, one in made]
        for trial, _ in made:
            sources.setdefault(trial.id, []).append((log, own))
    twice = [_of_one_name(name, found) for name, found in sources.items() if len(found) > 1]
    if twice or (refused and not (keep_going and good)):
        wrong = list(dict.fromkeys(problem for one in refused for problem in one.problems))
        if good and wrong and not keep_going:
            rest = f"keep_going=True imports the {counted(good, 'other')}"
            wrong[-1] = replace(wrong[-1], fix=f"{wrong[-1].fix}; {rest}" if wrong[-1].fix else rest)
        raise LogError(*wrong, *twice)
    if dry_run:
        return Imported(tuple(trials), tuple(quality), (), log_map.name, tuple(refused))
    files = [out / f"{trial.id}.parquet" for trial in trials]
    refuse_existing(files, overwrite)
    imported = Imported(tuple(trials), tuple(quality), tuple(files), log_map.name, tuple(refused))
    with all_or_none():
        for trial, path in zip(trials, files, strict=True):
            write_trial(trial, path, overwrite)
        write_json(imported.to_dict(), out / REPORT, overwrite)
    return imported


def paths_of(logs: Path | str | Sequence[Path | str]) -> tuple[Path, ...]:
    """The paths of logs, each once; of one the path alone does.  Raises LogError for what is none, and for no logs."""
    if hasattr(logs, "columns"):
        what, why = "a table is no log", "logs are files, and this one is in memory already"
        raise LogError(
            Problem(what, "logs", why, "make a trial of it: mmgtune.trial_of(table, 'turn_p35', ship='...')")
        )
    several = [logs] if isinstance(logs, (str, Path)) else parts_of(logs)
    if not several:
        what = "the list of logs is empty" if several == [] else f"{kind_of(logs)} is no list of logs"
        raise LogError(Problem(what, "logs", "their paths are wanted here", "give one path or several"))
    for one in several:
        must_be_name(one, "log", LogError)
    return tuple(dict.fromkeys(Path(one) for one in several))


def _each(log_map: LogMap, log: Path) -> tuple[LogMap, ...]:
    """The maps of one log: one for each of its parts, whose names then have that of the part in them.

    Raises LogError where all parts are wanted of a log that cannot be read.
    """
    own = log_map.of(log)
    parts = _parts_in(log, own) if own.part == ALL else own.parts
    template = own.id if "{part}" in own.id else f"{own.id}_{{part}}"
    found: dict[str, LogMap] = {}
    for part in parts:
        named = replace(own.of_part(part), id=template)
        taken = {name.lower() for name in found}  # run 1 and run_1, as files are called
        number = len(found) + 1
        while _name(named, log).lower() in taken:
            named, number = replace(named, id=f"{template}_{number}"), number + 1
        found[_name(named, log)] = named
    return tuple(found.values()) or (own,)


def _parts_in(log: Path, log_map: LogMap) -> list[str]:
    """The sheets of a workbook that hold a log, or the runs in a MATLAB file; "" where these are not told apart."""
    return (runs_in(variables(log)) if log_map.variable else logs_among(outlines_of(log))) or [""]


def _of_one_name(name: str, found: Sequence[tuple[Path, LogMap]]) -> Problem:
    """What is wrong where several trials would have the name ``name``, by the logs and maps that they are of."""
    (first, one), (second, other) = found[:2]
    what = f"several {'parts' if first == second else 'logs'} would become trial '{name}'"
    shown = [f"'{of.part}'" if first == second else f"'{log.name}'" for log, of in ((first, one), (second, other))]
    cut = [text for text, (log, of) in zip(shown, found, strict=False) if _name(of, log) != name]
    why = f"{cut[0]} is cut in parts, and they are numbered" if cut else f"{shown[0]} and {shown[1]} have one name"
    if first == second:
        fix = 'say id = "{part}-{stem}" in [trial], so that the numbers follow the log\'s name'
    elif cut:
        fix = f"give {next((text for text in shown if text not in cut), shown[1])} another name, or import it by itself"
    else:
        fix = 'say id = "{parent}-{stem}" in [trial]'
    return Problem(what, str(second), why, fix)


def _of_part(problem: Problem, part: str) -> Problem:
    """A problem in a part of a log, which says where that is."""
    return problem if isinstance(problem.where, InPart) else problem.at(f"{problem.where}, in '{part}'")


def _name(log_map: LogMap, log: Path) -> str:
    """The name of the trial that a log becomes."""
    part = re.sub(r"[^\w-]+", "_", log_map.part).strip("_")
    return re.sub(r"[^\w.-]+", "_", _written(log_map.id, log, part)).strip("._") or "trial"


def _written(template: str, log: Path, part: str) -> str:
    text = template.replace("{stem}", log.stem).replace("{parent}", true_path(log).parent.name)
    return text.replace("{part}", part)


def _trials(log: Path, log_map: LogMap, step: float | None) -> list[tuple[Trial, dict[str, Any]]]:
    """The trials of one log with their quality.  Raises LogError."""
    read, log_map = _records(log, log_map)
    records = [part for record in read for part in cut_at_jumps(record, log_map, step)]
    made: list[Piece] = []
    runs: list[int] = []
    short = 0
    for run, record in zip(_runs(records), records, strict=True):
        if len(records) > 1 and max(len(one.t) for one in record.series.values()) < FEWEST:
            short += 1
            continue
        try:
            pieces = _of_record(record, log_map, step)
            if made:
                pieces[0] = replace(pieces[0], cut=pieces[0].cut or "its time jumps")
            made += pieces
            runs += [run] * len(pieces)
        except LogError:
            # A few seconds between two settings of a clock are no trial; a whole log that is none is an error.
            if len(records) == 1 or max(len(one.t) for one in record.series.values()) > FEWEST:
                raise
            short += 1
    if not made:
        what = f"each of the {len(records)} parts of the log has fewer than {FEWEST} rows to make a trial of"
        why = "; ".join(dict.fromkeys(records[0].notes[-2:]))
        raise LogError(Problem(what, str(log), why, "correct the clock's stamps in the log, or give another log"))
    name = _name(log_map, log)
    found = []
    count = sum(not piece.follows for piece in made)
    number = 0
    first: dict[int, str] = {}
    for run, piece in zip(runs, made, strict=True):
        number += not piece.follows
        of_run = first.setdefault(run, name if len(set(runs)) == 1 else f"{name}_{number}")
        cut_from = of_run if runs.count(run) > 1 else ""
        id = name if count == 1 else f"{name}_{number}"
        notes = list(piece.notes)
        if count > 1:
            cut = f", cut where {piece.cut}" if piece.cut else ""
            notes = [f"part {number} of {count} of the log{cut}", *notes]
        if short:
            notes = [
                *notes,
                f"{counted(short, 'part')} with fewer than {FEWEST} rows {'was' if short == 1 else 'were'} left out",
            ]
        found.append(_trial(f"{id}_{piece.follows}" if piece.follows else id, piece, notes, log_map, cut_from))
    return found


AGAIN = 0.1
"""Share of the time of a part of a log within which the next one begins again where it is another run."""


def _runs(records: Sequence[Record]) -> list[int]:
    """The run that each part of a log is of: where its time jumps forward by far, or begins again, a run has ended; a
    clock that is set in between ends none."""
    spans = [_span(record) for record in records]
    ended = [
        next_one[0] > one[1] or next_one[0] < one[0] + AGAIN * (one[1] - one[0])
        for one, next_one in itertools.pairwise(spans)
    ]
    return [0, *itertools.accumulate(map(int, ended))]


def _span(record: Record) -> tuple[float, float]:
    """First and last time of a record [s]."""
    times = [one.t for one in record.series.values() if len(one.t)]
    return min((float(t[0]) for t in times), default=0.0), max((float(t[-1]) for t in times), default=0.0)


def _records(log: Path, log_map: LogMap) -> tuple[list[Record], LogMap]:
    """A log in the program's units, in parts where its clock was set back, and the map with what its cells say."""
    form = log_map.format or form_of(log)
    content = start_of(log)
    if form == "nmea":
        if binary(content):
            raise LogError(
                Problem("the log is binary, not NMEA 0183", str(log), fix="convert it with its logger's software")
            )
        return read_nmea(log, log_map), log_map
    if form == "csv":
        refuse_binary(log, content, log_map)
    readers = {"csv": read_text, "parquet": read_parquet, "xlsx": read_workbook, "mat": read_matlab}
    table = readers[form](log, log_map)
    log_map = as_cells_say(log_map, table.sided, table.headers)
    _turn_round(table)
    _drop_duplicates(table)
    line = put_right(time_in_seconds(table, log_map), log_map.time, table.place)
    table.columns = {name: values[line.keep] for name, values in table.columns.items()}
    t = line.t[line.keep]
    usual = float(np.median(np.abs(np.diff(t)))) if len(t) > 1 else 1.0
    if usual < QUICKEST:
        what, why = f"the rows are {usual:.3g} s apart", "no logger is as quick"
        raise LogError(Problem(what, table.place(0), why, "check unit and scale in [time] of the map"))
    bounds = [0, *line.parts, len(t)]
    records = []
    for first, last in itertools.pairwise(bounds):
        record = record_of(table, log_map, t, slice(first, last))
        record.notes += [*table.notes, *line.notes]
        records.append(record)
    return records, log_map


def _turn_round(table: Table) -> None:
    """Put rows that were written newest first in the order of time, in place."""
    if falls(table.t):
        table.t, table.rows = table.t[::-1], table.rows[::-1]
        table.columns = {name: values[::-1] for name, values in table.columns.items()}
        table.notes.append("the rows are written newest first, and were turned round")


def _drop_duplicates(table: Table) -> None:
    """Leave out rows that were written twice, in place; stamps that repeat over different rows are left alone."""
    again = np.diff(table.t) == 0.0
    same = again & np.all(
        [(np.diff(values) == 0.0) | np.isnan(values[1:]) & np.isnan(values[:-1]) for values in table.columns.values()],
        axis=0,
    )
    if not same.any() or same.sum() < 0.8 * again.sum():
        return
    kept = np.concatenate([[True], ~same])
    row = int(np.flatnonzero(~kept)[0])
    table.notes.append(f"{same.sum()} rows are written twice and were dropped, the first in {table.place(row)}")
    table.t, table.rows = table.t[kept], table.rows[kept]
    table.columns = {name: values[kept] for name, values in table.columns.items()}


def _of_record(record: Record, log_map: LogMap, step: float | None) -> list[Piece]:
    """What each trial in a record is made of, in the trial format.  Raises LogError where none is left."""
    where = str(record.path)
    record = when_it_happened(record, log_map)
    record = heading_recovered(without_spikes(with_local_positions(record, log_map)), log_map)
    grid = on_grid(record, log_map, step)
    columns = dict(grid.columns)
    measured = {name for name in record.series if name in ("u", "v", "r")}
    notes = list(record.notes)
    along_track = "sog" in columns and "cog" not in columns
    if along_track:
        notes += motion.with_course(grid.t, columns)
    if "sog" in columns:
        sog, cog = columns.pop("sog"), columns.pop("cog")
        columns["north"], columns["east"] = sog * np.cos(cog), sog * np.sin(cog)
    if "u" in measured or "north" not in columns:
        same_units_throughout(grid.t, columns, where)
    if "latitude" in log_map.sources or log_map.format == "nmea":
        not_mirrored(columns, where)
    if grid.bridged:
        notes.append(f"holes of up to {log_map.gap:g} steps were bridged linearly")
    notes += motion.at_midship(columns, log_map)
    if log_map.antenna is None and log_map.point is None:
        notes.append("positions are taken to be of midship, as the map has no [antenna]")
    before = set(columns)
    notes += motion.with_yaw_rate(grid.t, columns)
    try:
        notes += conventions.settle(grid.t, columns, log_map, measured, where)
    except conventions.NoYawRate as error:
        raise _elsewhere(error, record.path, log_map) from error
    notes += motion.over_ground(columns, log_map)
    before |= ({"u"} if along_track else {"u", "v"}) & set(columns)
    notes += motion.with_velocities(grid.t, columns)
    derived = tuple(name for name in ("u", "v", "r") if name in columns and name not in before)
    notes += with_mean(columns, "n", log_map)
    notes += conventions.settle_rudders(grid.t, columns, log_map, where)
    notes += with_mean(columns, "delta", log_map)
    found: list[Piece] = []
    end = 0
    for part in stretches(columns, log_map.inputs):
        cut = {name: values[part] for name, values in columns.items()}
        t = grid.t[part]
        inside, dropped = kept(t, cut, log_map, where)
        cut = {name: values[inside] for name, values in cut.items()}
        # What a cut begins with must be complete as well.
        rest = stretches(cut, log_map.inputs, 1)
        if rest and len(t[inside][rest[0]]) >= FEWEST:
            begun = t[inside][rest[0]]
            cut = {name: values[rest[0]] for name, values in cut.items()}
            why = missing_between(grid.t, columns, log_map.inputs, slice(end, part.start)) if found else ""
            piece = Piece({"t": begun, **cut}, record, grid, float(begun[0]), [*notes, *dropped], derived, cut=why)
            end = part.stop
            found += _split(piece) if log_map.cut.split else [piece]
    if not found:
        needed = [name for name in (*MEASURED, *log_map.inputs) if not np.isfinite(columns[name]).any()]
        why = (
            f"no sample has {', '.join(needed)}"
            if needed
            else "positions, heading, velocities and inputs are never all there"
        )
        raise LogError(
            Problem(
                f"no stretch of {FEWEST} samples or more is left to make a trial of",
                where,
                why,
                "check the map, [cut], and the gaps of the log",
            )
        )
    return found


def _elsewhere(error: LogError, log: Path, log_map: LogMap) -> LogError:
    """What is wrong with a record whose yaw rate is none: where it is instead, rather than a question for its sign."""
    found = yaw_rate_elsewhere(log, log_map)
    if found is None:
        return error
    said, fix = found
    first, *others = error.problems
    column = log_map.sources["r"].column
    shown = f"'{column}'" if isinstance(column, str) else f"column {column}"
    what = f"{shown} is not the yaw rate, which the map says it is"
    return LogError(Problem(what, first.where, f"{first.why}; {said}", fix), *others)


def _split(piece: Piece) -> list[Piece]:
    """A turning circle and its pull-out, where it has one."""
    first = pull_out(piece.columns["t"], piece.columns)
    if first is None:
        return [piece]
    at = float(piece.columns["t"][first])
    # The last sample of one is the first of the other, as each needs its own state to start from.
    parts = (("", slice(0, first + 1), f"its pull-out, from {at:.6g} s of the log, is a trial of its own"),
             ("pull-out", slice(first, None), "the pull-out after a turning circle, a trial of its own"))  # fmt: skip
    return [
        Piece(
            {name: values[part] for name, values in piece.columns.items()},
            piece.record,
            piece.grid,
            float(piece.columns["t"][part][0]),
            [*piece.notes, said],
            piece.derived,
            follows,
            "its pull-out begins" if follows else piece.cut,
        )
        for follows, part, said in parts
    ]


def _trial(id: str, piece: Piece, notes: list[str], log_map: LogMap, cut_from: str) -> tuple[Trial, dict[str, Any]]:
    """A trial and its quality.  Raises LogError where it could not be used."""
    record = piece.record
    columns = {**piece.columns, "t": piece.columns["t"] - piece.began}
    # Whoever reads the trial elsewhere has no use for a folder of this machine.
    notes = [note.replace(str(record.path), record.path.name) for note in notes]
    problems = unusable(columns, str(record.path))
    if problems:
        raise LogError(*(replace(one, fix=fix_in_map(one.fix)) for one in problems))
    kept = {ATTRIBUTES.get(name, name): values for name, values in columns.items()}
    required: Any = {name: kept.pop(name) for name in ATTRIBUTES.values()}
    for name in directions(kept):
        kept[name] = np.mod(kept[name], 2.0 * np.pi)
    trial = Trial(
        id=id,
        ship=log_map.ship,
        manoeuvre=piece.follows or log_map.manoeuvre.replace("{parent}", true_path(record.path).parent.name),
        group=_written(log_map.group, record.path, log_map.part) if log_map.group else "",
        source=log_map.source,
        **required,
        extra={name: values for name, values in kept.items() if known_column(name)},
        noise=log_map.noise,
        note="; ".join([*([log_map.note] if log_map.note else []), f"imported with the map {log_map.name}", *notes]),
        cut_from=cut_from,
        derived=piece.derived,
        antenna=log_map.antenna,
    )
    return trial, {**quality_of(trial, record, piece.grid, piece.began, notes, log_map), "cut": piece.cut}
