"""Classes of sister ships from the fits of a fleet."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from .. import limits
from ..components import effect_tag
from ..documents import parsed
from ..errors import OptionError, Problem, reason
from ..files import write_text
from ..fitting import CLASSES, FEWEST, Information, SisterClass
from ..run_files import INFORMATION


def classes_of(out: Path, rows: Sequence[Mapping[str, Any]]) -> list[SisterClass]:
    """The classes of three ships or more that were fitted; the fits of a ship at all dates count together.

    Parameters of effects are of the day, not of the class: what trials say of the rest is what is left when they are
    open.
    """
    told: dict[str, dict[str, Information]] = {}
    for row in rows:
        path = out / row["run"] / INFORMATION
        if not row["sisters"] or row["command"] != "fit" or row["answer"] == "failed" or not path.is_file():
            continue
        one = _told(path)
        one = one.apart_from([name for name in one.names if effect_tag(name)])
        ships = told.setdefault(row["sisters"], {})
        ships[row["ship"]] = ships[row["ship"]].and_of(one) if row["ship"] in ships else one
    return [SisterClass(name, ships) for name, ships in sorted(told.items()) if len(ships) >= FEWEST]


def _told(path: Path) -> Information:
    """What the trials of a job say.  Raises OptionError where the file does not hold that."""
    try:
        return Information.from_dict(parsed(limits.text(path, limits.RECORD_BYTES, OptionError)))
    except (OSError, ValueError, KeyError, RecursionError) as error:
        fix = "remove the row of the job from results and run the fleet again with resume=True: the job is run anew"
        what = "the file does not hold what trials say of coefficients"
        raise OptionError(Problem(what, str(path), reason(error), fix)) from error


def write_classes(out: Path, classes: Sequence[SisterClass]) -> list[dict[str, Any]]:
    """Write a file for each class, and remove those of classes that are no more.  Returns their documents."""
    documents = []
    for one in classes:
        document = one.to_dict()
        write_text(out / CLASSES / f"{one.name}.json", json.dumps(document, allow_nan=False) + "\n")
        documents.append(document)
    for path in (out / CLASSES).glob("*.json"):
        if path.stem not in [one.name for one in classes] and not path.is_dir():
            path.unlink()
    return documents
