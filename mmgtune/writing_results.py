"""One way for all results to be left in a folder: whole or not at all, and never in the place of others unasked."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from .documents import write_json
from .errors import must_be_a
from .files import all_or_none, path_of, refuse_existing


@contextmanager
def place_for(
    result: object, kind: type | tuple[type, ...], folder: Path | str, *names: str, overwrite: bool
) -> Iterator[Path]:
    """The folder that a result is to be written to; what is new in it goes again where an error ends the context.

    kind   what the result has to be
    names  files of which none may be there already, unless ``overwrite``

    Raises OptionError for what is no path and no such result, OutputError where a file is there already or the system
    refuses to write.
    """
    place = path_of(folder)
    must_be_a(result, kind, "result")
    refuse_existing([place / name for name in names], overwrite)
    with all_or_none():
        yield place


def write_record(document: Mapping[str, Any], place: Path, name: str) -> dict[str, Any]:
    """Write the record of a result, the last of its files: that it is there means that the others are.

    Returns it, with the folder it lies in (``out``).
    """
    found = {**document, "out": str(place)}
    write_json(found, place / name)
    return found
