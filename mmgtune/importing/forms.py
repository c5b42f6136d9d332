"""What kind of file a log is, by how it begins."""

from __future__ import annotations

import re
from pathlib import Path

from ..errors import LogError, Problem
from .mapping import LogMap
from .text import binary, start_of
from .workbook import OLD

_WORDS = {b"PAR1": "a Parquet file", b"PK\x03\x04": "a workbook or another archive", b"MATLAB": "a MATLAB file"}


def form_of(log: Path) -> str:
    """The format of a log: one of ``mapping.FORMATS``.  Raises LogError where it cannot be opened or read here."""
    content = start_of(log)
    if content.startswith(b"PAR1"):
        return "parquet"
    if content.startswith(b"PK\x03\x04"):
        return "xlsx"
    if content.startswith(OLD):
        why = "it is a workbook of the older kind (.xls), or one with a password"
        fix = "save it as .xlsx or as CSV, without a password"
        raise LogError(Problem("the log is no text", str(log), why, fix))
    if content.startswith((b"MATLAB", b"\x89HDF")) or (content[126:128] in (b"IM", b"MI") and binary(content)):
        return "mat"
    if re.match(rb"\s*[$!][A-Z]{4,},", content.removeprefix(b"\xef\xbb\xbf")):
        return "nmea"
    return "csv"


def refuse_binary(log: Path, content: bytes, log_map: LogMap) -> None:
    """Raise LogError where the first bytes of a log are no text in the encoding that the map says."""
    wide = log_map.encoding.lower().replace("_", "-").startswith(("utf-16", "utf-32"))
    if not binary(content) or (wide and log_map.format in (None, "csv")):
        return
    kind = next((words for mark, words in _WORDS.items() if content.startswith(mark)), "binary")
    fix = "convert it to CSV, Parquet or NMEA 0183 with its logger's own software; or say the right encoding"
    if kind != "binary":
        fix = "leave out format in [log] of the map: it is seen"
    raise LogError(Problem(f"the log is {kind}, not text", str(log), "it has zero bytes in it", fix))
