"""What kind of file a log is, by how it begins."""

from __future__ import annotations

import re
import zipfile
from pathlib import Path

from ...errors import LogError, Problem
from ..maps.mapping import LogMap
from .matlab import of_version_4
from .text import binary, start_of
from .workbook import OLD, ZIP

_WORDS = {b"PAR1": "a Parquet file", ZIP: "a workbook or another archive", b"MATLAB": "a MATLAB file"}


_UNPACK = "unpack it first"
_EXPORT = "export what the trial needs to CSV, with the program that it comes from or the library for it"
_OTHERS = {
    rb"\x1f\x8b": ("compressed (gzip)", _UNPACK),
    rb"BZh[1-9]": ("compressed (bzip2)", _UNPACK),
    rb"\xfd7zXZ": ("compressed (xz)", _UNPACK),
    rb"\x28\xb5\x2f\xfd": ("compressed (zstd)", _UNPACK),
    rb"7z\xbc\xaf|Rar!": ("an archive", _UNPACK),
    rb"ARROW1|FEA1": ("an Arrow file", "write it as Parquet: pandas.read_feather(...).to_parquet(...)"),
    rb"#ROSBAG|\x89MCAP": ("a recording of ROS", _EXPORT),
    rb"(?:UnFin)?MDF ": ("a recording of a measuring system (MDF)", _EXPORT),
    rb"TDSm": ("a recording of a measuring system (TDMS)", _EXPORT),
    rb"SQLite format 3": ("a database (SQLite)", "write the table of the log as CSV"),
    rb"%PDF": ("a document (PDF)", "ask for the numbers themselves"),
    rb"\s*<(?:\?xml|!DOCTYPE|gpx|kml|html)": (
        "XML, such as GPX, or a web page",
        "write it as CSV, with heading, rudder and revolutions beside the track",
    ),
    rb"\s*(?:\[\s*)?\{\s*\"": ("JSON", "write it as a table: pandas.read_json(...).to_csv(..., index=False)"),
}
"""How files begin that are no logs which are read here: what they are, and what to do."""


def form_of(log: Path) -> str:
    """The format of a log: one of ``mapping.FORMATS``.  Raises LogError where it cannot be opened or read here."""
    content = start_of(log)
    if content.startswith(b"PAR1"):
        return "parquet"
    if content.startswith(ZIP):
        _require_workbook(log)
        return "xlsx"
    if content.startswith(OLD):
        why = "it is a workbook of the older kind (.xls), or one with a password"
        fix = "save it as .xlsx or as CSV, without a password"
        raise LogError(Problem("the log is no text", str(log), why, fix))
    if content.startswith((b"MATLAB", b"\x89HDF")) or (content[126:128] in (b"IM", b"MI") and binary(content)):
        return "mat"
    if binary(content) and (of_version_4(content) or log.suffix.lower() == ".mat"):
        return "mat"  # where it is told why it cannot be read
    text = content.removeprefix(b"\xef\xbb\xbf")
    if re.match(rb"\s*[$!][A-Z]{4,},", text) or _is_of_sentences(text):
        return "nmea"
    for begins, (kind, fix) in _OTHERS.items():
        if re.match(begins, text):
            why = "logs are text tables, Parquet, .xlsx, MATLAB files and NMEA 0183"
            raise LogError(Problem(f"the log is {kind}", str(log), why, fix))
    if log.suffix.lower() == ".toml":
        why, fix = "it is TOML, as profiles, splits and maps are", "give the log itself; a map goes behind --map"
        raise LogError(Problem("the file is no log", str(log), why, fix))
    return "csv"


_SENTENCE = re.compile(rb"[^\r\n]{0,80}[$!][A-Z]{5},[^*\r\n]{0,80}\*[0-9A-Fa-f]{2}\s*")
"""A line of NMEA 0183 behind a time stamp, a port or a block of tags."""


def _is_of_sentences(text: bytes) -> bool:
    """Whether most lines of the beginning of a log are sentences of NMEA 0183 with something before them."""
    lines = [line for line in text.splitlines()[:-1] if line.strip()]
    return bool(lines) and 2 * sum(_SENTENCE.fullmatch(line) is not None for line in lines) > len(lines)


def _require_workbook(log: Path) -> None:
    """Raise LogError for an archive that is whole, and no workbook."""
    try:
        with zipfile.ZipFile(log) as archive:
            names = archive.namelist()
    except (OSError, ValueError, NotImplementedError, zipfile.BadZipFile):
        return  # a damaged one is told where it is read
    if "content.xml" in names:
        fix = "save it as .xlsx or as CSV"
        raise LogError(
            Problem("the log is a spreadsheet in OpenDocument format", str(log), "it is .ods, not .xlsx", fix)
        )
    if not any(name.startswith("xl/") for name in names):
        raise LogError(Problem("the log is a zip archive", str(log), "there is no workbook in it", _UNPACK))


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
