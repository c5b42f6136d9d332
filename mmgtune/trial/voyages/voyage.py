"""Logs of hours and days: trial files that are read block by block, never whole."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from ... import limits
from ...arrays import FloatArray
from ...errors import Problem, TrialError, reason
from ...files import require_regular
from ..digest import DIGEST_KEY, digest_of
from ..footer import rows_of
from ..metadata import antenna_of, facts_of
from ..parquet import another_digest, layout_of, numbers, unreadable
from ..raw_logs import refuse_log
from ..schema import FEWEST_SAMPLES, METADATA_KEY
from ..unusable import missing_columns, too_short, unusable_part

VOYAGE = "voyage"
"""What a trial's manoeuvre says where it is none: the ship went about her business."""

LONG = 3600.0
"""Seconds beyond which a trial is a voyage whatever it says."""

BLOCK = 65_536
"""Rows read at one time."""

_BUFFER = 1 << 18
"""Bytes of a column that are read at one time, however large its row group."""


@dataclass(frozen=True, eq=False)
class Block:
    """Rows of a voyage that follow each other.

    row      number of the first
    columns  arrays (n_rows,) by name
    """

    row: int
    columns: dict[str, FloatArray]


@dataclass(frozen=True, eq=False)
class Voyage:
    """A trial file as it says itself it is; its rows are read when they are wanted.

    manoeuvre  "voyage", or what else it says
    source     "measured", "generated", or "" where the file does not say
    n_rows     rows it has
    begins, ends  time of the first and last [s]
    columns    those that hold numbers, by name
    ignored    those that do not
    sealed     whether the file holds a digest of columns and facts, see ``verify``
    antenna    see ``Trial``
    """

    id: str
    ship: str
    manoeuvre: str
    source: str
    cut_from: str
    path: Path
    n_rows: int
    begins: float
    ends: float
    columns: tuple[str, ...]
    ignored: tuple[str, ...]
    sealed: bool
    antenna: tuple[float, float] | None
    _groups: tuple[int, ...] = field(repr=False)

    @property
    def duration(self) -> float:
        """Time from the first row to the last [s]."""
        return self.ends - self.begins

    @property
    def is_voyage(self) -> bool:
        """Whether it says so, or lasts longer than any manoeuvre."""
        return self.manoeuvre.strip().lower() == VOYAGE or self.duration > LONG

    @property
    def run(self) -> str:
        """Name of what was sailed in one go, which files cut from it share."""
        return self.cut_from or self.id

    def blocks(self, first: int = 0) -> Iterator[Block]:
        """All rows in order, BLOCK at a time whatever its row groups are; every page is held against its checksum.

        first  row from which on they are wanted, for which no more than its row group is read

        Raises TrialError where a row group is damaged, time does not increase, or numbers cannot be right.
        """
        before = -np.inf
        for block in _even(self._parts(self.columns, first), self.columns):
            problems = unusable_part(block.columns, str(self.path), before, block.row)
            before = float(block.columns["t"][-1])
            if problems:
                raise TrialError(*problems)
            yield block

    def verify(self) -> str:
        """SHA-256 of the file, once its columns and facts are found to have the digest it holds; column by column.

        Raises TrialError where they have not, or the file cannot be read.
        """
        found = hashlib.sha256()
        try:
            with self.path.open("rb") as content:
                while part := content.read(1 << 20):
                    found.update(part)
        except OSError as error:
            raise unreadable(b"PAR1", str(self.path), error) from error
        raw = _opened(self.path).schema_arrow.metadata or {}
        if DIGEST_KEY in raw:
            parts = ((name, self.n_rows, self._column(name)) for name in self.columns)
            if raw[DIGEST_KEY] != digest_of(parts, raw.get(METADATA_KEY, b"")):
                raise TrialError(another_digest(self.path))
        return found.hexdigest()

    def _column(self, name: str) -> Iterator[FloatArray]:
        for block in self._parts((name,), 0):
            yield block.columns[name]

    def _parts(self, names: tuple[str, ...], first: int) -> Iterator[Block]:
        """Rows as they come, from the row group on that holds ``first``."""
        yield from _parts(_opened(self.path), self.path, names, self._groups, first)


def open_voyage(path: Path | str) -> Voyage:
    """What a trial file says of itself, and how long it lasts; nothing else of it is read.

    Raises TrialError with everything that is wrong with its footer, facts and columns.
    """
    import pyarrow as pa

    path = Path(path)
    where = str(path)
    file = _opened(path)
    try:
        size = path.stat().st_size
        n_rows = rows_of(file.metadata, size, where, TrialError, limits.VOYAGE_BYTES)
        groups = tuple(file.metadata.row_group(k).num_rows for k in range(file.metadata.num_row_groups))
        schema = file.schema_arrow
    except (OSError, ValueError, pa.ArrowException) as error:
        raise unreadable(b"PAR1", where, error) from error
    limits.VOYAGE_ROWS.require(n_rows, where, TrialError)
    layout = layout_of(schema, where)
    limits.VOYAGE_COLUMNS.require(layout.n_numeric, where, TrialError)
    metadata: Mapping[bytes, bytes] = schema.metadata or {}
    refuse_log(path, layout.names, facts=METADATA_KEY in metadata)
    facts, problems = facts_of(metadata.get(METADATA_KEY), path, layout.names)
    problems = problems + layout.problems
    problems += missing_columns(layout.wanted, where, reported=layout.names)
    if not problems and n_rows < FEWEST_SAMPLES:
        problems.append(too_short(n_rows, where))
    if problems:
        raise TrialError(*problems)
    begins, ends = _ends(file, path, groups)
    return Voyage(
        id=facts.get("id") or path.stem,
        ship=facts.get("ship", ""),
        manoeuvre=facts.get("manoeuvre", ""),
        source=facts.get("source", ""),
        cut_from=facts.get("cut_from", ""),
        path=path,
        n_rows=n_rows,
        begins=begins,
        ends=ends,
        columns=tuple(layout.wanted),
        ignored=layout.ignored,
        sealed=DIGEST_KEY in metadata,
        antenna=antenna_of(facts),
        _groups=groups,
    )


def _opened(path: Path) -> Any:
    """A file to be read part by part.  Raises TrialError."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    try:
        require_regular(path)
        with path.open("rb") as file:
            begins = file.read(4)
    except OSError as error:
        fix = "check the path, and that you may read the file"
        why = reason(error)
        raise TrialError(Problem("the trial file cannot be opened", str(path), why, fix)) from error
    try:
        return pq.ParquetFile(path, pre_buffer=False, page_checksum_verification=True, buffer_size=_BUFFER)
    except (OSError, ValueError, pa.ArrowException) as error:
        raise unreadable(begins, str(path), error) from error


def _parts(file: Any, path: Path, names: tuple[str, ...], groups: tuple[int, ...], first: int) -> Iterator[Block]:
    """Rows as they come, BLOCK at the most, from the row group on that holds ``first``.

    Raises TrialError that names the row group where one is damaged.
    """
    import pyarrow as pa

    row = 0
    for k, n_rows in enumerate(groups):
        if row + n_rows > first:
            at, end = row, row + n_rows
            try:
                # Without worker threads, as ``read_trial``.
                for batch in file.iter_batches(BLOCK, row_groups=[k], columns=list(names), use_threads=False):
                    columns = {name: numbers(batch.column(batch.schema.get_field_index(name))) for name in names}
                    past = max(0, first - at)
                    if past < batch.num_rows:
                        yield Block(at + past, {name: values[past:] for name, values in columns.items()})
                    at += batch.num_rows
                if at != end:
                    raise ValueError(f"it holds {at - row} rows, its footer says {n_rows}")
            except (OSError, ValueError, pa.ArrowException) as error:
                where = f"{path}, row group {k + 1} of {len(groups)}, rows {row} to {end - 1}"
                raise unreadable(b"PAR1", where, error) from error
        row += n_rows


def _even(parts: Iterator[Block], names: tuple[str, ...]) -> Iterator[Block]:
    """The same rows, BLOCK at a time but for the last."""
    held: list[Block] = []
    count = 0
    for part in parts:
        held.append(part)
        count += len(part.columns["t"])
        while count >= BLOCK:
            row = held[0].row
            whole = {name: np.concatenate([one.columns[name] for one in held]) for name in names}
            yield Block(row, {name: values[:BLOCK] for name, values in whole.items()})
            count -= BLOCK
            held = [Block(row + BLOCK, {name: values[BLOCK:].copy() for name, values in whole.items()})]
    if count:
        yield Block(held[0].row, {name: np.concatenate([one.columns[name] for one in held]) for name in names})


def _ends(file: Any, path: Path, groups: tuple[int, ...]) -> tuple[float, float]:
    """Time of the first and the last row [s]."""
    first = next(_parts(file, path, ("t",), groups, 0)).columns["t"][0]
    last = first
    some = [k for k, n_rows in enumerate(groups) if n_rows]
    for block in _parts(file, path, ("t",), groups, sum(groups[: some[-1]])):
        last = block.columns["t"][-1]
    return float(first), float(last)
