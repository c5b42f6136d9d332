"""The results of a fleet: a Parquet data set, partitioned by ship and date, with a row for each job.

A row is a file of its own, written whole or not at all, and its name has the key of its job: a job is done where its
file is there.  So nothing is lost with whoever dies, and nothing stands there twice.
"""

from __future__ import annotations

import math
import os
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from ..errors import OptionError, Problem, reason
from ..files import atomic
from ..resources import looked_for, must_be_name
from .commands import Facts
from .job import Job

FOLDER = "results"
ANSWERS = ("good", "no", "failed")
"""What a row says of its job: nothing found wrong, something found wrong, could not run."""

UNKNOWN = ("off_track", "off_heading", "tuned_track", "tuned_heading")
"""Numbers that a row may not have: of what was not simulated, or diverged."""

_FROM = "__filename"
"""What Arrow calls the column that says which file a row is from."""

_FILE = re.compile(r"(?P<name>.+)-(?P<key>[0-9a-f]{16})\.parquet")


def made(job: Job, facts: Facts, record: str, seconds: float) -> dict[str, Any]:
    """The row of a job that ran, its results in the file ``record`` of its run folder."""
    return {**_of_job(job), **asdict(facts), "record": record, "seconds": seconds, "problems": []}


def failed(job: Job, problems: Sequence[Problem], seconds: float) -> dict[str, Any]:
    """The row of a job that could not run."""
    verdict = "; ".join(one.what for one in problems)
    told = [one.to_dict() for one in problems]
    return {**_of_job(job), **asdict(Facts("failed", verdict)), "record": "", "seconds": seconds, "problems": told}


def _of_job(job: Job) -> dict[str, Any]:
    return {
        "name": job.name,
        "command": job.command,
        "sisters": job.sisters,
        "key": job.key,
        "run": job.place,
        "profile": job.profile_path,
        "trials": job.trials.path,
    }


def path_of(out: Path, job: Job) -> Path:
    """The file of a job's row."""
    return out / FOLDER / f"ship={job.ship}" / f"date={job.date}" / f"{job.name}-{job.key}.parquet"


def write(out: Path, job: Job, row: Mapping[str, Any]) -> None:
    """Write the row of a job, and remove that of the same job with other data or options."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    path = path_of(out, job)
    with atomic(path) as part:
        pq.write_table(pa.Table.from_pylist([dict(row)], schema=schema()), part, compression="zstd")
    for other in path.parent.glob(f"{job.name}-*.parquet"):
        match = _FILE.fullmatch(other.name)
        if match and match["name"] == job.name and match["key"] != job.key:
            other.unlink(missing_ok=True)


def schema() -> Any:
    """Columns of the data set but for ship and date, which folders say."""
    import pyarrow as pa

    texts = ("name", "command", "sisters", "key", "run", "profile", "trials", "record", "answer", "verdict")
    numbers = ("seconds", "off_track", "off_heading", "tuned_track", "tuned_heading")
    problem = pa.struct([(name, pa.string()) for name in ("what", "where", "why", "fix")])
    return pa.schema(
        [
            *((name, pa.string()) for name in texts),
            *((name, pa.float64()) for name in numbers),
            ("generated", pa.bool_()),
            *((name, pa.list_(pa.string())) for name in ("causes", "sentences", "names")),
            *((name, pa.list_(pa.float64())) for name in ("values", "before", "errors")),
            ("problems", pa.list_(problem)),
        ]
    )


def done(out: Path) -> dict[str, Path]:
    """The files of rows that are there, by the keys of their jobs."""
    return {match["key"]: path for path, match in _files(out)}


def _files(out: Path) -> Iterator[tuple[Path, re.Match[str]]]:
    folder = out / FOLDER
    for of_ship in _inside(folder):
        for of_date in _inside(of_ship):
            for file in _inside(of_date):
                if match := _FILE.fullmatch(file.name):
                    yield file, match


def _inside(folder: Path) -> list[Path]:
    try:
        return [folder / name for name in sorted(os.listdir(folder))]
    except (FileNotFoundError, NotADirectoryError, ValueError):  # the last for a zero byte in the name
        return []


def read(out: Path | str) -> list[dict[str, Any]]:
    """All rows with their ship and date, by these and name.  Raises OptionError where there is no such data set."""
    must_be_name(out, "folder", OptionError)
    out = Path(out)
    import pyarrow as pa
    import pyarrow.dataset as ds

    folder = out / FOLDER
    keys_of = {str(path): match["key"] for path, match in _files(out)}
    if not keys_of:
        why = "no job has ended there" if out.is_dir() else looked_for(out)
        fix = "give the folder that --out of mmgtune fleet run named"
        raise OptionError(Problem("there are no results of a fleet", str(folder), why, fix))
    keys = pa.schema([("ship", pa.string()), ("date", pa.string())])
    whole = pa.unify_schemas([schema(), keys])
    parts = ds.partitioning(keys, flavor="hive")
    try:
        found = ds.dataset(
            list(keys_of), schema=whole, format="parquet", partitioning=parts, partition_base_dir=str(folder)
        )
        rows: list[dict[str, Any]] = found.to_table(columns=[*whole.names, _FROM]).to_pylist()
    except (OSError, ValueError, pa.ArrowException) as error:
        damaged = [(path, why) for path in keys_of if (why := _unreadable(path))] or [(str(folder), reason(error))]
        what = "the result of a job cannot be read"
        raise OptionError(*(Problem(what, path, why, ANEW) for path, why in damaged)) from error
    of_file: dict[str, list[dict[str, Any]]] = {path: [] for path in keys_of}
    for row in rows:
        of_file[str(row.pop(_FROM))].append(row)
    damaged = [(path, why) for path, several in of_file.items() if (why := _unsound(several, keys_of[path]))]
    if damaged:
        what = "the row of a job does not hold what such rows hold"
        raise OptionError(*(Problem(what, path, why, ANEW) for path, why in damaged))
    return sorted(rows, key=lambda row: (row["ship"], row["date"], row["name"]))


ANEW = "remove that file and run the fleet again with resume=True: the job is run anew"


def _unreadable(path: str) -> str:
    """Why a file of rows cannot be read; "" where it can."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    try:
        pq.read_table(path, partitioning=None)
    except (OSError, ValueError, pa.ArrowException) as error:
        return reason(error)
    return ""


def _unsound(several: Sequence[Mapping[str, Any]], key: str) -> str:
    """Why the rows of a file are not the one that ``write`` wrote there; "" where they are."""
    if len(several) != 1:
        return f"it has {len(several)} rows, not one"
    (row,) = several
    written = schema()
    lost = [one.name for one in written if row[one.name] is None and one.name not in UNKNOWN]
    if lost:
        return f"nothing in {', '.join(lost)}"
    if row["key"] != key or row["answer"] not in ANSWERS:
        return f"it is of another job than its name says, or its answer is none of {', '.join(ANSWERS)}"
    if Path(row["run"]).is_absolute() or ".." in Path(row["run"]).parts:
        return "its run folder is outside the fleet's"
    if len({len(row[name]) for name in ("names", "values", "before", "errors")}) > 1:
        return "not as many values and errors as names of coefficients"
    if None in (*row["causes"], *row["sentences"], *row["names"], *row["problems"]):
        return "names or sentences are missing"
    numbers = (row[one.name] for one in written if _holds_numbers(one.type))
    if not all(math.isfinite(value) for one in numbers for value in _as_list(one) if value is not None):
        return "numbers that are not finite"
    return ""


def _holds_numbers(kind: Any) -> bool:
    import pyarrow as pa

    return kind in (pa.float64(), pa.list_(pa.float64()))


def _as_list(value: Any) -> Sequence[float | None]:
    return value if isinstance(value, list) else [value]
